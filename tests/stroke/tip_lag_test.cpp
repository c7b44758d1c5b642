#include "stroke/placement/tip_lag.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>

#include "brush/calibration/sweep.h"
#include "core/ease.h"
#include "core/text/units.h"
#include "ink_centre.h"
#include "sheet.h"
#include "stroke/drawing/drawing.h"
#include "stroke/drawing/line_width.h"
#include "stroke/drawing/plane_ink.h"
#include "stroke/placement/holder.h"

namespace tuft::stroke {
namespace {

/// A straight line from x = -16 mm to 8 mm of the sheet, pressed within its first 1.5 mm, drawn under a
/// holder that leans by `tilt` (radians, to the right and down).
PaintStroke leaning(const std::string& brush, double pressure, const Vec2& tilt) {
    PaintStroke s;
    s.brush = brush;
    s.ink = "carbon";
    s.trace.placement = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::wrap};
    for (int i = 0; i <= 240; ++i) {
        StrokeSample p;
        p.time = 0.0025 * i;
        p.position = {-0.016 + 1e-4 * i, 0, 0};
        p.pressure = pressure * std::min(1.0, i / 15.0);
        p.tilt = tilt;
        s.trace.samples.push_back(p);
    }
    return s;
}

/// Where ink lies across the sheet, by columns of half a millimetre, metres.
struct Span {
    double lo = 1, hi = -1;
    double width() const { return hi - lo; }
};
std::map<int, Span> columns_of(const Document& painting) {
    std::map<int, Span> columns;
    const atlas::TexelMap& map = painting.model().texels;
    for (const std::uint32_t slot : painting.layers().canvas().touched_slots()) {
        const ink::Plane* plane = painting.layers().canvas().plane(slot, 0);
        for (int t = 0; plane && t < atlas::kTileTexels; ++t) {
            if ((*plane)[t] < 0.2f || map.tiles[slot].area[t] <= 0) continue;
            const Vec3 p = Vec3(map.position(slot, t));
            Span& span = columns[static_cast<int>(std::floor(p.x / 5e-4))];
            span.lo = std::min(span.lo, p.y);
            span.hi = std::max(span.hi, p.y);
        }
    }
    return columns;
}

TEST(TipLag, UnderATiltedHolderTheLineLiesOnItsPath) {
    const Model model = sheet();
    for (const std::string brush : {"mixed-medium", "goat-small"}) {
        for (const Vec2 tilt : {Vec2{0.6, 0}, Vec2{-0.6, 0}, Vec2{0, 0.6}, Vec2{0, -0.6}, Vec2{0.35, 0.35}}) {
            SCOPED_TRACE(brush + ", leaning " + std::to_string(tilt.x) + " " + std::to_string(tilt.y));
            Document painting(model);
            painting.paint(leaning(brush, 0.4, tilt));
            const std::map<int, Span> columns = columns_of(painting);
            const Span& middle = columns.at(-8);
            int first = 99, last = -99;
            for (const auto& [k, span] : columns) {
                if (span.width() < 0.9 * middle.width()) continue;
                first = std::min(first, k);
                last = std::max(last, k);
            }
            // The path runs from column -32 to 16. Under an upright holder's lag the full width began 5 mm
            // late and went on 6 mm beyond; what is left are the press and the grid of leans.
            EXPECT_NEAR(first, -31, 3);
            EXPECT_NEAR(last, 17, 3);
            EXPECT_NEAR(0.5 * (middle.lo + middle.hi), 0, 0.07 * middle.width());
        }
    }
}

TEST(TipLag, AnUprightHolderHasTheMeasuredLagAndSidesMirror) {
    TiltedTipLag lag(brush::load_preset("goat-small"));
    const double depth = 0.3 * working_depth(brush::load_preset("goat-small"));
    EXPECT_EQ(lag.at(depth, {0.03, -0.03}), Vec2(0));
    EXPECT_EQ(lag.at(0, {0.5, 0.5}), Vec2(0));
    const Vec2 left = lag.at(depth, {0.3, 0.5}), right = lag.at(depth, {0.3, -0.5});
    EXPECT_EQ(left, Vec2(right.x, -right.y));
    // Hair pulled behind a holder that leans ahead trails it less than an upright one's.
    EXPECT_LT(lag.at(depth, {0.6, 0}).x, -1e-3);
    EXPECT_NEAR(lag.at(depth, {0.6, 0}).y, 0, 1e-15);  // metres: round-off of the rod
}

/// A straight line to the right from the origin, its ferrule rolled, set down within its first millimetre.
StrokeSamples rolled_line(double length, double pressure, double roll) {
    StrokeSamples trace;
    for (int i = 0; 1e-4 * i < length; ++i)
        trace.samples.push_back({.time = 3e-3 * i,
                                 .position = {1e-4 * i, 0, 0},
                                 .pressure = pressure * std::min(1.0, 0.1 * i),
                                 .roll = roll});
    return trace;
}

/// A flat of three spines, which is measured in a fifth of the time of five, and how it is held.
struct CoarseFlat {
    brush::Preset preset = brush::load_preset("flat-12");
    std::unique_ptr<TiltedTipLag> tilted;
    HolderOptions options;

