#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/error.h"
#include "entry_text.h"
#include "sheet.h"
#include "stroke/journal/journal.h"
#include "stroke/surface/surface_stencil.h"

namespace tuft::stroke {
namespace {

// A star: ten sharp corners, by turns out and in. Counter-clockwise where y points up.
std::vector<Vec2> star(double r) {
    std::vector<Vec2> ring;
    for (int i = 0; i < 10; ++i) {
        const double a = std::numbers::pi * (i + 0.3) / 5;
        ring.push_back((i % 2 ? 0.4 : 1) * r * Vec2(std::cos(a), std::sin(a)));
    }
    return ring;
}

std::vector<StencilEdge> edges_round(const std::vector<Vec2>& ring) {
    std::vector<StencilEdge> edges;
    for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
    return edges;
}

bool within(const std::vector<Vec2>& ring, const Vec2& p) {
    bool inside = false;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
        if ((ring[i].y > p.y) != (ring[j].y > p.y) &&
            p.x < ring[j].x + (p.y - ring[j].y) / (ring[i].y - ring[j].y) * (ring[i].x - ring[j].x))
            inside = !inside;
    return inside;
}

TEST(SurfaceStencil, SidesAreThePolygons) {
    const std::vector<Vec2> ring = star(1);
    const std::vector<StencilEdge> edges = edges_round(ring);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-1.5, 1.5);
    for (int i = 0; i < 20'000; ++i) {
        const Vec2 p(place(random), place(random));
        EXPECT_EQ(inside_stencil(edges, p) > 0, within(ring, p)) << p.x << ' ' << p.y;
    }
    EXPECT_EQ(inside_stencil({}, {0, 0}), HUGE_VAL);
}

// A flat line over the sheet's middle, whatever way the sheet lies, with a star's stencil edge on it.
PaintStroke over_a_star(const Frame& frame, double r) {
    PaintStroke s;
    s.brush = "mixed-small";
    s.ink = "carbon";
    s.trace.placement = {frame.origin, frame.t, -frame.b};
    for (int i = 0; i <= 200; ++i)
        s.trace.samples.push_back({.time = 0.005 * i, .position = {1e-4 * i - 0.01, 0, 0}, .pressure = 0.6});
    s.trace.stencil = edges_round(star(r));
    return s;
}

TEST(SurfaceStencil, InkStaysWithinAndFillsWhatItFilled) {
    for (const Frame& frame : {Frame{}, make_frame({0.1, -0.2, 0.05}, glm::normalize(Vec3{1, 2, -0.5}))}) {
        const Model model = sheet(frame);
        PaintStroke with_stencil = over_a_star(frame, 5e-3), free = with_stencil;
        free.trace.stencil.clear();
        Document a(model), b(model);
        a.paint(with_stencil);
        b.paint(free);
        const double texel = model.texels.texel_size;
        int inside = 0, outside = 0;
        for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot) {
            const ink::Plane *p = a.layers().canvas().plane(slot, 0), *q = b.layers().canvas().plane(slot, 0);
            for (int t = 0; q && t < atlas::kTileTexels; ++t) {
                if (model.texels.tiles[slot].area[t] <= 0 || (*q)[t] < 0.5f) continue;
                const Vec3 at = Vec3(model.texels.position(slot, t)) - frame.origin;
                const double d =
                    inside_stencil(with_stencil.trace.stencil, {glm::dot(at, frame.t), -glm::dot(at, frame.b)});
                const double film = p ? (*p)[t] : 0;
                // A footprint is swept over the step from the one before, which is a texel.
                if (d < -2 * texel) {
                    ++outside;
                    EXPECT_EQ(film, 0) << "over the stencil";
                } else if (d > texel) {
                    ++inside;
                    EXPECT_GT(film, 0.9 * (*q)[t]);
                }
            }
        }
        // The star's arms and what lies between them, of a line 3 mm wide.
        EXPECT_GT(inside, 1000);
        EXPECT_GT(outside, 1000);
    }
}

// By squares of cells and runs of clusters comes out what every cell by every cluster does.
TEST(SurfaceStencil, EachCellIsCutByTheNearestEdge) {
    const Model model = sheet();
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-8e-3, 8e-3), radius(2e-3, 6e-3);
    for (int i = 0; i < 40; ++i) {
        StrokeSamples trace{.placement = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}};
        std::vector<Vec2> ring = star(radius(random));
        if (i % 2)  // a jagged disk of 2000 clusters
            for (ring.clear(); ring.size() < 2000;) {
                const double a = 2 * std::numbers::pi * static_cast<double>(ring.size()) / 2000;
                ring.push_back((ring.size() % 2 ? 5e-3 : 5.05e-3) * Vec2(std::cos(a), std::sin(a)));
            }
        trace.stencil = edges_round(ring);
        footprint::Footprint f;
        f.cell = 1e-4;
        f.width = 61;
        f.height = 47;
        f.frame = make_frame({place(random), place(random), 0}, {0, 0, 1});
        f.lo = -0.5 * f.cell * Vec2(f.width, f.height);
        f.radius = glm::length(f.lo);
        f.coverage.assign(static_cast<std::size_t>(f.width) * static_cast<std::size_t>(f.height), 200);
        const footprint::Footprint whole = f;
        SurfaceStencil(*model.query, trace).cut_off(f);
        for (int y = 0; y < f.height; ++y)
            for (int x = 0; x < f.width; ++x) {
                const Vec2 at = f.lo + f.cell * Vec2(x + 0.5, y + 0.5);
                const Vec3 p = f.frame.origin + at.x * f.frame.t + at.y * f.frame.b;
                const double stays = std::clamp(0.5 + inside_stencil(trace.stencil, {p.x, -p.y}) / f.cell, 0.0, 1.0);
                // SurfaceMapping the stencil edge rounds; a count is 1 / 200 of a cell.
                EXPECT_NEAR(f.coverage[static_cast<std::size_t>(y * f.width + x)], 200 * stays, 1.01) << x << ' ' << y;
            }
    }
}

TEST(SurfaceStencil, IsKeptInTheJournal) {
    PaintStroke s = over_a_star({}, 1.0 / 3);
    EXPECT_EQ(written_and_read(s).get<PaintStroke>().trace.stencil, s.trace.stencil) << "to the bit";
    s.trace.stencil.clear();
    EXPECT_TRUE(written_and_read(s).get<PaintStroke>().trace.stencil.empty());
    for (const char* bad :
         {R"({"tape":7})", R"({"tape":[1,2,3]})", R"({"tape":[1,2,3,"4"]})", R"({"tape":[1,2,3,1e999]})"})
        EXPECT_THROW(entry_of({}, bad), Error) << bad;
}

// As a hostile file may have it: clusters go by the whole, not by each edge.
TEST(SurfaceStencil, AStencilOfAnyLengthHasFewSegments) {
    const Model model = sheet();
    StrokeSamples trace{.placement = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    for (const double length : {0.02, 1e5, 1e150, 1e308}) {
        trace.stencil.assign(500, {{-0.01, 0}, {length - 0.01, 0}});
        EXPECT_LE(SurfaceStencil(*model.query, trace).clusters().size(), 100'000u + 500u) << length;
    }
    trace.stencil.assign(1, {{-0.01, 0}, {0.01, 0}});
    EXPECT_GE(SurfaceStencil(*model.query, trace).clusters().size(), 20u) << "1 mm each";
}

}  // namespace
}  // namespace tuft::stroke
