#include "app/document/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "app/view/texture.h"
#include "models.h"
#include "paths.h"
#include "stroke/gesture/roll.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::app {
namespace {

TEST(Curve, TwoPointsOnASheetAreJoinedByAStraightLine) {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/sheet.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    const Vec3 c(mesh.bounds.centre().x, mesh.bounds.centre().y, mesh.bounds.hi.z);
    const std::vector<CurvePoint> points{{.position = c - Vec3(0.04, 0, 0)}, {.position = c + Vec3(0.04, 0.02, 0)}};
    const auto places = project_curve(query, points, 10);
    ASSERT_EQ(places.size(), 11u);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vec3 want = glm::mix(points[0].position, points[1].position, static_cast<double>(i) / 10);
        EXPECT_NEAR(glm::distance(places[i].position, want), 0, 1e-7);  // Embree works in single precision
    }
    // The length of a straight line is that of its ends.
    EXPECT_NEAR(places.back().along, std::hypot(0.08, 0.02), 1e-6);
}

TEST(Curve, GoesThroughItsPointsOnTheSideThatIsSeen) {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/bowl.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    const Vec3 middle = mesh.bounds.centre();
    std::vector<CurvePoint> points;
    for (const double angle : {0.0, 0.5, 0.9, 1.6}) {
        const Vec3 out(std::cos(angle), std::sin(angle), 0);
        const auto hit = query.ray(middle + 0.5 * out + Vec3(0, 0, 0.01 * std::sin(3 * angle)), -out);
        ASSERT_TRUE(hit);
        points.push_back({.position = hit->position, .outward = out});
    }
    const auto places = project_curve(query, points, 16);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(glm::distance(places[16 * i].position, points[i].position), 0, 1e-6);
    for (const CurveSample& place : places) {
        ASSERT_TRUE(place.on);
        // The inside of the thin wall faces the other way.
        EXPECT_GT(glm::dot(place.normal, glm::normalize(place.position - Vec3(middle.x, middle.y, place.position.z))),
                  0);
    }
}

TEST(Curve, BreaksWhereThereIsNoModel) {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/torus.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    const Box& b = mesh.bounds;
    std::vector<CurvePoint> points;
    for (const double x : {b.lo.x, b.hi.x}) {
        const auto hit = query.ray(Vec3(0.9 * x + 0.1 * b.centre().x, b.centre().y, b.hi.z + 0.1), Vec3(0, 0, -1));
        ASSERT_TRUE(hit);
        points.push_back({.position = hit->position});
    }
    const brush::Preset preset = brush::load_preset("wolf-small");
    EXPECT_EQ(curve_poses(query, points, {.holder = stroke::holder_options(preset, query.mesh())}).size(),
              2u);  // over the hole
}

/// Anticlockwise along a circle on the sheet, from where it goes to the right, by `angle` radians; a point every 2°.
std::vector<CurvePoint> arc_on_sheet(const Vec3& c, double radius, double angle) {
    std::vector<CurvePoint> points;
    const int n = static_cast<int>(std::ceil(angle * 90 / std::numbers::pi));
    for (int i = 0; i <= n; ++i) {
        const double a = angle * i / n;
        points.push_back({.position = c + radius * Vec3(std::sin(a), -std::cos(a), 0)});
    }
    return points;
}

struct CurveOnSheet : testing::Test {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/sheet.ply")).mesh;
    const mesh::SurfaceQuery query{mesh};
    const Vec3 c{mesh.bounds.centre().x, mesh.bounds.centre().y, mesh.bounds.hi.z};
    /// Slow, so that a sample's step turns by less than is asked for; pressed as long as it can be.
    static constexpr CurveSettings kSlow{.taper_in = 1e-3, .taper_out = 1e-3, .speed = 0.01};
};

/// A ferrule that keeps its direction turns against the circle by 1/R a metre; its hair is λ/R (1 − exp(−s/λ)) late,
/// with λ half its length.
TEST_F(CurveOnSheet, TheTipLagFollowsATurnOfTheCurveAsInATrace) {
    const brush::Preset flat = brush::load_preset("flat-12");
    constexpr double kRadius = 0.03, kAngle = 1.5;
    std::vector<double> turns;
    CurveHand hand{.holder = stroke::holder_options(flat, mesh), .settings = kSlow};
    hand.holder.tip_lag = {{0, 0}, {0.02, 0}};
    hand.holder.tip_lag_change = [&](double, const Vec2&, double turn) {
        turns.push_back(turn);
        return Vec2{0};
    };
    ASSERT_EQ(curve_poses(query, arc_on_sheet(c, kRadius, kAngle), hand).size(), 1u);
    ASSERT_GT(turns.size(), 100u);
    const double lambda = 0.5 * flat.length, late = lambda / kRadius * -std::expm1(-kAngle * kRadius / lambda);
    // The last pressed sample is a step before the end, and the curve straightens over its last 2°.
    constexpr double kNear = 0.03;
    EXPECT_NEAR(std::remainder(turns.back() - (late - kAngle), std::numbers::pi), 0, kNear);
    EXPECT_GT(late, 10 * kNear);
}

