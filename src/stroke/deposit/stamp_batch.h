#pragma once

#include "core/system/progress.h"
#include "ink/exchange/blot.h"
#include "ink/exchange/erase.h"
#include "stroke/contact/stamp.h"
#include "stroke/deposit/stamp_target.h"

namespace tuft::stroke {

/// Puts stamps of one ink onto texels, or takes ink off with them, a batch at a time: tiles in parallel, on each tile
/// the stamps in their order, so that the texels do not depend on the number of threads. Batches have a fixed
/// length; the ink given is known after each.
class StampBatch {
  public:
    static constexpr std::size_t kStamps = 8;

    /// `target` must outlive it.
    StampBatch(StampTarget& target, const footprint::StampOptions& options);

    /// Takes a stamp; true when the batch is full and must be flushed. A stamp that erases may only stand beside
    /// others that do.
    bool add(Stamp stamp);
    /// Deposits what was added. Returns the ink given, film·m². Asks `going_on` every few hundred tiles; a stop
    /// leaves tiles half done, of which the target has copies.
    double flush(const ProgressFn& going_on = {});

    /// What erasing stamps have taken away so far.
    const ink::Amounts& erased() const { return erased_; }
    /// After erasing: draws off wet ink that stayed round what was erased.
    void blot(const atlas::SeamLinks& seams);

  private:
    /// A tile that one stamp of the batch reaches.
    struct TileStamp {
        std::uint32_t slot, stamp, tile;
    };
    void plan();
    std::vector<TileStamp> sort_by_tile();
    void write_tile(std::span<const TileStamp> stamps, std::span<const ink::DepositLaw> laws,
                    std::span<ink::Amounts> erased, std::span<double> given, footprint::Unpacked& unpacked);

    StampTarget& target_;
    footprint::StampOptions options_;
    std::vector<Stamp> batch_;
    std::vector<footprint::StampJobs> plans_;  ///< one per place in the batch; their memory is used again
    bool piecewise_ = false;
    ink::EraseStarts erase_starts_;
    ink::Amounts erased_;
};

}  // namespace tuft::stroke
