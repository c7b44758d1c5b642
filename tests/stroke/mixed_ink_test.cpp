#include <gtest/gtest.h>

#include <cmath>

#include "core/system/parallel.h"
#include "entry_text.h"
#include "sheet.h"
#include "stroke/journal/recorded_stroke.h"

namespace tuft::stroke {
namespace {

const std::string kBrush = "wolf-medium";

BrushAction brush_action(const BrushChange& what, const std::string& ink) {
    return {.what = what, .brush = kBrush, .ink = ink, .dip = DipMode::persistent};
}

/// A brush with cinnabar in its right flank and gamboge in the left.
void load_sides(Document& painting) {
    painting.paint(brush_action(Dip{}, "gamboge"));
    painting.paint(brush_action(Wipe{.amount = 1, .side = 0.5}, "gamboge"));
    painting.paint(brush_action(Dip{.side = 0.5}, "cinnabar"));
}

/// Drawn over the sheet with the holder at right angles to it; `turn` about the holder: where the
/// right flank, the ferrule's +x, points to.
PaintStroke drawn(FilmModel film, double y = 0, bool along_y = true) {
    const Vec3 along = along_y ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    PaintStroke s = line(kBrush, 6e-3, make_frame({y, 0, 0}, {0, 0, 1}, along));
    for (StrokeSample& p : s.trace.samples) p.rotation = Quat{1, 0, 0, 0};
    s.ink = "cinnabar";
    s.settings.dip = DipMode::persistent;
    s.settings.film = film;
    s.settings.spacing = 3;
    return s;
}

/// Where a pigment lies, metres along x, in the middle part of the stroke.
struct Spread {
    double amount = 0, mean = 0;
};
Spread spread(const Document& painting, const Model& model, int plane) {
    Spread out;
    for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            const Vec3f p = model.texels.position(slot, t);
            const ink::Plane* w = painting.layers().canvas().plane(slot, plane);
            if (!w || std::abs(p.y) > 5e-3f) continue;
            const double v = static_cast<double>((*w)[t]) * static_cast<double>(model.texels.tiles[slot].area[t]);
            out.amount += v;
            out.mean += v * static_cast<double>(p.x);
        }
    out.mean /= out.amount;
    return out;
}

TEST(MixedInk, TwoInksSideBySideLieSideBySideInTheStroke) {
    const Model model = sheet();
    for (const FilmModel film : {FilmModel::still, FilmModel::wet}) {
        Document painting(model);
        load_sides(painting);
        painting.paint(drawn(film));
        const Spread yellow = spread(painting, model, 0), red = spread(painting, model, 1);
        EXPECT_GT(yellow.amount, 1e-6) << name_of(film);
        EXPECT_GT(red.amount, 1e-6) << name_of(film);
        // The stroke is about 5 mm wide: halves of it lie 2.5 mm apart when nothing mixes.
        EXPECT_GT(std::abs(red.mean - yellow.mean), 1e-3) << name_of(film);
    }
}

TEST(MixedInk, EachPigmentIsConservedStillAndWet) {
    const Model model = sheet();
    for (const FilmModel film : {FilmModel::still, FilmModel::wet}) {
        Document painting(model);
        load_sides(painting);
        std::array<double, 2> whole;
        for (int p = 0; p < 2; ++p) whole[p] = painting.brushes().find(kBrush)->reservoir.pigment(p);
        for (int i = 0; i < 3; ++i) painting.paint(drawn(film, 4e-3 * i - 4e-3, i != 1));
        for (int p = 0; p < 2; ++p) {
            const double now = painting.layers().canvas().total(model.texels, p) +
                               painting.brushes().find(kBrush)->reservoir.pigment(p);
            EXPECT_NEAR(now / whole[p], 1, 1e-6) << name_of(film) << ' ' << p;
        }
        for (const auto& cell : painting.brushes().find(kBrush)->reservoir.content)
            for (const double v : cell) EXPECT_GE(v, -1e-9 * (whole[0] + whole[1])) << "the rounding of the texels";
    }
}

/// A flat with an ink in each half of its width, drawn over the sheet: what its hair loses of each, the texels have.
/// Sums of the differences of what is stored, so that even the rounding of texels is in the books.
TEST(MixedInk, ADoubleLoadedFlatKeepsTheMassOfEachInk) {
    const std::string flat = "flat-12*0.4";
    const Model model = sheet();
    Document painting(model);
    const auto prepare = [&](const BrushChange& what, const std::string& ink) {
        painting.paint(BrushAction{.what = what, .brush = flat, .ink = ink, .dip = DipMode::persistent});
    };
    prepare(Dip{}, "gamboge");
    prepare(Wipe{.amount = 1, .side = 0.5}, "gamboge");
    prepare(Dip{.side = 0.5}, "cinnabar");
    std::array<double, 2> whole;
    for (int p = 0; p < 2; ++p) whole[p] = painting.brushes().find(flat)->reservoir.pigment(p);
    for (int i = 0; i < 2; ++i) {
        PaintStroke s = line(flat, 3e-3, make_frame({8e-3 * i - 4e-3, 0, 0}, {0, 0, 1}, {0, 1, 0}));
        for (StrokeSample& p : s.trace.samples) p.rotation = Quat{1, 0, 0, 0};
        s.ink = "cinnabar";
        s.settings.dip = DipMode::persistent;
        painting.paint(s);
    }
    for (int p = 0; p < 2; ++p) {
        const double on_sheet = painting.layers().canvas().total(model.texels, p);
        const double now = on_sheet + painting.brushes().find(flat)->reservoir.pigment(p);
        EXPECT_GT(on_sheet, 1e-3 * whole[p]) << p;
        EXPECT_NEAR(now / whole[p], 1, 1e-10) << p;
    }
}

TEST(MixedInk, ReplaysToTheBitOnAnyNumberOfThreads) {
    const Model model = sheet();
    for (const FilmModel film : {FilmModel::still, FilmModel::wet}) {
        std::uint64_t hashes[2];
        std::vector<JournalEntry> journal;
        for (int i = 0; i < 2; ++i) {
            set_thread_count(i ? 3 : 1);
            Document painting(model);
            if (i == 0) {
                load_sides(painting);
                painting.paint(drawn(film));
                journal = painting.journal().entries();
            } else {
                painting.replay(journal);
            }
            hashes[i] = painting.layers().canvas().hash();
        }
        EXPECT_EQ(hashes[0], hashes[1]) << name_of(film);
    }
    set_thread_count(0);
}

TEST(MixedInk, BrushActionsWithASideComeBackFromTheirText) {
    const Preparation c = preparation_of("dip:cinnabar,depth=0.25,side=-0.5");
    EXPECT_EQ(std::get<BrushAction>(c).what, BrushChange(Dip{.depth = 0.25, .side = -0.5}));
    EXPECT_EQ(preparation_text(c), "dip:cinnabar,depth=0.25,side=-0.5");
    EXPECT_ANY_THROW(preparation_of("wipe,side=1.5"));
    EXPECT_ANY_THROW(preparation_of("rinse,side=0.5"));
    const BrushAction entry = brush_action(Wipe{.depth = 0.5, .amount = 0.25, .side = 0.125}, "carbon");
    EXPECT_EQ(written_and_read(entry).get<BrushAction>().what, entry.what);
}

}  // namespace
}  // namespace tuft::stroke
