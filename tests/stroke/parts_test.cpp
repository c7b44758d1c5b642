#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/system/parallel.h"
#include "entry_text.h"
#include "sheet.h"

namespace tuft::stroke {
namespace {

constexpr double kPane = 4e-3;  // metres over the sheet

void add_quads(mesh::PolygonSoup& soup, double x0, double x1, double z, std::uint32_t group) {
    constexpr std::uint32_t n = 10;
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i)
            soup.points.push_back({x0 + (x1 - x0) * i / n, kSide * (static_cast<double>(j) / n - 0.5), z});
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = first + j * (n + 1) + i;
            for (const std::uint32_t corner : {a, a + 1, a + n + 2, a + n + 1}) soup.corners.push_back(corner);
            soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            soup.polygon_groups.push_back(group);
        }
}

// A sheet whose left half is the part "body", its right half "trim". With a pane over all of it.
Model make_model(bool with_pane) {
    mesh::PolygonSoup soup;
    soup.polygon_start.push_back(0);
    soup.group_names = {"body", "trim", "pane"};
    add_quads(soup, -0.5 * kSide, 0, 0, 0);
    add_quads(soup, 0, 0.5 * kSide, 0, 1);
    if (with_pane) add_quads(soup, -0.5 * kSide, 0.5 * kSide, kPane, 2);
    ModelOptions options;
    options.repair.metres_per_unit = 1;
    options.repair.sides = mesh::OpenSides::file;  // under the pane a sheet sees more of the open below it
    options.unwrap.size = with_pane ? 1024 : 724;  // about the same texels
    return prepare_model(std::move(soup), options);
}

const Model& model() {
    static const Model m = make_model(true);
    return m;
}

PaintStroke quick() {
    PaintStroke s = line("wolf-small", 3e-3);
    s.settings.spacing = 3;
    return s;
}

MaskTexels texels_of(const std::string& part) {
    return evaluate({.name = part, .kind = MaskKind::group, .groups = {part}}, {}, model());
}

// Film units of all pigments on a part's texels, times their areas.
double ink_on(const Document& painting, const std::string& part) {
    const MaskTexels texels = texels_of(part);
    const ink::Canvas& canvas = painting.layers().canvas();
    double sum = 0;
    for (const std::uint32_t slot : canvas.touched_slots())
        for (int film = 0; film < ink::kFilms; ++film)
            for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
                if (const ink::Plane* w = canvas.film_plane(slot, film, p))
                    for (int t = 0; t < atlas::kTileTexels; ++t)
                        if (texels.coverage(slot, t))
                            sum += static_cast<double>((*w)[t]) *
                                   static_cast<double>(model().texels.tiles[slot].area[static_cast<std::size_t>(t)]);
    return sum;
}

PartEdit hide(const Document& d, std::vector<std::string> names) {
    return hidden_parts(d.parts().table(), names, true);
}
PartEdit lock(const Document& d, std::vector<std::string> names) {
    return locked_parts(d.parts().table(), names, true);
}

TEST(Parts, ABrushPaintsThroughAHiddenOne) {
    Document seen(model()), through(model());
    seen.paint(quick());
    EXPECT_GT(ink_on(seen, "pane"), 0);
    EXPECT_EQ(ink_on(seen, "body") + ink_on(seen, "trim"), 0);
    through.paint(hide(through, {"pane"}));
    const StrokeReport report = through.paint(quick());
    EXPECT_EQ(ink_on(through, "pane"), 0);
    EXPECT_GT(ink_on(through, "body"), 0);
    EXPECT_GT(ink_on(through, "trim"), 0);
    // As if it were not there. The two models have other texels: the rim of a stroke, 3 mm wide, is a texel of 0.08 mm
    // uncertain.
    const Model bare = make_model(false);
    Document without(bare);
    EXPECT_NEAR(report.ink_given / without.paint(quick()).ink_given, 1, 0.03);
}

TEST(Parts, AFlatStrokeLiesOnWhatIsSeen) {
    for (const SurfaceMapping mapping : {SurfaceMapping::project, SurfaceMapping::drape, SurfaceMapping::wrap}) {
        PaintStroke flat{.brush = "wolf-small", .ink = "carbon"};
        flat.trace.placement.origin = {0, 0, kPane};
        flat.trace.placement.mapping = mapping;
        for (int i = 0; i <= 40; ++i)
            flat.trace.samples.push_back({.time = 0.02 * i, .position = {-0.01 + 5e-4 * i, 0, 0}, .pressure = 0.5});
        Document d(model());
        d.paint(flat);
        EXPECT_GT(ink_on(d, "pane"), 0);
        d.paint(hide(d, {"pane"}));
        d.paint(flat);
        EXPECT_GT(ink_on(d, "body"), 0);
        EXPECT_GT(ink_on(d, "trim"), 0);
    }
}

