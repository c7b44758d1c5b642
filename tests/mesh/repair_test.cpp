#include "mesh/repair/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/system/parallel.h"
#include "mesh/repair/inspect.h"
#include "mesh_checks.h"

namespace tuft::mesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Surface repaired(PolygonSoup soup) {
    Surface s = build_surface(std::move(soup), {.metres_per_unit = 1});
    EXPECT_THAT(broken_promises(s), ElementsAre());
    return s;
}

/// The same polygons with a point of its own for every corner.
PolygonSoup loosened(const PolygonSoup& soup) {
    PolygonSoup out = soup;
    out.points.clear();
    for (std::size_t c = 0; c < soup.corners.size(); ++c) {
        out.points.push_back(soup.points[soup.corners[c]]);
        out.corners[c] = static_cast<std::uint32_t>(c);
    }
    return out;
}

/// Polygon p the other way round.
void reverse(PolygonSoup& soup, std::size_t p) {
    std::reverse(soup.corners.begin() + soup.polygon_start[p], soup.corners.begin() + soup.polygon_start[p + 1]);
}

TEST(Repair, SoundMeshIsLeftAlone) {
    const PolygonSoup torus = make_torus(20, 10);
    const Surface s = repaired(torus);
    EXPECT_THAT(texts(describe_defects(s.report)), ElementsAre());
    ASSERT_EQ(s.mesh.n_vertices(), torus.points.size());
    for (std::size_t v = 0; v < torus.points.size(); ++v) EXPECT_EQ(s.mesh.positions[v], Vec3f(torus.points[v]));
    for (std::size_t c = 0; c < torus.corners.size(); ++c) EXPECT_EQ(s.mesh.triangles[c / 3][c % 3], torus.corners[c]);
    EXPECT_TRUE(s.report.closed);
    EXPECT_EQ(s.report.components, 1u);
    EXPECT_EQ(s.report.holes, 0u);
}

TEST(Repair, LengthsBecomeMetres) {
    PolygonSoup box = make_box(Vec3(0), Vec3(100, 200, 300));
    const Surface s = build_surface(box);  // millimetres
    // Coordinates are rounded to float: 6e-8 relative.
    EXPECT_NEAR(s.mesh.bounds.size().z, 0.3, 0.3 * 6e-8);
    EXPECT_NEAR(signed_volume(s.mesh), 0.1 * 0.2 * 0.3, 0.006 * 2e-7);
}

TEST(Repair, WeldsVerticesAtTheSamePlace) {
    PolygonSoup box = loosened(make_box());
    add_polygon(box, {0, 1, 2});  // shares points, so it is no loose soup; and a duplicate of a half
    const Surface s = repaired(box);
    EXPECT_EQ(s.report.vertices_welded, 16u);
    EXPECT_EQ(s.mesh.n_vertices(), 8u);
    EXPECT_EQ(s.report.duplicate_faces_dropped, 1u);
    EXPECT_TRUE(s.report.closed);
    EXPECT_FALSE(s.report.file.loose_triangles);
}

TEST(Repair, NegativeZeroIsZero) {
    PolygonSoup sheet = make_sheet(1);
    sheet = loosened(sheet);
    sheet.points[0].z = -0.0;
    EXPECT_EQ(repaired(sheet).mesh.n_vertices(), 4u);
}

TEST(Repair, ClosesHairlineCracksOfLooseTriangles) {
    PolygonSoup torus = loosened(make_torus(40, 20));
    // The diagonal is about 115, so this is 2e-7 of it: well within the tolerance of 1e-6 and
    // well above the rounding of float coordinates.
    for (std::size_t i = 0; i < torus.points.size(); ++i) torus.points[i].z += i % 3 == 0 ? 2.4e-5 : 0;
    const Surface s = repaired(torus);
    EXPECT_GT(s.report.crack_vertices_welded, 0u);
    EXPECT_TRUE(s.report.closed);
    EXPECT_EQ(s.mesh.n_vertices(), 800u);
    EXPECT_EQ(s.mesh.n_triangles(), 1600u);
}

