#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "footprint/stamp/stamp.h"

namespace tuft::stroke {

/// Scratch buffers to plan stamps with: as many as threads plan at a time. Outlives a stroke, so that the memory is
/// used again by the next one.
class PlanScratchPool {
  public:
    /// A buffer for one thread, until it is destroyed.
    class Lease {
      public:
        explicit Lease(PlanScratchPool& pool);
        ~Lease();
        Lease(const Lease&) = delete;
        Lease& operator=(const Lease&) = delete;
        operator footprint::PlanScratch&() { return *scratch_; }

      private:
        PlanScratchPool& pool_;
        std::unique_ptr<footprint::PlanScratch> scratch_;
    };

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<footprint::PlanScratch>> free_;
    std::size_t allocated_ = 0;
};

}  // namespace tuft::stroke
