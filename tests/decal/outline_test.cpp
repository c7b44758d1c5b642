#include "decal/outline.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "decal/nest.h"
#include "surfaces.h"

namespace tuft::decal {
namespace {

using test::kMm;

/// Outlines of what is painted on a sheet 100 mm wide.
struct Sheet100 {
    mesh::TriangleMesh model =
        test::grid_mesh(80, 80, false, false, [](double u, double v) { return Vec3(0.1 * u, 0.1 * v, 0); });

    /// Where a point of a panel's plane lies on the sheet: both are flat, so one triangle says it of all.
    static Vec2 on_model(const FilmMesh& film, const Panel& panel, const Vec2& p) {
        const auto& face = panel.chart.faces[0];
        const auto& corners = film.mesh.triangles[panel.chart.triangles[0]];
        const auto at = [&](std::size_t k) { return Vec2(film.mesh.positions[corners[k]]); };
        const auto complex_ratio = [](const Vec2& a, const Vec2& b) {
            return Vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y) / glm::dot(b, b);
        };
        const Vec2 turn = glm::normalize(complex_ratio(at(1) - at(0), panel.flat[face[1]] - panel.flat[face[0]]));
        const Vec2 d = p - panel.flat[face[0]];
        return at(0) + Vec2(turn.x * d.x - turn.y * d.y, turn.y * d.x + turn.x * d.y);
    }

    template <class Painted>
    std::vector<Outline> outlines(Painted painted, const OutlineOptions& options = {}) const {
        return outlines_of(test::coverage_where(model, painted), options);
    }

    std::vector<Outline> outlines_of(const CoverageFn& coverage, OutlineOptions options) const {
        FilmMesh film = select_film(model, coverage, {.bleed = 8 * kMm}, 0.3 * kMm);
        const std::vector<Panel> panels = cut_into_panels(film, coverage, {});
        options.overlap = [](std::uint32_t) { return 0.0; };
        std::vector<Outline> all;
        for (const Panel& panel : panels) {
            const PrintSurface surface = extend(film, panel, [](std::uint32_t) { return 0.0; });
            for (Outline& o : find_outlines(film, panel, surface, coverage, options)) {
                for (Ring& ring : o.film)
                    for (Vec2& p : ring) p = on_model(film, panel, p);
                all.push_back(std::move(o));
            }
        }
        return all;
    }
};

auto disc(const Vec3& centre, double radius) {
    return [=](const Vec3& p) { return glm::length(p - centre) < radius; };
}

/// A shape by the signed distance from its border, positive outside.
struct Shape {
    std::string name;
    std::function<double(const Vec2& p)> outside;
    double area, perimeter;  // m², metres
    std::vector<Vec2> corners = {};

    double corner(const Vec2& p) const {
        double least = 1;
        for (const Vec2& c : corners) least = std::min(least, glm::length(p - c));
        return least;
    }

