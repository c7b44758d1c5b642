#include "writer/layout/feature_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/error.h"
#include "core/text/units.h"
#include "mesh/repair/repair.h"

namespace tuft::writer {
namespace {

/// Heights over a grid whose rows are given and whose columns are 4 mm apart over ±60 mm; `bent`: how far the rows of a
/// column are shifted.
mesh::TriangleMesh grid(const std::vector<double>& rows, const std::function<double(double)>& height,
                        const std::function<double(double)>& bent, double split_at = HUGE_VAL) {
    mesh::PolygonSoup soup;
    constexpr int kColumns = 31;
    for (int i = 0; i < kColumns; ++i)
        for (const double y : rows) {
            const double x = 0.004 * (i - 15);
            soup.points.emplace_back(x, y + bent(x), height(y));
        }
    const auto n = static_cast<std::uint32_t>(rows.size());
    for (std::uint32_t i = 0; i + 1 < kColumns; ++i)
        for (std::uint32_t j = 0; j + 1 < n; ++j) {
            const std::uint32_t a = i * n + j;
            for (const auto& face : {std::array{a, a + n, a + n + 1}, std::array{a, a + n + 1, a + 1}}) {
                soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
                soup.corners.insert(soup.corners.end(), face.begin(), face.end());
                if (split_at < HUGE_VAL) soup.polygon_groups.push_back(rows[j] < split_at - 1e-9 ? 0 : 1);
            }
        }
    soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    if (split_at < HUGE_VAL) soup.group_names = {"door", "wing"};
    return mesh::build_surface(std::move(soup), {.metres_per_unit = 1}).mesh;
}

std::vector<double> rows(double from, double to, double step) {
    std::vector<double> out;
    for (int i = 0; from + i * step < to + 1e-9; ++i) out.push_back(from + i * step);
    return out;
}

double still(double) {
    return 0;
}

/// A crease of a radius and an angle, 60 mm of a plane to both sides.
double rounded(double y, double radius, double angle) {
    const double arc = radius * std::sin(0.5 * angle), off = std::abs(y);
    if (off < arc) return std::sqrt(radius * radius - y * y) - radius;
    return radius * std::cos(0.5 * angle) - radius - (off - arc) * std::tan(0.5 * angle);
}

// The character line of a flank, straight or swept. Its middle is at y = bent(x).
TEST(FeatureLine, ARoundedCreaseIsFoundAndFollowedFromEndToEnd) {
    const auto swept = [](double x) { return 0.006 * std::sin(x / 0.04); };
    struct Case {
        double radius, degrees, step;  // metres; of the rows
        std::function<double(double)> bent;
    };
    for (const Case& c : {Case{0.005, 15, 0.0004, still}, Case{0.02, 25, 0.001, still}, Case{0.01, 20, 0.001, swept},
                          Case{0.02, 15, 0.003, still}}) {
        SCOPED_TRACE(testing::Message() << 1e3 * c.radius << " mm, " << c.degrees);
        const mesh::TriangleMesh mesh = grid(
            rows(-0.03, 0.03, c.step), [&](double y) { return rounded(y, c.radius, c.degrees * kDegree); }, c.bent);
        const mesh::SurfaceQuery query(mesh);
        const FeatureLine line = feature_line(query, {0.003, 0.011, 0}, 0.02);
        EXPECT_EQ(line.kind, LineKind::crease);
        EXPECT_FALSE(line.path.closed);
        // Rows cut the arc into facets, of which the outer two may be met in part.
        EXPECT_NEAR(line.angle, std::min(c.degrees * kDegree, line.over / c.radius), 1.5 * kDegree);
        EXPECT_NEAR(line.away, 0.011 - c.bent(0.003), 0.0015);
        double least = 1, most = -1;
        for (std::size_t i = 0; i < line.path.points.size(); ++i) {
            const Vec3& p = line.path.points[i];
            least = std::min(least, p.x), most = std::max(most, p.x);
            EXPECT_NEAR(p.y, c.bent(p.x), 0.0005) << p.x;  // the bend's middle, to a fraction of its facets
            EXPECT_GT(line.path.normals[i].z, std::cos(1.5 * kDegree)) << p.x;
        }
        EXPECT_LT(least, -0.054);  // a section needs as much to its sides as ahead: half a window of 8 mm
        EXPECT_GT(most, 0.054);
        EXPECT_GT(line.path.points.back().x, line.path.points.front().x);  // to the right of a reader above
    }
}

TEST(FeatureLine, AnEvenBendIsNoCrease) {
    const mesh::TriangleMesh mesh = grid(
        rows(-0.03, 0.03, 0.001), [](double y) { return std::sqrt(0.04 * 0.04 - y * y); }, still);
    const mesh::SurfaceQuery query(mesh);
    EXPECT_FALSE(crease_line(query, {0, 0, 0.04}, 0.02).has_value());
    EXPECT_THROW(feature_line(query, {0, 0, 0.04}, 0.02), Error);
}

// A step, walls of 80° that are 20 mm high: the line belongs to the face from which it was asked for.
TEST(FeatureLine, AnEdgeLiesOnTheSideOfThePlace) {
    const double run = 0.02 / std::tan(80 * kDegree);
    const mesh::TriangleMesh mesh = grid(
        {-0.03, -0.01, 0, run, 0.02, 0.03}, [&](double y) { return std::clamp(y / run, 0.0, 1.0) * 0.02; }, still);
    const mesh::SurfaceQuery query(mesh);
    for (const auto& [through, floor] : {std::pair(Vec3(0, -0.004, 0), true), {Vec3(0, 0.1 * run, 0.005), false}}) {
        const FeatureLine line = feature_line(query, through, 0.012);
        EXPECT_EQ(line.kind, LineKind::sharp_edge);
        EXPECT_NEAR(line.angle / kDegree, 80, 1e-3);  // floats of the mesh
        EXPECT_NEAR(line.path.length(), 0.12, 1e-6);
        for (std::size_t i = 0; i < line.path.points.size(); ++i) {
            EXPECT_NEAR(line.path.normals[i].z, floor ? 1 : std::cos(80 * kDegree), 1e-5);
            const auto on = query.closest_point(line.path.points[i]);
            EXPECT_NEAR(on->face_normal.z, floor ? 1 : std::cos(80 * kDegree), 1e-5);
        }
    }
    EXPECT_THROW(feature_line(query, {0, 0.012, 0.022}, 0.005), Error);  // the edge is 8 mm away
}

// A fold that bends enough for a crease: the edge itself is the nearer of the two, from wherever it is asked for.
TEST(FeatureLine, ASharpEdgeIsNoCreaseBesideItself) {
    const mesh::TriangleMesh mesh = grid(
        {-0.06, 0, 0.046}, [](double y) { return -std::max(y, 0.0) * std::tan(40 * kDegree); }, still);
    const mesh::SurfaceQuery query(mesh);
    for (const double y : {-0.006, -0.0071, -0.0083, -0.01015, -0.0102, -0.01117}) {
        const FeatureLine line = feature_line(query, {0.003, y, 0}, 0.02);
        EXPECT_EQ(line.kind, LineKind::sharp_edge) << y;
        EXPECT_NEAR(line.path.length(), 0.12, 1e-6) << y;
        for (const Vec3& n : line.path.normals) EXPECT_GT(n.z, 1 - 1e-6) << y;  // the face on the side of the place
    }
}

// The rim of a drum, asked for from its top: the letters nearest to the place are upright for a reader above.
TEST(FeatureLine, AClosedLineRunsToTheRightAtThePlace) {
    constexpr std::uint32_t kSides = 24;
    mesh::PolygonSoup soup;
    soup.polygon_start = {0};
    for (const double z : {0.0, 0.04})
        for (std::uint32_t i = 0; i < kSides; ++i) {
            const double turn = 360 * kDegree * i / kSides;
            soup.points.emplace_back(0.04 * std::cos(turn), 0.04 * std::sin(turn), z);
        }
    const auto add = [&](const std::vector<std::uint32_t>& face) {
        soup.corners.insert(soup.corners.end(), face.begin(), face.end());
        soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    };
    std::vector<std::uint32_t> top;
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const std::uint32_t next = (i + 1) % kSides;
        add({i, next, kSides + next, kSides + i});
        top.push_back(kSides + i);
    }
    add(top);
    const mesh::TriangleMesh mesh = mesh::build_surface(std::move(soup), {.metres_per_unit = 1}).mesh;
    const mesh::SurfaceQuery query(mesh);
    for (const auto& [place, right] : {std::pair(Vec3(0.001, -0.038, 0.04), Vec3(1, 0, 0)),
                                       {Vec3(0.001, 0.038, 0.04), Vec3(1, 0, 0)},
                                       {Vec3(0.038, 0.001, 0.04), Vec3(0, 1, 0)},
                                       {Vec3(-0.038, 0.001, 0.04), Vec3(0, 1, 0)}}) {
        const FeatureLine line = feature_line(query, place, 0.02);
        EXPECT_EQ(line.kind, LineKind::sharp_edge);
        ASSERT_TRUE(line.path.closed);
        const std::vector<Vec3>& points = line.path.points;
        ASSERT_EQ(points.size(), kSides);
        std::size_t at = 0;  // the step nearest to the place
        const auto away = [&](std::size_t i) {
            return glm::distance(0.5 * (points[i] + points[(i + 1) % kSides]), place);
        };
        for (std::size_t i = 0; i < kSides; ++i)
            if (away(i) < away(at)) at = i;
        EXPECT_GT(line.path.normals[at].z, 1 - 1e-6);
        EXPECT_GT(glm::dot(glm::normalize(points[(at + 1) % kSides] - points[at]), right), 0.9);
    }
}

TEST(FeatureLine, WhereGroupsMeetIsALineAndSoIsABorder) {
    const mesh::TriangleMesh mesh = grid(rows(-0.03, 0.03, 0.01), still, still, 0.01);
    const mesh::SurfaceQuery query(mesh);
    const FeatureLine groups = feature_line(query, {0, 0.006, 0}, 0.01);
    EXPECT_EQ(groups.kind, LineKind::group_border);
    for (const Vec3& p : groups.path.points) EXPECT_NEAR(p.y, 0.01, 2e-5);  // a thousandth of the reach beside it
    const FeatureLine border = feature_line(query, {0, -0.026, 0}, 0.01);
    EXPECT_EQ(border.kind, LineKind::border);
    EXPECT_FALSE(border.path.closed);  // its corners turn by more than 60 degrees
    EXPECT_NEAR(border.path.length(), 0.12, 1e-6);
}

}  // namespace
}  // namespace tuft::writer
