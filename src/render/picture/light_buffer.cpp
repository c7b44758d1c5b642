#include "render/picture/light_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/system/parallel.h"
#include "render/picture/sampling.h"

namespace tuft::render {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What comes to `p` from direction `d` but for the boxes.
Vec3f incoming(const Scene& scene, const LightCache& cache, const Vec3f& p, const Vec3f& d, const Vec2f& jitter,
               bool& hit_object) {
    const mesh::RayHit hit = scene.query.trace(p, d, 0, kInfinity);
    hit_object = hit.triangle != kNone;
    if (hit_object) {
        Vec3f n = face_normal(scene.mesh, hit.triangle);
        if (glm::dot(n, d) > 0) n = -n;
        Vec3f t, b;
        complete_frame(n, t, b);
        const Vec3f at = p + hit.distance * d + cache.voxel() * ((jitter.x - 0.5f) * t + (jitter.y - 0.5f) * b);
        return scene.material.albedo(hit.triangle, hit.b1, hit.b2) * cache.nearest_light(at, n);
    }
    if (d.z < -1e-4f && scene.studio.floor && p.z > scene.studio.floor_z) {
        const Vec3f at = p + (scene.studio.floor_z - p.z) / d.z * d;
        return scene.studio.floor_albedo * cache.floor_light(at.x, at.y);
    }
    return dome_radiance(scene.studio, d);
}

}  // namespace

LightSamples share_samples(int total) {
    total = std::clamp(total, 4, 4096);
    const int key = std::max(1, total / 4), other = std::max(1, total / 7);
    return {{key, other, other}, std::max(1, total - key - 2 * other)};
}

ViewHit trace_view_ray(const Scene& scene, const Camera& camera, const Vec3f& direction) {
    ViewHit s;
    const Vec3f eye(camera.eye);
    const mesh::RayHit hit = scene.query.trace(eye, direction, 0, kInfinity);
    if (hit.triangle != kNone) {
        s.kind = HitKind::object;
        s.triangle = hit.triangle;
        s.b1 = hit.b1;
        s.b2 = hit.b2;
        const auto& t = scene.mesh.triangles[hit.triangle];
        const Vec3f* corner = &scene.mesh.corner_normals[3 * std::size_t{hit.triangle}];
        const float b0 = 1 - hit.b1 - hit.b2;
        s.position =
            b0 * scene.mesh.positions[t[0]] + hit.b1 * scene.mesh.positions[t[1]] + hit.b2 * scene.mesh.positions[t[2]];
        s.face = face_normal(scene.mesh, hit.triangle);
        if (glm::dot(s.face, direction) > 0) s.face = -s.face;
        s.normal = b0 * corner[0] + hit.b1 * corner[1] + hit.b2 * corner[2];
        const float length = glm::length(s.normal);
        s.normal = length > 1e-6f ? s.normal / length : s.face;
        if (glm::dot(s.normal, s.face) < 0) s.normal = -s.normal;
        // A smooth normal may turn from the eye at a silhouette: bend it back to just visible.
        const float facing = -glm::dot(s.normal, direction);
        if (facing < 0.01f) s.normal = glm::normalize(s.normal - (facing - 0.01f) * -direction);
        return s;
    }
    if (scene.studio.floor && direction.z < -1e-5f && eye.z > scene.studio.floor_z) {
        s.position = eye + (scene.studio.floor_z - eye.z) / direction.z * direction;
        const Vec2f from_centre =
            Vec2f{s.position.x, s.position.y} - Vec2f{scene.studio.centre.x, scene.studio.centre.y};
        if (glm::length(from_centre) < 8 * scene.studio.radius) s.kind = HitKind::floor;
    }
    return s;
}