// sin π is 1.2e-16 in the spheres of many programs: their pole is a ring of points, in which it must not stay open.
TEST(Repair, ClosesAPoleThatIsARingOfPointsBesideEachOther) {
    constexpr std::uint32_t kRound = 24, kRings = 12;
    PolygonSoup sphere;
    for (std::uint32_t i = 0; i <= kRings; ++i)
        for (std::uint32_t j = 0; j < kRound; ++j) {
            const double polar = M_PI * i / kRings, azimuth = 2 * M_PI * j / kRound;
            sphere.points.emplace_back(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                       std::cos(polar));
        }
    sphere.polygon_start = {0};
    for (std::uint32_t i = 0; i < kRings; ++i)
        for (std::uint32_t j = 0; j < kRound; ++j) {
            const std::uint32_t a = i * kRound + j, b = i * kRound + (j + 1) % kRound;
            for (const std::uint32_t c : {a, a + kRound, b + kRound, b}) sphere.corners.push_back(c);
            sphere.polygon_start.push_back(static_cast<std::uint32_t>(sphere.corners.size()));
        }
    const Surface s = repaired(sphere);
    EXPECT_TRUE(s.report.closed);
    EXPECT_EQ(s.mesh.n_vertices(), (kRings - 1) * kRound + 2);
    EXPECT_EQ(s.mesh.n_triangles(), 2 * (kRings - 1) * kRound);
}

TEST(Repair, LeavesCloseSheetsApart) {
    PolygonSoup plates = make_box(Vec3(0), Vec3(100, 100, 1e-3));
    add_box(plates, Vec3(0, 0, 1.5e-3), Vec3(100, 100, 1e-3));
    for (const PolygonSoup& soup : {plates, loosened(plates)}) {
        const Surface s = repaired(soup);
        EXPECT_EQ(s.report.components, 2u);
        EXPECT_EQ(s.mesh.n_vertices(), 16u);
        EXPECT_TRUE(s.report.closed);
    }
}

TEST(Repair, DropsFacesWithoutArea) {
    PolygonSoup sheet = make_sheet(2);
    add_polygon(sheet, {0, 0, 1});     // repeated corner
    add_polygon(sheet, {4, 4, 4, 4});  // a point
    add_polygon(sheet, {0, 1, 2});     // collinear
    const Surface s = repaired(sheet);
    EXPECT_EQ(s.report.degenerate_faces_dropped, 3u);
    EXPECT_EQ(s.report.non_manifold.edges_split, 0u);
    EXPECT_EQ(s.mesh.n_triangles(), 8u);
}

TEST(Repair, QuadWithARepeatedCornerIsATriangle) {
    PolygonSoup soup = make_sheet(1);
    soup.points.emplace_back(2, 0, 0);
    add_polygon(soup, {1, 4, 3, 3});
    const Surface s = repaired(soup);
    EXPECT_EQ(s.mesh.n_triangles(), 3u);
    EXPECT_EQ(s.report.degenerate_faces_dropped, 0u);
}

// A cap between the halves of an edge keeps a surface closed; dropping it would open a slit.
TEST(Repair, FlipsFlatTrianglesInsteadOfOpeningASlit) {
    PolygonSoup box;
    add_box(box, Vec3(0), Vec3(1));
    set_uvs_to_position(box);
    PolygonSoup soup;
    soup.points = box.points;
    soup.points.emplace_back(0.5, 0, 0);  // 8: on the edge between 0 and 1
    for (std::size_t p = 0; p < 6; ++p) {
        std::vector<std::uint32_t> q(box.corners.begin() + 4 * static_cast<std::ptrdiff_t>(p),
                                     box.corners.begin() + 4 * static_cast<std::ptrdiff_t>(p) + 4);
        if (p == 0) q = {0, 2, 3, 1, 8};  // the bottom knows of it, the front does not
        add_polygon(soup, q);
    }
    add_polygon(soup, {0, 8, 1});
    set_uvs_to_position(soup);
    const Surface s = repaired(soup);
    EXPECT_EQ(s.report.degenerate_faces_repaired, 1u);
    EXPECT_EQ(s.report.degenerate_faces_dropped, 0u);
    EXPECT_TRUE(s.report.closed);
    EXPECT_EQ(s.mesh.n_triangles(), 14u);
    EXPECT_DOUBLE_EQ(signed_volume(s.mesh), 1);
    for (std::size_t c = 0; c < 3 * s.mesh.n_triangles(); ++c) {
        const Vec3f p = s.mesh.positions[s.mesh.triangles[c / 3][c % 3]];
        EXPECT_EQ(s.mesh.corner_uvs[c], Vec2f(p.x, p.y));
    }
}

