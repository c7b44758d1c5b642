#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "atlas/flatten/flatten.h"
#include "atlas/flatten/ldlt.h"
#include "atlas/flatten/reference.h"

namespace tuft::atlas {
namespace {

/// What the steps need of a `Reference`, in 56 bytes in place of 80: a chart has one for each triangle.
struct FlatTriangle {
    std::array<double, 3> half_cot;
    double base = 0;  ///< from corner `first`, the origin, to the next, along x
    Vec2 apex{0};     ///< the corner after that
    std::uint32_t first = 0;

    explicit FlatTriangle(const Reference& r) : half_cot(r.half_cot) {
        while (r.corner[first] != Vec2{0} || r.corner[(first + 1) % 3].y != 0) ++first;
        base = r.corner[(first + 1) % 3].x;
        apex = r.corner[(first + 2) % 3];
    }
    double area() const { return 0.5 * base * apex.y; }
    std::array<Vec2, 3> corners() const {
        std::array<Vec2, 3> out;
        out[first] = {0, 0};
        out[(first + 1) % 3] = {base, 0};
        out[(first + 2) % 3] = apex;
        return out;
    }
};

/// The part of a chart that is laid out anew: its triangles and their vertices, those that move
/// first.
struct Part {
    std::vector<std::array<std::uint32_t, 3>> faces;  ///< vertices of the part
    std::vector<FlatTriangle> flat;                   ///< [faces]
    std::vector<std::uint32_t> vertex;                ///< of the chart
    std::size_t n_free = 0;
    double area = 0;
};

/// Triangles of a chart in their own planes; of no `faces`: all.
std::vector<FlatTriangle> flatten_triangles(const ChartMesh& chart, std::span<const std::uint32_t> faces) {
    const std::size_t n = faces.empty() ? chart.faces.size() : faces.size();
    std::vector<FlatTriangle> flat;
    flat.reserve(n);
    for (std::size_t t = 0; t < n; ++t) flat.emplace_back(reference_triangle(chart, faces.empty() ? t : faces[t]));
    return flat;
}

/// All of a chart; its first vertex stays.
Part whole(const ChartMesh& chart) {
    const auto n = static_cast<std::uint32_t>(chart.n_vertices());
    Part part;
    part.vertex.resize(n);
    std::iota(part.vertex.begin(), part.vertex.end(), 1u);
    part.vertex[n - 1] = 0;
    part.n_free = n - 1;
    part.faces = chart.faces;
    for (auto& f : part.faces)
        for (std::uint32_t& v : f) v = v > 0 ? v - 1 : n - 1;
    part.flat = flatten_triangles(chart, {});
    part.area = chart.area;
    return part;
}

/// Some triangles of a chart; the vertices that they share with others stay.
Part part_of(const ChartMesh& chart, std::span<const std::uint32_t> faces) {
    std::vector<std::uint32_t> slot(chart.n_vertices(), kNone);
    std::vector<std::uint8_t> inside(chart.faces.size(), 0);
    for (const std::uint32_t f : faces) inside[f] = 1;
    constexpr std::uint32_t kHeld = kNone - 1;
    for (std::size_t f = 0; f < chart.faces.size(); ++f)
        if (!inside[f])
            for (const std::uint32_t v : chart.faces[f]) slot[v] = kHeld;
    Part part;
    part.flat = flatten_triangles(chart, faces);
    for (const FlatTriangle& triangle : part.flat) part.area += triangle.area();
    for (const std::uint32_t f : faces) {
        for (const std::uint32_t v : chart.faces[f])
            if (slot[v] == kNone) {
                slot[v] = static_cast<std::uint32_t>(part.vertex.size());
                part.vertex.push_back(v);
            }
    }
    part.n_free = part.vertex.size();
    for (const std::uint32_t f : faces) {
        std::array<std::uint32_t, 3> own = chart.faces[f];
        for (std::uint32_t& v : own) {
            if (slot[v] == kHeld) {
                slot[v] = static_cast<std::uint32_t>(part.vertex.size());
                part.vertex.push_back(v);
            }
            v = slot[v];
        }
        part.faces.push_back(own);
    }
    return part;
}

/// Stiffness matrix Σ half_cot over edges, of the vertices that move; `pinned` is what the others pull with.
SymmetricMatrix stiffness(const Part& part, const std::vector<Vec2>& uv, std::vector<Vec2>& pinned) {
    SymmetricMatrix matrix;
    matrix.entries.reserve(3 * part.faces.size());
    matrix.diagonal.assign(part.vertex.size(), 0);
    pinned.assign(part.n_free, Vec2(0));
    for (std::size_t t = 0; t < part.faces.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto [i, j] = std::minmax(part.faces[t][k], part.faces[t][(k + 1) % 3]);
            const double w = part.flat[t].half_cot[k];
            matrix.diagonal[i] += w;
            matrix.diagonal[j] += w;
            if (j < part.n_free)
                matrix.entries.push_back({j, i, -w});
            else if (i < part.n_free)
                pinned[i] += w * uv[j];
        }
    matrix.diagonal.resize(part.n_free);
    return matrix;
}

struct Rotation {
    double c = 1, s = 0;  // cosine and sine
    double energy = 0;    // left after it
};

/// Closest rotation (c, −s; s, c) to Σ w (u_i − u_j)(x_i − x_j)ᵀ over the edges of a triangle.
Rotation closest_rotation(const std::array<std::uint32_t, 3>& f, const std::array<Vec2, 3>& corner,
                          const std::array<double, 3>& half_cot, const std::vector<Vec2>& uv) {
    double c = 0, s = 0, square = 0;
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3;
        const Vec2 du = uv[f[k]] - uv[f[l]], dx = corner[k] - corner[l];
        const double w = half_cot[k];
        c += w * (du.x * dx.x + du.y * dx.y);
        s += w * (du.y * dx.x - du.x * dx.y);
        square += w * (glm::dot(du, du) + glm::dot(dx, dx));
    }
    const double norm = std::sqrt(c * c + s * s);
    if (!(norm > 0)) return {1, 0, std::max(0.0, square)};
    return {c / norm, s / norm, std::max(0.0, square - 2 * norm)};
}

/// The local step: `rhs` of the global one for the rotations that fit `uv` best. Returns the
/// energy of `uv`.
double fit_rotations(const Part& part, const std::vector<Vec2>& uv, std::vector<Vec2>& rhs) {
    std::fill(rhs.begin(), rhs.end(), Vec2(0));
    double energy = 0;
    for (std::size_t t = 0; t < part.flat.size(); ++t) {
        const auto& f = part.faces[t];
        const std::array<double, 3>& half_cot = part.flat[t].half_cot;
        const std::array<Vec2, 3> corner = part.flat[t].corners();
        const auto [c, s, e] = closest_rotation(f, corner, half_cot, uv);
        energy += e;
        for (int k = 0; k < 3; ++k) {
            const int l = (k + 1) % 3;
            const Vec2 dx = corner[k] - corner[l];
            const Vec2 b = half_cot[k] * Vec2(c * dx.x - s * dx.y, s * dx.x + c * dx.y);
            rhs[f[k]] += b;
            rhs[f[l]] -= b;
        }
    }
    return energy;
}

}  // namespace

