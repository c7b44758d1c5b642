#include "render/gl/gl_view.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "render/gl/gl_target.h"

namespace tuft::render {
namespace {

constexpr int kSamples = 4;
constexpr double kSlow = 0.025;  // seconds of one whole picture, above which a driver is spared
constexpr int kMargin = 3;       // pixels round a changed part that filtering reaches
constexpr double kSpare = 1.5;   // times the area of two parts up to which they are drawn as one
constexpr std::size_t kMostParts = 12;

/// The part of the picture that the hull of some points covers.
PixelRect part_of(const GlCamera& c, std::span<const Vec3f> points) {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const Vec3f& point : points) {
        const Vec3 p = picture_point(c, Vec3(point));
        if (p.z <= c.near) return {0, 0, c.width, c.height};
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    }
    const auto cut = [](double v, int most) { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most))); };
    // GL counts rows from below.
    const int left = cut(x0 - kMargin, c.width), right = cut(x1 + kMargin + 1, c.width);
    const int low = cut(c.height - y1 - kMargin, c.height), high = cut(c.height - y0 + kMargin + 1, c.height);
    return {left, low, right - left, high - low};
}

/// The same of a box.
PixelRect part_of(const GlCamera& c, const GlBox& box) {
    std::array<Vec3f, 8> corners;
    for (unsigned k = 0; k < 8; ++k)
        corners[k] = {k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y, k & 4 ? box.hi.z : box.lo.z};
    return part_of(c, corners);
}

PixelRect joined(const PixelRect& a, const PixelRect& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

double area(const PixelRect& r) {
    return static_cast<double>(r.width) * r.height;
}

/// Adds a part to others; parts that lie together become one.
void add(std::vector<PixelRect>& parts, PixelRect r) {
    if (r.empty()) return;
    for (std::size_t i = 0; i < parts.size();) {
        const PixelRect both = joined(parts[i], r);
        const bool near = area(both) <= kSpare * (area(parts[i]) + area(r)) || parts.size() >= kMostParts;
        if (!near) {
            ++i;
            continue;
        }
        r = both;
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
        i = 0;
    }
    parts.push_back(r);
}

}  // namespace

struct GlView::State {
    GlTarget smooth;  // the model, several samples per pixel
    GlTarget plain;   // the same, resolved
    GlTarget over;    // copy of a part of `smooth` with the tuft over it
    std::optional<GlCamera> camera;
    GlAppearance appearance;
    bool is_smooth = false, slow = false, warm = false;
    std::vector<GlBox> changed;
};

GlView::GlView() : state_(std::make_unique<State>()) {}
GlView::~GlView() = default;

void GlView::texture_changed(std::span<const GlBox> boxes) {
    state_->changed.insert(state_->changed.end(), boxes.begin(), boxes.end());
}
void GlView::scene_changed() {
    state_->camera.reset();
}

// A driver compiles what it needs when it needs it first: better now than under the first stroke.
void GlView::warm_up(GlScene& scene, const Frame& f) {
    State& s = *state_;
    const GlCamera& c = f.camera;
    const PixelRect middle{c.width / 2, c.height / 2, 1, 1};
    const GlBox everything{Vec3f(-1e30f), Vec3f(1e30f)};
    s.smooth.bind();
    if (!scene.has_glass())
        scene.redraw_model(c, f.appearance.light, f.appearance.options, middle, std::span(&everything, 1));
    const double depth = 1.1 * c.near, size = 0.01 * depth;
    const Vec3 at = c.eye + depth * c.forward;
    GlSolid solid{.positions = {Vec3f(at - size * c.right), Vec3f(at + size * c.right), Vec3f(at + size * c.up)},
                  .normals = std::vector<Vec3f>(3, Vec3f(-c.forward)),
                  .colours = std::vector<Vec3f>(3),
                  .triangles = {0, 1, 2}};
    s.over.resize(c.width, c.height, kSamples);
    s.smooth.copy_to(s.over, middle);
    s.over.bind();
    scene.draw_solid(c, f.appearance.light, solid, 0.5f);
    glFinish();
}

void GlView::draw(GlScene& scene, const Frame& f) {
    State& s = *state_;
    const GlCamera& c = f.camera;
    const PixelRect all{0, 0, c.width, c.height};
    const auto paint = [&](GlTarget& target, bool still) {
        target.bind();
        scene.draw_backdrop(c, f.appearance.low, f.appearance.high);
        scene.draw_model(c, f.appearance.light, f.appearance.options, still);
    };
    // What is behind glass must be drawn again under it.
    const bool through_glass = scene.has_glass() && !s.changed.empty();
    const bool same = s.camera && *s.camera == c && s.appearance == f.appearance && !through_glass;
    const bool spare = s.slow && f.moving;
    if (!same || (!s.is_smooth && !spare)) {
        const auto before = std::chrono::steady_clock::now();
        s.plain.resize(c.width, c.height, 0);
        if (spare) {
            paint(s.plain, false);
        } else {
            s.smooth.resize(c.width, c.height, kSamples);
            paint(s.smooth, !f.moving);
            s.smooth.copy_to(s.plain, all);
        }
        glFinish();
        if (!spare) s.slow = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count() > kSlow;
        s.is_smooth = !spare;
        s.camera = c;
        s.appearance = f.appearance;
        if (!spare && !std::exchange(s.warm, true)) warm_up(scene, f);
    } else if (!s.changed.empty() && f.appearance.options.shading != Shading::triangles) {
        std::vector<PixelRect> parts;
        for (const GlBox& box : s.changed) add(parts, part_of(c, box));
        for (const PixelRect& part : parts) {
            (s.is_smooth ? s.smooth : s.plain).bind();
            scene.redraw_model(c, f.appearance.light, f.appearance.options, part, s.changed);
            if (s.is_smooth) s.smooth.copy_to(s.plain, part);
        }
    }
    s.changed.clear();
    s.plain.resolve_to(f.framebuffer, all, f.x, f.y);
    if (!f.solid || f.solid->positions.empty() || f.opacity <= 0) return;
    // All points together: one beside the picture still spans triangles within it.
    const PixelRect part = part_of(c, f.solid->positions);
    if (part.empty()) return;
    GlTarget& under = s.is_smooth ? s.smooth : s.plain;
    s.over.resize(c.width, c.height, s.is_smooth ? kSamples : 0);
    under.copy_to(s.over, part);
    s.over.bind();
    scene.draw_solid(c, f.appearance.light, *f.solid, f.opacity);
    s.over.resolve_to(f.framebuffer, part, f.x, f.y);
}

}  // namespace tuft::render
