#include "decal/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "core/system/parallel.h"
#include "decal/page_marks.h"
#include "decal/stroke_font.h"
#include "ink/colour/pigments.h"
#include "surfaces.h"

namespace tuft::decal {
namespace {

using test::kMm;

/// A model whose paint is given by a formula; its atlas is one texel of one colour.
class SheetOfFormula : public testing::Test {
  protected:
    template <class Painted>
    Sheet sheet(const mesh::TriangleMesh& model, Painted painted, const SheetOptions& options) {
        uvs_.assign(3 * model.n_triangles(), Vec2f(0.5f));
        colour_ = {1, 3, {200, 30, 40}};
        PrintSource source{.corner_uvs = uvs_,
                           .coverage = {},
                           .colour = &colour_,
                           .amounts = nullptr,
                           .full = {},
                           .texel = 0.05 * kMm};
        source.coverage = test::coverage_where(model, painted);
        return make_sheet(model, source, options);
    }

    std::vector<Vec2f> uvs_;
    ink::AtlasMap<std::uint8_t> colour_;
};

double printed_area(const PrintImage& image) {
    double sum = 0;
    for (const std::uint8_t a : image.alpha) sum += a / 255.0;
    return sum * image.pixel * image.pixel;
}

/// Means of the printed pixels within `radius` of a point of the page, by coverage.
Vec2 centroid(const PrintImage& image, const Vec2& near, double radius) {
    Vec2 sum(0);
    double weight = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Vec2 p = image.origin + image.pixel * Vec2(x + 0.5, image.height - 1 - y + 0.5);
            if (glm::length(p - near) > radius) continue;
            const double a = image.alpha[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                         static_cast<std::size_t>(x)];
            sum += a * p;
            weight += a;
        }
    return sum / weight;
}

constexpr double kRadius = 0.05;

/// Geodesic discs on a cylinder of radius kRadius: centre (arc, height), radius.
struct Dot {
    Vec2 centre;
    double radius;
};
auto dots_on_cylinder(std::vector<Dot> dots) {
    return [dots](const Vec3& p) {
        const Vec2 q(kRadius * std::atan2(p.y, p.x), p.z);
        return std::any_of(dots.begin(), dots.end(),
                           [&](const Dot& d) { return glm::length(q - d.centre) < d.radius; });
    };
}

// Pixels of 1/300 inch with four samples a texel: the rim of a disc of 20 mm errs by 0.02 % of its area.
TEST_F(SheetOfFormula, PrintsTheAreaThatIsPainted) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 2.5, 0.1, 240, 60);
    const Sheet made = sheet(model, dots_on_cylinder({{{0, 0.05}, 0.02}}), {.bleed = 3 * kMm});
    ASSERT_EQ(made.pieces.size(), 1u);
    EXPECT_LT(made.pieces[0].strain, 2e-5);
    const double area = test::kPi * 0.02 * 0.02;
    EXPECT_NEAR(printed_area(made.pages[0].prints[0]), area, 1e-3 * area);
    EXPECT_NEAR(made.pieces[0].paint_area, area, 5e-3 * area);  // cells of 0.1 mm
}

