#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "atlas/atlas.h"
#include "atlas/pack/coverage.h"
#include "atlas/seams/half_edges.h"
#include "atlas/unwrap/atlas_picture.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/system/parallel.h"
#include "mesh/repair/repair.h"
#include "paths.h"
#include "shapes.h"
#include "test_mesh.h"

namespace tuft::atlas {
namespace {

using mesh::TriangleMesh;

TriangleMesh scaled(TriangleMesh m, float factor) {
    for (Vec3f& p : m.positions) p *= factor;
    m.bounds = {};
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    return m;
}

/// What every atlas must keep, whatever the mesh.
void expect_sound(const TriangleMesh& m, const Unwrapped& u) {
    EXPECT_EQ(u.report.flips, 0u);
    EXPECT_EQ(u.report.overlapping_texels, 0u);
    EXPECT_EQ(u.report.zero_area_triangles, 0u);
    EXPECT_GE(u.report.smallest_gap, static_cast<int>(u.atlas.gutter));
    ASSERT_EQ(u.atlas.corner_uvs.size(), 3 * m.n_triangles());
    ASSERT_EQ(u.atlas.triangle_chart.size(), m.n_triangles());
    for (const Vec2f& uv : u.atlas.corner_uvs) {
        ASSERT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
    }
    for (const std::uint32_t c : u.atlas.triangle_chart) ASSERT_LT(c, u.atlas.n_charts);
}

TEST(Unwrap, ShapesKeepTheInvariants) {
    const std::pair<const char*, TriangleMesh> shapes[] = {{"sheet", test::sheet()},
                                                           {"cylinder", test::cylinder()},
                                                           {"cone", test::cone()},
                                                           {"torus", test::torus()},
                                                           {"sphere", test::sphere()}};
    for (const auto& [name, m] : shapes) {
        SCOPED_TRACE(name);
        UnwrapOptions options;
        options.size = 512;
        const Unwrapped u = unwrap(m, options);
        expect_sound(m, u);
        EXPECT_EQ(u.atlas.size, 512u);
        EXPECT_LE(u.report.l2_stretch, 1.006);  // what charts may have, straight seams included
        EXPECT_GE(u.report.utilisation, 0.4);
    }
}

TriangleMesh model(const std::string& name) {
    const std::string path = source_folder() + "/models/" + name;
    return mesh::build_surface(mesh::read_ply(read_file(path), path)).mesh;
}

// Bounds a fifth above what the charts are today: few charts, short seams, little stretch.
TEST(Unwrap, PorcelainGetsFewChartsThatHardlyStretch) {
    const struct {
        const char* name;
        std::size_t charts;
        double seam;
    } models[] = {{"bowl.ply", 6, 5.3}, {"plate.ply", 8, 5.6}};
    for (const auto& [name, charts, seam] : models) {
        SCOPED_TRACE(name);
        const TriangleMesh m = model(name);
        UnwrapOptions options;
        options.size = 1024;
        const Unwrapped u = unwrap(m, options);
        expect_sound(m, u);
        EXPECT_LE(u.report.charts, charts);
        EXPECT_LE(u.report.seam_length, seam);
        EXPECT_LE(u.report.l2_stretch, 1.003);
        EXPECT_LE(u.report.linf_stretch, 3);
        EXPECT_GE(u.report.utilisation, 0.6);
    }
}

// A cylinder and a cone unroll without stretch; what is left is that of facets, which are
// flat, so the floats of the UVs: 2^-24 over a triangle's size of about 1/100.
TEST(Unwrap, DevelopableSurfacesUnrollIsometrically) {
    for (const TriangleMesh& m : {test::sheet(), test::cylinder(), test::cone()}) {
        const Unwrapped u = unwrap(m, {});
        EXPECT_NEAR(u.report.l2_stretch, 1, 1e-5);
        EXPECT_NEAR(u.report.angle_distortion, 1, 1e-3);
    }
}

TEST(Unwrap, IsTheSameForAnyNumberOfThreads) {
    const TriangleMesh m = test::torus();
    std::vector<Vec2f> first;
    for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        const Unwrapped u = unwrap(m, {});
        if (first.empty()) first = u.atlas.corner_uvs;
        EXPECT_EQ(first, u.atlas.corner_uvs) << threads;
    }
    set_thread_count(0);
}

TEST(Unwrap, ChartsDoNotDependOnTheUnit) {
    for (const TriangleMesh& m : {test::torus(), test::sphere(), test::cone()}) {
        const auto charts = static_cast<double>(unwrap(m, {}).report.charts);
        for (const float factor : {0.001f, 1000.f})
            EXPECT_NEAR(static_cast<double>(unwrap(scaled(m, factor), {}).report.charts), charts, 0.05 * charts);
    }
}

/// The unit cube, each face a grid of n × n cells, edges bent by 90°.
TriangleMesh box(int n) {
    std::map<std::array<int, 3>, std::uint32_t> index;
    std::vector<Vec3f> p;
    test::Triangles t;
    const auto at = [&](const std::array<int, 3>& g) {
        const auto [it, is_new] = index.try_emplace(g, std::uint32_t(p.size()));
        if (is_new) p.push_back(Vec3f(g[0], g[1], g[2]) / float(n));
        return it->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, n})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int a, int b) {
                        std::array<int, 3> g{};
                        g[axis] = side;
                        g[(axis + 1) % 3] = a;
                        g[(axis + 2) % 3] = b;
                        return at(g);
                    };
                    std::array<std::uint32_t, 4> q{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                                   corner(i, j + 1)};
                    if (side == 0) std::swap(q[1], q[3]);
                    t.push_back({q[0], q[1], q[2]});
                    t.push_back({q[0], q[2], q[3]});
                }
    return test::finish_mesh(p, t);
}

