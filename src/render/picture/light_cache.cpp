#include "render/picture/light_cache.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/system/parallel.h"
#include "render/picture/sampling.h"

namespace tuft::render {
namespace {

constexpr int kVoxels = 64;          // along the diagonal of the object
constexpr int kFloorGrid = 72;       // points along the side of the floor's grid
constexpr std::uint32_t kRays = 96;  // gathered per patch
constexpr int kBounces = 8;          // white porcelain keeps 0.86 at each

/// Which of the six axis directions a normal is nearest to.
int side_of(const Vec3f& n) {
    const Vec3f a = glm::abs(n);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (n[axis] < 0 ? 1 : 0);
}

}  // namespace

Vec3f face_normal(const mesh::TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const Vec3f n =
        glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    const float length = glm::length(n);
    return length > 0 ? n / length : Vec3f{0, 0, 1};
}

Vec3f direct_light(const Scene& scene, const Vec3f& p, const Vec3f& n, const std::array<int, 3>& samples,
                   const Vec2f& shift) {
    Vec3f sum{0};
    for (std::size_t b = 0; b < samples.size(); ++b) {
        Vec3f part{0};
        for (int i = 0; i < samples[b]; ++i) {
            const Vec2f s = wrap(sobol_point(static_cast<std::uint32_t>(i)) + shift);
            const BoxSample l = sample_box(scene.studio.boxes[b], p, n, s);
            if (l.light.y > 0 && !scene.query.blocked(p, l.direction, 0, l.distance)) part += l.light;
        }
        sum += part / static_cast<float>(samples[b]);
    }
    return sum;
}

LightCache::LightCache(const Scene& scene, Retain retain) {
    voxel_ = 2 * scene.studio.radius / kVoxels;
    origin_ = scene.studio.centre - Vec3f{1.5f * scene.studio.radius};
    floor_half_ = 3.2f * scene.studio.radius;
    floor_centre_ = {scene.studio.centre.x, scene.studio.centre.y};
    table_.assign(1 << 12, kNone);
    seed_patches(scene);
    if (scene.studio.floor) seed_floor(scene);
    link_nodes(scene);
    solve(scene);
    if (retain == Retain::links) return;
    links_ = {};
    dome_ = {};
}

void LightCache::relight(const Scene& scene) {
    if (scene.studio.floor) seed_floor(scene);
    solve(scene);
}

std::uint64_t LightCache::key(const Vec3f& p, int side) const {
    const Vec3f q = (p - origin_) / voxel_;
    const auto cell = [](float v) {
        return static_cast<std::uint64_t>(std::clamp(static_cast<int>(std::floor(v)), 0, (1 << 20) - 1));
    };
    return ((cell(q.x) << 40 | cell(q.y) << 20 | cell(q.z)) << 3) | static_cast<std::uint64_t>(side);
}

std::uint32_t LightCache::find(std::uint64_t key) const {
    const std::size_t mask = table_.size() - 1;
    for (std::size_t slot = hash_bits(key) & mask;; slot = (slot + 1) & mask)
        if (table_[slot] == kNone || keys_[table_[slot]] == key) return table_[slot];
}

void LightCache::insert(const Vec3f& p, const Vec3f& n) {
    const std::uint64_t k = key(p, side_of(n));
    if (find(k) != kNone) return;
    if (4 * (patches_.size() + 1) > table_.size()) {
        table_.assign(2 * table_.size(), kNone);
        const std::size_t mask = table_.size() - 1;
        for (std::uint32_t i = 0; i < keys_.size(); ++i) {
            std::size_t slot = hash_bits(keys_[i]) & mask;
            while (table_[slot] != kNone) slot = (slot + 1) & mask;
            table_[slot] = i;
        }
    }
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hash_bits(k) & mask;
    while (table_[slot] != kNone) slot = (slot + 1) & mask;
    table_[slot] = static_cast<std::uint32_t>(patches_.size());
    keys_.push_back(k);
    patches_.push_back({p, n, Vec3f{0}});
}

void LightCache::seed_patches(const Scene& scene) {
    // Evenly spaced along the running sum of areas: every patch that matters gets a point.
    const mesh::TriangleMesh& mesh = scene.mesh;
    const bool open = std::find(mesh.neighbours.begin(), mesh.neighbours.end(), kNone) != mesh.neighbours.end();
    const double area = mesh::surface_area(mesh);
    const double wanted = std::clamp(8 * area / (voxel_ * voxel_), 1e3, 4e5);
    const double step = area / wanted;
    double next = 0.5 * step, sum = 0;
    std::uint64_t count = 0;
    for (std::uint32_t t = 0; t < mesh.n_triangles() && step > 0; ++t) {
        const Vec3 a = mesh.position(t, 0), e1 = mesh.position(t, 1) - a, e2 = mesh.position(t, 2) - a;
        sum += 0.5 * glm::length(glm::cross(e1, e2));
        for (; next < sum; next += step) {
            Vec2f s = hash_point(17, count++);
            if (s.x + s.y > 1) s = Vec2f{1} - s;
            const auto at = mesh::surface_point(mesh, t, s.x, s.y);
            insert(Vec3f(at.position), Vec3f(at.normal));
            if (open) insert(Vec3f(at.position), -Vec3f(at.normal));
        }
    }
}

void LightCache::seed_floor(const Scene& scene) {
    const std::size_t n = std::size_t{kFloorGrid} * kFloorGrid;
    floor_.assign(n, Vec3f{0});
    open_floor_.assign(n, Vec3f{0});
    parallel_for(n, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec2f s{static_cast<float>(i % kFloorGrid), static_cast<float>(i / kFloorGrid)};
            const Vec2f xy = floor_centre_ + floor_half_ * (2.0f * s / static_cast<float>(kFloorGrid - 1) - 1.0f);
            open_floor_[i] = open_light(scene.studio, {xy.x, xy.y, scene.studio.floor_z}, {0, 0, 1});
        }
    });
}