// Found by fuzzing: a flat triangle that is left out where two others meet is mended at its
// long side afterwards, so its vertices must have come apart from theirs.
TEST(Repair, FlatTriangleOnASharedEdgeIsSetApart) {
    PolygonSoup soup;
    soup.points = {{0, 0, 0}, {0, 100, 0}, {1, 0, 0}, {0, 10, 8}, {1, 2, 0}, {0, 100, 4}, {0, 10, 0}};
    for (const auto& p :
         {std::vector<std::uint32_t>{0, 1, 3}, {1, 2, 4}, {4, 6, 5, 1}, {4, 6, 5, 1, 0}, {1, 2, 3}, {0, 1, 2, 3}})
        add_polygon(soup, p);
    repaired(soup);
}

TEST(Repair, DropsDuplicateFacesWhicheverWayRound) {
    PolygonSoup sheet = make_sheet(2);
    add_polygon(sheet, {1, 4, 0});  // the first triangle again, turned
    add_polygon(sheet, {4, 1, 0});  // and reversed
    const Surface s = repaired(sheet);
    EXPECT_EQ(s.report.duplicate_faces_dropped, 2u);
    EXPECT_EQ(s.mesh.n_triangles(), 8u);
    EXPECT_EQ(s.report.non_manifold.edges_split, 0u);
    EXPECT_EQ(s.report.faces_flipped, 0u);
}

TEST(Repair, DoubleSidedSheetBecomesOneSheet) {
    PolygonSoup sheet = make_sheet(3);
    const PolygonSoup once = sheet;
    for (std::size_t p = 0; p < once.n_polygons(); ++p)
        add_polygon(sheet, {once.corners[3 * p + 2], once.corners[3 * p + 1], once.corners[3 * p]});
    const Surface s = repaired(sheet);
    EXPECT_EQ(s.report.duplicate_faces_dropped, 18u);
    EXPECT_EQ(s.report.holes, 1u);
    EXPECT_EQ(s.mesh.n_triangles(), 18u);
}

TEST(Repair, FinComesOffTheSheetItStandsOn) {
    PolygonSoup sheet = make_sheet(4);
    sheet.points.emplace_back(2, 1.5, 1);
    add_polygon(sheet, {7, 12, 25});  // on the inner edge from (2, 1) to (2, 2)
    const Surface s = repaired(sheet);
    EXPECT_EQ(s.report.non_manifold.edges_split, 1u);
    EXPECT_EQ(s.report.non_manifold.vertices_split, 0u);
    EXPECT_EQ(s.report.components, 2u);
    EXPECT_EQ(s.report.border_edges, 16u + 3u);
    EXPECT_EQ(s.mesh.n_vertices(), 25u + 3u);
}

TEST(Repair, CubesThatTouchInAnEdgeComeApart) {
    PolygonSoup cubes = make_box();
    add_box(cubes, Vec3(1, 1, 0), Vec3(1));
    const Surface s = repaired(cubes);
    EXPECT_EQ(s.report.non_manifold.edges_split, 1u);
    EXPECT_EQ(s.report.components, 2u);
    EXPECT_TRUE(s.report.closed);
    EXPECT_EQ(s.mesh.n_vertices(), 16u);
    EXPECT_DOUBLE_EQ(signed_volume(s.mesh), 2);
}

