#pragma once

#include <cstdint>
#include <vector>

#include "brush/state/tuft_state.h"
#include "haptic/hair_answer.h"

/// \file
/// Cuts the solved poses into strokes: from the last pose in the air before the hair touches to the end of 50 ms in the
/// air. The poses are those that the force was computed for, to the bit; the painting takes them as they are
/// (`stroke::Document::begin`, `extend`, `end`).
namespace tuft::haptic {

/// Cuts a sequence of solved poses into strokes.
class StrokeCutter {
  public:
    /// What the next pose means for the painting.
    struct Cut {
        bool begins = false;             ///< a stroke begins with `poses`
        bool ends = false;               ///< a stroke ends after `poses`
        std::vector<brush::Pose> poses;  ///< of the stroke in work, times from its own beginning, s
    };
    Cut add(const SolvedPose& solved);
    /// Whether a stroke is in work: the window closes, or the arm is gone, and it must be ended.
    bool in_stroke() const { return in_stroke_; }
    void end() { in_stroke_ = known_ = false; }

  private:
    brush::Pose pose_of(const SolvedPose& solved) const;

    SolvedPose last_;
    std::uint64_t begin_ = 0, touched_ = 0;
    bool in_stroke_ = false, known_ = false;
};

}  // namespace tuft::haptic
