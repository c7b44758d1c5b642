#include "stroke/placement/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/text/units.h"
#include "grids.h"
#include "mesh/read/polygon_soup.h"
#include "paths.h"
#include "stroke/document/document.h"

/// Projected strokes over what has an edge: they stay on one sheet of the model.
namespace tuft::stroke {
namespace {

constexpr double kArch = 0.060;  // metres: radius of the hole in the body
constexpr double kTyre = 0.050;  // of the disk in it
const Placement kFromAbove{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::project};

TriangleMesh ring(double inner, double outer, double height, double drop = 0) {
    return make_grid(
        180, 12,
        [=](double u, double v) {
            const double a = 2 * pi * u, r = inner + v * (outer - inner);
            return Vec3(r * std::cos(a), r * std::sin(a), height - v * drop);
        },
        [=](const Vec3& p) { return drop > 0 ? -glm::normalize(Vec3(p.x, p.y, 0)) : Vec3(0, 0, 1); });
}

TriangleMesh together(const std::vector<TriangleMesh>& parts) {
    TriangleMesh all;
    for (const TriangleMesh& part : parts) {
        const auto points = static_cast<std::uint32_t>(all.positions.size());
        const auto triangles = static_cast<std::uint32_t>(all.triangles.size());
        for (const Vec3f& p : part.positions) all.positions.push_back(p), all.bounds.add(Vec3(p));
        for (const auto& t : part.triangles) all.triangles.push_back({t[0] + points, t[1] + points, t[2] + points});
        for (const Vec3f& n : part.corner_normals) all.corner_normals.push_back(n);
        for (const std::uint32_t n : part.neighbours) all.neighbours.push_back(n == kNone ? n : n + triangles);
    }
    return all;
}

/// A body with a round hole, a lip 15 mm deep round it, and a wheel in it.
TriangleMesh body_and_wheel(double wheel) {
    return together({ring(kArch, 0.2, 0), ring(kArch, kArch, 0, 0.015), ring(0, kTyre, wheel)});
}

StrokeSamples straight(double from, double to, double y = 0, double spacing = 1e-3) {
    std::vector<Vec2> points;
    const int n = static_cast<int>(std::ceil(std::abs(to - from) / spacing));
    for (int i = 0; i <= n; ++i) points.push_back({std::lerp(from, to, static_cast<double>(i) / n), y});
    return make_trace(kFromAbove, points);
}

struct Projected {
    SurfaceTrace mapped;
    std::vector<bool> left;
};
Projected projected(const SurfaceQuery& query, const StrokeSamples& trace) {
    Projected out{map_to_surface(query, trace), {}};
    out.left = leave_other_sheets(query, trace, out.mapped);
    return out;
}

// A wheel flush with the body, before it and behind it, by less and by more than the step of an edge: what parts them
// is the gap of 10 mm. Samples lie 1 mm apart and off the arch by half of that, so each is clearly on one side.
TEST(Projection, AStrokeOverAnArchEndsAtTheLipGoesOnBehindItAndLeavesTheWheel) {
    for (const double wheel : {2e-3, 0.0, -5e-3, -30e-3}) {
        const TriangleMesh model = body_and_wheel(wheel);
        const SurfaceQuery query(model);
        for (const double y : {0.0, 0.01, -0.03}) {
            const double lip = std::sqrt(kArch * kArch - y * y);
            const StrokeSamples there = straight(-0.1505, 0.1505, y), back = straight(0.1505, -0.1505, y);
            const Projected a = projected(query, there), b = projected(query, back);
            ASSERT_EQ(a.left.size(), there.samples.size());
            for (std::size_t i = 0; i < a.left.size(); ++i) {
                const double x = there.samples[i].position.x;
                if (std::abs(std::abs(x) - lip) < 0.2e-3) continue;  // the arch has 180 corners: 0.01 mm of sagitta
                EXPECT_EQ(a.left[i], std::abs(x) < lip) << wheel << " at " << x << ", " << y;
                EXPECT_EQ(a.mapped.samples[i].on_surface, !a.left[i]);
                EXPECT_EQ(a.left[i], b.left[b.left.size() - 1 - i]) << "the same in both directions, at " << x;
                EXPECT_GE(a.mapped.samples[i].position.z, std::min(0.0, wheel) - 1e-9);
                if (!a.left[i]) {
                    EXPECT_NEAR(a.mapped.samples[i].position.z, 0, 1e-9);
                }
            }
        }
    }
}

TEST(Projection, AStrokeThatLiesOnTheWheelStaysThere) {
    const TriangleMesh model = body_and_wheel(-5e-3);
    const SurfaceQuery query(model);
    const Projected on = projected(query, straight(-0.04, 0.04));
    EXPECT_EQ(std::count(on.left.begin(), on.left.end(), true), 0);
    // One end on the wheel, as most of it: it ends where the wheel ends.
    const StrokeSamples trace = straight(-0.0405, 0.0705);
    const Projected over = projected(query, trace);
    for (std::size_t i = 0; i < over.left.size(); ++i)
        EXPECT_EQ(over.left[i], trace.samples[i].position.x > kTyre) << trace.samples[i].position.x;
}

// What stands before the body, such as a mirror, is another sheet too.
TEST(Projection, AStrokeGoesOnBehindWhatStandsBeforeItsSheet) {
    const TriangleMesh model = together({make_sheet(0.3), ring(0, 0.02, 0.03)});
    const SurfaceQuery query(model);
    const StrokeSamples trace = straight(-0.1005, 0.1005);
    const Projected p = projected(query, trace);
    for (std::size_t i = 0; i < p.left.size(); ++i)
        EXPECT_EQ(p.left[i], std::abs(trace.samples[i].position.x) < 0.02) << trace.samples[i].position.x;
}

// A shut line, a step lower than an edge's, and a slope steeper than any step between samples change nothing.
TEST(Projection, ShutLinesStepsOfAPanelAndSlopesAreNoEdges) {
    const auto half = [](double from, double to, double height, double slope) {
        return make_grid(
            20, 20,
            [=](double u, double v) {
                const double x = std::lerp(from, to, u);
                return Vec3(x, 0.2 * (v - 0.5), height + slope * x);
            },
            [](const Vec3&) { return Vec3(0, 0, 1); });
    };
    const TriangleMesh floor = half(-0.1, 0.1, -0.02, 0);
    for (const TriangleMesh& model :
         {together({half(-0.1, -1e-3, 0, 0), half(1e-3, 0.1, 0, 0), floor}),
          together({half(-0.1, -1e-3, 0, 0), half(1e-3, 0.1, -3e-3, 0), floor}), half(-0.1, 0.1, 0, 1.8)}) {
        const SurfaceQuery query(model);
        for (const double spacing : {0.3e-3, 1e-3, 5e-3}) {
            const Projected p = projected(query, straight(-0.09, 0.09, 0, spacing));
            EXPECT_EQ(std::count(p.left.begin(), p.left.end(), true), 0) << spacing;
        }
    }
}

TEST(Projection, OtherMappingsDoNotChange) {
    const TriangleMesh model = body_and_wheel(0);
    const SurfaceQuery query(model);
    StrokeSamples trace = straight(-0.1, 0.1);
    trace.placement.mapping = SurfaceMapping::wrap;
    trace.placement.origin = {-0.1, 0, 0};
    EXPECT_TRUE(projected(query, trace).left.empty());
}

// Over the arch the brush hovers; where the body begins again it comes down no steeper than it goes on.
TEST(Projection, TheBrushIsLiftedOverTheGapAndSetDownBehindIt) {
    const TriangleMesh model = body_and_wheel(2e-3);
    const SurfaceQuery query(model);
    const HolderOptions options{.tuft_length = 0.03,
                                .working_depth = 0.01,
                                .hover = 0.004,
                                .steady = 0,
                                .tip_lag = {{0, 0}, {0.005, 0.006}, {0.01, 0.01}}};
    const HandPath path = hand_path(query, straight(-0.1505, 0.1505), options);
    double lowest = 1, deepest = 0;
    for (std::size_t i = 0; i < path.poses.size(); ++i) {
        const double x = path.mapped.samples[i].position.x;
        const double tip = path.poses[i].position.z + options.tuft_length * path.poses[i].axis().z;
        if (std::abs(x) < kArch - options.hover) lowest = std::min(lowest, tip - path.mapped.samples[i].position.z);
        if (x > kArch) deepest = std::min(deepest, tip);
        if (x > kArch + 1e-3 && x < kArch + 0.006) {
            EXPECT_NEAR(tip, -0.005 * (x - kArch) / 0.006, 0.005 * 1.1e-3 / 0.006) << "within a sample, at " << x;
        }
    }
    EXPECT_NEAR(lowest, options.hover, 1e-9);
    EXPECT_NEAR(deepest, -0.005, 1e-9);
}

// The car's front wheel is flush with its flank at 100 mm; the arch's lips are at 276 and 462 mm, 7 mm from the tyre.
class CarArch : public testing::Test {
  protected:
    static constexpr double kAxle = 369, kAxleHeight = 87, kTread = 91;  // mm; between the tread and the lip