// From the model to the print and back: the middles of small dots, found in the picture, are as far apart as on the
// cylinder, and lie under the dots.
TEST_F(SheetOfFormula, RoundTripFromModelToSheetAndBack) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 2.5, 0.1, 400, 60);
    const std::vector<Dot> dots{{{-0.03, 0.02}, 1 * kMm}, {{0.03, 0.03}, 1 * kMm}, {{0.01, 0.08}, 1 * kMm}};
    const Sheet made = sheet(model, dots_on_cylinder(dots), {.bleed = 3 * kMm, .join = 0.1});
    ASSERT_EQ(made.pieces.size(), 1u);
    const Piece& piece = made.pieces[0];
    const PrintSurface& surface = made.surfaces[piece.surface];
    std::vector<Vec2> found;
    for (const Dot& dot : dots) {
        // Where the dot's middle is on the page: the nearest of many points of the panel to it.
        Vec2 near(0);
        double least = 1;
        for (std::size_t t = 0; t < surface.faces.size(); ++t) {
            const Vec3 p = point_at(model, surface.source[t], surface.weights[t][0]);
            const double d = glm::length(Vec2(kRadius * std::atan2(p.y, p.x), p.z) - dot.centre);
            if (d < least) least = d, near = piece.placement(surface.flat[surface.faces[t][0]]);
        }
        found.push_back(centroid(made.pages[0].prints[0], near, 3 * kMm));
        const auto back = locate(surface, piece.placement.inverse(found.back()));
        ASSERT_TRUE(back);
        const auto again = SurfaceLocator(surface).locate(piece.placement.inverse(found.back()));
        ASSERT_TRUE(again);
        EXPECT_EQ(again->triangle, back->triangle);
        EXPECT_EQ(again->weights, back->weights);
        const Vec3 p = point_at(model, back->triangle, back->weights);
        const Vec3 truth(kRadius * std::cos(dot.centre.x / kRadius), kRadius * std::sin(dot.centre.x / kRadius),
                         dot.centre.y);
        EXPECT_LT(glm::length(p - truth), 0.05 * kMm);
    }
    for (std::size_t i = 0; i < dots.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_NEAR(glm::length(found[i] - found[j]), glm::length(dots[i].centre - dots[j].centre), 0.05 * kMm);
}

// A band round a cylinder wider than the page is cut; the lower piece laps under the next by the overlap, and prints
// agree there: together they show the band once and the laps twice.
TEST_F(SheetOfFormula, PanelsLapByTheOverlap) {
    const mesh::TriangleMesh model = test::whole_cylinder(kRadius, 0.08, 240, 40);
    const auto band = [](const Vec3& p) { return p.z > 0.03 && p.z < 0.05; };
    const Sheet made = sheet(model, band, {.bleed = 2 * kMm, .overlap = 6 * kMm, .page = {0.2, 0.15}});
    ASSERT_EQ(made.pieces.size(), 2u);
    double film = 0;
    for (const Piece& piece : made.pieces) film += area_of(piece.film);
    // Film: the band of 24 mm, round once, and a lap at one or both seams of the lower piece.
    const double round = 2 * 240 * kRadius * std::sin(test::kPi / 240), width = 24 * kMm;
    const double laps = film / width - round;
    EXPECT_NEAR(laps, 2 * 6 * kMm, 0.05 * kMm);  // 10 µm of film along both sides of the band
    // Ticks of 2 mm at both ends of each lap, and nothing but paint on the film.
    std::size_t ticks = 0;
    for (std::size_t p = 0; p < made.pages.size(); ++p)
        for (const Line& line : made.pages[p].lines) {
            if (line.role == Role::cut) continue;
            ticks += line.role == Role::label && line.points.size() == 2 &&
                     std::abs(glm::length(line.points[1] - line.points[0]) - 2 * kMm) < 1e-9;
            for (const Piece& piece : made.pieces)
                for (const Vec2& at : line.points)
                    EXPECT_FALSE(piece.page == p && contains(piece.film, piece.placement.inverse(at)));
        }
    EXPECT_EQ(ticks, 4u);
}

// A strip longer than the page is cut through bare film, 1 mm beside the paint: the film of the bleed goes on there.
TEST_F(SheetOfFormula, ACutThroughBareFilmTakesNoBleed) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 1.2, 0.2, 8, 1);
    const auto painted = [](const Vec3& p) {
        const double x = kRadius * std::atan2(p.y, p.x) / kMm, z = p.z / kMm;
        return std::abs(x) < 15 && z > 101 && z < 121;
    };
    const Sheet made =
        sheet(model, painted, {.bleed = 3 * kMm, .overlap = 1 * kMm, .join = 0, .page = {0.1, 0.12}, .prints = false});
    ASSERT_EQ(made.pieces.size(), 1u);
    const double truth = 36 * 26 - (4 - test::kPi) * 9;                            // mm², corners of 3 mm
    EXPECT_NEAR(area_of(made.pieces[0].film) / (kMm * kMm), truth, 0.02 * truth);  // facets of 7 mm, cells of 0.1 mm
    for (const Page& page : made.pages)
        for (const Line& line : page.lines)
            if (line.role == Role::label && line.points.size() == 2)
                EXPECT_GT(std::abs(glm::length(line.points[1] - line.points[0]) - 2 * kMm), 1e-9) << "no tick of a lap";
}

