#pragma once

#include "core/system/progress.h"
#include "footprint/stamp/neighbourhood.h"
#include "ink/exchange/blot.h"
#include "ink/exchange/erase.h"
#include "stroke/contact/stamp.h"
#include "stroke/deposit/stamp_target.h"

/// \file
/// Stamps of one ink, deposited or erased a batch at a time. Called by deposit_still.cpp.

namespace tuft::stroke {

/// Applies stamps to texels in batches of `kStamps`: tiles in parallel, the stamps of one tile in order, so that the
/// bits do not depend on the number of threads. The ink given is known after each batch.
class StampBatch {
  public:
    static constexpr std::size_t kStamps = 8;

    /// `target` must outlive it.
    StampBatch(StampTarget& target, const footprint::StampOptions& options);

    /// Adds a stamp; returns true when the batch is full and must be flushed. Precondition: all stamps of a batch
    /// erase, or none does.
    bool add(Stamp stamp);
    /// Deposits the batch. Returns the ink given, film·m². Calls `going_on` every few hundred tiles; a stop throws
    /// `Cancelled` and leaves tiles half done, of which the target has copies.
    double flush(const ProgressFn& going_on = {});

    /// Ink erased so far, film·m².
    const ink::Amounts& erased() const { return erased_; }
    /// After erasing: removes wet ink that stayed round the erased texels.
    void blot(const atlas::SeamLinks& seams);

  private:
    /// A tile that one stamp of the batch reaches.
    struct TileStamp {
        std::uint32_t slot, stamp, tile;
    };
    void plan();
    void sort_by_tile();
    /// Computes the factor on the film of each texel of a tile. Returns false where it is 1.
    bool find_tone(std::uint32_t slot, const Stamp& stamp, std::span<float, atlas::kTileTexels> tone);
    /// Returns the ink given to a tile, film·m².
    double write_tile(std::span<const TileStamp> stamps, std::span<const ink::DepositLaw> laws,
                      std::span<ink::Amounts> erased, footprint::Unpacked& unpacked);

    StampTarget& target_;
    footprint::StampOptions options_;
    std::vector<Stamp> batch_;
    std::vector<footprint::MovedFootprint> moved_;  ///< one per stamp
    footprint::Neighbourhood around_;
    std::vector<footprint::StampJobs> plans_;  ///< one per place in the batch; memory is reused
    bool piecewise_ = false;
    // Of the present batch; their memory is reused.
    std::vector<TileStamp> order_;         ///< by tile, then by stamp
    std::vector<std::size_t> first_;       ///< of each tile in `order_`, and its end
    std::vector<double> given_;            ///< film·m², by tile
    std::vector<ink::Amounts> erased_of_;  ///< likewise, by `order_`; empty where nothing is erased
    ink::EraseStarts erase_starts_;
    ink::Amounts erased_;
};

}  // namespace tuft::stroke
