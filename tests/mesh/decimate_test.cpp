#include "mesh/repair/decimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/error.h"
#include "mesh_checks.h"

/// Decimated copies, and normals that a file brings along.
namespace tuft::mesh {
namespace {

const RepairOptions kMetres{.metres_per_unit = 1};

TEST(Decimate, AClosedSurfaceStaysClosedAndOfItsGenus) {
    const TriangleMesh full = build_surface(make_torus(120, 60), kMetres).mesh;
    const PolygonSoup soup = decimate(full, {.n_triangles = 1000});
    EXPECT_LE(soup.n_polygons(), 1000u);
    EXPECT_GT(soup.n_polygons(), 900u);
    const Surface copy = build_surface(soup, kMetres);
    EXPECT_TRUE(copy.report.closed);
    EXPECT_TRUE(broken_promises(copy).empty());
    EXPECT_EQ(2 * copy.mesh.n_vertices(), copy.mesh.n_triangles()) << "Euler: V - E + F = 0 on a torus, E = 3F/2";
    EXPECT_EQ(copy.report.vertices_welded + copy.report.degenerate_faces_dropped, 0u);
}

// Collapses on a rough surface of 46,000 triangles fold some back to back; those go in pairs.
TEST(Decimate, ARoughScanStaysClosed) {
    PolygonSoup rough = make_torus(240, 96);
    for (std::size_t i = 0; i < rough.points.size(); ++i)
        rough.points[i] *= 1 + 0.03 * std::sin(double(i * i % 1009)) + 0.05 * std::sin(0.7 * double(i % 96));
    const TriangleMesh full = build_surface(std::move(rough), kMetres).mesh;
    const Surface copy = build_surface(decimate(full, {.n_triangles = 2500}), kMetres);
    EXPECT_TRUE(copy.report.closed);
    EXPECT_GT(copy.mesh.n_triangles(), 2000u);
}

TEST(Decimate, TheVerticesLeftAreVerticesOfTheModel) {
    const TriangleMesh full = build_surface(make_torus(60, 30), kMetres).mesh;
    std::set<std::array<float, 3>> known;
    for (const Vec3f& p : full.positions) known.insert({p.x, p.y, p.z});
    for (const Vec3& p : decimate(full, {.n_triangles = 500}).points)
        EXPECT_TRUE(known.contains({float(p.x), float(p.y), float(p.z)}));
}

TEST(Decimate, AFlatSheetLosesAllThatItsOutlineDoesNotNeed) {
    const TriangleMesh full = build_surface(make_sheet(40), kMetres).mesh;
    const PolygonSoup soup = decimate(full, {.error = 1e-6});
    EXPECT_LE(soup.n_polygons(), 16u);
    EXPECT_NEAR(surface_area(build_surface(soup, kMetres).mesh), 1600, 1e-3);
}

TEST(Decimate, GroupsAndUvsEndWhereTheyDid) {
    PolygonSoup sheet = make_sheet(40);
    set_uvs_to_position(sheet);
    sheet.group_names = {"left", "right"};
    for (std::size_t p = 0; p < sheet.n_polygons(); ++p)
        sheet.polygon_groups.push_back(sheet.points[sheet.corners[3 * p]].x < 12 ? 0 : 1);
    const PolygonSoup soup = decimate(build_surface(sheet, kMetres).mesh, {.error = 1e-6});
    EXPECT_LT(soup.n_polygons(), 60u);
    const TriangleMesh copy = build_surface(soup, kMetres).mesh;
    double left = 0;
    for (std::size_t t = 0; t < copy.n_triangles(); ++t) {
        const Vec3 a = copy.position(t, 0), b = copy.position(t, 1), c = copy.position(t, 2);
        if (copy.triangle_groups[t] == 0) left += 0.5 * glm::length(glm::cross(b - a, c - a));
        for (int k = 0; k < 3; ++k) {
            const Vec2f uv = copy.corner_uvs[3 * t + static_cast<std::size_t>(k)];
            EXPECT_EQ(Vec2f(copy.position(t, k)), uv);
        }
    }
    EXPECT_NEAR(left, 12 * 40, 1e-3);
}

// The walls of a plate 0.2 mm thick collapse at 0.5 mm; what is left lies back to back and went as a fin. A flat body,
// closed by two diagonals, went by itself.
TEST(Decimate, ThinClosedPartsStay) {
    for (const double thick : {0.0, 0.2}) {
        PolygonSoup soup = make_torus(60, 30);
        const auto n = static_cast<std::uint32_t>(soup.points.size());
        for (const double z : {0.0, thick})
            for (const Vec2& p : {Vec2(60, 0), Vec2(80, 0), Vec2(80, 20), Vec2(60, 20)}) soup.points.emplace_back(p, z);
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            add_polygon(soup, {n + a, n + b, n + c});
        };
        add(0, 2, 1), add(0, 3, 2), add(4, 5, 7), add(5, 6, 7);
        for (std::uint32_t k = 0; thick > 0 && k < 4; ++k) {
            const std::uint32_t next = (k + 1) % 4;
            add(k, next, next + 4), add(k, next + 4, k + 4);
        }
        const TriangleMesh full = build_surface(soup, kMetres).mesh;
        for (const DecimateOptions& how : {DecimateOptions{.error = 0.5}, DecimateOptions{.n_triangles = 1000}}) {
            const PolygonSoup copy = decimate(full, how);
            double corner = 0;
            for (const Vec3& p : copy.points) corner = std::max(corner, p.x + p.y);
            EXPECT_NEAR(corner, 100, 1e-5) << thick << ' ' << how.error;
            EXPECT_LT(copy.n_polygons(), how.n_triangles > 0 ? how.n_triangles + 1 : 700);
        }
    }
}

// Each part that would go is reduced by itself: in the time of its own vertices, or 4,000 of them would take minutes.
TEST(Decimate, ThousandsOfThinPartsStay) {
    PolygonSoup soup = make_torus(60, 30);
    for (int i = 0; i < 4000; ++i) {
        const auto n = static_cast<std::uint32_t>(soup.points.size());
        const double x = 100 + 3 * (i % 64), y = 3.0 * (i / 64);
        for (const Vec2& p : {Vec2(0, 0), Vec2(2, 0), Vec2(2, 2), Vec2(0, 2)})
            soup.points.emplace_back(x + p.x, y + p.y, 0);
        for (const auto& [a, b, c] : {std::array{0u, 2u, 1u}, {0u, 3u, 2u}, {0u, 1u, 3u}, {1u, 2u, 3u}})
            add_polygon(soup, {n + a, n + b, n + c});
    }
    const PolygonSoup copy = decimate(build_surface(soup, kMetres).mesh, {.error = 0.5});
    EXPECT_GE(copy.n_polygons(), 4 * 4000u);
}

// Plates that come back take triangles from the rest, of which larger rings went then.
TEST(Decimate, NoPartGoesForASmallerOne) {
    PolygonSoup soup = make_torus(120, 60);
    constexpr int kParts = 40;
    std::array<double, kParts> sizes{};  // of the boxes, about
    for (std::size_t part = 0; part < kParts; ++part) {
        const auto n = static_cast<std::uint32_t>(soup.points.size());
        const double x = 100 + 10 * static_cast<double>(part);
        if (part % 2 == 0) {  // a plate of no thickness
            sizes[part] = 1.5;
            const double side = sizes[part] / std::sqrt(2.0);
            for (const Vec2& p : {Vec2(0, 0), Vec2(side, 0), Vec2(side, side), Vec2(0, side)})
                soup.points.emplace_back(x + p.x, p.y, 0);
            for (const auto& [a, b, c] : {std::array{0u, 2u, 1u}, {0u, 3u, 2u}, {0u, 1u, 3u}, {1u, 2u, 3u}})
                add_polygon(soup, {n + a, n + b, n + c});
            continue;
        }
        sizes[part] = 1.7 + 0.1 * static_cast<double>(part);
        const PolygonSoup ring = make_torus(12, 8);
        Box box;
        for (const Vec3& p : ring.points) box.add(p);
        for (const Vec3& p : ring.points) soup.points.push_back(Vec3(x, 0, 0) + sizes[part] / box.diagonal() * p);
        for (std::size_t c = 0; c < ring.corners.size(); c += 3)
            add_polygon(soup, {n + ring.corners[c], n + ring.corners[c + 1], n + ring.corners[c + 2]});
    }
    const TriangleMesh full = build_surface(soup, kMetres).mesh;
    for (const std::size_t n_triangles : {200u, 300u, 400u, 600u, 1000u}) {
        const PolygonSoup copy = decimate(full, {.n_triangles = n_triangles});
        EXPECT_LE(copy.n_polygons(), n_triangles);
        std::array<bool, kParts> there{};
        for (const Vec3& p : copy.points)
            if (p.x > 90) there.at(static_cast<std::size_t>((p.x - 95) / 10)) = true;
        double smallest = 1e9, largest_lost = 0;
        for (std::size_t part = 0; part < kParts; ++part) {
            if (there[part])
                smallest = std::min(smallest, sizes[part]);
            else
                largest_lost = std::max(largest_lost, sizes[part]);
        }
        EXPECT_LE(largest_lost, smallest) << n_triangles;
    }
}

TEST(Decimate, SameMeshSameBitsAndNoLimitIsRefused) {
    const TriangleMesh full = build_surface(make_torus(60, 30), kMetres).mesh;
    const PolygonSoup a = decimate(full, {.n_triangles = 500}), b = decimate(full, {.n_triangles = 500});
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.corners, b.corners);
    EXPECT_THROW(decimate(full, {}), Error);
}

