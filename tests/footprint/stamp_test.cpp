#include "footprint/stamp/stamp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "core/hash.h"
#include "core/random.h"
#include "core/system/parallel.h"
#include "stage.h"

namespace tuft::footprint {
namespace {

constexpr double kPi = std::numbers::pi;

/// Sum of exposure × travel over a stroke of stamps `step` texels apart.
std::vector<std::array<double, atlas::kTileTexels>> stroke(Stage& stage, double texel, double step) {
    std::vector<std::array<double, atlas::kTileTexels>> sum(stage.map.n_slots());
    for (auto& s : sum) s.fill(0);
    const double length = 64;
    for (double travel = step; travel <= length + 1e-9; travel += step) {
        const Vec3 at = Vec3{-0.006, -0.0031, 0} + travel * texel * Vec3{0.8, 0.6, 0};
        const Footprint f = disc(make_frame(at, {0, 0, 1}, {1, 0, 0}), stage.triangle_at(at), 16 * texel, 0.5 * texel);
        const Motion motion{step * texel * Vec2{0.8, 0.6}, 0};
        for_exposed(stage, stage.plan(f, motion),
                    [&](std::uint32_t slot, int t, float e) { sum[slot][t] += e * step; });
    }
    return sum;
}

TEST(Stamp, AStrokeIsTheSameAtAnySampling) {
    Stage stage(testing::sheet(0.03, 2, 120));
    const double texel = 0.03 / 240;
    const auto dense = stroke(stage, texel, 0.5);
    double total = 0, peak = 0;
    for (const auto& tile : dense) {
        for (const double w : tile) {
            total += w;
            peak = std::max(peak, w);
        }
    }
    for (const double step : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {
        const auto sparse = stroke(stage, texel, step);
        double sum = 0, error2 = 0;
        std::size_t n = 0;
        for (std::size_t s = 0; s < dense.size(); ++s) {
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                sum += sparse[s][t];
                error2 += (sparse[s][t] - dense[s][t]) * (sparse[s][t] - dense[s][t]);
                n += dense[s][t] > 0;
            }
        }
        EXPECT_LT(std::sqrt(error2 / double(n)) / peak, 0.01) << step;
        EXPECT_NEAR(sum / total, 1, 1e-3) << step;
    }
}

TEST(Stamp, PrefixSumsAreManySubPoses) {
    Stage stage(testing::sheet(0.06, 2, 200));
    const double texel = 0.06 / 400;
    Random random(4);
    for (const double travel : {16.0, 37.3, 120.0}) {
        for (const double angle : {0.0, 0.3, 1.2, kPi / 2, 2.5, 4.1}) {
            Footprint f = disc(make_frame({0.003, 0.002, 0}, {0, 0, 1}), 0, 14 * texel, 0.5 * texel);
            f.triangle = stage.triangle_at(f.frame.origin);
            for (std::uint8_t& c : f.coverage)  // bristles: a picture without order
                if (random.uniform(0, 1) < 0.3) c = 0;
            const Motion motion{travel * texel * Vec2{std::cos(angle), std::sin(angle)}, 0};
            const StampJobs swept = stage.plan(f, motion);
            ASSERT_EQ(swept.sub_poses.size(), 1u);
            const StampJobs many = stage.plan(f, motion, {.sub_pose = 0.05, .max_sub_poses = 4096, .prefix_sums = 0});
            ASSERT_GT(many.sub_poses.size(), 300u);
            std::vector<float> a(stage.map.n_slots() * atlas::kTileTexels), b = a;
            double sum_a = 0, sum_b = 0, peak = 0, square = 0;
            for_exposed(stage, swept, [&](std::uint32_t s, int t, float e) { a[256 * s + t] = e; });
            for_exposed(stage, many, [&](std::uint32_t s, int t, float e) { b[256 * s + t] = e; });
            std::size_t n = 0;
            for (std::size_t k = 0; k < a.size(); ++k) {
                sum_a += a[k];
                sum_b += b[k];
                peak = std::max(peak, double(b[k]));
                square += (a[k] - b[k]) * (a[k] - b[k]);
                n += b[k] > 0;
            }
            // The shear takes the mean of two cells across the motion, half a texel wide, of a
            // picture that is noise from cell to cell; without one (along an axis) only the steps
            // of 1/255 are left.
            const bool sheared = std::abs(std::sin(2 * angle)) > 1e-6;
            EXPECT_LT(std::sqrt(square / double(n)) / peak, sheared ? 0.02 : 0.003) << travel << " " << angle;
            EXPECT_NEAR(sum_a / sum_b, 1, 2e-3) << travel << " " << angle;
        }
    }
}

TEST(Stamp, HairDrawnSidewaysInksAllThatItPassesOver) {
    Stage stage(testing::sheet(0.06, 2, 200));
    const double texel = 0.06 / 400;
    for (const double travel : {2.0, 5.3, 40.0}) {
        for (const double angle : {0.0, 0.3, 1.2, kPi / 2, 2.5, 4.1}) {
            // A hair a texel wide across the motion, 40 texels long: it leaves a box.
            const Vec2 along{-std::sin(angle), std::cos(angle)}, on{std::cos(angle), std::sin(angle)};
            Footprint f = disc(make_frame({0.003, 0.002, 0}, {0, 0, 1}), 0, 30 * texel, 0.5 * texel);
            f.triangle = stage.triangle_at(f.frame.origin);
            for (int j = 0; j < f.height; ++j)
                for (int i = 0; i < f.width; ++i) {
                    const Vec2 p = f.lo + f.cell * Vec2(i + 0.5, j + 0.5);
                    const double off = std::abs(glm::dot(p, on)) / f.cell, end = std::abs(glm::dot(p, along)) / texel;
                    f.coverage[static_cast<std::size_t>(j) * f.width + i] =
                        end < 20 ? static_cast<std::uint8_t>(255 * std::clamp(1.5 - off, 0.0, 1.0)) : 0;
                }
            const StampJobs jobs = stage.plan(f, {travel * texel * on, 0}, {.max_weight = 1});
            ASSERT_EQ(jobs.sub_poses.size(), 1u);
            double inside = 1, outside = 0;
            for_exposed(stage, jobs, [&](std::uint32_t slot, int t, float e) {
                const Vec3 d = Vec3(stage.map.position(slot, t)) - f.frame.origin;
                const Vec2 p(glm::dot(d, f.frame.t), glm::dot(d, f.frame.b));
                const double x = glm::dot(p, on) / texel, y = std::abs(glm::dot(p, along)) / texel;
                // It came from -travel; a texel and a cell of the picture lie at its border.
                if (x > -travel && x < 0 && y < 18.5) inside = std::min(inside, double(e));
                if (x < -travel - 1.8 || x > 1.8 || y > 21.5) outside = std::max(outside, double(e));
            });
            // Half of it: half of what lies over the mean that any closed picture leaves.
            const auto exposed = [&](float part) {
                std::map<std::pair<std::uint32_t, int>, float> by_texel;
                const StampJobs some = stage.plan(f, {travel * texel * on, 0}, {.max_weight = part});
                for_exposed(stage, some, [&](std::uint32_t slot, int t, float e) { by_texel[{slot, t}] = e; });
                return by_texel;
            };
            auto half = exposed(0.5f), none = exposed(1e-6f);
            // Each of the three pictures is rounded to 1/255.
            for (const auto& [texel_of, e] : exposed(1))
                ASSERT_NEAR(half[texel_of], 0.5f * (e + none[texel_of]), 1.1f / 255);
            // Between the cells of the sheared picture some of the hair's peak is lost, and little goes beyond.
            EXPECT_GT(inside, 0.75) << travel << " " << angle;
            EXPECT_LT(outside, 0.01) << travel << " " << angle;
        }
    }
}

// Between them are lines and cells without hair, which cost nothing.
TEST(Stamp, WhatHairsPassOverIsTheUnionOfWhatEachOneDoes) {
    Stage stage(testing::sheet(0.06, 2, 200));
    const double texel = 0.06 / 400;
    Footprint f = disc(make_frame({0.003, 0.002, 0}, {0, 0, 1}), 0, 50 * texel, 0.5 * texel);
    f.triangle = stage.triangle_at(f.frame.origin);
    constexpr int kApart = 90;  // cells, more than a hair and its way: each cell meets one hair
    ASSERT_GT(std::min(f.width, f.height), 2 * kApart);
    const auto picture = [&](int from, int to) {
        Footprint hairs = f;
        std::ranges::fill(hairs.coverage, std::uint8_t{0});
        for (int k = from; k < to; ++k)
            for (int j = 0; j < 7; ++j)
                for (int i = 0; i < 3; ++i)
                    hairs.coverage[std::size_t(10 + kApart * (k / 2) + j) * f.width + 7 + kApart * (k % 2) + i] = 200;
        return hairs;
    };
    for (const double travel : {0.4, 5.3, 30.0})
        for (const double angle : {0.0, 0.3, 1.2, kPi / 2, 2.5, 4.1}) {
            const Motion motion{travel * texel * Vec2{std::cos(angle), std::sin(angle)}, 0};
            std::vector<float> together(stage.map.n_slots() * atlas::kTileTexels), each = together;
            const auto add = [&](const Footprint& hairs, std::vector<float>& most) {
                const StampJobs jobs = stage.plan(hairs, motion, {.max_weight = 1});
                for_exposed(stage, jobs, [&](std::uint32_t s, int t, float e) {
                    float& at = most[atlas::kTileTexels * s + t];
                    at = std::max(at, e);
                });
            };
            for (int k = 0; k < 4; ++k) add(picture(k, k + 1), each);
            add(picture(0, 4), together);
            EXPECT_GT(std::ranges::max(together), 0.4) << travel << " " << angle;
            EXPECT_EQ(together, each) << travel << " " << angle;
        }
}

TEST(Stamp, ATurnAboutTheOriginSweepsTheAngle) {
    // A bar turned by 60° exposes a texel at radius ρ for (bar's angular width) / 60° of the
    // motion.
    Stage stage(testing::sheet(0.03, 1, 240));
    const double texel = 0.03 / 240;
    Footprint f;
    f.frame = make_frame({0.0001, 0.0002, 0}, {0, 0, 1}, {1, 0, 0});
    f.triangle = stage.triangle_at(f.frame.origin);
    f.cell = texel;
    f.width = f.height = 84;
    f.lo = Vec2{-42 * texel};
    f.radius = 42 * texel;
    f.coverage.assign(84 * 84, 0);
    for (int i = 44; i < 82; ++i) {
        for (int j = 40; j < 44; ++j) f.coverage[84 * j + i] = 255;  // 4 texels wide along +u
    }
    StampJobs jobs = stage.plan(f, {Vec2{0}, kPi / 3});
    double at_30 = 0;
    std::size_t n = 0, outside = 0;
    for_exposed(stage, jobs, [&](std::uint32_t slot, int t, float e) {
        const Vec3 d = Vec3(stage.map.position(slot, t)) - f.frame.origin;
        const double angle = std::atan2(d.y, d.x), rho = glm::length(d) / texel;
        outside += rho > 15 && (angle < -kPi / 3 - 3 / rho || angle > 3 / rho);
        if (rho < 20 || rho > 36 || std::abs(angle + kPi / 6) > 0.25) return;
        at_30 += e * rho;
        ++n;
    });
    EXPECT_EQ(outside, 0u);  // it came from −60°
    // Width 4 texels over a path of ρ π/3; 44 sub-poses.
    EXPECT_NEAR(at_30 / double(n) / (4 / (kPi / 3)), 1, 0.02);
}

TEST(Stamp, SameBitsForAllInstructionSetsAndThreadCounts) {
    Stage stage(testing::sphere(0.02, 200));
    std::vector<Footprint> prints;
    Random random(7);
    for (int i = 0; i < 24; ++i) {
        const Vec3 n = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        prints.push_back(disc(make_frame(0.02 * n, n), stage.triangle_at(0.02 * n), random.uniform(0.001, 0.02), 1e-4));
    }
    std::set<std::uint64_t> hashes;
    for (const int threads : {1, 2, 4, 8}) {
        set_thread_count(threads);
        for (const Isa isa : {Isa::baseline, Isa::avx2, Isa::avx512}) {
            std::vector<std::uint64_t> parts(prints.size());
            parallel_for(prints.size(), 1, [&](std::size_t begin, std::size_t end) {
                PlanScratch scratch;
                for (std::size_t i = begin; i < end; ++i) {
                    const StampOptions options{.isa = isa};
                    const Motion motion = i % 3 == 0 ? Motion{Vec2{3e-3, -1e-3}, 0} : Motion{Vec2{2e-4, -1e-4}, 0.05};
                    StampJobs jobs = plan_stamp(stage.surface(), prints[i], motion, options, {scratch});
                    choose_mode(jobs, i % 2 == 0, options);
                    std::array<float, atlas::kTileTexels> exposure;
                    for (const TileJob& job : jobs.tiles) {
                        evaluate(stage.map, jobs, job, exposure);
                        parts[i] = hash_span(std::span<const float>(exposure), parts[i]);
                    }
                }
            });
            hashes.insert(hash_span(std::span<const std::uint64_t>(parts)));
        }
    }
    set_thread_count(0);
    EXPECT_EQ(hashes.size(), 1u);
}

TEST(Stamp, SixteenBitTexelsAreExposedAsFloatOnes) {
    Stage exact(testing::sphere(0.02, 300));
    Stage small(exact.u, atlas::TexelStore::packed);
    Random random(11);
    double worst = 0, total = 0, difference = 0;
    for (int i = 0; i < 12; ++i) {
        const Vec3 n = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        const Footprint f = disc(make_frame(0.02 * n, n), exact.triangle_at(0.02 * n), random.uniform(0.002, 0.01),
                                 exact.map.texel_size);
        const StampJobs a = exact.plan(f), b = small.plan(f);
        std::vector<float> sum_a(exact.map.n_slots() * atlas::kTileTexels), sum_b = sum_a;
        for_exposed(exact, a, [&](std::uint32_t s, int t, float e) { sum_a[256 * s + t] = e; });
        for_exposed(small, b, [&](std::uint32_t s, int t, float e) { sum_b[256 * s + t] = e; });
        for (std::size_t k = 0; k < sum_a.size(); ++k) {
            worst = std::max(worst, double(std::abs(sum_a[k] - sum_b[k])));
            difference += sum_b[k] - sum_a[k];
            total += sum_a[k];
        }
    }
    // (u, v) moves by the position's 4e-4 texels and, 150 texels away, half of 6.5e-5 rad: 5e-3
    // texels, on a rim one texel wide; without a bias.
    EXPECT_LT(worst, 6e-3);
    EXPECT_LT(std::abs(difference) / total, 1e-5);
}

TEST(Stamp, FullAndEmptyQuadrantsAreExact) {
    Stage stage(testing::sphere(0.02, 300));
    Random random(3);
    std::size_t full = 0, empty = 0;
    for (int i = 0; i < 36; ++i) {
        const Vec3 n = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        Footprint f = disc(make_frame(0.02 * n, n), stage.triangle_at(0.02 * n), random.uniform(0.003, 0.012), 0.5e-4);
        if (i % 2 == 1)  // A bristle's thin line instead of a disc.
            for (int j = 0; j < f.height; ++j)
                for (int k = 0; k < f.width; ++k)
                    if (std::abs(2 * j - k - f.height / 2) > 7) f.coverage[std::size_t(j) * f.width + k] = 0;
        // A hole off the middle.
        const int hole = f.width / 3;
        for (int j = hole; j < hole + 7; ++j)
            std::fill_n(f.coverage.begin() + std::size_t(j) * f.width + hole, 5, std::uint8_t{0});
        const Motion motion{Vec2{random.uniform(-5e-4, 5e-4), random.uniform(-5e-4, 5e-4)}, i % 3 == 0 ? 0.05 : 0.0};
        // As many poses as it takes, and 27: 27 / 27 in floats is not 1.
        StampJobs known = stage.plan(f, motion, {.sub_pose = i % 4 == 0 ? 0.01 : 1.0, .max_sub_poses = 27});
        StampJobs plain = known;
        for (ClusterFrame& frame : plain.frames) {
            full += static_cast<std::size_t>(std::popcount(frame.full_quadrants));
            empty += static_cast<std::size_t>(std::popcount(
                static_cast<std::uint8_t>(~(frame.full_quadrants | frame.partial_quadrants) & kAllQuadrants)));
            frame.full_quadrants = 0;
            frame.partial_quadrants = kAllQuadrants;
        }
        std::array<float, atlas::kTileTexels> a, b;
        for (const Isa isa : {Isa::baseline, Isa::avx2, Isa::avx512}) {
            known.isa = isa;
            for (const TileJob& job : known.tiles) {
                evaluate(stage.map, known, job, a);
                evaluate(stage.map, plain, job, b);
                EXPECT_EQ(a, b);
            }
        }
    }
    EXPECT_GT(full, 1000u);  // else the test says nothing
    EXPECT_GT(empty, 1000u);
}

TEST(Stamp, ChangesNothingWhenTheModelIsMoved) {
    const Quat turn = glm::angleAxis(0.9, glm::normalize(Vec3{1, 2, -0.5}));
    const Vec3 shift{0.3, -0.2, 0.1};
    Stage here(testing::sphere(0.02, 200));
    testing::Unwrapped moved = here.u;
    for (Vec3f& p : moved.mesh.positions) p = Vec3f(turn * Vec3(p) + shift);
    for (Vec3f& m : moved.mesh.corner_normals) m = Vec3f(turn * Vec3(m));
    Stage there(std::move(moved));
    const Vec3 n = glm::normalize(Vec3{1, 0.9, 0.7});
    const Footprint f = disc(make_frame(0.02 * n, n), here.triangle_at(0.02 * n), 0.006, 1e-4);
    Footprint g = f;
    g.frame = {turn * f.frame.origin + shift, turn * f.frame.t, turn * f.frame.b, turn * f.frame.n};
    const StampJobs a = here.plan(f), b = there.plan(g);
    // Float positions 0.4 m from the origin: 3e-8 m, 3e-4 cells, on a ramp of one cell.
    EXPECT_NEAR(deposit_area(there, b) / deposit_area(here, a), 1, 1e-4);
    ASSERT_EQ(a.tiles.size(), b.tiles.size());
    std::array<float, atlas::kTileTexels> ea, eb;
    for (std::size_t k = 0; k < a.tiles.size(); ++k) {
        evaluate(here.map, a, a.tiles[k], ea);
        evaluate(there.map, b, b.tiles[k], eb);
        for (int t = 0; t < atlas::kTileTexels; ++t) EXPECT_NEAR(ea[t], eb[t], 2e-3);
    }
}

TEST(Stamp, EmptyAndStrayFootprintsExposeNothing) {
    Stage stage(testing::sheet(0.03, 1, 60));
    EXPECT_TRUE(stage.plan(Footprint{}).empty());
    Footprint f = disc(make_frame({0, 0, 0}, {0, 0, 1}), kNone, 0.002, 1e-4);
    EXPECT_TRUE(stage.plan(f).empty());
    f.triangle = 1000000;
    EXPECT_TRUE(stage.plan(f).empty());
}

TEST(Stamp, ModeHasHysteresis) {
    StampJobs jobs;
    const StampOptions options;
    jobs.discrepancy = 0.012;
    EXPECT_FALSE(choose_mode(jobs, false, options));
    EXPECT_TRUE(choose_mode(jobs, true, options));
    jobs.discrepancy = 0.016;
    EXPECT_TRUE(choose_mode(jobs, false, options));
    jobs.discrepancy = 0.009;
    EXPECT_FALSE(choose_mode(jobs, true, options));
}

}  // namespace
}  // namespace tuft::footprint
