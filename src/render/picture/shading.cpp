#include "render/picture/shading.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/picture/sampling.h"

namespace tuft::render {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNormalReflectance = 0.04f;  // of a coat with refractive index 1.5

float fresnel(float cosine) {
    const float m = 1 - std::clamp(cosine, 0.0f, 1.0f), m2 = m * m;
    return kNormalReflectance + (1 - kNormalReflectance) * m2 * m2 * m;
}

/// Keeps values to 0.8 and takes the rest smoothly to below 1.
float shoulder(float v) {
    return v <= 0.8f ? std::max(v, 0.0f) : 1 - 0.2f * std::exp(-(v - 0.8f) / 0.2f);
}

/// What a smooth coat mirrors from direction d.
Vec3f mirrored(const Shading& f, const Vec3f& p, const Vec3f& d, float roughness, TileReads* reads) {
    const mesh::RayHit hit = f.scene.query.trace(p, d, 0, kInfinity);
    if (hit.triangle != kNone) {
        Vec3f n = face_normal(f.scene.mesh, hit.triangle);
        if (glm::dot(n, d) > 0) n = -n;
        return f.seen.albedo(hit.triangle, hit.b1, hit.b2, reads) * f.cache.object_light(p + hit.distance * d, n);
    }
    const Studio& studio = f.scene.studio;
    if (d.z < -1e-4f && studio.floor && p.z > studio.floor_z) {
        const Vec3f at = p + (studio.floor_z - p.z) / d.z * d;
        const Vec3f floor = studio.floor_albedo * f.cache.floor_light(at.x, at.y);
        // Far floor runs into the wall, as a seamless backdrop does.
        const float far = glm::length(at - studio.centre) / (6 * studio.radius);
        const float blend = std::clamp(far - 0.5f, 0.0f, 1.0f);
        return glm::mix(floor, dome_radiance(studio, d), blend);
    }
    return dome_radiance(studio, d) + box_radiance(studio, p, d, roughness);
}

Vec3f shade_object(const Shading& f, const ViewHit& s, Light light, const Vec3f& view, TileReads* reads) {
    const Material m = f.seen.read(s.triangle, s.b1, s.b2, reads);
    Vec3f n = s.normal;
    if (m.slope != Vec3f{0}) {
        n = glm::normalize(n - m.slope);
        const Vec3f key = glm::normalize(f.scene.studio.boxes[0].centre - s.position);
        const float before = std::max(glm::dot(s.normal, key), 0.05f);
        light.direct *= std::clamp(glm::dot(n, key) / before, 0.0f, f.scene.studio.raking ? 1 / before : 2.0f);
    }
    if (f.scene.studio.raking) {
        const SoftBox& lamp = f.scene.studio.boxes[0];
        const Vec3f key = lamp.centre - s.position;
        const float away = glm::length(key);
        light.direct *= f.seen.unshaded(s.triangle, s.b1, s.b2, s.normal, key / away, glm::length(lamp.u) / away);
    }
    const Vec3f body = m.albedo * (light.direct + light.around);
    const float cosine = glm::dot(n, view);
    if (!f.seen.coated()) return body;
    float reflectance = fresnel(cosine);
    // A rough coat mirrors less at grazing angles and, when matt, nothing to speak of.
    reflectance = glm::mix(reflectance, std::min(reflectance, 0.1f), m.roughness) *
                  (1 - std::clamp((m.roughness - 0.5f) * 2, 0.0f, 1.0f));
    if (reflectance < 1e-3f) return body;
    Vec3f d = 2 * cosine * n - view;
    const float above = glm::dot(d, s.face);
    if (above < 0.02f) d = glm::normalize(d + (0.02f - above) * s.face);
    const Vec3f seen = mirrored(f, s.position + f.scene.offset * s.face, d, m.roughness, reads);
    return (1 - reflectance) * body + reflectance * seen;
}

Vec3f shade(const Shading& f, float x, float y, std::uint64_t seed, TileReads* reads) {
    const Vec3f direction(ray_direction(f.camera, x, y));
    const ViewHit s = trace_view_ray(f.scene, f.camera, direction);
    const Vec3f back = backdrop(x / static_cast<float>(f.camera.width), y / static_cast<float>(f.camera.height));
    if (s.kind == HitKind::backdrop) return back;
    Light light;
    const float pixel = f.pixel_angle * glm::length(s.position - Vec3f(f.camera.eye));
    if (!f.buffer.find(x, y, s, pixel, light))
        light = sample_light(f.scene, f.cache, s, share_samples(2 * f.options.light_samples),
                             {static_cast<int>(x), static_cast<int>(y), seed});
    if (s.kind == HitKind::object) return shade_object(f, s, light, -direction, reads);
    const Vec3f open = f.cache.open_floor_light(s.position.x, s.position.y);
    return back * glm::max(1.0f + (light.direct + light.around) / open, 0.02f);
}

/// sRGB code values of linear light that is kept below 1.
Vec3f shown_codes(const Vec3f& light) {
    return {encode_srgb(light.x), encode_srgb(light.y), encode_srgb(light.z)};
}

/// Extremes of the colours of a pixel's rays, and what they read.
struct PixelRays {
    TileReads* reads = nullptr;
    Vec3f lo{kInfinity}, hi{-kInfinity};
};

/// The sum of rays [from, to) of a pixel under a tent filter of radius one pixel; clipped light, so that
/// bright edges come out smooth. Widens the range of `rays` by their colours.
Vec3f draw_rays(const Shading& f, const PixelSeed& pixel, int from, int to, PixelRays& rays) {
    const Vec2f shift = hash_point(pixel.seed, 0);
    const auto tent = [](float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); };
    Vec3f sum{0};
    for (int n = from; n < to; ++n) {
        const Vec2f s = wrap(sobol_point(static_cast<std::uint32_t>(n)) + shift);
        const float x = static_cast<float>(pixel.x) + 0.5f + tent(s.x),
                    y = static_cast<float>(pixel.y) + 0.5f + tent(s.y);
        const Vec3f c = shade(f, x, y, hash_bits(pixel.seed, static_cast<std::uint64_t>(n) + 1), rays.reads);
        const Vec3f shown{shoulder(c.x), shoulder(c.y), shoulder(c.z)};
        sum += shown;
        rays.lo = glm::min(rays.lo, shown);
        rays.hi = glm::max(rays.hi, shown);
    }
    return sum;
}

}  // namespace

