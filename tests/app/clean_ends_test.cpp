#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "app/input/pointer.h"
#include "models.h"
#include "paths.h"
#include "stroke/placement/surface_mapping.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::app {
namespace {

constexpr double kPixel = 0.33e-3;  // metres at the model, as on a screen that shows 200 mm over 600 pixels
constexpr double kRate = 125;       // events of a mouse in a second

/// A view from one side in parallel projection; pixels to the right and up of the middle.
struct View {
    Vec3 middle{0}, right{1, 0, 0}, up{0, 1, 0};
    double metres = kPixel;  ///< of a pixel

    Aim aim(const Vec2& pixel, double time) const {
        const Vec3 forward = -glm::cross(right, up);
        return {.ray = {middle + metres * (pixel.x * right + pixel.y * up) - 2.0 * forward, forward},
                .view_right = right,
                .view_up = up,
                .metres_per_pixel = metres,
                .time = time};
    }
    Vec2 pixel(const Vec3& p) const { return Vec2(glm::dot(p - middle, right), glm::dot(p - middle, up)) / metres; }
};

/// The cursor of a mouse along corners (pixels) at a pace of so many pixels a second; `eased`: it begins and ends at
/// rest, as a careful hand does, else it moves when the button goes down and when it comes up.
std::vector<Aim> drawn(const View& view, const std::vector<Vec2>& corners, double pace, bool eased) {
    double length = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) length += glm::distance(corners[i - 1], corners[i]);
    const int n = std::max(1, static_cast<int>(std::lround(length / pace * kRate)));
    std::vector<Aim> aims;
    for (int i = 0; i <= n; ++i) {
        const double t = static_cast<double>(i) / n;
        double gone = length * (eased ? t * t * (3 - 2 * t) : t);
        std::size_t k = 1;
        while (k + 1 < corners.size() && gone > glm::distance(corners[k - 1], corners[k]))
            gone -= glm::distance(corners[k - 1], corners[k]), ++k;
        const double part = length > 0 ? gone / glm::distance(corners[k - 1], corners[k]) : 0;
        aims.push_back(
            view.aim(glm::round(corners[k - 1] + std::min(1.0, part) * (corners[k] - corners[k - 1])), i / kRate));
    }
    return aims;
}

/// What a pointer that goes along `aims` paints.
struct Painted : stroke::Document {
    Painted(const stroke::Model& model, const std::string& brush, const std::vector<Aim>& aims,
            PointerSettings settings = {})
        : stroke::Document(model), brush_(brush) {
        const brush::Preset preset = brush::load_preset(brush);
        stroke::TiltedTipLag tilted(preset);
        PointerInput hand(*model.query, preset, settings, {tilted.as_held()});
        for (const Aim& aim : aims) take(hand.move(aim));
        Aim last = aims.back();  // the button comes up at the last place, one event later
        last.time += 1 / kRate;
        take(hand.move(last));
        take(hand.lift());
    }

  private:
    void take(const std::vector<StrokeStep>& steps) {
        for (const StrokeStep& step : steps) {
            if (step.kind == StrokeStep::Kind::begin) {
                stroke::PaintStroke s;
                s.trace.flat = false;
                s.brush = brush_;
                s.ink = "carbon";
                begin(std::move(s));
            } else if (step.kind == StrokeStep::Kind::end) {
                end();
            } else {
                extend(step.poses);
            }
        }
    }

    std::string brush_;
};

/// Places of the view with ink, pixels; `which`: only where it holds.
std::vector<Vec2> inked(const stroke::Document& painting, const View& view,
                        const std::function<bool(const Vec3&)>& which = {}) {
    std::vector<Vec2> places;
    const stroke::Model& model = painting.model();
    const ink::Canvas& canvas = painting.layers().canvas();
    for (const std::uint32_t slot : canvas.touched_slots())
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            double film = 0;
            for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
                if (const ink::Plane* w = canvas.plane(slot, p)) film += static_cast<double>((*w)[t]);
            // A tenth of a full film of carbon is a dark grey.
            if (!(film > 0.18) || model.texels.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            if (const Vec3 p(model.texels.position(slot, t)); !which || which(p)) places.push_back(view.pixel(p));
        }
    return places;
}