    CoarseFlat() {
        preset.spines = 3;
        preset.segments = 8;
        tilted = std::make_unique<TiltedTipLag>(preset);
        options = holder_options(preset);
        options.tip_lag = tilted->as_held();
        options.tip_lag_change = [this](double depth, const Vec2& lean, double turn) {
            return tilted->at(depth, lean, turn);
        };
    }
};

/// The lag of an upright brush that lags by turn: as it is held, and turned.
std::vector<double> values_of(TiltedTipLag& lag) {
    std::vector<double> values;
    for (const TipLag& at : lag.as_held()) values.insert(values.end(), {at.depth, at.length});
    const Vec2 at = lag.at(0.004, Vec2{0}, 0.3);
    values.insert(values.end(), {at.x, at.y});
    return values;
}

TEST(TipLag, IsMeasuredOncePerPresetAndTakenFromTheCacheToTheBit) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(testing::TempDir()) / ("tuft-tip-lag-" + std::to_string(::getpid()));
    fs::remove_all(folder);
    const DiskCache cache(folder);
    const auto entries = [&] {
        return std::vector<fs::directory_entry>(fs::directory_iterator(folder), fs::directory_iterator());
    };
    brush::Preset preset = brush::load_preset("filbert-12");
    preset.spines = 2;
    preset.segments = 6;
    TiltedTipLag without(preset), first(preset, cache), second(preset, cache);
    const std::vector<double> measured = values_of(without);
    EXPECT_EQ(values_of(first), measured);
    const std::size_t n = entries().size();
    EXPECT_EQ(n, 3u) << "as held, and turned by the two nodes beside";
    // What is read counts as used: the cache dates it anew.
    const fs::file_time_type past = fs::last_write_time(folder) - std::chrono::hours(1);
    for (const fs::directory_entry& entry : entries()) fs::last_write_time(entry, past);
    const fs::path linked = folder.string() + "-linked";
    fs::remove_all(linked);
    fs::create_directory(linked);
    for (const fs::directory_entry& entry : entries())
        fs::create_hard_link(entry.path(), linked / entry.path().filename());
    EXPECT_EQ(values_of(second), measured);
    for (const fs::directory_entry& entry : entries()) {
        EXPECT_GT(fs::last_write_time(entry), past);
        EXPECT_EQ(fs::hard_link_count(entry.path()), 2u) << "one that is measured again is another file";
    }
    fs::remove_all(linked);
    EXPECT_EQ(entries().size(), n);
    // A brush that differs in the last bit is another one; under another name it is the same.
    preset.name = "mine";
    TiltedTipLag renamed(preset, cache);
    renamed.as_held();
    EXPECT_EQ(entries().size(), n);
    preset.tip_power = std::nextafter(preset.tip_power, 2.0);
    TiltedTipLag other(preset, cache);
    other.as_held();
    EXPECT_EQ(entries().size(), n + 1);
    fs::remove_all(folder);
}