// The film of a disc of 50 mm on a ball of 50 mm radius, with its bleed and the half millimetre of select_film.h, bears
// no more than a tenth above the least strain that a cap of that size must [Milnor1969], under a wide limit too. Facets
// of 1.7 and of 5 mm.
TEST_F(SheetOfFormula, ADiscOnABallIsStrainedByTheLeastPossible) {
    for (const int rings : {90, 30}) {
        const mesh::TriangleMesh model = test::grid_mesh(2 * rings, rings, true, false, [](double u, double v) {
            const double polar = test::kPi * (0.02 + 0.96 * v);
            return kRadius * Vec3(std::sin(polar) * std::cos(2 * test::kPi * u),
                                  std::sin(polar) * std::sin(2 * test::kPi * u), -std::cos(polar));
        });
        const auto disc = [](const Vec3& p) { return std::acos(p.x / glm::length(p)) < 0.5; };
        const Sheet made = sheet(model, disc, {.max_strain = 0.15, .bleed = 3 * kMm, .prints = false});
        ASSERT_EQ(made.pieces.size(), 1u);
        const double polar = 0.5 + 3.5 * kMm / kRadius, k = polar / std::sin(polar);
        EXPECT_LT(made.pieces[0].strain, 1.1 * (k - 1) / (k + 1)) << rings;
    }
}

// Two bars 8 mm apart on two triangles of 600 mm. The page is smaller than these, not than the drawing.
TEST_F(SheetOfFormula, LargeFacetsAreNotCutWhereTheDrawingFits) {
    const mesh::TriangleMesh model =
        test::grid_mesh(1, 1, false, false, [](double u, double v) { return Vec3(0.6 * u, 0.4 * v, 0); });
    const auto bars = [](const Vec3& p) {
        const double x = p.x / kMm - 300, y = p.y / kMm - 200;
        return std::abs(x) < 50 && std::abs(y) > 4 && std::abs(y) < 20;
    };
    const Sheet made = sheet(model, bars, {.bleed = 3 * kMm, .page = {0.21, 0.297}, .prints = false});
    ASSERT_EQ(made.pieces.size(), 1u);
    EXPECT_LT(made.pieces[0].strain, 1e-6);
    const double truth = 106 * 46 - (4 - test::kPi) * 9;  // mm², corners of 3 mm; the gap is narrower than `join`
    EXPECT_NEAR(area_of(made.pieces[0].film) / (kMm * kMm), truth, 0.02 * truth);
}

// A tongue of one area reaches into a bay of the next, so a straight cut between them parts its tip from it. With it
// the area would not fit the page.
TEST_F(SheetOfFormula, LeavesOutWhatACutPartsFromALargePieceAndSaysHowMuch) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 2, 0.03, 100, 30);
    const auto interlocked = [](const Vec3& p) {
        const double x = kRadius * std::atan2(p.y, p.x) / kMm, z = p.z / kMm;
        if (z < 4 || z > 26) return false;
        if (std::abs(z - 15) < 0.5 && x > -5 && x < 5) return true;  // tongue
        if (z > 24.5 && x > -3 && x < 6) return true;                // bridge
        return x > 5 || (x < -2 && (std::abs(z - 15) > 6 || x < -14));
    };
    SheetOptions options{.bleed = 1 * kMm, .join = 2 * kMm, .least_fragment = 0, .page = {0.09, 0.08}, .prints = false};
    const Sheet all = sheet(model, interlocked, options);
    ASSERT_EQ(all.pieces.size(), 3u);
    EXPECT_EQ(all.left_out.fragments, 0u);
    options.least_fragment = 10 * kMm * kMm;
    const Sheet made = sheet(model, interlocked, options);
    ASSERT_EQ(made.pieces.size(), 2u);
    EXPECT_EQ(made.left_out.fragments, 1u);
    EXPECT_GT(made.left_out.paint_area, 0);
    double paint = made.left_out.paint_area, truth = 0;
    for (const Piece& piece : made.pieces) paint += piece.paint_area;
    for (const Piece& piece : all.pieces) truth += piece.paint_area;
    EXPECT_NEAR(paint, truth, 1e-12 * truth);  // sums of the same numbers
    for (std::size_t i = 0; i < made.pieces.size(); ++i) EXPECT_EQ(made.pieces[i].number, static_cast<int>(i) + 1);
}