    struct Inked {
        double before = 0, over = 0, behind = 0, wheel = 0;  ///< sums of films, of the parts of the path and the wheel
    };

    /// A stripe along the flank at a height of `z`, metres.
    Inked paint(const std::string& brush, double from, double to, double z) const {
        PaintStroke stroke;
        stroke.brush = brush;
        stroke.ink = "titanium-white";
        stroke.trace = straight(from, to);
        stroke.trace.placement = {{0, -0.25, z}, {1, 0, 0}, {0, 0, -1}, SurfaceMapping::project};
        stroke.trace.placed = true;
        for (StrokeSample& s : stroke.trace.samples) s.pressure = 0.3;
        Document painting(car_);
        painting.paint(stroke);
        Inked inked;
        const ink::Canvas& canvas = painting.layers().canvas();
        for (const std::uint32_t slot : canvas.touched_slots()) {
            const ink::Plane* plane = canvas.plane(slot, 0);
            for (int t = 0; plane && t < atlas::kTileTexels; ++t) {
                const Vec3 p = Vec3(car_.texels.position(slot, t)) / kMillimetre;
                const double amount = (*plane)[t] * static_cast<double>(car_.texels.tiles[slot].area[t]);
                (p.x < 277 ? inked.before : p.x < 461 ? inked.over : inked.behind) += amount;
                if (std::hypot(p.x - kAxle, p.z - kAxleHeight) < kTread) inked.wheel += amount;
            }
        }
        return inked;
    }

