#include "atlas/texels/texel_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <sstream>

#include "analytic_surfaces.h"
#include "atlas/texels/border_cells.h"
#include "atlas/texels/cluster_graph.h"
#include "atlas/texels/log_map.h"
#include "atlas/texels/seam_links.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/random.h"
#include "core/system/parallel.h"
#include "paths.h"

namespace tuft::atlas {
namespace {

using testing::Unwrapped;

std::uint64_t hash_of(const TexelMap& m) {
    std::uint64_t h = hash_bytes(m.tiles.data(), m.tiles.size() * sizeof(TexelTile));
    h = hash_bytes(m.shapes.data(), m.shapes.size() * sizeof(TexelShape), h);
    h = hash_bytes(m.packed.data(), m.packed.size() * sizeof(PackedShape), h);
    h = hash_span(std::span<const std::uint32_t>(m.cluster_chart), h);
    return hash_span(std::span<const float>(m.reach), h);
}

std::size_t covered(const TexelMap& m) {
    std::size_t n = 0;
    for (const TexelTile& tile : m.tiles) {
        for (const std::uint8_t p : tile.cluster) n += p != kNoCluster;
    }
    return n;
}

double total_area(const TexelMap& m) {
    double a = 0;
    for (const TexelTile& tile : m.tiles) {
        for (const float t : tile.area) a += t;
    }
    return a;
}

TEST(TexelMap, SharedEdgesBelongToOneTriangleEach) {
    Unwrapped u = testing::sheet(0.1, 1, 64, 8);
    const std::uint32_t size = u.atlas.size;
    for (Vec2f& uv : u.atlas.corner_uvs)  // onto texel centres: every mesh edge runs through some
        uv = (glm::round(uv * float(size)) + 0.5f) / float(size);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    EXPECT_EQ(covered(map), 64u * 64u);  // a half-open square of 64 texels
}

TEST(TexelMap, PositionsAndAreasAreThoseOfTheSheet) {
    const Unwrapped u = testing::sheet(0.1, 3, 60);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    // Texel centres sample nine 60-texel squares at any phase: at most one row too many or few.
    EXPECT_NEAR(double(covered(map)), 9 * 3600, 9 * 61);
    const double texel = 0.1 / 180;
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        const TexelTile& tile = map.tiles[slot];
        for (int t = 0; t < kTileTexels; ++t) {
            if (tile.cluster[t] == kNoCluster) {
                EXPECT_EQ(tile.area[t], 0);
                continue;
            }
            EXPECT_NEAR(map.position(slot, t).z, 0, 1e-9);
            EXPECT_EQ(map.normal(slot, t).z, 1);
            const std::uint32_t x = map.tile_of_slot[slot] % map.tiles_per_side * kTile + t % kTile,
                                y = map.tile_of_slot[slot] / map.tiles_per_side * kTile + t / kTile;
            bool inside = true;  // not beside a seam
            for (int k = 0; k < 25; ++k) inside = inside && texel_ref(map, x + k % 5 - 2, y + k / 5 - 2).valid();
            // Snapping to 1/4096 texel over grid cells of 7.5 texels.
            if (inside) {
                EXPECT_NEAR(tile.area[t] / (texel * texel), 1, 1e-3);
            }
        }
    }
    EXPECT_NEAR(map.texel_size, texel, 1e-3 * texel);
}

TEST(TexelMap, AreasAddUpToTheSphere) {
    const Unwrapped u = testing::sphere(0.02, 128);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    // Sum over centres of a smooth density: the error is the 3·128 border texels' halves, random.
    EXPECT_NEAR(total_area(map) / mesh::surface_area(u.mesh), 1, 3e-3);
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        for (int t = 0; t < kTileTexels; ++t) {
            if (map.tiles[slot].cluster[t] == kNoCluster) continue;
            const Vec3 p(map.position(slot, t)), n(map.normal(slot, t));
            // Facets 1/48 of 90° wide, √2 as long across: sag r (√2 π/192)²/2 = 2.7e-4 r, and up
            // to 1.2 times that where the faces of the cube are stretched.
            EXPECT_NEAR(glm::length(p), 0.02, 4e-4 * 0.02);
            EXPECT_GT(glm::dot(n, glm::normalize(p)), 1 - 1e-4);
        }
    }
}

