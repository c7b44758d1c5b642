#include "render/brush/brush_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "brush/tuft/ferrule.h"
#include "core/text/units.h"
#include "render/brush/tuft_drawing.h"

namespace tuft::render {

using namespace brush;

namespace {

constexpr double kPressings[] = {0.02, 0.1, 0.2, 0.32, 0.45};  ///< depths over length
constexpr int kColumns = 6;
constexpr double kTilt = 0.45;    ///< radians
constexpr double kStride = 0.02;  ///< lengths between two samples
constexpr double kSample = 0.01;  ///< s

struct Posed {
    Tuft tuft;
    Pose pose;
    TuftState state;
    double depth = 0;
};

/// How a wide ferrule is moved: over its broad side, or along it.
enum class Side { broad, edge };

/// A brush in a hand over the sheet z = 0. `tilt` about y leans the holder ahead of a motion to the left,
/// `slant` about x leans it across.
struct SimulatedBrush {
    Posed now;
    double lowest = 0;  ///< of the root, where the lowest straight hair touches

    SimulatedBrush(const Preset& p, double tilt, double slant, Side side) {
        now.tuft = make_tuft(p, 3);
        now.pose.rotation = glm::angleAxis(-tilt, Vec3{0, 1, 0}) * glm::angleAxis(slant, Vec3{1, 0, 0});
        if (has_broad_side(now.tuft.preset) && side == Side::broad)
            now.pose.rotation = now.pose.rotation * glm::angleAxis(0.5 * std::numbers::pi, Vec3{0, 0, 1});
        lowest = p.length * -now.pose.axis().z;
        // A wide ferrule that leans along its broad side comes down on its corner.
        for (const FerruleSpine& set : ferrule_spines(p)) {
            const Vec3 hair = set.length * p.length * Vec3{std::sin(set.lean), 0, -std::cos(set.lean)};
            lowest = std::max(lowest, -(now.pose.rotation * (Vec3{set.x, set.y, 0} + hair)).z);
        }
        now.pose.position = {0, 0, lowest};
    }

    void move(double dx, double height) {
        const ContactPlane sheet;
        now.pose.position += Vec3{dx, 0, 0};
        now.pose.position.z = height;
        now.state = step(now.tuft, now.pose, {&sheet, 1}, kSample);
    }

    /// Pressed to `depth` while the hand moves to the left, then dragged until steady.
    void press(double depth) {
        now.depth = depth;
        const double stride = kStride * now.tuft.preset.length;
        const int pressing = 20 + static_cast<int>(std::ceil(depth / stride));
        for (int i = 0; i <= pressing + 150; ++i)
            move(-stride, lowest - depth * std::min(1.0, static_cast<double>(i) / pressing));
    }

