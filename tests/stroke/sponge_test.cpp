#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "core/system/parallel.h"
#include "sheet.h"
#include "stroke/placement/holder.h"
#include "stroke/placement/tip_lag.h"

/// Strokes with a sponge, and with tufts of other geometries.
namespace tuft::stroke {
namespace {

using std::numbers::pi;

const std::string kSponge = "sponge-30";

/// A dab at a place of the sheet: down to `depth` and, with `lift`, up again.
PaintStroke dab(const Vec2& at, double depth, bool lift = true) {
    const double length = brush::load_preset(kSponge).length;
    PaintStroke s;
    s.trace.flat = false;
    s.brush = kSponge;
    s.ink = "indigo";
    s.settings.film = FilmModel::wet;
    s.settings.dip = DipMode::persistent;
    s.settings.spacing = 3;
    constexpr int kSamples = 16;
    for (int k = 0; k <= kSamples; ++k) {
        const double f = static_cast<double>(k) / kSamples, part = lift ? std::sin(pi * f) : f;
        s.trace.samples.push_back({.time = 0.6 * f, .position = {at, length + 0.5e-3 - (depth + 0.5e-3) * part}});
    }
    return s;
}

BrushAction brush_action(const BrushChange& what) {
    return {.what = what, .brush = kSponge, .ink = "indigo", .dip = DipMode::persistent};
}

double in_sponge(const Document& painting) {
    const BrushInHand* held = painting.brushes().find(kSponge);
    return held ? held->reservoir.remaining() : 0;
}

/// All pigment and water of the sheet, film·m².
double on_sheet(const Document& painting, const Model& model) {
    double sum = 0;
    for (int p = 0; p < ink::kMaxPigments; ++p) sum += painting.layers().canvas().total(model.texels, p);
    return sum;
}

double given_by(const brush::Preset& sponge, const Model& model, double depth) {
    Document painting(model, {.substrate = "porcelain"});
    painting.use(sponge);
    PaintStroke press = dab({0, 0}, depth, false);
    press.settings.spacing = 0.05;  // the last pose lies up to a step, 12 µm, before the end
    const StrokeReport report = painting.paint(press);
    const double capacity = sponge.capacity * ink::kFilmPerVolume;
    EXPECT_NEAR(in_sponge(painting) + report.ink_given, capacity, 1e-6 * capacity);
    EXPECT_EQ(painting.brushes().find(kSponge)->reservoir.capacity, capacity) << "released";
    return report.ink_given / ink::kFilmPerVolume;
}

// Pressed by d further, a full sponge with a flat face gives A d. Of the first press some 60 mm³ stay on its skin, as
// the film that is exchanged with the surface: 2 % of 4 mm.
TEST(Sponge, OfASaturatedOnePressedByDepthGivesItsVolume) {
    const Model model = sheet({}, 256);
    brush::Preset flat = brush::load_preset(kSponge);
    flat.dome = flat.rim = flat.unevenness = 0;
    flat.capacity = 0.97 * pi * flat.radius * flat.radius * flat.length;
    const double area = pi * flat.radius * flat.radius;
    const double first = given_by(flat, model, 4e-3), second = given_by(flat, model, 8e-3);
    EXPECT_NEAR(first / (area * 4e-3), 1, 0.03);
    EXPECT_NEAR((second - first) / (area * 4e-3), 1, 0.01);
}

// Soak, press, soak: what is out and what is in stay one sum, to rounding of some thousand doubles.
TEST(Sponge, KeepsItsInkWhileItIsSqueezedAndSoaks) {
    const brush::Tuft tuft = brush::make_tuft(brush::load_preset(kSponge));
    ink::Reservoir sponge = empty_reservoir(tuft);
    ink::Mix mix{};
    mix[2] = 0.3f;
    const double supplied = ink::dip(sponge, mix);
    ink::Reservoir::Content out{};
    const auto sum = [](const ink::Reservoir::Content& c) {
        double s = 0;
        for (const double v : c) s += v;
        return s;
    };
    for (int i = 0; i < 500; ++i) {
        const double part = 0.3 + 0.7 * uniform(5, static_cast<std::uint64_t>(i));
        ink::compress(sponge, part);
        EXPECT_NEAR(sponge.capacity, part * sponge.rest_capacity, 1e-12 * sponge.capacity);
        const ink::Reservoir::Content given = ink::take(sponge, ink::excess(sponge));
        for (std::size_t p = 0; p < out.size(); ++p) out[p] += given[p];
        EXPECT_LE(ink::excess(sponge), 1e-9 * supplied);
        ink::flow(sponge, 0.01);
        ink::compress(sponge, 1);
        // It soaks up a half of what is out, as far as it has room.
        ink::Reservoir::Content soaked = out;
        const double takes = std::min(0.5 * sum(out), ink::free_capacity(sponge)),
                     share = takes / std::max(sum(out), 1e-30);
        for (std::size_t p = 0; p < out.size(); ++p) soaked[p] *= share, out[p] -= soaked[p];
        ink::absorb(sponge, soaked);
        ASSERT_NEAR(sponge.remaining() + sum(out), supplied, 1e-10 * supplied) << i;
    }
    EXPECT_NEAR(sponge.pigment(2) + out[2], static_cast<double>(mix[2]) * supplied, 1e-10 * supplied);
}

// A wrung sponge takes liquid up from a wet place. A full one takes back a part of what it was pressed out of while it
// is released, and has it to give at the next place.
TEST(Sponge, SoaksUpWetInkAndGivesItBack) {
    const Model model = sheet({}, 256);
    const brush::Preset preset = brush::load_preset(kSponge);
    Document wrung(model, {.substrate = "porcelain"});
    wrung.paint(brush_action(Dip{}));
    wrung.paint(dab({0, 0}, 6e-3, false));
    const double pool = on_sheet(wrung, model);
    wrung.paint(brush_action(Rinse{}));
    ASSERT_EQ(in_sponge(wrung), 0);
    const StrokeReport lifts = wrung.paint(dab({0, 0}, 4e-3));
    EXPECT_LT(lifts.ink_given, 0);
    EXPECT_NEAR(in_sponge(wrung), -lifts.ink_given, 1e-6 * in_sponge(wrung));
    EXPECT_LT(on_sheet(wrung, model), 0.85 * pool);

    const Vec2 here{-0.015, -0.015}, there{0.015, 0.015};
    Document pressed(model, {.substrate = "porcelain"}), released(model, {.substrate = "porcelain"});
    const double given = pressed.paint(dab(here, 6e-3, false)).ink_given;
    const double left = released.paint(dab(here, 6e-3)).ink_given;
    EXPECT_GT(given, 0);
    EXPECT_LT(left, 0.9 * given);
    brush::Tuft tuft = brush::make_tuft(preset);
    const brush::ContactPlane plane;
    const double lost = brush::step(tuft, {{0, 0, preset.length - 9e-3}, {1, 0, 0, 0}, 0}, {&plane, 1}, 0).volume_lost;
    const double again = released.paint(dab(there, 9e-3, false)).ink_given;
    // Less the last step of the path, 0.7 mm here, and the film on the skin.
    EXPECT_NEAR(again / (lost * ink::kFilmPerVolume - left), 1, 0.2);
}

// A sponge that was led and leant as hair is, ahead of its dot, smeared its pores over all but its rim: 0.2 % bare, now
// 23 %.
TEST(Sponge, ADabPrintsItsPoresAllOver) {
    const Model model = sheet({}, 512);
    const brush::Preset sponge = brush::load_preset(kSponge);
    Document painting(model);
    PaintStroke press;
    press.brush = kSponge;
    press.ink = "indigo";
    press.trace.placement = {.right = {1, 0, 0}, .down = {0, -1, 0}, .mapping = SurfaceMapping::project};
    for (int k = 0; k <= 20; ++k)
        press.trace.samples.push_back(
            {.time = 0.03 * k, .position = {0, 0, 0}, .pressure = 0.3 * std::sin(pi * k / 20)});
    press.trace.pressed = true;
    painting.paint(press);
    double bare = 0, all = 0;
    const ink::Canvas& canvas = painting.layers().canvas();
    for (const std::uint32_t slot : canvas.touched_slots())
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            if (model.texels.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            const Vec3 p(model.texels.position(slot, t));
            if (glm::length(Vec2(p)) > 0.5 * sponge.radius) continue;
            double film = 0;
            for (int i = 0; i < static_cast<int>(canvas.pigments().size()); ++i)
                if (const ink::Plane* w = canvas.plane(slot, i)) film += static_cast<double>((*w)[t]);
            ++all;
            bare += film < 0.2;
        }
    RecordProperty("bare_percent", std::to_string(100 * bare / all));
    // Of the skin 55 % are pores. Ink spans their rims, and those smaller than a texel.
    EXPECT_GT(bare / all, 0.1);
}

// A sponge that begins pressed is set down straight: a step at full depth would be none.
TEST(Sponge, ADotOfOneSampleLands) {
    const brush::Preset sponge = brush::load_preset(kSponge);
    HolderOptions options = holder_options(sponge);
    TiltedTipLag tilted(sponge);
    options.tip_lag = tilted.as_held();
    StrokeSamples dot;
    dot.samples.push_back({.position = {0, 0, 0}, .pressure = 0.3});
    const StrokeSamples led = compensate_tip_lag(lean_holder(dot, options), options);
    ASSERT_GT(led.samples.size(), 8u);
    EXPECT_LT(led.samples.front().pressure, 0.01);
    for (std::size_t i = 0; i < led.samples.size(); ++i) {
        EXPECT_EQ(Vec2(led.samples[i].position), Vec2(0));
        EXPECT_EQ(led.samples[i].tilt, Vec2(0));
        if (i > 0) EXPECT_GE(led.samples[i].pressure, led.samples[i - 1].pressure);
    }
    EXPECT_EQ(led.samples.back().pressure, 0.3);
}

/// A leaf of hair: flat, pointed, with a hole.
brush::Preset leaf() {
    brush::Preset p = brush::load_preset("flat-12");
    p.name = "leaf";
    p.spines = 2;
    std::string text;
    constexpr int n = 24, rows = 10;
    for (int k = 0; k <= rows; ++k)
        for (int i = 0; i < n; ++i) {
            const double u = static_cast<double>(k) / rows, w = 2 * pi * i / n;
            char line[96];
            std::snprintf(line, sizeof line, "v %.6f %.6f %.6f\n", 5.5 * std::cos(w), 1.6 * (1 - 0.7 * u) * std::sin(w),
                          -1e3 * p.length * u * (1 - 0.15 * std::abs(std::cos(w))));
            text += line;
        }
    char ends[96];
    std::snprintf(ends, sizeof ends, "v 0 0 0\nv 0 0 %.6f\n", -1e3 * p.length);
    text += ends;
    const auto face = [&](int a, int b, int c) {
        text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
    };
    for (int k = 0; k < rows; ++k)
        for (int i = 0; i < n; ++i) {
            const int j = (i + 1) % n;
            face(k * n + i, (k + 1) * n + i, (k + 1) * n + j);
            face(k * n + i, (k + 1) * n + j, k * n + j);
        }
    for (int i = 0; i < n; ++i) {
        const int j = (i + 1) % n;
        face(i, j, (rows + 1) * n);
        face(rows * n + j, rows * n + i, (rows + 1) * n + 1);
    }
    p.geometry = std::make_shared<brush::Geometry>(brush::parse_geometry(text, "leaf.obj"));
    return brush::parse_preset(brush::preset_toml(p), "leaf");
}

/// Hair of a broken hake: polylines with gaps between them.
brush::Preset broken_hake() {
    brush::Preset p = brush::load_preset("flat-12");
    p.name = "broken";
    p.spines = 2;
    std::string text;
    int points = 0;
    for (int i = 0; i < 60; ++i) {
        if (i % 20 > 12) continue;
        const double x = -5.5 + 11.0 * i / 59, y = 1.5 * (2 * uniform(3, static_cast<std::uint64_t>(i)) - 1);
        for (int k = 0; k <= 8; ++k) {
            char line[96];
            std::snprintf(line, sizeof line, "v %.6f %.6f %.6f\n", x, y * (1 - 0.5 * k / 8), -1e3 * p.length * k / 8);
            text += line;
        }
        text += "l";
        for (int k = 1; k <= 9; ++k) text += " " + std::to_string(points + k);
        text += "\n";
        points += 9;
    }
    p.geometry = std::make_shared<brush::Geometry>(brush::parse_geometry(text, "broken.obj"));
    return brush::parse_preset(brush::preset_toml(p), "broken");
}

// Every deposit takes them, no ink is lost, and a replay gives the same bits on any number of threads, with the brush
// read back from the text that a project holds.
TEST(Shapes, PaintWithEveryDepositAndReplayToTheBit) {
    const Model model = sheet({}, 256);
    for (const brush::Preset& preset : {leaf(), broken_hake(), brush::load_preset(kSponge)})
        for (const char* how : {"still", "wet", "paste", "eraser"}) {
            set_thread_count(1);
            Document painting(model, {.substrate = "porcelain"});
            painting.use(preset);
            PaintStroke s;
            s.trace.flat = false;
            s.brush = preset.name;
            s.ink = std::string(how) == "paste" ? "titanium-white-paste" : "cobalt";
            s.settings.film = std::string(how) == "wet" ? FilmModel::wet : FilmModel::still;
            for (int i = 0; i <= 60; ++i) {
                const double f = i / 60.0;
                s.trace.samples.push_back(
                    {.time = 0.5 * f,
                     .position = {-0.012 + 0.024 * f, 0, preset.length * (1.01 - 0.14 * std::sin(pi * f))}});
            }
            const StrokeReport report = painting.paint(s);
            EXPECT_TRUE(report.touched()) << preset.name << " " << how;
            EXPECT_GT(report.ink_given, 0) << preset.name << " " << how;
            EXPECT_NEAR((report.ink_given + report.ink_left) / (preset.capacity * ink::kFilmPerVolume), 1, 1e-6)
                << preset.name << " " << how;
            if (std::string(how) == "eraser") {
                s.tool = Tool::eraser;
                const double before = painting.layers().canvas().total(model.texels, 0);
                painting.paint(s);
                EXPECT_LT(painting.layers().canvas().total(model.texels, 0), 0.3 * before) << preset.name;
            }
            set_thread_count(3);
            Document again(model, {.substrate = "porcelain"});
            again.use(brush::parse_preset(brush::preset_toml(preset), "project"));
            again.replay(painting.journal().entries());
            EXPECT_EQ(again.layers().canvas().hash(), painting.layers().canvas().hash()) << preset.name << " " << how;
        }
    set_thread_count(0);
}

// Two dabs at the same pose print the same picture, with whatever hair seed: pores are of the sponge. A turned one
// prints another.
TEST(Sponge, PrintsTheSamePictureAgain) {
    const Model model = sheet({}, 384);
    const auto inked = [&](std::uint64_t seed, double turn) {
        Document painting(model);
        PaintStroke s = dab({0, 0}, 3e-3);
        s.settings.film = FilmModel::still;
        s.settings.dip = DipMode::each;
        s.seed = seed;
        for (StrokeSample& sample : s.trace.samples) sample.rotation = glm::angleAxis(turn, Vec3{0, 0, 1});
        painting.paint(s);
        std::vector<bool> out;
        for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot) {
            const ink::Plane* plane = painting.layers().canvas().plane(slot, 0);
            for (int t = 0; t < atlas::kTileTexels; ++t) out.push_back(plane && (*plane)[t] > 0.3f);
        }
        return out;
    };
    const auto different = [](const std::vector<bool>& a, const std::vector<bool>& b) {
        std::size_t n = 0, all = 0;
        for (std::size_t i = 0; i < a.size(); ++i) n += a[i] != b[i], all += a[i] || b[i];
        return static_cast<double>(n) / static_cast<double>(std::max<std::size_t>(all, 1));
    };
    const std::vector<bool> first = inked(1, 0);
    EXPECT_LT(different(first, inked(2, 0)), 1e-3);
    EXPECT_GT(different(first, inked(1, 0.5 * pi)), 0.2);
}

// A full sponge that is dragged leaves a thin film with the streaks of its pores. As thick as where it is pressed on,
// it hid them.
TEST(Sponge, AFullOneThatIsDraggedLeavesStreaks) {
    const Model model = sheet();
    Document painting(model);
    painting.paint(line(kSponge + "*0.4", 2e-3));
    const ink::Canvas& canvas = painting.layers().canvas();
    const double film = painting.materials().ink("carbon").film;
    constexpr double kRow = 6e-5;  // metres, a texel
    std::vector<double> row(101), weight(101);
    double landed = 0, landed_area = 0;
    for (const std::uint32_t slot : canvas.touched_slots()) {
        const ink::Plane* plane = canvas.plane(slot, 0);
        for (int t = 0; plane && t < atlas::kTileTexels; ++t) {
            const Vec3 p(model.texels.position(slot, t));
            const double area = static_cast<double>(model.texels.tiles[slot].area[t]);
            // Landed on until the hand is 5 mm on its way, it slides from there to where it is lifted.
            if (glm::length(Vec2(p) - Vec2(-0.0115, 0)) < 3e-3) landed += area * (*plane)[t], landed_area += area;
            if (std::abs(p.x - 1e-3) > 2e-3 || std::abs(p.y) > 3e-3) continue;
            const auto k = static_cast<std::size_t>((p.y + 3e-3) / kRow);
            row[k] += area * (*plane)[t], weight[k] += area;
        }
    }
    double mean = 0, square = 0, rows = 0;
    for (std::size_t k = 0; k < row.size(); ++k)
        if (weight[k] > 0) mean += row[k] / weight[k], square += std::pow(row[k] / weight[k], 2), ++rows;
    mean /= rows;
    const double contrast = std::sqrt(std::max(0.0, square / rows - mean * mean)) / mean;
    RecordProperty("film", std::to_string(mean / film));
    RecordProperty("contrast", std::to_string(contrast));
    EXPECT_LT(mean, 0.7 * film);
    EXPECT_GT(mean, 0.05 * film);
    EXPECT_LT(mean, 0.5 * landed / landed_area) << "less than where it was pressed on";
    // 12 mm of skin with 45 % of its area in ridges of 0.1 mm: their share of a row is 45 % by about a tenth of it.
    EXPECT_GT(contrast, 0.08);
}

}  // namespace
}  // namespace tuft::stroke
