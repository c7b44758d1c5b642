#include "stroke/deposit/plan_scratch_pool.h"

namespace tuft::stroke {

PlanScratchPool::Lease::Lease(PlanScratchPool& pool) : pool_(pool) {
    const std::lock_guard lock(pool_.mutex_);
    if (pool_.free_.empty()) {
        scratch_ = std::make_unique<footprint::PlanScratch>();
        pool_.free_.reserve(++pool_.allocated_);  // giving it back never throws
    } else {
        scratch_ = std::move(pool_.free_.back());
        pool_.free_.pop_back();
    }
}

PlanScratchPool::Lease::~Lease() {
    const std::lock_guard lock(pool_.mutex_);
    pool_.free_.push_back(std::move(scratch_));
}

}  // namespace tuft::stroke