TEST(Repair, ConesThatTouchInAPointComeApart) {
    PolygonSoup cubes = make_box();
    add_box(cubes, Vec3(1, 1, 1), Vec3(1));
    const Surface s = repaired(cubes);
    EXPECT_EQ(s.report.non_manifold.edges_split, 0u);
    EXPECT_EQ(s.report.non_manifold.vertices_split, 1u);
    EXPECT_EQ(s.report.components, 2u);
    EXPECT_EQ(s.mesh.n_vertices(), 16u);
}

TEST(Repair, CrossingSheetsThatShareAnEdgeStayFlat) {
    PolygonSoup soup;  // four half-planes around the z axis
    soup.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    for (std::uint32_t k = 2; k < 6; ++k) add_polygon(soup, {0, 1, k});
    const Surface s = repaired(soup);
    EXPECT_EQ(s.report.components, 2u);
    for (std::size_t t = 0; t < 4; ++t) {
        std::uint32_t over = kNone;
        for (std::size_t k = 0; k < 3; ++k) over = std::min(over, s.mesh.neighbours[3 * t + k]);
        ASSERT_NE(over, kNone);
        const auto normal = [&](std::size_t f) {
            return glm::cross(s.mesh.position(f, 1) - s.mesh.position(f, 0),
                              s.mesh.position(f, 2) - s.mesh.position(f, 0));
        };
        EXPECT_GT(glm::dot(normal(t), normal(over)), 0.9);
    }
}

TEST(Repair, TurnsFacesThatShowTheirBacks) {
    PolygonSoup torus = make_torus(20, 10);
    set_uvs_to_position(torus);
    for (const std::size_t p : {0u, 1u, 7u, 100u, 399u}) {
        std::swap(torus.corners[3 * p + 1], torus.corners[3 * p + 2]);
        std::swap(torus.corner_uvs[3 * p + 1], torus.corner_uvs[3 * p + 2]);
    }
    const Surface s = repaired(torus);
    EXPECT_EQ(s.report.faces_flipped, 5u);
    EXPECT_GT(signed_volume(s.mesh), 0);
    for (std::size_t c = 0; c < 3 * s.mesh.n_triangles(); ++c) {
        const Vec3f p = s.mesh.positions[s.mesh.triangles[c / 3][c % 3]];
        EXPECT_EQ(s.mesh.corner_uvs[c], Vec2f(p.x, p.y));
    }
}

TEST(Repair, ClosedPartsFaceOutwardOpenPartsKeepTheirMajority) {
    PolygonSoup inside_out = make_box();
    for (std::size_t p = 0; p < 6; ++p) reverse(inside_out, p);
    const Surface closed = repaired(inside_out);
    EXPECT_DOUBLE_EQ(signed_volume(closed.mesh), 1);
    EXPECT_EQ(closed.report.faces_flipped, 12u);

    PolygonSoup sheet = make_sheet(4);
    for (std::size_t p = 0; p < 20; ++p) reverse(sheet, p);  // of 32: down wins
    const Surface open = repaired(sheet);
    EXPECT_EQ(open.report.faces_flipped, 12u);
    EXPECT_LT(open.mesh.corner_normals[0].z, -0.99);
}

/// The polygons that `keep` says of their middles.
template <class Keep>
PolygonSoup kept(const PolygonSoup& soup, Keep keep) {
    PolygonSoup out;
    out.points = soup.points;
    for (std::size_t p = 0; p < soup.n_polygons(); ++p) {
        std::vector<std::uint32_t> corners(soup.corners.begin() + soup.polygon_start[p],
                                           soup.corners.begin() + soup.polygon_start[p + 1]);
        Vec3 middle(0);
        for (const std::uint32_t c : corners) middle += soup.points[c] / static_cast<double>(corners.size());
        if (keep(middle)) add_polygon(out, corners);
    }
    return out;
}