TEST(TipLag, AFlatBeginsWhereItsPathDoesHoweverItLiesToIt) {
    constexpr double kCell = 2e-4;
    const CoarseFlat flat;
    for (const double degrees : {0.0, 45.0, 90.0, -45.0}) {
        const double roll = glm::radians(degrees);
        const PlaneInk ink = plane_ink(rolled_line(16e-3, 0.4, roll), flat.preset, flat.options, 4e-4, kCell);
        double begins = 1;
        for (double x = -0.02; x < 0.02; x += kCell)
            for (double y = -0.012; y < 0.012; y += kCell)
                if (ink.at({x, y}) > 0.5) begins = std::min(begins, x);
        // The middle of the ferrule's mouth is set down there, to half its thickness; on the edge, the hair that is
        // pressed bulges beyond the mouth. Without a lag by turn it began 6 mm too early across.
        EXPECT_NEAR(begins, -0.5 * flat.preset.width * std::cos(roll), degrees == 0 ? 4e-3 : flat.preset.radius)
            << degrees;
    }
}

TEST(TipLag, APetalOfAFlatNarrowsSteadily) {
    constexpr double kCell = 2e-4;
    const CoarseFlat flat;
    StrokeSamples trace;  // pressed across, lifted onto the edge
    for (int i = 0; i <= 150; ++i) {
        const double s = i / 150.0, press = std::min(1.0, s / 0.25) * (1 - smooth_step((s - 0.3) / 0.7));
        trace.samples.push_back({.time = 0.01 * i,
                                 .position = {0.025 * s, 0, 0},
                                 .pressure = 0.55 * press,
                                 .roll = 0.5 * std::numbers::pi * (1 - smooth_step((s - 0.4) / 0.6))});
    }
    const PlaneInk ink = plane_ink(trace, flat.preset, flat.options, 3e-4, kCell);
    double narrowest = 1;
    for (double x = 2e-3; x < 0.03; x += 1e-3) {
        double width = 0;
        for (double y = -0.012; y < 0.012; y += kCell)
            if (ink.at({x, y}) > 0.5) width += kCell;
        if (x > 8e-3) {
            EXPECT_LT(width, narrowest + 2.5 * kCell) << x << ": to a cell at each side";
        }
        if (x > 6e-3) narrowest = std::min(narrowest, width);  // pressed
        EXPECT_GT(width, x < 14e-3 ? flat.preset.width - 2 * kCell : 0) << x << ": in one piece, up to its tail";
    }
}

// Hair lies only where it came to: a flat on its edge that trembles keeps the tip lag of its edge.
TEST(TipLag, AFlatThatTremblesOnItsEdgeStaysOnIt) {
    constexpr double kTremble = 1 * kDegree;
    FollowedTurn edge(26e-3, 0);
    for (int i = 1; i <= 200; ++i) {
        const double turn = kTremble * std::sin(0.3 * i);
        EXPECT_LE(std::abs(std::sin(edge.follow(turn, 1e-3))), std::sin(kTremble) + 1e-12) << i;
    }
    // From its broad side it comes back lying, until it is lifted.
    FollowedTurn broad(26e-3, 0.5 * std::numbers::pi);
    for (int i = 1; i <= 200; ++i) EXPECT_NEAR(std::abs(std::sin(broad.follow(0, 1e-3))), 1, 1e-12) << i;
    broad.lift();
    EXPECT_NEAR(std::sin(broad.follow(0, 1)), 0, 1e-9);
}