// A quarter of `edge_samples` rays do where neither they nor the pixels round it (`on_edge`) show contrast. Elsewhere
// rays are doubled until both halves of them, each of which covers the pixel evenly, agree: a highlight thinner than
// the pixel is met by few.
Vec3f shade_pixel(const Shading& f, bool on_edge, int x, int y, TileReads* reads) {
    constexpr float kContrast = 8.0f / 255, kAgreement = 5.0f / 255;  // codes: the eye sees most where it is dark
    constexpr int kMostRays = 8;                                      // times edge_samples
    const PixelSeed pixel{x, y, hash_bits(f.options.seed + 1, static_cast<std::uint64_t>(y) * f.camera.width + x)};
    PixelRays rays{.reads = reads};
    int n = std::max(1, f.options.edge_samples / 4);
    Vec3f sum = draw_rays(f, pixel, 0, n, rays);
    if (!on_edge && glm::length(shown_codes(rays.hi) - shown_codes(rays.lo)) < kContrast)
        return shown_codes(sum / static_cast<float>(n));
    while (n < kMostRays * f.options.edge_samples) {
        const Vec3f more = draw_rays(f, pixel, n, 2 * n, rays);
        const Vec3f gap =
            glm::abs(shown_codes(sum / static_cast<float>(n)) - shown_codes(more / static_cast<float>(n)));
        sum += more;
        n *= 2;
        if (n >= f.options.edge_samples && std::max({gap.x, gap.y, gap.z}) < kAgreement) break;
    }
    return shown_codes(sum / static_cast<float>(n));
}

Vec3f shade_middle(const Shading& f, int x, int y, TileReads* reads) {
    const std::uint64_t k =
        static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(f.camera.width) + static_cast<std::uint64_t>(x);
    const Vec3f c =
        shade(f, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, hash_bits(f.options.seed + 3, k), reads);
    return shown_codes({shoulder(c.x), shoulder(c.y), shoulder(c.z)});
}

PixelCode pixel_code(const Vec3f& code, std::uint64_t seed, std::size_t pixel) {
    const float dither = static_cast<float>(uniform(seed + 2, pixel));
    PixelCode out;
    for (int c = 0; c < 3; ++c)
        out[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::clamp(code[c] * 255 + dither, 0.0f, 255.0f));
    return out;
}

}  // namespace tuft::render