// Of two areas 15 mm apart, between which the film is cut. The cut goes beside the dot between them, which is a piece
// of its own, however much paint lies around. Its film, 10 mm wide, reaches no other paint.
TEST_F(SheetOfFormula, AWholeDotBesideACutStays) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 2, 0.03, 100, 30);
    for (const double at : {-1.5, 1.5}) {
        const auto between = [&](const Vec3& p) {
            const double x = kRadius * std::atan2(p.y, p.x) / kMm, z = p.z / kMm;
            return glm::length(Vec2(x - at, z - 15)) < 1.2 || (std::abs(x) > 7.5 && z > 4 && z < 26);
        };
        const Sheet made =
            sheet(model, between, {.bleed = 1 * kMm, .join = 2 * kMm, .page = {0.11, 0.08}, .prints = false});
        ASSERT_EQ(made.pieces.size(), 3u) << at;
        EXPECT_EQ(made.left_out.fragments, 0u);
        double least = 1;
        for (const Piece& piece : made.pieces) least = std::min(least, piece.paint_area);
        // Samples of 0.05 mm at the rim of a disc 2.4 mm wide.
        EXPECT_NEAR(least / (test::kPi * 1.2 * 1.2 * kMm * kMm), 1, 0.05);
    }
}

// Dots of 0.5 mm² are specks beside one large area, but not where they are all that is painted.
TEST_F(SheetOfFormula, LeavesOutSpecksOnlyWhereTheyAreNotMissed) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 2, 0.06, 100, 60);
    const auto dots = [](const Vec3& p) {
        const Vec2 at(kRadius * std::atan2(p.y, p.x) / kMm, p.z / kMm);
        return glm::length(at - 20.0 * glm::round(at / 20.0)) < 0.4;
    };
    const auto dot_and_area = [](const Vec3& p) {
        const Vec2 at(kRadius * std::atan2(p.y, p.x) / kMm, p.z / kMm);
        return glm::length(at - Vec2(-30, 30)) < 0.4 || at.x > 0;
    };
    const SheetOptions options{.bleed = 1 * kMm, .join = 2 * kMm, .prints = false};
    const Sheet spatter = sheet(model, dots, options);
    EXPECT_GT(spatter.pieces.size(), 8u);
    EXPECT_EQ(spatter.left_out.fragments, 0u);
    const Sheet with_area = sheet(model, dot_and_area, options);
    EXPECT_EQ(with_area.left_out.fragments, 1u);
    EXPECT_LT(with_area.left_out.paint_area, 1e-6);
}

// A large area of 2,750 mm², and far from it 2 mm² as a strip on film 10 mm wide, or a seal of 16 mm².
TEST_F(SheetOfFormula, LeavesOutSliversThatAreNotWorthTheirFilm) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 2, 0.05, 60, 30);
    const auto painted = [](double width, double height) {
        return [=](const Vec3& p) {
            const double x = kRadius * std::atan2(p.y, p.x) / kMm, z = p.z / kMm;
            return x > -5 || (std::abs(x + 35) < 0.5 * width && std::abs(z - 25) < 0.5 * height);
        };
    };
    SheetOptions options{.bleed = 3 * kMm, .join = 2 * kMm, .prints = false};
    EXPECT_EQ(sheet(model, painted(0.4, 5), options).pieces.size(), 2u) << "nothing is lost unasked";
    options.least_piece = 50 * kMm * kMm;
    const Sheet strip = sheet(model, painted(0.4, 5), options);
    EXPECT_EQ(strip.pieces.size(), 1u);
    EXPECT_EQ(strip.left_out.fragments, 1u);
    EXPECT_NEAR(strip.left_out.paint_area, 2e-6, 0.3e-6);  // rims in samples of 0.05 mm
    EXPECT_EQ(sheet(model, painted(4, 4), options).pieces.size(), 2u) << "a seal";
}