// The hand went back while it lifted, and the hair sprang forward: a step, and a rectangle of three quarters of the
// width as the end. Lifted while the hand goes on, a toe as wide as 12 mm ends in about a half circle.
TEST(TipLag, AStrokeOfAFilbertEndsRound) {
    constexpr double kCell = 1e-4, kWay = 40e-3;
    static WidthTables tables;
    const brush::Preset filbert = brush::load_preset("filbert-12");
    for (const double lands : {4e-3, 7e-3}) {
        StrokeSamples trace;
        for (int i = 0; i <= 200; ++i) {
            const double gone = kWay * i / 200;
            trace.samples.push_back({.time = gone / 0.05,
                                     .position = {gone, 0, 0},
                                     .pressure = 0.5 * std::min({1.0, gone / 7e-3, (kWay - gone) / lands}),
                                     .roll = 0.5 * std::numbers::pi});
        }
        const PlaneInk ink = plane_ink(trace, filbert, tables.holder("filbert-12"), 5e-4, kCell);
        const auto width_at = [&](double x) {
            double width = 0;
            for (double y = -0.012; y < 0.012; y += kCell) width += ink.at({x, y}) > 0.5 ? kCell : 0;
            return width;
        };
        double end = kWay + 0.01;
        while (end > 0 && width_at(end) == 0) end -= kCell;
        EXPECT_NEAR(end, kWay, 1.5e-3) << "it ends where its path does";
        const double whole = width_at(0.5 * kWay), radius = 0.5 * whole;
        for (const double left : {0.5e-3, 1e-3, 2e-3, 3e-3, 5e-3}) {
            // Of five spines, each 2.4 mm wide.
            EXPECT_NEAR(width_at(end - left), 2 * std::sqrt(left * (2 * radius - left)), 2.4e-3)
                << lands << ' ' << left;
        }
        for (double x = kWay - 0.015; x < end - 1e-3; x += kCell) {
            EXPECT_LT(width_at(x) - width_at(x + 3 * kCell), 2.4e-3) << x << ": no step";
        }
    }
}

TEST(TipLag, TheLagFollowsATurnOfAWideFerruleAsItsHairFallsOver) {
    HolderOptions options{.tuft_length = 0.02, .turned = true};
    options.tip_lag = {{0, 0}, {0.01, 0}};
    options.tip_lag_change = [](double, const Vec2&, double turn) { return Vec2(0.01 * std::sin(turn), 0); };
    StrokeSamples trace = rolled_line(0.03, 0.4, 0);
    for (StrokeSample& s : trace.samples)
        if (s.position.x > 0.01) s.roll = 1.2;
    const StrokeSamples led = compensate_tip_lag(trace, options);
    ASSERT_EQ(led.samples.size(), trace.samples.size());
    const double turned = trace.samples[100].position.x;
    for (std::size_t i = 0; i < led.samples.size(); ++i) {
        const double x = trace.samples[i].position.x,
                     followed = x > turned ? 1.2 * -std::expm1((turned - x) / 0.01) : 0;
        EXPECT_NEAR(led.samples[i].position.x - x, 0.01 * std::sin(followed), 1e-12) << x;
    }
}

TEST(TipLag, AFanThatNobodyLeansDrawsAnEvenBandFromItsStart) {
    constexpr double kPress = 0.4, kCell = 2e-4;
    const brush::Preset fan = brush::load_preset("fan-30");
    HolderOptions options = holder_options(fan);
    const double depth = kPress * options.working_depth;
    options.tip_lag = {{0, 0}, {depth, brush::line_place(fan, depth, {fan.lean, 0}, 0.5 * std::numbers::pi).behind}};
    const PlaneInk ink = plane_ink(rolled_line(8e-3, kPress, 0.5 * std::numbers::pi), fan, options, 3e-4, kCell);
    const auto column = [&](double x) {
        Span span;
        double inked = 0;
        for (double y = -0.02; y < 0.02; y += kCell)
            if (ink.at({x, y}) > 0.5) span = {std::min(span.lo, y), std::max(span.hi, y)}, inked += kCell;
        return std::pair{span, inked};
    };
    const double width = column(3e-3).first.width();
    EXPECT_GT(width, 0.75 * 30e-3) << "the fan is spread";
    for (const double x : {1e-3, 3e-3, 6e-3}) {
        const auto [span, inked] = column(x);
        // The outer hair comes down last: a few cells.
        EXPECT_NEAR(span.width(), width, 0.04 * width) << x;
        // It parts by a few hairs at most. Upright a third of it has ink: a T. Under the last stamp there is an arc.
        EXPECT_GT(inked, x < 5e-3 ? 0.92 * span.width() : 0) << x;
        EXPECT_NEAR(0.5 * (span.lo + span.hi), 0, 0.02 * width) << "on the path, " << x;
    }
    // The hair ends in an arc 4 mm high. Upright, its middle comes down 9 mm before the path.
    EXPECT_EQ(column(-5e-3).second, 0);
}

