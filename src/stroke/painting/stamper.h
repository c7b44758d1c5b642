#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "core/progress.h"
#include "footprint/stamp.h"
#include "ink/film/level.h"
#include "ink/film/paste.h"
#include "ink/touch/blot.h"
#include "ink/touch/deposit_mixed.h"
#include "ink/touch/transfer.h"
#include "stroke/painting/mask.h"
#include "stroke/painting/model.h"

namespace tuft::stroke {

/// One footprint with the ink it brings.
struct Stamp {
    footprint::Footprint footprint;
    footprint::Motion motion;    ///< since the stamp before, in the footprint's frame
    ink::DepositParams ink;
    double ds = 0;               ///< metres of travel it stands for
    double erases = 0;           ///< strength of an eraser, which takes ink instead; 0: it is none
    bool by_hair = false;        ///< drawn by its hair: the surface's grain shows where it is not filled
    float apart = 0;             ///< 0–1: how much of it is single hairs; 0: one closed patch
    double grain_film = 0;       ///< then: metres of ink under the hair over the grain's mean height
    ink::TouchGrid grid;         ///< over the footprint, for ink that is not the same all over it
};

/// Memory to plan stamps with, as much as threads plan at a time; outlives a stroke.
class PlanRooms {
  public:
    /// For one thread, until it is destroyed.
    class Room {
      public:
        explicit Room(PlanRooms& rooms);
        ~Room();
        Room(const Room&) = delete;
        Room& operator=(const Room&) = delete;
        operator footprint::PlanScratch&() { return *scratch_; }

      private:
        PlanRooms& rooms_;
        std::unique_ptr<footprint::PlanScratch> scratch_;
    };

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<footprint::PlanScratch>> free_;
    std::size_t made_ = 0;
};

/// Puts stamps onto the texels, a batch at a time: tiles in parallel, on each tile the
/// stamps in their order, so the texels do not depend on the number of threads. Batches
/// have a fixed length; ink given is known after each.
class Stamper {
  public:
    static constexpr std::size_t kBatch = 8;

    Stamper(const Model& model, ink::Canvas& canvas, const footprint::StampOptions& options,
            const ink::Substrate& substrate, PlanRooms& rooms);

    /// Keeps to a mask from now on, which must outlive the stamper; null: to none.
    void keep_to(const MaskTexels* mask) { mask_ = mask; }

    /// Takes a stamp; true when the batch is full and must be flushed.
    bool add(Stamp stamp);
    /// Lays down what was added. Returns the ink given, film·m². Asks `going_on` every few hundred
    /// tiles; a stop leaves tiles half done, which `take_before` has as they were.
    double flush(const ProgressFn& going_on = {});

    /// What erasing stamps have taken away since the start.
    const ink::Amounts& erased() const { return erased_; }

    /// For wet and for mixed ink, one stamp at a time: where it touches, and how much surface lies
    /// under each node of its grid.
    ink::NodeAreas expose(const Stamp& stamp);
    /// Lets ink go both ways there; of paste no more than `loose` film units. Returns what was
    /// given less what was taken, by node.
    ink::NodeContents exchange(const ink::TransferParams& params, double ds, double loose);
    /// Lays ink down there that differs from node to node. Returns what was given.
    ink::NodeContents lay(const ink::DepositParams& params, const ink::NodeMixes& mixes, double ds);

    /// What went down and came up, by node.
    struct Passed {
        ink::NodeContents given{}, taken{};
    };
    /// Ploughs paste there.
    Passed plough(const ink::PasteParams& params, const ink::NodeMixes& mixes, double ds);
    /// Rounds the paste that was laid over `length` metres.
    void level(const atlas::SeamLinks& seams, double length);

    /// Whether thick dry paint lies on some tile that was written to.
    bool on_relief() const;
    /// Lets thin ink that was laid settle on thick paint; `film` units of an ink of that strength.
    void pool(const atlas::SeamLinks& seams, double film, double strength);

    /// After erasing: draws off what of wet ink stayed round what was erased.
    void blot(const atlas::SeamLinks& seams);

    /// Notes a tile as it is, for `take_before`, unless it was noted already.
    void keep(std::uint32_t slot);

    /// Tiles as they were before this stamper first wrote to them.
    std::vector<ink::TileSnapshot> take_before();

  private:
    /// Single hairs drawn sideways ink all that they pass over; sub-poses would leave a comb.
    footprint::StampOptions options_of(const Stamp& stamp) const {
        footprint::StampOptions o = options_;
        o.passes_over = stamp.apart;
        return o;
    }

    footprint::Motion motion_of(const Stamp& stamp) const;

    using Grain = std::array<float, atlas::kTileTexels>;
    const Grain& grain(std::uint32_t slot);
    struct Exposed;
    template <class F>
    ink::NodeContents act_on_exposed(F act);

    const Model& model_;
    ink::Canvas& canvas_;
    footprint::StampOptions options_;
    std::vector<Stamp> batch_;
    PlanRooms& rooms_;
    std::vector<footprint::StampJobs> jobs_;       ///< one per place in the batch; their memory is used again
    bool piecewise_ = false;
    float grain_rms_ = 0, grain_length_ = 0;       ///< metres, of the substrate
    std::vector<std::unique_ptr<Grain>> grain_;    ///< by slot, made when a dry hair comes there
    struct Exposed {
        std::uint32_t slot = kNone;
        alignas(64) std::array<float, atlas::kTileTexels> exposure;
        ink::TexelPlaces places;
        ink::NodeAreas areas{};
        ink::NodeContents given{}, taken{};
    };
    std::vector<Exposed> exposed_;                 ///< by the stamp in work, as many as it reached
    std::unordered_map<std::uint32_t, ink::TileSnapshot> before_;
    ink::OpenBefore pastes_;  ///< `before` of lay_paste
    ink::EraseStarts starts_;                      ///< of tiles an eraser came to
    ink::Amounts erased_;
    const MaskTexels* mask_ = nullptr;
};

}  // namespace tuft::stroke
