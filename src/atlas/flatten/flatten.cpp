#include "atlas/flatten/flatten.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tuft::atlas {
namespace {

// A triangle flatter than this part of its longest edge is laid out as if it were this high.
constexpr double kMinHeight = 1e-4;
// The same for a triangle that is a chart of its own.
constexpr double kMinHeightAlone = 1.0 / 64;
// Normals further apart than this make a chart that is not plane.
constexpr double kPlaneCos = 1 - 1e-10;

/// The triangle in its own plane, counter-clockwise, first corner at the origin.
struct Reference {
    std::array<Vec2, 3> corner;
    std::array<double, 3> half_cot;  ///< half the cotangent of the angle facing edge k -> k + 1
    double area = 0;
};

Reference reference_triangle(const ChartMesh& chart, std::size_t t,
                             double min_height = kMinHeight) {
    const auto& f = chart.faces[t];
    int k = 0;
    double longest = -1;
    for (int i = 0; i < 3; ++i) {
        const double l = glm::length(chart.position[f[(i + 1) % 3]] - chart.position[f[i]]);
        if (l > longest) {
            longest = l;
            k = i;
        }
    }
    longest = std::max(longest, 1e-150);
    const Vec3 along = (chart.position[f[(k + 1) % 3]] - chart.position[f[k]]) / longest;
    const Vec3 side = chart.position[f[(k + 2) % 3]] - chart.position[f[k]];
    const double height = std::max(glm::length(glm::cross(along, side)), min_height * longest);
    Reference r;
    r.corner[k] = {0, 0};
    r.corner[(k + 1) % 3] = {longest, 0};
    r.corner[(k + 2) % 3] = {glm::dot(along, side), height};
    r.area = 0.5 * longest * height;
    for (int i = 0; i < 3; ++i) {
        const Vec2 a = r.corner[i] - r.corner[(i + 2) % 3];
        const Vec2 b = r.corner[(i + 1) % 3] - r.corner[(i + 2) % 3];
        r.half_cot[i] = 0.5 * glm::dot(a, b) / (2 * r.area);
    }
    return r;
}

double signed_area(const std::array<std::uint32_t, 3>& f, const std::vector<Vec2>& uv) {
    const Vec2 a = uv[f[1]] - uv[f[0]], b = uv[f[2]] - uv[f[0]];
    return 0.5 * (a.x * b.y - a.y * b.x);
}

bool all_positive(const ChartMesh& chart, const std::vector<Vec2>& uv) {
    return std::all_of(chart.faces.begin(), chart.faces.end(),
                       [&](const auto& f) { return signed_area(f, uv) > 0; });
}

bool all_finite(const std::vector<Vec2>& uv) {
    return std::all_of(uv.begin(), uv.end(),
                       [](const Vec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
}

/// UVs of a plane chart, seen from its normal; empty when it is not plane.
std::vector<Vec2> project_plane(const ChartMesh& chart, bool only_if_plane) {
    Vec3 sum(0);
    std::vector<Vec3> normal(chart.faces.size());
    for (std::size_t t = 0; t < normal.size(); ++t) {
        const auto& f = chart.faces[t];
        normal[t] = glm::cross(chart.position[f[1]] - chart.position[f[0]],
                               chart.position[f[2]] - chart.position[f[0]]);
        sum += normal[t];
    }
    const double length = glm::length(sum);
    if (!(length > 0)) return {};
    const Vec3 n = sum / length;
    if (only_if_plane)
        for (const Vec3& m : normal)
            if (!(glm::dot(m, n) > kPlaneCos * glm::length(m))) return {};
    const Frame frame = make_frame(Vec3(0), n);
    std::vector<Vec2> uv(chart.n_vertices());
    for (std::size_t v = 0; v < uv.size(); ++v)
        uv[v] = {glm::dot(chart.position[v], frame.t), glm::dot(chart.position[v], frame.b)};
    return uv;
}

using Matrix = Eigen::SparseMatrix<double>;

/// Stiffness matrix Σ half_cot over edges, without the row of vertex 0, which is pinned.
Matrix stiffness(const ChartMesh& chart, const std::vector<Reference>& references) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(6 * chart.faces.size() + chart.n_vertices());
    std::vector<double> diagonal(chart.n_vertices(), 0);
    for (std::size_t t = 0; t < chart.faces.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t i = chart.faces[t][k], j = chart.faces[t][(k + 1) % 3];
            const double w = references[t].half_cot[k];
            diagonal[i] += w;
            diagonal[j] += w;
            if (i > 0 && j > 0)
                entries.emplace_back(static_cast<int>(std::max(i, j)) - 1,
                                     static_cast<int>(std::min(i, j)) - 1, -w);
        }
    for (std::size_t v = 1; v < diagonal.size(); ++v)
        entries.emplace_back(static_cast<int>(v) - 1, static_cast<int>(v) - 1, diagonal[v]);
    const auto size = static_cast<Eigen::Index>(chart.n_vertices()) - 1;
    Matrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

std::vector<Reference> reference_triangles(const ChartMesh& chart) {
    std::vector<Reference> references(chart.faces.size());
    for (std::size_t t = 0; t < references.size(); ++t)
        references[t] = reference_triangle(chart, t);
    return references;
}

struct Rotation {
    double c = 1, s = 0;  // cosine and sine
    double energy = 0;    // left after it
};

/// Closest rotation (c, −s; s, c) to Σ w (u_i − u_j)(x_i − x_j)ᵀ over the edges of a triangle.
Rotation closest_rotation(const std::array<std::uint32_t, 3>& f, const Reference& r,
                          const std::vector<Vec2>& uv) {
    double c = 0, s = 0, square = 0;
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3;
        const Vec2 du = uv[f[k]] - uv[f[l]], dx = r.corner[k] - r.corner[l];
        const double w = r.half_cot[k];
        c += w * (du.x * dx.x + du.y * dx.y);
        s += w * (du.y * dx.x - du.x * dx.y);
        square += w * (glm::dot(du, du) + glm::dot(dx, dx));
    }
    const double norm = std::sqrt(c * c + s * s);
    if (!(norm > 0)) return {1, 0, std::max(0.0, square)};
    return {c / norm, s / norm, std::max(0.0, square - 2 * norm)};
}

/// Energy of a start, per area.
double start_energy(const ChartMesh& chart, const std::vector<Vec2>& uv) {
    double energy = 0;
    for (std::size_t t = 0; t < chart.faces.size(); ++t)
        energy += closest_rotation(chart.faces[t], reference_triangle(chart, t), uv).energy;
    return energy / std::max(chart.area, 1e-300);
}

/// A factorised stiffness matrix: both coordinates are solved for in one pass over it.
class Factor {
  public:
    bool compute(const Matrix& matrix) {
        ldlt_.compute(matrix);
        if (ldlt_.info() != Eigen::Success) return false;
        diagonal_ = ldlt_.vectorD();
        permuted_.resize(static_cast<std::size_t>(matrix.rows()));
        return true;
    }

    /// Replaces the right hand side by the solution.
    void solve(std::span<Vec2> x) {
        const auto& place = ldlt_.permutationP().indices();
        const auto& factor = ldlt_.matrixL().nestedExpression();  // below the diagonal of ones
        const int* start = factor.outerIndexPtr();
        const int* row = factor.innerIndexPtr();
        const double* value = factor.valuePtr();
        const auto n = static_cast<Eigen::Index>(x.size());
        Vec2* p = permuted_.data();
        for (Eigen::Index i = 0; i < n; ++i) p[place[i]] = x[static_cast<std::size_t>(i)];
        for (Eigen::Index j = 0; j < n; ++j)
            for (int k = start[j]; k < start[j + 1]; ++k) p[row[k]] -= value[k] * p[j];
        for (Eigen::Index j = 0; j < n; ++j) p[j] /= diagonal_[j];
        for (Eigen::Index j = n; j-- > 0;) {
            Vec2 sum = p[j];
            for (int k = start[j]; k < start[j + 1]; ++k) sum -= value[k] * p[row[k]];
            p[j] = sum;
        }
        for (Eigen::Index i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] = p[place[i]];
    }

  private:
    Eigen::SimplicialLDLT<Matrix> ldlt_;
    Eigen::VectorXd diagonal_;
    std::vector<Vec2> permuted_;
};

/// The local step: `rhs` of the global one for the rotations that fit `uv` best. Returns the
/// energy of `uv`.
double fit_rotations(const ChartMesh& chart, const std::vector<Reference>& references,
                     const std::vector<Vec2>& uv, std::vector<Vec2>& rhs) {
    std::fill(rhs.begin(), rhs.end(), Vec2(0));
    double energy = 0;
    for (std::size_t t = 0; t < references.size(); ++t) {
        const auto& f = chart.faces[t];
        const Reference& r = references[t];
        const auto [c, s, e] = closest_rotation(f, r, uv);
        energy += e;
        for (int k = 0; k < 3; ++k) {
            const int l = (k + 1) % 3;
            const Vec2 dx = r.corner[k] - r.corner[l];
            const Vec2 b = r.half_cot[k] * Vec2(c * dx.x - s * dx.y, s * dx.x + c * dx.y);
            rhs[f[k]] += b;
            rhs[f[l]] -= b;
        }
    }
    return energy;
}

}  // namespace

double arap(const ChartMesh& chart, std::vector<Vec2>& uv, const ArapOptions& options) {
    const std::size_t n = chart.n_vertices();
    if (n < 3) return 0;
    const std::vector<Reference> references = reference_triangles(chart);
    const double area = std::max(chart.area, 1e-300);
    Factor factor;
    std::vector<Vec2> rhs(n);
    const Vec2 pin = uv[0];
    double before = -1, energy = 0;
    for (int step = 0; step < options.iterations; ++step) {
        if (options.on_step) options.on_step();
        energy = fit_rotations(chart, references, uv, rhs) / area;
        if (energy < options.enough) break;
        if (before >= 0 && before - energy < options.tolerance * energy) break;
        if (step >= 3) {
            // What is left after the remaining steps if each helps as much as the last one.
            const double left = energy * std::pow(energy / before, options.iterations - step);
            if (left > options.hopeless) break;
        }
        before = energy;
        if (step == 0 && !factor.compute(stiffness(chart, references))) break;
        // Vertex 0 is pinned at the origin while solving, then all is moved to where it was.
        factor.solve(std::span(rhs).subspan(1));
        for (std::size_t v = 1; v < n; ++v) uv[v] = pin + rhs[v];
    }
    return energy;
}

bool untangle(const ChartMesh& chart, std::vector<Vec2>& uv) {
    const std::size_t n = chart.n_vertices();
    std::vector<std::uint32_t> start(n + 1, 0), around(3 * chart.faces.size());
    for (const auto& f : chart.faces)
        for (const std::uint32_t v : f) ++start[v + 1];
    for (std::size_t v = 0; v < n; ++v) start[v + 1] += start[v];
    std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
    for (std::size_t t = 0; t < chart.faces.size(); ++t)
        for (const std::uint32_t v : chart.faces[t])
            around[fill[v]++] = static_cast<std::uint32_t>(t);

    // The worst triangle around a vertex, its area over the area it should have.
    const auto worst = [&](std::uint32_t v) {
        double least = 1e300;
        for (std::uint32_t i = start[v]; i < start[v + 1]; ++i)
            least = std::min(least, signed_area(chart.faces[around[i]], uv) /
                                        reference_triangle(chart, around[i]).area);
        return least;
    };
    constexpr double kEnough = 0.05;
    for (int sweep = 0; sweep < 20; ++sweep) {
        bool bad = false;
        for (const auto& f : chart.faces) {
            if (signed_area(f, uv) > 0) continue;
            bad = true;
            for (const std::uint32_t v : f) {
                double size = 0;
                for (std::uint32_t i = start[v]; i < start[v + 1]; ++i)
                    for (const std::uint32_t w : chart.faces[around[i]])
                        size = std::max(size, glm::length(uv[w] - uv[v]));
                double best = worst(v);
                for (double step = 0.5 * size; step > 1e-6 * size && best < kEnough;) {
                    const Vec2 here = uv[v];
                    Vec2 better = here;
                    for (int d = 0; d < 8; ++d) {
                        const double angle = d * 0.78539816339744831;
                        uv[v] = here + step * Vec2(std::cos(angle), std::sin(angle));
                        const double w = worst(v);
                        if (w > best) {
                            best = w;
                            better = uv[v];
                        }
                    }
                    uv[v] = better;
                    if (better == here) step *= 0.5;
                }
            }
        }
        if (!bad) return true;
    }
    return all_positive(chart, uv);
}

void scale_to_area(const ChartMesh& chart, std::vector<Vec2>& uv) {
    double area = 0;
    for (const auto& f : chart.faces) area += signed_area(f, uv);
    if (!(std::abs(area) > 0) || !(chart.area > 0)) return;
    const double scale = std::sqrt(chart.area / std::abs(area));
    for (Vec2& p : uv) p *= scale;
}

std::vector<Vec2> flatten(const ChartMesh& chart, const ArapOptions& options) {
    if (!chart.disk) return {};
    if (chart.faces.size() == 1) {
        const Reference r = reference_triangle(chart, 0, kMinHeightAlone);
        std::vector<Vec2> uv(3);
        for (int k = 0; k < 3; ++k) uv[chart.faces[0][k]] = r.corner[k];
        return uv;
    }
    std::vector<Vec2> uv = project_plane(chart, true);
    if (!uv.empty() && all_positive(chart, uv)) return uv;
    uv.clear();
    // Where the projection does not shrink much it is as good a start as any.
    constexpr double kGoodStart = 0.15;
    std::vector<std::vector<Vec2>> starts{project_plane(chart, false)};
    if (starts[0].empty() || start_energy(chart, starts[0]) > kGoodStart)
        starts.emplace(starts.begin());
    else
        starts.emplace_back();
    for (std::vector<Vec2>& start : starts) {
        if (start.empty())
            if (auto conformal = lscm(chart)) start = std::move(*conformal);
        if (start.empty()) continue;
        arap(chart, start, options);
        if (!all_finite(start)) continue;
        uv = std::move(start);
        if (all_positive(chart, uv)) break;
    }
    if (uv.empty()) return {};
    if (!all_positive(chart, uv)) untangle(chart, uv);
    scale_to_area(chart, uv);
    return uv;
}

}  // namespace tuft::atlas
