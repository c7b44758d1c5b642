#include "stroke/placement/tip_lag.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "brush/calibration/sweep.h"
#include "core/ease.h"
#include "core/system/build_facts.h"
#include "core/system/parallel.h"
#include "stroke/gesture/mix_samples.h"
#include "stroke/gesture/roll.h"
#include "stroke/gesture/tractrix.h"
#include "stroke/placement/tip_lag_code.h"
#include "stroke/placement/turn_back.h"

namespace tuft::stroke {
namespace {

constexpr double kLeansNot = 0.05, kLeans = 0.15;  // radians
constexpr double kOnGrid = 1e-9;                   // of a cell
constexpr double kFallsOver = 0.5;  // of the tuft's length, of travel in which hair follows a turn of a wide ferrule
constexpr double kFallen = 0.25 * std::numbers::pi;  // of a turn from the edge, from which on hair lies
constexpr double kPlumb = 0.3;  // of the tuft's length, of travel over which an upright holder comes to its lean

/// Of the working depth, at which the tip lag as held is measured.
constexpr std::array kHeldDepths{0.05, 0.15, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

/// Whether what a cache held may be a tip lag: metres.
template <class T>
bool is_plausible(const T& value) {
    const auto is_length = [](double x) { return std::abs(x) < 1; };
    if constexpr (std::is_same_v<T, TipLag>)
        return is_length(value.depth) && is_length(value.length);
    else
        return is_length(value.x) && is_length(value.y);
}

/// Where x lies between the grid's values, held to its ends.
template <std::size_t N>
std::pair<std::size_t, double> cell_of(const std::array<double, N>& grid, double x) {
    std::size_t i = 0;
    while (i + 2 < N && x >= grid[i + 1]) ++i;
    const double f = std::clamp((x - grid[i]) / (grid[i + 1] - grid[i]), 0.0, 1.0);
    return {i, f < kOnGrid ? 0 : f > 1 - kOnGrid ? 1 : f};  // a value of the grid needs no other
}

}  // namespace

double tip_lag_length(std::span<const TipLag> table, double depth) {
    if (table.empty()) return 0;
    if (depth <= table.front().depth)
        return table.front().depth > 0 ? table.front().length * depth / table.front().depth : table.front().length;
    for (std::size_t i = 1; i < table.size(); ++i) {
        const TipLag &a = table[i - 1], &b = table[i];
        if (depth <= b.depth) return a.length + (b.length - a.length) * (depth - a.depth) / (b.depth - a.depth);
    }
    return table.back().length;
}

template <class T, class Measure>
std::vector<T> TiltedTipLag::read_or_measure(std::string_view kind, std::span<const std::size_t> place, std::size_t n,
                                             const Measure& measure) const {
    CacheKey key("tip lag 1");
    key.add_text(kTipLagCode);
    const BuildFacts& facts = build_facts();
    key.add_text(facts.compiler);
    key.add_text(facts.build_type);
    brush::add_to(key, preset_);
    key.add_text(kind);
    key.add_array(place);
    std::vector<T> values;
    const auto take = [&](CacheReader& entry) {
        std::vector<T> found = entry.get<T>();
        if (found.size() != n || !std::ranges::all_of(found, is_plausible<T>)) CacheReader::fail();
        values = std::move(found);
    };
    if (cache_.read(key, take)) return values;
    values = measure();
    if (cache_.write(key, [&](CacheWriter& entry) { entry.put(values); })) has_written_ = true;
    return values;
}

const std::vector<Vec2>& TiltedTipLag::node(std::size_t i, std::size_t j, std::size_t turn) {
    const std::lock_guard lock(mutex_);
    std::vector<Vec2>& tip_lags = nodes_[(turn * kAlong.size() + i) * kAcross.size() + j];
    if (!tip_lags.empty()) return tip_lags;
    return tip_lags = read_or_measure<Vec2>("node", std::array{i, j, turn}, kDepths.size(), [&] {
               const double roll = glm::radians(kTurns[turn]);
               std::vector<Vec2> measured(kDepths.size());
               parallel_for(measured.size(), 1, [&](std::size_t begin, std::size_t end) {
                   for (std::size_t k = begin; k < end; ++k) {
                       const brush::LinePlace place = brush::line_place(preset_, kDepths[k] * working_depth(preset_),
                                                                        {kAlong[i], kAcross[j]}, roll);
                       measured[k] = {place.behind, -place.aside};
                   }
               });
               return measured;
           });
}

Vec2 TiltedTipLag::of_node(std::size_t i, std::size_t j, std::size_t turn, double depth) {
    const double part = depth / working_depth(preset_);
    const std::vector<Vec2>& tip_lags = node(i, j, turn);
    if (part < kDepths[0]) return part / kDepths[0] * tip_lags[0];
    const auto [k, f] = cell_of(kDepths, part);
    return glm::mix(tip_lags[k], tip_lags[k + 1], f);
}

Vec2 TiltedTipLag::of_lean(double depth, const Vec2& lean, std::size_t turn) {
    const auto [i, f] = cell_of(kAlong, lean.x);
    const auto [j, g] = cell_of(kAcross, std::abs(lean.y));
    Vec2 sum{0};
    for (const auto& [a, wa] : {std::pair{i, 1 - f}, std::pair{i + 1, f}})
        for (const auto& [b, wb] : {std::pair{j, 1 - g}, std::pair{j + 1, g}})
            if (wa * wb > 0) sum += wa * wb * of_node(a, b, turn, depth);
    // Leaning to the other side is the mirror image.
    if (lean.y < 0) sum.y = -sum.y;
    return sum;
}

Vec2 TiltedTipLag::change_by_lean(double depth, const Vec2& lean, std::size_t turn) {
    const double part = smooth_step((glm::length(lean) - kLeansNot) / (kLeans - kLeansNot));
    if (part <= 0) return Vec2{0};
    return part * (of_lean(depth, lean, turn) - of_lean(depth, Vec2{0}, turn));
}

Vec2 TiltedTipLag::change_by_turn(double depth, double turn) {
    const auto [k, f] = cell_of(kTurns, turn);
    const Vec2 on_edge{tip_lag_length(as_held(), depth), 0};
    Vec2 sum{0};
    for (const auto& [t, w] : {std::pair{k, 1 - f}, std::pair{k + 1, f}})
        if (w > 0 && t != kEdge) sum += w * (of_node(kUpright, 0, t, depth) - on_edge);
    return sum;
}

Vec2 TiltedTipLag::at(double depth, const Vec2& lean, double turn) {
    if (depth <= 0) return Vec2{0};
    if (const Vec2 held{preset_.lean, 0}; is_bent_across(preset_)) {
        const bool is_held = glm::distance(lean, held) < kOnGrid;
        return is_held ? Vec2{0} : of_lean(depth, lean, kBroad) - of_lean(depth, held, kBroad);
    }
    if (!has_lag_by_turn(preset_)) return change_by_lean(depth, lean, kEdge);
    // Turned to the other side is the mirror image.
    const double folded = std::remainder(turn, std::numbers::pi), side = folded < 0 ? -1 : 1;
    const double degrees = glm::degrees(std::abs(folded)), broad = smooth_step((degrees - kTurns[1]) / 35);
    const Vec2 mirrored{lean.x, side * lean.y};
    Vec2 sum = change_by_turn(depth, degrees);
    if (broad < 1) sum += (1 - broad) * change_by_lean(depth, mirrored, kEdge);
    if (broad > 0) sum += broad * change_by_lean(depth, mirrored, kBroad);
    return {sum.x, side * sum.y};
}

std::vector<TipLag> TiltedTipLag::measure_as_held() {
    std::vector<TipLag> held{{0, 0}};
    if (is_bent_across(preset_)) {
        for (const double part : kDepths) {
            const double depth = part * working_depth(preset_);
            held.push_back({depth, of_lean(depth, {preset_.lean, 0}, kBroad).x});
        }
        return held;
    }
    std::vector<double> depths;
    depths.reserve(kHeldDepths.size());
    for (const double part : kHeldDepths) depths.push_back(part * working_depth(preset_));
    // An edge is set down with its middle on the path.
    const auto half = has_lag_by_turn(preset_) ? &brush::SweepRow::drag : &brush::SweepRow::width;
    for (const brush::SweepRow& row : brush::sweep_depth(preset_, depths))
        held.push_back({row.depth, std::max(0.0, row.offset + 0.5 * row.*half)});
    return held;
}

const std::vector<TipLag>& TiltedTipLag::as_held() {
    std::call_once(measured_, [&] {
        const std::size_t n = 1 + (is_bent_across(preset_) ? kDepths.size() : kHeldDepths.size());
        as_held_ = read_or_measure<TipLag>("as held", {}, n, [&] { return measure_as_held(); });
    });
    return as_held_;
}

DiskCache shared_tip_lag_cache() {
    return DiskCache(cache_folder("tip_lags"), std::uintmax_t{1} << 20);
}

FollowedTurn::FollowedTurn(double tuft_length, double turn) : lambda_(kFallsOver * tuft_length), turn_(turn) {
    fall_over();
}

void FollowedTurn::fall_over() {
    const double from_edge = std::abs(std::remainder(turn_, std::numbers::pi));
    if (from_edge >= kFallen) broadest_ = std::max(broadest_, from_edge);
}

double FollowedTurn::turn() const {
    const double from_edge = std::remainder(turn_, std::numbers::pi), broad = 0.5 * std::numbers::pi;
    if (std::abs(from_edge) >= broadest_) return turn_;
    return broad - (broad - broadest_) * from_edge / broadest_;
}

double FollowedTurn::follow(double turn, double gone) {
    const double left = std::remainder(turn - turn_, std::numbers::pi);
    turn_ += left * -std::expm1(-gone / lambda_);
    fall_over();
    return this->turn();
}

namespace {

double depth_of(const HolderOptions& options, double pressure) {
    return std::clamp(pressure, 0.0, 1.0) * options.working_depth;
}

/// What a lean and a turn add to the tip lag, `along` the path; that is 1 long where the string is taut.
Vec2 tilted_tip_lag(const HolderOptions& options, const Vec2& tilt, double roll, double depth, const Vec2& along) {
    const double taut = glm::length(along), lean = glm::length(tilt);
    // Across the broad side the lag without a change is that of a holder that leans as its make does.
    if (taut < 1e-9 || (lean <= 0 && !options.across && !options.turned)) return Vec2{0};
    const Vec2 ahead = along / taut, left{ahead.y, -ahead.x};  // y of a trace is down
    const Vec2 held = lean > 0 ? tilt * (std::min(lean, options.max_tilt) / lean) : Vec2{0};
    const Vec2 up{std::tan(held.x), std::tan(held.y)};
    const double turn = roll - std::atan2(-ahead.y, ahead.x);
    const Vec2 more =
        options.tip_lag_change(depth, {std::atan(glm::dot(up, ahead)), std::atan(glm::dot(up, left))}, turn);
    return taut * (more.x * ahead + more.y * left);
}

/// Of the ferrule's y, unit, to the right and down.
Vec2 across_of(double roll) {
    return {-std::sin(roll), -std::cos(roll)};
}

/// The part of a direction that the hair bends against.
Vec2 bent_along(const HolderOptions& options, double roll, const Vec2& ahead) {
    return options.across ? glm::dot(ahead, across_of(roll)) * across_of(roll) : ahead;
}

}  // namespace

Vec2 tip_lag_at(const HolderOptions& options, double pressure, const Vec2& tilt, double roll, const Vec2& ahead) {
    const double depth = depth_of(options, pressure);
    const Vec2 along = bent_along(options, roll, ahead);
    const Vec2 tip_lag = tip_lag_length(options.tip_lag, depth) * along;
    return options.tip_lag_change ? tip_lag + tilted_tip_lag(options, tilt, roll, depth, along) : tip_lag;
}

double lean_string(const HolderOptions& options) {
    return kPlumb * options.tuft_length;
}

Vec2 lean_of_make(const HolderOptions& options, double roll, const Vec2& ahead) {
    const double taut = glm::length(ahead);
    if (!(taut > 1e-9)) return Vec2{0};
    const Vec2 broad{std::cos(roll), -std::sin(roll)};
    const Vec2 to = options.blade_landing > 0 ? glm::dot(ahead, broad) * broad : bent_along(options, roll, ahead);
    return glm::atan(std::tan(taut * options.lean) / taut * to);
}

namespace {

constexpr double kTouch = 1e-6;   // of the pressure: the tip is down from the first sample
constexpr double kLean = 0.12;    // radians by which the holder tips ahead where it sets down pressed
constexpr double kLeanTurns = 4;  // over so many `tip_lag_turn` of travel it comes upright
constexpr double kAiming = 0.5;   // of `tip_lag_turn`: distance from the first sample at which its direction is taken

/// Direction in which a trace sets out: that of the place where it first is `away` metres from its
/// first sample. Zero where it never is.
Vec2 first_direction(std::span<const StrokeSample> samples, double away) {
    const Vec2 first(samples[0].position);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const Vec2 a = Vec2(samples[i - 1].position) - first, b = Vec2(samples[i].position) - first, chord = b - a;
        if (glm::length(b) < away) continue;
        // |a + t chord| = away
        const double aa = glm::dot(chord, chord), ab = glm::dot(a, chord), c = glm::dot(a, a) - away * away;
        const double t = aa > 0 ? (-ab + std::sqrt(std::max(0.0, ab * ab - aa * c))) / aa : 1;
        return glm::normalize(a + std::clamp(t, 0.0, 1.0) * chord);
    }
    return Vec2{0};
}

/// Speed over the first `reach` metres of path; 0 where it does not move.
double first_pace(std::span<const StrokeSample> samples, double reach) {
    double gone = 0, taken = 0;
    for (std::size_t i = 1; i < samples.size() && gone < reach; ++i) {
        const double piece = glm::distance(samples[i].position, samples[i - 1].position);
        const double part = piece > 0 ? std::min(1.0, (reach - gone) / piece) : 1;
        gone += part * piece;
        taken += part * (samples[i].time - samples[i - 1].time);
    }
    return gone > 0 && taken > 0 ? gone / taken : 0;
}

// The hand of a trace that begins pressed goes ahead by the tip lag while it presses: the tip touches where the trace
// begins and trails from there. Set down from above it would bend to any side, and a tuft that is
// pushed before the hand turns over only after centimetres.
bool set_down(StrokeSamples& trace, const HolderOptions& options, const Vec2& ahead, bool dot) {
    constexpr double kStep = 2.5e-4;  // metres between samples, less where they would be few
    constexpr double kFewest = 8, kMost = 100;
    constexpr double kPaceLength = 3e-3;  // metres over which the pace is taken
    constexpr int kPieces = 64;           // of the press, whose length is measured
    const StrokeSample first = trace.samples.front();
    if (!(tip_lag_length(options.tip_lag, depth_of(options, first.pressure)) > 0)) return false;
    const double pace = first_pace(trace.samples, kPaceLength);
    if (!(pace > 0) && (!dot || (ahead == Vec2(0) && !options.foam))) return false;
    // Metres that the foot of the holder goes, ahead and down, up to each pressure.
    std::vector<double> gone{0};
    Vec3 foot{0};
    for (int i = 1; i <= kPieces; ++i) {
        const double pressure = first.pressure * i / kPieces;
        const Vec3 next(tip_lag_at(options, pressure, first.tilt, first.roll, ahead), -depth_of(options, pressure));
        gone.push_back(gone.back() + glm::distance(next, foot));
        foot = next;
    }
    const double duration = gone.back() / (kSetDownPace * std::max(pace, kSlowestSetDown));
    const int n = static_cast<int>(std::clamp(std::ceil(gone.back() / kStep), kFewest, kMost));
    std::vector<StrokeSample> added(static_cast<std::size_t>(n), first);
    std::size_t k = 1;
    for (int i = 0; i < n; ++i) {
        const double part = static_cast<double>(i) / n, at = part * gone.back();
        while (k < kPieces && gone[k] < at) ++k;
        const double span = gone[k] - gone[k - 1];
        StrokeSample& s = added[static_cast<std::size_t>(i)];
        const double pressed = (static_cast<double>(k - 1) + (span > 0 ? (at - gone[k - 1]) / span : 0)) / kPieces;
        s.pressure = first.pressure * std::max(pressed, kTouch);
        s.time = first.time - (1 - part) * duration;
    }
    trace.samples.insert(trace.samples.begin(), added.begin(), added.end());
    return true;
}

// Surface that differs from the levelled one leans the tuft, and a tuft that leans tip ahead is pushed. The holder
// is tipped ahead by more than that until the tuft trails.
void lean_ahead(StrokeSamples& trace, const HolderOptions& options, const Vec2& ahead) {
    const double until = std::max(kLeanTurns * options.tip_lag_turn, options.blade_landing);
    double gone = 0;
    for (std::size_t i = 0; i < trace.samples.size() && gone < until; ++i) {
        StrokeSample& s = trace.samples[i];
        s.tilt += kLean * (1 - smooth_step(gone / until)) * ahead;
        if (i + 1 < trace.samples.size()) gone += glm::length(trace.samples[i + 1].position - s.position);
    }
}

// A hand that holds the brush upright, give or take a little, sets it down plumb: hair that touches ahead of the hand
// by a lean that nobody meant would be pushed, and turn over late. The lean comes as the hair is drawn to one side.
void set_down_plumb(StrokeSamples& trace, const HolderOptions& options) {
    const double whole = kPlumb * options.tuft_length;
    double along = 0;
    for (std::size_t i = 0; i < trace.samples.size() && along < whole; ++i) {
        StrokeSample& s = trace.samples[i];
        if (i > 0) along += glm::length(s.position - trace.samples[i - 1].position);
        const double meant = smooth_step((glm::length(s.tilt) - kLeansNot) / (kLeans - kLeansNot));
        s.tilt *= std::lerp(smooth_step(along / whole), 1.0, meant);
    }
}

/// Of a direction of the path, anticlockwise, radians.
double angle_of(const Vec2& ahead) {
    return std::atan2(-ahead.y, ahead.x);
}

/// Direction of a hand that sets a dot: towards the side that the holder leans to; upright, of a wide ferrule y, of a
/// round one to the right and down, as a right hand goes; of a blade, which is led along its line, x or −x. Zero for a
/// sponge, whose pores a hand that goes on would smear.
Vec2 dot_direction(const StrokeSample& first, const HolderOptions& options) {
    if (options.foam || options.tip_lag.empty()) return Vec2{0};
    if (options.blade_landing > 0) {
        const Vec2 along{std::cos(first.roll), -std::sin(first.roll)};
        return glm::dot(first.tilt, along) < 0 ? -along : along;
    }
    if (options.across || options.turned) {
        const Vec2 across = across_of(first.roll);
        return glm::dot(first.tilt, across) < 0 ? -across : across;
    }
    return glm::length(first.tilt) > kLeansNot ? glm::normalize(first.tilt) : Vec2(std::numbers::sqrt2 / 2);
}

constexpr double kCutsOfString = 6;  // pieces of its length, into which the path is cut where a string is slack
/// Whether the hand lifts a brush where a trace turns back. Along a stencil hair is pushed onto it, so that the ink
/// reaches its edge.
bool is_lifted_at_turns(const StrokeSamples& trace, const HolderOptions& options) {
    return trace.stencil.empty() && is_lifted_at_turns(options);
}

constexpr double kOtherSide = 0.5;  // sine of the path's turn to the broad side from which on hair lies on that side
constexpr double kComesOver =
    0.5;  // of the tuft's length, path before and after it stands up within which it is lifted
constexpr double kJustTouches = 0.04;  // of the pressure, with which it stands up

/// Direction in which a trace sets out; zero of a dot, which does not leave its first place.
Vec2 trace_direction(std::span<const StrokeSample> samples, const HolderOptions& options) {
    return first_direction(samples, kAiming * options.tip_lag_turn);
}
bool is_dot(std::span<const StrokeSample> samples, const HolderOptions& options) {
    return trace_direction(samples, options) == Vec2(0);
}

/// `ahead`: direction in which the trace sets out.
std::vector<Turning> turnings_of(const StrokeSamples& trace, const HolderOptions& options, const Vec2& ahead) {
    const bool lifted =
        !options.tip_lag.empty() && is_lifted_at_turns(trace, options) && !is_dot(trace.samples, options);
    return find_turnings(trace.samples, options.tip_lag_turn, ahead, lifted);
}

/// Lifts hair that bends across its broad side only where it comes over from one side to the other, in a turn of the
/// path, until it just touches: pressed, its flanks stay on the old side while its middle goes on. `ahead`: as in
/// `turnings_of`.
void lift_to_other_side(StrokeSamples& trace, const HolderOptions& options, const Vec2& ahead) {
    const std::vector<double> along = travelled<StrokeSample>(trace.samples);
    std::vector<double> side;  // sine, by sample
    Vec2 before(trace.samples.front().position), dragged = before - options.tip_lag_turn * ahead;
    for (const StrokeSample& s : trace.samples) {
        const Vec2 p(s.position);
        dragged = drag_string(dragged, before, p, options.tip_lag_turn);
        before = p;
        const Vec2 towards = p - dragged;
        const double taut = glm::length(towards);
        side.push_back(taut > 0 ? glm::dot(towards, across_of(s.roll)) / taut : 0);
    }
    std::size_t lies = side.size();  // last sample that lies on a side
    for (std::size_t i = 0; i < side.size(); ++i) {
        if (std::abs(side[i]) < kOtherSide) continue;
        if (lies < i && side[lies] * side[i] < 0) {
            std::size_t stands = lies;
            while (side[stands] * side[lies] > 0) ++stands;
            for (std::size_t k = lies; k < i; ++k) {
                const double off = std::abs(along[k] - along[stands]) / (kComesOver * options.tuft_length);
                const double part = std::max(smooth_step(std::abs(side[k]) / kOtherSide), smooth_step(off));
                trace.samples[k].pressure *= std::lerp(kJustTouches, 1.0, part);
            }
        }
        lies = i;
    }
}

/// Direction in which a hand sets out.
Vec2 initial_direction(std::span<const StrokeSample> samples, const HolderOptions& options) {
    const Vec2 ahead = trace_direction(samples, options);
    return ahead != Vec2(0) ? ahead : dot_direction(samples.front(), options);
}

}  // namespace

StrokeSamples lean_holder(StrokeSamples trace, const HolderOptions& options) {
    if (!(options.lean > 0) || !trace.flat || trace.samples.empty()) return trace;
    if (std::ranges::any_of(trace.samples, [](const StrokeSample& s) { return s.tilt != Vec2(0); })) return trace;
    const double string = lean_string(options);
    const Vec2 ahead = initial_direction(trace.samples, options);
    const std::vector<Turning> turning = turnings_of(trace, options, ahead);
    Vec2 before(trace.samples.front().position), dragged = before - string * ahead;
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        StrokeSample& s = trace.samples[i];
        const Vec2 p(s.position);
        dragged = drag_string(dragged, before, p, string);
        before = p;
        // Hair that is lifted is set down leaning to its other side.
        const Turning& turn = turning[i];
        const double taut = glm::length(turn.towards);
        if (turn.lift.back >= 1 && taut < turn.lift.air) dragged = p - string * turn.towards;
        s.tilt =
            lean_of_make(options, s.roll, glm::mix((p - dragged) / string, turn.towards, turn.lift.leans_over(taut)));
    }
    return trace;
}

