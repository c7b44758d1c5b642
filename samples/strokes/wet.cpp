#include <cmath>
#include <numbers>

#include "brush/preset/preset.h"
#include "compositions.h"
#include "core/text/units.h"
#include "hand.h"

namespace tuft::samples {

namespace {

using stroke::BrushAction;
using stroke::Dry;
using stroke::Preparation;

constexpr double kSquare = 1;      // metres: keys are in millimetres
constexpr double kRedTip = 0.085;  // of the tuft's length

const Dry kDry{};

struct How {
    const char* brush = "goat-medium";
    const char* ink = "carbon";
    WriteOptions options = {};
    std::vector<Preparation> before = {};
};

/// Writes strokes on one place of a model, keys in millimetres from it.
struct Writer {
    stroke::Placement place;
    std::vector<stroke::RecordedStroke> out = {};

    void add(const Stroke& s, const How& how) {
        WriteOptions options = how.options;
        options.size = kSquare;
        options.centre = {0, 0};
        stroke::RecordedStroke t = write(s, WidthTable(brush::load_preset(how.brush)), options);
        t.placement = place;
        t.brush = how.brush;
        t.ink = how.ink;
        t.seed = out.size() + 1;
        t.label = s.name;
        t.before = how.before;
        out.push_back(std::move(t));
    }
};

Writer on_sheet(double x, double y) {
    return {{{x * kMillimetre, y * kMillimetre, 0}, {1, 0, 0}, {0, -1, 0}, stroke::SurfaceMapping::wrap}};
}

Stroke band(const char* name, Vec2 from, Vec2 to, double width) {
    const Vec2 chord = to - from;
    const auto at = [&](double f, double w) { return Key{from.x + f * chord.x, from.y + f * chord.y, w}; };
    return {name, {at(0, 0), at(0.05, 0.3 * width), at(0.25, 0.8 * width), at(0.5, width), at(0.88, width), at(1, 0)}};
}

/// Pressed with the tip outwards, drawn to the heart and lifted there.
Stroke petal(double turn, double from, double length, double width) {
    const Vec2 u{std::sin(turn), -std::cos(turn)}, v{-u.y, u.x};
    const auto at = [&](double f, double side, double w, double pace) {
        const Vec2 p = (from + (1 - f) * length) * u + side * length * v;
        return Key{p.x, p.y, w, pace};
    };
    return {"petal",
            {at(0, 0, 0, 0.5), at(0.12, 0.02, 0.45 * width, 0.5), at(0.4, 0.05, width, 0.6),
             at(0.7, 0.03, 0.7 * width, 0.9), at(1, 0, 0, 1)}};
}

void append(std::vector<stroke::RecordedStroke>& to, Writer&& w) {
    for (stroke::RecordedStroke& t : w.out) to.push_back(std::move(t));
}

}  // namespace

std::vector<stroke::RecordedStroke> wet_sheet() {
    std::vector<stroke::RecordedStroke> out;
    // Petals: yellow in the belly, red in the tip.
    Writer flower = on_sheet(-50, 40);
    for (int k = 0; k < 5; ++k)
        flower.add(petal(2 * std::numbers::pi * (k + 0.1) / 5, 5, 27, 11),
                   {.brush = "mixed-large",
                    .ink = "samples/inks/gamboge-wash.toml",
                    .options = {.speed = 0.03},
                    .before = {BrushAction{.what = stroke::Wipe{.depth = kRedTip, .amount = 0.95}},
                               BrushAction{.what = stroke::Dip{.depth = kRedTip}, .ink = "cinnabar"}}});
    append(out, std::move(flower));
    // Three glazes, each over the dry one below.
    Writer glazes = on_sheet(48, 40);
    const char* inks[] = {"samples/inks/gamboge-wash.toml", "samples/inks/iron-red-wash.toml",
                          "samples/inks/indigo-wash.toml"};
    for (int k = 0; k < 3; ++k) {
        const double a = (k * 60 + 10) * kDegree;
        const Vec2 u{std::cos(a), std::sin(a)};
        glazes.add(band("glaze", -30.0 * u, 30.0 * u, 17),
                   {.brush = "mixed-large*1.6", .ink = inks[k], .options = {.speed = 0.06}, .before = {kDry}});
    }
    append(out, std::move(glazes));
    // A wet stripe, and a clean wet brush drawn through it.
    Writer smear = on_sheet(-50, -45);
    smear.add(
        {"stripe",
         {{-31, -9.5, 0}, {-29.8, -9.7, 2.5}, {-21, -11.2, 9}, {-8, -12, 8}, {13, -6, 8}, {26, -9, 5}, {31, -13, 0}}},
        {.brush = "mixed-medium", .ink = "indigo"});
    const double starts[] = {-19, -1, 17};
    for (const double x : starts)
        smear.add({"clean brush",
                   {{x, -20, 0}, {x + 0.5, -18, 5}, {x + 2, -8, 8}, {x + 1, 8, 8}, {x - 4, 20, 5}, {x - 8, 27, 0}}},
                  {.brush = "mixed-medium", .ink = "water", .options = {.speed = 0.04}});
    append(out, std::move(smear));
    // Fast and half dry: the bristles show.
    Writer sweep = on_sheet(45, -45);
    const double amounts[] = {0.74, 0.82};
    for (int k = 0; k < 2; ++k) {
        const double y = 22.0 * k - 12;
        sweep.add({"dry sweep",
                   {{-36, y + 5, 0, 0.5},
                    {-34, y + 4, 5, 0.4},
                    {-28, y + 1, 9, 1},
                    {-5, y - 5, 9, 1},
                    {18, y - 3, 8, 1},
                    {40, y - 9, 0, 1}}},
                  {.brush = k ? "goat-medium" : "wolf-large",
                   .options = {.speed = 0.25, .acceleration = 6},
                   .before = {BrushAction{.what = stroke::Wipe{.amount = amounts[k]}}}});
    }
    append(out, std::move(sweep));
    return out;
}

std::vector<stroke::RecordedStroke> wet_bowl() {
    const double radius = 68.4, height = 44.5, turn = -6 * kDegree;  // a seam of the atlas runs up the bowl there
    Writer w{{{radius * std::sin(turn) * kMillimetre, -radius * std::cos(turn) * kMillimetre, height * kMillimetre},
              {std::cos(turn), std::sin(turn), 0},
              {0, 0, -1},
              stroke::SurfaceMapping::wrap}};
    w.add({"wet ground", {{-26, -8, 0}, {-22, -9, 8}, {0, -11, 13}, {22, -7, 8}, {26, -6, 0}}},
          {.brush = "mixed-large", .ink = "water"});
    w.add({"wet ground", {{-27, 3, 0}, {-22, 2, 8}, {0, 0, 14}, {22, 3, 8}, {27, 4, 0}}},
          {.brush = "mixed-large", .ink = "water"});
    w.add({"indigo", {{-20, -4, 0}, {-17, -5, 6}, {-8, -6, 12}, {2, -3, 10}, {8, -1, 0}}},
          {.brush = "mixed-large", .ink = "indigo"});
    w.add({"gamboge", {{-6, 6, 0}, {-3, 5, 6}, {5, 3, 12}, {14, 2, 9}, {20, -1, 0}}},
          {.brush = "mixed-large", .ink = "gamboge"});
    w.add({"cinnabar", {{6, -10, 0}, {8, -9, 5}, {11, -7, 8}, {13, -5, 0}}},
          {.brush = "mixed-medium", .ink = "cinnabar"});
    w.add({"drop of water", {{-12, -5, 0}, {-11, -4, 4}, {-10, -3, 7}, {-9, -1, 0}}},
          {.brush = "mixed-medium", .ink = "water", .before = {Dry{5}}});
    return std::move(w.out);
}

std::vector<stroke::RecordedStroke> backrun() {
    Writer w = on_sheet(0, 0);
    w.add(band("wash", {-34, 0}, {34, 1}, 28),
          {.brush = "mixed-large*2.6", .ink = "samples/inks/indigo-wash.toml", .options = {.speed = 0.05}});
    // When it has lost its shine, clean water.
    const double drops[][2] = {{-13, 3}, {12, -4}};
    for (const auto& [x, y] : drops)
        w.add(
            {"drop of water", {{x - 1, y, 0, 0.5}, {x, y, 5, 0.5}, {x + 1, y + 0.5, 6, 0.5}, {x + 2, y + 0.5, 0, 0.5}}},
            {.brush = "mixed-large",
             .ink = "water",
             .options = {.speed = 0.02},
             .before =
                 x < 0 ? std::vector<Preparation>{Dry{25},
                                                  BrushAction{.what = stroke::Dip{.amount = 1.02}, .ink = "water"}}
                       : std::vector<Preparation>{BrushAction{.what = stroke::Dip{.amount = 1.02}, .ink = "water"}}});
    return std::move(w.out);
}

std::vector<stroke::RecordedStroke> wet_vase() {
    Writer w{{{0, -66.7 * kMillimetre, 118 * kMillimetre}, {1, 0, 0}, {0, 0, -1}, stroke::SurfaceMapping::wrap}};
    // Dripping wet: what the hair does not hold runs down the wall.
    w.add({"dripping stroke",
           {{-32, 2, 0, 0.6},
            {-29, 1, 7, 0.5},
            {-18, -3, 12, 0.6},
            {-4, -1, 9, 1},
            {10, 3, 11, 0.7},
            {24, 0, 8, 1},
            {36, -5, 0, 1}}},
          {.brush = "mixed-large",
           .ink = "indigo",
           .options = {.speed = 0.03},
           .before = {BrushAction{.what = stroke::Dip{.amount = 1.045}, .ink = "indigo"}}});
    return std::move(w.out);
}

}  // namespace tuft::samples