// Dots 1 mm wide all over: beyond a cut line only the rest of those that it cuts is printed, nothing of the next ones.
TEST_F(SheetOfFormula, BleedPrintsOnlyWhatIsCutThrough) {
    const mesh::TriangleMesh model = test::whole_cylinder(kRadius, 0.04, 240, 20);
    const auto dots = [](const Vec3& p) {
        const double row = std::round(p.z / (2.5 * kMm)), step = 2 * test::kPi * kRadius / 125;
        const double arc = kRadius * std::atan2(p.y, p.x) - 0.618 * step * row;  // no straight line passes all rows
        const Vec2 d(arc - step * std::round(arc / step), p.z - 2.5 * kMm * row);
        return glm::length(d) < 0.5 * kMm;
    };
    const Sheet made = sheet(model, dots, {.page = {0.2, 0.15}});
    ASSERT_GE(made.pieces.size(), 2u);
    std::size_t beyond = 0;
    std::map<std::size_t, std::size_t> prints;  // by page: those of the pieces before
    for (const Piece& piece : made.pieces) {
        const PrintImage& print = made.pages[piece.page].prints[prints[piece.page]++];
        const Region near = offset(piece.film, 1.2 * kMm);  // a dot, and two pixels
        for (int y = 0; y < print.height; y += 3)
            for (int x = 0; x < print.width; x += 3) {
                if (print.alpha[static_cast<std::size_t>(y) * static_cast<std::size_t>(print.width) +
                                static_cast<std::size_t>(x)] == 0)
                    continue;
                const Vec2 p =
                    piece.placement.inverse(print.origin + print.pixel * Vec2(x + 0.5, print.height - y - 0.5));
                if (contains(piece.film, p)) continue;
                ++beyond;
                EXPECT_TRUE(contains(near, p));
            }
    }
    EXPECT_GT(beyond, 0u);
}

TEST_F(SheetOfFormula, NumbersMarksAndScaleBarStandOnThePage) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 2.5, 0.1, 120, 60);
    const Sheet made = sheet(model, dots_on_cylinder({{{-0.03, 0.05}, 5 * kMm}, {{0.03, 0.05}, 5 * kMm}}),
                             {.upright = true, .strain_map = true});
    ASSERT_EQ(made.pieces.size(), 2u);
    ASSERT_EQ(made.pages.size(), 2u);
    EXPECT_TRUE(made.pages[1].strain_map);
    Region films;
    for (const Piece& piece : made.pieces) {
        Ring ring = piece.film[0];
        for (Vec2& p : ring) p = piece.placement(p);
        EXPECT_TRUE(intersect(films, {ring}).empty());
        films.push_back(ring);
        // Upright: the arrow points up the page.
        EXPECT_NEAR(piece.placement.s * piece.up.x + piece.placement.c * piece.up.y, 1, 1e-6);
    }
    double scale = 0;
    for (const Line& line : made.pages[0].lines) {
        for (const Vec2& p : line.points) {
            EXPECT_GE(std::min(p.x, p.y), 0);
            EXPECT_LE(p.x, 0.21);
            EXPECT_LE(p.y, 0.297);
            if (line.role == Role::label) {
                EXPECT_FALSE(contains(films, p));  // nothing is printed on a piece
            }
        }
        if (line.role == Role::mark && line.points.size() == 2)
            scale = std::max(scale, glm::length(line.points[1] - line.points[0]));
    }
    EXPECT_NEAR(scale, 50 * kMm, 1e-9);
}

// A person who lays pieces reads them upright. A long bar that slants would take four times the film, and is turned.
TEST_F(SheetOfFormula, PiecesStandUprightWhereThatTakesHardlyMoreFilm) {
    const mesh::TriangleMesh model =
        test::grid_mesh(60, 60, false, false, [](double u, double v) { return Vec3(0.2 * u, 0.2 * v, 0); });
    const auto along = [](const Vec3& p, double turn) {
        return std::cos(turn) * (p.x - 0.1) + std::sin(turn) * (p.y - 0.1);
    };
    const auto lean = [&](const auto& painted) {
        const Sheet made = sheet(model, painted, {});
        EXPECT_EQ(made.pieces.size(), 1u);
        const Piece& piece = made.pieces[0];
        return std::abs(piece.placement.c * piece.up.x - piece.placement.s * piece.up.y);
    };
    const double third = 2 * test::kPi / 3;
    EXPECT_LT(lean([&](const Vec3& p) {  // a triangle of equal sides, 20 degrees askew
                  return std::max({along(p, 0.35), along(p, 0.35 + third), along(p, 0.35 - third)}) < 0.02;
              }),
              1e-6);
    EXPECT_GT(lean([&](const Vec3& p) {
                  return std::abs(along(p, 0.6)) < 0.08 && std::abs(along(p, 0.6 + test::kPi / 2)) < 0.01;
              }),
              0.1);
}