/// Inner edges with `asked` true must part two charts.
template <class Asked>
void expect_parted(const TriangleMesh& m, const Atlas& atlas, Asked&& asked) {
    const std::vector<std::uint32_t> twin = twin_half_edges(m);
    std::size_t edges = 0;
    for (std::uint32_t h = 0; h < twin.size(); ++h) {
        if (twin[h] == kNone || !asked(h / 3, twin[h] / 3)) continue;
        ++edges;
        EXPECT_NE(atlas.triangle_chart[h / 3], atlas.triangle_chart[twin[h] / 3]) << h;
    }
    EXPECT_GT(edges, 0u);
}

TEST(Unwrap, SeamsFollowSharpEdgesOnRequest) {
    const TriangleMesh cube = box(8);
    const TriangleMesh roof = test::grid_mesh(20, 20, false, false, [](double u, double v) {
        return Vec3(u, v, -0.25 * std::abs(u - 0.5));  // bent by 28° along its ridge
    });
    UnwrapOptions options;
    options.size = 512;
    options.cutting = Cutting::never;
    EXPECT_EQ(unwrap(roof, options).report.charts, 1u);
    for (const TriangleMesh* m : {&cube, &roof}) {
        options.seams.sharp_angle = 0.35;  // 20°
        const Unwrapped u = unwrap(*m, options);
        expect_sound(*m, u);
        EXPECT_EQ(u.report.charts, m == &cube ? 6u : 2u);
        expect_parted(*m, u.atlas, [&](std::uint32_t s, std::uint32_t t) {
            return glm::dot(m->corner_normals[3 * s], m->corner_normals[3 * t]) < 0.93f;
        });
    }
    options.seams.sharp_angle = 0.6;  // 34°
    EXPECT_EQ(unwrap(roof, options).report.charts, 1u);
}

TEST(Unwrap, SeamsFollowFaceGroupsOnRequest) {
    const std::string text = [] {
        std::string obj;
        for (int j = 0; j <= 20; ++j)
            for (int i = 0; i <= 20; ++i) obj += "v " + std::to_string(i) + " " + std::to_string(j) + " 0\n";
        for (int part = 0; part < 4; ++part) {
            obj += part % 2 ? "g left" : "g right";
            obj += part / 2 ? "\nusemtl red\n" : "\nusemtl blue\n";
            for (int j = 0; j < 20; ++j)
                for (int i = 0; i < 20; ++i) {
                    if ((i < 7) != (part % 2 == 1) || (j < 4) != (part / 2 == 1)) continue;
                    const int a = 21 * j + i + 1;
                    obj += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(a + 22) + " " +
                           std::to_string(a + 21) + "\n";
                }
        }
        return obj;
    }();
    TriangleMesh m = mesh::build_surface(mesh::read_obj({text.begin(), text.end()}, "g.obj")).mesh;
    ASSERT_GE(m.group_names.size(), 4u);
    UnwrapOptions options;
    options.size = 512;
    EXPECT_EQ(unwrap(m, options).report.charts, 1u);
    options.seams.groups = true;
    const Unwrapped u = unwrap(m, options);
    expect_sound(m, u);
    EXPECT_EQ(u.report.charts, 4u);
    expect_parted(m, u.atlas,
                  [&](std::uint32_t s, std::uint32_t t) { return m.triangle_groups[s] != m.triangle_groups[t]; });
    m.triangle_groups.clear();
    EXPECT_THROW(unwrap(m, options), Error);
    options.seams.sharp_angle = 0.5;  // both: what there is
    EXPECT_EQ(unwrap(m, options).report.charts, 1u);
}

