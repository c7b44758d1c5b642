#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"
#include "stroke/gesture/tractrix.h"
#include "stroke/placement/placement.h"

/// How far the hand runs ahead of the ink.
namespace tuft::stroke {

/// The tip_lag of a brush at depths up to its working depth: from the foot of the holder's
/// axis back to the widest place of the steady contact patch, which lies half a line's
/// width behind its end (`brush::sweep_depth`; takes some 50 ms).
std::vector<TipLag> measure_tip_lag(const brush::Preset& preset);

/// What a lean of the holder adds to the tip_lag of one brush (see `measure_tip_lag`), from steady strokes of
/// it at a grid of leans and depths, made as they are asked for (some 25 ms for each of the grid's
/// leans). Up to 0.05 rad, as a hand holds a brush upright, it adds nothing; from 0.15 rad all.
class TiltedTipLag {
  public:
    explicit TiltedTipLag(brush::Preset preset) : preset_(std::move(preset)) {}

    /// Metres ahead along the path and to its left that the hand must be further than that of an upright holder,
    /// so that the line lies where the path is. `lean`: radians along the path and to its left, the
    /// axis' up ∝ normal + tan(lean.x) ahead + tan(lean.y) left. `depth`: metres of the unbent tip
    /// below the surface.
    Vec2 at(double depth, const Vec2& lean);

  private:
    static constexpr std::array kAlong{-0.8, -0.4, -0.2, 0.0, 0.2, 0.4, 0.8};
    static constexpr std::array kAcross{0.0, 0.4, 0.8};
    static constexpr std::array kDepths{0.05, 0.15, 0.3, 0.5, 0.7, 1.0};  // of the working depth

    const std::vector<Vec2>& node(std::size_t i, std::size_t j);
    Vec2 of_node(std::size_t i, std::size_t j, double depth);

    brush::Preset preset_;
    std::array<std::vector<Vec2>, kAlong.size() * kAcross.size()> nodes_;  // ahead and left by depth
};

/// The tip_lag at one place of a path, metres to the right and down in the axes of `tilt` (radians, as in
/// SurfaceSample). `ahead`: unit, the path's direction in them.
Vec2 lead_of(const HolderOptions& options, double pressure, const Vec2& tilt, const Vec2& ahead);

/// Times the pace of the trace at which its hand sets the brush down, ahead and down together, and the
/// least pace that is taken for that, m/s.
inline constexpr double kSetDownPace = 1.5, kSlowestSetDown = 0.02;
inline constexpr double kHoverTime = 0.05;  ///< seconds in which the tip goes between touch and `hover`

/// A dragged tuft paints behind the hand, and under a leaning holder aside of it. Moves the samples
/// of a flat trace ahead along the path by the tip_lag for their depth, and by what their lean
/// adds, so that the ink will lie where the trace was. The
/// direction is that of a point dragged behind the trace on a string of `tip_lag_turn` (a
/// tractrix), taut from the first touch in the direction in which the trace sets out;
/// where the path reverses, the tip_lag passes through zero. A trace that begins pressed gets samples
/// before its first, at the same place and earlier in time, in which the pressure rises to it, the holder moving at
/// `kSetDownPace` times the trace's pace: the tip touches first and trails then.
/// A holder that is upright but for 0.05 rad sets the brush down plumb and comes to that lean within 0.3 lengths of the
/// tuft.
/// The hand's speed bounds the holder's. Over a surface of curvature κ, while the tuft is pressed,
///
///     |v_holder| ≤ (1 + tip_lag / tip_lag_turn + 2 κ L + 1.5) |v_path| + 4 (|depth'| + L |tilt'|),
///
/// L the tuft's length; and at most `hover / kHoverTime` faster than the hand while it is not.
Trace lead_hand(Trace trace, const HolderOptions& options);

/// A trace that ends with the pressure 0 gets samples after its last, in which the hand takes the tip
/// up to `hover`; others stay.
Trace lift_off(Trace trace, const HolderOptions& options);

/// Metres of the unbent tip below the surface at each of the samples, which have `position`, `pressure`
/// and `time`: pressure · working depth; where the pressure is 0, minus the height to which the hand has lifted
/// it: as far as it goes along the path from the nearest pressed sample, or `hover` in `kHoverTime`, what is more,
/// up to `hover`.
template <class Sample>
std::vector<double> tip_depths(std::span<const Sample> samples, const HolderOptions& options) {
    const std::vector<double> along = travelled(samples);
    std::vector<double> depths;
    for (const Sample& s : samples)
        depths.push_back(s.pressure > 0 ? std::min(s.pressure, 1.0) * options.working_depth : -options.hover);
    const auto settle = [&](std::size_t i, std::optional<std::size_t>& pressed) {
        if (samples[i].pressure > 0) pressed = i;
        if (!pressed || pressed == i) return;
        const double time = std::abs(samples[i].time - samples[*pressed].time);
        const double height = std::max(std::abs(along[i] - along[*pressed]), time / kHoverTime * options.hover);
        depths[i] = std::max(depths[i], -height);
    };
    std::optional<std::size_t> before, after;
    for (std::size_t i = 0; i < samples.size(); ++i) settle(i, before);
    for (std::size_t i = samples.size(); i-- > 0;) settle(i, after);
    return depths;
}

}  // namespace tuft::stroke
