#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "ink/film/tile/fibres.h"
#include "wet_stage.h"

namespace tuft::ink {
namespace {

/// Radii in 16 directions round the middle at which the saturation falls below a tenth, linear between points half a
/// texel apart.
std::array<double, 16> radii(const Wet& s, const FilmParams& p) {
    std::map<std::pair<long, long>, double> saturation;
    const double texel = s.map.texel_size;
    Vec3 first{0};
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        if (saturation.empty()) first = at;
        const Vec3 cell = (at - first) / texel;
        saturation[{std::lround(cell.x), std::lround(cell.y)}] = s.water(slot, t, Liquid::pores) / p.pores.capacity;
    });
    const auto sample = [&](const Vec3& at) {
        const Vec3 cell = (at - first) / texel, floor = glm::floor(cell), f = cell - floor;
        double sum = 0;
        for (const int i : {0, 1})
            for (const int j : {0, 1}) {
                const auto found = saturation.find({std::lround(floor.x) + i, std::lround(floor.y) + j});
                if (found != saturation.end()) sum += (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y) * found->second;
            }
        return sum;
    };
    std::array<double, 16> out{};
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double a = 2 * std::numbers::pi * (static_cast<double>(k) + 0.25) / 16, step = 0.5 * texel;
        double r = 0, before = 1;
        for (double now = before; now >= 0.1; r += step) {
            before = now;
            now = sample(Vec3{std::cos(a), std::sin(a), 0} * (r + step));
            if (now < 0.1) r += step * ((before - 0.1) / (before - now) - 1);
        }
        out[k] = r;
    }
    return out;
}

/// Amplitude of the n-fold pattern over the mean.
double pattern(const std::array<double, 16>& radii, int n) {
    std::complex<double> sum = 0;
    double mean = 0;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        sum += radii[k] * std::polar(1.0, 2 * std::numbers::pi * n * static_cast<double>(k) / 16);
        mean += radii[k];
    }
    return (n == 8 ? 1 : 2) * std::abs(sum) / mean;
}

// Even paper has no direction: what a drop wets is round, whichever way the texels run.
TEST(Soaking, ADropOnEvenPaperIsRound) {
    const FilmParams p = even_paper();
    for (const int texels : {60, 120}) {
        Wet s(testing::sheet(0.012, 1, texels));
        s.wet([&](const Vec3& at) { return 6 * p.pores.capacity * disc(at, 1e-3); });
        s.film.advance(s.canvas, 20, p);
        const auto r = radii(s, p);
        const auto [low, high] = std::minmax_element(r.begin(), r.end());
        EXPECT_LT(*high / *low - 1, 0.02) << texels << ": a tenth of a texel of 0.2 mm";
        EXPECT_LT(pattern(r, 4), 0.005) << texels;
        EXPECT_LT(pattern(r, 8), 0.005) << texels;
    }
}

/// Fronts in the rows of a strip that is fed along its left side, metres from there, by 0.2 mm of its breadth.
std::vector<double> fronts_of_rows(double texel, const FilmParams& p, double seconds) {
    constexpr double kSide = 0.0096, kRowWidth = 0.2e-3;
    Wet s(testing::sheet(kSide, 1, static_cast<int>(std::lround(kSide / texel))));
    s.wet([&](const Vec3& at) { return at.x < -0.4 * kSide ? 1e3 : 0; });
    s.film.advance(s.canvas, seconds, p);
    std::map<long, std::map<long, std::array<double, 2>>> rows;
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        auto& c = rows[std::lround(std::floor(at.y / kRowWidth))][std::lround(2 * at.x / texel)];
        c[0] += s.water(slot, t, Liquid::pores) / p.pores.capacity, c[1] += 1;
    });
    std::vector<double> out;
    for (const auto& [row, columns] : rows) {
        double x = -0.4 * kSide;
        for (const auto& [column, c] : columns)
            if (c[0] / c[1] > 0.1) x = std::max(x, 0.5 * static_cast<double>(column) * texel);
        out.push_back(x + 0.4 * kSide);
    }
    return out;
}

struct Spread {
    double mean = 0, rms = 0;
};
Spread spread_of(const std::vector<double>& v) {
    Spread out;
    for (const double x : v) out.mean += x / static_cast<double>(v.size());
    for (const double x : v) out.rms += (x - out.mean) * (x - out.mean) / static_cast<double>(v.size());
    out.rms = std::sqrt(out.rms);
    return out;
}

// Along fibres liquid runs ahead of Washburn's front and between them it stays behind, by a tenth of the distance and
// more; in the mean it keeps to it. Where it runs ahead is a matter of the paper and not of the texels.
TEST(Soaking, FibresFeatherAFrontThatKeepsToWashburnsLawInTheMean) {
    FilmParams even = even_paper(), p = even;
    p.unevenness = film_params(load_substrate("rice-paper")).unevenness;
    const double front = 4e-3, seconds = front * front / p.pores.suction;
    const std::vector<double> fine = fronts_of_rows(0.05e-3, p, seconds), coarse = fronts_of_rows(0.1e-3, p, seconds);
    const Spread f = spread_of(fine), c = spread_of(coarse), e = spread_of(fronts_of_rows(0.1e-3, even, seconds));
    double product = 0;
    for (std::size_t i = 0; i < fine.size(); ++i)
        product += (fine[i] - f.mean) * (coarse[i] - c.mean) / static_cast<double>(fine.size());
    EXPECT_NEAR(f.mean / e.mean, 1, 0.07) << "of 48 rows with five fibres' lengths between them";
    EXPECT_NEAR(c.mean / e.mean, 1, 0.07);
    EXPECT_GT(f.rms, 0.05 * front);
    EXPECT_LT(e.rms, 0.005 * front);
    EXPECT_GT(product / (f.rms * c.rms), 0.85) << "texels of 0.1 mm show fibres of 0.15 mm";
}

TEST(Soaking, FibresAreOfThePlaceAlone) {
    const Vec3 tilted = glm::normalize(Vec3{0.3, 0.5, 0.8}), across = glm::normalize(glm::cross(tilted, Vec3{0, 0, 1}));
    for (const Vec3& normal : {Vec3{0, 0, 1}, tilted}) {
        const Vec3 u = normal.z == 1 ? Vec3{1, 0, 0} : across, v = glm::cross(normal, u);
        const auto place = [&](int i, int j) { return Vec3{0.01, -0.02, 0.013} + i * 0.2e-3 * u + j * 0.2e-3 * v; };
        wet::Fibres rows(0.02e-3), columns(0.02e-3);
        constexpr int kSide = 200;
        std::vector<double> values;
        double sum = 0, square = 0;
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) {
                values.push_back(rows.at(place(i, j), normal));
                sum += values.back(), square += values.back() * values.back();
            }
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i)
                EXPECT_EQ(columns.at(place(i, j), normal), values[static_cast<std::size_t>(i * kSide + j)]);
        const double n = kSide * kSide;
        // 40 mm by 40 mm hold 8,000 fibres: 1 %; and more near the lattice on the plane z = const.
        EXPECT_NEAR(sum / n, 0, 0.06);
        EXPECT_NEAR(std::sqrt(square / n), 1, 0.06);
    }
}

}  // namespace
}  // namespace tuft::ink
