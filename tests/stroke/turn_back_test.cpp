#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/text/units.h"
#include "sheet.h"
#include "stroke/drawing/line_width.h"
#include "stroke/drawing/plane_ink.h"
#include "stroke/placement/holder.h"
#include "stroke/placement/placement.h"
#include "stroke/placement/tip_lag.h"
#include "stroke/pointer/pointer_strokes.h"

/// Wide brushes whose path turns back, or turns to their other broad side.
namespace tuft::stroke {
namespace {

struct Extent {
    double lo = 1, hi = -1;

    double width() const { return hi - lo; }
};

/// There and back on one line by a whole hand: least and greatest y of the ink within the way, and how far it reaches
/// beyond both ends.
struct ThereAndBack {
    Extent across;
    double before = 0, behind = 0;  // metres
};
ThereAndBack there_and_back(const std::string& brush, double roll, double pressure, int samples, bool back) {
    constexpr double kWay = 40e-3, kCell = 1e-4, kLands = 6e-3;
    static WidthTables tables;
    StrokeSamples trace;
    const double whole = back ? 2 * kWay : kWay;
    for (int i = 0; i <= samples * (back ? 2 : 1); ++i) {
        const double gone = std::min(whole, i * kWay / samples), left = whole - gone;
        trace.samples.push_back({.time = gone / 0.04,
                                 .position = {gone <= kWay ? gone : whole - gone, 0, 0},
                                 .pressure = pressure * std::min({1.0, gone / kLands, left / kLands}),
                                 .roll = roll});
    }
    const PlaneInk ink = plane_ink(trace, brush::load_preset(brush), tables.holder(brush), 5e-4, kCell);
    ThereAndBack out;
    Extent along;
    for (double y = -0.02; y < 0.02; y += kCell)
        for (double x = -0.01; x < 0.06; x += kCell)
            if (ink.at({x, y}) > 0.5) {
                out.across = {std::min(out.across.lo, y), std::max(out.across.hi, y)};
                along = {std::min(along.lo, x), std::max(along.hi, x)};
            }
    out.before = -along.lo, out.behind = along.hi - kWay;
    return out;
}

// Hair that was pushed before the hand lay on ahead of it, fell along its row after 20 to 40 mm and left a spike 12 mm
// high beside a flat's stroke.
TEST(TurnBack, OfAWideBrushStaysOnItsStroke) {
    for (const auto& [brush, roll, pressure] : {std::tuple{"flat-12", 0.5 * std::numbers::pi, 0.4},
                                                {"filbert-12", 0.5 * std::numbers::pi, 0.4},
                                                {"hake-60*0.25", 0.5 * std::numbers::pi, 0.4},
                                                {"sword-8", 0.0, 0.15}}) {
        SCOPED_TRACE(brush);
        const ThereAndBack once = there_and_back(brush, roll, pressure, 400, false),
                           twice = there_and_back(brush, roll, pressure, 400, true);
        // The stripe of a blade, 0.5 mm, lies beside itself by up to 0.3 mm.
        const double width = once.across.width();
        EXPECT_LT(twice.across.width(), 1.05 * width + 4e-4);
        EXPECT_NEAR(0.5 * (twice.across.lo + twice.across.hi), 0, 0.03 * width + 2e-4);
        // Of the hair of a blade, 50 mm, and of the others, 8 to 26 mm, that much may touch beyond the turn.
        EXPECT_NEAR(twice.behind, 0, std::string_view(brush) == "sword-8" ? 7e-3 : 4e-3);
    }
}

// Hair that was lifted left the end of a line with width, which its stencil cuts, ragged.
TEST(TurnBack, AlongAStencilTheHandKeepsItsPressure) {
    static WidthTables tables;
    for (const char* brush : {"flat-12", "fan-30"}) {
        const HolderOptions holder = tables.holder(brush);
        StrokeSamples trace;
        for (int i = 0; i <= 160; ++i)
            trace.samples.push_back({.time = 0.0125 * i,
                                     .position = {5e-4 * std::min(i, 160 - i), 0, 0},
                                     .pressure = 0.4 * std::min({1.0, i / 12.0, (160 - i) / 12.0}),
                                     .roll = 0.5 * std::numbers::pi});
        const auto least = [&](const StrokeSamples& path) {  // about the turn
            const StrokeSamples led = compensate_tip_lag(lean_holder(add_turn_samples(path, holder), holder), holder);
            double pressure = 1;
            for (const StrokeSample& s : led.samples)
                if (std::abs(s.time - 1) < 0.4) pressure = std::min(pressure, s.pressure);
            return pressure;
        };
        EXPECT_LT(least(trace), 0.1) << brush;
        trace.stencil = {{{-0.01, 0.005}, {0.05, 0.005}}};
        EXPECT_EQ(least(trace), 0.4) << brush;
    }
}

// A flat that keeps its roll draws a round as a broad nib does: broad, thin, broad. On its edge the hand went back by
// 1.6 mm, to the lag of hair that is set down there, and the hair that still lay was pushed: steps and a hook.
TEST(TurnBack, ARoundAtOneRollNeverTakesTheHandBack) {
    constexpr double kTurn = 4.2, kLands = 8e-3;
    static WidthTables tables;
    for (const char* brush : {"flat-12", "filbert-12"})
        for (const double radius : {16e-3, 25e-3}) {
            StrokeSamples trace;
            for (int i = 0; i <= 400; ++i) {
                const double a = kTurn * i / 400;
                trace.samples.push_back(
                    {.time = radius * a / 0.05,
                     .position = radius * Vec3(std::sin(a), -std::cos(a), 0),
                     .pressure = 0.45 * std::min({1.0, radius * a / kLands, radius * (kTurn - a) / kLands}),
                     .roll = 0.5 * std::numbers::pi});
            }
            const StrokeSamples led = compensate_tip_lag(trace, tables.holder(brush));
            const std::size_t set_down = led.samples.size() - trace.samples.size();
            double back = 0;  // metres, against the path, while it is pressed
            for (std::size_t i = 1; i < trace.samples.size(); ++i) {
                const StrokeSample &p = trace.samples[i - 1], &q = trace.samples[i];
                if (std::min(p.pressure, q.pressure) < 0.449) continue;
                const Vec3 gone = led.samples[set_down + i].position - led.samples[set_down + i - 1].position;
                back += std::max(0.0, -glm::dot(gone, glm::normalize(q.position - p.position)));
            }
            EXPECT_LT(back, 1e-4) << brush << ' ' << radius;
        }
}

/// How far ink lies from all discs of `radius` within the ink, at most, metres: the longest spike or thread beside a
/// stroke.
double longest_spike(const PlaneInk& ink, double half_width, double radius) {
    constexpr double kCell = 3e-4;
    const int n = static_cast<int>(2 * half_width / kCell), reach = static_cast<int>(std::round(radius / kCell));
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(j * n + i); };
    std::vector<char> inked(static_cast<std::size_t>(n * n)), covered(inked.size(), 0);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) inked[at(i, j)] = ink.at(kCell * Vec2(i, j) - half_width) > 0.5;
    std::vector<std::array<int, 2>> disc;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x)
            if (x * x + y * y <= reach * reach) disc.push_back({x, y});
    for (int j = reach; j + reach < n; ++j)
        for (int i = reach; i + reach < n; ++i)
            if (std::ranges::all_of(disc, [&](const auto& d) { return inked[at(i + d[0], j + d[1])]; }))
                for (const auto& d : disc) covered[at(i + d[0], j + d[1])] = 1;
    int longest = 0;  // squared, in cells
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            if (!inked[at(i, j)] || covered[at(i, j)]) continue;
            int nearest = n * n;
            for (int l = 0; l < n; ++l)
                for (int k = 0; (l - j) * (l - j) < nearest && k < n; ++k)
                    if (covered[at(k, l)]) nearest = std::min(nearest, (k - i) * (k - i) + (l - j) * (l - j));
            longest = std::max(longest, nearest);
        }
    return kCell * std::sqrt(longest);
}

