#include "brush/tuft/table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/rod/rod.h"
#include "brush/tuft/tuft.h"
#include "core/cubic.h"

namespace tuft::brush {

namespace {

constexpr int kFiner = 2;           ///< rod segments for one spine segment: tip within 3e-4 L
constexpr double kLargestLoad = 8;  ///< P L²/B0 of the last row: the tip has turned past 80°

/// Clamped at the origin along x, bends towards y.
const rod::Clamp kHolder{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

struct Loaded {
    rod::Memory memory;
    rod::Result result;
};

Loaded load_to(const rod::Rod& fine, const rod::Memory& from, double load) {
    rod::Law law;
    law.limits.tolerance = 1e-10;
    law.limits.max_iterations = 200;
    Loaded out{from, {}};
    out.result = rod::solve(fine, out.memory, kHolder, {.law = law, .load = {{0, load, 0}}});
    return out;
}

/// Row of one loaded shape, in units of L and B0 times `length` and `stiffness`.
TableRow row_of(const Loaded& at, double load, double length, double stiffness) {
    TableRow row;
    row.moment = load * at.memory.node.back().x * stiffness / length;
    row.load = load * stiffness / (length * length);
    const std::size_t fine = at.memory.tangent.size();
    for (std::size_t i = fine + kFiner; i >= kFiner;) {
        i -= kFiner;
        const Vec3& x = at.memory.node[i];
        const Vec3 inner = i == 0 ? kHolder.tangent : at.memory.tangent[i - 1];
        const Vec3 t = i == fine ? at.memory.tangent[i - 1] : inner + at.memory.tangent[i];
        row.nodes.push_back(length * Vec2{x.x, x.y});
        row.angles.push_back(std::atan2(t.y, t.x));
        row.moments.push_back(i == fine ? 0 : at.result.moment[i] * stiffness / length);
    }
    row.angles.back() = 0;
    return row;
}

/// Load whose root moment is `moment` (units of L and B0), from the shape before it. The
/// moment rises with the load, so that regula falsi with halving (Illinois) is safe.
double load_for(const rod::Rod& fine, const rod::Memory& from, double moment, double lo, double hi) {
    const auto miss = [&](double p) { return p * load_to(fine, from, p).memory.node.back().x - moment; };
    double f_lo = miss(lo), f_hi = miss(hi);
    for (int i = 0; i < 40 && hi - lo > 1e-12 * hi; ++i) {
        const double p = (lo * f_hi - hi * f_lo) / (f_hi - f_lo), f = miss(p);
        if (std::abs(f) < 1e-11) return p;
        if ((f > 0) == (f_hi > 0)) {
            hi = p;
            f_hi = f;
            f_lo *= 0.5;
        } else {
            lo = hi;
            f_lo = f_hi;
            hi = p;
            f_hi = f;
        }
        if (lo > hi) {
            std::swap(lo, hi);
            std::swap(f_lo, f_hi);
        }
    }
    return 0.5 * (lo + hi);
}

}  // namespace

QueryTable make_table(const Preset& p, int rows) {
    const std::vector<double> spine = spine_segments(p.segments, 0.25 + 0.75 * p.hardness);
    std::vector<double> lengths;
    for (const double l : spine) lengths.insert(lengths.end(), kFiner, l / kFiner);
    rod::Rod fine = rod::make_rod(profile_of(p), lengths);
    fine.plastic_share = p.plastic_share;

    QueryTable table{p.length, p.stiffness, {}};
    rod::Memory memory = rod::make_memory(fine, kHolder);
    rod::Memory probe = memory;
    double largest = 0;
    for (int i = 1; i <= 16; ++i) {
        Loaded at = load_to(fine, probe, kLargestLoad * i / 16);
        largest = kLargestLoad * i / 16 * at.memory.node.back().x;
        probe = std::move(at.memory);
    }
    rows = std::max(rows, 2);
    double load = 0;
    for (int i = 0; i < rows; ++i) {
        const double moment = largest * i / (rows - 1);
        double above = load + kLargestLoad / rows;
        while (i > 0 && above < 16 * kLargestLoad &&
               above * load_to(fine, memory, above).memory.node.back().x < moment) {
            above += kLargestLoad / rows;
        }
        if (i > 0) load = load_for(fine, memory, moment, load, above);
        Loaded at = load_to(fine, memory, load);
        table.rows.push_back(row_of(at, load, p.length, p.stiffness));
        memory = std::move(at.memory);
    }
    return table;
}

namespace {

/// Place between rows k and k+1 of even spacing.
struct BetweenRows {
    double t = 0;                      ///< part of the way, 0–1
    bool first = false, last = false;  ///< no row comes before k; none after k+1