// On a map of strain the foot names the map and states the strain on any page, clear of all else that stands there.
TEST_F(SheetOfFormula, TheFootOfAStrainMapIsWhole) {
    const mesh::TriangleMesh model = test::cylinder_part(kRadius, 2.5, 0.1, 120, 60);
    constexpr double kSize = 2.2 * kMm;
    for (const double width : {0.08, 0.1, 0.105, 0.12, 0.148, 0.164, 0.18, 0.21, 0.297, 0.6}) {
        const Sheet made = sheet(model, dots_on_cylinder({{{0, 0.05}, 5 * kMm}}),
                                 {.page = {width, 0.42}, .strain_map = true, .title = "a door of a car"});
        const Page& map = made.pages.at(1);
        std::vector<const char*> texts{"STRAIN MAP", "0.0 OF 3.0 %"};
        if (width >= 0.1) texts.push_back("PAGE 1/1");
        for (const char* text : texts) {
            const std::vector<std::vector<Vec2>> letters = text_lines(text, Vec2(0), kSize);
            const auto stands_at = [&](const Vec2& at) {
                return std::ranges::all_of(letters, [&](const std::vector<Vec2>& letter) {
                    return std::ranges::any_of(map.lines, [&](const Line& line) {
                        return line.points.size() == letter.size() &&
                               glm::length(line.points[0] - letter[0] - at) < 1e-9 &&
                               glm::length(line.points.back() - letter.back() - at) < 1e-9;
                    });
                });
            };
            const auto found = std::ranges::find_if(
                map.lines, [&](const Line& line) { return stands_at(line.points[0] - letters[0][0]); });
            ASSERT_NE(found, map.lines.end()) << text << ' ' << width;
            const Vec2 lo = found->points[0] - letters[0][0], hi = lo + Vec2(text_width(text, kSize), kSize);
            const auto is_inside = [&](const Vec2& p) { return p.x > lo.x && p.x < hi.x && p.y > lo.y && p.y < hi.y; };
            std::size_t n_inside = 0;
            for (const Line& line : map.lines) n_inside += std::ranges::any_of(line.points, is_inside);
            EXPECT_LE(n_inside, letters.size()) << text << ' ' << width;
            for (const PrintImage& print : map.prints) {
                const Vec2 end = print.origin + print.pixel * Vec2(print.width, print.height);
                EXPECT_FALSE(print.origin.x < hi.x && end.x > lo.x && print.origin.y < hi.y && end.y > lo.y)
                    << text << ' ' << width;
            }
        }
    }
}

// Same bits for any number of threads.
TEST_F(SheetOfFormula, DoesNotDependOnTheNumberOfThreads) {
    const mesh::TriangleMesh model = test::sphere_cap(0.05, 1.3, 30);
    const auto painted = [](const Vec3& p) { return p.z > 0.02 && std::sin(300 * p.x) > 0; };
    std::vector<Sheet> made;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        made.push_back(sheet(model, painted, {}));
    }
    set_thread_count(0);
    ASSERT_EQ(made[0].pieces.size(), made[1].pieces.size());
    for (std::size_t i = 0; i < made[0].pieces.size(); ++i) {
        EXPECT_EQ(made[0].pieces[i].film, made[1].pieces[i].film);
        EXPECT_EQ(made[0].pages[0].prints.size(), made[1].pages[0].prints.size());
    }
    for (std::size_t i = 0; i < made[0].pages[0].prints.size(); ++i)
        EXPECT_EQ(made[0].pages[0].prints[i].alpha, made[1].pages[0].prints[i].alpha);
}

