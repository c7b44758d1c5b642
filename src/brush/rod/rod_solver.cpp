#include "brush/rod/rod_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tuft::brush::rod {

double clamp_distance(const Clamp& a, const Clamp& b) {
    return glm::length(b.position - a.position) + glm::length(b.tangent - a.tangent) + glm::length(b.side - a.side);
}

namespace {

constexpr double kFirstTouch = 0.1;  ///< B0/L²: guess of a first contact's force
constexpr double kForcing = 0.01;    ///< residual of a pass over the change of the forces that its friction comes from
constexpr double kRoughest = 0.1;    ///< of the forces: a greater change counts as this
constexpr double kFaint = 0.02;      ///< B0/L²: normal force below which relative accuracy is no aim
constexpr double kStands =
    0.9;  ///< cosine of the bend, 26°, up to which hair stands and may yet buckle or fall to any side

/// Where a point first touched on its way from its last place, z0 off the surface, to `x`.
Vec3 touching_point(double z0, double z1, const Vec3& x_t0, const Vec3& x) {
    if (z0 <= 0 || z1 >= z0) return x;
    return x_t0 + std::min(1.0, z0 / (z0 - z1)) * (x - x_t0);
}

/// Hair along a tangent over a plane of unit normal.
struct Hair {
    Vec3 tangent{0}, plane{0};
    Vec3 grain{0};    ///< unit, along the hair in the plane; zero where it stands upright
    double lean = 0;  ///< sine of its angle to the normal
};

Hair hair_over(const Vec3& tangent, const Vec3& plane) {
    Hair hair{tangent, plane};
    const Vec3 flat = tangent - glm::dot(tangent, plane) * plane;
    const double lean = glm::length(flat);
    if (lean < 1e-6) return hair;
    hair.grain = flat / lean;
    hair.lean = lean;
    return hair;
}

/// Friction of a point at x for the next pass, from the normal force and hair known so far.
Friction friction_of(const FrictionLaw& law, const Hair& hair, double weight, double normal_force, const Vec3& anchor,
                     const Vec3& x) {
    Friction f;
    f.anchor = anchor;
    f.stick = law.stick_stiffness * weight;
    f.cap = law.coefficient * normal_force;
    f.normal = hair.plane;
    f.grain = hair.grain;
    f.along = 1 + (2 * law.grain - 1) * hair.lean;
    f.across = 1 + (1 - 2 * law.grain) * hair.lean;
    if (law.with_hair > 0 && hair.lean > 0) {
        Vec3 d = x - anchor;
        d -= glm::dot(d, hair.plane) * hair.plane;
        const double moved = glm::length(d);
        if (moved > 0) {
            const double with = std::max(0.0, -glm::dot(d, hair.grain) / moved);
            f.cap *= 1 - law.with_hair * hair.lean * with * with * with * with;
        }
    }
    return f;
}

}  // namespace

void Solver::begin(const Load& load, const Recycled<Vec3>& before) {
    shape.tangent = memory.tangent;
    transport_sides(memory.clamp, shape.tangent, shape.side);
    Vec3 a = memory.clamp.tangent, side = memory.clamp.side;
    for (int j = 0; j < n(); ++j) {
        // Frames are transported anew along the rod, so that spin gathered in one solve is dropped.
        memory.joint[j].bend = bend_of(a, side, shape.tangent[j]);
        recovered += recover_joint(rod, j, memory.joint[j], law.joints.recovery);
        a = shape.tangent[j];
        side = shape.side[j];
    }
    frozen.rod = &rod;
    frozen.joint = &memory.joint;
    frozen.law = &law;
    frozen.load = load;
    frozen.clamp = memory.clamp;
    compute_points(obstacles, memory.node, frozen, fine, walls);
    frozen.points.obstacles = fine;
    compute_patches(frozen);
    const std::size_t points = fine.size();
    frozen.points.friction.resize(points);
    for (Friction& f : frozen.points.friction) f.cap = 0;
    frozen.points.multiplier.assign(points, 0);
    lagged.normal.assign(points, 0);
    lagged.anchor.assign(points, Vec3{0});
    lagged.anchored.assign(points, 0);
    const double part = stands() ? 0 : step_ratio();
    double carried = 0;
    for (const ContactMemory& c : memory.contact) carried += c.force;
    memory.contact.resize(std::max(static_cast<std::size_t>(law.points_per_segment) * n() + 1, points));
    for (std::size_t p = 1; p < points; ++p) {
        const ContactMemory& c = memory.contact[p];
        const Vec3 x = point(memory.node, p);
        if (c.touching) {
            lagged.anchor[p] = transported_anchor(p, c, point(before, p));
            lagged.anchored[p] = 1;
            lagged.normal[p] = std::max(0.0, c.force + part * c.growth);
            frozen.points.multiplier[p] = c.multiplier;
        } else if (const double z = distance(p, x).z - fine[p].radius; z < 0) {
            const Vec3 from = point(before, p);
            lagged.anchor[p] = touching_point(distance(p, from).z - fine[p].radius, z, from, x);
            lagged.anchored[p] = 1;
            // Hair that touches for the first time sticks where it touched; without any
            // friction in the first pass it could slip to the wrong side of the hand.
            if (carried == 0) lagged.normal[p] = kFirstTouch;
        }
    }
}

