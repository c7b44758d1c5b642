#include "decal/panels/lay_flat.h"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "atlas/flatten/flatten.h"
#include "atlas/flatten/reference.h"
#include "core/system/interrupt.h"

namespace tuft::decal {
namespace {

using atlas::ChartMesh;
using atlas::Reference;

constexpr double kNeedle = 0.01;       // height over the longest edge
constexpr double kDevelopable = 2e-5;  // strain up to which unrolling is exact enough: 0.002 mm in 100
constexpr double kAim = 0.96;          // of the limit: strain that the local step clamps to
constexpr int kMostSteps = 600;
constexpr int kPatience = 150;  // steps without a gain of 1 %
constexpr double kMomentum = 0.75;
constexpr double kNoMatter = 2e-3;  // strain that film does not feel
constexpr double kFirstCut = 0.15;  // of the strain, that is tried to be spared at once, then half of it ...
constexpr double kLastCut = 0.015;  // ... down to this

/// A 2 × 2 matrix (a, b; c, d) as a turn and scaling (e, −h; h, e) and a mirror and scaling (f, g; g, −f). Its singular
/// values are the sum and the difference of both scales.
struct TurnAndMirror {
    double e, f, g, h;
    double q, r;  // scales of the turn and of the mirror

    double s1() const { return q + r; }
    double s2() const { return q - r; }  // < 0 where the map turns over
};

TurnAndMirror parts_of(const std::array<double, 4>& m) {
    const double e = 0.5 * (m[0] + m[3]), f = 0.5 * (m[0] - m[3]), g = 0.5 * (m[2] + m[1]), h = 0.5 * (m[2] - m[1]);
    return {e, f, g, h, std::sqrt(e * e + h * h), std::sqrt(f * f + g * g)};
}

/// The matrix with the same axes and other singular values, row by row.
std::array<double, 4> with_values(const TurnAndMirror& m, double s1, double s2) {
    const double q = 0.5 * (s1 + s2), r = 0.5 * (s1 - s2);
    const double e = m.q > 0 ? q * (m.e / m.q) : q, h = m.q > 0 ? q * (m.h / m.q) : 0;
    const double f = m.r > 0 ? r * (m.f / m.r) : r, g = m.r > 0 ? r * (m.g / m.r) : 0;
    return {e + f, g - h, g + h, e - f};
}

/// The map from a triangle's own plane onto the sheet, row by row.
std::array<double, 4> map_of(const Reference& r, const std::array<std::uint32_t, 3>& f, std::span<const Vec2> flat) {
    const Vec2 x1 = r.corner[1] - r.corner[0], x2 = r.corner[2] - r.corner[0];
    const Vec2 u1 = flat[f[1]] - flat[f[0]], u2 = flat[f[2]] - flat[f[0]];
    const double det = x1.x * x2.y - x1.y * x2.x;
    return {(u1.x * x2.y - u2.x * x1.y) / det, (u2.x * x1.x - u1.x * x2.x) / det, (u1.y * x2.y - u2.y * x1.y) / det,
            (u2.y * x1.x - u1.y * x2.x) / det};
}

bool is_needle(const Reference& r) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, glm::length(r.corner[(k + 1) % 3] - r.corner[k]));
    return 2 * r.area < kNeedle * longest * longest;
}

std::vector<Reference> references_of(const ChartMesh& chart) {
    std::vector<Reference> references(chart.faces.size());
    for (std::size_t t = 0; t < references.size(); ++t) references[t] = atlas::reference_triangle(chart, t);
    return references;
}

Stretch stretch_of(const Reference& r, const std::array<std::uint32_t, 3>& f, std::span<const Vec2> flat) {
    if (is_needle(r)) return {};
    const TurnAndMirror m = parts_of(map_of(r, f, flat));
    if (!(m.s2() > 0)) return {std::numeric_limits<double>::infinity(), 0};
    return {1 / m.s2(), 1 / m.s1()};
}

/// Greatest and least stretch of all triangles.
Stretch range_of(const std::vector<Reference>& references, const ChartMesh& chart, std::span<const Vec2> flat) {
    Stretch range{0, std::numeric_limits<double>::infinity()};
    for (std::size_t t = 0; t < references.size(); ++t) {
        const Stretch s = stretch_of(references[t], chart.faces[t], flat);
        range.most = std::max(range.most, s.most);
        range.least = std::min(range.least, s.least);
    }
    return range;
}

