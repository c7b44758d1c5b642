#include "render/picture/brush_in_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "brush/preset/rest_shape.h"
#include "core/system/parallel.h"
#include "render/brush/tuft_drawing.h"
#include "render/picture/material.h"

namespace tuft::render {
namespace {

/// A point of the brush's middle line.
struct AxisPoint {
    Vec2 at{0};             ///< pixels
    double depth = 0;       ///< metres along the camera's axis
    double half_width = 0;  ///< metres
};

/// From the tip to the end of the holder.
std::vector<AxisPoint> axis_of(const Camera& camera, const brush::Tuft& tuft, const brush::TuftState& state,
                               double length) {
    std::vector<AxisPoint> axis;
    const auto add = [&](const Vec3& p, double half_width) {
        if (const auto seen = project(camera, p)) axis.push_back({{seen->x, seen->y}, seen->z, half_width});
    };
    const double radius = std::max(tuft.preset.radius, 0.5 * tuft.preset.width);
    if (!state.branches.empty())
        for (const brush::Section& s : state.branches[state.branches.size() / 2].sections)
            add(s.centre, std::max(s.a, s.b));
    add(tuft.pose.position, radius);
    add(tuft.pose.position - length * tuft.pose.axis(), radius);
    return axis;
}

/// The axis point nearest to a picture position.
AxisPoint nearest_on(const std::vector<AxisPoint>& axis, const Vec2& at) {
    AxisPoint best = axis.front();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < axis.size(); ++i) {
        const Vec2 d = axis[i + 1].at - axis[i].at;
        const double size = glm::dot(d, d);
        const double s = size > 0 ? std::clamp(glm::dot(at - axis[i].at, d) / size, 0.0, 1.0) : 0;
        const Vec2 off = at - (axis[i].at + s * d);
        if (glm::dot(off, off) >= least) continue;
        least = glm::dot(off, off);
        best = {at, std::lerp(axis[i].depth, axis[i + 1].depth, s),
                std::lerp(axis[i].half_width, axis[i + 1].half_width, s)};
    }
    return best;
}

/// Part of a pixel in which the brush lies before the model.
float visible_part(const Camera& camera, const mesh::SurfaceQuery& query, const std::vector<AxisPoint>& axis, int x,
                   int y) {
    constexpr double kWithin = 0.7;      // of the half-width: hair on the surface is not hidden by it
    constexpr double kLeastBias = 2e-4;  // metres
    constexpr int kSide = 2;
    const AxisPoint here = nearest_on(axis, {x + 0.5, y + 0.5});
    const double bias = std::max(kLeastBias, kWithin * here.half_width);
    int seen = 0;
    for (int k = 0; k < kSide * kSide; ++k) {
        const Vec3 d = ray_direction(camera, x + (k % kSide + 0.5) / kSide, y + (k / kSide + 0.5) / kSide);
        const mesh::RayHit hit = query.trace(Vec3f(camera.eye), Vec3f(d), 0, std::numeric_limits<float>::infinity());
        seen += hit.triangle == kNone || double{hit.distance} * glm::dot(d, camera.forward) > here.depth - bias;
    }
    return static_cast<float>(seen) / (kSide * kSide);
}

/// Part of the picture in pixels: left, top, width, height.
struct Part {
    int x = 0, y = 0, width = 0, height = 0;
};

Part part_round(const std::vector<AxisPoint>& axis, double margin, const Image& image) {
    Vec2 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
    for (const AxisPoint& p : axis) {
        lo = glm::min(lo, p.at - margin);
        hi = glm::max(hi, p.at + margin);
    }
    lo = glm::clamp(lo, Vec2{0}, Vec2{image.width, image.height});
    hi = glm::clamp(hi, Vec2{0}, Vec2{image.width, image.height});
    const int x = static_cast<int>(std::floor(lo.x)), y = static_cast<int>(std::floor(lo.y));
    return {x, y, static_cast<int>(std::ceil(hi.x)) - x, static_cast<int>(std::ceil(hi.y)) - y};
}

std::array<float, 256> make_linear_of_code() {
    std::array<float, 256> linear;
    for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = decode_srgb(static_cast<float>(i) / 255);
    return linear;
}

/// What decides where the brush is seen.
struct BrushScene {
    const Camera& camera;
    const mesh::SurfaceQuery& query;
    const std::vector<AxisPoint>& axis;
    Part part;
};

std::size_t first_channel(const Image& image, const Part& part, std::size_t k) {
    const std::size_t x = k % static_cast<std::size_t>(part.width), y = k / static_cast<std::size_t>(part.width);
    return 3 * ((static_cast<std::size_t>(part.y) + y) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(part.x) + x);
}

/// Writes the pixels of the part that drawing changed, as far as the brush is before the model.
void blend_visible(Image& image, const BrushScene& scene, const std::vector<float>& before,
                   const std::vector<float>& drawn) {
    const Part& part = scene.part;
    parallel_for(before.size() / 3, 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const float *now = &drawn[3 * k], *was = &before[3 * k];
            if (std::equal(now, now + 3, was)) continue;
            const float seen = visible_part(scene.camera, scene.query, scene.axis,
                                            part.x + static_cast<int>(k % static_cast<std::size_t>(part.width)),
                                            part.y + static_cast<int>(k / static_cast<std::size_t>(part.width)));
            if (seen <= 0) continue;
            std::uint8_t* out = &image.rgb[first_channel(image, part, k)];
            for (std::size_t c = 0; c < 3; ++c)
                out[c] = static_cast<std::uint8_t>(
                    std::clamp(255 * encode_srgb(std::lerp(was[c], now[c], seen)) + 0.5f, 0.0f, 255.0f));
        }
    });
}

}  // namespace

