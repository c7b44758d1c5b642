#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "brush/state/tuft_state.h"
#include "core/system/recycled.h"

/// \file
/// Poses at even steps from samples at any rate. Called by `StrokeSession` for every stroke.

namespace tuft::stroke {

/// Distance of poses, and what counts towards it.
struct ResampleOptions {
    double step = 1e-4;                 ///< metres between two poses, in the measure below
    double lever = 0.02;                ///< metres that a rotation by 1 rad counts (the tuft's length)
    double drift = 2e-3;                ///< m/s that time counts, so that a dwell gets poses, too
    std::size_t max_poses = 1'000'000;  ///< some ten minutes of painting
};

/// Resamples the path of a hand as its samples arrive: a pose at the first sample, one at every multiple of `step` of
/// the length
///
///     ds² = |dx|² + (lever dφ)² + (drift dt)²,
///
/// and one at the last sample. Between samples the position follows a centripetal Catmull–Rom spline, which has no
/// cusps and no self-crossings within a segment [Catmull1974, Yuksel2011]. Time is a monotone cubic over the spline's
/// knots [Fritsch1980]. The rotation is a cumulative cubic in time [Kim1995], with rates from the parabola through
/// three samples. All are of third order. The result does not depend on the sampling rate beyond that order, nor on
/// whether samples come one by one or all at once. The spline looks one sample ahead. A sample whose time falls counts
/// as simultaneous with the one before; repeated samples are merged. Throws `Error` when the path needs more than
/// `max_poses`.
class Resampler {
  public:
    explicit Resampler(const ResampleOptions& options);
    /// Adds a sample; appends the poses that are known by now to `out`.
    void push(brush::Pose sample, std::vector<brush::Pose>& out);
    /// Ends the path: appends the remaining poses, the last one at the last sample.
    void finish(std::vector<brush::Pose>& out);
    /// Returns the position of each sample among the poses, in steps from the first pose, as far as poses are known.
    /// Pose k lies at k; the last one of `finish` lies at the last sample.
    std::vector<double> places() const;

  private:
    void emit_segment(const brush::Pose& before, const brush::Pose& after, std::vector<brush::Pose>& out);
    void emit(const brush::Pose& pose, std::vector<brush::Pose>& out);

    ResampleOptions options_;
    std::deque<brush::Pose, Recycler<brush::Pose>>
        window_;  ///< up to four samples; the segment in work is the middle one
    std::size_t emitted_ = 0;
    double since_last_ = 0;  ///< length since the last pose, metres
    bool has_before_ = false;
    std::vector<std::uint32_t> merged_;  ///< [samples] index into `places_`
    std::vector<double> places_;         ///< of samples that differ from the one before
};

/// Throws the `Error` of `Resampler` where the samples are farther apart than `max_poses` steps in all: before the
/// first pose is taken, and never for a path that `Resampler` takes. Cost: linear.
void check_path_length(std::span<const brush::Pose> poses, const ResampleOptions& options);

/// Resamples a whole path.
std::vector<brush::Pose> resample(std::span<const brush::Pose> poses, const ResampleOptions& options = {});

}  // namespace tuft::stroke