  private:
    static Model prepared() {
        ModelOptions options;
        options.unwrap.size = 2048;
        options.cache = shared_model_cache();
        return prepare_model(mesh::read_polygon_file(source_folder() + "/models/car.ply"), options);
    }
    const Model car_ = prepared();
};

TEST_F(CarArch, AStripeOverItLeavesNoInkOnTheWheel) {
    const Inked inked = paint("wolf-small", 0.200, 0.500, 0.100);
    EXPECT_GT(inked.behind, 0.3 * inked.before) << "38 mm behind the arch, 76 before it; the head is narrower";
    EXPECT_LT(inked.over, 0.01 * inked.before) << "hair that turns round the lip leaves some";
}

// Below its middle the tyre is as near to the lip, and the hand that comes from the nose leans back over the gap: it
// would lead wide hair across it.
TEST_F(CarArch, NeitherDoesOneFromTheNoseNorAWideOne) {
    struct Case {
        const char* brush;
        double from, to, z;
    };
    for (const Case& c : {Case{"wolf-small", 0.519, 0.219, 0.080}, Case{"wolf-medium", 0.519, 0.219, 0.080},
                          Case{"wolf-medium", 0.219, 0.519, 0.070}, Case{"wolf-medium", 0.519, 0.219, 0.070},
                          Case{"sword-8", 0.519, 0.219, 0.130}}) {
        const Inked inked = paint(c.brush, c.from, c.to, c.z);
        EXPECT_GT(inked.before, 0) << c.brush;
        EXPECT_GT(inked.behind, 0) << c.brush;
        EXPECT_EQ(inked.wheel, 0) << c.brush << " at " << c.z;
    }
}

}  // namespace
}  // namespace tuft::stroke