    void lift(double height) {
        const double from = now.pose.position.z;
        for (int i = 1; i <= 60; ++i)
            move(-0.2 * kStride * now.tuft.preset.length, from + (lowest + height - from) * i / 60);
    }
};

std::string label(const char* format, double value) {
    char text[48];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// Everything in pixels of a picture 2000 wide times `unit`.
struct Sheet {
    BrushCanvas& canvas;
    const Preset& preset;
    double unit, width, column, scale;
    Vec3 ink = linear_colour(50, 46, 42), faint = linear_colour(120, 114, 106);

    void text(const std::string& words, Vec2 at, double size, const Vec3& colour) const {
        write_text(canvas, words, at, size * unit, colour);
    }
    void centred(const std::string& words, double x, double y, double size, const Vec3& colour) const {
        text(words, {x - 0.5 * text_width(words, size * unit), y}, size, colour);
    }
    void rule(double y) const {
        const double thick = 2 * unit;
        const Vec2 line[] = {{0, y}, {width, y}};
        stroke_line(canvas, line, {&thick, 1}, linear_colour(70, 66, 60));
    }
};

void draw_scale(const Sheet& sheet, const BrushView& view, double x0, double x1) {
    const Vec3 ink = linear_colour(90, 86, 80);
    const double thin = 1.1 * sheet.unit, y = view.foot.y;
    const double mm = view.scale * kMillimetre;
    for (int k = static_cast<int>(std::ceil((x0 - view.foot.x) / mm));
         k <= static_cast<int>(std::floor((x1 - view.foot.x) / mm)); ++k) {
        const double x = view.foot.x + k * mm, tall = (k % 10 == 0 ? 11 : k % 5 == 0 ? 8 : 4) * sheet.unit;
        const Vec2 tick[] = {{x, y}, {x, y + tall}};
        stroke_line(sheet.canvas, tick, {&thin, 1}, ink);
        if (k % 10 == 0) sheet.centred(std::to_string(std::abs(k)), x + sheet.unit, y + 24 * sheet.unit, 8.5, ink);
    }
}

/// Paper and, from `ground` on, the sheet; what the row below drew into this one goes.
void fill_row(const Sheet& sheet, double top, double ground, double bottom) {
    const Vec2 over[] = {{0, top}, {sheet.width, top}, {sheet.width, ground}, {0, ground}};
    fill_polygon(sheet.canvas, over, linear_colour(246, 243, 236));
    top = ground;
    const Vec2 under[] = {{0, top}, {sheet.width, top}, {sheet.width, bottom}, {0, bottom}};
    fill_polygon(sheet.canvas, under, linear_colour(233, 228, 216));
}

/// By what whole number a patch is drawn smaller, so that it leaves its label free; `space` in pixels.
int patch_reduction(const Preset& preset, double scale, double space) {
    constexpr double kSpread = 1.25;  // of the tuft's width, as far as it spreads under the deepest press
    const double width = tuft_width(preset) + 2 * preset.length * std::sin(preset.splay);
    return std::max(1, static_cast<int>(std::ceil(kSpread * width * scale / space)));
}

std::string reduced(const std::string& name, int times) {
    return times > 1 ? name + label(", patches %.0f times smaller", static_cast<double>(times)) : name;
}

/// One row from the side; `top` to `top` + 535 units.
void draw_row(const Sheet& sheet, double top, double tilt, Side side, const char* name) {
    const double u = sheet.unit, ground = top + 370 * u, plan = ground + 88 * u;
    const int smaller = patch_reduction(sheet.preset, sheet.scale, 112 * u);
    fill_row(sheet, top, ground, top + 535 * u);
    const double length = sheet.preset.length;
    for (int k = 0; k < kColumns; ++k) {
        const bool lifted = k + 1 == kColumns;
        SimulatedBrush brush(sheet.preset, tilt, 0, side);
        brush.press(kPressings[std::min(k, kColumns - 2)] * length);
        if (lifted) brush.lift(0.12 * length);
        const Posed& at = brush.now;
        // The scale begins under the tuft's root; where the holder leans, it begins at its axis'
        // foot.
        const double foot = std::tan(tilt) * at.pose.position.z;
        BrushView view;
        view.scale = sheet.scale;
        view.origin = {at.pose.position.x + foot, 0, 0};
        view.foot = {(k + 0.33) * sheet.column + 0.35 * sheet.scale * foot, ground};
        draw_brush(sheet.canvas, {at.tuft, at.state, at.pose}, view, 2.5 * length);
        draw_scale(sheet, view, (k + 0.02) * sheet.column, (k + 0.98) * sheet.column);
        BrushView below = view;
        below.scale /= smaller;
        if (at.state.touching) draw_patch(sheet.canvas, at.tuft, at.state, below, plan);
        // Under the patch of a wide tuft, which is as wide as the tuft.
        const double x = (k + 0.5) * sheet.column,
                     y = ground + (sheet.preset.spines > 1 || at.tuft.carried ? 161 : 152) * u;
        sheet.centred(
            lifted ? "lifted" : label("%.1f mm", at.depth / kMillimetre) + label("   %.2f N", at.state.normal_force), x,
            y, 12, sheet.ink);
    }
    sheet.rule(ground);
    // Over the handles' bands, so that it can be read.
    const Vec2 band[] = {{0, top}, {sheet.width, top}, {sheet.width, top + 40 * u}, {0, top + 40 * u}};
    fill_polygon(sheet.canvas, band, linear_colour(246, 243, 236));
    sheet.text(reduced(name, smaller), {24 * u, top + 27 * u}, 14, sheet.ink);
}

/// The tips of a writer's craft, seen from behind and above.
void draw_tips(const Sheet& sheet, double top) {
    constexpr double kDown = 0.5;  // radians the viewer looks down
    const double u = sheet.unit, length = sheet.preset.length, column = sheet.width / 4;
    const double ground = top + 330 * u;
    fill_row(sheet, top, top + 200 * u, top + 540 * u);
    const int smaller = patch_reduction(sheet.preset, 1.1 * sheet.scale, 130 * u);
    for (int k = 0; k < 4; ++k) {
        TuftAppearance appearance;
        SimulatedBrush brush(sheet.preset, k == 1 ? 0.2 : 0, k == 0 ? 0.7 : 0, Side::broad);
        std::string name = "slanted tip, along one side";
        if (k == 2) {
            brush.now.tuft.ink_left = 0.05;
            brush.now.tuft.wetness = 0.4;
            brush.now.tuft.preset.split_factor = 3;  // the paper's: shipped hair parts later, in bundles
            name = "split tip, short of ink";
        } else if (k == 3) {
            appearance.dry = true;
            brush.now.tuft.wetness = 0;
            for (double& apart : brush.now.tuft.bundles.separation) apart = 1;
            name = "dry tip, in bundles";
        }
        brush.press((k == 0 ? 0.25 : k == 1 ? 0.25 : k == 2 ? 0.42 : 0.34) * length);
        if (k == 1) {
            for (int i = 0; i < 12; ++i) brush.move(kStride * length, brush.now.pose.position.z);
            name = "reversed tip, pushed on";
        }
        const Posed& at = brush.now;
        BrushView view;
        view.scale = 1.1 * sheet.scale;
        view.origin = {at.pose.position.x, at.pose.position.y, 0};
        // The hair trails to the right, towards the viewer's side.
        view.right = glm::normalize(Vec3{0.55, 0.83, 0});
        const Vec3 back = glm::cross(view.right, Vec3{0, 0, 1});
        view.up = std::cos(kDown) * Vec3{0, 0, 1} - std::sin(kDown) * back;
        if (k == 1) {
            view.right = {1, 0, 0};
            view.up = {0, std::sin(0.25), std::cos(0.25)};
        }
        // A slanted holder stands aside from where its tip is.
        const double aside = view.scale * glm::dot(at.pose.axis(), view.right) * length;
        view.foot = {(k + 0.47) * column - 0.5 * aside, ground - 60 * u};
        draw_brush(sheet.canvas, {at.tuft, at.state, at.pose}, view, 2.5 * length, appearance);
        BrushView plan = view;
        plan.foot.x = (k + 0.42) * column;
        plan.scale /= smaller;
        double across = 0;
        for (const Branch& branch : at.state.branches) across += branch.sections[branch.sections.size() / 3].centre.y;
        plan.origin.y = across / static_cast<double>(at.state.branches.size());
        draw_patch(sheet.canvas, at.tuft, at.state, plan, top + 440 * u, appearance);
        sheet.centred(name, (k + 0.5) * column, top + 522 * u, 12, sheet.ink);
    }
    const Vec2 band[] = {{0, top}, {sheet.width, top}, {sheet.width, top + 40 * u}, {0, top + 40 * u}};
    fill_polygon(sheet.canvas, band, linear_colour(246, 243, 236));
    sheet.text(reduced("tips", smaller), {24 * u, top + 27 * u}, 14, sheet.ink);
}

}  // namespace

BrushPicture draw_tuft(const Preset& preset, int width) {
    width = std::clamp(width, 320, 8000);
    const double unit = width / 2000.0, row = 535 * unit, head = 54 * unit;
    // A shape of its own has no split or dry tip.
    const bool tips = !is_foam(preset) && !preset.geometry;
    const int height = static_cast<int>(std::ceil(head + (tips ? 4 : 3) * row));
    BrushCanvas canvas(width, height, linear_colour(246, 243, 236));
    const double column = static_cast<double>(width) / kColumns;
    const Sheet sheet{canvas, preset,
                      unit,   static_cast<double>(width),
                      column, 0.92 * column / std::max(1.3 * preset.length, is_foam(preset) ? 2.6 * preset.radius : 0)};
    if (tips) draw_tips(sheet, head + 3 * row);
    if (has_broad_side(preset)) {
        draw_row(sheet, head + 2 * row, kTilt, Side::edge, "leaning ahead, on its edge");
        draw_row(sheet, head + row, kTilt, Side::broad, "leaning ahead, on its broad side");
        draw_row(sheet, head, 0, Side::broad, "upright, on its broad side");
    } else {
        draw_row(sheet, head + 2 * row, -kTilt, Side::broad, "leaning back, pushed");
        draw_row(sheet, head + row, kTilt, Side::broad, "leaning ahead, pulled");
        draw_row(sheet, head, 0, Side::broad, "upright");
    }
    const Vec2 band[] = {{0, 0}, {sheet.width, 0}, {sheet.width, head}, {0, head}};
    fill_polygon(canvas, band, linear_colour(246, 243, 236));
    sheet.text(preset.name +
                   label(is_foam(preset) ? ", foam %.0f mm high" : ", hair %.0f mm long", preset.length / kMillimetre) +
                   (has_broad_side(preset) ? label(", %.0f mm wide", preset.width / kMillimetre) : "") +
                   label(", %.1f mm thick", 2 * preset.radius / kMillimetre),
               {24 * unit, 36 * unit}, 18, sheet.ink);
    return {width, height, to_srgb(canvas)};
}

}  // namespace tuft::render