/// The hand lags by asin(λ / R) (gesture/roll.h), the blade by its string over R more.
TEST_F(CurveOnSheet, ABladeTurnsWithItsHairAsInATrace) {
    const brush::Preset sword = brush::load_preset("sword-8");
    constexpr double kRadius = 0.02, kAngle = 3.5;
    CurveHand hand{.holder = stroke::holder_options(sword, mesh), .settings = kSlow, .roll_follow = true};
    const double string = hand.holder.tip_lag_turn;
    hand.holder.tip_lag = {{0, 0}, {0.02, 0}};
    const auto strokes = curve_poses(query, arc_on_sheet(c, kRadius, kAngle), hand);
    ASSERT_EQ(strokes.size(), 1u);
    const Vec3 broad = strokes[0].back().rotation * Vec3(1, 0, 0);
    // Across the path is along the radius.
    const double across = kAngle - 0.5 * std::numbers::pi, lag = std::asin(stroke::kRollLag / kRadius);
    // The curve straightens over its last 2°, which the hand follows over 5 mm.
    constexpr double kNear = 4e-3;
    EXPECT_NEAR(std::remainder(std::atan2(broad.y, broad.x) - (across - lag - string / kRadius), std::numbers::pi), 0,
                kNear);
    EXPECT_GT(string / kRadius, 3 * kNear) << "which the blade's own lag exceeds";
}

/// Under a holder that leans by so many radians to the right and down.
class TiltedCurve : public testing::TestWithParam<std::pair<double, double>> {};
INSTANTIATE_TEST_SUITE_P(Curve, TiltedCurve,
                         testing::Values(std::pair(0.0, 0.0), std::pair(0.6, 0.0), std::pair(0.0, -0.6)));

TEST_P(TiltedCurve, ItsInkIsOnIt) {
    const stroke::Model model = test::shipped_model("sheet.ply", 1024);
    const Vec3 c(model.mesh->bounds.centre().x, model.mesh->bounds.centre().y, model.mesh->bounds.hi.z);
    constexpr double radius = 0.03;
    std::vector<CurvePoint> points;
    for (int i = 0; i <= 8; ++i) {
        const double a = std::numbers::pi * i / 8;
        points.push_back({.position = c + radius * Vec3(std::cos(a), std::sin(a), 0)});
    }
    stroke::Document painting(model);
    const brush::Preset preset = painting.materials().brush("wolf-medium");
    CurveHand hand{.holder = stroke::holder_options(preset, *model.mesh),
                   .pressure = 0.4,
                   .tilt = {GetParam().first, GetParam().second}};
    stroke::TiltedTipLag tilted(preset);
    hand.holder.tip_lag = tilted.as_held();
    hand.holder.tip_lag_change = [&tilted](double depth, const Vec2& lean, double turn) {
        return tilted.at(depth, lean, turn);
    };
    const auto strokes = curve_poses(*model.query, points, hand);
    ASSERT_EQ(strokes.size(), 1u);
    stroke::PaintStroke stroke;
    stroke.trace.flat = false;
    stroke.brush = "wolf-medium";
    stroke.ink = "carbon";
    painting.begin(std::move(stroke));
    painting.extend(strokes[0]);
    painting.end();
    const render::MapPixels map = Texture(painting).pixels();
    double sum = 0, off = 0, wide = 0;
    for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            const std::uint32_t tile = model.texels.tile_of_slot[slot];
            if (model.texels.tiles[slot].cluster[static_cast<std::size_t>(t)] == atlas::kNoCluster) continue;
            const std::size_t x = tile % model.texels.tiles_per_side * atlas::kTile +
                                  static_cast<std::size_t>(t) % atlas::kTile,
                              y = tile / model.texels.tiles_per_side * atlas::kTile +
                                  static_cast<std::size_t>(t) / atlas::kTile;
            const double ink = map.levels[0][y * map.size + x][3];
            const Vec3 p = Vec3(model.texels.position(slot, t)) - c;
            if (ink == 0) continue;
            sum += ink;
            off += ink * (std::hypot(p.x, p.y) - radius);
            wide += ink * std::abs(std::hypot(p.x, p.y) - radius);
        }
    ASSERT_GT(sum, 0);
    // The middle of the ink is nearer to the circle than half of what its line spreads.
    EXPECT_LT(std::abs(off / sum), 0.5 * wide / sum) << 1e3 * off / sum << " mm of " << 1e3 * wide / sum;
}

}  // namespace
}  // namespace tuft::app