    /// Coverage as a map has it: the mean over texels whose rows are turned against the grid of the outline, read
    /// between their middles. A shape with sides is the half plane of its nearest side within a texel.
    CoverageFn mapped(const mesh::TriangleMesh& model, double texel) const {
        return [this, &model, texel](std::uint32_t triangle, const Weights& w) {
            const Vec3 p = point_at(model, triangle, w);
            constexpr double c = 0.8, s = 0.6;
            const Vec2 q{(c * p.x + s * p.y) / texel, (c * p.y - s * p.x) / texel};
            const Vec2 low = glm::floor(q), part = q - low;
            const auto mean_of = [&](const Vec2& texel_at) {
                const Vec2 middle = texel * Vec2(c * texel_at.x - s * texel_at.y, s * texel_at.x + c * texel_at.y);
                double sum = 0;
                constexpr int n = 5;
                if (const double d = outside(middle); std::abs(d) > texel) return d < 0 ? 1.0 : 0.0;
                for (int i = 0; i < n * n; ++i) {
                    const Vec2 o = texel * (Vec2(i % n + 0.5, i / n + 0.5) / double{n} - Vec2(0.5));
                    sum += outside(middle + Vec2(c * o.x - s * o.y, s * o.x + c * o.y)) < 0;
                }
                return sum / double{n * n};
            };
            const auto row = [&](double y) {
                return (1 - part.x) * mean_of(low + Vec2(0, y)) + part.x * mean_of(low + Vec2(1, y));
            };
            return (1 - part.y) * row(0) + part.y * row(1);
        };
    }
};

const Vec2 kMiddle{0.0503, 0.0498};

Shape rectangle(double a, double b, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    Shape shape{fmt::format("{} x {} mm turned by {}", a / kMm, b / kMm, angle),
                [=](const Vec2& p) {
                    const Vec2 d = p - kMiddle;
                    const Vec2 e(std::abs(c * d.x + s * d.y) - 0.5 * a, std::abs(c * d.y - s * d.x) - 0.5 * b);
                    return std::min(0.0, std::max(e.x, e.y)) + glm::length(glm::max(e, Vec2(0)));
                },
                a * b, 2 * (a + b)};
    for (const double x : {-0.5 * a, 0.5 * a})
        for (const double y : {-0.5 * b, 0.5 * b})
            shape.corners.push_back(kMiddle + Vec2(c * x - s * y, s * x + c * y));
    return shape;
}

Shape ring_shape(double inner, double outer) {
    return {fmt::format("ring of {} to {} mm", inner / kMm, outer / kMm),
            [=](const Vec2& p) {
                const double r = glm::length(p - kMiddle);
                return std::max(r - outer, inner - r);
            },
            test::kPi * (outer * outer - inner * inner), 2 * test::kPi * (outer + inner)};
}

// The cut line of a convex shape is `bleed` outside it everywhere, with corners of that radius: Steiner's formulas give
// its length and area. Stairs of a cell would make it longer by up to a quarter. A straight edge errs by what the half
// coverage does that is read between texels, 0.086 of a texel, with 10 µm. Texels show a corner round: half of them is
// covered 0.7 of a texel inside it at most.
TEST(Outline, RunsTheBleedOutsideThePaint) {
    const double texel = 0.1 * kMm, tolerance = 0.02 * kMm, corner = 0.7 * texel;
    for (const Shape& shape :
         {rectangle(8 * kMm, 5 * kMm, 0), rectangle(12.04 * kMm, 8.07 * kMm, test::kPi / 4), ring_shape(0, 7 * kMm)})
        for (const double bleed : {0.0, 3 * kMm}) {
            SCOPED_TRACE(fmt::format("{}, bleed {} mm", shape.name, bleed / kMm));
            const Sheet100 sheet;
            const auto found = sheet.outlines_of(shape.mapped(sheet.model, texel),
                                                 {.bleed = bleed, .join = 2 * bleed, .least_side = 0});
            ASSERT_EQ(found.size(), 1u);
            ASSERT_EQ(found[0].film.size(), 1u);
            const Ring& ring = found[0].film[0];
            double length = 0, side = 0, worst = 0;
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Vec2 &p = ring[i], &q = ring[(i + 1) % ring.size()];
                length += glm::length(q - p);
                for (const double s : {0.0, 0.25, 0.5, 0.75}) {
                    const Vec2 at = p + s * (q - p);
                    const double error = std::abs(shape.outside(at) - bleed);
                    worst = std::max(worst, error);
                    if (shape.corner(at) > bleed + 3 * texel) side = std::max(side, error);
                }
            }
            const bool has_corners = !shape.corners.empty();
            EXPECT_LT(side, tolerance);
            EXPECT_LT(worst, has_corners ? corner : tolerance);
            const double perimeter = shape.perimeter + 2 * test::kPi * bleed;
            EXPECT_NEAR(length, perimeter, 4 * corner);
            EXPECT_NEAR(area_of(ring), shape.area + shape.perimeter * bleed + test::kPi * bleed * bleed,
                        tolerance * perimeter);
            if (bleed > 0) {
                EXPECT_NEAR(found[0].paint_area, shape.area, 1e-3 * shape.area);
            }
        }
}

// The paint of a ring keeps both its borders; film lies the bleed inside and outside them.
TEST(Outline, IsAsTrueInsideARing) {
    const Shape shape = ring_shape(30 * kMm, 34 * kMm);
    const Sheet100 sheet;
    double area = 0;
    for (const Outline& o : sheet.outlines_of(shape.mapped(sheet.model, 0.1 * kMm), {.bleed = 2 * kMm})) {
        area += area_of(o.film);
        EXPECT_NEAR(o.paint_area, shape.area, 1e-3 * shape.area);
        for (const Ring& ring : o.film)
            for (const Vec2& p : ring) EXPECT_NEAR(shape.outside(p), 2 * kMm, 0.02 * kMm);
    }
    EXPECT_NEAR(area, test::kPi * (36 * 36 - 28 * 28) * 1e-6, 0.02 * kMm * 2 * test::kPi * 64 * kMm);
}

