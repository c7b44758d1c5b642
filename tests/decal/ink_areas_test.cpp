#include "decal/ink_areas.h"

#include <gtest/gtest.h>

#include "decal/sheet.h"
#include "surfaces.h"

namespace tuft::decal {
namespace {

using test::kMm;

constexpr double kSide = 50 * kMm;

/// A square of two triangles.
PrintSurface square() {
    PrintSurface s;
    s.faces = {{0, 1, 2}, {0, 2, 3}};
    s.n_own = 2;
    s.flat = {{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}};
    s.source = {0, 1};
    s.weights.assign(2, {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}});
    s.strain = {0, 0};
    return s;
}

const Region kFilm{{{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}}};

/// Coverage by `value(texel middle)`, read between the middles of texels whose rows are turned against the sheet's.
template <class Value>
CoverageFn mapped(double texel, Value value) {
    return [=](std::uint32_t triangle, const Weights& w) {
        const Vec2 p = kSide * (triangle == 0 ? Vec2(w[1] + w[2], w[2]) : Vec2(w[1], w[1] + w[2]));
        constexpr double c = 0.96, s = 0.28;
        const Vec2 q{(c * p.x + s * p.y) / texel, (c * p.y - s * p.x) / texel};
        const Vec2 low = glm::floor(q), part = q - low;
        const auto at = [&](double i, double j) {
            const Vec2 t = texel * (low + Vec2(i, j));
            return value(Vec2(c * t.x - s * t.y, s * t.x + c * t.y));
        };
        return std::lerp(std::lerp(at(0, 0), at(1, 0), part.x), std::lerp(at(0, 1), at(1, 1), part.x), part.y);
    };
}

/// The part of a texel within a disc, by its distance from the rim.
double in_disc(const Vec2& p, const Vec2& centre, double radius, double texel) {
    return std::clamp(0.5 + (radius - glm::length(p - centre)) / texel, 0.0, 1.0);
}

/// Sum of the angles by which rings turn, without sign.
double turning(const Region& region) {
    double sum = 0;
    for (const Ring& ring : region)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 a = ring[(i + 1) % ring.size()] - ring[i],
                       b = ring[(i + 2) % ring.size()] - ring[(i + 1) % ring.size()];
            sum += std::abs(std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b)));
        }
    return sum;
}

// A wedge of coverage over one texel holds the place of its half exactly; what bends within a texel errs in the second
// order of texel / radius, below 0.02 % here.
TEST(InkAreas, ADiscAndARingHaveTheirAreas) {
    constexpr double texel = 0.4 * kMm, outer = 15 * kMm, inner = 6 * kMm;
    const Vec2 centre{24.3 * kMm, 25.1 * kMm};
    const auto disc = mapped(texel, [=](const Vec2& p) { return in_disc(p, centre, outer, texel); });
    const Region full = find_ink_area(square(), disc, kFilm, 0, texel);
    ASSERT_EQ(full.size(), 1u);
    const double area = test::kPi * outer * outer;
    EXPECT_NEAR(area_of(full), area, 1e-3 * area);
    const auto ring = mapped(
        texel, [=](const Vec2& p) { return in_disc(p, centre, outer, texel) - in_disc(p, centre, inner, texel); });
    const Region hollow = find_ink_area(square(), ring, kFilm, 0, texel);
    ASSERT_EQ(hollow.size(), 2u);
    EXPECT_LT(area_of(hollow[1]), 0);  // a hole
    const double left = area - test::kPi * inner * inner;
    EXPECT_NEAR(area_of(hollow), left, 1e-3 * left);
}

// Texels that are painted or not: their stairs are half a texel high and turn the border by some 90 degrees a texel.
TEST(InkAreas, StairsOfTexelsAreNoPartOfTheBorder) {
    constexpr double texel = 0.8 * kMm, radius = 20 * kMm;
    const Vec2 centre{25 * kMm, 25 * kMm};
    const auto disc = mapped(texel, [=](const Vec2& p) { return glm::length(p - centre) < radius ? 1.0 : 0.0; });
    const Region region = find_ink_area(square(), disc, kFilm, 0, texel);
    ASSERT_EQ(region.size(), 1u);
    double square_sum = 0, most = 0;
    for (const Vec2& p : region[0]) {
        const double off = glm::length(p - centre) - radius;
        square_sum += off * off;
        most = std::max(most, std::abs(off));
    }
    EXPECT_LT(std::sqrt(square_sum / static_cast<double>(region[0].size())), 0.2 * texel);
    EXPECT_LT(most, 0.7 * texel);                     // half a diagonal: what a texel's middle does not tell
    EXPECT_LT(turning(region), 1.5 * 2 * test::kPi);  // a convex ring turns once; with its stairs this one 16 times
}

