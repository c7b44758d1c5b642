#include "stroke/layers/palette.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "entry_text.h"
#include "sheet.h"
#include "stroke/document/pick.h"

namespace tuft::stroke {
namespace {

const std::string kBrush = "wolf-medium";

// A pool of ink on the palette, 16 mm wide and half a millimetre deep in its middle.
Fill pool(const std::string& ink, const Vec3& at) {
    return {.ink = ink,
            .layer = kPaletteLayer,
            .film = 50,
            .gradient = Gradient::round,
            .to_film = 0,
            .from = at,
            .to = at + Vec3{0.008, 0, 0}};
}

// A stroke through a place, on the palette or the model, with what is in the brush.
PaintStroke through(const Vec3& at, std::uint32_t layer, const std::string& ink, const Vec3& direction = {1, 0, 0}) {
    PaintStroke s = line(kBrush, 8e-3, make_frame(at, {0, 0, 1}, direction));
    s.ink = ink;
    s.layer = layer;
    s.settings.dip = DipMode::persistent;
    s.settings.film = FilmModel::wet;
    s.settings.spacing = 3;  // coarse is enough here, and quick
    return s;
}

BrushAction rinse(const std::string& ink) {
    return {.what = Rinse{}, .brush = kBrush, .ink = ink};
}

std::vector<JournalEntry> mixing() {
    return {pool("cinnabar", {-0.012, 0, 0}),
            pool("gamboge", {0.012, 0, 0}),
            rinse("cinnabar"),
            through({-0.012, 0, 0}, kPaletteLayer, "cinnabar"),
            through({0.012, 0, 0}, kPaletteLayer, "cinnabar"),
            through({0, 0, 0}, kFirstLayer, "cinnabar")};
}

// Of pigment `plane`: on palette and model, and in the brush, film·m².
double all_of(Document& painting, int plane) {
    double sum = painting.layers().canvas().total(painting.model().texels, plane);
    if (painting.palette().canvas())
        sum += painting.palette().canvas()->total(painting.palette().model().texels, plane);
    if (const BrushInHand* brush = painting.brushes().find(kBrush)) sum += brush->reservoir.pigment(plane);
    return sum;
}

TEST(Palette, ItsTexelsAreAtTheirPositions) {
    const Model plate = make_palette();
    ASSERT_EQ(plate.atlas.size, kPaletteTexels);
    EXPECT_NEAR(plate.atlas.texel_size, kPaletteTexel, 1e-9);
    std::size_t covered = 0;
    for (std::uint32_t slot = 0; slot < plate.texels.n_slots(); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            if (plate.texels.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            const std::uint32_t tile = plate.texels.tile_of_slot[slot];
            const double i = tile % plate.texels.tiles_per_side * 16.0 + t % 16,
                         j = tile / plate.texels.tiles_per_side * 16.0 + t / 16;
            const Vec3 wanted{(i + 0.5) * kPaletteTexel - 0.064, (j + 0.5) * kPaletteTexel - 0.049, 0};
            // Positions are floats of some centimetres.
            EXPECT_LT(glm::distance(Vec3(plate.texels.position(slot, t)), wanted), 1e-8);
            EXPECT_NEAR(static_cast<double>(plate.texels.tiles[slot].area[t]), kPaletteTexel * kPaletteTexel, 1e-12);
            ++covered;
        }
    EXPECT_EQ(covered, 480u * 360u);
}

TEST(Palette, NoMaskOfTheModelHoldsOnIt) {
    const Model model = sheet();
    const MaskEdit mask{
        .mask = {.id = 1, .name = "under", .kind = MaskKind::angle, .direction = {0, 0, -1}, .within = 0.5}};
    const auto painted = [&](std::uint32_t with) {
        Document painting(model);
        painting.paint(mask);
        std::vector<JournalEntry> strokes = mixing();
        strokes.resize(4);
        for (JournalEntry& s : strokes) {
            if (PaintStroke* stroke = s.as<PaintStroke>(); stroke && on_palette(s)) stroke->mask = with;
            if (Fill* fill = s.as<Fill>(); fill && on_palette(s)) fill->mask = with;
            painting.paint(s);
        }
        return std::pair{painting.palette().canvas()->hash(), painting.layers().hash()};
    };
    // A project from elsewhere may say so, and its model may have fewer texels than the palette.
    EXPECT_EQ(painted(1), painted(0));
}

TEST(Palette, ABrushMixesOnItAndPaintsTheMixture) {
    const Model model = sheet();
    Document painting(model);
    const std::vector<JournalEntry> strokes = mixing();
    for (std::size_t i = 0; i < 3; ++i) painting.paint(strokes[i]);
    const int red = 0, yellow = 1;
    ASSERT_EQ(painting.layers().canvas().pigments().size(), 2u);
    // A cone of 50 units: π r² h / 3, times the pigment's part of the ink.
    const double cone = 3.14159265 * 0.008 * 0.008 * 50 / 3 * painting.materials().ink("cinnabar").parts[0].fraction;
    EXPECT_NEAR(painting.palette().canvas()->total(painting.palette().model().texels, red) / cone, 1,
                1e-3);  // texels of 1/64 of its width
    const double before[] = {all_of(painting, red), all_of(painting, yellow)};
    EXPECT_EQ(painting.brushes().find(kBrush)->reservoir.remaining(), 0);

    painting.paint(strokes[3]);
    EXPECT_GT(painting.brushes().find(kBrush)->reservoir.fullness(), 0.02);
    EXPECT_EQ(painting.brushes().find(kBrush)->reservoir.pigment(yellow), 0);
    painting.paint(strokes[4]);
    const ink::Reservoir& loaded = painting.brushes().find(kBrush)->reservoir;
    EXPECT_GT(loaded.pigment(red), 0);
    EXPECT_GT(loaded.pigment(yellow), 0);
    EXPECT_EQ(painting.layers().canvas().total(model.texels, red), 0) << "the model is clean so far";

    painting.paint(strokes[5]);
    for (const int p : {red, yellow}) EXPECT_GT(painting.layers().canvas().total(model.texels, p), 0);

    // Stirred to and fro over both pools, what lies between them is of both.
    for (int i = 0; i < 3; ++i)
        painting.paint(through({0, 0, 0}, kPaletteLayer, "cinnabar", {i == 1 ? -1.0 : 1.0, 0, 0}));
    const Pick between = pick_on_palette(painting, {0, 0, 0});
    EXPECT_GT(between.amounts[red], 0.05 * between.amounts[yellow]);
    EXPECT_GT(between.amounts[yellow], 0.05 * between.amounts[red]);
    // Amounts are floats on texels, some 1e5 of them: what goes astray is rounding.
    for (const int p : {red, yellow}) EXPECT_NEAR(all_of(painting, p) / before[p], 1, 1e-5);
}

// 0: every texel is of one of two pigments; 1: all have them in the same parts.
double mixedness(Document& painting) {
    const atlas::TexelMap& map = painting.palette().model().texels;
    const double whole[] = {painting.palette().canvas()->total(map, 0), painting.palette().canvas()->total(map, 1)};
    double sum = 0, parts = 0, square = 0;
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            double of[2] = {};
            for (int k = 0; k < 2; ++k)
                if (const ink::Plane* plane = painting.palette().canvas()->plane(slot, k))
                    of[k] = static_cast<double>((*plane)[t] * map.tiles[slot].area[t]) / whole[k];
            const double both = of[0] + of[1];
            if (!(both > 0)) continue;
            sum += both;
            parts += of[0];
            square += of[0] * of[0] / both;
        }
    const double mean = parts / sum;
    return 1 - (square / sum - mean * mean) / (mean * (1 - mean));
}

TEST(Palette, FiveCirclesThroughTwoPoolsMixThem) {
    const Model model = sheet();
    Document painting(model);
    painting.paint(pool("gamboge", {-0.007, 0, 0}));
    painting.paint(pool("indigo", {0.007, 0, 0}));
    painting.paint(rinse("gamboge"));
    EXPECT_LT(mixedness(painting), 0.02);
    PaintStroke circles = through({0, 0, 0}, kPaletteLayer, "gamboge");
    const StrokeSample upright = circles.trace.samples.front();
    circles.trace.samples.clear();
    const double length = brush::load_preset(kBrush).length, turn = 0.8, seconds = 5 * turn;
    for (int i = 0; i <= 800; ++i) {
        const double t = seconds * i / 800, angle = 2 * 3.14159265 * t / turn,
                     press = std::min({1.0, t / 0.15, (seconds - t) / 0.15});
        StrokeSample s = upright;
        s.time = t;
        s.position = {0.014 * std::cos(angle), 0.014 * std::sin(angle), length + 1e-3 - 0.013 * press};
        circles.trace.samples.push_back(s);
    }
    painting.paint(circles);
    // The tip goes round in a ring of half the pools' area: what lies there is green, a third of all.
    EXPECT_GT(mixedness(painting), 0.2);
}

TEST(Palette, ReplaysAndIsTakenBackToTheBit) {
    const Model model = sheet();
    Document painting(model);
    std::vector<std::uint64_t> palette, texels;
    const auto note = [&] {
        palette.push_back(painting.palette().canvas() ? painting.palette().canvas()->hash() : 0);
        texels.push_back(painting.layers().hash());
    };
    for (const JournalEntry& s : mixing()) {
        painting.paint(s);
        note();
    }
    painting.paint(WashPalette{});
    EXPECT_TRUE(painting.palette().canvas()->touched_slots().empty());
    EXPECT_EQ(painting.layers().hash(), texels.back());

    // Hashes tell the pigments met so far: from the second pool on there are two.
    for (std::size_t i = palette.size(); i-- > 1;) {
        ASSERT_TRUE(painting.undo());
        EXPECT_EQ(painting.palette().canvas()->hash(), palette[i]) << i;
        EXPECT_EQ(painting.layers().hash(), texels[i]) << i;
    }
    for (std::size_t i = 2; i < palette.size(); ++i) ASSERT_TRUE(painting.redo());
    EXPECT_EQ(painting.palette().canvas()->hash(), palette.back());
    EXPECT_EQ(painting.layers().hash(), texels.back());

    Document again(model);
    again.replay(painting.journal().entries());
    EXPECT_EQ(again.palette().canvas()->hash(), palette.back());
    EXPECT_EQ(again.layers().hash(), texels.back());
    EXPECT_NE(texels.back(), texels.front());
}

TEST(Palette, PicturesShowThePoolsInTheirPlaces) {
    const Model model = sheet();
    Document painting(model);
    PalettePicture bare, inked;
    painting.paint(rinse("cinnabar"));
    painting.palette().model();
    refresh(bare, painting.palette());
    painting.paint(pool("cinnabar", {0.03, 0.02, 0}));
    inked = bare;
    refresh(inked, painting.palette(), painting.appearance().take_palette_dirty());
    // 0.03 m to the right of the middle and 0.02 above it, in pixels of 0.25 mm.
    const auto at = [](const PalettePicture& p, int x, int y) {
        return &p.rgb[3 * static_cast<std::size_t>(y * p.width + x)];
    };
    const std::uint8_t *there = at(inked, 240 + 120, 180 - 80), *mirrored = at(inked, 240 + 120, 180 + 80);
    EXPECT_GT(there[0], there[2] + 60) << "red";
    EXPECT_EQ(std::vector(mirrored, mirrored + 3), std::vector(at(bare, 360, 260), at(bare, 360, 260) + 3));
    PalettePicture whole;
    refresh(whole, painting.palette());
    EXPECT_EQ(whole.rgb, inked.rgb);
}

TEST(Palette, IsNoLayerThatCouldBeMade) {
    LayerTable table;
    table.next_id = kPaletteLayer;
    EXPECT_THROW(apply(table, add_on_top(table, "mine")), Error);
    EXPECT_THROW(entry_of({}, R"({"layer": 4294967294})"), Error);
    EXPECT_THROW(entry_of({}, R"({"on": "table"})"), Error);
    const JournalEntry entry = entry_of({}, R"({"on": "palette"})");
    EXPECT_EQ(layer_of(entry), kPaletteLayer);
    EXPECT_EQ(layer_of(written_and_read(entry)), kPaletteLayer);
}

}  // namespace
}  // namespace tuft::stroke