PolygonSoup inverted(PolygonSoup soup) {
    for (std::size_t p = 0; p < soup.n_polygons(); ++p) reverse(soup, p);
    return soup;
}

/// Mean of (point − centre) · normal over the triangles: > 0 where they face outward.
double outwardness(const TriangleMesh& mesh, const Vec3& centre) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 a = mesh.position(t, 0);
        sum += glm::dot(a - centre, glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a));
    }
    return sum;
}

PolygonSoup make_ball() {  // 24 by 16 quads
    PolygonSoup ball;
    constexpr std::uint32_t kAround = 24, kUp = 17;
    for (std::uint32_t j = 0; j < kUp; ++j)
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const double u = 6.283185307179586 * i / kAround, v = 3.141592653589793 * (j + 0.01) / (kUp - 0.98);
            ball.points.emplace_back(std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), -std::cos(v));
        }
    for (std::uint32_t j = 0; j + 1 < kUp; ++j)
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const std::uint32_t a = kAround * j + i, b = kAround * j + (i + 1) % kAround;
            add_polygon(ball, {a, b, b + kAround, a + kAround});
        }
    return ball;
}

TEST(Repair, OpenPartsThatAreInsideOutAreTurnedRound) {
    const PolygonSoup jar = kept(make_ball(), [](const Vec3& p) { return p.z < 0.8; });
    const Surface sound = repaired(jar), turned = repaired(inverted(jar));
    EXPECT_GT(outwardness(sound.mesh, Vec3(0)), 0);
    EXPECT_EQ(sound.report.parts_turned, 0u);
    EXPECT_GT(outwardness(turned.mesh, Vec3(0)), 0);
    EXPECT_EQ(turned.report.parts_turned, 1u);
    EXPECT_EQ(turned.report.faces_flipped, 0u);
    EXPECT_THAT(texts(describe_defects(turned.report)), Contains("1 open part was inside out: turned round"));
    // One face of the file shows its back among the others: that is reported.
    PolygonSoup one = inverted(jar);
    reverse(one, 5);
    EXPECT_EQ(repaired(one).report.faces_flipped, 2u);
    EXPECT_GT(outwardness(repaired(one).mesh, Vec3(0)), 0);
}

TEST(Repair, SidesOfOpenPartsAreKeptOrTurnedOnDemand) {
    const PolygonSoup jar = inverted(kept(make_ball(), [](const Vec3& p) { return p.z < 0.8; }));
    const Surface file = build_surface(jar, {.metres_per_unit = 1, .sides = OpenSides::file});
    const Surface turned = build_surface(jar, {.metres_per_unit = 1, .sides = OpenSides::turned});
    EXPECT_LT(outwardness(file.mesh, Vec3(0)), 0);
    EXPECT_GT(outwardness(turned.mesh, Vec3(0)), 0);
    EXPECT_EQ(file.report.parts_turned + turned.report.parts_turned, 0u) << "nothing that a person must be told";
    EXPECT_THROW(open_sides_of("inside"), Error);
}

TEST(Repair, WhatMayBeMeantToBePaintedInsideKeepsItsSides) {
    const PolygonSoup ball = make_ball();
    const PolygonSoup cup = kept(ball, [](const Vec3&p) { return p.z < 0; }), sheet = make_sheet(4);
    for (const PolygonSoup& soup : {cup, inverted(cup), sheet, inverted(sheet)})
        EXPECT_EQ(repaired(soup).report.parts_turned, 0u);
    EXPECT_LT(outwardness(repaired(inverted(cup)).mesh, Vec3(0)), 0);
    // A shell with a lining: the lining faces inward, and sees nothing at its back.
    PolygonSoup lined = kept(ball, [](const Vec3& p) { return p.z < 0.8; });
    const PolygonSoup lining = inverted(lined);
    const auto base = static_cast<std::uint32_t>(lined.points.size());
    for (const Vec3& p : lining.points) lined.points.push_back(0.95 * p);
    for (std::size_t p = 0; p < lining.n_polygons(); ++p) {
        std::vector<std::uint32_t> corners(lining.corners.begin() + lining.polygon_start[p],
                                           lining.corners.begin() + lining.polygon_start[p + 1]);
        for (std::uint32_t& c : corners) c += base;
        add_polygon(lined, corners);
    }
    EXPECT_EQ(repaired(lined).report.parts_turned, 0u);
    EXPECT_EQ(repaired(inverted(lined)).report.parts_turned, 2u);
}