// A line that two rows of texels share has half its film on each. The coverage of a texel is its part of the thickest
// film round it (painted_sheet.cpp), so the line is one texel wide where a row has it, and two where rows share it.
TEST(InkAreas, ALineOneTexelWideStays) {
    constexpr double texel = 0.5 * kMm, length = 30 * kMm;
    const Vec2 from{9 * kMm, 12 * kMm}, along = glm::normalize(Vec2(0.9, 0.4)), x{0.96, 0.28}, y{-0.28, 0.96};
    const auto film = [=](const Vec2& p) {
        const double s = glm::dot(p - from, along), across = std::abs(along.x * (p - from).y - along.y * (p - from).x);
        return s < 0 || s > length ? 0.0 : std::max(1 - across / texel, 0.0);
    };
    const auto line = mapped(texel, [=](const Vec2& p) {
        double thickest = 0;
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j)
                thickest = std::max(thickest, film(p + texel * (double{1} * i * x + double{1} * j * y)));
        return film(p) > 0 ? film(p) / thickest : 0.0;
    });
    const Region region = find_ink_area(square(), line, kFilm, 0, texel);
    ASSERT_EQ(region.size(), 1u);  // in one piece
    EXPECT_NEAR(glm::length(box_of(region).size()), length, 3 * texel);
    EXPECT_GT(area_of(region) / length, 0.9 * texel);
    EXPECT_LT(area_of(region) / length, 2.0 * texel);
}

// Beyond a cut line through paint, what hangs together with the paint is printed as far as the bleed.
TEST(InkAreas, RunOnBeyondTheCutAsFarAsTheBleed) {
    const auto painted = mapped(0.1 * kMm, [](const Vec2& p) {
        const bool band = std::abs(p.y - 20 * kMm) < 5 * kMm;
        const bool island = glm::length(p - Vec2(31.5 * kMm, 40 * kMm)) < 1 * kMm;
        return band || island ? 1.0 : 0.0;
    });
    const Region film{{{10 * kMm, 5 * kMm}, {30 * kMm, 5 * kMm}, {30 * kMm, 45 * kMm}, {10 * kMm, 45 * kMm}}};
    const Region region = find_ink_area(square(), painted, film, 3 * kMm, 0.1 * kMm);
    ASSERT_EQ(region.size(), 1u);
    EXPECT_NEAR(area_of(region), 26 * 10 * kMm * kMm, 0.1 * 72 * kMm * kMm);  // a texel along its border
}

TEST(InkAreas, OneInkIsAMixOfOneProportion) {
    PaintSamples samples{.area = 1, .cover = {1, 1, 1}, .colour = {}, .amounts = {2, 1, 1, 0.5f, 0.5f, 0.25f}};
    samples.colour.assign(3, {0.1f, 0.2f, 0.3f});
    const auto one = find_single_ink(samples);
    ASSERT_TRUE(one);
    EXPECT_NEAR(one->mix[0], 2.0 / 3, 1e-6);
    EXPECT_NEAR(one->colour[2], 0.3, 1e-6);
    samples.amounts = {2, 0, 1, 0.5f, 0.5f, 1};
    EXPECT_FALSE(find_single_ink(samples));
}

/// The sheet of a square film of 40 mm with a disc of paint in one mix.
Sheet disc_sheet(float film, const SheetOptions& options) {
    const mesh::TriangleMesh model =
        test::grid_mesh(2, 2, false, false, [](double u, double v) { return Vec3(0.04 * u, 0.04 * v, 0); });
    const std::vector<Vec2f> uvs(3 * model.n_triangles(), Vec2f(0.5f));
    const ink::AtlasMap<std::uint8_t> colour{1, 3, {200, 30, 40}};
    const ink::AtlasMap<float> amounts{1, 2, {0.7f * film, 0.3f * film}};
    const PrintSource source{.corner_uvs = uvs,
                             .coverage = test::coverage_where(
                                 model, [](const Vec3& p) { return glm::length(p - Vec3(0.02, 0.02, 0)) < 0.01; }),
                             .colour = &colour,
                             .amounts = &amounts,
                             .full = {8, 8},  // somewhere else
                             .texel = 0.5 * kMm};
    return make_sheet(model, source, options);
}

