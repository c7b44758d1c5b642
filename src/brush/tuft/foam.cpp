#include "brush/tuft/foam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ease.h"
#include "core/random.h"
#include "core/text/units.h"

namespace tuft::brush {

namespace {

using std::numbers::pi;

constexpr int kFaceCells = 44;  ///< across the face
constexpr int kSideRings = 8;   ///< from the rim to the mouth
constexpr double kOpen = 0.8;   ///< volume of all pores over that of the foam, overlaps counted twice: 55 % open
constexpr double kCoarse = 6e-3, kFine = 2.5e-3;  ///< m, wavelengths of the unevenness
constexpr double kPoresFrom = 0.02;               ///< of the height from the mouth; above is the glued end

std::uint64_t cell_seed(std::uint64_t seed, const glm::i64vec3& cell) {
    const auto part = [](std::int64_t v) { return static_cast<std::uint64_t>(v + (1 << 20)); };
    return hash_bits(hash_bits(hash_bits(seed, part(cell.x)), part(cell.y)), part(cell.z));
}

/// Value noise in [0, 1), smooth over one unit.
double noise(std::uint64_t seed, const Vec3& p) {
    const Vec3 base = glm::floor(p), f{fade(p.x - base.x), fade(p.y - base.y), fade(p.z - base.z)};
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
        const glm::i64vec3 corner{k & 1, k >> 1 & 1, k >> 2};
        const double weight = (corner.x ? f.x : 1 - f.x) * (corner.y ? f.y : 1 - f.y) * (corner.z ? f.z : 1 - f.z);
        sum += weight * uniform(cell_seed(seed, glm::i64vec3(base) + corner));
    }
    return sum;
}

/// By how much the skin is recessed at a place of the material, metres.
double recess(const Preset& p, const Vec3& at) {
    if (!(p.unevenness > 0)) return 0;
    const auto seed = static_cast<std::uint64_t>(p.pore_seed);
    return p.unevenness * (0.6 * noise(hash_bits(seed, 1), at / kCoarse) + 0.4 * noise(hash_bits(seed, 2), at / kFine));
}

/// Depth of a cylinder's face at radius r, metres.
double face_depth(const Preset& p, double r) {
    double depth = p.length;
    if (p.dome > 0) depth -= p.dome - std::sqrt(p.dome * p.dome - r * r);
    const double over = r - (p.radius - p.rim);
    if (over > 0 && p.rim > 0) depth -= p.rim - std::sqrt(std::max(0.0, p.rim * p.rim - over * over));
    return depth;
}

/// The unit square onto the unit disc, area for area [Shirley1997].
Vec2 disc_point(double a, double b) {
    if (a == 0 && b == 0) return Vec2{0};
    if (std::abs(a) > std::abs(b)) {
        const double w = pi / 4 * b / a;
        return a * Vec2{std::cos(w), std::sin(w)};
    }
    const double w = pi / 4 * a / b;
    return b * Vec2{std::sin(w), std::cos(w)};
}

/// A closed cylinder along −z with the preset's face.
void make_cylinder(const Preset& p, CarriedShape& body) {
    constexpr int n = kFaceCells;
    const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const Vec2 q = p.radius * disc_point(2.0 * i / n - 1, 2.0 * j / n - 1);
            Vec3 point{q, -face_depth(p, glm::length(q))};
            point.z += recess(p, point);
            body.rest.push_back(point);
        }
    // Seen from below, which is outside.
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            body.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
            body.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
        }
    std::vector<std::uint32_t> ring;  // the rim, anticlockwise seen from above
    for (int i = 0; i < n; ++i) ring.push_back(at(i, 0));
    for (int j = 0; j < n; ++j) ring.push_back(at(n, j));
    for (int i = n; i > 0; --i) ring.push_back(at(i, n));
    for (int j = n; j > 0; --j) ring.push_back(at(0, j));
    const std::size_t count = ring.size();
    for (int k = 1; k <= kSideRings; ++k) {
        std::vector<std::uint32_t> upper;
        for (const std::uint32_t v : ring) {
            const Vec3 low = body.rest[v];
            upper.push_back(static_cast<std::uint32_t>(body.rest.size()));
            body.rest.emplace_back(low.x, low.y, low.z * (kSideRings - k) / (kSideRings - k + 1));
        }
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t next = (i + 1) % count;
            body.triangles.push_back({ring[i], ring[next], upper[next]});
            body.triangles.push_back({ring[i], upper[next], upper[i]});
        }
        ring = std::move(upper);
    }
    const auto middle = static_cast<std::uint32_t>(body.rest.size());
    body.rest.emplace_back(0, 0, 0);
    for (std::size_t i = 0; i < count; ++i) body.triangles.push_back({ring[i], ring[(i + 1) % count], middle});
}