// As of a car: panels that do not touch, and a flat one outside, of which alone nobody could say.
TEST(Repair, ABodyOfPanelsIsTurnedAsOne) {
    PolygonSoup body;
    const auto add_panel = [&](const PolygonSoup& ball, const Vec3& side) {
        PolygonSoup panel = kept(ball, [&](const Vec3& p) {
            return glm::dot(p, side) > 0.999 * std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        });
        const auto base = static_cast<std::uint32_t>(body.points.size());
        for (const Vec3& p : panel.points) body.points.push_back(p + 0.02 * side);
        for (std::size_t p = 0; p < panel.n_polygons(); ++p) {
            std::vector<std::uint32_t> corners(panel.corners.begin() + panel.polygon_start[p],
                                               panel.corners.begin() + panel.polygon_start[p + 1]);
            for (std::uint32_t& c : corners) c += base;
            add_polygon(body, corners);
        }
    };
    for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)})
        add_panel(make_ball(), side);
    const auto base = static_cast<std::uint32_t>(body.points.size());
    for (const Vec2& p : {Vec2(0, 0), Vec2(0.3, 0), Vec2(0.3, 0.3), Vec2(0, 0.3)})
        body.points.emplace_back(3, p.x, p.y);
    add_polygon(body, {base, base + 1, base + 2, base + 3});
    const Surface sound = repaired(body), turned = repaired(inverted(body));
    EXPECT_EQ(sound.report.parts_turned, 0u);
    EXPECT_EQ(turned.report.parts_turned, 6u);
    EXPECT_GT(outwardness(turned.mesh, Vec3(0)), 0);
}

TEST(Repair, CavityOfAHollowBodyKeepsFacingIntoIt) {
    PolygonSoup hollow = make_box(Vec3(0), Vec3(10));
    add_box(hollow, Vec3(2), Vec3(6));
    const Surface solids = repaired(hollow);  // both outward in the file: a body in a body
    EXPECT_DOUBLE_EQ(signed_volume(solids.mesh), 1000 + 216);
    for (std::size_t p = 6; p < 12; ++p) reverse(hollow, p);
    const Surface s = repaired(hollow);
    EXPECT_DOUBLE_EQ(signed_volume(s.mesh), 1000 - 216);
    EXPECT_EQ(s.report.faces_flipped, 0u);
    EXPECT_EQ(s.report.components, 2u);
}

TEST(Repair, MoebiusStripIsCutOpen) {
    constexpr std::uint32_t kSteps = 40;
    PolygonSoup strip;
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const double u = 6.283185307179586 * i / kSteps;
        for (const double w : {-1.0, 0.0, 1.0})
            strip.points.emplace_back((5 + w * std::cos(u / 2)) * std::cos(u), (5 + w * std::cos(u / 2)) * std::sin(u),
                                      w * std::sin(u / 2));
    }
    for (std::uint32_t i = 0; i < kSteps; ++i)
        for (std::uint32_t w = 0; w < 2; ++w) {
            const bool last = i + 1 == kSteps;  // the ring closes with the other edge up
            const std::uint32_t a = 3 * i + w, b = a + 1;
            const std::uint32_t c = last ? 2 - w : a + 3, d = last ? 1 - w : b + 3;
            add_polygon(strip, {a, c, d, b});
        }
    const Surface s = repaired(strip);
    EXPECT_THAT(texts(s.report.warnings), ElementsAre(HasSubstr("one side")));
    EXPECT_EQ(s.mesh.n_triangles(), 4u * kSteps);
    EXPECT_EQ(s.report.components, 1u);
    EXPECT_EQ(s.report.non_manifold.vertices_split, 0u);
}