TEST(TexelMap, SameBitsForAnyNumberOfThreads) {
    const Unwrapped u = testing::sphere(0.02, 100);
    std::set<std::uint64_t> maps, packed, graphs, links;
    for (const int n : {1, 2, 4, 8}) {
        set_thread_count(n);
        const TexelMap map = build_texel_map(u.mesh, u.atlas);
        packed.insert(hash_of(build_texel_map(u.mesh, u.atlas, {}, TexelStore::packed)));
        const ClusterGraph graph = build_cluster_graph(u.mesh, u.atlas, map);
        maps.insert(hash_of(map));
        graphs.insert(hash_span(std::span<const ClusterEdge>(graph.edges)));
        const SeamLinks seam = build_seam_links(u.mesh, u.atlas, map);
        std::uint64_t h = 0;
        for (const SeamLink& l : seam.links) {
            h = hash_bytes(&l.weight, sizeof l.weight, h);
            h = hash_bits(h, l.other_slot * 65536ull + l.texel * 256ull + l.other_texel);
        }
        links.insert(h);
    }
    set_thread_count(0);
    EXPECT_EQ(maps.size(), 1u);
    EXPECT_EQ(packed.size(), 1u);
    EXPECT_EQ(graphs.size(), 1u);
    EXPECT_EQ(links.size(), 1u);
}

TEST(TexelMap, SixteenBitsKeepPlacesAndNormals) {
    // Charts so small that most tiles hold clusters of several, far apart in space.
    for (const double texels : {9.0, 160.0}) {
        const Unwrapped u = testing::sphere(0.02, texels);
        const TexelMap exact = build_texel_map(u.mesh, u.atlas, {}, TexelStore::floats);
        const TexelMap small = build_texel_map(u.mesh, u.atlas, {}, TexelStore::packed);
        ASSERT_EQ(exact.n_slots(), small.n_slots());
        EXPECT_EQ(exact.cluster_start, small.cluster_start);
        EXPECT_TRUE(small.shapes.empty());
        double worst_place = 0, worst_normal = 0;
        TexelShape room;
        for (std::uint32_t slot = 0; slot < exact.n_slots(); ++slot) {
            EXPECT_EQ(exact.tiles[slot].cluster, small.tiles[slot].cluster);
            const TexelShape& shape = shape_of(small, slot, room);
            for (int t = 0; t < kTileTexels; ++t) {
                if (exact.tiles[slot].cluster[t] == kNoCluster) continue;
                // Beside seams they come from the places, which are off by 4e-4 of a texel.
                ASSERT_NEAR(exact.tiles[slot].area[t] / small.tiles[slot].area[t], 1, 4e-3);
                const Vec3f p = small.position(slot, t), n = small.normal(slot, t);
                // One texel at a time or the whole tile, the same bits.
                EXPECT_EQ(p, Vec3f(shape.px[t], shape.py[t], shape.pz[t]));
                EXPECT_EQ(n, Vec3f(shape.nx[t], shape.ny[t], shape.nz[t]));
                EXPECT_NEAR(glm::length(n), 1, 2e-7);
                worst_place = std::max(worst_place, double(glm::length(p - exact.position(slot, t))));
                worst_normal = std::max(worst_normal, double(glm::length(n - exact.normal(slot, t))));
            }
        }
        // Half a step of a box of 16 √2 texels (stretched by up to 1.3) on each of three axes.
        EXPECT_LT(worst_place, 0.5 * std::sqrt(3.0) * 16 * std::sqrt(2.0) * 1.3 / 65535 * exact.texel_size);
        // Half a step of 2/65535 in u and in v moves the octahedron's point by √6 times that, and
        // in the middle of a face it is √3 times nearer than the sphere; float rounding.
        EXPECT_LT(worst_normal, std::sqrt(18.0) / 65535 + 2e-7);
    }
}