StrokeSamples add_turn_samples(const StrokeSamples& trace, const HolderOptions& options) {
    if (options.tip_lag.empty() || trace.samples.empty() || !trace.flat || !is_lifted_at_turns(trace, options))
        return trace;
    if (is_dot(trace.samples, options)) return trace;
    const Vec2 ahead = initial_direction(trace.samples, options);
    StrokeSamples out = trace;
    out.samples.clear();
    const double string = options.tip_lag_turn;
    Vec2 before(trace.samples.front().position), dragged = before - string * ahead;
    for (const StrokeSample& s : trace.samples) {
        const Vec2 p(s.position), motion = p - before, taut = before - dragged;
        const double gone = glm::length(motion);
        const bool slack = glm::dot(taut, motion) < 0 || glm::length(taut) < (1 - 1e-9) * string;
        // Within two strings of its length it is taut again.
        const int n = slack ? static_cast<int>(std::ceil(kCutsOfString * std::min(gone / string, 2.0))) : 0;
        const StrokeSample from = out.samples.empty() ? s : out.samples.back();
        for (int i = 1; i <= n && i * string < kCutsOfString * gone; ++i)
            out.samples.push_back(mix_samples(from, s, i * string / (kCutsOfString * gone)));
        dragged = drag_string(dragged, before, p, string);
        before = p;
        out.samples.push_back(s);
    }
    return out;
}