/// Lays triangle after triangle beside the one before it: exact for developable surfaces.
std::vector<Vec2> unroll(const ChartMesh& chart, const std::vector<Reference>& references) {
    std::vector<Vec2> flat(chart.n_vertices());
    std::vector<std::uint8_t> placed(chart.n_vertices(), 0), seen(chart.faces.size(), 0);
    std::vector<std::uint32_t> queue{0};
    seen[0] = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        flat[chart.faces[0][k]] = references[0].corner[k];
        placed[chart.faces[0][k]] = 1;
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t g = chart.twin[3 * queue[i] + k];
            if (g == kNone || seen[g / 3]) continue;
            const std::uint32_t t = g / 3;
            seen[t] = 1;
            queue.push_back(t);
            const std::size_t a = g % 3, b = (a + 1) % 3, c = (a + 2) % 3;
            const auto& f = chart.faces[t];
            if (placed[f[c]]) continue;
            const Vec2 x = references[t].corner[b] - references[t].corner[a];
            const Vec2 y = references[t].corner[c] - references[t].corner[a];
            const Vec2 u = flat[f[b]] - flat[f[a]];
            const double square = glm::dot(x, x);
            const double along = glm::dot(x, y) / square, across = (x.x * y.y - x.y * y.x) / square;
            flat[f[c]] = flat[f[a]] + along * u + across * Vec2(-u.y, u.x);
            placed[f[c]] = 1;
        }
    return flat;
}

/// Strain limiting: one factorisation, then local and global steps.
class StrainLimiter {
  public:
    StrainLimiter(const ChartMesh& chart, const std::vector<Reference>& references)
        : chart_(chart), references_(references), n_(static_cast<Eigen::Index>(chart.n_vertices()) - 1) {
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t t = 0; t < references.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto i = static_cast<int>(chart.faces[t][k]);
                const auto j = static_cast<int>(chart.faces[t][(k + 1) % 3]);
                const double w = references[t].half_cot[k];
                if (i < n_) entries.emplace_back(i, i, w);
                if (j < n_) entries.emplace_back(j, j, w);
                if (i < n_ && j < n_) entries.emplace_back(std::max(i, j), std::min(i, j), -w);
            }
        Eigen::SparseMatrix<double> matrix(n_, n_);
        matrix.setFromTriplets(entries.begin(), entries.end());
        factor_.compute(matrix);
        ok_ = factor_.info() == Eigen::Success && factor_.vectorD().allFinite();
    }

    /// Moves `flat` until no strain exceeds `limit`, or nothing is gained any more. Returns its strain.
    double run(std::vector<Vec2>& flat, double limit) const {
        if (!ok_ || n_ < 2) return range_of(references_, chart_, flat).strain();
        const double lo = 1 / (1 + kAim * limit), hi = 1 / (1 - kAim * limit);
        std::vector<Vec2> best = flat, before = flat, at(flat.size());
        double least = range_of(references_, chart_, flat).strain();
        int idle = 0;
        for (int step = 0; step < kMostSteps && least > limit && idle < kPatience; ++step) {
            check_interrupt();
            for (std::size_t v = 0; v < at.size(); ++v) at[v] = flat[v] + kMomentum * (flat[v] - before[v]);
            before = flat;
            flat = global_step(at, lo, hi);
            const double strain = range_of(references_, chart_, flat).strain();
            idle = strain < 0.99 * least ? 0 : idle + 1;
            if (strain < least) least = strain, best = flat;
        }
        flat = std::move(best);
        return least;
    }

  private:
    using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

    std::vector<Vec2> global_step(const std::vector<Vec2>& at, double lo, double hi) const {
        // The last vertex stays where it is, which fixes the shift.
        std::vector<Vec2> rhs(at.size(), Vec2(0)), out(at.size());
        const auto last = static_cast<std::uint32_t>(n_);
        for (std::size_t t = 0; t < references_.size(); ++t) {
            const auto& f = chart_.faces[t];
            const Reference& r = references_[t];
            const TurnAndMirror m = parts_of(map_of(r, f, at));
            const auto [a, b, c, d] = with_values(m, std::clamp(m.s1(), lo, hi), std::clamp(m.s2(), lo, hi));
            const auto target = [&](const Vec2& x) { return Vec2(a * x.x + b * x.y, c * x.x + d * x.y); };
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t l = (k + 1) % 3;
                const double w = r.half_cot[k];
                const Vec2 pull = w * target(r.corner[k] - r.corner[l]);
                rhs[f[k]] += pull;
                rhs[f[l]] -= pull;
                if (f[l] == last) rhs[f[k]] += w * at[last];
                if (f[k] == last) rhs[f[l]] += w * at[last];
            }
        }
        Eigen::Map<Coordinates>(&out[0].x, n_, 2) = factor_.solve(Eigen::Map<const Coordinates>(&rhs[0].x, n_, 2));
        out[last] = at[last];
        return out;
    }

    const ChartMesh& chart_;
    const std::vector<Reference>& references_;
    Eigen::Index n_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::AMDOrdering<int>> factor_;
    bool ok_ = false;
};