TEST(TexelMap, PacksAtlasesFrom4096TexelsOn) {
    EXPECT_FALSE(is_packed(TexelStore::automatic, 4095));
    EXPECT_TRUE(is_packed(TexelStore::automatic, 4096));
    EXPECT_FALSE(is_packed(TexelStore::floats, 16384));
    EXPECT_TRUE(is_packed(TexelStore::packed, 16));
}

TEST(TexelMap, AnUnpackedTileDoesNotDependOnWhatTheBufferHeld) {
    // Charts so small that there are tiles of one cluster, of a few and of many, all with texels that no chart covers.
    const Unwrapped u = testing::sphere(0.02, 9);
    const TexelMap map = build_texel_map(u.mesh, u.atlas, {}, TexelStore::packed);
    TexelShape zeros{}, marked{};
    std::size_t uncovered = 0;
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        zeros.px.fill(0), zeros.py.fill(0), zeros.pz.fill(0);
        marked.px.fill(7), marked.py.fill(7), marked.pz.fill(7);
        shape_of(map, slot, zeros);
        shape_of(map, slot, marked);
        uncovered += static_cast<std::size_t>(std::ranges::count(map.tiles[slot].cluster, kNoCluster));
        EXPECT_EQ(zeros.px, marked.px) << "slot " << slot;
        EXPECT_EQ(zeros.py, marked.py) << "slot " << slot;
        EXPECT_EQ(zeros.pz, marked.pz) << "slot " << slot;
    }
    EXPECT_GT(uncovered, 0u);
}

TEST(TexelMap, RefusesAnAtlasOfAnotherMeshAndSurvivesBadCoordinates) {
    Unwrapped u = testing::sheet(0.1, 1, 40);
    Unwrapped bad = u;
    bad.atlas.corner_uvs.pop_back();
    EXPECT_THROW(build_texel_map(bad.mesh, bad.atlas), Error);
    u.atlas.corner_uvs[0] = {NAN, 0};
    u.atlas.corner_uvs[4] = {1e30f, -1e30f};
    u.atlas.corner_uvs[7] = {-INFINITY, 0.5f};
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    EXPECT_GT(covered(map), 1000u);
    build_cluster_graph(u.mesh, u.atlas, map);
    build_seam_links(u.mesh, u.atlas, map);
}

TEST(LogMap, MatchesTheReferenceTable) {
    // tests/data/physics/geodesic.csv: exact log maps, closed form or geodesic ODE (err ≤ 1e-12).
    std::ifstream file(test_data() + "/physics/geodesic.csv");
    ASSERT_TRUE(file);
    std::string line;
    std::getline(file, line);
    int rows = 0;
    double worst_round = 0, worst_torus = 0;
    while (std::getline(file, line)) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream in(line);
        std::string surface;
        double v[21];
        in >> surface;
        for (double& x : v) in >> x;
        ASSERT_TRUE(in);
        const Vec3 q{v[14], v[15], v[16]};
        const Frame f{{v[2], v[3], v[4]}, {v[5], v[6], v[7]}, {v[8], v[9], v[10]}, {v[11], v[12], v[13]}};
        const double distance = v[19];
        Vec3 m{0};
        double curvature = 1 / v[0];
        if (surface == "sphere") {
            m = glm::normalize(q);
        } else if (surface == "cylinder") {
            m = glm::normalize(Vec3{q.x, q.y, 0});
        } else if (surface == "torus") {
            const Vec3 ring = v[0] * glm::normalize(Vec3{q.x, q.y, 0});
            m = glm::normalize(q - ring);
            curvature = 1 / v[1];
        } else {
            continue;  // cone: checked through its own curvature below the ratio here
        }
        if (glm::dot(m, f.n) < 0) m = glm::dot(f.n, glm::normalize(f.origin)) < 0 ? -m : m;
        if (glm::dot(m, f.n) < kLogMapMinCos) continue;
        const double ratio = distance * curvature;
        const double error = glm::length(log_map(f, q, m) - Vec2{v[17], v[18]}) / distance;
        ++rows;
        if (surface != "torus") {
            worst_round = std::max(worst_round, error);
        } else if (ratio <= 0.51) {
            worst_torus = std::max(worst_torus, error);
        }
    }
    EXPECT_GT(rows, 80);
    EXPECT_LT(worst_round, 1e-4);  // exact but for the series (2e-5 of the curvature term)
    EXPECT_LT(worst_torus, 5e-3);  // third order: measured .0021 oblique at r/R = .5
}