TEST(Repair, CountsPartsHolesAndBorders) {
    PolygonSoup soup = make_sheet(5);
    // Takes out the middle square: a hole with four edges in a rim of twenty.
    std::vector<std::uint32_t> corners;
    for (std::size_t p = 0; p < soup.n_polygons(); ++p)
        if (p / 2 != 12)
            corners.insert(corners.end(), soup.corners.begin() + 3 * static_cast<std::ptrdiff_t>(p),
                           soup.corners.begin() + 3 * static_cast<std::ptrdiff_t>(p) + 3);
    soup.corners = corners;
    soup.polygon_start.resize(corners.size() / 3 + 1);
    add_box(soup, Vec3(20), Vec3(1));
    soup.points.emplace_back(50, 50, 50);
    const Surface s = repaired(soup);
    EXPECT_EQ(s.report.components, 2u);
    EXPECT_EQ(s.report.holes, 2u);
    EXPECT_EQ(s.report.border_edges, 24u);
    EXPECT_FALSE(s.report.closed);
    EXPECT_EQ(s.report.unused_vertices_dropped, 1u);
    EXPECT_EQ(s.report.file.polygons_triangulated, 6u);
    EXPECT_EQ(s.report.file.points, 36u + 8u + 1u);
    EXPECT_EQ(s.report.file.polygons, 48u + 6u);
}

TEST(Repair, KeepsColoursGroupsAndTextureCoordinatesThroughEverything) {
    PolygonSoup cubes = make_box();
    add_box(cubes, Vec3(1, 1, 0), Vec3(1));
    set_uvs_to_position(cubes);
    cubes.group_names = {"left", "right"};
    for (std::size_t p = 0; p < 12; ++p) cubes.polygon_groups.push_back(p < 6 ? 0 : 1);
    for (const Vec3& p : cubes.points)
        cubes.point_colours.push_back({static_cast<std::uint8_t>(10 * p.x), static_cast<std::uint8_t>(10 * p.y),
                                       static_cast<std::uint8_t>(10 * p.z), 255});
    const Surface s = repaired(cubes);
    for (std::size_t t = 0; t < s.mesh.n_triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = s.mesh.triangles[t][k];
            const Vec3f p = s.mesh.positions[v];
            EXPECT_EQ(s.mesh.corner_uvs[3 * t + k], Vec2f(p.x, p.y));
            EXPECT_EQ(s.mesh.vertex_colours[v][1], static_cast<std::uint8_t>(10 * p.y));
            EXPECT_EQ(s.mesh.triangle_groups[t], t < 12 ? 0u : 1u);
        }
    EXPECT_THAT(s.mesh.group_names, ElementsAre("left", "right"));
}

TEST(Repair, PartsAreKeptAndOneWithoutAFaceLeftIsNamed) {
    PolygonSoup cubes = make_box();
    add_box(cubes, Vec3(0), Vec3(1));  // on the faces of the first one
    add_box(cubes, Vec3(3, 0, 0), Vec3(1));
    cubes.scene = std::make_shared<SourceScene>();
    for (const char* name : {"body", "double", "wheel"}) cubes.scene->parts.push_back({.object = name});
    cubes.group_names = {"paint", "rubber"};
    for (std::uint32_t p = 0; p < 18; ++p) {
        cubes.polygon_parts.push_back(p / 6);
        cubes.polygon_groups.push_back(p < 12 ? 0 : 1);
    }
    const Surface s = repaired(cubes);
    ASSERT_EQ(s.mesh.triangle_parts.size(), 24u);
    for (std::size_t t = 0; t < 24; ++t) {
        EXPECT_EQ(s.mesh.triangle_parts[t], t < 12 ? 0u : 2u);
        EXPECT_EQ(s.mesh.triangle_groups[t], t < 12 ? 0u : 1u);
    }
    EXPECT_EQ(s.mesh.scene->parts[2].object, "wheel");
    EXPECT_THAT(texts(s.report.warnings),
                ElementsAre("1 part of the file has no face left ('double'): all of its 6 faces are "
                            "without an area or lie on faces of other parts"));
    cubes.polygon_parts[5] = 3;
    EXPECT_THROW(build_surface(cubes), Error);
}