void draw_brush_in_picture(Image& image, const Camera& camera, const mesh::SurfaceQuery& query, const brush::Tuft& tuft,
                           const brush::TuftState& state, double length) {
    const std::vector<AxisPoint> axis = axis_of(camera, tuft, state, length);
    if (axis.size() < 2) return;
    const Vec3 tip =
        state.branches.empty() ? tuft.pose.position : state.branches[state.branches.size() / 2].sections.front().centre;
    const auto foot = project(camera, tip);
    if (!foot) return;
    const double scale = camera.height / (2 * camera.tan_half_height * foot->z);
    double reach = std::max(tuft.preset.width, 2 * tuft.preset.radius);  // hair splays beyond the middle line
    for (const brush::Branch& branch : state.branches)
        for (const brush::Section& s : branch.sections)
            reach = std::max(reach, glm::length(s.centre - tip) - tuft.preset.length + 2 * tuft.preset.radius);
    const Part part = part_round(axis, 4 + scale * (reach + 0.25 * tuft.preset.length), image);
    if (part.width <= 0 || part.height <= 0) return;

    static const std::array<float, 256> linear = make_linear_of_code();
    BrushCanvas canvas(part.width, part.height, Vec3{0});
    for (std::size_t k = 0; k < canvas.rgb.size() / 3; ++k)
        for (std::size_t c = 0; c < 3; ++c)
            canvas.rgb[3 * k + c] = linear[image.rgb[first_channel(image, part, k) + c]];
    const std::vector<float> before = canvas.rgb;
    // Sheared axes: a point farther off lies nearer to the middle of the picture.
    const Vec3 sight = (tip - camera.eye) / foot->z;
    const BrushView view{.foot = Vec2{foot->x - part.x, foot->y - part.y},
                         .origin = tip,
                         .scale = scale,
                         .right = camera.right - glm::dot(sight, camera.right) * camera.forward,
                         .up = camera.up - glm::dot(sight, camera.up) * camera.forward};
    draw_brush(canvas, {tuft, state, tuft.pose}, view, length, {.ground = -std::numeric_limits<double>::infinity()});

    blend_visible(image, {camera, query, axis, part}, before, canvas.rgb);
}

}  // namespace tuft::render