Light sample_light(const Scene& scene, const LightCache& cache, const ViewHit& at, const LightSamples& samples,
                   const PixelSeed& pixel) {
    const auto& [x, y, seed] = pixel;
    Light light;
    const bool floor = at.kind == HitKind::floor;
    const Vec3f start = at.position + scene.offset * at.face;
    for (std::size_t b = 0; b < samples.boxes.size(); ++b) {
        const Vec2f shift = lattice_shift(x, y, seed, b);
        Vec3f part{0};
        // On the floor errors of the lattice of shifts show as waves. More rays only where the first are stopped would
        // be cheaper, but darken the edges of shadows.
        const int n = (floor ? samples.on_floor : 1) * samples.boxes[b];
        for (int i = 0; i < n; ++i) {
            const Vec2f s = wrap(sobol_point(static_cast<std::uint32_t>(i)) + shift);
            const BoxSample l = sample_box(scene.studio.boxes[b], start, at.normal, s);
            if (!(l.light.y > 0)) continue;
            const bool blocked =
                glm::dot(l.direction, at.face) <= 0 || scene.query.blocked(start, l.direction, 0, l.distance);
            if (floor ? blocked : !blocked) part += floor ? -l.light : l.light;
        }
        light.direct += part / static_cast<float>(n);
    }
    const Vec2f turn = lattice_shift(x, y, seed, 3);
    const std::uint64_t jitter = hash_bits(seed, (static_cast<std::uint64_t>(x) << 32) + static_cast<std::uint64_t>(y));
    for (int i = 0; i < samples.around; ++i) {
        const Vec2f s = wrap(sobol_point(static_cast<std::uint32_t>(i)) + turn);
        Vec3f d = cosine_direction(at.normal, s);
        const float below = glm::dot(d, at.face);
        if (below < 1e-3f) d = glm::normalize(d + (2e-3f - below) * at.face);
        bool hit = false;
        const Vec3f in = incoming(scene, cache, start, d, hash_point(jitter, static_cast<std::uint64_t>(i)), hit);
        if (!floor)
            light.around += in;
        else if (hit)
            light.around += in - dome_radiance(scene.studio, d);
    }
    light.around /= static_cast<float>(samples.around);
    return light;
}

bool LightBuffer::find(float x, float y, const ViewHit& at, float pixel_size, Light& out) const {
    const auto per_square = static_cast<float>(step);
    const float px = x / per_square - 0.5f, py = y / per_square - 0.5f;
    pixel_size *= per_square;
    const int i0 = static_cast<int>(std::floor(px)), j0 = static_cast<int>(std::floor(py));
    Light sum;
    float total = 0;
    const auto add = [&](int i, int j, float weight) {
        if (i < 0 || j < 0 || i >= width || j >= height) return;
        const std::size_t k = static_cast<std::size_t>(j) * width + i;
        const ViewHit& there = hits[k];
        if (there.kind != at.kind) return;
        const float off = std::abs(glm::dot(at.face, there.position - at.position)) / (2 * pixel_size);
        const float cosine = glm::dot(at.normal, there.normal);
        if (off > 3 || cosine < 0.7f) return;
        weight *= std::exp(-off) * cosine * cosine * cosine * cosine * cosine * cosine * cosine * cosine;
        sum.direct += weight * light[k].direct;
        sum.around += weight * light[k].around;
        total += weight;
    };
    const float fx = px - static_cast<float>(i0), fy = py - static_cast<float>(j0);
    add(i0, j0, (1 - fx) * (1 - fy));
    add(i0 + 1, j0, fx * (1 - fy));
    add(i0, j0 + 1, (1 - fx) * fy);
    add(i0 + 1, j0 + 1, fx * fy);
    if (total < 0.02f)
        for (int j = -1; j <= 2; ++j)
            for (int i = -1; i <= 2; ++i) add(i0 + i, j0 + j, 0.1f);
    if (total < 1e-3f) return false;
    out.direct = sum.direct / total;
    out.around = sum.around / total;
    return true;
}

LightBuffer fill_light_buffer(const Scene& scene, const LightCache& cache, const Camera& camera,
                              const LightBufferOptions& options) {
    LightBuffer buffer;
    buffer.step = options.step;
    buffer.width = (camera.width + options.step - 1) / options.step;
    buffer.height = (camera.height + options.step - 1) / options.step;
    const auto width = static_cast<std::size_t>(buffer.width);
    const std::size_t n = width * static_cast<std::size_t>(buffer.height);
    buffer.hits.resize(n);
    buffer.light.resize(n);
    constexpr int kBand = 32;  // rows between two reports
    for (int top = 0; top < buffer.height; top += kBand) {
        report(options.progress, "light", static_cast<double>(top) / buffer.height);
        const int rows = std::min(kBand, buffer.height - top);
        parallel_for(static_cast<std::size_t>(rows) * width, 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t k = static_cast<std::size_t>(top) * width + i;
                const double x = options.step * (static_cast<double>(k % width) + 0.5);
                const double y = options.step * (static_cast<double>(k / width) + 0.5);
                ViewHit& s = buffer.hits[k];
                s = trace_view_ray(scene, camera, Vec3f(ray_direction(camera, x, y)));
                if (s.kind != HitKind::backdrop)
                    buffer.light[k] =
                        sample_light(scene, cache, s, options.samples,
                                     {static_cast<int>(k % width), static_cast<int>(k / width), options.seed});
            }
        });
    }
    if (buffer.step > 1) remove_specks(buffer, camera);
    smooth_light(buffer, camera);
    return buffer;
}

}  // namespace tuft::render