/// A box whose corners all have normals that lean by `lean` from those of its faces, away from the middle.
PolygonSoup leaning_box(double lean) {
    PolygonSoup box = make_box(Vec3(-0.5));
    for (std::size_t p = 0; p < box.n_polygons(); ++p) {
        const auto corner = [&](std::size_t k) { return box.points[box.corners[4 * p + k]]; };
        const Vec3 face = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3 out = glm::normalize(corner(k) - glm::dot(corner(k), face) * face);
            box.corner_normals.emplace_back(std::cos(lean) * face + std::sin(lean) * out);
        }
    }
    return box;
}

/// The greatest angle between a corner's normal and that of its triangle.
double greatest_lean(const TriangleMesh& m) {
    double most = 0;
    for (std::size_t c = 0; c < m.corner_normals.size(); ++c)
        most = std::max(most, std::acos(std::min(1.0, glm::dot(Vec3(m.corner_normals[c]), face_normal(m, c / 3)))));
    return most;
}

TEST(FileNormals, AreKeptThroughTriangulationTurningAndYUp) {
    const double lean = 0.5;
    // Floats under acos: 1e-6 of an angle of 0.5.
    EXPECT_NEAR(greatest_lean(build_surface(leaning_box(lean), kMetres).mesh), lean, 1e-5);
    RepairOptions y_up = kMetres;
    y_up.y_up = true;
    EXPECT_NEAR(greatest_lean(build_surface(leaning_box(lean), y_up).mesh), lean, 1e-5);
    PolygonSoup inside_out = leaning_box(lean);
    for (std::size_t p = 0; p < inside_out.n_polygons(); ++p) {
        std::reverse(inside_out.corners.begin() + 4 * static_cast<std::ptrdiff_t>(p),
                     inside_out.corners.begin() + 4 * static_cast<std::ptrdiff_t>(p) + 4);
        std::reverse(inside_out.corner_normals.begin() + 4 * static_cast<std::ptrdiff_t>(p),
                     inside_out.corner_normals.begin() + 4 * static_cast<std::ptrdiff_t>(p) + 4);
    }
    for (Vec3f& n : inside_out.corner_normals) n = -n;
    EXPECT_NEAR(greatest_lean(build_surface(inside_out, kMetres).mesh), lean, 1e-5);
}

TEST(FileNormals, ThatAreNoneOrAgainstTheirTriangleGiveWay) {
    PolygonSoup box = leaning_box(1.2);  // 69 degrees
    box.corner_normals[0] = Vec3f(NAN);
    EXPECT_NEAR(greatest_lean(build_surface(box, kMetres).mesh), 0, 1e-3);
    box.corner_normals.pop_back();
    EXPECT_THROW(build_surface(box, kMetres), Error);
}

}  // namespace
}  // namespace tuft::mesh
