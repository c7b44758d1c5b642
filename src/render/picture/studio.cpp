#include "render/picture/studio.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ease.h"
#include "render/picture/sampling.h"

namespace tuft::render {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Brightness over a box at (s, t) in units of its half axes.
float profile(float s, float t, float edge) {
    const float a = smooth_step((1 + edge - std::abs(s)) / (2 * edge));
    const float b = smooth_step((1 + edge - std::abs(t)) / (2 * edge));
    return a * b * (1 - 0.18f * std::min(s * s + t * t, 2.0f));
}

SoftBox make_box(const Vec3f& at, const Vec3f& aim, float half_width, float half_height, const Vec3f& radiance) {
    SoftBox box;
    box.centre = at;
    box.normal = glm::normalize(aim - at);
    Vec3f side = glm::cross(Vec3f{0, 0, 1}, box.normal);
    side = glm::length(side) > 1e-3f ? glm::normalize(side) : Vec3f{1, 0, 0};
    box.u = half_width * side;
    box.v = half_height * glm::normalize(glm::cross(box.normal, side));
    box.radiance = radiance;
    return box;
}

}  // namespace

Studio make_studio(const Box& bounds, double azimuth, double turn, bool floor, double exposure) {
    Studio s;
    s.centre = Vec3f(bounds.centre());
    s.radius = std::max(static_cast<float>(0.5 * bounds.diagonal()), 1e-6f);
    s.floor = floor;
    s.floor_z = static_cast<float>(bounds.empty() ? 0 : bounds.lo.z);
    const double a = azimuth + turn;
    const Vec3f right(std::cos(a), std::sin(a), 0), away(-std::sin(a), std::cos(a), 0), up(0, 0, 1);
    const float r = s.radius;
    const auto at = [&](float x, float y, float z) { return s.centre + r * (x * right + y * away + z * up); };
    s.boxes[0] = make_box(at(-2.0f, -1.8f, 2.2f), s.centre, 1.35f * r, 1.0f * r, {9.0f, 8.85f, 8.6f});
    s.boxes[1] = make_box(at(2.9f, -1.5f, 0.9f), s.centre, 0.6f * r, 1.3f * r, {3.6f, 3.68f, 3.85f});
    s.boxes[2] = make_box(at(0.7f, 3.0f, 1.7f), s.centre, 1.7f * r, 0.5f * r, {4.2f, 4.25f, 4.35f});

    const Vec3f to_key = glm::normalize(s.boxes[0].centre - s.centre);
    const Vec3f light = open_light(s, s.centre, glm::normalize(to_key + up));
    const float mean = (light.x + light.y + light.z) / 3;
    s.scale = static_cast<float>(exposure) * 1.06f / mean;
    for (SoftBox& box : s.boxes) box.radiance *= s.scale;
    return s;
}

Studio make_raking_studio(const Box& bounds, const RakingLight& light) {
    const auto& [right, up, forward, turn, floor, exposure] = light;
    constexpr float kGrazing = 0.23f;         // sine of the lamp's height over a face that looks at the camera
    constexpr float kFar = 6, kLamp = 0.35f;  // radii
    Studio s;
    s.centre = Vec3f(bounds.centre());
    s.radius = std::max(static_cast<float>(0.5 * bounds.diagonal()), 1e-6f);
    s.floor = floor;
    s.floor_z = static_cast<float>(bounds.empty() ? 0 : bounds.lo.z);
    s.raking = true;
    s.dome = 0.3f;
    const auto c = static_cast<float>(std::cos(turn)), d = static_cast<float>(std::sin(turn));
    // A little from above, as light falls.
    const Vec3f side = glm::normalize(-right + 0.35f * up);
    const Vec3f turned = c * side + d * glm::normalize(glm::cross(-forward, -side));
    const Vec3f at = std::sqrt(1 - kGrazing * kGrazing) * turned - kGrazing * forward;
    s.boxes[0] = make_box(s.centre + kFar * s.radius * at, s.centre, kLamp * s.radius, kLamp * s.radius,
                          Vec3f{330.0f, 322.0f, 308.0f});
    for (int k = 1; k < 3; ++k)  // switched off
        s.boxes[k] = make_box(s.centre - kFar * s.radius * forward, s.centre, s.radius, s.radius, Vec3f{0});
    const Vec3f received = open_light(s, s.centre, -forward);
    s.scale = static_cast<float>(exposure) * 0.62f * 3 / (received.x + received.y + received.z);
    for (SoftBox& box : s.boxes) box.radiance *= s.scale;
    return s;
}