/// Where ink lies along a line from `a` to `b`, pixels from `a`, and half of its width in the middle.
struct Line {
    double begin = 1e9, end = -1e9, half = 0, aside = 0;
};
Line measure(const std::vector<Vec2>& ink, const Vec2& a, const Vec2& b) {
    const double length = glm::distance(a, b);
    const Vec2 along = (b - a) / length, across{-along.y, along.x};
    Line line;
    for (const Vec2& p : ink) {
        const double u = glm::dot(p - a, along), v = glm::dot(p - a, across);
        line.begin = std::min(line.begin, u);
        line.end = std::max(line.end, u);
        if (std::abs(u - 0.5 * length) < 0.1 * length) line.half = std::max(line.half, std::abs(v));
    }
    for (const Vec2& p : ink)
        if (const double u = glm::dot(p - a, along); u < 0.25 * length || u > 0.75 * length)
            line.aside = std::max(line.aside, std::abs(glm::dot(p - a, across)));
    return line;
}

const stroke::Model& sheet() {
    static const stroke::Model model = test::shipped_model("sheet.ply", 1024);
    return model;
}

/// Whether ink covers both ends and goes no further beyond them than half of the line's width.
void expect_clean(const Line& line, double length, const std::string& what) {
    constexpr double kTolerance = 2.5;  // pixels: cursors are whole pixels, texels two thirds of one
    EXPECT_LT(line.begin, kTolerance) << what;
    EXPECT_GT(line.begin, -line.half - kTolerance) << what;
    EXPECT_GT(line.end, length - kTolerance) << what;
    EXPECT_LT(line.end, length + line.half + kTolerance) << what;
    // No claw: the ends are as slim as the middle. A careful hand is slower there and presses more.
    EXPECT_LT(line.aside, 1.5 * line.half + kTolerance) << what;
}

const std::pair<double, bool> kPaces[] = {{100, true}, {400, true}, {400, false}, {1500, false}};

TEST(CleanEnds, InkBeginsAtThePressAndEndsAtTheRelease) {
    const View view{.middle = sheet().mesh->bounds.centre()};
    for (const char* brush : {"wolf-small", "wolf-medium", "goat-medium", "mixed-large"})
        for (const auto& [pace, eased] : kPaces)
            for (const double angle : {0.0, 2.6}) {
                const Vec2 d{std::cos(angle), std::sin(angle)}, a = glm::round(-90.0 * d), b = glm::round(90.0 * d);
                const Painted painting(sheet(), brush, drawn(view, {a, b}, pace, eased));
                expect_clean(measure(inked(painting, view), a, b), glm::distance(a, b),
                             std::string(brush) + " at " + std::to_string(pace) + (eased ? " eased" : "") +
                                 ", direction " + std::to_string(angle));
            }
}

// What it is for: as the hand was, slow strokes began with a claw and fast ones ended short.
TEST(CleanEnds, WithoutThemStrokesBeginWithAClawAndEndShort) {
    const View view{.middle = sheet().mesh->bounds.centre()};
    const Vec2 d{std::cos(1.0), std::sin(1.0)}, a = glm::round(-90.0 * d), b = glm::round(90.0 * d);
    PointerSettings plain;
    plain.clean_ends = false;
    const Painted slow(sheet(), "wolf-medium", drawn(view, {a, b}, 100, true), plain);
    const Line claw = measure(inked(slow, view), a, b);
    EXPECT_GT(claw.aside, 3 * claw.half);
    const Painted fast(sheet(), "wolf-medium", drawn(view, {a, b}, 1500, false), plain);
    EXPECT_LT(measure(inked(fast, view), a, b).end, glm::distance(a, b) - 15);
}

TEST(CleanEnds, AClickIsADotWhereItWas) {
    const View view{.middle = sheet().mesh->bounds.centre()};
    for (const char* brush : {"wolf-small", "goat-large"}) {
        const Vec2 at{12, -7};
        const Painted painting(sheet(), brush, {view.aim(at, 0), view.aim(at, 0.08)});
        const std::vector<Vec2> ink = inked(painting, view);
        ASSERT_GT(ink.size(), 20u) << brush;
        double furthest = 0, nearest = 1e9;
        for (const Vec2& p : ink)
            furthest = std::max(furthest, glm::distance(p, at)), nearest = std::min(nearest, glm::distance(p, at));
        EXPECT_LT(nearest, 2) << brush;
        // A tuft pressed down lies to one side, no further than its pressed length.
        const brush::Preset preset = brush::load_preset(brush);
        EXPECT_LT(furthest, 0.45 * stroke::working_depth(preset) * 2 / kPixel + preset.radius / kPixel) << brush;
    }
}