// In a turn that it does not follow the hair of a fan comes over from one broad side to the other. Pressed, its flanks
// stayed behind: a waist, a knot, and a spike, 5.3 mm long of nine spines and 3.6 mm of five.
TEST(TurnBack, OfAFanToItsOtherSideLeavesNoSpike) {
    brush::Preset fan = brush::load_preset("fan-30");
    fan.spines = 5;
    fan.segments = 10;
    TiltedTipLag tilted(fan);
    HolderOptions options = holder_options(fan);
    options.tip_lag = tilted.as_held();
    options.tip_lag_change = [&](double depth, const Vec2& lean, double turn) { return tilted.at(depth, lean, turn); };
    constexpr double kRadius = 27e-3, kTurn = 4.5, kLands = 0.6;
    StrokeSamples trace;
    for (int i = 0; i <= 200; ++i) {
        const double a = kTurn * i / 200;
        trace.samples.push_back({.time = kRadius * a / 0.05,
                                 .position = kRadius * Vec3(std::sin(a), -std::cos(a), 0),
                                 .pressure = 0.5 * std::min({1.0, a / kLands, (kTurn - a) / kLands}),
                                 .roll = 0.5 * std::numbers::pi});
    }
    // A disc of 4 mm: hairs at its ends stand out by as much as the fan's ends are ragged.
    const double spike = longest_spike(plane_ink(trace, fan, options, 5e-4, 3e-4), 0.05, 2.1e-3);
    RecordProperty("spike_mm", std::to_string(spike / kMillimetre));
    EXPECT_LT(spike, 2.5e-3);
}

