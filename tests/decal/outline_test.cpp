#include "decal/outline.h"

#include <gtest/gtest.h>

#include "decal/nest.h"
#include "surfaces.h"

namespace tuft::decal {
namespace {

using test::kMm;

/// Outlines of what is painted on a sheet 100 mm wide.
struct Sheet100 {
    mesh::TriangleMesh model =
        test::grid_mesh(80, 80, false, false, [](double u, double v) { return Vec3(0.1 * u, 0.1 * v, 0); });

    template <class Painted>
    std::vector<Outline> outlines(Painted painted, OutlineOptions options = {}) const {
        const CoverageFn coverage = test::coverage_where(model, painted);
        FilmMesh film = select_film(model, coverage, 8 * kMm, 0.3 * kMm);
        const std::vector<Panel> panels = cut_into_panels(film, coverage, {});
        options.overlap = [](std::uint32_t) { return 0.0; };
        std::vector<Outline> all;
        for (const Panel& panel : panels) {
            const PrintSurface surface = extend(film, panel, [](std::uint32_t) { return 0.0; });
            for (Outline& o : find_outlines(film, panel, surface, coverage, options)) all.push_back(std::move(o));
        }
        return all;
    }
};

auto disc(const Vec3& centre, double radius) {
    return [=](const Vec3& p) { return glm::length(p - centre) < radius; };
}

// The cut line of a disc is a circle `bleed` outside it; a cell is 0.1 mm, the line within half of that.
TEST(Outline, RunsTheBleedOutsideThePaint) {
    for (const double bleed : {1 * kMm, 3 * kMm, 8 * kMm}) {
        const auto found = Sheet100().outlines(disc({0.05, 0.05, 0}, 0.02), {.bleed = bleed});
        ASSERT_EQ(found.size(), 1u);
        ASSERT_EQ(found[0].film.size(), 1u);
        const double radius = std::sqrt(area_of(found[0].film) / test::kPi);
        EXPECT_NEAR(radius, 0.02 + bleed, 0.05 * kMm);
        EXPECT_NEAR(found[0].paint_area, test::kPi * 0.02 * 0.02, 5e-3 * test::kPi * 0.02 * 0.02);  // cells on the rim
    }
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
