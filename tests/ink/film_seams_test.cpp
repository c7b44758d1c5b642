#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/random.h"
#include "core/system/parallel.h"
#include "wet_stage.h"

namespace tuft::ink {
namespace {

/// Where a sheet of 16 mm lies in an atlas: its lower left corner, texels, and how far it is turned.
struct Lie {
    Vec2 at{0};
    double angle = 0;

    Vec2 across(double texels) const { return texels * Vec2{std::cos(angle), std::sin(angle)}; }
    Vec2 up(double texels) const { return texels * Vec2{-std::sin(angle), std::cos(angle)}; }
};
testing::Patch part_of_sheet(const Lie& lie, int texels, double from, double to) {
    testing::Patch p =
        testing::flat({16e-3 * from - 8e-3, -8e-3, 0}, {16e-3 * (to - from), 0, 0}, {0, 16e-3, 0}, 8, 16);
    return testing::place(p, lie.at + lie.across(texels * from), lie.across(texels * (to - from)), lie.up(texels));
}
/// In one chart; or cut down the middle, the halves lying in different ways.
testing::Unwrapped one_chart(const Lie& lie, int texels = 160) {
    return testing::build({part_of_sheet(lie, texels, 0, 1)}, static_cast<std::uint32_t>(4 * texels));
}
testing::Unwrapped two_charts(const Lie& left, const Lie& right) {
    return testing::build({part_of_sheet(left, 160, 0, 0.5), part_of_sheet(right, 160, 0.5, 1)}, 640);
}

/// Water and ink spread from a blot of 3 mm.
Wet blot_on(testing::Unwrapped sheet, double shortest_step = 0) {
    Wet s(std::move(sheet));
    FilmParams p = film_params(load_substrate("bisque"));
    p.unevenness = 0;       // crinkles of some texels would show where texels lie, not the seam
    p.ripples.tension = 0;  // for that: film_laws_test.cpp
    p.shortest_step = shortest_step;
    const auto centred = [](const Vec3& at) { return disc(at - Vec3{0.7e-3, 0.2e-3, 0}, 3e-3, 3e-3); };
    s.wet([&](const Vec3& at) { return 4 * centred(at); });
    s.ink(0, [&](const Vec3& at) { return 2 * centred(at); });
    s.film.advance(s.canvas, 20, p);
    return s;
}

struct BlotError {
    double worst = 0, rms = 0;  ///< of the peak
    Vec3 at{0};                 ///< the worst
};
/// Of all texels a millimetre inside the sheet's edges, against `truth(position)`.
template <class Truth>
BlotError error_of(const Wet& s, Truth&& truth) {
    double worst = 0, sum2 = 0, peak = 0;
    Vec3 where{0};
    std::size_t n = 0;
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        if (std::max(std::abs(at.x), std::abs(at.y)) > 7e-3) return;
        const double expected = truth(at), e = s.amount(slot, t) - expected;
        peak = std::max(peak, expected);
        if (std::abs(e) > worst) worst = std::abs(e), where = at;
        sum2 += e * e;
        ++n;
    });
    return {worst / peak, std::sqrt(sum2 / static_cast<double>(n)) / peak, where};
}

/// Each half against a sheet without a seam, whose texels lie where the half has its own: what differs is the seam
/// alone.
BlotError error_of_seam(const Lie& left, const Lie& right, const Wet& cut, const Wet& whole_left,
                        const Wet& whole_right) {
    return error_of(cut, [&](const Vec3& at) {
        const Lie& lie = at.x > 0 ? right : left;
        const Vec2 uv = lie.at + lie.across((at.x + 8e-3) * 1e4) + lie.up((at.y + 8e-3) * 1e4);
        const Wet& s = at.x > 0 ? whole_right : whole_left;
        const atlas::TexelRef ref =
            atlas::texel_ref(s.map, static_cast<std::int64_t>(uv.x), static_cast<std::int64_t>(uv.y));
        return ref.valid() ? s.amount(ref.slot, ref.texel) : 0;
    });
}
/// The same. `paint` puts the ink on a sheet of given charts.
template <class Paint>
BlotError error_of_seam(const Lie& left, const Lie& right, const Paint& paint) {
    return error_of_seam(left, right, paint(two_charts(left, right)), paint(one_chart(left)), paint(one_chart(right)));
}
BlotError error_of_seam(const Lie& left, const Lie& right, double shortest_step = 0) {
    return error_of_seam(left, right, [&](const auto& charts) { return blot_on(charts, shortest_step); });
}

