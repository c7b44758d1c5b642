#include "decal/panels/gaps.h"

#include <gtest/gtest.h>

#include "decal/ink_areas.h"
#include "decal/panels/panels.h"
#include "decal/panels/select_film.h"
#include "surfaces.h"

namespace tuft::decal {
namespace {

using test::kMm;

constexpr double kAll = 1e6;  // mm, beyond every model

/// A profile of x and z in mm, drawn along 20 mm of y.
mesh::TriangleMesh drawn(const std::vector<Vec2>& profile) {
    const auto n = static_cast<int>(profile.size()) - 1;
    return test::grid_mesh(n, 8, false, false, [&](double u, double v) {
        const Vec2 p = profile[static_cast<std::size_t>(std::lround(u * n))];
        return kMm * Vec3(p.x, 20 * v, p.y);
    });
}

FilmMesh film_of(const mesh::TriangleMesh& model) {
    return select_film(
        model, [](std::uint32_t, const Weights&) { return 1.0; }, {.bleed = kMm}, kMm);
}

/// mm² of a stripe 4 mm wide and up to `end` along x, on what lies at z = 0 of two panels with a shut line between
/// them, 1.5 mm wide and deep.
double printed_stripe(double run_on, double end) {
    const mesh::TriangleMesh model = drawn(
        {{0, 0}, {10, 0}, {18, 0}, {19.25, 0}, {19.25, -1.5}, {20.75, -1.5}, {20.75, 0}, {22, 0}, {30, 0}, {40, 0}});
    const CoverageFn stripe = test::coverage_where(
        model, [&](const Vec3& p) { return std::abs(p.y - 10 * kMm) < 2 * kMm && p.z > -1e-6 && p.x < end * kMm; });
    FilmMesh film = film_of(model);
    double area = 0;
    for (const Panel& panel : cut_into_panels(film, stripe, {})) {
        const PrintSurface surface = extend(
            film, panel, [](std::uint32_t) { return 0.0; }, find_gaps(model, film), run_on);
        const Box2 box = box_of({surface.flat});
        const Region all = offset({{box.lo, {box.hi.x, box.lo.y}, box.hi, {box.lo.x, box.hi.y}}}, kMm);
        area += 1e6 * area_of(find_ink_area(surface, stripe, all, 0, 0.1 * kMm));
    }
    return area;
}

TEST(Gaps, PaintGoesOnToTheMiddleOfAShutLine) {
    // Laid flat the model is 43 mm long, the gap 4.5 mm. Ends of a stripe are found to a tenth of a texel of 0.1 mm.
    constexpr double kWithin = 4 * 0.02 + 43 * 0.02;
    EXPECT_NEAR(printed_stripe(0, kAll), 4 * (40 - 1.5), kWithin);  // as it lies on the model
    EXPECT_NEAR(printed_stripe(3 * kMm, kAll), 4 * 43, kWithin);
    EXPECT_NEAR(printed_stripe(1 * kMm, kAll), 4 * (38.5 + 2 * 1), kWithin);
    EXPECT_NEAR(printed_stripe(3 * kMm, 19.25), 4 * (19.25 + 2.25), kWithin);  // of one side alone
    EXPECT_NEAR(printed_stripe(3 * kMm, 13), 4 * 13, kWithin);                 // does not reach the gap
}

TEST(Gaps, GroovesAreGapsAndCreasesAreNot) {
    const auto part = [](const std::vector<Vec2>& profile) {
        const mesh::TriangleMesh model = drawn(profile);
        const std::vector<std::uint8_t> in_gap = find_gaps(model, film_of(model));
        return std::accumulate(in_gap.begin(), in_gap.end(), 0.0) / static_cast<double>(in_gap.size());
    };
    EXPECT_EQ(part({{0, 0}, {10, 0}, {20, 0}}), 0);
    EXPECT_EQ(part({{0, 8}, {0, 1}, {0, 0}, {1, 0}, {8, 0}}), 0);                                // inner corner
    EXPECT_EQ(part({{0, 3}, {8, 0.3}, {9, 0}, {10, 0.3}, {18, 3}}), 0);                          // wide valley
    EXPECT_EQ(part({{0, 0}, {10, 0}, {10, -9}, {30, -9}, {30, 0}, {40, 0}}), 0);                 // 20 mm wide
    EXPECT_NEAR(part({{0, 0}, {10, 0}, {11, -3}, {12, 0}, {22, 0}}), 0.5, 1e-12);                // narrow groove
    EXPECT_NEAR(part({{0, 0}, {9, 0}, {9, -2}, {12, -2}, {12, 0}, {22, 0}}), 3.0 / 5.0, 1e-12);  // walls and floor
}

/// A sheet faces another part of the model 5 mm away, but there is no film there for it to be spanned over.
TEST(Gaps, WhatNoFilmSpansIsNone) {
    const mesh::TriangleMesh model = drawn({{0, 0}, {10, 0}, {15, 0}, {20, 0}, {20, 5}, {10, 5}, {0, 5}});
    const auto below = test::coverage_where(model, [](const Vec3& p) { return p.z < 1e-6 && p.x < 12 * kMm; });
    const std::vector<std::uint8_t> in_gap = find_gaps(model, select_film(model, below, {.bleed = kMm}, kMm));
    ASSERT_FALSE(in_gap.empty());
    EXPECT_EQ(std::accumulate(in_gap.begin(), in_gap.end(), 0), 0);
}

/// Each face in a gap knows the rims within reach of its box, in their order.
TEST(Gaps, FacesKnowTheRimsWithinReach) {
    const mesh::TriangleMesh model =
        drawn({{0, 0}, {10, 0}, {11, -3}, {12, 0}, {13, 0}, {14, -3}, {15, 0}, {24, 0}, {34, 0}});
    FilmMesh film = film_of(model);
    const auto all = [](std::uint32_t, const Weights&) { return 1.0; };
    const std::vector<Panel> panels = cut_into_panels(film, all, {});
    const std::vector<std::uint8_t> in_gap = find_gaps(model, film);
    std::size_t known = 0;
    for (const Panel& panel : panels) {
        const PrintSurface surface = extend(
            film, panel, [](std::uint32_t) { return 0.0; }, in_gap, 2 * kMm);
        for (std::size_t t = 0; t < surface.rims_of.size(); ++t) {
            if (!in_gap[panel.chart.triangles[t]]) continue;
            Ring corners;
            for (const std::uint32_t v : surface.faces[t]) corners.push_back(surface.flat[v]);
            const Box2 face = box_of({corners});
            std::vector<std::uint32_t> within;
            for (std::uint32_t r = 0; r < surface.rims.size(); ++r) {
                const Box2 rim = box_of({{surface.rims[r].a, surface.rims[r].b}});
                const Vec2 apart = glm::max(rim.lo - face.hi, face.lo - rim.hi);
                if (std::max(apart.x, apart.y) <= 2 * kMm) within.push_back(r);
            }
            EXPECT_EQ(surface.rims_of[t], within) << t;
            known += within.size();
        }
    }
    EXPECT_GT(known, 0u);
}

}  // namespace
}  // namespace tuft::decal