/// A patch, or a point of the floor's grid after them.
LightCache::Patch LightCache::node(const Scene& scene, std::size_t index) const {
    if (index < patches_.size()) return patches_[index];
    const std::size_t k = index - patches_.size();
    const Vec2f s{static_cast<float>(k % kFloorGrid), static_cast<float>(k / kFloorGrid)};
    const Vec2f xy = floor_centre_ + floor_half_ * (2.0f * s / static_cast<float>(kFloorGrid - 1) - 1.0f);
    return {{xy.x, xy.y, scene.studio.floor_z}, {0, 0, 1}, Vec3f{0}};
}

/// Returns the dome's light on a patch. `links` gets one for each ray that meets another surface.
Vec3f LightCache::link_patch(const Scene& scene, const Patch& at, std::size_t index, std::vector<Link>& links) const {
    const Vec3f start = at.p + scene.offset * at.n;
    const Vec2f shift = hash_point(23, index);
    Vec3f dome{0};
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const Vec3f d = cosine_direction(at.n, wrap(sobol_point(i) + shift));
        const mesh::RayHit hit = scene.query.trace(start, d, 0, std::numeric_limits<float>::infinity());
        if (hit.triangle != kNone) {
            Vec3f n = face_normal(scene.mesh, hit.triangle);
            if (glm::dot(n, d) > 0) n = -n;
            const Vec3f p = start + hit.distance * d;
            const std::uint32_t patch = find(key(p, side_of(n)));
            if (patch != kNone) links.push_back({patch, scene.material.albedo(hit.triangle, hit.b1, hit.b2)});
        } else if (d.z < 0 && scene.studio.floor && start.z > scene.studio.floor_z) {
            const Vec3f p = start + (scene.studio.floor_z - start.z) / d.z * d;
            const Vec2f g = (Vec2f{p.x, p.y} - floor_centre_) / floor_half_ * 0.5f + 0.5f;
            if (g.x < 0 || g.y < 0 || g.x > 1 || g.y > 1) {
                dome += dome_radiance(scene.studio, d);
            } else {
                const auto cell = [](float v) { return static_cast<std::uint32_t>(v * (kFloorGrid - 1) + 0.5f); };
                links.push_back({kFloorLink + cell(g.y) * kFloorGrid + cell(g.x), scene.studio.floor_albedo});
            }
        } else {
            dome += dome_radiance(scene.studio, d);
        }
    }
    return dome / static_cast<float>(kRays);
}