TEST(CleanEnds, AFanLeansAheadAsItIsHeldUnlessAPenOrTheSettingsLeanIt) {
    const View view{.middle = sheet().mesh->bounds.centre()};
    const brush::Preset fan = brush::load_preset("fan-30");
    // Of the last pose of a stroke upwards or to the right; the broad side is across the view.
    const auto lean = [&](const Vec2& ahead, const PointerSettings& settings, std::optional<Vec2> tilt) {
        PointerInput hand(*sheet().query, fan, settings);
        brush::Pose last;
        for (Aim aim : drawn(view, {{0, 0}, 60.0 * ahead}, 200, false)) {
            aim.tilt = tilt;
            for (const StrokeStep& step : hand.move(aim))
                if (!step.poses.empty()) last = step.poses.back();
        }
        return last.rotation * Vec3(0, 0, 1);
    };
    EXPECT_NEAR(lean({0, 1}, {}, {}).y, std::sin(fan.lean), 1e-3);
    EXPECT_NEAR(lean({0, -1}, {}, {}).y, -std::sin(fan.lean), 1e-3);
    EXPECT_NEAR(lean({1, 0}, {}, {}).z, 1, 1e-3) << "on edge";
    EXPECT_NEAR(lean({0, 1}, {.tilt = {0.3, 0}}, {}).y, 0, 1e-3);
    EXPECT_NEAR(lean({0, 1}, {}, Vec2(0)).y, 0, 1e-3);
}

TEST(CleanEnds, AZigzagBeginsAndEndsWhereTheHandDid) {
    const View view{.middle = sheet().mesh->bounds.centre()};
    for (const double pace : {200.0, 800.0}) {
        const std::vector<Vec2> corners{{-80, -30}, {-40, 30}, {0, -30}, {40, 30}, {80, -30}};
        const Painted painting(sheet(), "wolf-small", drawn(view, corners, pace, false));
        const std::vector<Vec2> ink = inked(painting, view);
        for (const Vec2& end : {corners.front(), corners.back()}) {
            double nearest = 1e9, beyond = 0;
            for (const Vec2& p : ink) {
                nearest = std::min(nearest, glm::distance(p, end));
                beyond = std::max(beyond, end.y - p.y);
            }
            EXPECT_LT(nearest, 2.5) << pace;
            EXPECT_LT(beyond, 10) << pace;  // the line is 6 pixels wide, and slants
        }
    }
}

TEST(CleanEnds, HoldOnBowlsAndCars) {
    const stroke::Model bowl = test::shipped_model("bowl.ply", 1024), car = test::shipped_model("car.ply", 1024);
    const auto side = [](const stroke::Model& model, const Vec3& up, const Vec3& offset, double metres) {
        return View{.middle = model.mesh->bounds.centre() + offset, .up = up, .metres = metres};
    };
    struct Place {
        const stroke::Model& model;
        const char* brush;
        View view;
    };
    const Place places[] = {
        {bowl, "wolf-small", side(bowl, {0, 1, 0}, {0, 0, 0}, 0.33e-3)},      // inside, from above
        {bowl, "wolf-small", side(bowl, {0, 0, 1}, {0, 0, 0}, 0.33e-3)},      // outside, from the front
        {car, "wolf-large*3", side(car, {0, 0, 1}, {0, 0, -0.03}, 1.9e-3)}};  // the door; the whole car on 600 pixels
    for (const auto& [model, brush, view] : places)
        for (const auto& [pace, eased] : {std::pair{150.0, true}, {800.0, false}})
            for (const double angle : {0.0, 2.8}) {
                const Vec2 d{std::cos(angle), std::sin(angle)}, a = glm::round(-45.0 * d), b = glm::round(45.0 * d);
                const Painted painting(model, brush, drawn(view, {a, b}, pace, eased));
                const Line line = measure(inked(painting, view), a, b);
                expect_clean(
                    line, glm::distance(a, b),
                    std::string(brush) + " at " + std::to_string(pace) + ", direction " + std::to_string(angle));
            }
}

/// The longest part of a line from `a` to `b` without ink, pixels.
double longest_gap(const std::vector<Vec2>& ink, const Vec2& a, const Vec2& b) {
    const double length = glm::distance(a, b);
    std::vector<double> along{0, length};
    for (const Vec2& p : ink) along.push_back(std::clamp(glm::dot(p - a, (b - a) / length), 0.0, length));
    std::sort(along.begin(), along.end());
    double gap = 0;
    for (std::size_t i = 1; i < along.size(); ++i) gap = std::max(gap, along[i] - along[i - 1]);
    return gap;
}