Vec3 Solver::transported_anchor(std::size_t p, const ContactMemory& c, const Vec3& last) const {
    if (c.normal == Vec3{0}) return c.anchor;
    return last - parallel_transport(last - c.anchor, c.normal, normal_at(p, memory.node));
}

Distance Solver::distance(std::size_t p, const Vec3& x) const {
    return distance_of(fine[p], frozen.points.crease[p], law.edge, x);
}

Vec3 Solver::normal_at(std::size_t p, const Recycled<Vec3>& x) const {
    return frozen.points.crease[p].share <= 0 ? fine[p].normal : met_at(p, x).normal;
}

void Solver::freeze_friction(const Recycled<Vec3>& x, const Recycled<Vec3>& tangents) {
    if (fine.empty() || law.friction.coefficient <= 0) return;
    Hair hair;
    for (std::size_t p = 1; p < fine.size(); ++p) {
        frozen.points.friction[p].cap = 0;
        // A wall that is no more has no weight and no node; its contact in the last solve is not carried on.
        if (!lagged.anchored[p] || lagged.normal[p] <= 0 || frozen.points.weight[p] <= 0) continue;
        const PointPlace& at = place(p);
        const Vec3& tangent = tangents[at.s > 0 ? at.node : at.node - 1];
        const Vec3 at_point = point(x, p), plane = normal_at(p, x);
        if (tangent != hair.tangent || plane != hair.plane) hair = hair_over(tangent, plane);
        Friction f =
            friction_of(law.friction, hair, frozen.points.weight[p], lagged.normal[p], lagged.anchor[p], at_point);
        const bool tip = p + 1 == frozen.points.walls_from;
        const double c = std::min(0.0, glm::dot(tangent, plane));
        if (law.friction.end_share < 1) f.cap *= tip ? std::max(law.friction.end_share, 1 - c * c) : 1 - c * c;
        if (tip) {
            f.pore_cap = law.friction.pore_grip * lagged.normal[p] * (law.friction.end_share < 1 ? 1 - c * c : 1) *
                         std::max(0.0, -c);
        }
        frozen.points.friction[p] = f;
    }
    turn_patches(frozen);
}

bool Solver::propose_shape(const Guess* guess) {
    const bool guessed = guess && guess->tangent.size() == shape.tangent.size();
    const double part = step_ratio();
    if (!guessed && (memory.turn.empty() || part <= 0)) return false;
    Recycled<Vec3>& tangent = ws.next.tangent;
    tangent.resize(shape.tangent.size());
    ws.ahead = memory.node;
    const Mat3 frame = clamp_frame(memory.clamp);
    for (int j = 0; j < n(); ++j) {
        tangent[j] = guessed ? guess->tangent[j] : glm::normalize(shape.tangent[j] + part * (frame * memory.turn[j]));
        ws.ahead[j + 1] = ws.ahead[j] + rod.length[j] * tangent[j];
    }
    transport_sides(memory.clamp, tangent, ws.next.side);
    for (std::size_t p = 1; guessed && p < std::min(lagged.normal.size(), guess->force.size()); ++p)
        lagged.normal[p] = guess->force[p];
    if (!guessed && stands())
        freeze_friction(memory.node, shape.tangent);
    else
        freeze_friction(ws.ahead, tangent);
    return true;
}

bool Solver::stands() const {
    return glm::dot(memory.tangent.back(), memory.clamp.tangent) > kStands;
}

void Solver::start(const Guess* guess) {
    if (propose_shape(guess)) {
        evaluate(frozen, ws.next, ws.trial);
        ++work.evaluations;
        ++work.values;
        if (ws.trial.value < value_of(frozen, shape, ws.at)) {
            std::swap(shape, ws.next);
            std::swap(ws.at, ws.trial);
            return;
        }
    }
    freeze_friction(memory.node, shape.tangent);
    evaluate(frozen, shape, ws.at);
    ++work.evaluations;
}

