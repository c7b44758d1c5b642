#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/system/parallel.h"
#include "entry_text.h"
#include "ink/composite/match.h"
#include "sheet.h"
#include "stroke/document/pick.h"
#include "stroke/drawing/copies.h"
#include "stroke/painting/apply_area.h"

/// Masked areas of drawings: coverage, gradients, what they cover, copies.
namespace tuft::stroke {
namespace {

const Model& model() {
    static const Model m = sheet();
    return m;
}

using Ring = std::vector<Vec2>;

Ring box(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

FlatArea area(std::vector<Ring> rings, const std::string& ink = "carbon") {
    FlatArea a{.rings = std::move(rings), .placement = {}, .low = Vec2(-0.02), .high = Vec2(0.02), .stops = {}};
    a.placement.mapping = SurfaceMapping::drape;
    a.stops = {{.ink = ink, .film = 1}};
    return a;
}

double total(const Document& p) {
    double sum = 0;
    for (int k = 0; k < static_cast<int>(p.layers().canvas().pigments().size()); ++k)
        sum += p.layers().canvas().total(model().texels, k);
    return sum;
}

double at(const Document& p, double x, double y, int pigment = 0) {
    return pick(p, {x, y, 0}).amounts[static_cast<std::size_t>(pigment)];
}

TEST(Area, HasTheFilmOfItsStopAndTheAreaOfItsRings) {
    for (const SurfaceMapping mapping : {SurfaceMapping::drape, SurfaceMapping::wrap, SurfaceMapping::project}) {
        Document p(model());
        FlatArea a = area({box(-0.0103, -0.0052, 0.0097, 0.0048)});
        a.placement.mapping = mapping;
        p.paint(fill_of_area(a));
        const double film = p.materials().ink("carbon").strength();
        // Scan lines are exact for a box; coverage is stored in 1/255.
        EXPECT_NEAR(total(p) / (film * 0.02 * 0.01), 1, 2e-3);
        EXPECT_NEAR(at(p, 0, 0), film, 1e-6);
        EXPECT_NEAR(at(p, 0.0094, -0.0045), film, 1e-6) << "y of the drawing points down";
        EXPECT_EQ(at(p, 0.0099, 0), 0);
        EXPECT_EQ(at(p, 0, 0.0056), 0);
    }
}

TEST(Area, ADiscHasItsAreaWhereverItsEdgesLie) {
    Document p(model());
    Ring disc;
    for (int i = 0; i < 720; ++i) {
        const double a = 2 * std::numbers::pi * i / 720;
        disc.emplace_back(0.0013 + 0.009 * std::cos(a), -0.0007 + 0.009 * std::sin(a));
    }
    p.paint(fill_of_area(area({disc})));
    EXPECT_NEAR(total(p) / (p.materials().ink("carbon").strength() * std::numbers::pi * 0.009 * 0.009), 1, 3e-3);
}

TEST(Area, ALineThinnerThanATexelLeavesItsAreaOfInk) {
    Document p(model());
    const double texel = model().texels.texel_size;
    p.paint(fill_of_area(area({box(-0.01, 0.0011, 0.01, 0.0011 + 0.4 * texel)})));
    // Half a scan line at each edge, of 16 a cell, which is half a texel; coverage below 1/512 is dropped.
    EXPECT_NEAR(total(p) / (p.materials().ink("carbon").strength() * 0.02 * 0.4 * texel), 1, 0.06);
}

TEST(Area, DetailKeepsItsShapeDownToThreeTexels) {
    // A ring whose line and hole are three texels wide, at several places between texels.
    const double texel = model().texels.texel_size;
    for (const Vec2 off : {Vec2(0, 0), Vec2(0.5, 0.25), Vec2(0.25, 0.5), Vec2(0.8, 0.7)}) {
        std::vector<Ring> rings(2);
        for (int i = 0; i < 360; ++i) {
            const double a = 2 * std::numbers::pi * i / 360;
            rings[0].push_back(texel * (off + 4.5 * Vec2(std::cos(a), std::sin(a))));
            rings[1].push_back(texel * (off + 1.5 * Vec2(std::cos(a), -std::sin(a))));
        }
        Document p(model());
        p.paint(fill_of_area(area(rings)));
        const double film = p.materials().ink("carbon").strength();
        EXPECT_NEAR(total(p) / (film * std::numbers::pi * (4.5 * 4.5 - 1.5 * 1.5) * texel * texel), 1, 0.01);
        EXPECT_LT(at(p, texel * off.x, -texel * off.y), 0.05 * film) << "the hole is open";
        for (int k = 0; k < 16; ++k) {
            const double a = std::numbers::pi * k / 8;
            // The middle of the line, from the nearest texel's centre: 0.7 texels off at most.
            EXPECT_GT(at(p, texel * (off.x + 3 * std::cos(a)), -texel * (off.y + 3 * std::sin(a))), 0.8 * film);
            EXPECT_LT(at(p, texel * (off.x + 6.2 * std::cos(a)), -texel * (off.y + 6.2 * std::sin(a))), 0.01 * film);
        }
    }
}

TEST(Area, TwoThatShareAnEdgeShowNoSubstrateBetweenThem) {
    // A ground, and two halves of it that meet along an edge: a slanting one, and upright ones at several places
    // between cells and texels.
    const double texel = model().texels.texel_size;
    double slope = 0.0034, offset = 0;
    std::vector<Vec2> edge;
    const auto halves = [&](bool trapped) {
        edge = {{0.0004 + offset + 0.5 * slope, -0.011}, {0.0004 + offset - 0.5 * slope, 0.011}};
        FlatArea left = area({{{-0.01, -0.011}, edge[0], edge[1], {-0.01, 0.011}}}, "carbon");
        FlatArea right = area({{edge[0], {0.01, -0.011}, {0.01, 0.011}, edge[1]}}, "cinnabar");
        if (trapped) left.under = {{edge[0], edge[0] + Vec2(0.003, 0), edge[1] + Vec2(0.003, 0), edge[1]}};
        Document p(model());
        p.paint(fill_of_area(area({box(-0.015, -0.015, 0.015, 0.015)}, "indigo")));
        p.paint(fill_of_area(left));
        p.paint(fill_of_area(right));
        double ground = 0, least = 1, beyond = 0;
        const double black = p.materials().ink("carbon").strength(), red = p.materials().ink("cinnabar").strength();
        for (double y = -0.009; y < 0.009; y += 1.37 * texel)
            for (double x = -5; x <= 5; x += 0.5) {
                const double across = 0.0004 + offset + y * slope / 0.022 + x * texel;
                const auto amounts = pick(p, {across, y, 0}).amounts;
                ground = std::max(ground, amounts[0] / p.materials().ink("indigo").strength());
                least = std::min(least, amounts[1] / black + amounts[2] / red);
                if (x >= 3) beyond = std::max(beyond, amounts[1] / black);
            }
        return std::array{ground, least, beyond};
    };
    EXPECT_GT(halves(false)[0], 0.2) << "by coverage alone a quarter of the ground shows: a (1 - a)";
    for (const auto& [sloping, part] : {std::pair{0.0034, 0.0}, {0.0, 0.0}, {0.0, 0.2}, {0.0, 0.45}, {0.0, 0.8}}) {
        slope = sloping, offset = part * texel;
        const auto [ground, least, beyond] = halves(true);
        // Coverage is stored in 1/255, of both areas.
        EXPECT_LT(ground, 0.01) << slope << ", " << offset;
        EXPECT_GT(least, 0.99) << slope << ", " << offset;
        EXPECT_EQ(beyond, 0) << "the later area covers what lies under it";
    }
}

TEST(Area, TheRuleSaysWhatCrossingRingsEnclose) {
    const std::vector<Ring> rings{box(-0.01, -0.01, 0.01, 0.01), box(-0.005, -0.005, 0.005, 0.005)};
    FlatArea a = area(rings);
    Document nonzero(model()), even_odd(model()), opposite(model());
    nonzero.paint(fill_of_area(a));
    a.even_odd = true;
    even_odd.paint(fill_of_area(a));
    a.even_odd = false;
    std::reverse(a.rings[1].begin(), a.rings[1].end());
    opposite.paint(fill_of_area(a));
    EXPECT_NEAR(total(even_odd) / total(nonzero), 0.75, 2e-3);
    EXPECT_NEAR(total(opposite) / total(even_odd), 1, 1e-6);
    EXPECT_GT(at(nonzero, 0, 0), 0);
    EXPECT_EQ(at(even_odd, 0, 0), 0);
}

TEST(Area, ALinearGradientIsLinearInAmountsAndMonotone) {
    FlatArea a = area({box(-0.015, -0.005, 0.015, 0.005)});
    a.stops = {{.at = 0, .ink = "cinnabar", .film = 2}, {.at = 1, .ink = "indigo", .film = 1}};
    a.gradient = AreaGradient::linear;
    a.to_unit = {1 / 0.02, 0, 0, 1 / 0.02, 0.5, 0};  // 0 at x = -10 mm, 1 at 10 mm
    Document p(model());
    p.paint(fill_of_area(a));
    const double red = 2 * p.materials().ink("cinnabar").strength(), blue = p.materials().ink("indigo").strength();
    const double texel = model().texels.texel_size;
    double before = 1e9;
    for (const double x : {-0.014, -0.01, -0.005, 0.0, 0.0043, 0.01, 0.014}) {
        const double t = std::clamp((x + 0.01) / 0.02, 0.0, 1.0), slope = texel / 0.02;
        EXPECT_NEAR(at(p, x, 0, 0), red * (1 - t), red * slope) << x;  // of the nearest texel's centre
        EXPECT_NEAR(at(p, x, 0, 1), blue * t, blue * slope) << x;
        EXPECT_LE(at(p, x, 0, 0), before);
        before = at(p, x, 0, 0);
    }
}

TEST(Area, SpreadRepeatsOrReflectsAGradient) {
    FlatArea a = area({box(0, 0, 1, 1)});
    a.gradient = AreaGradient::linear;
    EXPECT_EQ(along_area(a, {1.25, 0}), 1);
    a.spread = AreaSpread::repeat;
    EXPECT_NEAR(along_area(a, {1.25, 0}), 0.25, 1e-12);
    EXPECT_NEAR(along_area(a, {-0.25, 0}), 0.75, 1e-12);
    a.spread = AreaSpread::reflect;
    EXPECT_NEAR(along_area(a, {1.25, 0}), 0.75, 1e-12);
    EXPECT_NEAR(along_area(a, {-0.25, 0}), 0.25, 1e-12);
    a.spread = AreaSpread::pad;
    a.gradient = AreaGradient::radial;
    EXPECT_NEAR(along_area(a, {0.3, 0.4}), 0.5, 1e-12);
    // On the circle t is 1 wherever the focus lies, at the focus 0; half way along a ray it is a half.
    a.focus = {0.4, 0.2};
    for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
        const Vec2 rim(std::cos(angle), std::sin(angle));
        EXPECT_NEAR(along_area(a, rim), 1, 1e-12);
        EXPECT_NEAR(along_area(a, 0.5 * (rim + a.focus)), 0.5, 1e-12);
    }
    EXPECT_NEAR(along_area(a, a.focus), 0, 1e-12);
}

TEST(Area, CoversWhatLiesThereAndTranslucentOnesInPart) {
    Document p(model());
    p.paint(fill_of_area(area({box(-0.01, -0.01, 0.01, 0.01)}, "cinnabar")));
    FlatArea over = area({box(-0.005, -0.005, 0.005, 0.005)}, "indigo");
    over.stops[0].opacity = 1;
    p.paint(fill_of_area(over));
    const double red = p.materials().ink("cinnabar").strength();
    EXPECT_EQ(at(p, 0, 0, 0), 0);
    EXPECT_NEAR(at(p, 0, 0, 1), p.materials().ink("indigo").strength(), 1e-6);
    EXPECT_NEAR(at(p, 0.008, 0, 0), red, 1e-6);
    FlatArea veil = area({box(-0.01, 0.006, 0.01, 0.01)}, "indigo");
    veil.stops[0].opacity = 0.25;
    p.paint(fill_of_area(veil));
    EXPECT_NEAR(at(p, 0, -0.008, 0), 0.75 * red, 1e-6);
    const std::uint64_t hash = p.layers().hash();
    ASSERT_TRUE(p.undo());
    EXPECT_NEAR(at(p, 0, -0.008, 0), red, 1e-6);
    ASSERT_TRUE(p.redo());
    EXPECT_EQ(p.layers().hash(), hash);
}

TEST(Area, ShowsTheColourThatNamesItsInk) {
    // Colours that the pigments reach: the map shows what the mix shows, and that is the colour within dE2000 1.
    for (const std::string hex : {"#1b1b1b", "#bd3b25", "#26405f", "#d8b040"}) {
        Document p(model());
        FlatArea a = area({box(-0.01, -0.01, 0.01, 0.01)}, hex);
        a.stops[0].film = -1;
        p.paint(fill_of_area(a));
        const Pick there = pick(p, {0.002, 0.003, 0});
        const auto got = picked_ink(there, p.layers().pigments(), "picked");
        ASSERT_TRUE(got);
        const auto lab = [](const ink::Rgb& c) { return ink::lab_of_rgb({double(c[0]), double(c[1]), double(c[2])}); };
        EXPECT_LT(ink::delta_e_2000(lab(ink::colour_on(*got, p.materials().substrate(), got->film)),
                                    lab(*ink::colour_of_hex(hex))),
                  1.5)
            << hex;
    }
}

TEST(Area, IsTheSameForAnyNumberOfThreadsAndFromItsText) {
    FlatArea a = area({box(-0.0103, -0.0052, 0.0097, 0.0048)});
    a.stops = {{.at = 0.1, .ink = "cinnabar", .opacity = 0.5, .film = 2}, {.at = 1, .ink = "indigo", .film = 1}};
    a.gradient = AreaGradient::radial;
    a.spread = AreaSpread::reflect;
    a.to_unit = {70, 3, -5, 90, 0.1, 0.2};
    a.focus = {0.2, -0.1};
    a.placed = true;
    a.reading.part = "number";
    a.reading.centre = {0.001, 0.002};
    a.lines = {{{-0.01, 0}, {0.003, 0.0001}, {0.0097, 0}}, {{0, 0.001}}};
    a.under = {box(0.0097, -0.0052, 0.0117, 0.0048)};
    JournalEntry entry{fill_of_area(a)};
    std::uint64_t hashes[3];
    for (int i = 0; i < 3; ++i) {
        set_thread_count(i == 0 ? 1 : 4);
        Document p(model());
        p.paint(i == 2 ? written_and_read(entry) : entry);
        hashes[i] = p.layers().hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
    EXPECT_EQ(written_and_read(entry).get<Fill>(), entry.get<Fill>());
    EXPECT_EQ(area_of_text(text_of(a)), a);
    EXPECT_EQ(inks_of(entry), (std::vector<std::string>{"cinnabar", "indigo"}));
}

TEST(Area, WhatNoDrawingCanHaveIsRefused) {
    const FlatArea good = area({box(0, 0, 0.01, 0.01)});
    const auto refused = [&](auto change) {
        FlatArea a = good;
        change(a);
        EXPECT_THROW(check_area(a), Error);
    };
    EXPECT_NO_THROW(check_area(good));
    refused([](FlatArea& a) { a.stops.clear(); });
    refused([](FlatArea& a) { a.stops[0].ink.clear(); });
    refused([](FlatArea& a) { a.stops[0].opacity = NAN; });
    refused([](FlatArea& a) { a.stops[0].at = 2; });
    refused([](FlatArea& a) { a.rings[0][0].x = NAN; });
    refused([](FlatArea& a) { a.rings[0][0].x = 1e300; });
    refused([](FlatArea& a) { a.focus = {1, 0}; });
    refused([](FlatArea& a) { a.to_unit[3] = INFINITY; });
    refused([](FlatArea& a) { a.placement.right = Vec3(0); });
    Fill fill = fill_of_area(good);
    fill.area.reset();
    EXPECT_THROW(check_fill(fill), Error);
    for (const std::string text : {"", "{", "{}", "[]", "{\"rings\":[[1]]}", "{\"rings\":[[[1,2]]]}"})
        EXPECT_THROW(area_of_text(text), Error) << text;
}

TEST(Copies, MeetTheMirrorImageOfEveryPoint) {
    // An L: no mirror image of itself.
    const Ring letter{{0.004, -0.01}, {0.007, -0.01}, {0.007, 0.007}, {0.014, 0.007}, {0.014, 0.01}, {0.004, 0.01}};
    FlatArea a = area({letter});
    a.under = a.rings;
    a.placed = true;
    a.placement.origin = {0.002, 0, 0};
    const std::vector<JournalEntry> one{JournalEntry(fill_of_area(a))};
    const Symmetry across{.mirror_x = true};
    Document p(model());
    p.paint(one[0]);
    const double alone = total(p);
    const std::vector<JournalEntry> copies = symmetric_copies(one, across, CopyReading::mirrored, {7, "flank"});
    ASSERT_EQ(copies.size(), 1u);
    EXPECT_EQ(copies[0].group, (EntryGroup{7, "flank"}));
    p.paint(copies[0]);
    EXPECT_NEAR(total(p) / alone, 2, 1e-4);  // texels are not symmetric to the last bit
    for (const Vec2 q : {Vec2(0.0075, 0.005), Vec2(0.008, -0.005), Vec2(0.014, -0.0085), Vec2(0.011, 0.005)})
        EXPECT_NEAR(at(p, q.x, q.y), at(p, -q.x, q.y), 1e-6);
    const FlatArea& copy = *copies[0].get<Fill>().area;
    EXPECT_EQ(copy.under, copy.rings) << "what it reaches under goes with it";
    EXPECT_GT(glm::dot(glm::cross(copy.placement.down, copy.placement.right), Vec3(0, 0, 1)), 0) << "right-handed";
    // Twice is the original.
    const JournalEntry back = symmetric_copies(copies, across, CopyReading::mirrored, {})[0];
    EXPECT_EQ(back.get<Fill>().area->rings, a.rings);
}

TEST(Copies, KeepMarkedPartsReadableWhereTheMirrorPutsThem) {
    const Ring letter{{0.004, -0.01}, {0.007, -0.01}, {0.007, 0.007}, {0.014, 0.007}, {0.014, 0.01}, {0.004, 0.01}};
    FlatArea a = area({letter});
    a.under = a.rings;
    a.placed = true;
    a.reading.part = "number";
    a.reading.centre = {0.009, 0};
    const JournalEntry copy = symmetric_copies(std::vector<JournalEntry>{JournalEntry(fill_of_area(a))},
                                               {.mirror_x = true}, CopyReading::upright_parts, {})[0];
    const FlatArea& b = *copy.get<Fill>().area;
    EXPECT_EQ(b.under, b.rings);
    for (std::size_t i = 0; i < letter.size(); ++i) {
        EXPECT_NEAR(b.rings[0][i].x, letter[i].x - 2 * 0.009, 1e-12);
        EXPECT_NEAR(b.rings[0][i].y, letter[i].y, 1e-12);
    }
}

TEST(Copies, GoRoundAnAxis) {
    FlatArea a = area({box(0.008, -0.002, 0.012, 0.002)});
    a.placed = true;
    const std::vector<JournalEntry> one{JournalEntry(fill_of_area(a))};
    Document p(model());
    p.paint(one[0]);
    const double alone = total(p);
    const std::vector<JournalEntry> copies = symmetric_copies(one, {.radial = 5}, CopyReading::mirrored, {1, "round"});
    ASSERT_EQ(copies.size(), 4u);
    for (const JournalEntry& copy : copies) p.paint(copy);
    EXPECT_NEAR(total(p) / alone, 5, 0.02);  // edges at other angles: coverage in 1/255
    EXPECT_EQ(copies[3].group.id, 4u);
    for (int i = 0; i < 5; ++i) {
        const double angle = 2 * std::numbers::pi * i / 5;
        EXPECT_GT(at(p, 0.01 * std::cos(angle), 0.01 * std::sin(angle)), 0);
    }
}

}  // namespace
}  // namespace tuft::stroke