// A cut cell has the mean of what lies in it, and its middle is up to 0.14 texels beside its texel's. At the front in
// the pores ink rises by up to a quarter of its peak in a texel: 3.5 % of the peak. Away from the front it is a tenth
// of that.
constexpr double kAtFront = 0.03, kAtMostAtFront = 0.035;

TEST(WetFilm, ABlotIsTheSameWithASeamUnderIt) {
    // The right half straight on or turned by a quarter, at several fractions of a texel.
    const double quarter = std::numbers::pi / 2, degree = quarter / 90;
    const Lie left{{8.21, 8.13}, 0};
    std::map<std::array<double, 3>, Wet> known;  // sheets without a seam: many halves lie alike
    const auto whole = [&](const Lie& lie) -> const Wet& {
        const std::array key{lie.at.x, lie.at.y, lie.angle};
        const auto found = known.find(key);
        return found != known.end() ? found->second : known.emplace(key, blot_on(one_chart(lie))).first->second;
    };
    const auto expect_same = [&](const Lie& a, const Lie& b) {
        const BlotError e = error_of_seam(a, b, blot_on(two_charts(a, b)), whole(a), whole(b));
        EXPECT_LT(e.worst, kAtFront) << a.angle << ' ' << b.angle;
        EXPECT_LT(e.rms, 3.5e-4);
    };
    for (const Lie& right :
         {Lie{{200.87, 8.21}, 0}, {{460.6, 8.37}, quarter}, {{460, 8.87}, quarter}, {{460.45, 8.62}, quarter}})
        expect_same(left, right);
    // Askew: the edges of the texels go up in steps, and the halves share the texels along the cut.
    for (const auto& [a, b] : {std::pair{0.0, 15.0},
                               {0.0, 30.0},
                               {0.0, 45.0},
                               {15.0, 15.0},
                               {15.0, 30.0},
                               {30.0, 30.0},
                               {30.0, 36.0},
                               {45.0, 22.5},
                               {45.0, 45.0}})
        expect_same({{140.3, 8.4}, a * degree}, {{420.7, 10.2}, b * degree});
    // Texels of the two halves that nearly lie on each other: their cells' middles lie far from them.
    for (const Vec2& off : {Vec2{0, 0}, {0.27, 0.41}, {0.5, 0.13}, {0.77, 0.68}})
        for (const auto& [a, b] : {std::pair{0.0, 30.0}, {15.0, 15.0}, {10.0, 70.0}})
            expect_same({{140.3, 8.4}, a * degree}, {Vec2{420.7, 10.2} + off, b * degree});
    // And so near that what links them is cut: what flows past them over the seam is not.
    expect_same({{140.826, 8.468}, 33.856 * degree}, {{421.234, 10.920}, 12.597 * degree});
    expect_same({{140.952, 9.138}, 26.400 * degree}, {{421.249, 11.107}, 11.248 * degree});
    expect_same({{140.714, 8.709}, 41.600 * degree}, {{421.356, 10.550}, 10.187 * degree});
    expect_same({{140.694, 8.752}, 11.713 * degree}, {{421.068, 10.233}, 14.883 * degree});
    // So much as a step allows flows over links: with less these are more off.
    expect_same({{140.545, 8.910}, 9.757 * degree}, {{421.508, 10.431}, 12.992 * degree});
    expect_same({{140.380, 9.088}, 23.310 * degree}, {{421.410, 10.304}, 6.269 * degree});
    expect_same({{140.650, 9.004}, 34.978 * degree}, {{421.405, 10.796}, 3.874 * degree});
}

/// A stroke on paper, on texels of 0.05 mm: in the first seconds its fronts run.
struct Stroke {
    Wet wet;
    FilmReport report;
    double water = 0, ink = 0;  ///< before