// Paint that ends sharply, sample by sample, is found between the samples too.
TEST(Outline, FindsTheEndOfSharpPaint) {
    for (const double bleed : {1 * kMm, 3 * kMm, 8 * kMm}) {
        const auto found = Sheet100().outlines(disc({0.05, 0.05, 0}, 0.02), {.bleed = bleed});
        ASSERT_EQ(found.size(), 1u);
        ASSERT_EQ(found[0].film.size(), 1u);
        for (const Vec2& p : found[0].film[0]) EXPECT_NEAR(glm::length(p - Vec2(0.05)), 0.02 + bleed, 0.02 * kMm);
        EXPECT_NEAR(found[0].paint_area, test::kPi * 0.02 * 0.02, 5e-3 * test::kPi * 0.02 * 0.02);  // cells on the rim
    }
}

// A line of paint thinner than a cell that passes between nodes is as wide as its samples, and never lost.
TEST(Outline, KeepsLinesThinnerThanACell) {
    const double width = 0.06 * kMm;
    const auto line = [&](const Vec3& p) { return std::abs(p.x - 0.05) < 0.5 * width && std::abs(p.y - 0.05) < 0.02; };
    const auto found =
        Sheet100().outlines(line, {.bleed = 2 * kMm, .join = 4 * kMm, .least_side = 0, .texel = 0.02 * kMm});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(box_of(found[0].film).size().x, width + 4 * kMm, 0.06 * kMm);  // a sample each side, and the clearance
    EXPECT_NEAR(box_of(found[0].film).size().y, 44 * kMm, 0.04 * kMm);
}

// Paint that runs to the end of the surface ends there.
TEST(Outline, EndsWithTheSurface) {
    const auto found = Sheet100().outlines([](const Vec3& p) { return p.x > 0.09 && std::abs(p.y - 0.05) < 0.01; },
                                           {.bleed = 3 * kMm});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(box_of(found[0].film).size().x, 16 * kMm, 0.04 * kMm);
    EXPECT_NEAR(box_of(found[0].film).size().y, 26 * kMm, 0.04 * kMm);
}

TEST(Outline, NearIslandsShareAPieceAndFarOnesDoNot) {
    const auto two = [](double apart) {
        return [=](const Vec3& p) {
            return disc({0.05 - 0.5 * apart, 0.05, 0}, 5 * kMm)(p) || disc({0.05 + 0.5 * apart, 0.05, 0}, 5 * kMm)(p);
        };
    };
    EXPECT_EQ(Sheet100().outlines(two(19 * kMm), {.bleed = 1 * kMm}).size(), 1u);  // 9 mm between them
    EXPECT_EQ(Sheet100().outlines(two(24 * kMm), {.bleed = 3 * kMm}).size(), 2u);  // 14 mm
    EXPECT_EQ(Sheet100().outlines(two(40 * kMm), {.bleed = 1 * kMm}).size(), 2u);  // 30 mm
    EXPECT_EQ(Sheet100().outlines(two(27 * kMm), {.bleed = 8 * kMm}).size(), 2u);  // 1 mm between their films
}

// Film tears from a sharp inner corner. Two arcs that meet leave none: a disc of a little less than half the bleed that
// rolls round the film touches all of its line, so the closing by that disc adds nothing. Two discs with their sharp
// corners would leave 2.1 mm². Tolerance: a tenth of a cell along the line, as elsewhere.
TEST(Outline, HasNoSharpInnerCorner) {
    const auto two = [](const Vec3& p) {
        return disc({0.043, 0.05, 0}, 2 * kMm)(p) || disc({0.057, 0.05, 0}, 2 * kMm)(p);
    };
    const auto found = Sheet100().outlines(two, {.bleed = 8 * kMm});
    ASSERT_EQ(found.size(), 1u);
    const Region closed = offset(offset(found[0].film, 3.5 * kMm), -3.5 * kMm);
    EXPECT_LT(area_of(closed) - area_of(found[0].film), 0.01 * kMm * 80 * kMm);
    EXPECT_GT(area_of(found[0].film), test::kPi * 100 * kMm * kMm);
}