StrokeSamples compensate_tip_lag(StrokeSamples trace, const HolderOptions& options) {
    if (options.tip_lag.empty() || trace.samples.empty() || !trace.flat) return trace;
    // The hand knows where it is going to start: the string is taut from the first touch.
    const Vec2 first(trace.samples.front().position);
    const Vec2 ahead = initial_direction(trace.samples, options);
    const bool dot = is_dot(trace.samples, options);
    const Vec2 off = dot && options.dot_place ? options.dot_place(trace) : Vec2{0};
    if (!dot && options.across && trace.stencil.empty()) lift_to_other_side(trace, options, ahead);
    const bool pressed = set_down(trace, options, ahead, dot);
    set_down_plumb(trace, options);
    // Over a convex surface a blade's point meets a surface that falls ahead of it, however softly it lands: it would
    // slide on ahead of the hand and fall to its side.
    const bool leans = options.lean > kLean && glm::dot(trace.samples.front().tilt, ahead) > kLean;
    if ((pressed || dot || options.blade_landing > 0) && ahead != Vec2(0) && !leans) lean_ahead(trace, options, ahead);
    Vec2 before = first;
    FollowedTurn turn(options.tuft_length, trace.samples.front().roll - angle_of(ahead));
    BladeRoll blade(options.tip_lag_turn, trace.samples.front().roll);
    const double turn_leans = kLeanTurns * options.tip_lag_turn;
    double since_turn = 1e9, over = 0;  // metres; how much it turned back there
    const std::vector<Turning> turning = turnings_of(trace, options, ahead);
    std::vector<TipLagSample> lags(trace.samples.size());
    double along = 0;
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        StrokeSample& s = trace.samples[i];
        const Vec2 p(s.position);
        const auto& [string, lift] = turning[i];
        const double taut = glm::length(string), gone = glm::distance(p, before);
        Vec2 towards = string;
        since_turn += gone;
        if (lift.back > 0 && taut < 1 - 1e-9) {
            s.pressure *= lift.pressed(taut);
            towards = glm::mix(string, taut > 1e-9 ? string / taut : Vec2{0}, lift.back);
            if (taut < lift.air) since_turn = 0, over = lift.back;
        }
        if (since_turn < turn_leans && !(options.lean > kLean))
            s.tilt += over * kLean * (1 - smooth_step(since_turn / turn_leans)) * towards;
        if (options.blade_landing > 0) {
            blade.follow(s.roll, gone);
            s.roll = blade.roll();
        }
        const double turned = turn.follow(s.roll - angle_of(towards), gone);
        const double roll = options.turned ? turned + angle_of(towards) : s.roll;
        before = p;
        along += gone;
        const Vec2 tip_lag = tip_lag_at(options, s.pressure, s.tilt, roll, towards);
        lags[i] = {towards, along, depth_of(options, s.pressure), s.roll - angle_of(towards), tip_lag};
        if (!(s.pressure > 0)) turn.lift();
    }
    if (!dot) shorten_tip_lag_at_end(lags, options);
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        Vec3& position = trace.samples[i].position;
        position = Vec3(Vec2(position) - off + lags[i].tip_lag, position.z);
    }
    return trace;
}

StrokeSamples lift_off(StrokeSamples trace, const HolderOptions& options) {
    constexpr int kSamples = 8;
    if (trace.samples.empty() || !trace.flat || trace.samples.back().pressure > 0) return trace;
    const double from = -tip_depths<StrokeSample>(trace.samples, options).back();
    const double left = options.hover - from;
    if (!(left > 1e-3 * options.hover)) return trace;
    StrokeSample s = trace.samples.back();
    const double begins = s.time, duration = kHoverTime * left / options.hover;
    for (int i = 1; i <= kSamples; ++i) {
        s.time = begins + duration * i / kSamples;
        trace.samples.push_back(s);
    }
    return trace;
}

}  // namespace tuft::stroke
