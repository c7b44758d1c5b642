#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "stroke/laying.h"

namespace tuft::stroke {

namespace {

using mesh::SurfaceQuery;

constexpr int kRays = 180;        // headings in which lines are walked; between them linear
constexpr int kRings = 3;         // of the hexagonal pattern of samples
constexpr double kFit = 0.7;      // part of the pattern that must lie on ground for its curvature
constexpr double kLeast = 0.35;   // and for its slope
constexpr std::size_t kMostSteps = 20'000;

/// The ground under a small disk: z = c[0] + c[1] a + c[2] b + (c[3] a² + 2 c[4] a b + c[5] b²) / 2
/// over its plane, metres, a along `heading`, b along normal × heading.
struct Ground {
    Vec3 position{0};
    Vec3 normal{0, 0, 1};
    Vec3 heading{1, 0, 0};
    std::array<double, 3> curvature{0, 0, 0};  ///< 1/m: along, mixed, across
    bool found = false;
};

const std::vector<Vec2>& pattern() {
    static const std::vector<Vec2> points = [] {
        std::vector<Vec2> p;
        for (int j = -kRings; j <= kRings; ++j)
            for (int i = std::max(-kRings, -kRings - j); i <= std::min(kRings, kRings - j); ++i)
                p.push_back(Vec2(i + 0.5 * j, 0.5 * std::sqrt(3.0) * j) / double(kRings));
        return p;
    }();
    return points;
}

/// Solves A x = b for symmetric positive A in place; false when A has no such inverse.
template <int N>
bool solve(std::array<std::array<double, N>, N>& a, std::array<double, N>& b) {
    for (int k = 0; k < N; ++k) {
        if (!(a[k][k] > 1e-12)) return false;
        for (int i = k + 1; i < N; ++i) {
            const double f = a[i][k] / a[k][k];
            for (int j = k; j < N; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (int k = N - 1; k >= 0; --k) {
        for (int j = k + 1; j < N; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return true;
}

struct Height {
    double a, b, z;  ///< over the disk, in radii
};

/// Least sum of pseudo-Huber distances, which narrow grooves hardly bend; convex, so that the
/// fit changes as little as the ground does. N = 6: with curvature; 3: without.
template <int N>
bool fit(const std::vector<Height>& heights, std::array<double, N>& c) {
    constexpr double kNarrow = 0.01;  // radii: differences of height that count fully
    constexpr int kPasses = 8;
    c.fill(0);
    for (int pass = 0; pass < kPasses; ++pass) {
        std::array<std::array<double, N>, N> lhs{};
        std::array<double, N> rhs{};
        for (const Height& h : heights) {
            const std::array<double, 6> all{1, h.a, h.b, 0.5 * h.a * h.a, h.a * h.b, 0.5 * h.b * h.b};
            double rest = h.z;
            for (int k = 0; k < N; ++k) rest -= c[k] * all[k];
            const double weight = pass == 0 ? 1 : 1 / std::sqrt(1 + rest * rest / (kNarrow * kNarrow));
            for (int i = 0; i < N; ++i) {
                rhs[i] += weight * all[i] * h.z;
                for (int j = 0; j < N; ++j) lhs[i][j] += weight * all[i] * all[j];
            }
        }
        if (!solve<N>(lhs, rhs)) return false;
        c = rhs;
    }
    return true;
}

/// The triangle's unit normal as its corners go round.
Vec3 face_normal(const mesh::TriangleMesh& mesh, std::uint32_t t) {
    const Vec3 a = mesh.position(t, 0);
    return glm::normalize(glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a));
}

/// Room above a point before the surface on the other side comes, at most `most`.
double clearance(const SurfaceQuery& query, const Vec3& p, const Vec3& normal, double most) {
    double from = 0;
    for (int hop = 0; hop < 4; ++hop) {  // a point within a bump first meets the bump's outside
        const mesh::RayHit hit = query.trace(Vec3f(p + from * normal), Vec3f(normal), float(1e-3 * most), float(most - from));
        if (hit.triangle == kNone) return most;
        const double at = from + hit.distance;
        if (glm::dot(face_normal(query.mesh(), hit.triangle), normal) < 0) return 0.5 * at;
        from = at;
        if (from >= most) break;
    }
    return most;
}

/// The ground near where it is thought to be. Where too little of it is there for a
/// curvature, that of the guess stays; where there is next to none, the guess itself.
Ground feel(const SurfaceQuery& query, const Ground& guess, double radius) {
    const Vec3 side = glm::cross(guess.normal, guess.heading);
    const double up = clearance(query, guess.position, guess.normal, radius);
    const Vec3f down(-guess.normal);
    std::vector<Height> heights;
    heights.reserve(pattern().size());
    for (const Vec2& p : pattern()) {
        const double bulge = 0.5 * radius *
                             (guess.curvature[0] * p.x * p.x + 2 * guess.curvature[1] * p.x * p.y +
                              guess.curvature[2] * p.y * p.y);
        const Vec3 eye = guess.position + radius * (p.x * guess.heading + p.y * side) +
                         (up + std::clamp(radius * bulge, -radius, radius)) * guess.normal;
        const mesh::RayHit hit = query.trace(Vec3f(eye), down, 0, float(up + radius));
        if (hit.triangle == kNone || glm::dot(face_normal(query.mesh(), hit.triangle), guess.normal) < 0.1) continue;
        heights.push_back({p.x, p.y, (glm::dot(eye - guess.position, guess.normal) - double(hit.distance)) / radius});
    }
    Ground ground = guess;
    const auto part = double(heights.size()) / double(pattern().size());
    double height = 0;
    Vec2 slope{0};
    if (std::array<double, 6> c; part >= kFit && fit<6>(heights, c)) {
        height = c[0];
        slope = {c[1], c[2]};
        const double most = 1.0;  // sharper ground than the disk cannot be told from noise
        for (int k = 0; k < 3; ++k) ground.curvature[k] = std::clamp(c[3 + k], -most, most) / radius;
    } else if (std::array<double, 3> d; part >= kLeast) {
        for (Height& h : heights)
            h.z -= 0.5 * radius *
                   (guess.curvature[0] * h.a * h.a + 2 * guess.curvature[1] * h.a * h.b +
                    guess.curvature[2] * h.b * h.b);
        if (!fit<3>(heights, d)) return guess;
        height = d[0];
        slope = {d[1], d[2]};
    } else {
        return ground;
    }
    ground.found = true;
    ground.position += radius * height * guess.normal;
    ground.normal = glm::normalize(guess.normal - slope.x * guess.heading - slope.y * side);
    ground.heading = into_plane(parallel_transport(guess.heading, guess.normal, ground.normal), ground.normal);
    return ground;
}

/// One step of a straightest line: ahead on the osculating paraboloid, then onto the ground.
Ground step(const SurfaceQuery& query, const Ground& from, double length, double radius) {
    const double k = from.found ? from.curvature[0] : 0, mixed = from.found ? from.curvature[1] : 0;
    const Vec3 side = glm::cross(from.normal, from.heading);
    Ground guess = from;
    guess.found = false;
    const double turn = k * length;
    guess.position += length * (1 - turn * turn / 6) * from.heading + 0.5 * turn * length * from.normal;
    guess.normal = glm::normalize(from.normal - length * (k * from.heading + mixed * side));
    guess.heading = into_plane(parallel_transport(from.heading, from.normal, guess.normal), guess.normal);
    Ground next = feel(query, guess, radius);
    if (!next.found) {  // past an edge: straight on
        next = from;
        next.found = false;
        next.position += length * from.heading;
    }
    return next;
}

/// The straightest lines from the placement's origin, walked as far as they are asked for.
class Drape {
  public:
    Drape(const SurfaceQuery& query, const Placement& place)
        : query_(query), radius_(drape_radius(query.mesh())), stride_(0.5 * radius_) {
        const auto start = query.closest_point(place.origin);
        if (!start) throw Error("there is no surface to lay a stroke on");
        gap_ = start->distance;
        Ground ground{start->position, start->normal, axes_across(start->normal, place.right, place.down).right,
                      {0, 0, 0}, true};
        for (int pass = 0; pass < 4; ++pass) ground = feel(query, ground, radius_);
        origin_ = ground;
        axes_ = axes_across(ground.normal, place.right, place.down);
        hand_ = glm::dot(glm::cross(axes_.right, ground.normal), axes_.down) < 0 ? -1 : 1;
    }

    double origin_gap() const { return gap_; }
    double radius() const { return radius_; }

    /// Place, normal and axes of a flat point on the ground; `on_surface` as felt there.
    LaidSample at(const Vec2& flat) {
        const double length = glm::length(flat);
        const double angle = std::atan2(flat.y, flat.x) / (2 * std::numbers::pi) * kRays;
        const double left = std::floor(angle), u = angle - left;
        const double along = length / stride_;
        const auto ring = static_cast<std::size_t>(std::min(along, double(kMostSteps - 1)));
        const double v = along - double(ring);
        LaidSample out;
        out.position = out.normal = out.right = out.down = Vec3(0);
        for (int r = 0; r < 2; ++r) {
            const int ray = ((static_cast<int>(left) + r) % kRays + kRays) % kRays;
            for (std::size_t s = 0; s < 2; ++s) {
                const double weight = (r ? u : 1 - u) * (s ? v : 1 - v);
                const Ground& g = node(ray, ring + s);
                const double phi = 2 * std::numbers::pi * ray / kRays;
                const Vec3 side = hand_ * glm::cross(g.heading, g.normal);
                out.position += weight * g.position;
                out.normal += weight * g.normal;
                out.right += weight * (std::cos(phi) * g.heading - std::sin(phi) * side);
                out.down += weight * (std::sin(phi) * g.heading + std::cos(phi) * side);
                if (!g.found && weight > 0.25) out.on_surface = false;
            }
        }
        out.normal = glm::normalize(out.normal);
        const Axes axes = axes_across(out.normal, out.right, out.down);
        out.right = axes.right;
        out.down = axes.down;
        return out;
    }

  private:
    const Ground& node(int ray, std::size_t ring) {
        std::vector<Ground>& line = lines_[static_cast<std::size_t>(ray)];
        if (line.empty()) {
            const double phi = 2 * std::numbers::pi * ray / kRays;
            Ground start = origin_;
            start.heading = std::cos(phi) * axes_.right + std::sin(phi) * axes_.down;
            Ground turned = start;
            turned.curvature = feel(query_, start, radius_).curvature;
            line.push_back(turned);
        }
        while (line.size() <= ring) line.push_back(step(query_, line.back(), stride_, radius_));
        return line[ring];
    }

    const SurfaceQuery& query_;
    double radius_, stride_, gap_ = 0, hand_ = 1;
    Ground origin_;
    Axes axes_;
    std::array<std::vector<Ground>, kRays> lines_;
};

}  // namespace

double drape_radius(const mesh::TriangleMesh& mesh) {
    return std::min(0.008, 0.04 * mesh.bounds.diagonal());
}

LaidTrace lay_draped(const SurfaceQuery& query, const Trace& trace) {
    Drape drape(query, trace.placement);
    LaidTrace laid;
    laid.origin_gap = drape.origin_gap();
    laid.samples.reserve(trace.samples.size());
    for (const TraceSample& s : trace.samples) {
        LaidSample out = drape.at(Vec2(s.position));
        const LaidSample hand = hand_data(s);
        out.time = hand.time;
        out.pressure = hand.pressure;
        out.tilt = hand.tilt;
        const double up = clearance(query, out.position, out.normal, drape.radius());
        if (const auto hit = exact_ray(query, out.position + up * out.normal, -out.normal, up + drape.radius())) {
            out.on = *hit;
            out.position = hit->position;
        } else {
            out.on = *query.closest_point(out.position);
            out.on_surface = false;
        }
        laid.missed += !out.on_surface;
        laid.samples.push_back(out);
    }
    return laid;
}

}  // namespace tuft::stroke