TEST(Repair, NormalsSplitAtCreasesOnly) {
    const Surface box = repaired(make_box());
    for (std::size_t c = 0; c < 36; ++c) {  // every corner has its face's normal
        const Vec3 p = box.mesh.position(c / 3, 0);
        const Vec3 n = glm::cross(box.mesh.position(c / 3, 1) - p, box.mesh.position(c / 3, 2) - p);
        EXPECT_NEAR(glm::length(Vec3(box.mesh.corner_normals[c]) - n), 0, 1e-6);
    }
    // On the torus the normal is known: away from the centre line of the tube. The angle-weighted
    // mean over squares of 6 degrees errs by the square of that angle.
    const Surface torus = repaired(make_torus(60, 60));
    for (std::size_t c = 0; c < 3 * torus.mesh.n_triangles(); ++c) {
        const Vec3 p(torus.mesh.positions[torus.mesh.triangles[c / 3][c % 3]]);
        const Vec3 centre = 30.0 * glm::normalize(Vec3(p.x, p.y, 0));
        EXPECT_NEAR(glm::length(Vec3(torus.mesh.corner_normals[c]) - (p - centre) / 10.0), 0, 0.011);
    }
    // 36-degree facets are smooth, 45-degree ones are not.
    for (const std::uint32_t sides : {8u, 10u}) {
        PolygonSoup prism;
        for (std::uint32_t i = 0; i < sides; ++i)
            for (const double z : {0.0, 1.0}) {
                const double a = 6.283185307179586 * i / sides;
                prism.points.emplace_back(std::cos(a), std::sin(a), z);
            }
        for (std::uint32_t i = 0; i < sides; ++i) {
            const std::uint32_t j = (i + 1) % sides;
            add_polygon(prism, {2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
        }
        const Surface s = repaired(prism);
        const Vec3 p(s.mesh.positions[s.mesh.triangles[0][0]]);
        const double radial = glm::dot(Vec3(s.mesh.corner_normals[0]), Vec3(p.x, p.y, 0));
        if (sides == 10)
            EXPECT_GT(radial, std::cos(0.5 * 36 * 0.01745329 / 2));
        else
            EXPECT_NEAR(radial, std::cos(22.5 * 0.01745329), 1e-5);
    }
}

TEST(Repair, SameBitsForAnyNumberOfThreads) {
    PolygonSoup soup = make_torus(90, 70);
    for (std::size_t p = 0; p < soup.n_polygons(); p += 37) reverse(soup, p);
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        const Surface s = build_surface(soup);
        std::uint64_t h = hash_span(std::span<const Vec3f>(s.mesh.positions));
        h = hash_span(std::span<const std::array<std::uint32_t, 3>>(s.mesh.triangles), h);
        hashes.push_back(hash_span(std::span<const Vec3f>(s.mesh.corner_normals), h));
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Repair, NothingLeftIsAnError) {
    PolygonSoup flat;
    flat.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    add_polygon(flat, {0, 1, 2});
    EXPECT_THROW(build_surface(flat), Error);
    EXPECT_THROW(build_surface(PolygonSoup{}), Error);
    PolygonSoup box = make_box();
    EXPECT_THROW(build_surface(box, {.metres_per_unit = 0}), Error);
    box.corners[5] = 1000;
    EXPECT_THROW(build_surface(box), Error);
    box = make_box();
    box.points[3].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(build_surface(box), Error);
}

TEST(Repair, StopsOnRequest) {
    RepairOptions options;
    options.progress = [](std::string_view phase, double) { return phase != "matching edges"; };
    EXPECT_THROW(build_surface(make_box(), options), Cancelled);
}

}  // namespace
}  // namespace tuft::mesh
