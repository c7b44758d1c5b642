#include "ink/exchange/reservoir.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"

namespace tuft::ink {
namespace {

constexpr double kThread = 0.6;      ///< part of the film below which the ink under a hair breaks
constexpr double kThreadWets = 0.1;  ///< of the travel that a film takes: the thread under a hair is there at once

/// Part of the supply that comes without any bending: hair wets what it touches.
constexpr double kCapillarySupply = 0.25;
constexpr double kFlowStep = 0.005;                  // seconds
constexpr double kSoftEdge = 0.1;                    // of the width
constexpr double kWeight = 9810, kViscosity = 2e-3;  // N/m³, Pa·s: watery ink
constexpr int kNeighbours = 4;                       // of a bundle that it shares ink with, at least
constexpr std::size_t kMostSteps = 1000;             // of flow at once: 5 s, after which all is even

using Content = Reservoir::Content;
constexpr int kPlanes = Reservoir::kPlanes;

void check_layout(const ReservoirLayout& l) {
    double capacities = 0, before = 0;
    bool good = !l.bundles.empty() && !l.cell_ends.empty() && l.cell_capacities.size() == l.cell_ends.size();
    for (std::size_t c = 0; good && c < l.cell_ends.size(); ++c) {
        good = l.cell_ends[c] > before && l.cell_capacities[c] > 0;
        before = l.cell_ends[c];
        capacities += l.cell_capacities[c];
    }
    if (!good || std::abs(before - 1) > 1e-9 || std::abs(capacities - 1) > 1e-9)
        throw Error("the hair of a tuft cannot be divided so for its ink");
}

/// Pairs of bundles that lie next to each other: of each its nearest ones.
std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours(const std::vector<Vec2>& places) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    const auto n = static_cast<std::uint32_t>(places.size());
    std::vector<std::pair<double, std::uint32_t>> near;
    for (std::uint32_t i = 0; i < n; ++i) {
        near.clear();
        for (std::uint32_t j = 0; j < n; ++j)
            if (j != i) near.emplace_back(glm::distance(places[i], places[j]), j);
        std::sort(near.begin(), near.end());
        near.resize(std::min<std::size_t>(near.size(), kNeighbours));
        for (const auto& [distance, j] : near) pairs.emplace_back(std::min(i, j), std::max(i, j));
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

/// Part of cell i that lies within reach.
double part_within(const ReservoirLayout& l, std::size_t i, const Reach& reach) {
    const std::size_t c = i % l.cell_ends.size();
    const double begin = c == 0 ? 0 : l.cell_ends[c - 1], end = l.cell_ends[c];
    const double part = std::clamp((end - std::max(begin, 1 - reach.depth)) / (end - begin), 0.0, 1.0);
    if (reach.side == 0) return part;
    const double from_side = 0.5 - 0.5 * std::copysign(1.0, reach.side) * l.bundles[i / l.cell_ends.size()].x;
    return part * std::clamp((std::abs(reach.side) - from_side) / kSoftEdge + 0.5, 0.0, 1.0);
}

/// Planes of which some cell holds something.
Recycled<int> planes_in(const Reservoir& tuft) {
    Content most{};
    for (const Content& c : tuft.content)
        for (int p = 0; p < kPlanes; ++p) most[p] = std::max(most[p], c[p]);
    Recycled<int> planes;
    for (int p = 0; p < kPlanes; ++p)
        if (most[p] > 0) planes.push_back(p);
    return planes;
}

void flow_step(Reservoir& tuft, double seconds, std::span<const int> planes, std::span<Content> change,
               std::span<double> total) {
    const std::size_t n = tuft.content.size();
    for (std::size_t i = 0; i < n; ++i) {
        change[i].fill(0);
        total[i] = sum_of(tuft.content[i]);
    }
    for (const CellLink& link : tuft.links) {
        const double qa = total[link.a], qb = total[link.b];
        const double net = seconds * link.flow * (qa / tuft.cell_capacity[link.a] - qb / tuft.cell_capacity[link.b]);
        const double exchange = seconds * link.mixing * std::min(qa, qb);
        // Out of a and out of b, each of its own mixture.
        const double out_a = exchange + std::max(net, 0.0), out_b = exchange + std::max(-net, 0.0);
        const double part_a = qa > 0 ? out_a / qa : 0, part_b = qb > 0 ? out_b / qb : 0;
        for (const int p : planes) {
            const double f = part_a * tuft.content[link.a][p] - part_b * tuft.content[link.b][p];
            change[link.a][p] -= f;
            change[link.b][p] += f;
        }
    }
    for (std::size_t i = 0; i < n; ++i)
        for (const int p : planes) tuft.content[i][p] += change[i][p];
}

/// Calls f(cell, part) for each cell in contact, in order.
template <class F>
void each_touched(const Reservoir& tuft, std::span<const float> contact, F f) {
    const bool all = contact.size() != tuft.content.size();
    for (std::size_t i = 0; i < tuft.content.size(); ++i) {
        const double part = all ? tuft.cell_capacity[i] / tuft.capacity : static_cast<double>(contact[i]);
        if (part > 0) f(i, part);
    }
}

Mix mix_over(const Reservoir& tuft, std::span<const float> contact) {
    Content sum{};
    each_touched(tuft, contact, [&](std::size_t i, double part) {
        const double scale = part / tuft.cell_capacity[i];
        for (int p = 0; p < kPlanes; ++p) sum[p] += scale * tuft.content[i][p];
    });
    const double left = sum_of(sum);
    if (!(left > 0)) return tuft.mix();
    Mix parts{};
    for (int p = 0; p < kMaxPigments; ++p) parts[p] = static_cast<float>(sum[p] / left);
    return parts;
}

double saturation_over(const Reservoir& tuft, std::span<const float> contact) {
    double sum = 0, weight = 0;
    each_touched(tuft, contact, [&](std::size_t i, double part) {
        sum += part * tuft.saturation(i);
        weight += part;
    });
    return weight > 0 ? sum / weight : 0;
}

}  // namespace

double Reservoir::remaining() const {
    double sum = 0;
    for (const Content& c : content) sum += sum_of(c);
    return sum;
}

double Reservoir::pigment(int plane) const {
    double sum = 0;
    for (const Content& c : content) sum += c[plane];
    return sum;
}

double Reservoir::fullness() const {
    return capacity > 0 ? remaining() / capacity : 0;
}

double Reservoir::saturation(std::size_t cell) const {
    return cell_capacity[cell] > 0 ? sum_of(content[cell]) / cell_capacity[cell] : 0;
}

Mix Reservoir::mix() const {
    Mix parts{};
    const double left = remaining();
    if (left > 0)
        for (int p = 0; p < kMaxPigments; ++p) parts[p] = static_cast<float>(pigment(p) / left);
    return parts;
}

Reservoir make_reservoir(double millilitres, ReservoirLayout layout) {
    check_layout(layout);
    Reservoir tuft;
    tuft.capacity = tuft.rest_capacity = film_of_millilitres(millilitres);
    const std::size_t bundles = layout.bundles.size(), cells = layout.cell_ends.size();
    tuft.content.assign(bundles * cells, Content{});
    for (std::size_t k = 0; k < bundles; ++k)
        for (const double part : layout.cell_capacities)
            tuft.cell_capacity.push_back(tuft.capacity * part / static_cast<double>(bundles));
    const auto link = [&](std::size_t a, std::size_t b, double time, double mixing) {
        if (!(tuft.cell_capacity[a] > 0 && tuft.cell_capacity[b] > 0)) return;
        tuft.links.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                              std::min(tuft.cell_capacity[a], tuft.cell_capacity[b]) / time, 1 / mixing});
    };
    for (std::size_t k = 0; k < bundles; ++k)
        for (std::size_t c = 1; c < cells; ++c)
            link(k * cells + c - 1, k * cells + c, layout.refill_time, layout.mix_time);
    for (const auto& [i, j] : neighbours(layout.bundles))
        for (std::size_t c = 0; c < cells; ++c)
            link(i * cells + c, j * cells + c, layout.side_time, 10 * layout.mix_time);
    tuft.layout = std::move(layout);
    return tuft;
}