TEST(Parts, ALockedOneIsTouchedAndStaysAsItIs) {
    Document d(model());
    d.paint(lock(d, {"pane"}));
    d.paint(quick());
    EXPECT_EQ(ink_on(d, "pane") + ink_on(d, "body") + ink_on(d, "trim"), 0);  // the pane holds the brush off
    d.paint(hide(d, {"pane"}));
    d.paint(lock(d, {"trim"}));
    d.paint(quick());
    EXPECT_GT(ink_on(d, "body"), 0);
    EXPECT_EQ(ink_on(d, "trim"), 0);
    // Neither a fill nor an eraser changes it.
    d.paint(Fill{.ink = "cinnabar"});
    EXPECT_EQ(ink_on(d, "trim") + ink_on(d, "pane"), 0);
    const double body = ink_on(d, "body");
    d.paint(lock(d, {"body"}));
    PaintStroke eraser = quick();
    eraser.tool = Tool::eraser;
    d.paint(eraser);
    EXPECT_EQ(ink_on(d, "body"), body);
}

TEST(Parts, WetInkDoesNotFlowOntoALockedOne) {
    Document d(model(), {.substrate = "rice-paper"});
    d.paint(hide(d, {"pane"}));
    d.paint(lock(d, {"trim"}));
    PaintStroke wet = quick();
    wet.settings.film = FilmModel::wet;
    d.paint(wet);
    d.paint(Dry{.seconds = 5});
    EXPECT_GT(ink_on(d, "body"), 0);
    EXPECT_EQ(ink_on(d, "trim"), 0);
}

TEST(Parts, IsolationHidesAllOthers) {
    const std::vector<std::string> all = part_names(*model().mesh);
    EXPECT_EQ(all, (std::vector<std::string>{"body", "trim", "pane"}));
    Document d(model());
    d.paint(isolated_parts(d.parts().table(), all, {"trim"}));
    EXPECT_TRUE(d.parts().table().find("body")->hidden);
    EXPECT_TRUE(d.parts().table().find("pane")->hidden);
    EXPECT_EQ(d.parts().table().find("trim"), nullptr);
    for (const std::uint8_t hidden : d.parts().hidden_triangles()) EXPECT_LE(hidden, 1);
    EXPECT_FALSE(d.parts().surface()->ray({-0.01, 0, 0.1}, {0, 0, -1}).has_value());
    EXPECT_NEAR(d.parts().surface()->ray({0.01, 0, 0.1}, {0, 0, -1})->position.z, 0, 1e-9);
    d.paint(hidden_parts(d.parts().table(), all, false));
    EXPECT_EQ(d.parts().table(), PartTable{});
    EXPECT_NEAR(d.parts().surface()->ray({-0.01, 0, 0.1}, {0, 0, -1})->position.z, kPane, 1e-9);
}

TEST(Parts, WithAllHiddenNothingIsPaintedAndNothingBreaks) {
    Document d(model());
    d.paint(hide(d, part_names(*model().mesh)));
    d.paint(quick());
    for (const SurfaceMapping mapping : {SurfaceMapping::project, SurfaceMapping::drape, SurfaceMapping::wrap}) {
        PaintStroke flat{.brush = "wolf-small", .ink = "carbon"};
        flat.trace.placement.mapping = mapping;
        for (int i = 0; i <= 10; ++i)
            flat.trace.samples.push_back({.time = 0.02 * i, .position = {1e-3 * i, 0, 0}, .pressure = 0.5});
        try {
            d.paint(flat);
        } catch (const Error&) {
        }
    }
    d.paint(Fill{.ink = "cinnabar"});
    EXPECT_EQ(ink_on(d, "body") + ink_on(d, "trim") + ink_on(d, "pane"), 0);
}

TEST(Parts, EachHasItsSubstrate) {
    Document d(model());
    const ink::Substrate clay = ink::load_substrate("clay"), porcelain = ink::load_substrate("porcelain");
    d.paint(parts_of_substrate(d.parts().table(), {"trim"}, clay));
    const MaskTexels trim = texels_of("trim");
    const auto reflectance = [&](std::uint32_t slot, int t) {
        return trim.coverage(slot, t) ? clay.reflectance : porcelain.reflectance;
    };
    int shared = 0;
    for (std::uint32_t slot = 0; slot < model().texels.n_slots(); ++slot) {
        const ink::TileAppearance look = ink::shade_tile(d.appearance().stack(), slot, d.appearance().substrate());
        int clays = 0, texels = 0;
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            if (model().texels.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            clays += trim.coverage(slot, t) > 0, ++texels;
            // The colour goes through the bands and back, in single precision.
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(look.colour[c][static_cast<std::size_t>(t)], reflectance(slot, t)[c], 1e-4);
            ASSERT_EQ(look.roughness[static_cast<std::size_t>(t)],
                      trim.coverage(slot, t) ? clay.roughness : porcelain.roughness);
        }
        shared += clays > 0 && clays < texels;
    }
    EXPECT_GT(shared, 0);  // the border of two parts on one chart

    // What stays on each is its capacity; a tile that both share has that of one of them.
    d.paint(Fill{.ink = "carbon", .film = 100});
    for (std::uint32_t slot = 0; slot < model().texels.n_slots(); ++slot) {
        const ink::Plane* w = d.layers().canvas().plane(slot, 0);
        if (!w || d.parts().substrates()->of_texel.contains(slot)) continue;
        for (int t = 0; t < atlas::kTileTexels; ++t)
            if (model().texels.tiles[slot].cluster[t] != atlas::kNoCluster) {
                ASSERT_NEAR((*w)[t], trim.coverage(slot, t) ? clay.capacity : porcelain.capacity, 1e-5);
            }
    }
    d.appearance().preview_substrate(ink::load_substrate("bisque"));
    EXPECT_EQ(d.appearance().stack().substrates, nullptr);
}