void LightCache::link_nodes(const Scene& scene) {
    links_.resize(n_nodes());
    dome_.resize(n_nodes());
    dome_scale_ = scene.studio.scale;
    parallel_for(n_nodes(), 32, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) dome_[i] = link_patch(scene, node(scene, i), i, links_[i]);
    });
}

void LightCache::solve(const Scene& scene) {
    const std::size_t n_object = patches_.size(), n = n_nodes();
    std::vector<Vec3f> own(n), light(n), next(n);
    parallel_for(n, 32, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Patch at = node(scene, i);
            own[i] = direct_light(scene, at.p + scene.offset * at.n, at.n, {16, 8, 8}, hash_point(23, i)) +
                     scene.studio.scale / dome_scale_ * dome_[i];
        }
    });
    light = own;
    for (int bounce = 0; bounce < kBounces; ++bounce) {
        for (std::size_t i = 0; i < n; ++i) {
            Vec3f sum{0};
            for (const Link& l : links_[i])
                sum += l.albedo * light[l.patch & kFloorLink ? n_object + (l.patch - kFloorLink) : l.patch];
            next[i] = own[i] + sum / static_cast<float>(kRays);
        }
        std::swap(light, next);
    }
    mean_ = Vec3f{0};
    for (std::size_t i = 0; i < n_object; ++i) {
        patches_[i].light = light[i];
        mean_ += light[i] / static_cast<float>(n_object);
    }
    std::copy(light.begin() + static_cast<std::ptrdiff_t>(n_object), light.end(), floor_.begin());
}

Vec3f LightCache::nearest_light(const Vec3f& p, const Vec3f& n) const {
    const std::uint32_t patch = find(key(p, side_of(n)));
    return patch != kNone ? patches_[patch].light : object_light(p, n);
}

Vec3f LightCache::object_light(const Vec3f& p, const Vec3f& n) const {
    const Vec3f q = (p - origin_) / voxel_ - 0.5f;
    const Vec3f base = glm::floor(q), f = q - base;
    Vec3f sum{0};
    float total = 0, behind = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3f o(static_cast<float>(corner & 1), static_cast<float>((corner >> 1) & 1),
                      static_cast<float>(corner >> 2));
        const Vec3f w3 = o * f + (1.0f - o) * (1.0f - f);
        const float w = w3.x * w3.y * w3.z + 1e-4f;
        const Vec3f at = origin_ + voxel_ * (base + o + 0.5f);
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(n[axis]) < 0.3f) continue;
            const std::uint32_t patch = find(key(at, 2 * axis + (n[axis] < 0 ? 1 : 0)));
            if (patch == kNone) {
                behind += find(key(at, 2 * axis + (n[axis] < 0 ? 0 : 1))) != kNone ? w : 0.0f;
                continue;
            }
            const float facing = std::max(0.0f, glm::dot(n, patches_[patch].n));
            const float weight = w * facing * facing * facing;
            sum += weight * patches_[patch].light;
            total += weight;
        }
    }
    if (total > 1e-7f) return sum / total;
    return behind > 0 ? Vec3f{0} : mean_;  // the inner side of a closed wall is dark
}

Vec3f LightCache::read_floor(const std::vector<Vec3f>& grid, float x, float y) const {
    const Vec2f g = glm::clamp((Vec2f{x, y} - floor_centre_) / floor_half_ * 0.5f + 0.5f, 0.0f, 1.0f) *
                    static_cast<float>(kFloorGrid - 1);
    const int i = std::min(static_cast<int>(g.x), kFloorGrid - 2), j = std::min(static_cast<int>(g.y), kFloorGrid - 2);
    const float a = g.x - static_cast<float>(i), b = g.y - static_cast<float>(j);
    const Vec3f* row = &grid[static_cast<std::size_t>(j * kFloorGrid + i)];
    return (1 - b) * ((1 - a) * row[0] + a * row[1]) + b * ((1 - a) * row[kFloorGrid] + a * row[kFloorGrid + 1]);
}

Vec3f LightCache::floor_light(float x, float y) const {
    return floor_.empty() ? Vec3f{0} : read_floor(floor_, x, y);
}

Vec3f LightCache::open_floor_light(float x, float y) const {
    return open_floor_.empty() ? Vec3f{1} : read_floor(open_floor_, x, y);
}

}  // namespace tuft::render