// Samples that are added at a turn had shifted the places of those after it.
TEST(TurnBack, OnAModelTheHandLeadsTheInkByItsLagOnly) {
    static WidthTables tables;
    const Model model = sheet({}, 256);
    const HolderOptions& options = tables.holder("flat-12");
    StrokeSamples trace;
    for (int i = 0; i <= 20; ++i)
        trace.samples.push_back({.time = 0.05 * i,
                                 .position = {i <= 10 ? -0.015 + 3e-3 * i : 0.045 - 3e-3 * i, 0, 0},
                                 .pressure = 0.4,
                                 .roll = 0.5 * std::numbers::pi});
    const HandPath path = hand_path(*model.query, trace, options);
    ASSERT_GT(path.mapped.samples.size(), trace.samples.size() + path.set_down);
    for (const SurfaceSample& s : path.mapped.samples)
        EXPECT_LT(glm::length(s.tip_lag), 0.6 * options.tuft_length) << s.time;  // the flat's lag at that depth: 0.48
}

// A corner of a right angle keeps the hair down and the hand where it was.
TEST(TurnBack, ACornerIsNone) {
    static WidthTables tables;
    const HolderOptions& options = tables.holder("flat-12");
    StrokeSamples trace;
    for (int i = 0; i <= 80; ++i)
        trace.samples.push_back({.time = 0.01 * i,
                                 .position = {5e-4 * std::min(i, 40), 5e-4 * std::max(0, i - 40), 0},
                                 .pressure = 0.4,
                                 .roll = 0.5 * std::numbers::pi});
    const StrokeSamples led = compensate_tip_lag(add_turn_samples(trace, options), options);
    EXPECT_GE(led.samples.size(), trace.samples.size());
    for (const StrokeSample& s : led.samples) EXPECT_EQ(s.pressure, s.time >= 0 ? 0.4 : s.pressure) << s.time;
}

// Hair that was kept down through a sharp corner, or lifted by half, stood out beside it: a spike above the first leg,
// 1.2 mm at 120 degrees and 2.2 mm at 140 of a flat, 0.8 mm of a bright.
TEST(TurnBack, ASharpCornerHasNoSpikeAndNoGap) {
    static WidthTables tables;
    constexpr double kLeg = 30e-3, kStep = 4e-4, kCell = 1e-4, kLands = 6e-3;
    for (const auto& [brush, degrees] : {std::pair{"flat-12", 120.0}, {"flat-12", 140.0}, {"bright-12", 150.0}}) {
        SCOPED_TRACE(std::string(brush) + " " + std::to_string(degrees));
        const Vec2 second{std::cos(degrees * kDegree), std::sin(degrees * kDegree)};  // y of a trace is down
        const auto place = [&](double gone) {
            return gone < kLeg ? Vec2{gone, 0} : Vec2{kLeg, 0} + (gone - kLeg) * second;
        };
        StrokeSamples trace;
        for (double gone = 0; gone < 2 * kLeg + 0.5 * kStep; gone += kStep)
            trace.samples.push_back({.time = gone / 0.04,
                                     .position = Vec3(place(gone), 0),
                                     .pressure = 0.4 * std::min({1.0, gone / kLands, (2 * kLeg - gone) / kLands}),
                                     .roll = 0.5 * std::numbers::pi});
        const PlaneInk ink = plane_ink(trace, brush::load_preset(brush), tables.holder(brush), 5e-4, kCell);
        const auto top = [&](double from, double to) {  // of the ink on the side away from the second leg
            double y = 0;
            for (double x = from; x < to; x += kCell)
                for (double up = 0; up < 0.02; up += kCell)
                    if (ink.at({x, up}) > 0.5) y = std::max(y, up);
            return y;
        };
        EXPECT_LT(top(0.01, kLeg + 0.01), top(0.008, 0.012) + 3e-4);  // three cells
        // Of the broad side, 12 mm, half lies on both sides of the path.
        for (double gone = kLeg; gone < 2 * kLeg - kLands; gone += kCell)
            for (const double up : {-3e-3, 0.0, 3e-3})
                EXPECT_GT(ink.at(Vec2(place(gone).x, up - place(gone).y)), 0.5) << gone << " " << up;
    }
}