// In steps of 255 of the most there is, the parts of so thin a film were 1 and 0.
TEST(InkAreas, ThinFilmOfOneMixIsOneInk) {
    const Sheet sheet = disc_sheet(0.04f, {.outlines = true});
    ASSERT_EQ(sheet.inks.size(), 1u);
    EXPECT_NEAR(sheet.inks[0].mix[1], 0.3, 1e-6);
    EXPECT_NEAR(sheet.inks[0].colour[0], 200 / 255.0, 1e-6);
    EXPECT_TRUE(sheet.pages[0].prints.empty());
}

// Pictures of this film would have more than 2^28 pixels; lines alone need none.
TEST(InkAreas, AreFoundWithoutThePixelsOfAPicture) {
    const Sheet sheet = disc_sheet(1, {.pixel = 1e-6, .prints = false, .outlines = true});
    ASSERT_EQ(sheet.pages[0].areas.size(), 1u);
    const double truth = test::kPi * 0.01 * 0.01;
    EXPECT_NEAR(area_of(sheet.pages[0].areas[0].region), truth, 1e-2 * truth);  // texels of 0.5 mm
}

// Triangles from one corner: the box of each holds most of the film.
TEST(InkAreas, PointsUnderNeedlesAreFoundInFewCells) {
    constexpr std::uint32_t n = 2000;
    PrintSurface fan;
    fan.flat.push_back({0, 0});
    for (std::uint32_t i = 0; i <= n; ++i) {
        const double angle = 2 * test::kPi * i / n;
        fan.flat.push_back({std::cos(angle), std::sin(angle)});
        if (i == 0) continue;
        fan.faces.push_back({0, i, i + 1});
        fan.source.push_back(i - 1);
    }
    fan.n_own = n;
    fan.weights.assign(n, {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}});
    const SurfaceLocator locator(fan);
    EXPECT_LE(locator.n_listed(), std::size_t{32} * n);  // 160 in cells of the mean area
    for (const Vec2 p : {Vec2(0.3, 0.2), Vec2(-0.7, 0.1), Vec2(0.01, -0.9)})
        EXPECT_EQ(locator.locate(p)->triangle, locate(fan, p)->triangle);
}

TEST(InkAreas, EachPlateOfASheetHasItsOwn) {
    const mesh::TriangleMesh model =
        test::grid_mesh(20, 20, false, false, [](double u, double v) { return Vec3(0.1 * u, 0.1 * v, 0); });
    const auto disc = [&](double x) {
        return test::coverage_where(model, [x](const Vec3& p) { return glm::length(p - Vec3(x, 0.05, 0)) < 0.01; });
    };
    const std::vector<Vec2f> uvs(3 * model.n_triangles(), Vec2f(0.5f));
    ink::AtlasMap<std::uint8_t> colour{1, 3, {200, 30, 40}};
    PrintSource source{.corner_uvs = uvs, .coverage = {}, .colour = &colour, .full = {1, 1}, .texel = 0.2 * kMm};
    source.plates = {disc(0.03), disc(0.055)};
    source.coverage = [&](std::uint32_t t, const Weights& w) {
        return std::max(source.plates[0](t, w), source.plates[1](t, w));
    };
    const Sheet sheet = make_sheet(model, source, {.outlines = true});
    ASSERT_EQ(sheet.pages[0].areas.size(), 2u);
    EXPECT_TRUE(sheet.pages[0].prints.empty());
    std::vector<Vec2> centres;
    for (std::size_t m = 0; m < 2; ++m) {
        const InkArea& area = sheet.pages[0].areas[m];
        EXPECT_EQ(area.ink, m);
        const double truth = test::kPi * 0.01 * 0.01;
        EXPECT_NEAR(area_of(area.region), truth, 1e-3 * truth);
        const Box2 box = box_of(area.region);
        centres.push_back(0.5 * (box.lo + box.hi));
    }
    EXPECT_NEAR(glm::length(centres[1] - centres[0]), 0.025, 0.1 * kMm);
}

}  // namespace
}  // namespace tuft::decal
