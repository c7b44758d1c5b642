#include "render/gl_view.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "render/gl_target.h"

namespace tuft::render {
namespace {

constexpr int kSamples = 4;
constexpr double kSlow = 0.025;  // seconds of one whole picture, above which a driver is spared
constexpr int kMargin = 3;       // pixels round a changed part that filtering reaches

void include(PixelRect& r, const GlCamera& c, const Vec3f& lo, const Vec3f& hi) {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (int k = 0; k < 8; ++k) {
        const Vec3 p = picture_point(c, Vec3(k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z));
        if (p.z <= c.near) {
            r = {0, 0, c.width, c.height};
            return;
        }
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    }
    const auto cut = [](double v, int most) { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most))); };
    // GL counts rows from below.
    const int left = cut(x0 - kMargin, c.width), right = cut(x1 + kMargin + 1, c.width);
    const int low = cut(c.height - y1 - kMargin, c.height), high = cut(c.height - y0 + kMargin + 1, c.height);
    if (right <= left || high <= low) return;
    if (r.empty()) {
        r = {left, low, right - left, high - low};
        return;
    }
    const int rx = std::max(r.x + r.width, right), ry = std::max(r.y + r.height, high);
    r.x = std::min(r.x, left);
    r.y = std::min(r.y, low);
    r.width = rx - r.x;
    r.height = ry - r.y;
}

}  // namespace

struct GlView::State {
    GlTarget smooth;   // the model, several samples per pixel
    GlTarget plain;    // the same, resolved
    GlTarget over;     // copy of a part of `smooth` with the tuft over it
    std::optional<GlCamera> camera;
    GlLook look;
    bool is_smooth = false, slow = false;
    std::vector<std::pair<Vec3f, Vec3f>> changed;
};

GlView::GlView() : state_(std::make_unique<State>()) {}
GlView::~GlView() = default;

void GlView::texture_changed(const Vec3f& lo, const Vec3f& hi) { state_->changed.emplace_back(lo, hi); }
void GlView::scene_changed() { state_->camera.reset(); }

void GlView::draw(GlScene& scene, const Frame& f) {
    State& s = *state_;
    const GlCamera& c = f.camera;
    const PixelRect all{0, 0, c.width, c.height};
    const auto paint = [&](GlTarget& target, const PixelRect& part) {
        target.bind();
        scene.draw_backdrop(c, f.look.low, f.look.high, part);
        scene.draw_model(c, f.look.light, f.look.options, part);
    };
    const bool same = s.camera && *s.camera == c && s.look == f.look;
    const bool spare = s.slow && f.moving;
    if (!same || (!s.is_smooth && !spare)) {
        const auto before = std::chrono::steady_clock::now();
        s.plain.resize(c.width, c.height, 0);
        if (spare) {
            paint(s.plain, all);
        } else {
            s.smooth.resize(c.width, c.height, kSamples);
            paint(s.smooth, all);
            s.smooth.copy_to(s.plain, all);
        }
        glFinish();
        if (!spare) s.slow = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count() > kSlow;
        s.is_smooth = !spare;
        s.camera = c;
        s.look = f.look;
    } else if (!s.changed.empty() && f.look.options.shading != Shading::triangles) {
        PixelRect part;
        for (const auto& [lo, hi] : s.changed) include(part, c, lo, hi);
        if (!part.empty()) {
            paint(s.is_smooth ? s.smooth : s.plain, part);
            if (s.is_smooth) s.smooth.copy_to(s.plain, part);
        }
    }
    s.changed.clear();
    s.plain.resolve_to(f.framebuffer, all, f.x, f.y);
    if (!f.solid || f.solid->positions.empty() || f.opacity <= 0) return;
    PixelRect part;
    for (const Vec3f& p : f.solid->positions) include(part, c, p, p);
    if (part.empty()) return;
    GlTarget& under = s.is_smooth ? s.smooth : s.plain;
    s.over.resize(c.width, c.height, s.is_smooth ? kSamples : 0);
    under.copy_to(s.over, part);
    s.over.bind();
    scene.draw_solid(c, f.look.light, *f.solid, f.opacity);
    s.over.resolve_to(f.framebuffer, part, f.x, f.y);
}

}  // namespace tuft::render