double arap_energy(const ChartMesh& chart, const std::vector<Vec2>& uv) {
    double energy = 0;
    for (std::size_t t = 0; t < chart.faces.size(); ++t) {
        const Reference r = reference_triangle(chart, t);
        energy += closest_rotation(chart.faces[t], r.corner, r.half_cot, uv).energy;
    }
    return energy / std::max(chart.area, 1e-300);
}

double arap(const ChartMesh& chart, std::vector<Vec2>& uv, const ArapOptions& options,
            std::span<const std::uint32_t> faces) {
    // Triangles from which on they are laid out twice, at a tenth of the time of the factors, so that only one of both
    // takes memory while the factors are computed.
    constexpr std::size_t kLarge = 30000;
    if (chart.n_vertices() < 3) return 0;
    Part part = faces.empty() ? whole(chart) : part_of(chart, faces);
    if (part.n_free == 0) return 0;
    const double area = std::max(part.area, 1e-300);
    LdltFactor factor;
    std::vector<Vec2> at(part.vertex.size()), rhs(part.vertex.size()), pinned;
    for (std::size_t v = 0; v < at.size(); ++v) at[v] = uv[part.vertex[v]];
    const auto hand_out = [&] {
        for (std::size_t v = 0; v < part.n_free; ++v) uv[part.vertex[v]] = at[v];
    };
    double before = -1, energy = 0;
    for (int step = 0; step < options.iterations; ++step) {
        if (options.on_step) options.on_step();
        energy = fit_rotations(part, at, rhs) / area;
        if (energy < options.converged_energy) break;
        if (before >= 0 && before - energy < options.tolerance * energy) break;
        if (step >= 3) {
            // What is left after the remaining steps if each helps as much as the last one.
            const double left = energy * std::pow(energy / before, options.iterations - step);
            if (left > options.abandon_energy) break;
        }
        if (step > 0 && options.should_stop) {
            hand_out();
            if (options.should_stop(step)) break;
        }
        before = energy;
        const std::span<Vec2> moving = std::span(at).first(part.n_free);
        if (step == 0) {
            SymmetricMatrix matrix = stiffness(part, at, pinned);
            const bool large = part.faces.size() > kLarge;
            if (large) part.flat = {};
            if (!factor.compute(std::move(matrix), moving)) break;
            if (large) part.flat = flatten_triangles(chart, faces);
        }
        for (std::size_t v = 0; v < part.n_free; ++v) rhs[v] += pinned[v];
        std::copy_n(rhs.begin(), part.n_free, moving.begin());
        factor.solve(moving);
    }
    hand_out();
    return energy;
}

}  // namespace tuft::atlas