    /// `call`: seconds that no step exceeds.
    explicit Stroke(double shortest_step, int charts = 1, double seconds = 8, double call = 8)
        : wet(testing::sheet(0.01, charts, 200)) {
        FilmParams p = film_params(load_substrate("rice-paper"));
        p.shortest_step = shortest_step;
        p.ripples.tension = 0;
        const auto stroke = [](const Vec3& at) { return disc({at.x, 0.5 * at.y, 0}, 1.5e-3, 0.1e-3); };
        wet.wet([&](const Vec3& at) { return 3.5 * stroke(at); });
        wet.ink(0, [&](const Vec3& at) { return 2 * stroke(at); });
        water = wet.canvas.total_liquid(wet.map), ink = wet.canvas.total(wet.map, 0);
        for (double t = 0; t < seconds - 1e-9; t += call) {
            const FilmReport part = wet.film.advance(wet.canvas, std::min(call, seconds - t), p);
            report.steps += part.steps, report.evaporated += part.evaporated;
        }
    }
};

TEST(WetFilm, StepsFarBeyondWhatStabilityAllowsLeaveInkWhereShortOnesDo) {
    const Stroke exact(0, 1, 8, 0.004), fast(FilmParams{}.shortest_step);
    EXPECT_GT(exact.report.steps, 10 * fast.report.steps);
    double sum2 = 0, peak = 0;
    std::size_t n = 0;
    exact.wet.each([&](std::uint32_t slot, int t, const Vec3&) {
        const double a = exact.wet.amount(slot, t), d = fast.wet.amount(slot, t) - a;
        peak = std::max(peak, a);
        if (a > 0) sum2 += d * d, ++n;
    });
    // In the first second fronts run by more than a texel a step, and what carries pigment is upstream of the whole
    // step.
    EXPECT_LT(std::sqrt(sum2 / static_cast<double>(n)) / peak, 0.015);
}

