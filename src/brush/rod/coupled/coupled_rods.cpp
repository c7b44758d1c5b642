#include "brush/rod/coupled/coupled_rods.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "brush/rod/coupled/coupled_energy.h"

namespace tuft::brush::rod {

namespace {

using BufferStore = std::deque<Buffers, Recycler<Buffers>>;  ///< a Buffers stays where it is

constexpr double kSettled = 1e-3;  ///< change of t and m between passes, radians, that is no change

struct Work {
    Recycled<Solver> solvers;
    Recycled<FrozenPair> pairs;
    Recycled<double> miss;  ///< of the pairs' lagged normal forces in the pass before
    double relaxation = 1;  ///< of those forces
};

FrozenPair frozen_pair(const CoupledPair& pair, std::span<const CoupledRod> rods) {
    const Rod &a = *rods[pair.first].rod, &b = *rods[pair.second].rod;
    FrozenPair out;
    out.pair = &pair;
    out.nodes = std::min({a.segments(), b.segments(), static_cast<int>(pair.touching.size()) - 1}) + 1;
    const auto n = static_cast<std::size_t>(out.nodes);
    for (std::size_t i = 0; i < n; ++i) out.weight.push_back(std::min(a.weight[i], b.weight[i]));
    out.node.resize(n);
    out.curvature.resize(n);
    pair.memory->slip.resize(n, Vec2{0});
    pair.memory->normal.resize(n, 0);
    pair.memory->growth.resize(n, 0);
    out.normal = out.lagged = pair.memory->normal;
    return out;
}

/// Starts the lagged normal forces from those of the last solve, changed on as they changed there.
void start_pairs(Work& w) {
    double part = 2;
    for (const Solver& s : w.solvers) part = std::min(part, s.stands() ? 0 : s.step_ratio());
    for (FrozenPair& f : w.pairs) {
        if (f.pair->guess.size() == f.lagged.size()) {
            f.lagged.assign(f.pair->guess.begin(), f.pair->guess.end());
            continue;
        }
        for (std::size_t i = 0; i < f.lagged.size(); ++i)
            f.lagged[i] = std::max(0.0, f.normal[i] + part * f.pair->memory->growth[i]);
    }
}

/// Starts all rods from their proposed shapes where Π is lower there, as one rod does; `work`: what that takes.
void start(std::span<const CoupledRod> rods, Work& w, CoupledSystem& system, SolverWork& work) {
    bool proposed = true;
    for (std::size_t k = 0; k < rods.size(); ++k) proposed = w.solvers[k].propose_shape(rods[k].guess) && proposed;
    ++work.evaluations;
    if (proposed) {
        for (Solver& s : w.solvers) {
            s.ws.at.node = s.ws.ahead;
            std::swap(s.shape, s.ws.next);
        }
        system.freeze_pairs();
        system.evaluate_all();
        ++work.values;
        if (system.value() < system.value_of_next()) return;
        for (Solver& s : w.solvers) std::swap(s.shape, s.ws.next);
        ++work.evaluations;
    }
    for (Solver& s : w.solvers) {
        s.ws.at.node = s.memory.node;
        s.freeze_friction(s.memory.node, s.shape.tangent);
    }
    system.freeze_pairs();
    system.evaluate_all();
}

/// Residual to which the next pass is solved: one rod's for the mean of their forces. Rods that are lifted have none,
/// and wait for the others.
double tolerance_of_pass(const Work& w) {
    ForceChange mean;
    for (const Solver& s : w.solvers) {
        if (s.is_exact()) return 0;
        mean.change += s.passes.forces.change / static_cast<double>(w.solvers.size());
        mean.sum += s.passes.forces.sum / static_cast<double>(w.solvers.size());
    }
    return pass_tolerance(mean);
}

Recycled<FrozenNode> nodes_of(std::span<const FrozenPair> pairs) {
    Recycled<FrozenNode> out;
    for (const FrozenPair& f : pairs) out.insert(out.end(), f.node.begin(), f.node.end());
    return out;
}

/// The directions and the sliding forces of the pairs hardly changed from one pass to the next.
bool settled(std::span<const FrozenNode> before, std::span<const FrozenNode> now, double pass_tolerance) {
    double change = 0, sum = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (glm::distance(before[i].tangent, now[i].tangent) > kSettled) return false;
        if (std::isfinite(now[i].cap)) {
            change += std::abs(now[i].cap - before[i].cap);
            sum += now[i].cap;
        }
    }
    return change <= pass_tolerance * sum + 1e-12;
}

/// Moves the lagged normal forces of all pairs towards those of the pass, by Aitken's rule from the second pass on.
void relax_pairs(Work& w, int pass) {
    double along = 0, before = 0;
    std::size_t at = 0;
    for (const FrozenPair& f : w.pairs) {
        for (std::size_t i = 0; i < f.normal.size(); ++i, ++at) {
            const double miss = f.normal[i] - f.lagged[i];
            if (pass == 1) {
                w.miss.push_back(miss);
                continue;
            }
            along += miss * w.miss[at];
            before += w.miss[at] * w.miss[at];
            w.miss[at] = miss;
        }
    }
    // As for the normal forces of one rod, see Solver::relax.
    const double ratio = before > 0 ? along / before : 0;
    if (pass > 1) w.relaxation = std::clamp(w.relaxation / std::max(1 - ratio, 0.2), 0.2, 1.5);
    at = 0;
    for (FrozenPair& f : w.pairs)
        for (double& n : f.lagged) n = std::max(0.0, n + w.relaxation * w.miss[at++]);
}

/// A spring of stiffness k on the shift u that slid where it passed `cap`: its slip moves on.
void slide(double k, double cap, double weight, double u, double& slip, CoupledResult& out) {
    const double strain = u - slip, most = cap / k, size = std::abs(strain);
    if (size > most) {
        out.dissipation += weight * cap * (size - most);
        slip = u - (strain > 0 ? most : -most);
    }
    const double held = std::min(size, most);
    out.energy += weight * 0.5 * k * held * held;
}

PairState finish_pair(const FrozenPair& f, const CouplingLaw& law, const Work& w, CoupledResult& out) {
    PairState state;
    PairMemory& memory = *f.pair->memory;
    const Recycled<Vec3>&x = w.solvers[f.pair->first].ws.at.node, &y = w.solvers[f.pair->second].ws.at.node;
    for (int i = 0; i < f.nodes; ++i) {
        const FrozenNode& frozen = f.node[i];
        const Vec3 d = y[i] - x[i];
        const double distance = glm::dot(d, frozen.row);
        const double touching = f.pair->touching[i], spread = f.pair->spread.empty() ? touching : f.pair->spread[i];
        const PairEnergy u = pair_energy(f.pair->law_at(law, i), touching, spread, distance);
        out.energy += f.weight[i] * frozen.faces * u.value;
        const double normal = frozen.faces * u.normal;
        // As for a contact's force, see ContactMemory.
        memory.growth[i] =
            normal > 0 && memory.normal[i] > 0 ? 0.5 * (memory.growth[i] + normal - memory.normal[i]) : 0;
        memory.normal[i] = normal;
        state.distance.push_back(distance);
        state.gap.push_back(distance - touching);
        state.faces.push_back(frozen.faces);
        if (law.shear <= 0) continue;
        slide(law.shear, frozen.cap, f.weight[i], glm::dot(d, frozen.across), memory.slip[i].y, out);
    }
    for (int j = 0; j < f.segments() && law.shear > 0; ++j) {
        const double la = w.solvers[f.pair->first].rod.length[j], lb = w.solvers[f.pair->second].rod.length[j];
        const Vec3 mean = 0.5 * ((x[j + 1] - x[j]) / la + (y[j + 1] - y[j]) / lb);
        const double rest = f.pair->rest_shift.empty() ? 0 : f.pair->rest_shift[j];
        const double cap = 0.5 * (f.node[j].cap + f.node[j + 1].cap);
        slide(law.shear, cap, std::min(la, lb), glm::dot(mean, y[j + 1] - x[j + 1]) - rest, memory.slip[j].x, out);
    }
    return state;
}

/// Moves the rods to their clamps and prepares the solvers; `buffers` holds one for each rod.
void begin(std::span<const CoupledRod> rods, std::span<const CoupledPair> pairs, BufferStore& buffers, Work& w) {
    while (buffers.size() < rods.size()) buffers.emplace_back();
    w.solvers.reserve(rods.size());
    for (std::size_t k = 0; k < rods.size(); ++k) {
        const CoupledRod& r = rods[k];
        buffers[k].before = r.memory->node;
        const double moved = clamp_distance(r.memory->clamp, r.clamp);
        move_with_clamp(*r.memory, r.clamp);
        w.solvers.push_back({*r.rod, *r.memory, r.obstacles, r.walls, *r.law, buffers[k], moved});
        w.solvers.back().begin(r.load, buffers[k].before);
    }
    for (const CoupledPair& pair : pairs) w.pairs.push_back(frozen_pair(pair, rods));
    start_pairs(w);
}

}  // namespace