TEST(TipLag, AcrossItsBroadSideIsContinuousWhereTheHolderIsUpright) {
    HolderOptions options;
    options.across = true;
    options.lean = 0.4;
    options.tip_lag = {{0, 0}, {0.01, 0.004}};  // leaning as the make does
    options.tip_lag_change = [](double, const Vec2& lean, double) {
        return Vec2(0.01 * (lean.x - 0.4), 0.01 * lean.y);
    };
    const double roll = 0.5 * std::numbers::pi;
    const Vec2 upright = tip_lag_at(options, 0.5, {0, 0}, roll, {1, 0});
    for (const Vec2 tilt : {Vec2(1e-9, 0), Vec2(0, -1e-9)})
        EXPECT_LT(glm::distance(upright, tip_lag_at(options, 0.5, tilt, roll, {1, 0})), 1e-9);
    EXPECT_NEAR(glm::distance(upright, tip_lag_at(options, 0.5, {0.4, 0}, roll, {1, 0})), 0.004, 1e-9);
}

TEST(TipLag, ADotOfAFanIsOnePieceWhereItIsSet) {
    constexpr double kPress = 0.3, kCell = 2e-4;
    const brush::Preset fan = brush::load_preset("fan-30");
    HolderOptions options = holder_options(fan);
    const double depth = kPress * options.working_depth;
    options.tip_lag = {{0, 0}, {depth, brush::line_place(fan, depth, {fan.lean, 0}, 0.5 * std::numbers::pi).behind}};
    StrokeSamples trace;
    for (int i = 0; i <= 20; ++i)
        trace.samples.push_back(
            {.time = 0.01 * i, .pressure = kPress * (1 - std::abs(0.1 * i - 1)), .roll = 0.5 * std::numbers::pi});
    const PlaneInk ink = plane_ink(trace, fan, options, 5e-4, kCell);
    Vec2 sum{0};
    double cells = 0;
    std::array<double, 2> middle{1, -1};  // along x, of the middle of the fan
    for (double y = -0.02; y < 0.02; y += kCell)
        for (double x = -0.015; x < 0.015; x += kCell) {
            if (!(ink.at({x, y}) > 0.5)) continue;
            sum += Vec2(x, y), ++cells;
            if (std::abs(y) < 2e-3) middle = {std::min(middle[0], x), std::max(middle[1], x)};
        }
    // Hair that is pressed lies 1.3 mm short of where dragged hair lies. Upright the dot is a T, 10 mm long. The hair
    // leaps over 1 mm as it comes down.
    EXPECT_NEAR(sum.x / cells, 0, 1.5e-3);
    EXPECT_NEAR(sum.y / cells, 0, 1e-4);
    EXPECT_LT(middle[1] - middle[0], 6e-3);
}

