#include "brush/rod/coupled/coupled_energy.h"

#include <algorithm>
#include <cmath>

#include "core/ease.h"

namespace tuft::brush::rod {

namespace {

constexpr double kFaces = 0.5;  ///< of the depth, shift out of the row up to which neighbours face each other

Vec3 node_tangent(const Clamp& clamp, const Recycled<Vec3>& node, std::size_t i) {
    const Vec3 inner = i == 0 ? clamp.tangent : glm::normalize(node[i] - node[i - 1]);
    if (i + 1 >= node.size()) return inner;
    return inner + glm::normalize(node[i + 1] - node[i]);
}

/// A spring of stiffness k on the shift u that slides at the force `cap`.
struct Slider {
    double energy = 0, force = 0, stiffness = 0;
};

Slider slider(double k, double cap, double u) {
    if (k * std::abs(u) <= cap) return {0.5 * k * u * u, k * u, k};
    return {cap * (std::abs(u) - 0.5 * cap / k), u > 0 ? cap : -cap, 0};
}

}  // namespace

PairEnergy pair_energy(const CouplingLaw& law, double touching, double spread, double distance) {
    PairEnergy out;
    const double g = distance - touching, overlap = law.rest_gap() - g;
    if (overlap > 0) {
        out.normal = law.contact * overlap;
        out.value += 0.5 * law.contact * overlap * overlap;
        out.force += out.normal;
        out.stiffness += law.contact;
    }
    const double pressed = spread - distance;
    if (pressed > 0 && law.spread > 0) {
        out.value += 0.5 * law.spread * pressed * pressed;
        out.force += law.spread * pressed;
        out.stiffness += law.spread;
    }
    if (law.film > 0) {
        const double y = g / law.film_range, slope = law.film / law.film_range;
        if (y < 0) {
            out.value -= law.film * (1 - 3 * y);
            out.force -= 3 * slope;
        } else if (y < 1) {
            const double z = 1 - y;
            out.value -= law.film * z * z * z;
            out.force -= 3 * slope * z * z;
            out.stiffness -= 6 * slope / law.film_range * z;
        }
    }
    return out;
}

void CoupledSystem::freeze_pairs() {
    for (FrozenPair& f : pairs_) {
        const Solver &a = solvers_[f.pair->first], &b = solvers_[f.pair->second];
        const Recycled<Vec3>&x = a.ws.at.node, &y = b.ws.at.node;
        // The row's direction at rest is carried along the mean of both rods.
        const Vec2& row = f.pair->direction;
        const auto row_of = [&](const Clamp& c) { return row.x * c.side + row.y * glm::cross(c.tangent, c.side); };
        Vec3 along = glm::normalize(a.frozen.clamp.tangent + b.frozen.clamp.tangent);
        Vec3 out = row_of(a.frozen.clamp) + row_of(b.frozen.clamp);
        out = glm::normalize(out - glm::dot(out, along) * along);
        for (int i = 0; i < f.nodes; ++i) {
            const Vec3 sum = node_tangent(a.frozen.clamp, x, i) + node_tangent(b.frozen.clamp, y, i);
            const double size = glm::length(sum);
            const Vec3 t = size > 1e-6 ? sum / size : along;
            out = parallel_transport(out, along, t);
            out = glm::normalize(out - glm::dot(out, t) * t);
            along = t;
            FrozenNode& node = f.node[i];
            node.tangent = t;
            node.row = out;
            node.across = glm::cross(t, out);
            if (!f.pair->depth.empty()) {
                const double past = std::abs(glm::dot(y[i] - x[i], node.across)) / f.pair->depth[i];
                node.faces = 1 - smooth_step((past - kFaces) / (1 - kFaces));
            }
            const double normal = f.lagged[i];
            node.cap = std::isfinite(law_.friction) ? law_.friction * normal : law_.friction;
        }
    }
}

double CoupledSystem::add_coupling(Evaluation Workspace::*which, bool derivatives) {
    double value = 0;
    for (FrozenPair& f : pairs_) {
        Evaluation &a = solvers_[f.pair->first].ws.*which, &b = solvers_[f.pair->second].ws.*which;
        const CoupledPair& pair = *f.pair;
        for (int i = 0; i < f.nodes; ++i) {
            const FrozenNode& frozen = f.node[i];
            const Vec3 d = b.node[i] - a.node[i];
            const double touching = pair.touching[i], faces = frozen.faces;
            const PairEnergy u = pair_energy(pair.law_at(law_, i), touching,
                                             pair.spread.empty() ? touching : pair.spread[i], glm::dot(d, frozen.row));
            const Vec3& m = frozen.across;
            Slider out;
            if (law_.shear > 0) out = slider(law_.shear, frozen.cap, glm::dot(d, m) - pair.memory->slip[i].y);
            const double w = f.weight[i];
            value += w * (faces * u.value + out.energy);
            if (!derivatives) continue;
            f.normal[i] = faces * u.normal;
            const Vec3 slope = out.force * m - faces * u.force * frozen.row;
            const Sym3 curvature = faces * std::max(u.stiffness, 0.0) * outer(frozen.row) + out.stiffness * outer(m);
            a.slope[i] -= w * slope;
            b.slope[i] += w * slope;
            f.curvature[i] = w * curvature;
            a.curvature[i] += f.curvature[i];
            b.curvature[i] += f.curvature[i];
        }
        if (law_.shear > 0) value += add_shear(f, which, derivatives);
    }
    return value;
}

double CoupledSystem::add_shear(FrozenPair& f, Evaluation Workspace::*which, bool derivatives) {
    const Solver &first = solvers_[f.pair->first], &second = solvers_[f.pair->second];
    Evaluation &a = solvers_[f.pair->first].ws.*which, &b = solvers_[f.pair->second].ws.*which;
    double value = 0;
    f.shear.resize(f.segments());
    for (int j = 0; j < f.segments(); ++j) {
        const double la = first.rod.length[j], lb = second.rod.length[j], l = std::min(la, lb);
        const Vec3 ta = (a.node[j + 1] - a.node[j]) / la, tb = (b.node[j + 1] - b.node[j]) / lb;
        const Vec3 d = b.node[j + 1] - a.node[j + 1];
        const Vec3 mean = 0.5 * (ta + tb);
        const double rest = f.pair->rest_shift.empty() ? 0 : f.pair->rest_shift[j];
        const double cap = 0.5 * (f.node[j].cap + f.node[j + 1].cap);
        const Slider out = slider(law_.shear, cap, glm::dot(mean, d) - rest - f.pair->memory->slip[j].x);
        value += l * out.energy;
        if (!derivatives) continue;
        const SegmentShear& s = f.shear[j] = {l * out.force, l * out.stiffness, mean, 0.5 * d};
        a.slope[j + 1] -= s.force * s.mean;
        b.slope[j + 1] += s.force * s.mean;
    }
    return value;
}

void CoupledSystem::evaluate_all() {
    value_ = 0;
    own_slope_.resize(solvers_.size());
    for (std::size_t k = 0; k < solvers_.size(); ++k) {
        Solver& s = solvers_[k];
        evaluate(s.frozen, s.shape, s.ws.at);
        own_slope_[k] = s.ws.at.slope;
        value_ += s.ws.at.value;
    }
    value_ += add_coupling(&Workspace::at, true);
}

double CoupledSystem::value_of_next() {
    double value = 0;
    for (Solver& s : solvers_) value += value_of(s.frozen, s.ws.next, s.ws.trial);
    return value + add_coupling(&Workspace::trial, false);
}

void CoupledSystem::differentiate() {
    gradient_.clear();
    for (Solver& s : solvers_) {
        rod::differentiate(s.frozen, s.shape, s.ws.at, s.ws.derivatives);
    }
    // Shear also turns the tangents, ∂u/∂t = ½ d.
    for (const FrozenPair& f : pairs_) {
        for (const int side : {f.pair->first, f.pair->second}) {
            Solver& s = solvers_[side];
            for (std::size_t j = 0; j < f.shear.size(); ++j) {
                double* g = &s.ws.derivatives.gradient[2 * j];
                g[0] += f.shear[j].force * glm::dot(f.shear[j].half_distance, s.shape.side[j]);
                g[1] += f.shear[j].force * glm::dot(f.shear[j].half_distance, s.ws.derivatives.second[j]);
            }
        }
    }
    for (Solver& s : solvers_)
        gradient_.insert(gradient_.end(), s.ws.derivatives.gradient.begin(), s.ws.derivatives.gradient.end());
}

void CoupledSystem::differentiate_twice() {
    for (Solver& s : solvers_) rod::differentiate_twice(s.frozen, s.shape, s.ws.at, s.ws.derivatives);
    // On the unit sphere ∂²t/∂u² = −t.
    for (const FrozenPair& f : pairs_) {
        for (const int side : {f.pair->first, f.pair->second}) {
            Solver& s = solvers_[side];
            for (std::size_t j = 0; j < f.shear.size(); ++j) {
                const double straight = -f.shear[j].force * glm::dot(f.shear[j].half_distance, s.shape.tangent[j]);
                s.ws.derivatives.segment[j].own.m[0][0] += straight;
                s.ws.derivatives.segment[j].own.m[1][1] += straight;
            }
        }
    }
}

int CoupledSystem::newton_step(bool) {
    constexpr double kDamping[] = {0, 0.5, 3, 20, 200, 2000, 2e4};
    int cost = 0;
    bool usable = false;
    for (const double damping : kDamping) {
        ++cost;
        if (!descend(damping)) continue;
        usable = std::all_of(step_.begin(), step_.end(), [](double u) { return std::isfinite(u); });
        if (usable && longest_turn(step_) <= 2 * kLongestStep) return cost;
    }
    return usable ? cost : 0;
}

void CoupledSystem::advance_all(double scale) {
    std::size_t first = 0;
    for (Solver& s : solvers_) {
        const std::size_t size = 2 * s.shape.tangent.size();
        advance(s.shape, std::span(step_).subspan(first, size), scale, s.ws.next);
        first += size;
    }
}

void CoupledSystem::complete_step() {
    trial_value_ = 0;
    trial_slope_.resize(solvers_.size());
    for (std::size_t k = 0; k < solvers_.size(); ++k) {
        Solver& s = solvers_[k];
        evaluate(s.frozen, s.ws.next, s.ws.trial);
        trial_slope_[k] = s.ws.trial.slope;
        trial_value_ += s.ws.trial.value;
    }
    trial_value_ += add_coupling(&Workspace::trial, true);
}

double CoupledSystem::try_step(double scale) {
    advance_all(scale);
    complete_step();
    return trial_value_;
}

double CoupledSystem::probe_step(double scale) {
    advance_all(scale);
    return value_of_next();
}

void CoupledSystem::accept() {
    for (Solver& s : solvers_) {
        std::swap(s.shape, s.ws.next);
        std::swap(s.ws.at, s.ws.trial);
    }
    std::swap(own_slope_, trial_slope_);
    value_ = trial_value_;
}

}  // namespace tuft::brush::rod
