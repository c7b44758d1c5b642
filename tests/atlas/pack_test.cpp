#include "atlas/pack/pack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace tuft::atlas {
namespace {

using Polygon = std::vector<Vec2>;

Polygon star(Random& random) {
    const int n = 3 + static_cast<int>(random.uniform() * 20);
    const double size = std::pow(10.0, random.uniform(-1.5, 0));
    const double flattening = random.uniform(0.1, 1);
    Polygon p;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n, r = size * random.uniform(0.3, 1);
        p.push_back({r * std::cos(a), flattening * r * std::sin(a)});
    }
    return p;
}

double area(const Polygon& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2 a = p[i], b = p[(i + 1) % p.size()];
        sum += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return sum;
}

double point_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
    const Vec2 d = b - a;
    const double t = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0);
    return glm::length(p - a - t * d);
}

/// Distance of two polygons that do not overlap.
double distance(const Polygon& p, const Polygon& q) {
    double least = 1e300;
    for (int turn = 0; turn < 2; ++turn) {
        const Polygon& a = turn ? q : p;
        const Polygon& b = turn ? p : q;
        for (const Vec2& v : a)
            for (std::size_t i = 0; i < b.size(); ++i)
                least = std::min(least, point_segment(v, b[i], b[(i + 1) % b.size()]));
    }
    return least;
}

bool contains(const Polygon& p, const Vec2& q) {
    bool in = false;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2 a = p[i], b = p[(i + 1) % p.size()];
        if ((a.y <= q.y) != (b.y <= q.y) && q.x < a.x + (b.x - a.x) * (q.y - a.y) / (b.y - a.y)) in = !in;
    }
    return in;
}

std::vector<Polygon> placed(const std::vector<Polygon>& borders, const Packing& packing) {
    std::vector<Polygon> out = borders;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Placement& p = packing.placements[i];
        for (Vec2& v : out[i]) v = p.offset + p.scale * Vec2(p.c * v.x - p.s * v.y, p.s * v.x + p.c * v.y);
    }
    return out;
}

TEST(Pack, ShapesKeepTheirDistanceAndScale) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        std::vector<Polygon> borders;
        double sum = 0;
        for (int i = 0; i < 12 * int(seed); ++i) {
            borders.push_back(star(random));
            sum += area(borders.back());
        }
        PackOptions options;
        options.size = seed % 2 ? 512 : 700;
        options.gutter = static_cast<std::uint32_t>(seed);
        options.search = seed % 3 == 0 ? Search::patient : Search::full;
        const Packing packing = pack(borders, options);
        ASSERT_TRUE(packing.fits);
        const auto p = placed(borders, packing);
        for (std::size_t i = 0; i < p.size(); ++i) {
            for (const Vec2& v : p[i]) {
                EXPECT_GE(std::min(v.x, v.y), options.gutter / 2.0 - 1e-6);
                EXPECT_LE(std::max(v.x, v.y), options.size - options.gutter / 2.0 + 1e-6);
            }
            EXPECT_NEAR(area(p[i]) / (area(borders[i]) * packing.texels_per_unit * packing.texels_per_unit), 1, 1e-9);
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_GE(distance(p[i], p[j]), options.gutter - 1e-6);
                EXPECT_FALSE(contains(p[i], p[j][0]) || contains(p[j], p[i][0]));
            }
        }
        const double used = sum * packing.texels_per_unit * packing.texels_per_unit;
        EXPECT_GE(used, 0.4 * options.size * options.size);  // star shapes fill 0.6 of their boxes
    }
}

TEST(Pack, FinerTurnsCoverMoreOfThePage) {
    double gained = 0;
    constexpr int kSets = 8;
    for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
        Random random(seed);
        std::vector<Polygon> borders;
        for (int i = 0; i < 30; ++i) borders.push_back(star(random));
        PackOptions options{.size = 512};
        const double full = pack(borders, options).texels_per_unit;
        options.search = Search::patient;
        gained += std::pow(pack(borders, options).texels_per_unit / full, 2) - 1;
    }
    // 3 % on the charts of scans; no single search is sure to gain.
    EXPECT_GT(gained / kSets, 0.01);
}