/// Top of the ink (metres up from the first leg, which goes along x) of a flat in the hand of a live pointer, whose
/// path turns down by so many degrees, and that of the first leg alone.
std::array<double, 2> tops_of_a_live_corner(const Model& model, const std::string& brush, double degrees, bool pen) {
    static WidthTables tables;
    constexpr double kStart = -0.012, kLeg = 0.03, kLands = 6e-3, kStep = 4e-4;
    const Vec2 second{std::cos(degrees * kDegree), std::sin(degrees * kDegree)};
    StrokeSamples trace;
    for (double gone = 0; gone < 2 * kLeg; gone += kStep)
        trace.samples.push_back(
            {.time = gone / 0.04,
             .position = Vec3(kStart + std::min(gone, kLeg), 0, 0) + std::max(0.0, gone - kLeg) * Vec3(second, 0),
             .pressure = 0.4 * std::min({1.0, gone / kLands, (2 * kLeg - gone) / kLands}),
             .roll = pen ? 0.5 * std::numbers::pi : 0});
    PointerSettings settings;
    settings.roll = pen ? 0 : 0.5 * std::numbers::pi;
    const HolderOptions& holder = tables.holder(brush);
    const PointerInput pointer(*model.query, brush::load_preset(brush), settings,
                               {holder.tip_lag, holder.tip_lag_change});
    Document painting(model);
    for (const StrokeSamples& drawn : draw_with_pointer(pointer, aims_of(trace, model.mesh->bounds, 1e-4, pen))) {
        PaintStroke stroke;
        stroke.trace = drawn;
        stroke.brush = brush;
        stroke.ink = "carbon";
        painting.paint(stroke);
    }
    std::array<double, 2> tops{};
    const ink::Canvas& canvas = painting.layers().canvas();
    for (const std::uint32_t slot : canvas.touched_slots())
        if (const ink::Plane* plane = canvas.plane(slot, 0))
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                if (!((*plane)[t] > 0.2f)) continue;  // a tenth of a full film
                const Vec3 p(model.texels.position(slot, t));
                tops[0] = std::max(tops[0], p.y);
                if (p.x < kStart + 0.012 && p.x > kStart + 0.004) tops[1] = std::max(tops[1], p.y);
            }
    return tops;
}

// A hand that does not know its path kept its hair down: spikes 4 to 6 mm high beside a reversal by 160 degrees.
TEST(TurnBack, OfALivePointerLeavesNoSpike) {
    const Model model = sheet({}, 512);
    for (const auto& [degrees, pen] : {std::pair{160.0, false}, {160.0, true}, {140.0, false}}) {
        SCOPED_TRACE(std::to_string(degrees) + (pen ? " of a pen" : " of a mouse"));
        const auto [all, first] = tops_of_a_live_corner(model, "flat-12", degrees, pen);
        EXPECT_GT(first, 4e-3);
        // Four texels; the hair of a pen springs forward, aslant, as it is lifted.
        EXPECT_LT(all, first + (pen ? 2e-3 : 5e-4));
    }
}

/// The hand of a flat along x through `turns` (metres), pressed at 0.4, in steps of 0.25 mm.
StrokeSamples hand_through(const std::vector<double>& turns) {
    constexpr double kStep = 2.5e-4, kSpeed = 0.04;
    StrokeSamples trace;
    double time = 0;
    for (std::size_t k = 0; k + 1 < turns.size(); ++k) {
        const double way = turns[k + 1] - turns[k];
        const int n = std::max(1, static_cast<int>(std::lround(std::abs(way) / kStep)));
        for (int i = k > 0 ? 1 : 0; i <= n; ++i)
            trace.samples.push_back({.time = time + i * std::abs(way) / n / kSpeed,
                                     .position = {turns[k] + way * i / n, 0, 0},
                                     .pressure = 0.4,
                                     .roll = 0.5 * std::numbers::pi});
        time = trace.samples.back().time;
    }
    return trace;
}

