#include "brush/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "brush/canvas.h"
#include "brush/skin.h"
#include "brush/tuft.h"
#include "core/random.h"
#include "core/units.h"

namespace tuft::brush {

namespace {

constexpr double kPressings[] = {0.02, 0.1, 0.2, 0.32, 0.45};  ///< depths over length
constexpr int kHairs = 420;
constexpr int kBetween = 5;   ///< sections drawn between two nodes

struct Pressed {
    Pose pose;
    TuftState state;
    double depth = 0;
};

/// Pressed to `depth` while the hand moves to the left, then dragged until steady.
Pressed press(const Preset& p, double depth, double tilt) {
    Pressed out;
    out.depth = depth;
    Tuft tuft = make_tuft(p);
    const ContactPlane sheet;
    const double stride = 0.02 * p.length, tip = p.length * std::cos(tilt);
    const int pressing = 20 + static_cast<int>(std::ceil(depth / stride));
    out.pose.rotation = glm::angleAxis(-tilt, Vec3{0, 1, 0});
    for (int i = 0; i <= pressing + 150; ++i) {
        const double part = std::min(1.0, static_cast<double>(i) / pressing);
        out.pose.position = {-stride * i, 0, tip - depth * part};
        out.state = step(tuft, out.pose, {&sheet, 1}, 0.01);
    }
    return out;
}

/// From metres beside the foot of the holder's axis to pixels of one column.
struct View {
    Vec2 foot{0};        ///< pixel of the axis' foot on the ground
    double scale = 1;    ///< pixels per metre
    double root_x = 0;   ///< metres
    Vec2 operator()(const Vec3& p) const { return foot + scale * Vec2{p.x - root_x, -p.z}; }
    Vec2 plan(const Vec3& p, double y0) const {
        return {foot.x + scale * (p.x - root_x), y0 + scale * p.y};
    }
};

/// Half width of a section seen from the side, along the picture's normal to the spine.
Vec2 half_side(const Section& s) {
    const Vec2 t{s.tangent.x, s.tangent.z};
    const double length = glm::length(t);
    if (length < 1e-6) return {s.a, 0};
    const Vec2 across = Vec2{-t.y, t.x} / length;
    const double pe = s.a * (s.e.x * across.x + s.e.z * across.y);
    const double pm = s.b * (s.m.x * across.x + s.m.z * across.y);
    return std::hypot(pe, pm) * across;
}

void draw_hair(Canvas& canvas, const std::vector<Section>& fine, const View& view, std::uint64_t seed) {
    Random random(seed);
    std::vector<Vec2> line(fine.size());
    std::vector<double> width(fine.size());
    for (int hair = 0; hair < kHairs; ++hair) {
        const double angle = random.uniform(0, 2 * std::numbers::pi), reach = std::sqrt(random.uniform());
        const double end = random.uniform();
        // Hairs of unequal length: the outer ones end before the tip.
        const auto stop = static_cast<std::size_t>(end * end * 0.35 * reach * static_cast<double>(fine.size()));
        line.clear();
        width.clear();
        double lit = 0;
        for (std::size_t i = stop; i < fine.size(); ++i) {
            const Section& s = fine[i];
            const Vec3 p = s.centre + 0.97 * reach * (s.a * std::cos(angle) * s.e + s.b * std::sin(angle) * s.m);
            line.push_back(view(p));
            const double part = static_cast<double>(i - stop) / static_cast<double>(fine.size());
            width.push_back(0.5 + 1.1 * std::min(1.0, 4 * part));
            lit += s.m.z * std::sin(angle) - 0.35 * (s.m.x * std::sin(angle) + s.e.x * std::cos(angle));
        }
        if (line.size() < 2) continue;
        lit /= static_cast<double>(line.size());
        const double tone = std::clamp(0.45 + 0.4 * lit * reach + random.uniform(-0.22, 0.22), 0.0, 1.0);
        const Vec3 colour = glm::mix(srgb(52, 36, 26), srgb(196, 158, 112), tone);
        stroke_line(canvas, line, width, colour, 0.75);
    }
}

void draw_tuft_side(Canvas& canvas, const Pressed& pressed, const View& view, std::uint64_t seed) {
    for (const Branch& branch : pressed.state.branches) {
        const std::vector<Section> fine = refine_sections(branch.sections, kBetween);
        std::vector<Vec2> outline;
        for (const Section& s : fine) {
            const Vec2 h = half_side(s);
            outline.push_back(view(s.centre + Vec3{h.x, 0, h.y}));
        }
        for (std::size_t i = fine.size(); i-- > 0;) {
            const Vec2 h = half_side(fine[i]);
            outline.push_back(view(fine[i].centre - Vec3{h.x, 0, h.y}));
        }
        fill_polygon(canvas, outline, srgb(88, 62, 44));
        draw_hair(canvas, fine, view, seed);
    }
}

void draw_holder(Canvas& canvas, const Pose& pose, const Preset& p, const View& view) {
    const Vec3 up = -pose.axis(), side = pose.rotation * Vec3{1, 0, 0};
    const double r = 1.12 * rest_radius(p, 0);
    const auto bar = [&](double from, double to, double w0, double w1, const Vec3& dark, const Vec3& light) {
        constexpr int kShades = 24;
        for (int k = 0; k < kShades; ++k) {
            const double a = -1 + 2.0 * k / kShades, b = -1 + 2.0 * (k + 1) / kShades, mid = 0.5 * (a + b);
            const double shade = std::max(0.0, std::sqrt(1 - mid * mid) * 0.8 - 0.25 * mid);
            const Vec2 quad[] = {view(pose.position + from * up + a * w0 * side),
                                 view(pose.position + from * up + b * w0 * side),
                                 view(pose.position + to * up + b * w1 * side),
                                 view(pose.position + to * up + a * w1 * side)};
            fill_polygon(canvas, quad, glm::mix(dark, light, shade));
        }
    };
    bar(0.22 * p.length, 2.5 * p.length, 0.92 * r, 0.88 * r, srgb(96, 66, 34), srgb(222, 184, 120));
    bar(0, 0.24 * p.length, r, 1.04 * r, srgb(28, 28, 32), srgb(150, 150, 158));
}

/// The contact patch seen from above, as ink.
void draw_patch(Canvas& canvas, const Pressed& pressed, const View& view, double y0) {
    for (const Branch& branch : pressed.state.branches) {
        std::vector<Vec2> left, right;
        for (const Section& s : refine_sections(branch.sections, kBetween)) {
            const double ne = s.a * s.e.z, nm = s.b * s.m.z, reach = std::hypot(ne, nm);
            if (reach <= 0 || std::abs(s.centre.z) > reach) continue;
            const double middle = std::atan2(nm, ne), half = std::acos(-s.centre.z / reach);
            Vec3 q[2];
            for (int k = 0; k < 2; ++k) {
                const double w = middle + (k == 0 ? -half : half);
                q[k] = s.centre + s.a * std::cos(w) * s.e + s.b * std::sin(w) * s.m;
            }
            if (q[0].y > q[1].y) std::swap(q[0], q[1]);
            left.push_back(view.plan(q[0], y0));
            right.push_back(view.plan(q[1], y0));
        }
        left.insert(left.end(), right.rbegin(), right.rend());
        fill_polygon(canvas, left, srgb(24, 22, 24));
    }
}

void draw_scale(Canvas& canvas, const View& view, double x0, double x1, double y) {
    const Vec3 ink = srgb(90, 86, 80);
    const double thin = 1.2;
    const double mm = view.scale * kMillimetre;
    const int from = static_cast<int>(std::ceil((x0 - view.foot.x) / mm));
    const int to = static_cast<int>(std::floor((x1 - view.foot.x) / mm));
    for (int k = from; k <= to; ++k) {
        const double x = view.foot.x + k * mm, tall = k % 10 == 0 ? 12 : k % 5 == 0 ? 8 : 4;
        const Vec2 tick[] = {{x, y}, {x, y + tall}};
        stroke_line(canvas, tick, {&thin, 1}, ink);
        if (k % 10 == 0) {
            const std::string text = std::to_string(std::abs(k));
            write_text(canvas, text, {x - 0.5 * text_width(text, 9) + 1, y + 26}, 9, ink);
        }
    }
}

std::string label(const char* format, double value) {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

}  // namespace

Picture draw_tuft(const Preset& preset, const PictureOptions& options) {
    const int width = std::clamp(options.width, 320, 8000), height = std::clamp(options.height, 180, 8000);
    Canvas canvas(width, height, srgb(246, 243, 236));
    constexpr int kColumns = std::size(kPressings);
    const double column = static_cast<double>(width) / kColumns;
    const double ground = 0.72 * height, plan = 0.865 * height;
    const double scale = std::min(0.56 * height / preset.length, 0.92 * column / (0.95 * preset.length));
    const Vec2 under[] = {{0, ground}, {width * 1.0, ground}, {width * 1.0, height * 1.0}, {0, height * 1.0}};
    fill_polygon(canvas, under, srgb(233, 228, 216));
    for (int k = 0; k < kColumns; ++k) {
        const Pressed pressed = press(preset, kPressings[k] * preset.length, options.tilt);
        View view;
        view.scale = scale;
        view.foot = {(k + 0.28) * column, ground};
        // The origin is the foot of the holder's axis; where the holder leans, it moves aside.
        const double foot = std::tan(options.tilt) * pressed.pose.position.z;
        view.root_x = pressed.pose.position.x + foot;
        view.foot.x += 0.7 * scale * foot;
        draw_holder(canvas, pressed.pose, preset, view);
        draw_tuft_side(canvas, pressed, view, 7 + k);
        draw_patch(canvas, pressed, view, plan);
        draw_scale(canvas, view, (k + 0.02) * column, (k + 0.98) * column, ground);
        const Vec3 ink = srgb(50, 46, 42);
        write_text(canvas, label("%.1f mm", pressed.depth / kMillimetre), {(k + 0.12) * column, 0.96 * height}, 13, ink);
        write_text(canvas, label("%.2f N", pressed.state.normal_force), {(k + 0.60) * column, 0.96 * height}, 13, ink);
    }
    const double thick = 2;
    const Vec2 line[] = {{0, ground}, {width * 1.0, ground}};
    stroke_line(canvas, line, {&thick, 1}, srgb(70, 66, 60));
    return {width, height, to_srgb(canvas)};
}

}  // namespace tuft::brush
