#include "stroke/journal/entry/fill.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/system/parallel.h"
#include "core/text/units.h"
#include "entry_text.h"
#include "sheet.h"

namespace tuft::stroke {
namespace {

const Model& model() {
    static const Model m = sheet();
    return m;
}

double area() {
    double sum = 0;
    for (const atlas::TexelTile& tile : model().texels.tiles)
        for (const float a : tile.area) sum += static_cast<double>(a);
    return sum;
}

Fill fill(const std::string& ink, Fill how) {
    how.ink = ink;
    return how;
}

PaintStroke quick(double depth = 3e-3) {
    PaintStroke s = line("wolf-small", depth);
    s.settings.spacing = 3;  // coarse is enough here, and quick
    return s;
}

PaintStroke eraser(double depth = 3e-3) {
    PaintStroke s = quick(depth);
    s.tool = Tool::eraser;
    s.ink.clear();
    return s;
}

double total(const Document& p) {
    double sum = 0;
    for (int k = 0; k < static_cast<int>(p.layers().canvas().pigments().size()); ++k)
        sum += p.layers().canvas().total(model().texels, k);
    return sum;
}

// Film on the nearest texel, all films.
double film_at(const Document& p, const Vec3& at, int pigment) {
    const auto near = model().query->closest_point(at);
    const atlas::TexelRef texel =
        atlas::texel_at(*model().mesh, model().atlas, model().texels, near->triangle, near->position);
    double sum = 0;
    for (int film = 0; film < ink::kFilms; ++film)
        if (const ink::Plane* w = p.layers().canvas().film_plane(texel.slot, film, pigment))
            sum += static_cast<double>((*w)[texel.texel]);
    return sum;
}

TEST(Fill, IsFilmTimesArea) {
    Document p(model());
    const StrokeReport r = p.paint(fill("carbon", {.film = 1.5}));
    const double wanted = 1.5 * area() * p.materials().ink("carbon").strength();
    EXPECT_NEAR(total(p) / wanted, 1, 1e-6);  // films are single precision
    EXPECT_NEAR(r.ink_given / total(p), 1, 1e-12);
    p.paint(fill("carbon", {.film = 1000}));
    EXPECT_NEAR(total(p) / (static_cast<double>(p.appearance().substrate().capacity) * area()), 1, 1e-6)
        << "no more than stays";
    ASSERT_TRUE(p.undo());
    EXPECT_NEAR(total(p) / wanted, 1, 1e-6);
    ASSERT_TRUE(p.undo());
    EXPECT_EQ(total(p), 0);
}

TEST(Fill, AGradientIsLinearBetweenItsEnds) {
    Document p(model());
    p.paint(fill("cinnabar", {.film = 2,
                              .gradient = Gradient::along,
                              .to_film = 0.5,
                              .to_ink = "indigo",
                              .from = {-0.02, 0, 0},
                              .to = {0.02, 0, 0}}));
    const double red = p.materials().ink("cinnabar").strength(), blue = p.materials().ink("indigo").strength();
    for (const double x : {-0.025, -0.02, -0.01, 0.0, 0.0137, 0.02, 0.028}) {
        const double t = std::clamp((x + 0.02) / 0.04, 0.0, 1.0), film = 2 - 1.5 * t;
        // The texel asked for lies up to 0.7 texels away: 0.04 mm of 40.
        EXPECT_NEAR(film_at(p, {x, 0.005, 0}, 0), film * (1 - t) * red, 4e-3) << x;
        EXPECT_NEAR(film_at(p, {x, 0.005, 0}, 1), film * t * blue, 4e-3) << x;
    }
    Document round(model());
    round.paint(
        fill("carbon", {.film = 0, .gradient = Gradient::round, .to_film = 1, .from = {0, 0, 0}, .to = {0, 0.02, 0}}));
    EXPECT_NEAR(film_at(round, {0.006, 0.008, 0}, 0), 0.5 * round.materials().ink("carbon").strength(), 4e-3);
    EXPECT_NEAR(film_at(round, {0.025, 0, 0}, 0), round.materials().ink("carbon").strength(), 1e-6);
}

// Two sheets that do not hang together, and the charts of a cube.
TEST(Fill, APartAndAChartEndWhereTheyEnd) {
    mesh::PolygonSoup soup;
    for (const double z : {0.0, 0.01}) {
        const auto n = static_cast<std::uint32_t>(soup.points.size());
        for (const Vec3& v : {Vec3{0, 0, z}, Vec3{0.02, 0, z}, Vec3{0.02, 0.02, z}, Vec3{0, 0.02, z}})
            soup.points.push_back(v);
        if (soup.polygon_start.empty()) soup.polygon_start.push_back(0);
        for (std::uint32_t k = 0; k < 4; ++k) soup.corners.push_back(n + k);
        soup.polygon_start.push_back(n + 4);
    }
    ModelOptions options;
    options.repair.metres_per_unit = 1;
    options.unwrap.size = 256;
    options.unwrap.cutting = atlas::Cutting::never;
    const Model two = prepare_model(std::move(soup), options);
    for (const Region region : {Region::part, Region::chart}) {
        Document p(two);
        p.paint(fill("carbon", {.film = 1, .region = region, .at = {0.01, 0.01, 0.011}}));
        const double strength = p.materials().ink("carbon").strength();
        // 256² texels approximate the area of a chart to a texel along its rim.
        EXPECT_NEAR(p.layers().canvas().total(two.texels, 0) / strength, 4e-4, 0.03 * 4e-4);
        for (const std::uint32_t slot : p.layers().canvas().touched_slots())
            for (int t = 0; t < atlas::kTileTexels; ++t)
                if ((*p.layers().canvas().plane(slot, 0))[t] > 0) {
                    EXPECT_GT(two.texels.position(slot, t).z, 0.009f);
                }
    }
}

TEST(Eraser, TakesWhatItsContactCoversAndTheBooksBalance) {
    Document p(model());
    p.paint(fill("carbon", {.film = 2}));
    p.paint(Dry{});  // a dry film below
    p.paint(fill("cinnabar", {.film = 1}));
    const double before = total(p);
    const std::uint64_t hash = p.layers().hash();
    const StrokeReport r = p.paint(eraser());
    EXPECT_GT(r.stamps, 10u);
    EXPECT_EQ(r.ink_given, 0);
    EXPECT_GT(r.removed.sum(), 0);
    EXPECT_NEAR((total(p) + r.removed.sum()) / before, 1, 1e-6);
    // Both films go, in proportion to what was there.
    EXPECT_NEAR(r.removed.pigment[0] / r.removed.pigment[1],
                2 * p.materials().ink("carbon").strength() / p.materials().ink("cinnabar").strength(), 1e-3);
    EXPECT_EQ(film_at(p, {0, 0, 0}, 0), 0) << "the middle of the stroke is bare";
    EXPECT_EQ(film_at(p, {0, 0.02, 0}, 0),
              static_cast<double>(2 * static_cast<float>(p.materials().ink("carbon").strength())));
    EXPECT_EQ(p.brushes().find("wolf-small"), nullptr) << "an eraser is no brush of the rack";
    ASSERT_TRUE(p.undo());
    EXPECT_EQ(p.layers().hash(), hash);
    ASSERT_TRUE(p.redo());
    EXPECT_NEAR((total(p) + r.removed.sum()) / before, 1, 1e-6);
}

TEST(Eraser, FilmOnlyFallsAndMoreSoUnderMorePressure) {
    double last = 0;
    for (const double depth : {1e-3, 2e-3, 4e-3}) {
        Document p(model());
        p.paint(fill("carbon", {.film = 2}));
        std::vector<ink::TileSnapshot> before;
        for (const std::uint32_t slot : p.layers().canvas().touched_slots())
            before.push_back(p.layers().canvas().snapshot(slot));
        const double removed = p.paint(eraser(depth)).removed.sum();
        EXPECT_GT(removed, last) << depth;
        last = removed;
        for (const ink::TileSnapshot& tile : before) {
            const ink::TileSnapshot after = p.layers().canvas().snapshot(tile.slot);
            ASSERT_EQ(after.amounts.size(), tile.amounts.size());
            for (std::size_t i = 0; i < tile.amounts.size(); ++i) {
                ASSERT_LE(after.amounts[i], tile.amounts[i]);
                ASSERT_GE(after.amounts[i], 0);
            }
        }
    }
}

/// How dark a texel looks, 0–1: what it hides.
double looks(const Document& p, std::uint32_t slot, int t) {
    const ink::EraseStart start = ink::erase_start(p.layers().canvas(), slot);
    return 1 - std::exp(-static_cast<double>(start.hides[t]));
}

TEST(Eraser, TheSameStrokeLeavesNothingOfIt) {
    Document p(model());
    p.paint(quick());
    double before = 0, after = 0, worst = 0;
    const auto each = [&](auto&& fn) {
        for (const std::uint32_t slot : p.layers().canvas().touched_slots())
            for (int t = 0; t < atlas::kTileTexels; ++t) fn(looks(p, slot, t));
    };
    each([&](double look) { before += look; });
    p.paint(eraser());
    each([&](double look) { after += look, worst = std::max(worst, look); });
    EXPECT_LT(after, 0.002 * before) << "4 % were left, all of it a line along the rim";
    EXPECT_LT(worst, 0.25);
}

TEST(Eraser, WorksOnItsLayerAlone) {
    Document p(model());
    p.paint(fill("carbon", {.film = 2}));
    p.paint(add_on_top(p.layers().table(), "top"));
    const std::uint64_t below = p.layers().canvas().hash();
    PaintStroke s = eraser();
    s.layer = 2;
    EXPECT_EQ(p.paint(s).removed.sum(), 0) << "nothing is there";
    EXPECT_EQ(p.layers().canvas().hash(), below);
}

TEST(Eraser, ReplaysToTheBitForAnyThreadCount) {
    std::uint64_t hash = 0;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Document p(model());
        p.paint(fill("indigo",
                     {.film = 1, .gradient = Gradient::round, .to_film = 2, .from = {0, 0, 0}, .to = {0, 0.02, 0}}));
        p.paint(quick());
        p.paint(eraser(2e-3));
        if (threads == 1) hash = p.layers().hash();
        EXPECT_EQ(p.layers().hash(), hash);
        Document again(model());
        std::vector<JournalEntry> strokes = p.journal().entries();
        for (JournalEntry& s : strokes) {  // as a file has them
            const JournalEntry back = written_and_read(s);
            if (const Fill* filled = s.as<Fill>()) {
                EXPECT_EQ(back.get<Fill>(), *filled);
            }
            s = back;
        }
        again.replay(strokes);
        EXPECT_EQ(again.layers().hash(), hash);
    }
    set_thread_count(0);
}

TEST(Fill, NonsenseIsRefused) {
    Document p(model());
    EXPECT_THROW(p.paint(fill("carbon", {.film = -1})), Error);
    EXPECT_THROW(p.paint(fill("carbon", {.film = std::nan("")})), Error);
    EXPECT_THROW(p.paint(fill("carbon", {.gradient = Gradient::along})), Error) << "no length";
    EXPECT_THROW(p.paint(fill("no-such-ink", {})), Error);
    EXPECT_TRUE(p.journal().empty());
    for (const char* text : {R"({"action":"fill"})", R"({"action":"fill","fill":{"film":"much","region":"all"}})",
                             R"({"tool":"knife"})", R"({"action":"fill","fill":{"film":1,"region":"moon"}})",
                             R"({"action":"fill","fill":{"film":1e9,"region":"all"}})",
                             R"({"action":"fill","fill":{"film":1,"region":"part","at":[1,2]}})"})
        EXPECT_THROW(entry_of({}, text), Error) << text;
}

}  // namespace
}  // namespace tuft::stroke