/// Lowers the largest strain step by step as far as it goes.
void lower_strain(const StrainLimiter& limiter, std::vector<Vec2>& flat, double strain) {
    double part = kFirstCut;
    while (part > kLastCut && strain > kNoMatter) {
        std::vector<Vec2> lower = flat;
        const double reached = limiter.run(lower, (1 - part) * strain);
        if (reached < (1 - 0.5 * part) * strain)
            flat = std::move(lower), strain = reached;
        else
            part *= 0.5;
    }
}

FlatPanel finished(const ChartMesh& chart, const std::vector<Reference>& references, std::vector<Vec2> flat) {
    FlatPanel panel;
    panel.strain = range_of(references, chart, flat).strain();
    panel.sound = atlas::check_flat(chart, flat).sound();
    panel.flat = std::move(flat);
    return panel;
}

std::vector<Vec2> times(std::vector<Vec2> flat, double scale) {
    for (Vec2& p : flat) p *= scale;
    return flat;
}

}  // namespace

std::vector<Stretch> measure_stretch(const ChartMesh& chart, std::span<const Vec2> flat) {
    std::vector<Stretch> stretches(chart.faces.size());
    for (std::size_t t = 0; t < stretches.size(); ++t)
        stretches[t] = stretch_of(atlas::reference_triangle(chart, t), chart.faces[t], flat);
    return stretches;
}

double largest_strain(const ChartMesh& chart, std::span<const Vec2> flat) {
    double largest = 0;
    for (const Stretch& s : measure_stretch(chart, flat)) largest = std::max(largest, s.strain());
    return largest;
}

FlatPanel lay_flat(const ChartMesh& chart, double limit, SheetSize size) {
    if (!chart.disk) return {};
    const std::vector<Reference> references = references_of(chart);
    std::vector<Vec2> flat = unroll(chart, references);
    if (range_of(references, chart, flat).strain() < kDevelopable) return finished(chart, references, std::move(flat));
    // Every map within the limit has Σ area Σ (1/σ − 1)² ≤ 2 (limit / (1 − limit))² area.
    const double most = 2 * std::pow(limit / (1 - limit), 2);
    atlas::ArapOptions options;
    options.iterations = 100;
    options.tolerance = 1e-4;
    options.abandon_energy = 2 * most;
    flat = atlas::flatten(chart, options);
    if (flat.empty()) return {};
    const Stretch range = range_of(references, chart, flat);
    if (!std::isfinite(range.most)) return finished(chart, references, std::move(flat));
    std::optional<StrainLimiter> limiter;
    if (size == SheetSize::nearest) limiter.emplace(chart, references);
    const auto lowered = [&](std::vector<Vec2> from) {
        if (!limiter) return finished(chart, references, std::move(from));
        std::vector<Vec2> lower = from;
        lower_strain(*limiter, lower, range_of(references, chart, from).strain());
        FlatPanel panel = finished(chart, references, std::move(lower));
        return panel.sound ? panel : finished(chart, references, std::move(from));
    };
    if (range.strain() <= limit) return lowered(std::move(flat));
    // The same strain at both ends: (scale σ_max − 1) = (1 − scale σ_min).
    const double balance = 0.5 * (range.most + range.least);
    std::vector<Vec2> scaled = times(flat, balance);
    FlatPanel panel = finished(chart, references, scaled);
    if (panel.strain > limit && atlas::arap_energy(chart, flat) > most) return panel;
    if (panel.strain > limit) {
        if (!limiter) limiter.emplace(chart, references);
        limiter->run(scaled, limit);
        panel = finished(chart, references, std::move(scaled));
    }
    if (!panel.within(limit) || size == SheetSize::balanced) return panel;
    // Where the limit is met at a size nearer to the true one too, most of the film is strained less.
    for (const double part : {0.0, 0.5}) {
        std::vector<Vec2> nearer = times(flat, 1 + part * (balance - 1));
        limiter->run(nearer, limit);
        if (FlatPanel other = finished(chart, references, std::move(nearer)); other.within(limit))
            return lowered(std::move(other.flat));
    }
    return lowered(std::move(panel.flat));
}

}  // namespace tuft::decal