// Cells of four texels, on which the search begins, leave room for 170 strips of six texels in two columns: only a
// third column of shorter ones would hold all.
TEST(Pack, NarrowStripsFillThePage) {
    const double width = 0.012;
    const std::vector<Polygon> strips(176, {{0, 0}, {1, 0}, {1, width}, {0, width}});
    PackOptions options;
    options.size = 1024;
    const Packing packing = pack(strips, options);
    // Two strips, a gutter and two margins in a row. The search ends within 0.4 % of what fits, and masks round up.
    EXPECT_GE(packing.texels_per_unit, 0.98 * (1024 - 2 * 4) / 2.0);
    EXPECT_LE(packing.texels_per_unit, (1024 - 2 * 4) / 2.0);
}

TEST(Pack, SquaresFillThePage) {
    const std::vector<Polygon> squares(16, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    PackOptions options;
    options.size = 1024;
    const Packing packing = pack(squares, options);
    // Four squares, three gutters and two margins in a row; masks round up to cells.
    EXPECT_GE(packing.texels_per_unit, 0.98 * (1024 - 4 * 4) / 4.0);
    EXPECT_LE(packing.texels_per_unit, (1024 - 4 * 4) / 4.0);
}

// Nine squares fit a page best, in threes; that many pages are needed, and no more, at that scale.
TEST(Pack, SquaresFillSeveralPages) {
    const std::vector<Polygon> squares(36, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    PackOptions options;
    options.size = 512;
    options.pages = 4;
    const Packing full = pack(squares, options);
    ASSERT_TRUE(full.fits);
    EXPECT_EQ(full.pages, 4u);
    EXPECT_GE(full.texels_per_unit, 0.98 * (512 - 4 * 3) / 3.0);
    EXPECT_LE(full.texels_per_unit, (512 - 4 * 3) / 3.0);
    options.pages = 10;
    options.texels_per_unit = full.texels_per_unit;
    const Packing needed = pack(squares, options);
    ASSERT_TRUE(needed.fits);
    EXPECT_EQ(needed.pages, 4u);
    for (const Packing* packing : {&full, &needed}) {
        std::vector<int> on_page(4, 0);
        for (const std::uint32_t page : packing->page) ++on_page.at(page);
        EXPECT_EQ(on_page, std::vector<int>(4, 9));
    }
    options.texels_per_unit = 600;
    EXPECT_EQ(pack(squares, options).too_large.size(), 36u);
}

TEST(Pack, FindsTheSizeThatAScaleNeeds) {
    Random random(9);
    std::vector<Polygon> borders;
    double sum = 0;
    for (int i = 0; i < 30; ++i) {
        borders.push_back(star(random));
        sum += area(borders.back());
    }
    PackOptions options;
    options.texels_per_unit = 100;
    const Packing packing = pack(borders, options);
    ASSERT_TRUE(packing.fits);
    EXPECT_EQ(packing.size % 16, 0u);
    const double use = sum * 1e4 / packing.size / packing.size;
    EXPECT_GE(use, 0.35);
    EXPECT_LE(use, 1);
}

TEST(Pack, NamesASizeWhenThePageIsTooSmall) {
    const std::vector<Polygon> squares(100, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    PackOptions options;
    options.size = 32;
    const Packing packing = pack(squares, options);
    EXPECT_FALSE(packing.fits);
    EXPECT_GE(packing.size, 44u);  // ten texels and eleven gutters of four would need 54
    EXPECT_LE(packing.size, 128u);
    options.size = packing.size;
    EXPECT_TRUE(pack(squares, options).fits);
}

}  // namespace
}  // namespace tuft::atlas