TEST(TipLag, AMakeLeansAcrossItsBroadSideUnlessAPenTiltsIt) {
    HolderOptions options{.tuft_length = 0.01, .lean = 0.4, .across = true};
    const auto tilts = [&](double roll, const Vec2& tilt = Vec2{0}) {
        StrokeSamples trace = rolled_line(0.02, 0.4, roll);
        for (StrokeSample& s : trace.samples) s.tilt = tilt;
        return lean_holder(trace, options).samples.back().tilt;
    };
    const double quarter = 0.5 * std::numbers::pi, half = std::sqrt(0.5);
    const auto expect_near = [](const Vec2& a, const Vec2& b) { EXPECT_LT(glm::distance(a, b), 1e-12); };
    expect_near(tilts(quarter), {0.4, 0});  // either face leads
    expect_near(tilts(-quarter), {0.4, 0});
    expect_near(tilts(0), {0, 0});
    const double both = std::atan(std::tan(0.4) * half * half);
    expect_near(tilts(0.5 * quarter), {both, both});  // y, across, is up and to the left
    EXPECT_EQ(tilts(quarter, {0, 0.01}), Vec2(0, 0.01));
    options.across = false;
    expect_near(tilts(0), {0.4, 0});
    options.blade_landing = 0.02;  // along its broad side, whichever end of it leads
    expect_near(tilts(0), {0.4, 0});
    expect_near(tilts(2 * quarter), {0.4, 0});
    expect_near(tilts(quarter), {0, 0});
    expect_near(tilts(0.5 * quarter), {both, -both});
    options.blade_landing = 0;
    // Where the path turns back the lean comes round, and passes through upright.
    StrokeSamples back = rolled_line(0.02, 0.4, quarter);
    for (std::size_t i = 0; i < back.samples.size(); ++i)
        back.samples[i].position.x = 0.01 - std::abs(0.01 - back.samples[i].position.x);
    const StrokeSamples turned = lean_holder(back, options);
    expect_near(turned.samples.back().tilt, {-0.4, 0});
    for (std::size_t i = 1; i < turned.samples.size(); ++i)
        EXPECT_LT(glm::distance(turned.samples[i].tilt, turned.samples[i - 1].tilt),
                  0.4 * 1e-4 / lean_string(options) * 1.1)
            << "no faster than the string turns";
}

/// What a trace under a holder that is upright but for a little to the right and to the writer leaves on a plane: where
/// cells of a tenth of a millimetre are inked, trace's axes.
std::vector<Vec2> inked_cells(StrokeSamples trace, const std::string& brush) {
    static WidthTables tables;
    for (StrokeSample& s : trace.samples) s.tilt = {0.015, 0.025};
    const PlaneInk ink = plane_ink(trace, brush::load_preset(brush), tables.holder(brush), 5e-5, 1e-4);
    std::vector<Vec2> cells;
    for (double y = -0.025; y < 0.025; y += 1e-4)
        for (double x = -0.025; x < 0.025; x += 1e-4)
            if (ink.at({x, -y}) > 0.5) cells.push_back({x, y});
    return cells;
}

TEST(TipLag, AStrokeSetDownFineStaysOnItsPathInEveryDirection) {
    // Hair that touches ahead of the hand by a lean that nobody meant was pushed, and turned over after some
    // millimetres.
    for (const char* brush : {"wolf-medium", "goat-medium", "mixed-medium"})
        for (int k = 0; k < 8; ++k) {
            SCOPED_TRACE(std::string(brush) + " " + std::to_string(45 * k));
            const double a = k * std::numbers::pi / 4;
            const Vec2 direction(std::cos(a), std::sin(a));
            StrokeSamples trace;
            for (int i = 0; i <= 90; ++i) {
                const double x = 2e-4 * i;
                trace.samples.push_back(
                    {.time = x / 0.045, .position = Vec3(x * direction, 0), .pressure = 0.35 * smooth_step(x / 4e-3)});
            }
            double body = 0, head = 0;  // how far to the side the ink reaches, within the first 8 mm and beyond
            for (const Vec2& p : inked_cells(trace, brush)) {
                const double along = glm::dot(p, direction), aside = std::abs(p.x * direction.y - p.y * direction.x);
                if (along < 8e-3)
                    head = std::max(head, aside);
                else if (along < 15e-3)
                    body = std::max(body, aside);
            }
            // The tuft stands where it is set down, and is up to half as wide again there (LineWidth.*).
            EXPECT_LT(head, 1.5 * body);
        }
}