TEST(Parts, LightPassesBareGlassAndNotInk) {
    Document d(model());
    EXPECT_TRUE(
        ink::compose_transmission8(d.appearance().stack(), model().texels, d.appearance().substrate()).texels.empty());
    const ink::Substrate glass = ink::load_substrate("glass");
    d.paint(parts_of_substrate(d.parts().table(), {"pane"}, glass));
    d.paint(quick());
    const auto map = ink::compose_transmission8(d.appearance().stack(), model().texels, d.appearance().substrate());
    const auto value = [&](const Vec3& p) {
        const auto at = *model().query->closest_point(p);
        const atlas::TexelRef texel =
            atlas::texel_at(*model().mesh, model().atlas, model().texels, at.triangle, at.position);
        const std::uint32_t tile = model().texels.tile_of_slot[texel.slot], n = model().texels.tiles_per_side;
        const std::size_t x = tile % n * 16 + texel.texel % 16, y = tile / n * 16 + texel.texel / 16;
        return map.texels[y * map.size + x] / 255.0;
    };
    EXPECT_NEAR(value({0, 0.02, kPane}), 0.9, 0.5 / 255);
    EXPECT_EQ(value({0, 0.02, 0}), 0);
    EXPECT_LT(value({0, 0, kPane}), 0.02);  // film 1.8: exp(−7.2) of it is left, less at the edge of the stroke
}

TEST(Parts, UndoReplayAndTextKeepThem) {
    std::uint64_t hash = 0;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Document p(model());
        p.paint(hide(p, {"pane"}));
        p.paint(parts_of_substrate(p.parts().table(), {"trim"}, ink::load_substrate("clay")));
        p.paint(quick());
        PaintStroke beside = quick();
        for (StrokeSample& s : beside.trace.samples) s.position.y += 8e-3;
        p.paint(std::vector<JournalEntry>{beside, quick()}, {});
        p.paint(lock(p, {"body"}));
        p.paint(Fill{.ink = "cinnabar"});
        p.paint(hidden_parts(p.parts().table(), {"pane"}, false));
        const PartTable table = p.parts().table();
        if (threads == 1) hash = p.layers().hash();
        EXPECT_EQ(p.layers().hash(), hash);
        std::vector<JournalEntry> entries = p.journal().entries();
        for (JournalEntry& e : entries) {
            const JournalEntry back = written_and_read(e);
            if (const PartEdit* edit = e.as<PartEdit>()) {
                EXPECT_EQ(back.get<PartEdit>(), *edit);
            }
            e = back;
        }
        Document again(model());
        again.replay(entries);
        EXPECT_EQ(again.layers().hash(), hash);
        EXPECT_EQ(again.parts().table(), table);
        while (p.undo()) {
        }
        EXPECT_EQ(p.parts().table(), PartTable{});
        while (p.redo()) {
        }
        EXPECT_EQ(p.parts().table(), table);
        EXPECT_EQ(p.layers().hash(), hash);
    }
    set_thread_count(0);
}

TEST(Parts, UnknownNamesAreRefusedButReplayed) {
    Document d(model());
    try {
        d.paint(hide(d, {"pain"}));
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(error.message().text().find("did you mean 'pane'"), std::string::npos) << error.message().text();
    }
    EXPECT_TRUE(d.journal().entries().empty());
    EXPECT_THROW(d.paint(PartEdit{}), Error);
    EXPECT_THROW(d.paint(hide(d, {"pane", "pane"})), Error);
    // A revised model may lack a part.
    d.replay({JournalEntry(hide(d, {"wing"}))});
    EXPECT_TRUE(d.parts().hidden_triangles().empty());
    d.paint(quick());
    EXPECT_GT(ink_on(d, "pane"), 0);
}

}  // namespace
}  // namespace tuft::stroke