/// A geometry whose skin is recessed.
void take_geometry(const Preset& p, CarriedShape& body) {
    body.triangles = p.geometry->triangles;
    for (const Vec3& point : p.geometry->points) {
        Vec3 q = kMillimetre * point;
        const double up = recess(p, q);
        q.z = std::min(0.0, q.z + up * std::clamp(-2 * q.z / p.length, 0.0, 1.0));
        body.rest.push_back(q);
    }
}

/// Grid of pores: one sphere in each cell.
struct PoreGrid {
    std::uint64_t seed;
    double least, most;  // m, radii
    double pitch;        // m

    explicit PoreGrid(const Preset& p)
        : seed(hash_bits(static_cast<std::uint64_t>(p.pore_seed), 3)), least(0.5 * p.pore_min), most(0.5 * p.pore_max) {
        // Mean of r³ of radii between both.
        const double cube = (least + most) * (least * least + most * most) / 4;
        pitch = std::cbrt(4 * pi / 3 * cube / kOpen);
    }
    Vec4 sphere(const glm::i64vec3& cell) const {
        const std::uint64_t own = cell_seed(seed, cell);
        return {pitch * (Vec3(cell) + Vec3{uniform(own, 0), uniform(own, 1), uniform(own, 2)}),
                least + (most - least) * uniform(own, 3)};
    }
};

/// Adds the pores that a triangle of the skin cuts.
void cut_pores(const PoreGrid& grid, std::uint32_t index, CarriedShape& body) {
    const auto& t = body.triangles[index];
    const Vec3 &p = body.rest[t[0]], u = body.rest[t[1]] - p, v = body.rest[t[2]] - p, n = glm::cross(u, v);
    const double twice = glm::length(n);
    if (!(twice > 0)) return;
    Box box;
    for (const std::uint32_t k : t) box.add(body.rest[k]);
    const glm::i64vec3 lo(glm::floor((box.lo - grid.most) / grid.pitch)),
        hi(glm::floor((box.hi + grid.most) / grid.pitch));
    for (std::int64_t z = lo.z; z <= hi.z; ++z)
        for (std::int64_t y = lo.y; y <= hi.y; ++y)
            for (std::int64_t x = lo.x; x <= hi.x; ++x) {
                const Vec4 sphere = grid.sphere({x, y, z});
                const Vec3 off = Vec3(sphere) - p;
                const double away = glm::dot(off, n) / twice;
                if (std::abs(away) >= sphere.w) continue;
                const double b = glm::dot(glm::cross(off, v), n) / (twice * twice),
                             c = glm::dot(glm::cross(u, off), n) / (twice * twice);
                if (b < 0 || c < 0 || b + c >= 1) continue;
                body.pores.push_back({index, {b, c}, std::sqrt(sphere.w * sphere.w - away * away)});
            }
}

void make_pores(const Preset& p, CarriedShape& body) {
    const PoreGrid grid(p);
    for (std::uint32_t i = 0; i < body.triangles.size(); ++i) {
        const auto& t = body.triangles[i];
        const bool low =
            std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return body.rest[v].z < -kPoresFrom * p.length; });
        if (low) cut_pores(grid, i, body);
    }
}

}  // namespace

double foam_stress(double solid, double strain) {
    const double dense = densification_strain(solid), rest = 1 - dense;
    return strain <= dense ? strain : dense + rest * (rest / (1 - strain) - 1);
}

double foam_energy(double solid, double strain) {
    const double dense = densification_strain(solid), rest = 1 - dense;
    if (strain <= dense) return 0.5 * strain * strain;
    return 0.5 * dense * dense + (dense - rest) * (strain - dense) + rest * rest * std::log(rest / (1 - strain));
}

std::shared_ptr<const CarriedShape> make_foam(const Preset& p, const Bundles& bundles) {
    auto body = std::make_shared<CarriedShape>();
    body->height = p.length;
    body->shut_strain = densification_strain(p.solid);
    if (p.geometry)
        take_geometry(p, *body);
    else
        make_cylinder(p, *body);
    make_pores(p, *body);
    finish_shape(bundles, p.length, *body);
    return body;
}

}  // namespace tuft::brush