void compress(Reservoir& tuft, double part) {
    constexpr double kLeast = 1e-3;
    const double capacity = std::clamp(part, kLeast, 1.0) * tuft.rest_capacity;
    if (capacity == tuft.capacity) return;
    tuft.capacity = capacity;
    const std::size_t cells = tuft.n_cells();
    for (std::size_t i = 0; i < tuft.cell_capacity.size(); ++i)
        tuft.cell_capacity[i] =
            capacity * tuft.layout.cell_capacities[i % cells] / static_cast<double>(tuft.n_bundles());
}

double excess(const Reservoir& tuft) {
    return std::max(0.0, tuft.remaining() - tuft.capacity);
}

double dip(Reservoir& tuft, const Mix& mix, const Dip& how) {
    double pigments = 0, taken = 0;
    for (const float part : mix) pigments += static_cast<double>(part);
    for (std::size_t i = 0; i < tuft.content.size(); ++i) {
        const double within = part_within(tuft.layout, i, {how.depth, how.side});
        // The dipped part of the cell is filled; what it holds is spread over all of it.
        const double want =
            within * (std::min(how.level, kMostLevel) * tuft.cell_capacity[i] - sum_of(tuft.content[i]));
        if (!(want > 0)) continue;
        for (int p = 0; p < kMaxPigments; ++p) tuft.content[i][p] += want * static_cast<double>(mix[p]);
        tuft.content[i][kMaxPigments] += want * std::max(0.0, 1 - pigments);
        taken += want;
    }
    return taken;
}