TEST(ClusterGraph, EdgesComeInInversePairsAndClustersCoverEveryTexelOnce) {
    const Unwrapped u = testing::sphere(0.02, 100);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    const ClusterGraph g = build_cluster_graph(u.mesh, u.atlas, map);
    ASSERT_EQ(g.edge_start.size(), g.n_clusters() + 1);
    for (std::uint32_t i = 0; i < g.n_clusters(); ++i) {
        EXPECT_GT(g.edge_start[i + 1], g.edge_start[i]) << "a cluster of a closed surface hangs alone";
        for (std::uint32_t k = g.edge_start[i]; k < g.edge_start[i + 1]; ++k) {
            const ClusterEdge& e = g.edges[k];
            bool found = false;
            for (std::uint32_t l = g.edge_start[e.to]; l < g.edge_start[e.to + 1]; ++l) {
                const ClusterEdge& back = g.edges[l];
                if (back.to != i) continue;
                found = true;
                // Float rounding of hops of some 0.3 mm.
                EXPECT_NEAR(e.hop_u + e.c * back.hop_u - e.s * back.hop_v, 0, 1e-9);
                EXPECT_NEAR(e.hop_v + e.s * back.hop_u + e.c * back.hop_v, 0, 1e-9);
            }
            EXPECT_TRUE(found);
        }
    }
}

TEST(ClusterGraph, HopsOnAFlatSheetAreDifferencesOfPositions) {
    const Unwrapped u = testing::sheet(0.1, 3, 60);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    const ClusterGraph g = build_cluster_graph(u.mesh, u.atlas, map);
    for (std::uint32_t i = 0; i < g.n_clusters(); ++i) {
        const TexelCluster& p = g.clusters[i];
        for (std::uint32_t k = g.edge_start[i]; k < g.edge_start[i + 1]; ++k) {
            const Vec3f d = g.clusters[g.edges[k].to].centre - p.centre;
            const Vec3f b = glm::cross(p.normal, p.tangent);
            // Float positions of 0.05 m, a few operations.
            EXPECT_NEAR(g.edges[k].hop_u, glm::dot(d, p.tangent), 2e-8);
            EXPECT_NEAR(g.edges[k].hop_v, glm::dot(d, b), 2e-8);
        }
    }
}

TEST(ClusterGraph, StackedSheetsDoNotHangTogether) {
    Unwrapped a = testing::plate(0.04, 0.0005, 100);
    // Without the rims the two faces are 0.5 mm apart with nothing between.
    const std::size_t n = 2 * 2 * 16 * 16;
    a.mesh.triangles.resize(n);
    a.mesh.corner_normals.resize(3 * n);
    a.mesh.neighbours.resize(3 * n);
    for (std::uint32_t& x : a.mesh.neighbours) x = x < n ? x : kNone;
    a.atlas.corner_uvs.resize(3 * n);
    a.atlas.triangle_chart.resize(n);
    const TexelMap map = build_texel_map(a.mesh, a.atlas);
    const ClusterGraph g = build_cluster_graph(a.mesh, a.atlas, map);
    for (std::uint32_t i = 0; i < g.n_clusters(); ++i) {
        for (std::uint32_t k = g.edge_start[i]; k < g.edge_start[i + 1]; ++k)
            EXPECT_EQ(g.clusters[i].normal.z > 0, g.clusters[g.edges[k].to].normal.z > 0);
    }
}

/// Two halves of a flat sheet of 0.2 m, texels of 1 mm, turned in the atlas by these angles.
Unwrapped halves(double left, double right, double shift) {
    const auto half = [&](double from, double angle, const Vec2& at) {
        testing::Patch p = testing::flat({from, -0.1, 0}, {0.1, 0, 0}, {0, 0.2, 0}, 8, 16);
        const Vec2 s{std::cos(angle), std::sin(angle)};
        return testing::place(p, at, 100.0 * s, 200.0 * Vec2{-s.y, s.x});
    };
    return testing::build({half(-0.1, left, {160 + shift, 8.13}), half(0, right, {460.6 - shift, 8.37})}, 700);
}