TEST(WetFilm, LongStepsKeepEveryPigmentAndAllWaterAndAreTheSameOnAnyNumberOfThreads) {
    std::uint64_t hashes[2];
    for (int i = 0; i < 2; ++i) {
        set_thread_count(i ? 4 : 1);
        Stroke s(FilmParams{}.shortest_step, 2, 16);
        EXPECT_LE(s.report.steps, 800u) << "20 ms and longer";
        EXPECT_NEAR((s.wet.canvas.total_liquid(s.wet.map) + s.report.evaporated) / s.water, 1, 1e-5);
        EXPECT_NEAR(s.wet.canvas.total(s.wet.map, 0) / s.ink, 1, 1e-5);
        hashes[i] = s.wet.canvas.hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(WetFilm, WhereFlowsAreHeldBackASeamDoesNotHoldThemBackMore) {
    // Steps of 50 ms, 2.5 times what stability allows here: blocks of texels end at seams.
    const double degree = std::numbers::pi / 180;
    for (const auto& [left, right] :
         {std::pair{Lie{{8.21, 8.13}, 0}, Lie{{200.87, 8.21}, 0}}, {{{140.3, 8.4}, 0}, {{420.7, 10.2}, 30 * degree}}}) {
        const BlotError e = error_of_seam(left, right, 0.1);
        EXPECT_LT(e.worst, kAtFront);
        EXPECT_LT(e.rms, 0.0015) << "of steps in two parts, where they meet";
    }
}

TEST(WetFilm, ABlotIsTheSameOverRandomSeams) {
    // At the steps in use, where flows are hardly held back, and, for a third of the seams, twice as long.
    const double degree = std::numbers::pi / 180;
    for (const double shortest : {FilmParams{}.shortest_step, 2 * FilmParams{}.shortest_step}) {
        int n = 0, within = 0;
        const std::uint64_t seeds = shortest > FilmParams{}.shortest_step ? 1 : 3;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed)
            for (std::uint64_t i = 0; i < 8; ++i, ++n) {
                const auto at = [&](std::uint64_t k) { return uniform(seed, 10 * i + k); };
                const Lie left{{140.3 + at(0), 8.4 + at(1)}, 45 * at(2) * degree},
                    right{{420.7 + at(3), 10.2 + at(4)}, 45 * at(5) * degree};
                const BlotError e = error_of_seam(left, right, shortest);
                EXPECT_LT(e.worst, kAtMostAtFront) << seed << ' ' << i;
                EXPECT_LT(e.rms, 0.0015) << seed << ' ' << i;
                within += e.worst < kAtFront;
            }
        EXPECT_GE(within, n - 1) << "of " << n;
    }
}

/// A film with ridges askew to all texels, which level; 16 µm thick.
Wet ridges_on(testing::Unwrapped sheet) {
    Wet s(std::move(sheet));
    FilmParams p = film_params(load_substrate("porcelain"), {0, 0, -1});
    p.drying.evaporation = p.drying.rim_evaporation = 0;
    const auto film = [&](const Vec3& at) {
        return 1.6 + 0.5 * std::sin(1200 * at.x + 500 * at.y) * std::cos(900 * at.y) + 0.3 * disc(at, 3e-3, 1e-3);
    };
    s.wet(film);
    s.ink(0, film);
    s.film.advance(s.canvas, 1, p);
    return s;
}

TEST(WetFilm, RidgesLevelAsIfThereWereNoSeam) {
    // Of 80 % of the peak-to-peak amounts that were there before a tenth is left.
    const double degree = std::numbers::pi / 180;
    for (const auto& [left, right] : {std::pair{Lie{{8.21, 8.13}, 0}, Lie{{200.87, 8.21}, 0}},
                                      {{{140.3, 8.4}, 0}, {{420.7, 10.2}, 30 * degree}},
                                      {{{140.3, 8.4}, 15 * degree}, {{420.7, 10.2}, 40 * degree}}}) {
        const BlotError e = error_of_seam(left, right, [](const auto& charts) { return ridges_on(charts); });
        EXPECT_LT(e.worst, 0.02) << left.angle << ' ' << right.angle << " at " << e.at.x << ' ' << e.at.y;
        EXPECT_LT(e.rms, 0.002) << e.rms;
    }
}

TEST(WetFilm, ABlotIsTheSameHoweverTexelsLie) {
    // Against means over each texel of a sheet with texels of half the length.
    const Wet fine = blot_on(one_chart({{8.21, 8.13}, 0}, 320));
    const auto read = [&](const Vec3& at) {
        const double x = (at.x + 8e-3) / 5e-5 + 8.21 - 0.5, y = (at.y + 8e-3) / 5e-5 + 8.13 - 0.5;
        const double i = std::floor(x), j = std::floor(y);
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
            const double di = k & 1, dj = k >> 1;
            const atlas::TexelRef ref =
                atlas::texel_ref(fine.map, static_cast<std::int64_t>(i + di), static_cast<std::int64_t>(j + dj));
            if (ref.valid())
                sum += (1 - std::abs(x - i - di)) * (1 - std::abs(y - j - dj)) * fine.amount(ref.slot, ref.texel);
        }
        return sum;
    };
    for (const Lie& lie : {Lie{{8.21, 8.13}, 0}, Lie{{8.71, 8.63}, 0}, Lie{{100.3, 8.4}, std::numbers::pi / 6},
                           Lie{{130.3, 8.4}, std::numbers::pi / 4}}) {
        const BlotError e = error_of(blot_on(one_chart(lie)), [&](const Vec3& at) {
            double sum = 0;
            for (int k = 0; k < 16; ++k) {
                const Vec2 d{0.25 * (k % 4) - 0.375, 0.25 * (k / 4) - 0.375};  // of a texel, in its own directions
                sum += read(
                    at + 1e-4 * Vec3{glm::dot(d, lie.up(1)) * Vec2{0, 1} + glm::dot(d, lie.across(1)) * Vec2{1, 0}, 0});
            }
            return sum / 16;
        });
        // At the front half a texel of 0.1 mm, upwind of half of one of 0.05, 0.03 texels apart.
        EXPECT_LT(e.worst, kAtFront);
        EXPECT_LT(e.rms, 2.5e-3);
    }
}

}  // namespace
}  // namespace tuft::ink
