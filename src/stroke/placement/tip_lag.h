#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "brush/preset/preset.h"
#include "core/files/disk_cache.h"
#include "core/geometry/types.h"
#include "stroke/gesture/tractrix.h"
#include "stroke/placement/placement.h"

/// \file
/// Tip lag: a dragged tuft paints behind the hand, and beside it under a leaning holder. Measured per brush, and
/// compensated in the hand's samples. Called by `Materials` and `hand_path`.
namespace tuft::stroke {

/// Change of a brush's tip lag by a lean of the holder and, of a brush that `has_lag_by_turn`, by the turn of its broad
/// side from the path, measured on steady strokes at a grid of leans, turns and depths. A node of the grid is measured
/// at its first use: 25 ms, of a flat 0.5 s, of a fan 1.5 s of computing, its depths side by side. Leans up to 0.05 rad
/// change nothing, as a hand does not hold a brush more upright; from 0.15 rad on the change is full. Of a brush that
/// `is_bent_across` every lean counts, from that of its make. Nodes in the cache are those that the same sources
/// measured of the same preset: the values are the same to the bit. Thread-safe.
///
/// An upright flat on its edge keeps its hair under it; turned by 20 degrees or more it lies down on its broad side and
/// trails twice as far. What a lean adds is measured on the edge and across, and eased from one to the other.
class TiltedTipLag {
  public:
    explicit TiltedTipLag(brush::Preset preset, DiskCache cache = {})
        : preset_(std::move(preset)), cache_(std::move(cache)) {}
    ~TiltedTipLag() {
        if (has_written_) cache_.trim();
    }
    TiltedTipLag(const TiltedTipLag&) = delete;
    TiltedTipLag& operator=(const TiltedTipLag&) = delete;

    /// Returns the additional displacement of the hand, metres ahead along the path and to its left, that puts the line
    /// onto the path. `lean`: radians along the path and to its left, up ∝ normal + tan(lean.x) ahead + tan(lean.y)
    /// left. `depth`: metres of the unbent tip below the surface. `turn`: radians of the ferrule's x from the path,
    /// anticlockwise; both faces are alike.
    Vec2 at(double depth, const Vec2& lean, double turn = 0);
    /// Returns the tip lag that `at` is the change from: upright, the broad side along the path; of a brush that
    /// `is_bent_across`, leaning as its make does, the broad side across. By depths up to the working depth: the
    /// distance from the foot of the holder's axis back to the widest place of the steady contact patch, which lies
    /// half a line's width behind its end (`brush::sweep_depth`). Measured at the first call: about 50 ms; of a fan 1.5
    /// s.
    const std::vector<TipLag>& as_held();

  private:
    static constexpr std::array kAlong{-0.8, -0.4, -0.2, 0.0, 0.2, 0.4, 0.8};
    static constexpr std::array kAcross{0.0, 0.4, 0.8};
    static constexpr std::array kTurns{0.0, 10.0, 20.0, 45.0, 90.0};      // degrees; hair falls over at 10 to 20
    static constexpr std::array kDepths{0.05, 0.15, 0.3, 0.5, 0.7, 1.0};  // of the working depth
    static constexpr std::size_t kEdge = 0, kBroad = kTurns.size() - 1, kUpright = 3;  // of `kTurns`; of `kAlong`

    template <class T, class Measure>
    std::vector<T> read_or_measure(std::string_view kind, std::span<const std::size_t> place, std::size_t n,
                                   const Measure& measure) const;
    std::vector<TipLag> measure_as_held();
    const std::vector<Vec2>& node(std::size_t i, std::size_t j, std::size_t turn);
    Vec2 of_node(std::size_t i, std::size_t j, std::size_t turn, double depth);
    Vec2 of_lean(double depth, const Vec2& lean, std::size_t turn);
    Vec2 change_by_lean(double depth, const Vec2& lean, std::size_t turn);
    Vec2 change_by_turn(double depth, double turn);

