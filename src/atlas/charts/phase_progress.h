#pragma once

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>

#include "core/system/progress.h"

/// \file
/// Progress of a phase of the unwrapping that several threads advance.
namespace tuft::atlas {

/// Progress of one phase that several threads advance. When the callback cancels, every call throws `Cancelled`.
class PhaseProgress {
  public:
    PhaseProgress(ProgressFn progress, std::string phase, double all)
        : progress_(std::move(progress)), phase_(std::move(phase)), all_(all) {}

    /// Adds `work`, in the unit of `all`, to what is done, and reports it.
    void advance(double work) {
        if (!progress_ || !(work >= 0)) return;
        const std::lock_guard lock(mutex_);
        done_ += work;
        stopped_ = stopped_ || !progress_(phase_, all_ > 0 ? std::min(done_ / all_, 1.0) : 1.0);
        if (stopped_) throw Cancelled();
    }

  private:
    ProgressFn progress_;
    std::string phase_;
    double all_, done_ = 0;
    bool stopped_ = false;
    std::mutex mutex_;
};

/// One task's share of a phase, reported in steps and never exceeded.
class TaskProgress {
  public:
    TaskProgress(PhaseProgress& phase, double work) : phase_progress_(phase), left_(work) {}

    void advance(double work) {
        work = std::min(work, left_);
        left_ -= work;
        phase_progress_.advance(work);
    }
    void finish() { advance(left_); }

  private:
    PhaseProgress& phase_progress_;
    double left_;
};

}  // namespace tuft::atlas