/// Least pressure of the holder from a time on, and its greatest tilt.
std::array<double, 2> least_and_tilt(const StrokeSamples& trace, const HolderOptions& holder, double from) {
    std::array<double, 2> out{1, 0};
    const StrokeSamples led = compensate_tip_lag(lean_holder(add_turn_samples(trace, holder), holder), holder);
    for (const StrokeSample& s : led.samples)
        if (s.time >= from) out = {std::min(out[0], s.pressure), std::max(out[1], glm::length(s.tilt))};
    return out;
}

// The path goes on as it came: by the net turn of the slack string no turn was seen.
TEST(TurnBack, TwoTurnsWithinAStringAreLiftedToo) {
    static WidthTables tables;
    EXPECT_LT(least_and_tilt(hand_through({0, 0.02, 0.0185, 0.04}), tables.holder("flat-12"), 0.4)[0], 0.1);
}

// The last sample of a stroke, 1 um back, was lifted off and tilted by 0.12 rad.
TEST(TurnBack, TremorIsNone) {
    static WidthTables tables;
    const std::vector<double> back{0, 0.03, 0.03 - 1e-6}, back_and_on{0, 0.02, 0.02 - 1e-6, 0.03};
    for (const std::vector<double>& turns : {back, back_and_on}) {
        const auto [pressure, tilt] = least_and_tilt(hand_through(turns), tables.holder("flat-12"), 0.3);
        EXPECT_EQ(pressure, 0.4);
        EXPECT_LT(tilt, 1e-3);
    }
}

// A dot of a holder that does not compensate its lag has no direction to lean in.
TEST(TurnBack, WithoutTipLagADotStandsUpright) {
    for (const char* brush : {"fan-30", "sword-8"}) {
        StrokeSamples dot;
        dot.samples.push_back({.position = {0, 0, 0}, .pressure = 0.3});
        const StrokeSamples leant = lean_holder(dot, holder_options(brush::load_preset(brush)));
        EXPECT_EQ(leant.samples.front().tilt, Vec2(0)) << brush;
    }
}

// A mouse at 1 m/s passes the turn in one event: the hand pressed on through it.
TEST(TurnBack, OfAFastPointerIsLifted) {
    static WidthTables tables;
    const Model model = sheet({}, 128);
    StrokeSamples trace;
    for (int i = 0; i <= 12; ++i)
        trace.samples.push_back(
            {.time = 0.004 * i, .position = {i <= 6 ? -0.012 + 4e-3 * i : 0.036 - 4e-3 * i, 0, 0}, .pressure = 0.4});
    const brush::Preset preset = brush::load_preset("flat-12");
    const HolderOptions& holder = tables.holder("flat-12");
    PointerSettings settings;
    settings.roll = 0.5 * std::numbers::pi;
    settings.smoothing = 0;
    const PointerInput pointer(*model.query, preset, settings, {holder.tip_lag, holder.tip_lag_change});
    const std::vector<StrokeSamples> drawn =
        draw_with_pointer(pointer, aims_of(trace, model.mesh->bounds, 1e-4, false));
    ASSERT_EQ(drawn.size(), 1u);
    double highest = 0;  // of the tip over the sheet, but for the ends
    const std::vector<StrokeSample>& poses = drawn.front().samples;
    for (std::size_t i = 30; i + 14 < poses.size(); ++i) highest = std::max(highest, poses[i].position.z);
    EXPECT_GT(highest, preset.length);
}

TEST(TurnBack, IsTheSameForAnySamples) {
    const ThereAndBack many = there_and_back("flat-12", 0.5 * std::numbers::pi, 0.4, 800, true),
                       few = there_and_back("flat-12", 0.5 * std::numbers::pi, 0.4, 20, true);
    // Cells of 0.1 mm; where few samples lie the hand lands 2 mm apart.
    EXPECT_NEAR(many.across.width(), few.across.width(), 3e-4);
    EXPECT_NEAR(many.behind, few.behind, 3e-4);
}

}  // namespace
}  // namespace tuft::stroke