double wipe(Reservoir& tuft, double part, const Reach& reach) {
    double gone = 0;
    for (std::size_t i = 0; i < tuft.content.size(); ++i) {
        const double less = std::clamp(part, 0.0, 1.0) * part_within(tuft.layout, i, reach);
        gone += less * sum_of(tuft.content[i]);
        for (double& v : tuft.content[i]) v *= 1 - less;
    }
    return gone;
}

double rinse(Reservoir& tuft) {
    const double left = tuft.remaining();
    for (Content& c : tuft.content) c.fill(0);
    return left;
}

Content take(Reservoir& tuft, double amount, const ContactCells& contact) {
    Content taken{};
    const double left = tuft.remaining();
    if (!(left > 0) || !(amount > 0)) return taken;
    amount = std::min(amount, left);
    const auto draw = [&](std::size_t i, double part) {
        for (int p = 0; p < kPlanes; ++p) {
            const double v = part * tuft.content[i][p];
            tuft.content[i][p] -= v;
            taken[p] += v;
        }
    };
    double lacking = amount;
    if (contact.size() == tuft.content.size()) {
        each_touched(tuft, contact, [&](std::size_t i, double part) {
            const double q = sum_of(tuft.content[i]);
            if (!(q > 0)) return;
            const double want = std::min({q, part * amount, lacking});
            draw(i, want / q);
            lacking -= want;
        });
    }
    const double rest = tuft.remaining();
    if (lacking > 0 && rest > 0) {
        const double part = std::min(lacking / rest, 1.0);
        for (std::size_t i = 0; i < tuft.content.size(); ++i) draw(i, part);
    }
    return taken;
}

double free_capacity(const Reservoir& tuft, const ContactCells& contact) {
    double sum = 0;
    each_touched(tuft, contact,
                 [&](std::size_t i, double) { sum += std::max(0.0, tuft.cell_capacity[i] - sum_of(tuft.content[i])); });
    return sum;
}