// Plates hold amounts: laid over each other by Kubelka and Munk's law they are the colour of the painting. Tints are
// steps of 1/255 of the fullest texel; two codes are what such a step changes at most here.
TEST(Plates, SumToTheColour) {
    const mesh::TriangleMesh model =
        test::grid_mesh(20, 20, false, false, [](double u, double v) { return Vec3(0.016 * u, 0.016 * v, 0); });
    const ink::Substrate substrate = ink::load_substrate("porcelain");
    const std::vector<ink::Pigment> pigments{ink::load_ink("cobalt").parts[0].pigment,
                                             ink::load_ink("cinnabar").parts[0].pigment};
    ink::AtlasMap<float> amounts{16, 2, {}};
    ink::Plane first{}, second{};
    for (std::size_t t = 0; t < 256; ++t) {
        first[t] = 0.3f * static_cast<float>(t % 16) / 15;
        second[t] = 0.2f * static_cast<float>(t / 16) / 15 + 0.01f;
        amounts.texels.push_back(first[t]);
        amounts.texels.push_back(second[t]);
    }
    const auto colours_of = [&](const ink::Plane& a, const ink::Plane& b) {
        const ink::TileFilm film{.pigments = {&a, &b}};
        const ink::TileAppearance shown = ink::shade_films({&film, 1}, nullptr, pigments, substrate);
        std::vector<std::uint8_t> rgb;
        for (std::size_t t = 0; t < 256; ++t)
            for (std::size_t c = 0; c < 3; ++c) rgb.push_back(ink::code_of_linear(shown.colour[c][t]));
        return rgb;
    };
    const ink::AtlasMap<std::uint8_t> colour{16, 3, colours_of(first, second)};
    std::vector<Vec2f> uvs;
    for (std::size_t t = 0; t < model.n_triangles(); ++t)
        for (int k = 0; k < 3; ++k) uvs.push_back(Vec2f(model.position(t, k) / 0.016));
    const PrintSource source{.corner_uvs = uvs,
                             .coverage = [](std::uint32_t, const Weights&) { return 1.0; },
                             .colour = &colour,
                             .amounts = &amounts,
                             .full = {0.3f, 0.21f},
                             .texel = 1e-3};
    const Sheet made = make_sheet(model, source, {.upright = true, .pixel = 1e-3});
    const PrintImage& print = made.pages[0].prints[0];
    ASSERT_EQ(print.plates.size(), 2u);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < print.alpha.size(); ++i) {
        if (print.alpha[i] != 255) continue;
        ink::Plane a{}, b{};
        a[0] = 0.3f * static_cast<float>(print.plates[0][i]) / 255;
        b[0] = 0.21f * static_cast<float>(print.plates[1][i]) / 255;
        const std::vector<std::uint8_t> sum = colours_of(a, b);
        // Pixels lie between texels: colours there are means of codes, amounts are means of amounts.
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], print.rgb[3 * i + c], 4) << i;
        ++compared;
    }
    EXPECT_GT(compared, 150u);
}

// A bilinear read at the edge of paint mixes in no substrate.
TEST(Colours, SpreadFromPaintToTheTexelsRoundIt) {
    ink::AtlasMap<std::uint8_t> colour{5, 3, std::vector<std::uint8_t>(75, 200)};
    ink::AtlasMap<float> coverage{5, 1, std::vector<float>(25, 0)};
    coverage.texels[12] = 1;
    for (std::size_t c = 0; c < 3; ++c) colour.texels[3 * 12 + c] = 10;
    spread_colours(colour, coverage, 1);
    for (std::size_t i = 0; i < 25; ++i) {
        const bool near = i % 5 >= 1 && i % 5 <= 3 && i / 5 >= 1 && i / 5 <= 3;
        EXPECT_EQ(colour.texels[3 * i], near ? 10 : 200) << i;
    }
}

// Inks are named by colours, brushes by a factor; a character without lines of its own is a box.
TEST(StrokeFont, DrawsWhatNamesOfInksAndBrushesAreMadeOf) {
    const auto box = text_lines("$", {}, 1);
    for (const char c : std::string("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ-.,:/%+=()_#*"))
        EXPECT_NE(text_lines(std::string(1, c), {}, 1), box) << c;
}

}  // namespace
}  // namespace tuft::decal