TEST(TipLag, ATapIsADropWhereverTheHandDrifts) {
    const std::array<Vec2, 7> drifts{Vec2{0, 0}, {3e-4, 0},     {-3e-4, 0},   {0, -3e-4},
                                     {0, 3e-4},  {5e-4, -5e-4}, {-5e-4, 3e-4}};
    for (const char* brush : {"wolf-medium", "goat-medium", "mixed-medium"})
        for (const Vec2& drift : drifts) {
            SCOPED_TRACE(std::string(brush) + " " + std::to_string(drift.x) + " " + std::to_string(drift.y));
            StrokeSamples trace;
            for (int i = 0; i <= 100; ++i)
                trace.samples.push_back({.time = 2.5e-3 * i,
                                         .position = Vec3(0.01 * i * drift, 0),
                                         .pressure = 0.3 * std::sin(std::numbers::pi * i / 100)});
            const std::vector<Vec2> cells = inked_cells(trace, brush);
            ASSERT_GT(cells.size(), 100u);
            // Its hull by directions: a drop is convex but for its point, a V or a row of dots leaves a third of it
            // bare.
            std::size_t hull = 0;
            std::array<double, 64> most;
            most.fill(-1);
            const auto across = [](std::size_t k) {
                return Vec2(std::cos(2 * std::numbers::pi * double(k) / 64),
                            std::sin(2 * std::numbers::pi * double(k) / 64));
            };
            for (const Vec2& p : cells)
                for (std::size_t k = 0; k < most.size(); ++k) most[k] = std::max(most[k], glm::dot(p, across(k)));
            for (double y = -0.025; y < 0.025; y += 1e-4)
                for (double x = -0.025; x < 0.025; x += 1e-4) {
                    bool in = true;
                    for (std::size_t k = 0; k < most.size() && in; ++k)
                        in = glm::dot(Vec2(x, y), across(k)) <= most[k] + 1e-9;
                    hull += in;
                }
            EXPECT_GT(static_cast<double>(cells.size()), 0.75 * static_cast<double>(hull));
        }
}

/// Part of a sphere through the origin, 40 mm wide, hollow where the curvature (1/m) is negative; its normal at the
/// origin leans by `slope` radians.
Model dome(double curvature, double slope) {
    constexpr std::uint32_t n = 24;
    const Frame frame = make_frame(Vec3(0), {std::sin(slope), 0, std::cos(slope)});
    mesh::PolygonSoup soup;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const double x = 0.04 * (i / double(n) - 0.5), y = 0.04 * (j / double(n) - 0.5), rr = x * x + y * y;
            const double z = -curvature * rr / (1 + std::sqrt(1 - curvature * curvature * rr));
            soup.points.push_back(frame.to_world({x, y, z}) / kMillimetre);
        }
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            soup.corners.insert(soup.corners.end(), {a, a + 1, a + n + 2, a + n + 1});
        }
    soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    ModelOptions options;
    options.unwrap.size = 256;
    return prepare_model(soup, options);
}

PaintStroke dot_at_origin(const Vec3& normal, const std::string& brush, double pressure, bool pressed) {
    PaintStroke s;
    s.brush = brush;
    s.ink = "carbon";
    s.trace.placement = upright_placement(Vec3(0), normal, 0);
    s.trace.placement.mapping = SurfaceMapping::drape;
    for (int i = 0; i <= 20; ++i)
        s.trace.samples.push_back({.time = 0.01 * i, .pressure = pressure * (pressed ? 1 : 1 - std::abs(0.1 * i - 1))});
    return s;
}

/// Mean place of the ink of a dot that is set at the origin, metres.
Vec3 place_of_dot(const Model& model, const Vec3& normal, const std::string& brush, double pressure, bool pressed) {
    return test::ink_centre(model, dot_at_origin(normal, brush, pressure, pressed));
}