TEST(BorderCells, TileTheSurfaceTogetherAndAreExactForLinearFlows) {
    const double degree = std::numbers::pi / 180;
    for (const auto& [a, b] : {std::pair{0.0, 0.0}, {0.0, 30.0}, {15.0, 45.0}, {45.0, 45.0}, {10.0, 75.0}})
        for (const double shift : {0.1, 0.37, 0.8}) {
            const Unwrapped u = halves(a * degree, b * degree, shift);
            const TexelMap map = build_texel_map(u.mesh, u.atlas);
            const BorderCells border = build_border_cells(u.mesh, u.atlas, map);
            struct Sums {
                double area = 0, length_distance = 0, least = 1e9;
                Vec2 flux{0};
                int faces = 0;
            };
            std::map<std::pair<std::uint32_t, int>, Sums> sums;
            for (const BorderCell& c : border.cells) sums[{c.texel.slot, c.texel.texel}].area = c.area;
            // Whole faces to texels that are no border themselves.
            const auto add = [&](const TexelRef& from, const TexelRef& to, double conductance) {
                const Vec2 d = Vec2(map.position(to.slot, to.texel)) - Vec2(map.position(from.slot, from.texel));
                Sums& s = sums[{from.slot, from.texel}];
                s.flux += conductance * d / 1e-3;
                s.length_distance += conductance * glm::dot(d, d);
                s.least = std::min(s.least, glm::length(d) / 1e-3);
                ++s.faces;
            };
            for (const BorderFace& f : border.faces) add(f.a, f.b, f.conductance), add(f.b, f.a, f.conductance);
            for (const BorderCell& c : border.cells) {
                const std::uint32_t tile = map.tile_of_slot[c.texel.slot];
                const int x = static_cast<int>(tile % map.tiles_per_side) * kTile + c.texel.texel % kTile,
                          y = static_cast<int>(tile / map.tiles_per_side) * kTile + c.texel.texel / kTile;
                for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
                    const TexelRef o = texel_ref(map, x + dx, y + dy);
                    if (o.valid() && !sums.contains({o.slot, o.texel})) add(c.texel, o, 1);
                }
            }
            std::size_t n = 0;
            for (const BorderCell& c : border.cells) {
                if (std::abs(map.position(c.texel.slot, c.texel.texel).y) > 0.095f) continue;
                const Sums& s = sums[{c.texel.slot, c.texel.texel}];
                if (s.least < 0.36) continue;  // conductances of pairs so close are pinned down
                // Float positions, 1e-5 of a texel.
                EXPECT_LT(glm::length(s.flux), 1e-3) << a << ' ' << b;
                EXPECT_NEAR(s.length_distance / (4 * s.area), 1, 1e-3)
                    << "of any cell: four times the area is Σ length distance";
                ++n;
            }
            EXPECT_GT(n, 180u);
        }
}

TEST(SeamLinks, AreTheSameFromBothSidesAndShort) {
    const Unwrapped u = testing::sheet(0.1, 2, 100);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    const SeamLinks seam = build_seam_links(u.mesh, u.atlas, map);
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        for (std::uint32_t k = seam.start[slot]; k < seam.start[slot + 1]; ++k) {
            const SeamLink& l = seam.links[k];
            bool found = false;
            for (std::uint32_t m = seam.start[l.other_slot]; m < seam.start[l.other_slot + 1]; ++m) {
                const SeamLink& back = seam.links[m];
                found |= back.other_slot == slot && back.other_texel == l.texel && back.texel == l.other_texel &&
                         back.weight == l.weight;
            }
            EXPECT_TRUE(found);
            const Vec3f gap = map.position(slot, l.texel) - map.position(l.other_slot, l.other_texel);
            EXPECT_LT(glm::length(gap), 2.5 * map.texel_size);
        }
    }
}