/// Furthest ink from the line through `a` and `b`, pixels.
double furthest_aside(const std::vector<Vec2>& ink, const Vec2& a, const Vec2& b) {
    const Vec2 along = glm::normalize(b - a);
    double most = 0;
    for (const Vec2& p : ink) most = std::max(most, std::abs(along.x * (p.y - a.y) - along.y * (p.x - a.x)));
    return most;
}

// From the inside of a bowl to its outside, seen from above its rim: one stroke for the eye. It was none: hair hooked
// over the rim, and the holder turned by a right angle on the lip.
TEST(CleanEnds, AStrokeOverARimHasNoGapAndNoClaw) {
    const stroke::Model bowl = test::shipped_model("bowl.ply", 2048);
    const Box& box = bowl.mesh->bounds;
    for (const auto& [elevation, below] : {std::pair{0.35, 60.0}, {0.55, 60.0}, {0.9, 15.0}}) {
        const View view{.middle = {box.centre().x, box.lo.y, box.hi.z},
                        .up = {0, std::sin(elevation), std::cos(elevation)}};
        for (const char* brush : {"wolf-small", "wolf-medium", "goat-medium"})
            for (const auto& [pace, eased] : {std::pair{150.0, true}, {800.0, false}})
                for (const double aside : {0.0, 1.0}) {
                    const Vec2 a{-60 * aside, 60}, b{below * aside, -below};
                    const Painted painting(bowl, brush, drawn(view, {a, b}, pace, eased));
                    const std::vector<Vec2> ink = inked(painting, view);
                    const std::string what = std::string(brush) + " at " + std::to_string(pace) + ", aside " +
                                             std::to_string(aside) + ", from " + std::to_string(elevation);
                    // Pixels: two events of a fast mouse are 13 apart, and one is on each side of the rim.
                    EXPECT_LT(longest_gap(ink, a, b), 8) << what;
                    // The line is up to 16 wide, and its middle is within 3 of the cursor's path.
                    EXPECT_LT(furthest_aside(ink, a, b), 11) << what;
                }
    }
}

// Under a flared lip the wall's normal is a right angle from the lip's within some millimetres: a holder that turned as
// slowly as over a calm surface had its tip ahead there, and the hair swung aside.
TEST(CleanEnds, AStrokeFromAFlaredLipGoesStraightDownTheNeck) {
    const stroke::Model vase = test::shipped_model("vase.ply", 1024);
    const Box& box = vase.mesh->bounds;
    const double elevation = 0.7;
    const View view{.middle = {box.centre().x, -0.0404, box.hi.z},  // the front of the lip
                    .up = {0, std::sin(elevation), std::cos(elevation)}};
    const auto in_front = [&](const Vec3& p) {
        const auto at = vase.query->closest_point(p, 1e-3);
        return at && p.y < box.centre().y && glm::dot(at->normal, glm::cross(view.right, view.up)) > 0;
    };
    for (const char* brush : {"wolf-medium", "mixed-medium"})
        for (const double pace : {400.0, 600.0, 900.0}) {
            const Vec2 a{-6, 40}, b{10, -62};
            const Painted painting(vase, brush, drawn(view, {a, b}, pace, false));
            const std::vector<Vec2> ink = inked(painting, view, in_front);
            ASSERT_GT(ink.size(), 50u);
            // The line is up to 7 wide. Its middle is up to 9 aside where it begins under the lip, from which the tuft
            // still hangs, and within 5 from 80 pixels on.
            EXPECT_LT(furthest_aside(ink, a, b), 13) << brush << " at " << pace;
            std::vector<Vec2> end = ink;
            std::erase_if(end, [&](const Vec2& p) { return glm::dot(p - a, glm::normalize(b - a)) < 80; });
            EXPECT_LT(furthest_aside(end, a, b), 8) << brush << " at " << pace;
        }
}

TEST(CleanEnds, StrokesReplayToTheBit) {
    const View view{.middle = sheet().mesh->bounds.centre()};
    const Painted painting(sheet(), "wolf-medium", drawn(view, {{-60, 0}, {20, 30}, {60, -20}}, 500, false));
    stroke::Document again(sheet());
    again.replay(painting.journal().entries());
    EXPECT_EQ(again.layers().hash(), painting.layers().hash());
}

}  // namespace
}  // namespace tuft::app