// Pressed down plumb the hair lay 1.5 mm to one side on a plane, and to any side where the surface bends.
TEST(TipLag, ADotLiesWhereItIsSetOnAnySlope) {
    for (const double curvature : {0.0, 1 / 0.075, -1 / 0.075})
        for (const double slope : {0.0, 0.5 * std::numbers::pi}) {
            const Model model = dome(curvature, slope);
            const Vec3 normal{std::sin(slope), 0, std::cos(slope)};
            for (const bool pressed : {false, true}) {
                const Vec3 off = place_of_dot(model, normal, "wolf-small", 0.3, pressed);
                EXPECT_LT(glm::length(off - glm::dot(off, normal) * normal), 0.3e-3)
                    << curvature << ' ' << slope << ' ' << pressed;
            }
        }
}

// Where its hair leaps, more is inked than where single spines lie: a filbert's dot lay 1.5 mm off.
TEST(TipLag, ADotOfAFilbertLiesWhereItIsSet) {
    brush::Preset preset = brush::load_preset("filbert-12");
    preset.name = "coarse";
    preset.spines = 3;
    preset.segments = 8;
    const Model model = dome(1 / 0.075, 0);
    for (const bool pressed : {false, true}) {
        Document painting(model);
        painting.use(preset);
        const Vec3 off = test::ink_centre(painting, dot_at_origin({0, 0, 1}, preset.name, 0.3, pressed));
        EXPECT_LT(glm::length(Vec2(off)), 0.3e-3) << pressed;
    }
}

// A flat's dot is 2 to 5 mm thick: 0.3 mm, as of round brushes, is not seen.
TEST(TipLag, DotsOfFlatsAndBladesLieWhereTheyAreSet) {
    const Model model = dome(0, 0);
    for (const auto& [name, most] : {std::pair{"flat-12", 0.3e-3}, {"bright-12", 0.3e-3}, {"sword-8", 0.3e-3}}) {
        brush::Preset preset = brush::load_preset(name);
        preset.name = "coarse";
        preset.segments = 10;
        Document painting(model);
        painting.use(preset);
        const Vec3 off = test::ink_centre(painting, dot_at_origin({0, 0, 1}, preset.name, 0.3, false));
        EXPECT_LT(glm::length(Vec2(off)), most) << name;
    }
}

// Pressed straight down on a dome a blade fell to its side, and its dot lay 13 mm off.
TEST(TipLag, ADotOfABladeLiesWhereItIsSetOnADome) {
    const Model model = dome(1 / 0.075, 0);
    brush::Preset preset = brush::load_preset("sword-8");
    preset.name = "coarse";
    preset.segments = 10;
    Document painting(model);
    painting.use(preset);
    const Vec3 off = test::ink_centre(painting, dot_at_origin({0, 0, 1}, preset.name, 0.3, false));
    EXPECT_LT(glm::length(Vec2(off)), 1e-3) << off.x << ' ' << off.y;
}

// Hand and brush in the mirror paint the mirror image. The holder leans ahead: hair set down plumb falls to its own y.
TEST(TipLag, AFlatAndASwordPaintTheirMirrorImages) {
    constexpr double kCell = 1e-4;
    for (const std::string name : {"flat-12", "sword-8"}) {
        brush::Preset preset = brush::load_preset(name);
        preset.segments = 10;
        const HolderOptions options = holder_options(preset);
        const auto rolled = [&](double roll) {
            StrokeSamples trace = rolled_line(12e-3, 0.4, roll);
            for (StrokeSample& s : trace.samples) s.tilt = {0.3, 0};
            return plane_ink(trace, preset, options, 4e-4, kCell);
        };
        const PlaneInk one = rolled(0.5), other = rolled(-0.5);
        double differ = 0, all = 0;
        for (double y = -0.02 + 0.5 * kCell; y < 0.02; y += kCell)
            for (double x = -0.06 + 0.5 * kCell; x < 0.03; x += kCell) {
                const double a = one.at({x, y});
                all += a;
                differ += std::abs(a - other.at({x, -y}));
            }
        ASSERT_GT(all, 1000) << name;
        EXPECT_LT(differ, 1e-6 * all) << name;
    }
}

}  // namespace
}  // namespace tuft::stroke