    /// Cubic through the values of rows k−1 to k+2, slopes by central differences.
    template <class T>
    T cubic(const T& before, const T& lo, const T& hi, const T& after) const {
        const T m0 = first ? hi - lo : (hi - before) * 0.5;
        const T m1 = last ? hi - lo : (after - lo) * 0.5;
        return hermite(lo, hi, m0, m1, 1, t);
    }
};

/// The rows round a moment, and the place of it between the inner two.
struct RowsAround {
    const TableRow &before, &lo, &hi, &after;
    BetweenRows place;

    RowsAround(const std::vector<TableRow>& rows, std::size_t k, double t)
        : before(rows[k == 0 ? 0 : k - 1]),
          lo(rows[k]),
          hi(rows[k + 1]),
          after(rows[std::min(k + 2, rows.size() - 1)]),
          place{t, k == 0, k + 2 == rows.size()} {}

    template <class F>
    auto cubic(const F& of) const {
        return place.cubic(of(before), of(lo), of(hi), of(after));
    }
};

RowsAround rows_around(const QueryTable& table, double moment) {
    const std::size_t n = table.rows.size();
    const double at = std::clamp(moment / table.rows.back().moment, 0.0, 1.0) * static_cast<double>(n - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(at), n - 2);
    return {table.rows, k, at - static_cast<double>(k)};
}

}  // namespace

TableRow look_up(const QueryTable& table, double moment) {
    const RowsAround rows = rows_around(table, moment);
    const std::size_t n = rows.lo.nodes.size();
    TableRow out;
    out.moment = rows.cubic([](const TableRow& r) { return r.moment; });
    out.load = rows.cubic([](const TableRow& r) { return r.load; });
    out.nodes.resize(n);
    out.angles.resize(n);
    out.moments.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        out.nodes[i] = rows.cubic([i](const TableRow& r) { return r.nodes[i]; });
        out.angles[i] = rows.cubic([i](const TableRow& r) { return r.angles[i]; });
        out.moments[i] = rows.cubic([i](const TableRow& r) { return r.moments[i]; });
    }
    return out;
}

namespace {

FixedShape stand(const QueryTable& table, const TableRow& row, double root_height, double holder_angle, double mu,
                 double lambda) {
    FixedShape out;
    out.moment = row.moment;
    out.holder_angle = holder_angle;
    out.tip_angle = std::numbers::pi / 2 - holder_angle + row.angles.front();
    const Vec2 axis{std::cos(holder_angle), -std::sin(holder_angle)}, side{-axis.y, axis.x};
    for (const Vec2& b : row.nodes) out.nodes.push_back(Vec2{0, root_height} + b.x * axis + b.y * side);
    const double lever = std::max(std::abs(out.nodes.front().x), 0.1 * table.length);
    out.reaction = lambda * row.moment / lever;
    out.friction = mu * out.reaction;
    return out;
}

/// Holder angle that puts the tip of a row on the plane.
double standing_angle(const TableRow& row, double root_height) {
    const Vec2& tip = row.nodes.front();
    const double reach = glm::length(tip);
    return std::atan2(tip.y, tip.x) + std::asin(std::clamp(root_height / reach, -1.0, 1.0));
}

}  // namespace

FixedShape fixed_shape(const QueryTable& table, double moment, double root_height, double mu, double lambda) {
    const TableRow row = look_up(table, moment);
    return stand(table, row, root_height, standing_angle(row, root_height), mu, lambda);
}

FixedShape fixed_shape_at_angle(const QueryTable& table, double root_height, double holder_angle, double mu,
                                double lambda) {
    // The tip's height rises with the moment; the first row that lifts it to the plane counts.
    const double moment = touching_moment(table, root_height, {-std::sin(holder_angle), std::cos(holder_angle)});
    return stand(table, look_up(table, moment), root_height, holder_angle, mu, lambda);
}

double touching_moment(const QueryTable& table, double root_height, const Vec2& up) {
    const auto height = [&](const Vec2& tip) { return root_height + glm::dot(tip, up); };
    if (height(table.rows.front().nodes.front()) >= 0) return 0;
    std::size_t k = 1;
    while (k < table.rows.size() && height(table.rows[k].nodes.front()) < 0) ++k;
    if (k == table.rows.size()) return table.rows.back().moment;
    double lo = table.rows[k - 1].moment, hi = table.rows[k].moment;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (lo + hi);
        const Vec2 tip = rows_around(table, middle).cubic([](const TableRow& r) { return r.nodes.front(); });
        (height(tip) < 0 ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

}  // namespace tuft::brush