TEST(SeamLinks, LetAGaussianSpreadOverSeamsAsInsideAChart) {
    // ∂w/∂t = D ∇²w: a Gaussian 3 texels beside the seam of two charts, one turned by a
    // quarter, spreads as σ² = σ0² + 2 D t, from 4 to 15 texels.
    testing::Patch left = testing::flat({-0.1, -0.1, 0}, {0.1, 0, 0}, {0, 0.2, 0}, 8, 16);
    testing::Patch right = testing::flat({0, -0.1, 0}, {0.1, 0, 0}, {0, 0.2, 0}, 8, 16);
    testing::place(left, {8.21, 8.13}, {100, 0}, {0, 200});
    testing::place(right, {330.6, 8.37}, {0, 100}, {-200, 0});
    const Unwrapped u = testing::build({left, right}, 352);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    const SeamLinks seam = build_seam_links(u.mesh, u.atlas, map);
    const double texel = 1e-3;
    const auto gaussian = [&](std::uint32_t slot, int t, double sigma) {
        const Vec2 d = Vec2(map.position(slot, t)) / texel - Vec2{3, 0};
        return 16 / (sigma * sigma) * std::exp(-glm::dot(d, d) / (2 * sigma * sigma));
    };
    std::vector<std::array<double, kTileTexels>> w(map.n_slots()), flux;
    for (std::uint32_t s = 0; s < map.n_slots(); ++s) {
        for (int t = 0; t < kTileTexels; ++t) w[s][t] = map.tiles[s].cluster[t] == kNoCluster ? 0 : gaussian(s, t, 4);
    }
    const double k = 0.19;  // σ² grows by 2 k a step
    double before = 0, after = 0;
    for (const auto& tile : w) before = std::accumulate(tile.begin(), tile.end(), before);
    for (int step = 0; step < 550; ++step) {
        flux.assign(map.n_slots(), {});
        for (std::uint32_t s = 0; s < map.n_slots(); ++s) {
            const std::uint32_t tile = map.tile_of_slot[s];
            const int x0 = int(tile % map.tiles_per_side) * kTile, y0 = int(tile / map.tiles_per_side) * kTile;
            for (int t = 0; t < kTileTexels; ++t) {
                if (map.tiles[s].cluster[t] == kNoCluster) continue;
                for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
                    const TexelRef o = texel_ref(map, x0 + t % kTile + dx, y0 + t / kTile + dy);
                    if (!o.valid()) continue;
                    const double f = k * (w[s][t] - w[o.slot][o.texel]);
                    flux[s][t] -= f;
                    flux[o.slot][o.texel] += f;
                }
            }
            for (std::uint32_t l = seam.start[s]; l < seam.start[s + 1]; ++l) {
                const SeamLink& link = seam.links[l];
                flux[s][link.texel] -= k * link.weight * (w[s][link.texel] - w[link.other_slot][link.other_texel]);
            }
        }
        for (std::uint32_t s = 0; s < map.n_slots(); ++s) {
            for (int t = 0; t < kTileTexels; ++t) w[s][t] += flux[s][t];
        }
    }
    double sum2 = 0, worst = 0;
    std::size_t n = 0;
    for (std::uint32_t s = 0; s < map.n_slots(); ++s) {
        for (int t = 0; t < kTileTexels; ++t) {
            if (map.tiles[s].cluster[t] == kNoCluster) continue;
            const double e = (w[s][t] - gaussian(s, t, 15)) / (16.0 / 225);  // of the peak
            after += w[s][t];
            if (glm::length(Vec2(map.position(s, t))) / texel > 45) continue;
            sum2 += e * e;
            worst = std::max(worst, std::abs(e));
            ++n;
        }
    }
    EXPECT_NEAR(after / before, 1, 1e-9);  // antisymmetric fluxes
    // Target for film over a seam: 0.5 % rms and 4 % at most.
    EXPECT_LT(std::sqrt(sum2 / double(n)), 0.005);
    EXPECT_LT(worst, 0.04);
}

}  // namespace
}  // namespace tuft::atlas