// The car has creases that end in smooth metal: slits, which must not become annuli.
TEST(Unwrap, RequestedSeamsKeepTheInvariantsOfARealModel) {
    const TriangleMesh m = model("car.ply");
    UnwrapOptions options;
    options.size = 1024;
    options.seams.sharp_angle = 0.5;
    const Unwrapped u = unwrap(m, options);
    expect_sound(m, u);
    // A chart may lie on both sides of a crease that ends inside it, but no edge glues them.
    const std::vector<std::uint32_t> twin = twin_half_edges(m);
    const std::vector<std::uint8_t> seam = uv_seams(twin, u.atlas.corner_uvs);
    std::size_t sharp = 0, crossed = 0;
    for (std::uint32_t h = 0; h < twin.size(); ++h) {
        if (twin[h] == kNone) continue;
        const auto normal = [&](std::uint32_t t) {
            const Vec3 a = m.position(t, 0);
            return glm::normalize(glm::cross(m.position(t, 1) - a, m.position(t, 2) - a));
        };
        if (glm::dot(normal(h / 3), normal(twin[h] / 3)) > std::cos(0.5) - 1e-9) continue;
        ++sharp;
        crossed += !seam[h];
    }
    EXPECT_GT(sharp, 1000u);
    EXPECT_EQ(crossed, 0u);
}

// Two squares fill half a square page whichever way they lie; with one cut, five sixths and more
// could be filled.
TEST(Unwrap, CutsChartsThatWouldLeaveThePageHalfEmpty) {
    const TriangleMesh one = test::grid_mesh(24, 24, false, false, [](double u, double v) { return Vec3(u, v, 0); });
    std::vector<Vec3f> p = one.positions;
    test::Triangles t(one.triangles.begin(), one.triangles.end());
    for (const Vec3f& q : one.positions) p.push_back(q + Vec3f(2, 0, 0));
    const auto n = static_cast<std::uint32_t>(one.n_vertices());
    for (const auto& f : one.triangles) t.push_back({f[0] + n, f[1] + n, f[2] + n});
    const TriangleMesh two = test::finish_mesh(p, t);
    UnwrapOptions options;
    options.size = 512;
    options.cutting = Cutting::never;
    EXPECT_EQ(unwrap(two, options).report.charts, 2u);
    options.cutting = Cutting::where_useful;
    EXPECT_EQ(unwrap(one, options).report.charts, 1u);
    const Unwrapped u = unwrap(two, options);
    expect_sound(two, u);
    EXPECT_GT(u.report.charts, 2u);
    EXPECT_LE(u.report.charts, 8u);
    EXPECT_GE(u.report.utilisation, 0.6);
    EXPECT_NEAR(u.report.l2_stretch, 1, 1e-6);  // halves lie as the whole did
}

/// Frames open at one side, and more squares than a few in between.
TriangleMesh frames_and_squares() {
    constexpr int kSide = 20, kWidth = 2, kFrames = 8, kSquares = 56;
    std::vector<Vec3f> p;
    test::Triangles t;
    const auto add = [&](double size, double z, const auto& inside) {
        const auto first = static_cast<std::uint32_t>(p.size());
        for (int j = 0; j <= kSide; ++j)
            for (int i = 0; i <= kSide; ++i) p.push_back(Vec3f(Vec3(size * i / kSide, size * j / kSide, z)));
        const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (kSide + 1) + i); };
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                if (!inside(i, j)) continue;
                t.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                t.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    };
    for (int f = 0; f < kFrames; ++f)
        add(1 + 0.03 * f, f, [](int i, int j) { return i < kWidth || i >= kSide - kWidth || j < kWidth; });
    for (int s = 0; s < kSquares; ++s) add(0.02 + 1e-3 * s, kFrames + s, [](int, int) { return true; });
    return test::finish_mesh(p, t);
}