void absorb(Reservoir& tuft, const Content& lifted, const ContactCells& contact) {
    const double amount = sum_of(lifted);
    if (!(amount > 0)) return;
    double lacking = amount;
    const auto put = [&](std::size_t i, double v) {
        for (int p = 0; p < kPlanes; ++p) tuft.content[i][p] += v / amount * lifted[p];
        lacking -= v;
    };
    const auto free_of = [&](std::size_t i) { return std::max(0.0, tuft.cell_capacity[i] - sum_of(tuft.content[i])); };
    each_touched(tuft, contact, [&](std::size_t i, double share) {
        put(i, std::min({share * amount, free_of(i), lacking}));
    });
    // Into all the hair that is not full, alike.
    double free = 0;
    for (std::size_t i = 0; i < tuft.content.size() && lacking > 0; ++i) free += free_of(i);
    const double part = free > 0 ? std::min(1.0, lacking / free) : 0;
    for (std::size_t i = 0; i < tuft.content.size() && part > 0; ++i) put(i, std::min(part * free_of(i), lacking));
    if (lacking > 0) {
        const double beyond = lacking;
        each_touched(tuft, contact, [&](std::size_t i, double share) { put(i, share * beyond); });
        if (!tuft.content.empty()) put(0, lacking);  // what rounding of the parts left
    }
}

Mix mix_at(const Reservoir& tuft, const ContactCells& contact) {
    return mix_over(tuft, contact);
}
double saturation_at(const Reservoir& tuft, const ContactCells& contact) {
    return saturation_over(tuft, contact);
}

void flow(Reservoir& tuft, double dt, FlowTo to) {
    if (tuft.links.empty() || !(dt > 0)) return;
    tuft.unspent += dt;
    // Half a part in a million of a step: sums of times that mean a whole step give one.
    const double due = std::floor(tuft.unspent / kFlowStep + 5e-7);
    if (!(due >= 1) && to == FlowTo::whole_step) return;
    tuft.unspent = std::max(0.0, tuft.unspent - due * kFlowStep);
    const Recycled<int> planes = planes_in(tuft);
    Recycled<Content> change(tuft.content.size());
    Recycled<double> total(tuft.content.size());
    const std::size_t steps = std::min(static_cast<std::size_t>(std::min(due, 1e9)), kMostSteps);
    for (std::size_t k = 0; k < steps; ++k) flow_step(tuft, kFlowStep, planes, change, total);
    if (to == FlowTo::now) flow_step(tuft, std::exchange(tuft.unspent, 0), planes, change, total);
}

double drained_volume(const Reservoir& tuft, const Drain& drain, double dt) {
    const double free = (tuft.remaining() - tuft.capacity) / kFilmPerVolume;
    const double area = std::numbers::pi * drain.radius * drain.length;
    if (!(free > 0) || !(dt > 0) || !(area > 0)) return 0;
    const double c = 2 * std::numbers::pi * drain.radius * std::clamp(drain.slope, 0.0, 1.0) * kWeight /
                     (3 * kViscosity * area * area * area);
    return (free - free / std::sqrt(1 + 2 * c * free * free * dt)) * kFilmPerVolume;
}

double paper_quantity(double eta, double moment_factor, double remaining) {
    return eta * moment_factor * remaining;
}

double supply_quantity(double eta, double moment_factor, double remaining, double ds, double supply_length) {
    return -remaining * std::expm1(-eta * moment_factor * ds / supply_length);
}

DepositParams stamp_deposit(const Reservoir& tuft, const Ink& ink, const StampContact& contact,
                            const Substrate& substrate) {
    DepositParams out;
    out.transfer_length = static_cast<float>(std::lerp(1.0, kThreadWets, contact.by_hair) * ink.transfer_length);
    out.capacity = substrate.capacity;
    out.extinction = extinction_of(ink);
    out.mix = mix_over(tuft, contact.cells);
    const double left = tuft.remaining();
    if (!(left > 0)) {
        out.target = 0;
        return out;
    }
    const double near = contact.cells.empty() ? left : tuft.capacity * saturation_over(tuft, contact.cells);
    const double k = std::clamp(contact.moment_factor, 0.0, 1.0);
    const double squeezed = kCapillarySupply + (1 - kCapillarySupply) * k;
    const double offered = ink.supply * squeezed * near / ink.supply_length;  // film·m² per metre
    const double requested = ink.film * contact.width;
    double target = ink.film * std::min(1.0, 0.85 + 0.3 * k);
    if (requested > 0) target *= std::max(-std::expm1(-offered / requested), kThread * contact.by_hair);
    if (contact.area > 0) target = std::min(target, std::max(0.0, left - contact.pending) / contact.area);
    out.target = static_cast<float>(target);
    return out;
}

}  // namespace tuft::ink