TEST(Outline, ASpeckGetsFilmThatFingersCanHold) {
    const auto found = Sheet100().outlines(disc({0.05, 0.05, 0}, 0.4 * kMm), {.bleed = 0.5 * kMm});
    ASSERT_EQ(found.size(), 1u);
    const Vec2 size = box_of(found[0].film).size();
    EXPECT_NEAR(size.x, 10 * kMm, 0.2 * kMm);
    EXPECT_NEAR(size.y, 10 * kMm, 0.2 * kMm);
}

// A frame keeps its hole where that is wide, and loses it where it would only be a fiddly one.
TEST(Outline, KeepsWideHolesOnly) {
    const auto ring = [](double inner) {
        return [=](const Vec3& p) {
            const double r = glm::length(p - Vec3(0.05, 0.05, 0));
            return r < inner + 4 * kMm && r > inner;
        };
    };
    double area = 0;
    for (const Outline& o : Sheet100().outlines(ring(30 * kMm), {.bleed = 2 * kMm})) area += area_of(o.film);
    EXPECT_NEAR(area, test::kPi * (36 * 36 - 28 * 28) * 1e-6, 2e-5);  // half a cell along 400 mm
    const auto small = Sheet100().outlines(ring(14 * kMm), {.bleed = 2 * kMm});
    ASSERT_EQ(small.size(), 1u);
    EXPECT_EQ(small[0].film.size(), 1u);
}

// A shape whose every corner points outwards has nothing that a closing fills. Grown by 2 mm each of these had an arc
// that an inward offset turned into a spike as long as the radius.
TEST(Offset, AClosingHasNoSpikes) {
    const std::vector<std::pair<double, Ring>> shapes = {
        {0.0020, {{0, 0}, {-3168, -120}, {-4043, -114}, {-7347, 63}, {117093, -115107}}},
        {0.0022, {{0, 0}, {118066, -114533}, {119293, -114497}, {119843, -114495}, {123338, -114571}}},
        {0.0025, {{0, 0}, {8290, -115163}, {12674, -115069}, {13101, -115067}, {19681, -115173}}}};
    for (auto [radius, ring] : shapes) {
        for (Vec2& p : ring) p *= 1e-7;
        if (area_of(ring) < 0) std::reverse(ring.begin(), ring.end());
        const Region closed = offset(offset({ring}, radius), -radius);
        // 10 um of round corners, 5 um in and 5 um out, on sides that bend by 2 um.
        EXPECT_TRUE(subtract(closed, offset({ring}, 2e-5)).empty()) << radius;
        EXPECT_TRUE(subtract(offset({ring}, -2e-5), closed).empty()) << radius;
    }
}

TEST(Nest, PiecesLieInsideThePageAndApart) {
    std::vector<NestItem> items;
    Random random(3);
    for (int i = 0; i < 30; ++i) {
        Ring ring;
        const double r = random.uniform(5, 30) * kMm, squeeze = random.uniform(0.3, 1);
        for (int k = 0; k < 40; ++k)
            ring.push_back(r * (1 + 0.3 * std::sin(3 * 2 * test::kPi * k / 40)) *
                           Vec2(std::cos(2 * test::kPi * k / 40), squeeze * std::sin(2 * test::kPi * k / 40)));
        items.push_back({{ring}});
    }
    const Vec2 area{0.19, 0.263};
    const std::vector<NestPlace> places = nest(items, area, 2 * kMm);
    for (std::size_t i = 0; i < items.size(); ++i) {
        ASSERT_TRUE(places[i].fits);
        Ring own = items[i].shapes[0];
        for (Vec2& p : own) {
            p += places[i].offset;
            EXPECT_GE(std::min(p.x, p.y), 0);
            EXPECT_LE(p.x, area.x);
            EXPECT_LE(p.y, area.y);
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (places[j].page != places[i].page) continue;
            Ring other = items[j].shapes[0];
            for (Vec2& p : other) p += places[j].offset;
            // Less than the gap by the points that Clipper's round corners leave out.
            EXPECT_TRUE(intersect(offset({own}, 0.99 * kMm), offset({other}, 0.99 * kMm)).empty()) << i << " " << j;
        }
    }
}

}  // namespace
}  // namespace tuft::decal