// Eight open frames are as large as eight squares while they are whole, of which they cover a quarter.
TEST(Unwrap, CutsFramesAmongManyCharts) {
    const TriangleMesh m = frames_and_squares();
    UnwrapOptions options;
    options.size = 1024;
    options.cutting = Cutting::never;
    const Unwrapped whole = unwrap(m, options);
    EXPECT_EQ(whole.report.charts, 64u);
    options.cutting = Cutting::where_useful;
    const Unwrapped u = unwrap(m, options);
    expect_sound(m, u);
    EXPECT_GT(u.report.charts, whole.report.charts);
    EXPECT_GE(u.report.utilisation, std::min(0.65, 1.2 * whole.report.utilisation));
    EXPECT_NEAR(u.report.l2_stretch, 1, 1e-6);  // halves lie as the whole did
    options.cutting = Cutting::tight;           // never worse than without asking for it
    EXPECT_GE(unwrap(m, options).report.utilisation, u.report.utilisation);
}

TEST(Unwrap, TexelSizeIsKept) {
    const TriangleMesh m = test::torus();
    UnwrapOptions options;
    options.texel_size = 0.0005;
    const Unwrapped u = unwrap(m, options);
    expect_sound(m, u);
    EXPECT_NEAR(u.atlas.texel_size, 0.0005, 1e-3 * 0.0005);  // charts keep their area
    EXPECT_EQ(u.atlas.size % 16, 0u);
    const double covered = u.report.utilisation * u.atlas.size * u.atlas.size * 0.0005 * 0.0005;
    EXPECT_NEAR(covered, mesh::surface_area(m), 0.01 * covered);  // texels on borders
}

/// No chart may leave its page, nor come nearer to the page's edge than half a gutter.
void expect_paged(const Atlas& atlas) {
    EXPECT_EQ(atlas.size, atlas.page_size() * atlas.pages_per_side());
    const double side = atlas.page_size(), margin = atlas.gutter / 2;
    std::vector<std::uint32_t> page(atlas.n_charts, kNone);
    std::vector<std::uint8_t> used(atlas.pages, 0);
    for (std::size_t t = 0; t < atlas.triangle_chart.size(); ++t) {
        const std::uint32_t p = atlas.page_of(t);
        ASSERT_LT(p, atlas.pages);
        used[p] = 1;
        std::uint32_t& of_chart = page[atlas.triangle_chart[t]];
        if (of_chart == kNone) of_chart = p;
        ASSERT_EQ(of_chart, p);
        for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
            const Vec2 uv = side * page_uv(atlas, p, atlas.corner_uvs[c]);
            // Floats of UVs round by 2^-24 of the whole; snapping moves by 1/16 texel at most.
            ASSERT_GE(std::min({uv.x, uv.y, side - uv.x, side - uv.y}), margin - 0.07);
        }
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), 1), atlas.pages);
}

TEST(Unwrap, SpreadsChartsOverAsManyPagesAsATexelSizeNeeds) {
    UnwrapOptions options;
    options.texel_size = 0.0005;
    const Unwrapped one = unwrap(test::torus(), options);
    options.size = 160;  // the torus needs about 0.04 m² / (0.5 mm)² = 158,000 texels
    options.pages = 20;
    const Unwrapped u = unwrap(test::torus(), options);
    expect_sound(test::torus(), u);
    expect_paged(u.atlas);
    EXPECT_GE(u.atlas.pages, 7u);
    EXPECT_LE(u.atlas.pages, 20u);
    EXPECT_EQ(u.atlas.page_size(), 160u);
    EXPECT_NEAR(u.atlas.texel_size, one.atlas.texel_size, 1e-3 * one.atlas.texel_size);
    EXPECT_EQ(udim_of(u.atlas, u.atlas.pages_per_side()), 1011u);
    options.pages = u.atlas.pages - 1;
    EXPECT_THROW(unwrap(test::torus(), options), Error);
    options.pages = 20;
    options.size = 2048;
    EXPECT_EQ(unwrap(test::torus(), options).atlas.pages, 1u);
    options.max_size = 300;  // no room for two pages beside each other
    options.size = 160;
    EXPECT_THROW(unwrap(test::torus(), options), Error);
}

TEST(Unwrap, FillsThePagesItIsGiven) {
    UnwrapOptions options;
    options.size = 256;
    const double one = unwrap(test::torus(), options).atlas.texel_size;
    options.pages = 4;
    const Unwrapped u = unwrap(test::torus(), options);
    expect_sound(test::torus(), u);
    expect_paged(u.atlas);
    EXPECT_EQ(u.atlas.pages, 4u);
    EXPECT_GE(u.report.utilisation, 0.4);
    // Four times the texels, less what the gutters of small pages cost.
    EXPECT_LT(u.atlas.texel_size, 0.65 * one);
}

