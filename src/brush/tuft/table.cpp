#include "brush/tuft/table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/rod/rod.h"
#include "brush/tuft/tuft.h"

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
    law.tolerance = 1e-10;
    law.max_iterations = 200;
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
        const double t2 = t * t, t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * lo + (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * hi + (t3 - t2) * m1;
    }
};

}  // namespace

TableRow look_up(const QueryTable& table, double moment) {
    const std::vector<TableRow>& rows = table.rows;
    const double last = rows.back().moment;
    const double at = std::clamp(moment / last, 0.0, 1.0) * static_cast<double>(rows.size() - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(at), rows.size() - 2);
    const BetweenRows place{at - static_cast<double>(k), k == 0, k + 2 == rows.size()};
    const TableRow &r0 = rows[place.first ? k : k - 1], &r1 = rows[k], &r2 = rows[k + 1],
                   &r3 = rows[place.last ? k + 1 : k + 2];
    TableRow out;
    out.moment = place.cubic(r0.moment, r1.moment, r2.moment, r3.moment);
    out.load = place.cubic(r0.load, r1.load, r2.load, r3.load);
    for (std::size_t i = 0; i < r1.nodes.size(); ++i) {
        out.nodes.push_back(place.cubic(r0.nodes[i], r1.nodes[i], r2.nodes[i], r3.nodes[i]));
        out.angles.push_back(place.cubic(r0.angles[i], r1.angles[i], r2.angles[i], r3.angles[i]));
        out.moments.push_back(place.cubic(r0.moments[i], r1.moments[i], r2.moments[i], r3.moments[i]));
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
    const auto height = [&](const TableRow& row) {
        const Vec2& tip = row.nodes.front();
        return root_height - tip.x * std::sin(holder_angle) + tip.y * std::cos(holder_angle);
    };
    const double moment = touching_moment(table, height);
    return stand(table, look_up(table, moment), root_height, holder_angle, mu, lambda);
}

double touching_moment(const QueryTable& table, const std::function<double(const TableRow&)>& tip_height) {
    if (tip_height(table.rows.front()) >= 0) return 0;
    std::size_t k = 1;
    while (k < table.rows.size() && tip_height(table.rows[k]) < 0) ++k;
    if (k == table.rows.size()) return table.rows.back().moment;
    double lo = table.rows[k - 1].moment, hi = table.rows[k].moment;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (lo + hi);
        (tip_height(look_up(table, middle)) < 0 ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

}  // namespace tuft::brush
