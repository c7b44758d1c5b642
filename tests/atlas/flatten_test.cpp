#include "atlas/flatten/flatten.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>

#include "atlas/charts/charts.h"
#include "atlas/charts/merge.h"
#include "atlas/charts/transfer_uvs.h"
#include "atlas/pack/snap.h"
#include "atlas/seams/seam_graph.h"
#include "atlas/seams/straighten.h"
#include "nasty_meshes.h"

namespace tuft::atlas {
namespace {

constexpr double kPi = std::numbers::pi;

ChartMesh whole_chart(const mesh::TriangleMesh& m) {
    std::vector<std::uint32_t> all(m.n_triangles());
    std::iota(all.begin(), all.end(), 0u);
    return make_chart(m, twin_half_edges(m), all, std::sqrt(mesh::surface_area(m)));
}

mesh::TriangleMesh cylinder_part(double turn) {
    return test::grid_mesh(60, 20, false, false,
                           [&](double u, double v) { return Vec3(std::cos(turn * u), std::sin(turn * u), 2 * v); });
}

// Facets of a developable surface unroll exactly; what is left is where the iteration stops.
TEST(Flatten, UnrollsCylindersAndCones) {
    for (const double turn : {0.5, 2.0, 4.0, 6.0}) {
        const ChartMesh cylinder = whole_chart(cylinder_part(turn));
        ASSERT_TRUE(cylinder.disk);
        const FlatCheck check = check_flat(cylinder, flatten(cylinder));
        EXPECT_TRUE(check.sound()) << turn;
        EXPECT_NEAR(check.l2, 1, 1e-4) << turn;
        const ChartMesh cone = whole_chart(test::grid_mesh(60, 20, false, false, [&](double u, double v) {
            const double r = 0.3 + v;
            return Vec3(r * std::cos(turn * u), r * std::sin(turn * u), 1.5 * v);
        }));
        EXPECT_NEAR(check_flat(cone, flatten(cone)).l2, 1, 1e-4) << turn;
    }
}

/// Where a corner lies on a cylinder's part whose facets are laid out in the plane, and that turned and shifted.
Vec2 unrolled(const Vec3& p, double turn) {
    const double facet = std::round(60 * std::atan2(p.y, p.x) / turn);
    return {2 * facet * std::sin(turn / 120), p.z};
}

Vec2 elsewhere(const Vec2& p) {
    return {std::cos(1.0) * p.x - std::sin(1.0) * p.y + 7, std::sin(1.0) * p.x + std::cos(1.0) * p.y - 3};
}

FlatChart flat_chart(const mesh::TriangleMesh& m, std::span<const std::uint32_t> glued,
                     const std::vector<std::uint32_t>& triangles, double turn, bool moved) {
    FlatChart chart;
    chart.mesh = make_chart(m, glued, triangles, 1);
    chart.uv.resize(chart.mesh.n_vertices());
    for (std::size_t f = 0; f < chart.mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Vec2 p = unrolled(m.position(chart.mesh.triangles[f], k), turn);
            chart.uv[chart.mesh.faces[f][k]] = moved ? elsewhere(p) : p;
        }
    return chart;
}

/// Half-edges glued over all edges but those between triangles of different sides.
std::vector<std::uint32_t> glued_within(const mesh::TriangleMesh& m, const std::vector<std::uint8_t>& side) {
    std::vector<std::uint32_t> glued = twin_half_edges(m);
    for (std::uint32_t h = 0; h < glued.size(); ++h)
        if (glued[h] != kNone && side[h / 3] != side[glued[h] / 3]) glued[h] = kNone;
    return glued;
}

// Two charts of one developable surface fit together without stretch wherever each of them lies: what
// one takes over from the other comes to lie as if it had always been its own. 1e-12: rounding, of
// places about 10 in size.
TEST(TransferUvs, IsExactBetweenChartsOfADevelopableSurface) {
    const double turn = 2.0;
    const mesh::TriangleMesh m = cylinder_part(turn);
    std::vector<std::uint8_t> before(m.n_triangles()), after(m.n_triangles());
    std::vector<std::uint32_t> left, right, taken, grown;
    for (std::uint32_t t = 0; t < m.n_triangles(); ++t) {
        const Vec3 c = (m.position(t, 0) + m.position(t, 1) + m.position(t, 2)) / 3.0;
        const double u = std::atan2(c.y, c.x) / turn;
        before[t] = u > 0.4 + 0.05 * std::sin(5 * c.z);
        after[t] = u > 0.6 + 0.05 * std::cos(7 * c.z);
        (before[t] ? right : left).push_back(t);
        if (!after[t]) grown.push_back(t);
        if (before[t] && !after[t]) taken.push_back(t);
    }
    const std::vector<std::uint32_t> old_seam = glued_within(m, before), new_seam = glued_within(m, after);
    const FlatChart own = flat_chart(m, old_seam, left, turn, false),
                    donor = flat_chart(m, old_seam, right, turn, true);
    const FlatChart truth = flat_chart(m, new_seam, grown, turn, false);
    const std::vector<Vec2> uv = transfer_uvs(own, donor, taken, truth.mesh);
    ASSERT_GT(taken.size(), 300u);
    for (std::size_t v = 0; v < uv.size(); ++v) EXPECT_LT(glm::length(uv[v] - truth.uv[v]), 1e-12);
}

// SurfaceMapping a part anew leaves all corners outside it where they are to the bit, and pulls those inside back
// to where a developable surface has no stretch: the energy's only minimum there, so that what is left
// is where the iteration stops. 1e-5 of a facet's size 0.033, from 0.3 of it.
TEST(Arap, RefinesOnlyTheGivenFaces) {
    const double turn = 2.0;
    const mesh::TriangleMesh m = cylinder_part(turn);
    std::vector<std::uint32_t> all(m.n_triangles()), part;
    std::iota(all.begin(), all.end(), 0u);
    const FlatChart truth = flat_chart(m, twin_half_edges(m), all, turn, false);
    std::vector<std::uint8_t> outside(truth.uv.size(), 0);
    for (std::uint32_t f = 0; f < all.size(); ++f) {
        const Vec2 c =
            (truth.uv[truth.mesh.faces[f][0]] + truth.uv[truth.mesh.faces[f][1]] + truth.uv[truth.mesh.faces[f][2]]) /
            3.0;
        if (glm::length(c - Vec2(1, 1)) < 0.4)
            part.push_back(f);
        else
            for (const std::uint32_t v : truth.mesh.faces[f]) outside[v] = 1;
    }
    std::vector<Vec2> uv = truth.uv;
    std::size_t inside = 0;
    for (std::size_t v = 0; v < uv.size(); ++v)
        if (!outside[v])
            uv[v] += 0.01 * Vec2(std::sin(12.0 * double(inside)), std::cos(7.0 * double(inside))), ++inside;
    ASSERT_GT(inside, 50u);
    arap(truth.mesh, uv, {.iterations = 2000, .tolerance = 1e-12, .converged_energy = 1e-20}, part);
    for (std::size_t v = 0; v < uv.size(); ++v) {
        if (outside[v])
            EXPECT_EQ(uv[v], truth.uv[v]);
        else
            EXPECT_LT(glm::length(uv[v] - truth.uv[v]), 1e-5 * 0.033);
    }
}

// Bounded charts are what makes large meshes linear: a sheet that would be one chart becomes
// several, and merging them keeps to the bound.
TEST(Charts, HoldNoMoreTrianglesThanAllowed) {
    const mesh::TriangleMesh sheet =
        test::grid_mesh(40, 40, false, false, [](double u, double v) { return Vec3(u, v, 0); });
    ChartOptions options;
    EXPECT_EQ(cut_into_charts(sheet, options, {}).charts.size(), 1u);
    options.triangles = 500;
    CutMesh cut = cut_into_charts(sheet, options, {});
    MergeOptions all;
    all.largest_chart = 1;
    merge_charts(sheet, cut, options, all, {});
    std::size_t triangles = 0;
    for (const FlatChart& c : cut.charts) {
        EXPECT_LE(c.mesh.faces.size(), 500u);
        triangles += c.mesh.faces.size();
    }
    EXPECT_EQ(triangles, sheet.n_triangles());
}

// Strains of a spherical cap laid flat grow with the square of its angle (Gauss), so L2 − 1,
// their mean square, grows with the fourth power.
TEST(Flatten, StretchOfASphericalCapGrowsWithTheFourthPowerOfItsAngle) {
    const auto excess = [](double angle) {
        const ChartMesh cap = whole_chart(test::grid_mesh(24, 24, false, false, [&](double u, double v) {
            const Vec2 p = (2.0 * Vec2(u, v) - 1.0) * angle / std::sqrt(2.0);
            return glm::normalize(Vec3(std::tan(p.x), std::tan(p.y), 1));
        }));
        ArapOptions options;
        options.iterations = 200;
        options.tolerance = 1e-6;
        const FlatCheck check = check_flat(cap, flatten(cap, options));
        EXPECT_TRUE(check.sound());
        return check.l2 - 1;
    };
    const double order = std::log2(excess(0.6) / excess(0.3));
    EXPECT_NEAR(order, 4, 0.4);  // higher orders of the angle
}

TEST(Flatten, UntanglesAFoldedVertex) {
    const mesh::TriangleMesh m = test::grid_mesh(8, 8, false, false, [](double u, double v) { return Vec3(u, v, 0); });
    const ChartMesh chart = whole_chart(m);
    std::vector<Vec2> uv = flatten(chart);
    for (std::uint32_t v = 0; v < uv.size(); ++v) {
        std::vector<Vec2> folded = uv;
        folded[v] += Vec2(0.35, 0.2);  // over three cells
        EXPECT_TRUE(untangle(chart, folded));
        EXPECT_EQ(check_flat(chart, folded).flips, 0u);
    }
}

TEST(Flatten, NoticesBordersThatCrossOrComeNear) {
    const auto ring = [](double turn, double pitch) {
        const ChartMesh chart = whole_chart(cylinder_part(1));
        std::vector<Vec2> uv(chart.n_vertices());
        for (std::size_t v = 0; v < uv.size(); ++v) {
            // The strip bent to a ring in the plane: along it the angle, across it the radius.
            const Vec3 p = chart.position[v] * std::sqrt(2.0);
            const double along = std::atan2(p.y, p.x + 1), r = 1.4 - 0.2 * p.z + pitch * along;
            uv[v] = r * Vec2(std::cos(turn * along), std::sin(turn * along));
        }
        return std::pair(chart, uv);
    };
    const auto crosses = [&](double turn, double pitch, double gap) {
        const auto [chart, uv] = ring(turn, pitch);
        return crosses_itself(chart, uv, gap);
    };
    EXPECT_FALSE(crosses(5, 0, 0));
    EXPECT_TRUE(crosses(7, 0, 0));      // further than round: over its own beginning
    EXPECT_FALSE(crosses(7, 1, 0));     // a spiral passes outside
    EXPECT_FALSE(crosses(6.2, 0, 0));   // ends 0.08 apart
    EXPECT_TRUE(crosses(6.2, 0, 0.1));  // less than the gap
    EXPECT_FALSE(crosses(6.2, 0, 0.01));
}

TEST(SeamGraph, GluedChartsAreDisks) {
    for (const test::NastyMesh& nasty : test::nasty_meshes()) {
        SCOPED_TRACE(nasty.name);
        const mesh::TriangleMesh& m = nasty.mesh;
        const auto twin = twin_half_edges(m);
        std::vector<std::uint32_t> all(m.n_triangles());
        std::iota(all.begin(), all.end(), 0u);
        const double unit = std::sqrt(mesh::surface_area(m));
        const Patch patch = make_patch(m, twin, all, unit);
        SeamGraph graph(patch, {});
        graph.glue_developable({});
        std::vector<std::uint8_t> seam = graph.seams();
        double before = 0, after = 0;
        for (const bool straight : {false, true}) {
            if (straight) straighten_seams(patch, seam);
            std::vector<std::uint32_t> glued = twin;
            double& length = straight ? after : before;
            for (std::size_t h = 0; h < seam.size(); ++h)
                if (seam[h]) {
                    glued[h] = kNone;
                    length += patch.length[h];
                }
            for (const auto& triangles : connected_charts(glued))
                EXPECT_TRUE(make_chart(m, glued, triangles, unit).disk);
        }
        // Edges bent like creases count for less than their length, 0.6 of it at the least.
        EXPECT_LE(after, before / 0.6);
    }
}

// A graph that begins with given seams keeps no more than those; it is the graph that glued its way there.
TEST(SeamGraph, BegunWithSeamsItIsTheOneThatLeftThem) {
    for (const test::NastyMesh& nasty : test::nasty_meshes()) {
        SCOPED_TRACE(nasty.name);
        const mesh::TriangleMesh& m = nasty.mesh;
        std::vector<std::uint32_t> all(m.n_triangles());
        std::iota(all.begin(), all.end(), 0u);
        const Patch patch = make_patch(m, twin_half_edges(m), all, std::sqrt(mesh::surface_area(m)));
        SeamGraph glued(patch, {});
        glued.glue_developable({});
        SeamGraph begun(patch, glued.seams());
        EXPECT_EQ(begun.seams(), glued.seams());
        // The same charts, by their triangles, areas (summed in another order) and chains.
        std::map<std::uint32_t, std::uint32_t> number;
        for (const std::uint32_t t : all) {
            const auto [it, first] = number.try_emplace(glued.chart_of(t), begun.chart_of(t));
            ASSERT_EQ(it->second, begun.chart_of(t));
        }
        EXPECT_EQ(number.size(), begun.n_charts_at_first());
        for (const auto& [a, b] : number) {
            EXPECT_EQ(glued.n_triangles(a), begun.n_triangles(b));
            EXPECT_NEAR(glued.moments(a).area, begun.moments(b).area, 1e-12);  // of 1, all together
        }
        const std::vector<SeamGraph::Chain> before = glued.chains(), after = begun.chains();
        ASSERT_EQ(before.size(), after.size());
        for (std::size_t i = 0; i < before.size(); ++i) {
            EXPECT_EQ(number[before[i].chart_a], after[i].chart_a);
            EXPECT_EQ(before[i].closed, after[i].closed);
            auto x = glued.half_edges(before[i].id), y = begun.half_edges(after[i].id);
            std::sort(x.begin(), x.end());
            std::sort(y.begin(), y.end());
            EXPECT_EQ(x, y);
        }
    }
}

TEST(Snap, EveryTriangleKeepsAnArea) {
    Random random(3);
    // Fans of needles far narrower than the grid of floats.
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<Vec2> uv{{0.7, 0.6}};
        std::vector<std::array<std::uint32_t, 3>> faces;
        const int n = 12;
        for (int i = 0; i <= n; ++i) {
            const double a = random.uniform(0, 1) + i * 3e-8;
            uv.push_back(Vec2(0.7, 0.6) + 0.1 * Vec2(std::cos(0.5 + i * 4e-7), std::sin(0.5 + i * 4e-7)) + a * 1e-12);
        }
        for (std::uint32_t i = 1; i <= std::uint32_t(n); ++i) faces.push_back({0, i, i + 1});
        const std::vector<Vec2> start = uv;
        EXPECT_TRUE(snap_to_floats(faces, uv, 1024).empty());
        for (const auto& f : faces) {
            Vec2f p[3];
            for (int k = 0; k < 3; ++k) p[k] = Vec2f(uv[f[k]]);
            const double area = (double{p[1].x} - p[0].x) * (double{p[2].y} - p[0].y) -
                                (double{p[1].y} - p[0].y) * (double{p[2].x} - p[0].x);
            EXPECT_GT(area, 0);
        }
        for (std::size_t v = 0; v < uv.size(); ++v)  // no vertex goes far: 1/16 texel each time
            EXPECT_LT(glm::length(uv[v] - start[v]), 0.5 / 1024);
    }
}

/// Largest singular value of the linear map from one triangle to another.
double largest_stretch(const std::array<Vec2, 3>& from, const std::array<Vec2, 3>& to) {
    const Vec2 a = from[1] - from[0], b = from[2] - from[0], c = to[1] - to[0], d = to[2] - to[0];
    const double det = a.x * b.y - a.y * b.x;
    const Vec2 u = (b.y * c - a.y * d) / det, v = (a.x * d - b.x * c) / det;
    const double e = glm::dot(u, u), f = glm::dot(u, v), g = glm::dot(v, v);
    return std::sqrt(0.5 * (e + g + std::sqrt((e - g) * (e - g) + 4 * f * f)));
}

// Rounding alone turns needles that are a hundredth of a step to four steps high over, or shears them.
TEST(Snap, RoundingStretchesNoNeedleThreefold) {
    Random random(5);
    for (int trial = 0; trial < 2000; ++trial) {
        const double step = std::exp2(-24), height = step * std::pow(10.0, random.uniform(-2, 0.6));
        const double angle = random.uniform(0, 6.28), length = random.uniform(0.001, 0.1);
        const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
        const Vec2 first(random.uniform(0.3, 0.6), random.uniform(0.3, 0.6));
        std::vector<Vec2> uv{first, first + length * along,
                             first + random.uniform(0.2, 0.8) * length * along + height * across};
        const std::array<Vec2, 3> before{uv[0], uv[1], uv[2]};
        EXPECT_TRUE(snap_to_floats({{0, 1, 2}}, uv, 1024).empty());
        EXPECT_LT(largest_stretch({uv[0], uv[1], uv[2]}, before), 3) << height / step;
    }
}

}  // namespace
}  // namespace tuft::atlas