TEST(Unwrap, WiderGuttersAreKept) {
    UnwrapOptions options;
    options.size = 512;
    for (const std::uint32_t gutter : {0u, 1u, 3u, 8u, 16u}) {
        options.gutter = gutter;
        expect_sound(test::torus(), unwrap(test::torus(), options));
    }
}

TEST(Unwrap, RefusesSizesThatCannotBeWithTheSizeNeeded) {
    const auto message = [](const UnwrapOptions& options) -> std::string {
        try {
            unwrap(test::torus(), options);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    UnwrapOptions options;
    options.size = 20000;
    EXPECT_NE(message(options).find("16384"), std::string::npos);
    options.size = 0;
    options.texel_size = 1e-7;  // 30 mm of tube at 0.1 µm
    EXPECT_NE(message(options).find("texels"), std::string::npos);
    options.texel_size = 0;
    options.size = 8;
    EXPECT_NE(message(options).find("needs at least"), std::string::npos);
    options.size = 0;
    options.texel_size = -1;
    EXPECT_NE(message(options).find("above 0"), std::string::npos);
}

TEST(Unwrap, CanBeCancelled) {
    UnwrapOptions options;
    options.progress = [](std::string_view, double) { return false; };
    EXPECT_THROW(unwrap(test::torus(), options), Cancelled);
}

TEST(AtlasPicture, ShowsChartsAndTheirStretch) {
    const TriangleMesh m = test::torus();
    UnwrapOptions options;
    options.size = 256;
    const Unwrapped u = unwrap(m, options);
    const AtlasPicture picture = draw_atlas(m, u.atlas, {.side = 256});
    EXPECT_EQ(picture.width, 512u);
    EXPECT_EQ(picture.height, 256u);
    // At the atlas's own size the stretch side draws exactly the covered texels.
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) drawn += (i / 3) % 512 >= 256 && picture.rgb[i] > 30;
    EXPECT_EQ(drawn, static_cast<std::size_t>(std::lround(u.report.utilisation * 256 * 256)));
}

TEST(AtlasPicture, LeavesOutUvsThatAreNotNumbersOrOutside) {
    const TriangleMesh m = test::sheet();
    UnwrapOptions options;
    options.size = 256;
    Atlas atlas = unwrap(m, options).atlas;
    const AtlasPicture whole = draw_atlas(m, atlas, {.side = 256});
    const float infinite = std::numeric_limits<float>::infinity();
    atlas.corner_uvs[0] = Vec2f(NAN, 0.5f);
    atlas.corner_uvs[4] = Vec2f(0.5f, infinite);
    atlas.corner_uvs[8] = Vec2f(-infinite, NAN);
    const AtlasPicture holed = draw_atlas(m, atlas, {.side = 256});
    // Only the pixels of the three triangles, and the borders round them, may differ.
    std::size_t differing = 0;
    for (std::size_t i = 0; i < whole.rgb.size(); i += 3)
        differing += !std::equal(&whole.rgb[i], &whole.rgb[i] + 3, &holed.rgb[i]);
    EXPECT_GT(differing, 0u);
    EXPECT_LT(differing, 2 * 3 * (256u * 256 / m.n_triangles() + 4 * 40));
    for (Vec2f& uv : atlas.corner_uvs) uv *= 1e30f;
    EXPECT_EQ(draw_atlas(m, atlas, {.side = 256}).rgb.size(), whole.rgb.size());
}

// The listener hears of the work inside one chart, from whichever thread, and can stop it.
TEST(Unwrap, LargeChartsReportTheirProgressAndCanBeStopped) {
    const TriangleMesh m = test::grid_mesh(160, 160, false, false, [](double u, double v) {
        return Vec3(u, v, 0.05 * std::sin(3 * u) * std::sin(3 * v));
    });
    std::size_t calls = 0;
    double last = 0;
    UnwrapOptions options;
    options.progress = [&](std::string_view phase, double fraction) {
        if (phase != "flatten") return true;
        ++calls;
        EXPECT_GE(fraction, last);
        EXPECT_LE(fraction, 1);
        last = fraction;
        return true;
    };
    const Unwrapped u = unwrap(m, options);
    EXPECT_GT(calls, 2 * u.report.charts);  // several within a chart
    calls = 0;
    options.progress = [&](std::string_view phase, double) {
        calls += phase == "flatten";
        return calls < 2;
    };
    EXPECT_THROW(unwrap(m, options), Cancelled);
    EXPECT_EQ(calls, 2u);  // nobody is asked again
}

}  // namespace
}  // namespace tuft::atlas