double pass_tolerance(const ForceChange& forces) {
    return kForcing * std::min(forces.change, kRoughest * forces.sum);
}

ForceChange Solver::change_of_forces() const {
    ForceChange out;
    for (std::size_t p = 1; p < fine.size(); ++p) {
        out.change += std::abs(ws.at.normal[p] - (law.normal.hard ? frozen.points.multiplier[p] : lagged.normal[p]));
        out.sum += ws.at.normal[p];
    }
    return out;
}

bool Solver::is_settled(const ForceChange& change) const {
    return (law.friction.coefficient <= 0 && !law.normal.hard) ||
           change.change <= law.limits.pass_tolerance * (change.sum + kFaint);
}

bool Solver::take_normal_forces(int pass) {
    passes.forces = change_of_forces();
    passes.forces_changed = false;
    for (std::size_t p = 1; p < fine.size(); ++p) {
        const double fresh = ws.at.normal[p];
        passes.forces_changed = passes.forces_changed || (law.normal.hard && frozen.points.multiplier[p] != fresh) ||
                                (fresh > 0 && !lagged.anchored[p]);
        if (law.normal.hard) frozen.points.multiplier[p] = fresh;
        if (fresh > 0 && !lagged.anchored[p]) {
            lagged.anchor[p] = point(ws.at.node, p);
            lagged.anchored[p] = 1;
        }
    }
    if (law.friction.coefficient > 0 || law.normal.hard) relax(pass);
    return is_settled(passes.forces);
}

void Solver::relax(int pass) {
    double along = 0, before = 0;
    for (std::size_t p = 1; p < fine.size(); ++p) {
        const double miss = ws.at.normal[p] - lagged.normal[p];
        if (pass > 1) {
            along += miss * lagged.last_miss[p];
            before += lagged.last_miss[p] * lagged.last_miss[p];
        }
    }
    // The last miss went in with `relaxation`: ratio = 1 - relaxation (1 - slope of the map).
    const double ratio = before > 0 ? along / before : 0;
    if (pass > 1) passes.relaxation = std::clamp(passes.relaxation / std::max(1 - ratio, 0.2), 0.2, 1.5);
    lagged.last_miss.assign(fine.size(), 0);
    for (std::size_t p = 1; p < fine.size(); ++p) {
        const double miss = ws.at.normal[p] - lagged.normal[p];
        passes.forces_changed = passes.forces_changed || miss != 0;
        lagged.last_miss[p] = miss;
        lagged.normal[p] = std::max(0.0, lagged.normal[p] + passes.relaxation * miss);
    }
}

void Solver::expect_forces() {
    passes.forces.sum = std::accumulate(lagged.normal.begin(), lagged.normal.end(), 0.0);
    passes.forces.change = law.limits.pass_tolerance * passes.forces.sum;
}

NewtonResult Solver::minimise_pass(double tolerance, Result& done) {
    const NewtonResult r = newton(
        frozen, shape, ws, {law.limits.max_iterations - done.iterations, stalls_left(law, passes.stalls), tolerance});
    passes.stalls += r.stalls;
    done.iterations += r.iterations;
    work += {.iterations = r.iterations, .evaluations = r.evaluations, .values = r.values};
    return r;
}

Result Solver::run(const Guess* guess) {
    Result out;
    start(guess);
    expect_forces();
    for (out.passes = 1;; ++out.passes) {
        const double rough = is_exact() ? 0 : pass_tolerance(passes.forces);
        NewtonResult r = minimise_pass(rough, out);
        if (r.converged && rough > law.limits.tolerance && forces_settled())
            r.converged = minimise_pass(0, out).converged;
        const bool settled = fine.empty() || take_normal_forces(out.passes);
        out.converged = r.converged && settled;
        // At a kink of Π that no step leaves, a pass with the same friction is the pass before again.
        const bool stuck = out.passes > 1 && !r.converged && !r.moved && !passes.forces_changed;
        const bool spent = out.iterations >= law.limits.max_iterations || stalls_left(law, passes.stalls) <= 0;
        if (out.converged || stuck || spent || out.passes >= law.limits.max_passes) break;
        ws.ahead = ws.at.node;
        freeze_friction(ws.ahead, shape.tangent);
        evaluate(frozen, shape, ws.at);
        ++work.evaluations;
    }
    out.work = work;
    out.work.solves = 1;
    out.work.passes = out.passes;
    finish(out);
    return out;
}

