#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "atlas/atlas.h"
#include "core/error.h"
#include "shapes.h"

namespace tuft::atlas {
namespace {

using mesh::TriangleMesh;

TEST(FileUvs, AreKeptWhenTheyAreOurOwn) {
    TriangleMesh m = test::torus();
    UnwrapOptions options;
    options.size = 512;
    const Unwrapped first = unwrap(m, options);
    m.corner_uvs = first.atlas.corner_uvs;
    const Unwrapped again = unwrap(m, options);
    EXPECT_TRUE(again.atlas.from_file);
    EXPECT_EQ(again.atlas.corner_uvs, first.atlas.corner_uvs);
    EXPECT_EQ(again.report.charts, first.report.charts);
    EXPECT_NEAR(again.atlas.texel_size, first.atlas.texel_size, 1e-9);
    options.uvs = UvPolicy::renew;
    EXPECT_FALSE(unwrap(m, options).atlas.from_file);
}

TEST(FileUvs, ThatAreMirroredAreTurnedOver) {
    TriangleMesh m = test::sheet();
    for (std::size_t c = 0; c < 3 * m.n_triangles(); ++c) {
        const Vec3f p = m.positions[m.triangles[c / 3][c % 3]];
        m.corner_uvs.push_back({0.9f - 4 * p.x, 4 * p.y});
    }
    const Unwrapped u = unwrap(m, {});
    EXPECT_TRUE(u.atlas.from_file);
    EXPECT_EQ(u.report.flips, 0u);
    EXPECT_EQ(u.report.overlapping_texels, 0u);
}

/// A square sheet of 0.1 m and its mirror image above it, which has the same UVs plus (`page`, 0), as a
/// mirror modifier leaves them.
TriangleMesh mirrored_sheets(const std::function<Vec2f(const Vec2f&)>& uv, float page) {
    std::vector<Vec3f> p;
    test::Triangles t;
    std::vector<Vec2f> uvs;
    const Vec2f corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const std::uint32_t image : {0u, 1u}) {
        for (const Vec2f& c : corners) p.emplace_back(0.1f * (image ? 1 - c.x : c.x), 0.1f * c.y, 0.1f * float(image));
        for (std::array<std::uint32_t, 3> f : {std::array{0u, 1u, 2u}, std::array{0u, 2u, 3u}}) {
            if (image) std::swap(f[1], f[2]);
            t.push_back({4 * image + f[0], 4 * image + f[1], 4 * image + f[2]});
            for (const std::uint32_t v : f) uvs.push_back(uv(corners[v]) + Vec2f(page * float(image), 0));
        }
    }
    TriangleMesh m = test::finish_mesh(p, t);
    m.corner_uvs = std::move(uvs);
    return m;
}

std::string why_not_kept(const TriangleMesh& m) {
    UnwrapOptions options;
    options.size = 512;
    options.uvs = UvPolicy::keep;
    try {
        unwrap(m, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(FileUvs, OfHalvesThatShareTheirTextureAreRefusedForThat) {
    const TriangleMesh m = mirrored_sheets([](const Vec2f& c) { return Vec2f(0.2f) + 0.5f * c; }, 0);
    EXPECT_NE(why_not_kept(m).find("4 triangles lie where others do"), std::string::npos) << why_not_kept(m);
}

TEST(FileUvs, OnAPageOfMirroredChartsKeepTheirPlacesToEachOther) {
    // The two triangles of each sheet lie apart, those of the image mirrored on page 1002: turned over
    // each by itself they would touch.
    TriangleMesh m = mirrored_sheets([](const Vec2f& c) { return Vec2f(0.05f) + 0.8f * c; }, 1);
    for (const std::size_t t : {1u, 3u})
        for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) m.corner_uvs[c] += Vec2f(-0.02f, 0.02f);
    UnwrapOptions options;
    options.size = 512;
    options.uvs = UvPolicy::keep;
    const Unwrapped u = unwrap(m, options);
    EXPECT_EQ(u.atlas.pages, 2u);
    EXPECT_EQ(u.report.charts, 4u);
    EXPECT_EQ(u.report.flips, 0u);
    EXPECT_EQ(u.report.overlapping_texels, 0u);
}

TEST(FileUvs, MirroredBetweenOthersAreRefusedForThat) {
    // A triangle of the sheet and one of its image share a square, as lightmaps have them: turned over,
    // the mirrored one lies on the other.
    TriangleMesh m = mirrored_sheets([](const Vec2f& c) { return 0.4f * c; }, 0);
    for (std::size_t c = 0; c < 12; ++c) {
        const std::size_t t = c / 3;
        if (t == 1 || t == 3) m.corner_uvs[c] += Vec2f(0, 0.05f);
        if (t == 0 || t == 3) m.corner_uvs[c] += Vec2f(0.5f, 0.5f);
    }
    EXPECT_NE(why_not_kept(m).find("mirrored between others"), std::string::npos) << why_not_kept(m);
}

TEST(FileUvs, ThatCannotServeAreRenewed) {
    TriangleMesh m = test::cylinder();
    const std::function<Vec2f(const Vec3f&)> bad[] = {
        [](const Vec3f& p) { return Vec2f(5 * p.x + 0.5f, 4 * p.z); },    // front over back
        [](const Vec3f& p) { return Vec2f(20 * p.x + 0.5f, 40 * p.z); },  // outside
        [](const Vec3f&) { return Vec2f(0.5f); },                         // no room
        [](const Vec3f& p) { return Vec2f(p.x, NAN); }};
    for (const auto& uv : bad) {
        m.corner_uvs.clear();
        for (std::size_t c = 0; c < 3 * m.n_triangles(); ++c)
            m.corner_uvs.push_back(uv(m.positions[m.triangles[c / 3][c % 3]]));
        const Unwrapped u = unwrap(m, {});
        EXPECT_FALSE(u.atlas.from_file);
        EXPECT_EQ(u.report.flips, 0u);
        UnwrapOptions options;
        options.uvs = UvPolicy::keep;
        EXPECT_THROW(unwrap(m, options), Error);
    }
}

/// UVs as an OBJ file of the atlas holds them: floats, pages by their UDIM numbers.
std::vector<Vec2f> written_uvs(const Atlas& atlas) {
    std::vector<Vec2f> uvs;
    for (std::size_t c = 0; c < atlas.corner_uvs.size(); ++c) {
        const std::uint32_t page = atlas.page_of(c / 3), tile = udim_of(atlas, page) - 1001;
        uvs.push_back(Vec2f(page_uv(atlas, page, atlas.corner_uvs[c]) + Vec2(tile % 10, tile / 10)));
    }
    return uvs;
}

Unwrapped kept(const TriangleMesh& m, std::uint32_t size) {
    UnwrapOptions options;
    options.size = size;
    options.uvs = UvPolicy::keep;
    return unwrap(m, options);
}

std::string refusal(const TriangleMesh& m, std::uint32_t size = 256) {
    try {
        kept(m, size);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

void expect_sound(const Unwrapped& u) {
    EXPECT_EQ(u.report.flips, 0u);
    EXPECT_EQ(u.report.overlapping_texels, 0u);
    EXPECT_EQ(u.report.zero_area_triangles, 0u);
}

// 2 to 7 pages: squares of 2 x 2 pages, which floats divide exactly, and of 3 x 3, which they
// do not. Rounding moves a UV by 2^-24 of the whole, 2e-4 of a texel.
TEST(FileUvs, OnSeveralPagesComeBackOnTheSame) {
    TriangleMesh m = test::torus();
    for (const std::uint32_t pages : {2u, 4u, 5u, 7u}) {
        SCOPED_TRACE(pages);
        UnwrapOptions options;
        options.size = 128;
        options.pages = pages;
        const Unwrapped first = unwrap(m, options);
        ASSERT_GE(first.atlas.pages, 2u);
        m.corner_uvs = written_uvs(first.atlas);
        const Unwrapped again = kept(m, 128);
        expect_sound(again);
        EXPECT_TRUE(again.atlas.from_file);
        EXPECT_EQ(again.atlas.pages, first.atlas.pages);
        EXPECT_EQ(again.atlas.size, first.atlas.size);
        EXPECT_EQ(again.report.charts, first.report.charts);
        EXPECT_EQ(again.report.smallest_gap, first.report.smallest_gap);
        EXPECT_NEAR(again.report.utilisation, first.report.utilisation, 1e-3);
        EXPECT_NEAR(again.atlas.texel_size / first.atlas.texel_size, 1, 1e-5);
        for (std::size_t c = 0; c < m.corner_uvs.size(); ++c) {
            ASSERT_EQ(udim_of(again.atlas, again.atlas.page_of(c / 3)),
                      udim_of(first.atlas, first.atlas.page_of(c / 3)));
            ASSERT_NEAR(again.atlas.corner_uvs[c].x, first.atlas.corner_uvs[c].x, 2e-7);
            ASSERT_NEAR(again.atlas.corner_uvs[c].y, first.atlas.corner_uvs[c].y, 2e-7);
        }
    }
}

TEST(FileUvs, KeepTheNumbersOfTheirPages) {
    TriangleMesh m = test::sheet();  // in four stripes, on pages as another program may number them
    const std::array<Vec2f, 4> tiles{Vec2f(0, 0), Vec2f(9, 0), Vec2f(2, 7), Vec2f(9, 99)};
    const auto stripe_of = [&](std::size_t t) {
        return static_cast<std::size_t>(std::min({m.position(t, 0).x, m.position(t, 1).x, m.position(t, 2).x}) * 20 +
                                        1e-3);
    };
    for (std::size_t c = 0; c < 3 * m.n_triangles(); ++c) {
        const Vec3f p = m.positions[m.triangles[c / 3][c % 3]];
        const std::size_t s = stripe_of(c / 3);
        const Vec2f uv(20 * p.x - float(s), 5 * p.y);  // from edge to edge of each page
        m.corner_uvs.push_back(glm::clamp(uv, Vec2f(0), Vec2f(1)) + tiles[s]);
    }
    const Unwrapped u = kept(m, 128);
    expect_sound(u);
    EXPECT_EQ(u.atlas.pages, 4u);
    EXPECT_EQ(u.atlas.page_size(), 128u);
    EXPECT_EQ(u.atlas.udims, (std::vector<std::uint32_t>{1001, 1010, 1073, 2000}));
    EXPECT_EQ(u.report.charts, 4u);
    const std::vector<Vec2f> back = written_uvs(u.atlas);
    for (std::size_t c = 0; c < back.size(); ++c) {
        // Floats below 128 are 2^-17 apart.
        ASSERT_NEAR(back[c].x, m.corner_uvs[c].x, 8e-6);
        ASSERT_NEAR(back[c].y, m.corner_uvs[c].y, 8e-6);
    }
    const UvCheck check = check_file_uvs(m, 64);
    EXPECT_TRUE(check.fault.empty()) << check.fault.text();
    EXPECT_EQ(check.atlas.udims, u.atlas.udims);
    EXPECT_EQ(check.atlas.page_size(), 64u);
    UnwrapOptions options;  // without being asked they are not kept
    EXPECT_FALSE(unwrap(m, options).atlas.from_file);
}

TEST(FileUvs, OnNoPageAreRefused) {
    TriangleMesh m = test::sheet();
    for (std::size_t c = 0; c < 3 * m.n_triangles(); ++c) {
        const Vec3f p = m.positions[m.triangles[c / 3][c % 3]];
        m.corner_uvs.push_back({0.05f + 4 * p.x, 0.05f + 4 * p.y});
    }
    const std::vector<Vec2f> good = m.corner_uvs;
    EXPECT_EQ(refusal(m), "");
    const auto moved = [&](const Vec2f& by) {
        for (std::size_t c = 0; c < good.size(); ++c) m.corner_uvs[c] = good[c] + by;
        return refusal(m);
    };
    EXPECT_EQ(moved({9, 99}), "");
    EXPECT_NE(moved({9, 399}).find("UDIM"), std::string::npos);  // page 5000
    EXPECT_NE(moved({10, 0}).find("UDIM"), std::string::npos);
    EXPECT_NE(moved({-1, 0}).find("UDIM"), std::string::npos);
    EXPECT_NE(moved({0.5f, 0}).find("more than one page"), std::string::npos);
    for (const float hostile : {1e30f, -1e30f, 3e9f}) {
        m.corner_uvs = good;
        m.corner_uvs[5].y = hostile;
        EXPECT_NE(refusal(m).find("UDIM"), std::string::npos) << hostile;
        EXPECT_FALSE(check_file_uvs(m, 64).fault.empty());
    }
    m.corner_uvs = good;
    m.corner_uvs[7].x = NAN;
    EXPECT_NE(refusal(m).find("not finite"), std::string::npos);
    EXPECT_FALSE(check_file_uvs(m, 64).fault.empty());
}

TEST(FileUvs, OnTooManyPagesAreRefused) {
    TriangleMesh m = test::sheet();  // 2400 triangles, each pair on a page of its own
    const auto on_pages = [&](std::size_t pages) {
        m.corner_uvs.clear();
        for (std::size_t c = 0; c < 3 * m.n_triangles(); ++c) {
            const std::size_t page = std::min(c / 6, pages - 1), square = c / 6 - page;
            const Vec3f q = m.positions[m.triangles[c / 6 * 2][0]];
            const Vec3f p = m.positions[m.triangles[c / 3][c % 3]];
            const Vec2f at = square == 0 ? Vec2f(p.x - q.x, p.y - q.y) : Vec2f(p.x, p.y);
            m.corner_uvs.push_back(Vec2f(0.1f) + 4.f * at + Vec2f(page % 10, page / 10));
        }
    };
    on_pages(60);
    EXPECT_EQ(refusal(m, 128), "");
    EXPECT_NE(refusal(m, 4096).find("smaller pages"), std::string::npos);  // 8 x 8 of them
    on_pages(101);
    EXPECT_NE(refusal(m, 64).find("more than the 100"), std::string::npos);
}

}  // namespace
}  // namespace tuft::atlas
