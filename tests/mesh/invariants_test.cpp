#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "mesh/repair/repair.h"
#include "mesh_checks.h"

// A hundred meshes that are wrong in every way at once: whatever went in, the promises of
// TriangleMesh hold for what comes out.
namespace tuft::mesh {
namespace {

using ::testing::ElementsAre;

class Vandal {
  public:
    Vandal(PolygonSoup soup, std::uint64_t seed) : soup_(std::move(soup)), random_(seed) {}

    PolygonSoup run(std::size_t rounds) {
        for (std::size_t i = 0; i < rounds; ++i) damage();
        return std::move(soup_);
    }

  private:
    std::uint32_t below(std::size_t n) {
        return static_cast<std::uint32_t>(random_.uniform() * static_cast<double>(n));
    }
    std::uint32_t point() { return below(soup_.points.size()); }
    std::uint32_t& corner() { return soup_.corners[below(soup_.corners.size())]; }
    std::vector<std::uint32_t> polygon() {
        const std::size_t p = below(soup_.n_polygons());
        return {soup_.corners.begin() + soup_.polygon_start[p], soup_.corners.begin() + soup_.polygon_start[p + 1]};
    }

    void damage() {
        std::vector<std::uint32_t> face = polygon();
        const std::size_t p = below(soup_.n_polygons());
        const auto begin = soup_.corners.begin() + soup_.polygon_start[p];
        const auto end = soup_.corners.begin() + soup_.polygon_start[p + 1];
        switch (below(12)) {
            case 0:
                corner() = point();
                break;  // joins far things
            case 1:
                corner() = face[0];
                break;  // folds a face
            case 2:
                std::reverse(begin, end);
                break;  // shows its back
            case 3:
                add_polygon(soup_, face);
                break;  // twice
            case 4:
                std::reverse(face.begin(), face.end());
                add_polygon(soup_, face);
                break;
            case 5:
                soup_.points[point()] = soup_.points[point()];
                break;  // coincide
            case 6:
                add_polygon(soup_, {face[0], face[1], point()});
                break;  // a fin
            case 7:
                add_polygon(soup_, {point(), point(), point()});
                break;
            case 8: {  // a point on an edge, with a cap
                soup_.points.push_back(0.5 * (soup_.points[face[0]] + soup_.points[face[1]]));
                const auto middle = static_cast<std::uint32_t>(soup_.points.size() - 1);
                add_polygon(soup_, {face[0], middle, face[1]});
                break;
            }
            case 9: {  // a face of its own points
                std::vector<std::uint32_t> copy;
                for (const std::uint32_t c : face) {
                    copy.push_back(static_cast<std::uint32_t>(soup_.points.size()));
                    soup_.points.push_back(soup_.points[c]);
                }
                std::copy(
                    copy.begin(), copy.end(),
                    soup_.corners.end() - static_cast<std::ptrdiff_t>(std::min(copy.size(), soup_.corners.size())));
                break;
            }
            case 10: {  // a large polygon through anything
                std::vector<std::uint32_t> ring;
                for (std::uint32_t k = 0; k < 4 + below(8); ++k) ring.push_back(point());
                add_polygon(soup_, ring);
                break;
            }
            default:
                std::fill(begin, end, face[0]);  // a hole
        }
    }

    PolygonSoup soup_;
    Random random_;
};

PolygonSoup base(std::uint64_t seed) {
    switch (seed % 5) {
        case 0:
            return make_torus(9, 7);
        case 1:
            return make_sheet(7);
        case 2: {
            PolygonSoup soup = make_box();
            add_box(soup, Vec3(1, 0, 0), Vec3(1));  // shares a side
            add_box(soup, Vec3(2, 1, 0), Vec3(1));  // shares an edge
            add_box(soup, Vec3(3, 2, 1), Vec3(1));  // shares a corner
            return soup;
        }
        case 3:
            return make_torus(3, 3);
        default:
            return make_torus(25, 11);
    }
}

TEST(BadMeshes, AHundredBecomeSound) {
    std::size_t split_edges = 0, split_vertices = 0, flipped = 0, mended = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        SCOPED_TRACE(seed);
        PolygonSoup soup = Vandal(base(seed), seed).run(1 + seed);
        if (seed % 3 == 0) set_uvs_to_position(soup);
        const Surface s = build_surface(soup, {.metres_per_unit = 1});
        ASSERT_THAT(broken_promises(s), ElementsAre());
        split_edges += s.report.non_manifold.edges_split;
        split_vertices += s.report.non_manifold.vertices_split;
        flipped += s.report.faces_flipped;
        mended += s.report.degenerate_faces_repaired;
        // Coordinates reach 40, and a mended corner is interpolated: a few roundings of float.
        for (std::size_t c = 0; c < s.mesh.corner_uvs.size(); ++c) {
            const Vec3f p = s.mesh.positions[s.mesh.triangles[c / 3][c % 3]];
            ASSERT_NEAR(glm::distance(s.mesh.corner_uvs[c], Vec2f(p.x, p.y)), 0, 40 * 4 * 6e-8);
        }
    }
    EXPECT_GT(split_edges, 100u);
    EXPECT_GT(split_vertices, 10u);
    EXPECT_GT(flipped, 100u);
    EXPECT_GT(mended, 10u);
}

// A repaired mesh is sound, so repairing it again must find nothing.
TEST(BadMeshes, RepairIsIdempotent) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        const Surface once = build_surface(Vandal(base(seed), seed).run(1 + seed), {.metres_per_unit = 1});
        // A flip beside a split edge may lay a triangle onto another one of other vertices.
        if (once.report.degenerate_faces_repaired) continue;
        PolygonSoup soup;
        for (const Vec3f& p : once.mesh.positions) soup.points.emplace_back(p);
        for (const auto& t : once.mesh.triangles) add_polygon(soup, {t[0], t[1], t[2]});
        const Surface twice = build_surface(soup, {.metres_per_unit = 1});
        EXPECT_THAT(broken_promises(twice), ElementsAre());
        // Split vertices lie on each other and are welded and split again; no face is lost or
        // flipped.
        EXPECT_EQ(twice.mesh.n_triangles(), once.mesh.n_triangles());
        EXPECT_EQ(twice.report.degenerate_faces_dropped, 0u);
        EXPECT_EQ(twice.report.duplicate_faces_dropped, 0u);
    }
}

// Turning, moving and scaling a bad mesh changes neither its topology nor the report.
TEST(BadMeshes, RepairDoesNotDependOnScale) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        const PolygonSoup soup = Vandal(base(seed), seed).run(1 + seed);
        const Surface a = build_surface(soup, {.metres_per_unit = 1});
        const Surface b = build_surface(soup, {.metres_per_unit = 1.0 / 1024});  // exact in binary
        EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
        EXPECT_EQ(a.mesh.neighbours, b.mesh.neighbours);
        EXPECT_EQ(a.report.faces_flipped, b.report.faces_flipped);
    }
}

}  // namespace
}  // namespace tuft::mesh
