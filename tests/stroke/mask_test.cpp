#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/system/parallel.h"
#include "core/text/units.h"
#include "entry_text.h"
#include "sheet.h"
#include "stroke/document/pick.h"
#include "stroke/surface/mask_texels.h"

namespace tuft::stroke {
namespace {

const Model& model() {
    static const Model m = sheet();
    return m;
}

// A sphere of 20 mm by latitudes, its upper half one group, its lower another.
const Model& ball() {
    static const Model m = [] {
        mesh::PolygonSoup soup;
        constexpr std::uint32_t kRings = 24, kAround = 48;
        for (std::uint32_t j = 0; j <= kRings; ++j)
            for (std::uint32_t i = 0; i < kAround; ++i) {
                const double a = std::numbers::pi * j / kRings, b = 2 * std::numbers::pi * i / kAround;
                soup.points.push_back(0.02 * Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
            }
        soup.polygon_start.push_back(0);
        soup.group_names = {"upper", "lower"};
        for (std::uint32_t j = 0; j < kRings; ++j)
            for (std::uint32_t i = 0; i < kAround; ++i) {
                const std::uint32_t k = (i + 1) % kAround;
                for (const std::uint32_t corner :
                     {j * kAround + i, (j + 1) * kAround + i, (j + 1) * kAround + k, j * kAround + k})
                    soup.corners.push_back(corner);
                soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
                soup.polygon_groups.push_back(j < kRings / 2 ? 0 : 1);
            }
        ModelOptions options;
        options.repair.metres_per_unit = 1;
        options.unwrap.size = 512;
        return prepare_model(std::move(soup), options);
    }();
    return m;
}

// Surface that the mask covers, over the whole one.
double share(const Mask& mask, const MaskTable& table, const Model& m) {
    const MaskTexels texels = evaluate(mask, table, m);
    double in = 0, all = 0;
    for (std::uint32_t slot = 0; slot < m.texels.n_slots(); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            const double area = static_cast<double>(m.texels.tiles[slot].area[t]);
            all += area;
            in += area * texels.coverage(slot, t) / 255;
        }
    return in / all;
}

Mask lasso(std::vector<Vec2> polygon, bool through = false) {
    // Seen from above.
    return {.name = "lasso",
            .kind = MaskKind::lasso,
            .view = {.origin = {0, 0, 0}, .right = {1, 0, 0}, .up = {0, 1, 0}, .through = through},
            .polygon = std::move(polygon)};
}

PaintStroke quick() {
    PaintStroke s = line("wolf-small", 3e-3);
    s.settings.spacing = 3;
    return s;
}

// A revised model may lack them.
TEST(Mask, OfGroupsThatAreGoneCoverNothing) {
    const MaskEdit edit{.mask = {.id = 1, .name = "m", .kind = MaskKind::group, .groups = {"rim", "upper"}}};
    MaskTable table;
    apply(table, edit);
    EXPECT_NEAR(share(table.masks[0], table, ball()), 0.5, 0.01) << "the upper half, within a texel along the equator";
    Document document(ball());
    EXPECT_THROW(document.paint(MaskEdit(edit)), Error) << "a new one is a slip of the pen";
    EXPECT_NO_THROW(document.replay({entry_after({}, MaskEdit(edit))}));
}

TEST(Mask, ByAngleIsACap) {
    const double half = 50 * kDegree;
    const Mask hard{.name = "cap", .kind = MaskKind::angle, .direction = {0, 0, 3}, .within = half};
    // Archimedes: a cap has the part (1 − cos a)/2 of the sphere. Normals are those of facets of
    // 7.5 degrees, interpolated; the soft edge is even about the same angle to second order.
    EXPECT_NEAR(share(hard, {}, ball()), (1 - std::cos(half)) / 2, 2e-3);
    Mask soft = hard;
    soft.soft = 10 * kDegree;
    EXPECT_NEAR(share(soft, {}, ball()), (1 - std::cos(half)) / 2, 3e-3);
}

TEST(Mask, ByGroupIsTheGroupAndItsInverseTheRest) {
    MaskTable table;
    apply(table, {.mask = {.name = "upper", .kind = MaskKind::group, .groups = {"upper"}}});
    apply(table, {.mask = {.name = "rest", .kind = MaskKind::invert, .of = {1}}});
    apply(table, {.mask = {.name = "both", .kind = MaskKind::unite, .of = {1, 2}}});
    apply(table, {.mask = {.name = "none", .kind = MaskKind::intersect, .of = {1, 2}}});
    EXPECT_NEAR(share(*table.find("upper"), table, ball()), 0.5, 2e-3);  // a texel along the equator
    EXPECT_NEAR(share(*table.find("upper"), table, ball()) + share(*table.find("rest"), table, ball()), 1, 1e-9);
    EXPECT_EQ(share(*table.find("both"), table, ball()), 1);
    EXPECT_EQ(share(*table.find("none"), table, ball()), 0);
    const MaskTexels upper = evaluate(*table.find("upper"), table, ball());
    for (std::uint32_t slot = 0; slot < ball().texels.n_slots(); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            if (ball().texels.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            const float z = ball().texels.position(slot, t).z;
            if (std::abs(z) > 1e-4f) {
                ASSERT_EQ(upper.coverage(slot, t), z > 0 ? 255 : 0);
            }
        }
    EXPECT_THROW(check_groups({.name = "x", .kind = MaskKind::group, .groups = {"uper"}}, *ball().mesh), Error);
}

TEST(Mask, ByLassoIsWhatIsSeen) {
    const std::vector<Vec2> square{{-0.01, -0.01}, {0.01, -0.01}, {0.01, 0.01}, {-0.01, 0.01}};
    // On the sheet the square itself, its rim a texel soft.
    EXPECT_NEAR(share(lasso(square), {}, model()), 4e-4 / (kSide * kSide), 1e-4);
    // On the ball what lies above the square and is seen: half of what lies in the column.
    const double seen = share(lasso(square), {}, ball()), all = share(lasso(square, true), {}, ball());
    EXPECT_GT(seen, 0);
    EXPECT_NEAR(all / seen, 2, 1e-2);
    // Everything that is seen of a ball from far away is half of it.
    const double r = 0.021;
    EXPECT_NEAR(share(lasso({{-r, -r}, {r, -r}, {r, r}, {-r, r}}), {}, ball()), 0.5, 1e-2);  // grazing facets
    // From an eye at the distance d the cap 1 − R/d of the half.
    Mask eye = lasso({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
    eye.view.origin = {0, 0, 0.05};
    eye.view.perspective = true;
    EXPECT_NEAR(share(eye, {}, ball()), 0.5 * (1 - 0.4), 1e-2);
}

TEST(Mask, NothingOutsideAndTheSameInside) {
    // The brush keeps the ink it does not leave outside. One that holds a hundred times the
    // ink does not feel that: what differs inside is a hundredth of 1.3 % of the film of 1.8.
    brush::Preset deep = brush::load_preset("wolf-small");
    deep.capacity *= 100;
    Document free(model()), kept(model());
    free.use(deep);
    kept.use(deep);
    free.paint(quick());
    kept.paint(MaskEdit({.mask = lasso({{-0.005, -1}, {0.004, -1}, {0.004, 1}, {-0.005, 1}})}));
    PaintStroke s = quick();
    s.mask = 1;
    EXPECT_GT(kept.paint(s).ink_given, 0);
    const MaskTexels& mask = kept.masks().texels(1);
    const double fresh = free.layers().canvas().total(model().texels, 0);
    EXPECT_LT(kept.layers().canvas().total(model().texels, 0), 0.5 * fresh);
    double difference = 0;
    for (const std::uint32_t slot : free.layers().canvas().touched_slots()) {
        const ink::Plane* there = free.layers().canvas().plane(slot, 0);
        const ink::Plane* here = kept.layers().canvas().plane(slot, 0);
        for (int t = 0; there && t < atlas::kTileTexels; ++t) {
            const float w = here ? (*here)[t] : 0;
            if (mask.coverage(slot, t) == 0) {
                ASSERT_EQ(w, 0);
            }
            if (mask.coverage(slot, t) == 255)
                difference = std::max(difference, static_cast<double>(std::abs(w - (*there)[t])));
        }
    }
    EXPECT_LT(difference, 1e-3);
    // A mask of everything is none, to the bit.
    Document all(model());
    all.use(deep);
    all.paint(MaskEdit({.mask = {.name = "all", .kind = MaskKind::angle, .within = 3.14159}}));
    s.mask = 1;
    all.paint(s);
    EXPECT_TRUE(all.layers().canvas().same_contents(free.layers().canvas()));
}

TEST(Mask, WetInkDoesNotFlowOutOfItUntilItIsPaintedWithoutIt) {
    // Half of the sheet is masked; a stroke with much water runs over its edge.
    const Mask half{.name = "half",
                    .kind = MaskKind::lasso,
                    .view = {.right = {1, 0, 0}, .up = {0, 1, 0}},
                    .polygon = {{0, -1}, {1, -1}, {1, 1}, {0, 1}}};
    PaintStroke wet = quick();
    wet.ink = "carbon";
    wet.settings.film = FilmModel::wet;
    const Dry wait{.seconds = 5};
    const auto outside = [](Document& painting) {
        const MaskTexels& mask = painting.masks().texels(1);
        double sum = 0;
        for (std::uint32_t slot = 0; slot < model().texels.n_slots(); ++slot)
            for (int p = 0; p < static_cast<int>(painting.layers().canvas().pigments().size()); ++p)
                for (int t = 0; t < atlas::kTileTexels; ++t)
                    if (mask.coverage(slot, t) == 0)
                        for (int film = 0; film < ink::kFilms; ++film)
                            if (const ink::Plane* w = painting.layers().canvas().film_plane(slot, film, p))
                                sum += static_cast<double>((*w)[t]);
        return sum;
    };
    Document painting(model(), {.substrate = "rice-paper"});
    painting.paint(MaskEdit({.mask = half}));
    wet.mask = 1;
    painting.paint(wet);
    painting.paint(wait);
    EXPECT_EQ(outside(painting), 0);
    EXPECT_TRUE(painting.layers().canvas().wet());
    const std::uint64_t hash = painting.layers().hash();
    painting.undo();
    painting.undo();
    painting.redo();
    painting.redo();
    EXPECT_EQ(painting.layers().hash(), hash);
    Document again(model(), {.substrate = "rice-paper"});
    again.replay(painting.journal().entries());
    EXPECT_EQ(again.layers().hash(), hash);
    // The stencil edge comes off with the next stroke, which lies elsewhere.
    PaintStroke beside = wet;
    beside.mask = 0;
    for (StrokeSample& s : beside.trace.samples) s.position += Vec3{0.012, 0, 0};
    painting.paint(beside);
    painting.paint(wait);
    EXPECT_GT(outside(painting), 0.1);
}

TEST(Mask, UndoReplayAndTextKeepIt) {
    std::uint64_t hash = 0;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Document p(model());
        p.paint(MaskEdit({.mask = lasso({{-0.005, -1}, {0.004, -1}, {0.004, 1}})}));
        p.paint(MaskEdit({.mask = {.name = "金", .kind = MaskKind::invert, .of = {1}}}));
        p.paint(Fill{.ink = "cinnabar", .mask = 2});
        PaintStroke s = quick();
        s.mask = 1;
        p.paint(s);
        const MaskTable table = p.masks().table();
        if (threads == 1) hash = p.layers().hash();
        EXPECT_EQ(p.layers().hash(), hash);
        std::vector<JournalEntry> strokes = p.journal().entries();
        for (JournalEntry& e : strokes) {
            const JournalEntry back = written_and_read(e);
            if (const MaskEdit* edit = e.as<MaskEdit>()) {
                EXPECT_EQ(back.get<MaskEdit>(), *edit);
            }
            e = back;
        }
        Document again(model());
        again.replay(strokes);
        EXPECT_EQ(again.layers().hash(), hash);
        EXPECT_EQ(again.masks().table(), table);
        while (p.undo()) {
        }
        EXPECT_EQ(p.masks().table(), MaskTable{});
        while (p.redo()) {
        }
        EXPECT_EQ(p.masks().table(), table);
        EXPECT_EQ(p.layers().hash(), hash);
    }
    set_thread_count(0);
}

TEST(Mask, NonsenseIsRefused) {
    MaskTable t;
    EXPECT_THROW(apply(t, {.mask = {.name = "", .kind = MaskKind::angle}}), Error);
    EXPECT_THROW(apply(t, {.mask = {.name = "a", .kind = MaskKind::angle, .direction = {0, 0, 0}}}), Error);
    EXPECT_THROW(apply(t, {.mask = {.name = "a", .kind = MaskKind::angle, .within = std::nan("")}}), Error);
    EXPECT_THROW(apply(t, {.mask = {.name = "a", .kind = MaskKind::group}}), Error);
    EXPECT_THROW(apply(t, {.mask = {.name = "a", .kind = MaskKind::invert, .of = {1}}}), Error);
    EXPECT_THROW(apply(t, {.mask = lasso({{0, 0}, {1, 1}})}), Error);
    Mask skewed = lasso({{0, 0}, {1, 1}, {0, 1}});
    skewed.view.up = {1, 0, 0};
    EXPECT_THROW(apply(t, {.mask = skewed}), Error);
    EXPECT_THROW(apply(t, {.remove = true, .mask = {.id = 1}}), Error);
    EXPECT_EQ(t, MaskTable{});
    // Masks of masks of masks cost each mask once, however often it is named.
    apply(t, {.mask = {.name = "0", .kind = MaskKind::angle}});
    apply(t, {.mask = {.name = "1", .kind = MaskKind::invert, .of = {1}}});
    EXPECT_THROW(apply(t, {.remove = true, .mask = {.id = 1}}), Error) << "in use";
    for (std::uint32_t i = 2; i < 40; ++i)
        apply(t, {.mask = {.name = std::to_string(i), .kind = MaskKind::unite, .of = {i - 1, i}}});
    EXPECT_EQ(share(t.masks.back(), t, ball()), 1);
    for (const char* text :
         {R"({"action":"mask"})", R"({"mask":-1})", R"({"mask":"all"})",
          R"({"action":"mask","mask_edit":{"what":"add","id":1,"name":"a","kind":"moon"}})",
          R"({"action":"mask","mask_edit":{"what":"add","id":1,"name":"a","kind":"lasso","polygon":[[1]]}})"})
        EXPECT_THROW(entry_of({}, text), Error) << text;
    Document p(model());
    PaintStroke masked = quick();
    masked.mask = 3;
    EXPECT_THROW(p.paint(masked), Error);
}

TEST(Eyedropper, ReturnsWhatWasDepositedAndMakesAnInkOfIt) {
    Document p(model());
    const auto fill = [&](const std::string& ink, double film) { p.paint(Fill{.ink = ink, .film = film}); };
    const Vec3 at{0.0123, -0.007, 0.001};
    EXPECT_TRUE(pick(p, at).films.empty());
    EXPECT_FALSE(picked_ink(pick(p, at), p.layers().pigments(), "none"));
    fill("cinnabar", 1.5);
    p.paint(Dry{});
    fill("indigo", 0.5);
    const Pick both = pick(p, at);
    EXPECT_NEAR(both.at.distance, 1e-3, 1e-9);
    ASSERT_EQ(both.films.size(), 2u);
    EXPECT_EQ(both.films[0].film, ink::kFirstDryFilm);
    EXPECT_EQ(both.films[1].film, ink::kOpenFilm);
    const double red = 1.5 * p.materials().ink("cinnabar").strength(),
                 blue = 0.5 * p.materials().ink("indigo").strength();
    EXPECT_NEAR(both.amounts[0], red, 1e-6);  // single precision
    EXPECT_NEAR(both.amounts[1], blue, 1e-6);
    ink::Ink picked = *picked_ink(both, p.layers().pigments(), "picked");
    ASSERT_EQ(picked.parts.size(), 2u);
    EXPECT_NEAR(picked.parts[0].fraction, red / (red + blue), 1e-6);
    EXPECT_LE(picked.strength(), 1);
    EXPECT_NEAR(picked.film, red + blue, 1e-6);
    // It is an ink like any other: it goes through a file and paints what was picked.
    picked = ink::parse_ink(ink::ink_toml(picked), "picked");
    picked.name = "picked";
    Document other(model());
    other.use(picked);
    other.paint(Fill{.ink = "picked", .film = picked.film});
    EXPECT_NEAR(pick(other, at).amounts[0], red, 1e-5);
    EXPECT_NEAR(pick(other, at).amounts[1], blue, 1e-5);
}

}  // namespace
}  // namespace tuft::stroke
