#pragma once

#include "ink/exchange/deposit_mixed.h"
#include "ink/exchange/transfer.h"
#include "ink/film/level.h"
#include "ink/film/paste.h"
#include "stroke/contact/stamp.h"
#include "stroke/deposit/stamp_target.h"

namespace tuft::stroke {

/// One stamp at a time, for ink that differs over the footprint or is exchanged with what lies there: first the texels
/// that the stamp exposes are found, then ink acts on them, tiles in parallel. The bits do not depend on the number of
/// threads.
class StampExposure {
  public:
    /// `target` must outlive it.
    StampExposure(StampTarget& target, const footprint::StampOptions& options);

    /// Finds the exposed texels. Returns the surface under each node of the stamp's grid, m².
    ink::NodeAreas expose(const Stamp& stamp);

    /// Exchanges wet ink there; of paste no more than `loose` film units. Returns what was given less what was taken,
    /// by node.
    ink::NodeContents exchange(const ink::TransferParams& params, double ds, double loose);
    /// Deposits ink there that differs from node to node. Returns what was given.
    ink::NodeContents deposit(const ink::DepositParams& params, const ink::NodeMixes& mixes, double ds);

    /// Ink given and taken, by node.
    struct Exchanged {
        ink::NodeContents given{}, taken{};
    };
    /// Ploughs paste there.
    Exchanged plough(const ink::PasteParams& params, const ink::NodeMixes& mixes, double ds);
    /// Rounds the paste that was deposited over `length` metres.
    void level(const atlas::SeamLinks& seams, double length);

  private:
    struct Tile {
        std::uint32_t slot = kNone;  ///< kNone: nothing of it is exposed
        alignas(64) std::array<float, atlas::kTileTexels> exposure;
        ink::TexelPlaces places;
        ink::NodeAreas areas{};
        ink::NodeContents given{}, taken{};
    };
    struct Scratch;  // of one thread
    void expose_tile(Tile& tile, const Stamp& stamp, const footprint::TileJob& job, Scratch& scratch);
    template <class Act>
    ink::NodeContents act_on_tiles(Act act);

    StampTarget& target_;
    footprint::StampOptions options_;
    footprint::StampJobs plan_;
    bool piecewise_ = false;
    std::vector<Tile> tiles_;  ///< that the present stamp reaches
    ink::OpenBefore pastes_;   ///< paste on the tiles before the stroke
};

}  // namespace tuft::stroke