CoupledResult solve_coupled(std::span<const CoupledRod> rods, std::span<const CoupledPair> pairs,
                            const CouplingLaw& law) {
    thread_local BufferStore buffers;
    Work w;
    begin(rods, pairs, buffers, w);
    CoupledSystem system(w.solvers, w.pairs, law);
    CoupledResult out;
    out.rods.resize(rods.size());
    const Law& first = *rods.front().law;
    start(rods, w, system, out.work);
    int iterations = 0, passes = 1, stalls = 0;
    bool converged = false;
    for (Solver& s : w.solvers) s.expect_forces();
    const auto minimise_pass = [&](double tolerance) {
        const NewtonResult r =
            minimise(system, {first.limits.max_iterations - iterations, stalls_left(first, stalls), tolerance});
        stalls += r.stalls;
        iterations += r.iterations;
        out.work += {.iterations = r.iterations, .evaluations = r.evaluations, .values = r.values};
        return r;
    };
    for (;; ++passes) {
        const double rough = tolerance_of_pass(w);
        NewtonResult r = minimise_pass(rough);
        const bool settles = std::all_of(w.solvers.begin(), w.solvers.end(),
                                         [](const Solver& s) { return s.fine.empty() || s.forces_settled(); });
        if (r.converged && rough > first.limits.tolerance && settles) r.converged = minimise_pass(0).converged;
        bool at_rest = r.converged;
        for (Solver& s : w.solvers) {
            if (!s.fine.empty() && !s.take_normal_forces(passes)) at_rest = false;
        }
        const Recycled<FrozenNode> before = nodes_of(w.pairs);
        relax_pairs(w, passes);
        system.freeze_pairs();
        converged = at_rest && settled(before, nodes_of(w.pairs), first.limits.pass_tolerance);
        if (converged || passes >= first.limits.max_passes || iterations >= first.limits.max_iterations ||
            stalls_left(first, stalls) <= 0)
            break;
        for (Solver& s : w.solvers) {
            s.ws.ahead = s.ws.at.node;
            s.freeze_friction(s.ws.ahead, s.shape.tangent);
        }
        system.evaluate_all();
        ++out.work.evaluations;
    }
    out.work.solves = 1;
    out.work.passes = passes;
    for (const FrozenPair& f : w.pairs) out.pairs.push_back(finish_pair(f, law, w, out));
    for (std::size_t k = 0; k < rods.size(); ++k) {
        Result& r = out.rods[k];
        r.converged = converged;
        r.iterations = iterations;
        r.passes = passes;
        Solver& s = w.solvers[k];
        s.ws.at.slope = system.own_slope(k);  // without the forces of its neighbours
        s.finish(r);
    }
    return out;
}

double elimination_residual(std::span<const CoupledRod> rods, std::span<const CoupledPair> pairs,
                            const CouplingLaw& law) {
    BufferStore buffers;
    Work w;
    begin(rods, pairs, buffers, w);
    CoupledSystem system(w.solvers, w.pairs, law);
    SolverWork work;
    start(rods, w, system, work);
    system.differentiate();
    system.differentiate_twice();
    if (!system.descend(0)) return std::numeric_limits<double>::infinity();
    const std::span<const double> g = system.gradient(), u = system.step();
    const Eigen::Map<const Eigen::VectorXd> gradient(g.data(), static_cast<Eigen::Index>(g.size())),
        step(u.data(), static_cast<Eigen::Index>(u.size()));
    return (system.dense() * step + gradient).cwiseAbs().maxCoeff() / gradient.cwiseAbs().maxCoeff();
}

}  // namespace tuft::brush::rod
