#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "brush/tuft/tuft_state.h"

namespace tuft::stroke {

struct ResampleOptions {
    double step = 1e-4;                 ///< metres between two poses, in the measure below
    double lever = 0.02;                ///< metres: what a turn by one radian counts as (the tuft's length)
    double drift = 2e-3;                ///< m/s: what resting counts as, so that a dwell keeps its time
    std::size_t max_poses = 1'000'000;  ///< some ten minutes of painting
};

/// Poses at even steps along the path of the hand, as samples arrive: the first one,
/// one at every multiple of `step`, and the last one.
///
/// Between samples the position follows a centripetal Catmull–Rom spline (Catmull and
/// Rom 1974; Yuksel et al. 2011: no cusps, no self-crossings within a segment), time a rising
/// cubic over the spline's knots (Fritsch and Carlson 1980) and the rotation a cumulative cubic in
/// time (Kim, Kim and Shin 1995), with the rates of the parabolas through three samples, so that
/// all are third-order exact. Length is measured in the space of poses,
/// ds² = |dx|² + (lever dφ)² + (drift dt)², so the result is the same for any rate at
/// which the device sampled the same motion, and the same whether the samples came one by
/// one or all at once. The spline looks one sample ahead. Samples whose time falls are
/// taken as simultaneous with the one before; repeated samples are merged.
/// Throws `Error` when the path needs more than `max_poses`.
class Resampler {
  public:
    explicit Resampler(const ResampleOptions& options);
    /// Adds a sample and appends the poses that became known to `out`.
    void push(brush::Pose sample, std::vector<brush::Pose>& out);
    /// Ends the path: appends what is left, ending with the last sample.
    void finish(std::vector<brush::Pose>& out);
    /// Where the samples lie among the poses given out, in steps from the first pose: pose k lies at k, but the one
    /// that `finish` ends with, which lies at the last sample. One for each sample pushed that lies behind the last
    /// pose.
    std::vector<double> places() const;

  private:
    void emit_segment(const brush::Pose& before, const brush::Pose& after, std::vector<brush::Pose>& out);
    void emit(const brush::Pose& pose, std::vector<brush::Pose>& out);

    ResampleOptions options_;
    std::deque<brush::Pose> window_;  ///< up to four samples; the segment in work is the middle one
    std::size_t emitted_ = 0;
    double since_last_ = 0;  ///< length since the last pose given out, metres
    bool has_before_ = false;
    std::vector<std::uint32_t> merged_;  ///< for each sample pushed, which of those that differ it is
    std::vector<double> places_;         ///< of those that differ
};

/// Throws the `Error` of `Resampler` where the samples are farther apart than `max_poses` steps in all: before the
/// first pose is taken, and never for a path that `Resampler` takes. Cost: linear.
void check_path_length(std::span<const brush::Pose> poses, const ResampleOptions& options);

/// All at once.
std::vector<brush::Pose> resample(std::span<const brush::Pose> poses, const ResampleOptions& options = {});

}  // namespace tuft::stroke