void Solver::finish(Result& out) {
    const Evaluation& at = ws.at;
    out.moment.resize(n());
    out.dissipation += recovered;
    out.normal_force.assign(n() + 1, 0);
    out.contact_force.assign(n() + 1, Vec3{0});
    out.slip.assign(n() + 1, Vec3{0});
    if (fine.size() > frozen.points.walls_from) out.wall_force.assign(n() + 1, Vec3{0});
    out.contact_energy = at.contact;
    buffers.friction_sum.assign(n() + 1, 0);
    for (int j = 0; j < n(); ++j) {
        out.moment[j] = glm::length(at.joint[j].moment + end_moment(frozen));
        const Vec2 turn = at.joint[j].bend - memory.joint[j].bend;
        out.dissipation += law.joints.damping * rod.stiffness[j] * glm::dot(turn, turn);
        out.dissipation += commit_joint(rod, j, memory.joint[j], at.joint[j].bend);
        out.bend_energy += stored_energy(rod, j, memory.joint[j], at.joint[j].bend);
    }
    for (int i = 1; i <= n(); ++i) {
        Vec3 f = -at.slope[i];
        if (i == n()) f -= frozen.load.tip_force;
        out.contact_force[i] = f;
        out.force += f;
        out.root_moment += glm::cross(at.node[i] - at.node[0], f);
    }
    out.root_moment += glm::cross(at.node[n()] - at.node[0], frozen.load.tip_force);
    for (std::size_t p = 0; p < memory.contact.size(); ++p) finish_contact(p, out);
    for (int i = 0; i <= n(); ++i) out.slip[i] /= std::max(buffers.friction_sum[i], 1e-300);
    out.met.reserve(memory.node.size());
    for (std::size_t p = 0; p < std::min(fine.size(), frozen.points.walls_from); p += law.points_per_segment)
        out.met.push_back(met_at(p, at.node));
    const Mat3 back = glm::transpose(clamp_frame(memory.clamp));
    memory.turn.resize(shape.tangent.size());
    for (std::size_t j = 0; j < shape.tangent.size(); ++j) {
        memory.turn[j] = back * (shape.tangent[j] - memory.tangent[j]);
    }
    memory.moved = moved;
    memory.tangent = shape.tangent;
    memory.node = at.node;
}

void Solver::finish_contact(std::size_t p, Result& out) {
    ContactMemory& c = memory.contact[p];
    c.touching = p < fine.size() && ws.at.normal[p] > 0;
    if (!c.touching) {
        c = {};
        return;
    }
    const Stencil& at = frozen.points.stencil[p];
    // Half of it taken from before, so that what a pass leaves is not carried on at twice its size.
    c.growth = c.force > 0 ? 0.5 * (c.growth + ws.at.normal[p] - c.force) : 0;
    c.force = ws.at.normal[p];
    c.multiplier = law.normal.hard ? c.force : 0;
    const bool own = p < frozen.points.walls_from;
    for (int k = 0; k < at.count; ++k) {
        if (own)
            out.normal_force[at.first + k] += at.w[k] * c.force;
        else
            out.wall_force[at.first + k] += at.w[k] * c.force * fine[p].normal;
    }
    const Vec3 x = point(ws.at.node, p);
    const Friction& f = frozen.points.friction[p];
    const bool sticks = f.cap > 0 && f.stick > 0;
    c.normal = sticks ? f.normal : normal_at(p, ws.at.node);
    Vec3 d = lagged.anchored[p] && law.friction.coefficient > 0 ? x - lagged.anchor[p] : Vec3{0};
    d -= glm::dot(d, c.normal) * c.normal;
    c.anchor = x - d;
    if (!sticks) return;
    const double along = glm::dot(d, f.grain);
    const Vec3 side = d - along * f.grain;
    const double q = std::sqrt(f.along * f.along * along * along + f.across * f.across * glm::dot(side, side));
    const double reach = f.cap / f.stick;
    out.contact_energy += 0.5 * f.stick * std::min(q, reach) * std::min(q, reach);
    if (q > reach) {
        out.dissipation += f.cap * (q - reach);
        c.anchor = x - d * (reach / q);
        for (int k = 0; own && k < at.count; ++k) out.slip[at.first + k] += at.w[k] * f.cap * (1 - reach / q) * d;
    }
    for (int k = 0; own && k < at.count; ++k) buffers.friction_sum[at.first + k] += at.w[k] * f.cap;
}

}  // namespace tuft::brush::rod
