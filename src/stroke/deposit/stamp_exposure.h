#pragma once

#include "ink/exchange/deposit_mixed.h"
#include "ink/exchange/transfer.h"
#include "ink/film/level.h"
#include "ink/film/tile/paste.h"
#include "stroke/contact/stamp.h"
#include "stroke/deposit/stamp_target.h"

/// \file
/// Stamps applied one at a time, for ink that varies over the footprint. Called by deposit models for mixed ink, wet
/// ink and paste.

namespace tuft::stroke {

/// Exposure of texels by the present stamp, and laws of ink that act on it: `expose` first, then one of the others.
/// Tiles in parallel; the bits do not depend on the number of threads.
class StampExposure {
  public:
    /// `target` must outlive it.
    StampExposure(StampTarget& target, const footprint::StampOptions& options);

    /// Computes the exposure of texels by a stamp. Returns the area under each node of the stamp's grid, m².
    ink::NodeAreas expose(const Stamp& stamp);

    /// Exchanges wet ink (ink/exchange/transfer.h), of paste at most `loose` film units. Returns ink given minus ink
    /// taken, film·m², by node. `ds`: metres of travel.
    ink::NodeContents exchange(const ink::TransferParams& params, double ds, double loose);
    /// Deposits ink that differs from node to node. Returns the ink given, film·m², by node.
    ink::NodeContents deposit(const ink::DepositParams& params, const ink::NodeMixes& mixes, double ds);

    /// Ink given and taken, film·m², by node.
    struct Exchanged {
        ink::NodeContents given{}, taken{};
    };
    /// Ploughs paste (ink/film/tile/paste.h).
    Exchanged plough(const ink::PasteParams& params, const ink::NodeMixes& mixes, double ds);
    /// Levels the paste of the stroke over `length` metres.
    void level(const atlas::SeamLinks& seams, double length);

  private:
    struct Tile {
        std::uint32_t slot = kNone;  ///< kNone: not exposed
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
    std::vector<Tile> tiles_;  ///< of the present stamp
    ink::OpenBefore pastes_;   ///< paste before the stroke
};

}  // namespace tuft::stroke