    brush::Preset preset_;
    DiskCache cache_;
    mutable std::atomic<bool> has_written_{false};  // to the cache
    std::mutex mutex_;                              // of `nodes_` while one is measured; measured ones do not change
    std::array<std::vector<Vec2>, kAlong.size() * kAcross.size() * kTurns.size()> nodes_;  // ahead and left by depth
    std::once_flag measured_;
    std::vector<TipLag> as_held_;
};

/// Returns the cache of the user's measured tip lags: `tuft/tip_lags` in $XDG_CACHE_HOME or ~/.cache, 1 MiB.
DiskCache shared_tip_lag_cache();

/// Returns the length of a table at a depth, metres: linear between its rows, and down to 0 at depth 0.
double tip_lag_length(std::span<const TipLag> table, double depth);

/// Returns the tip lag at one point of a path, metres to the right and down. `tilt` and `roll`: radians, as in
/// `SurfaceSample`; `ahead`: direction of the path in the same axes, up to 1 long. With `options.across` it is the tip
/// lag of the part of `ahead` that is across the broad side.
Vec2 tip_lag_at(const HolderOptions& options, double pressure, const Vec2& tilt, double roll, const Vec2& ahead);

/// Returns the tilt of a holder that leans as its make is held, radians towards right and down: by `options.lean`
/// towards `ahead` (as of `tip_lag_at`). With `options.across` it leans by the part of that across its broad side only,
/// and stands upright along its edge. A blade leans by the part along its broad side only.
Vec2 lean_of_make(const HolderOptions& options, double roll, const Vec2& ahead);

/// Returns the length of the string on which a point is dragged whose direction a make leans in, metres: 0.3 lengths of
/// the tuft.
double lean_string(const HolderOptions& options);

/// Leans the holder of a flat trace as its make is held (`lean_of_make`) where the device gave no tilt at all. Ahead is
/// the direction of a point dragged behind the trace on a `lean_string`, taut from the first touch; of a dot, with
/// `options.across`, that of the ferrule's y.
StrokeSamples lean_holder(StrokeSamples trace, const HolderOptions& options);

/// Turn of a wide ferrule from its path as its hair has followed it: hair falls over from its edge to its broad side
/// while it is dragged by about its lag. With Δ what is left of the turn, mod π, and s the path's length,
/// dΔ/ds = −Δ/λ, λ half the tuft's length. Hair that lies stays down: where the turn φ comes back from the broadest α
/// to the edge, and past it to −α, the hair goes round by its broad side, at π/2 − (π/2 − α) φ/α. A flat at one roll so
/// goes round a curve without standing up where its line is thin.
class FollowedTurn {
  public:
    /// `turn`: radians, in which the hair lies at first.
    FollowedTurn(double tuft_length, double turn);
    /// Returns the turn in which the hair lies, radians, mod π.
    double turn() const;
    /// Returns the turn in which the hair lies after a further `gone` metres at a ferrule turned by `turn` radians.
    double follow(double turn, double gone);
    /// The hair is in the air: it does not lie any more.
    void lift() { broadest_ = 0; }

  private:
    void fall_over();

    double lambda_, turn_;
    double broadest_ = 0;  // radians, turn from the edge of hair that came to lie; 0: it did not
};

/// Speed of setting down, ahead and down together: over the speed of the trace, and the least speed of the trace that
/// is taken for it, m/s.
inline constexpr double kSetDownPace = 1.5, kSlowestSetDown = 0.02;
inline constexpr double kHoverTime = 0.05;  ///< seconds of the tip between the surface and `hover`

/// Adds samples to a flat trace of a wide ferrule where the path turns back, so that `compensate_tip_lag` lifts and
/// turns the hair there evenly, however far apart the samples lie. Called first; other traces do not change.
StrokeSamples add_turn_samples(const StrokeSamples& trace, const HolderOptions& options);

/// Compensates the tip lag of a flat trace: moves its samples ahead along the path by the tip lag at their depth and
/// lean, so that the ink lies where the trace was.
///
/// Ahead is the direction of a point dragged behind the trace on a string of length `tip_lag_turn` (a tractrix), taut
/// from the first touch in the initial direction of the trace. A dot is set as a stroke begins: the tip touches, and
/// the hand goes on as it presses, towards the side that the holder leans to, or to the right and down; of a wide
/// ferrule across its broad side, of a blade along it. A sponge is pressed straight down. Then its middle lies where
/// the trace was (`options.dot_place`), whichever way the surface leans. Pressed down plumb the hair would fall to any
/// side. Where the path reverses, the tip lag passes through zero. A wide ferrule is lifted there and set down to its
/// other side, with the ink up to the place where the path turns (turn_back.h); along a stencil it is kept
/// down. A trace that begins pressed gets samples before its first one, at the same place and earlier in time, whose
/// pressure rises to the first; the holder moves at `kSetDownPace` times the trace's speed, so that the tip touches
/// first and trails. It leans ahead by 0.12 rad more, which fades over 4 `tip_lag_turn`; not where the lean of its make
/// already tilts it ahead by more than that. A blade leans so at any landing, over `blade_landing` at least. It turns
/// as late as the string (`BladeRoll`).
///
/// Where a toe lifts, the tip lag is bounded by `shorten_tip_lag_at_end` (turn_back.h).
///
/// A holder upright to 0.05 rad sets the brush down plumb and reaches its lean within 0.3 lengths of the tuft.
///
/// The hand's speed bounds the holder's. Over a surface of curvature κ, while the tuft is pressed,
///
///     |v_holder| ≤ (1 + tip_lag / tip_lag_turn + 2 κ L + 1.5) |v_path| + 4 (|depth'| + L |tilt'| + L |roll'|),
///
/// with L the tuft's length; of a brush that `has_lag_by_turn` 6 |v_path| more, as its hair falls over within L / 2.
/// Above the surface it is at most `hover / kHoverTime` faster than the hand. Where a turn lifts the hair (turn_back.h)
/// the holder goes up, over and down on 0.6 to 3 `tip_lag_turn` of path: a flat's 27 times as fast as the hand in a
/// reversal, 36 times at a corner of 115 to 120°.
StrokeSamples compensate_tip_lag(StrokeSamples trace, const HolderOptions& options);

/// Adds samples after a trace that ends with pressure 0, in which the tip rises to `hover`. Other traces do not change.
StrokeSamples lift_off(StrokeSamples trace, const HolderOptions& options);

/// Returns the depth of the unbent tip below the surface at each sample, metres. [samples] Pressed: pressure · working
/// depth. Lifted: −min(hover, max(d, t hover / kHoverTime)), with d and t the path length and time from the nearest
/// pressed sample. `Sample` has `position`, `pressure` and `time`.
template <class Sample>
std::vector<double> tip_depths(std::span<const Sample> samples, const HolderOptions& options) {
    const std::vector<double> along = travelled(samples);
    std::vector<double> depths;
    depths.reserve(samples.size());
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