Vec3f dome_radiance(const Studio& studio, const Vec3f& d) {
    // Grey walls that grow lighter towards a white ceiling, a little darker behind the object.
    const float h = smooth_step(0.5f + 0.5f * d.z);
    const Vec3f low{0.19f, 0.194f, 0.20f}, high{0.52f, 0.53f, 0.545f};
    return studio.scale * studio.dome * glm::mix(low, high, h);
}

Vec3f box_radiance(const Studio& studio, const Vec3f& origin, const Vec3f& direction, float roughness) {
    Vec3f sum{0};
    for (const SoftBox& box : studio.boxes) {
        const float facing = -glm::dot(direction, box.normal);
        if (facing <= 1e-3f) continue;
        const float t = glm::dot(origin - box.centre, box.normal) / facing;
        if (t <= 0) continue;
        const Vec3f d = origin + t * direction - box.centre;
        const float uu = glm::dot(box.u, box.u), vv = glm::dot(box.v, box.v);
        // A rough coat spreads a mirror direction over about roughness² radians.
        const float blur = 1.5f * roughness * roughness * t;
        const float edge_u = SoftBox::kEdge + blur / std::sqrt(uu), edge_v = SoftBox::kEdge + blur / std::sqrt(vv);
        const float su = std::abs(glm::dot(d, box.u)) / uu, sv = std::abs(glm::dot(d, box.v)) / vv;
        if (su >= 1 + edge_u || sv >= 1 + edge_v) continue;
        // A blur wider than the box dims it: keep the area under the profile.
        const float dim = 1 / (std::max(1.0f, edge_u) * std::max(1.0f, edge_v));
        const float inside = (1 - 0.18f * std::min(su * su + sv * sv, 2.0f));
        sum += box.radiance * (dim * inside * smooth_step((1 + edge_u - su) / (2 * edge_u)) *
                               smooth_step((1 + edge_v - sv) / (2 * edge_v)));
    }
    return sum;
}

BoxSample sample_box(const SoftBox& box, const Vec3f& p, const Vec3f& n, const Vec2f& s) {
    constexpr float kReach = 1 + SoftBox::kEdge;
    const float a = kReach * (2 * s.x - 1), b = kReach * (2 * s.y - 1);
    BoxSample out;
    const Vec3f d = box.centre + a * box.u + b * box.v - p;
    const float d2 = glm::dot(d, d);
    out.distance = std::sqrt(d2);
    out.direction = d / out.distance;
    const float cos_n = glm::dot(n, out.direction), cos_box = -glm::dot(box.normal, out.direction);
    if (cos_n <= 0 || cos_box <= 0) return out;
    const float area = 4 * kReach * kReach * glm::length(box.u) * glm::length(box.v);
    out.light = box.radiance * (profile(a, b, SoftBox::kEdge) * cos_n * cos_box * area / (d2 * kPi));
    return out;
}

Vec3f open_light(const Studio& studio, const Vec3f& p, const Vec3f& n) {
    constexpr std::uint32_t kSamples = 64;
    Vec3f sum{0};
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec2f s = sobol_point(i) + Vec2f{0.5f / kSamples};
        for (const SoftBox& box : studio.boxes) sum += sample_box(box, p, n, s).light;
        const Vec3f d = cosine_direction(n, s);
        sum += d.z < 0 && studio.floor ? studio.floor_albedo * studio.scale * 1.5f : dome_radiance(studio, d);
    }
    return sum / static_cast<float>(kSamples);
}

Vec3f backdrop(float x, float y) {
    const float glow = std::exp(-1.6f * ((x - 0.5f) * (x - 0.5f) * 1.6f + (y - 0.42f) * (y - 0.42f) * 1.2f));
    const Vec3f dark{0.235f, 0.24f, 0.25f}, light{0.50f, 0.505f, 0.51f};
    return glm::mix(dark, light, glow * (0.75f + 0.25f * smooth_step(y)));
}

}  // namespace tuft::render
