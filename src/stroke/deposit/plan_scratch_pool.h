#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "footprint/stamp/plan_scratch.h"

/// \file
/// Scratch buffers for planning stamps in parallel. A `Document` owns one pool for all of its strokes.

namespace tuft::stroke {

/// Buffers for `footprint::plan_stamp`, as many as threads plan at the same time. Thread-safe. Memory is reused by the
/// next stroke.
class PlanScratchPool {
  public:
    /// A buffer for one thread, given back at the end of its life.
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
