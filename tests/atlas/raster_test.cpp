#include "atlas/pack/raster.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <utility>

namespace tuft::atlas {
namespace {

using Texels = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// By the definition: the centres of texels in a triangle of random corners, counter-clockwise or
// not, up to far beyond the page; none lies on an edge but by chance of 2⁻²⁴.
TEST(Raster, RowsHoldTheCentresInside) {
    std::mt19937_64 random(1);
    for (const double spread : {0.01, 0.1, 1.0, 7.0})
        for (int i = 0; i < 300; ++i) {
            std::uniform_real_distribution<float> middle(0, 1), off(float(-spread), float(spread));
            const Vec2f m(middle(random), middle(random));
            std::array<Vec2f, 3> uv;
            for (Vec2f& p : uv) p = glm::clamp(m + Vec2f(off(random), off(random)), -7.9f, 7.9f);
            for (const std::uint32_t size : {16u, 100u}) {
                Texels rows, inside;
                raster_rows(uv, size, [&](std::uint32_t y, std::uint32_t first, std::uint32_t last) {
                    for (std::uint32_t x = first; x <= last; ++x) rows.insert({x, y});
                });
                const auto side = [](const Vec2& a, const Vec2& b, const Vec2& p) {
                    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
                };
                // The grid's places, which are exact in doubles, as is what side() makes of them.
                std::array<Vec2, 3> at;
                for (int k = 0; k < 3; ++k) at[k] = Vec2(uv_grid(uv[k])[0], uv_grid(uv[k])[1]) / kUvGrid;
                for (std::uint32_t y = 0; y < size; ++y)
                    for (std::uint32_t x = 0; x < size; ++x) {
                        const Vec2 c((x + 0.5) / size, (y + 0.5) / size);
                        const double s0 = side(at[0], at[1], c), s1 = side(at[1], at[2], c), s2 = side(at[2], at[0], c);
                        if ((s0 > 0 && s1 > 0 && s2 > 0) || (s0 < 0 && s1 < 0 && s2 < 0)) inside.insert({x, y});
                    }
                EXPECT_EQ(rows, inside) << spread << ' ' << i << ' ' << size;
            }
        }
}

TEST(Raster, TheWidthOfTheNumbersDoesNotShow) {
    std::mt19937_64 random(2);
    std::uniform_int_distribution<std::int64_t> place(-(1 << 25), 1 << 25), step(-(1 << 17), 1 << 17);
    int n = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::array<std::array<std::int64_t, 2>, 3> p;
        p[0] = {place(random), place(random)};
        for (int k = 1; k < 3; ++k) p[k] = {p[0][0] + step(random), p[0][1] + step(random)};
        if (i % 4 == 0) p[1][1] = p[0][1];  // an edge along the rows
        const std::int64_t area = twice_area(p[0], p[1], p[2]);
        if (area == 0) continue;
        if (area < 0) std::swap(p[1], p[2]);
        std::vector<std::array<std::uint32_t, 3>> narrow, wide;
        raster_rows_in<std::int64_t>(p, 4096, [&](auto y, auto a, auto b) { narrow.push_back({y, a, b}); });
        raster_rows_in<__int128>(p, 4096, [&](auto y, auto a, auto b) { wide.push_back({y, a, b}); });
        EXPECT_EQ(narrow, wide);
        n += !wide.empty();
    }
    EXPECT_GT(n, 1000) << "some lie on the page";
}

}  // namespace
}  // namespace tuft::atlas
