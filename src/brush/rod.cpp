#include "brush/rod.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "brush/rod_energy.h"
#include "brush/rod_newton.h"

namespace tuft::brush::rod {

Rod make_rod(const Profile& profile, int n, double tip_ratio) {
    return make_rod(profile, spine_segments(n, tip_ratio));
}

Rod make_rod(const Profile& profile, std::span<const double> lengths) {
    const std::size_t n = lengths.size();
    Rod rod;
    rod.length.assign(lengths.begin(), lengths.end());
    rod.stiffness.resize(n);
    rod.yield.resize(n);
    rod.weight.assign(n + 1, 0);
    double node = 0, from = 0;
    for (std::size_t j = 0; j < n; ++j) {
        const double to = node + 0.5 * rod.length[j];
        rod.stiffness[j] = 1 / compliance(profile, from, to);
        rod.yield[j] = yield_moment(profile, node) / rod.stiffness[j];
        rod.weight[j] += 0.5 * rod.length[j];
        rod.weight[j + 1] += 0.5 * rod.length[j];
        from = to;
        node += rod.length[j];
    }
    // The clamp joint stands for the half segment beside it, where the moment of a load at
    // the tip is less by a quarter segment's lever; a little less than that, because yielding
    // grows faster than the moment (set within 2 % at 16 segments).
    if (n > 0) rod.yield[0] /= 1 - 0.225 * rod.length[0];
    rod.buckling = buckling_load(rod);
    return rod;
}

Rod outer_part(const Rod& rod, int first, double share) {
    Rod part;
    part.plastic_share = rod.plastic_share;
    part.length.assign(rod.length.begin() + first, rod.length.end());
    part.stiffness.assign(rod.stiffness.begin() + first, rod.stiffness.end());
    for (double& k : part.stiffness) k /= share;
    part.yield.assign(rod.yield.begin() + first, rod.yield.end());
    part.weight.assign(rod.weight.begin() + first, rod.weight.end());
    part.buckling = buckling_load(part);
    return part;
}

double buckling_load(const Rod& rod) {
    const Eigen::Index n = rod.segments();
    if (n < 2) return 0;
    // In φ = √l θ the load's form is |φ|² and the tip is held where v·φ = 0.
    DenseMatrix a = DenseMatrix::Zero(n, n);
    Eigen::VectorXd v(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        const double k = rod.stiffness[j], l = rod.length[j];
        v[j] = std::sqrt(l);
        a(j, j) += k / l;
        if (j == 0) continue;
        const double before = rod.length[j - 1];
        a(j - 1, j - 1) += k / before;
        a(j, j - 1) -= k / std::sqrt(l * before);
        a(j - 1, j) = a(j, j - 1);
    }
    v.normalize();
    const DenseMatrix held = DenseMatrix::Identity(n, n) - v * v.transpose();
    a = held * a * held + a.trace() * v * v.transpose();
    const Eigen::SelfAdjointEigenSolver<DenseMatrix> eigen(a, Eigen::EigenvaluesOnly);
    return eigen.info() == Eigen::Success ? eigen.eigenvalues()[0] : 0;
}

Memory make_memory(const Rod& rod, const Clamp& clamp) {
    Memory memory;
    memory.clamp = clamp;
    memory.tangent.assign(rod.segments(), clamp.tangent);
    memory.joint.resize(rod.segments());
    memory.contact.resize(rod.segments() + 1);
    memory.node = nodes(rod, memory);
    return memory;
}

namespace {

Mat3 clamp_frame(const Clamp& c) { return {c.tangent, c.side, glm::cross(c.tangent, c.side)}; }

/// How far a clamp went, turns counted at one length.
double clamp_distance(const Clamp& a, const Clamp& b) {
    return glm::length(b.position - a.position) + glm::length(b.tangent - a.tangent) +
           glm::length(b.side - a.side);
}

}  // namespace

void carry(Memory& memory, const Clamp& clamp) {
    const Clamp& was = memory.clamp;
    const Mat3 turn = clamp_frame(clamp) * glm::transpose(clamp_frame(was));
    for (Vec3& t : memory.tangent) t = glm::normalize(turn * t);
    for (Vec3& x : memory.node) x = clamp.position + turn * (x - was.position);
    memory.clamp = clamp;
}

void turn_about_clamp(Memory& memory, double angle) {
    const Quat turn = glm::angleAxis(angle, memory.clamp.tangent);
    const Vec3& root = memory.clamp.position;
    for (Vec3& t : memory.tangent) t = glm::normalize(turn * t);
    for (Vec3& x : memory.node) x = root + turn * (x - root);
    for (ContactMemory& c : memory.contact) {
        c.anchor = root + turn * (c.anchor - root);
        c.normal = turn * c.normal;
    }
    // In the joints' frames, which are carried out from the clamp, a turn of all is a turn in the plane.
    const double co = std::cos(angle), si = std::sin(angle);
    const auto turned = [&](const Vec2& v) { return Vec2{co * v.x - si * v.y, si * v.x + co * v.y}; };
    for (JointMemory& joint : memory.joint) {
        for (Vec2& s : joint.stop) s = turned(s);
        joint.bend = turned(joint.bend);
    }
    memory.turn.clear();
}

std::vector<Vec3> nodes(const Rod& rod, const Memory& memory) {
    std::vector<Vec3> x(rod.segments() + 1);
    x[0] = memory.clamp.position;
    for (int j = 0; j < rod.segments(); ++j) x[j + 1] = x[j] + rod.length[j] * memory.tangent[j];
    return x;
}

namespace {

constexpr double kFirstTouch = 0.1;   ///< B0/L²: guess of a first contact's force
constexpr double kFaint = 0.02;       ///< B0/L²: normal force below which relative accuracy is no aim

/// Where a point first touched on its way from its last place, z0 off the surface, to `x`.
Vec3 touching_point(double z0, double z1, const Vec3& x_t0, const Vec3& x) {
    if (z0 <= 0 || z1 >= z0) return x;
    return x_t0 + std::min(1.0, z0 / (z0 - z1)) * (x - x_t0);
}

/// Friction of a point for the next pass, from the normal force and tangent known so far.
Friction friction_of(const Law& law, const Vec3& plane, double weight, double normal_force,
                     const Vec3& anchor, const Vec3& x, const Vec3& tangent) {
    Friction f;
    f.anchor = anchor;
    f.stick = law.stick_stiffness * weight;
    f.cap = law.friction * normal_force;
    f.normal = plane;
    const Vec3 flat = tangent - glm::dot(tangent, plane) * plane;
    const double lean = glm::length(flat);
    if (lean < 1e-6) return f;
    const Vec3 hair = flat / lean;
    f.grain = hair;
    f.along = 1 + (2 * law.grain - 1) * lean;
    f.across = 1 + (1 - 2 * law.grain) * lean;
    if (law.with_hair > 0) {
        Vec3 d = x - anchor;
        d -= glm::dot(d, plane) * plane;
        const double moved = glm::length(d);
        if (moved > 0) {
            const double with = std::max(0.0, -glm::dot(d, hair) / moved);
            f.cap *= 1 - law.with_hair * lean * with * with * with * with;
        }
    }
    return f;
}

/// One solve: friction passes around Newton, then the memory moves on.
struct Solver {
    const Rod& rod;
    Memory& memory;
    std::span<const Obstacle> obstacles;   ///< of the nodes
    const Law& law;
    std::vector<Obstacle> fine;            ///< of the contact points
    Frozen frozen;
    Shape shape;
    std::vector<double> normal;       ///< lagged N̂
    std::vector<Vec3> anchor;
    std::vector<char> anchored;
    Workspace& ws;
    double moved = 0;                      ///< of the clamp since the last solve
    std::vector<double> last_miss = {};    ///< of N̂ in the pass before
    double relaxation = 1;
    double recovered = 0;                  ///< energy lost by the set going back

    int n() const { return rod.segments(); }

    void begin(const Load& load, const std::vector<Vec3>& before) {
        shape.tangent = memory.tangent;
        shape.side = transported_sides(memory.clamp, shape.tangent);
        Vec3 a = memory.clamp.tangent, side = memory.clamp.side;
        for (int j = 0; j < n(); ++j) {
            // Frames are laid anew along the rod, so that spin gathered in one solve is dropped.
            memory.joint[j].bend = bend_of(a, side, shape.tangent[j]);
            recovered += recover_joint(rod, j, memory.joint[j], law.recovery);
            a = shape.tangent[j];
            side = shape.side[j];
        }
        frozen.rod = &rod;
        frozen.joint = &memory.joint;
        lay_points();
        frozen.obstacles = fine;
        frozen.law = &law;
        frozen.load = load;
        frozen.clamp = memory.clamp;
        const std::size_t points = fine.size();
        frozen.friction.assign(points, {});
        lay_give();
        frozen.multiplier.assign(points, 0);
        normal.assign(points, 0);
        anchor.assign(points, Vec3{0});
        anchored.assign(points, 0);
        double carried = 0;
        for (const ContactMemory& c : memory.contact) carried += c.force;
        memory.contact.resize(static_cast<std::size_t>(law.points_per_segment) * n() + 1);
        for (std::size_t p = 1; p < points; ++p) {
            const ContactMemory& c = memory.contact[p];
            const Vec3 x = point(memory.node, p);
            if (c.touching) {
                anchor[p] = carried_anchor(p, c, point(before, p));
                anchored[p] = 1;
                normal[p] = c.force;
                frozen.multiplier[p] = c.multiplier;
            } else if (const double z = distance(p, x).z - fine[p].radius; z < 0) {
                const Vec3 from = point(before, p);
                anchor[p] = touching_point(distance(p, from).z - fine[p].radius, z, from, x);
                anchored[p] = 1;
                // Hair that touches for the first time sticks where it touched; without any
                // friction in the first pass it could slip to the wrong side of the hand.
                if (carried == 0) normal[p] = kFirstTouch;
            }
        }
    }

    /// The anchor of a point that stuck at `last`: what it is stretched along the surface
    /// turns with the surface's normal, so that neither a rounded edge nor a change of planes
    /// pulls at it.
    Vec3 carried_anchor(std::size_t p, const ContactMemory& c, const Vec3& last) const {
        if (c.normal == Vec3{0}) return c.anchor;
        return last - parallel_transport(last - c.anchor, c.normal, normal_at(p, memory.node));
    }

    PointPlace place(std::size_t p) const {
        return point_place(static_cast<int>(p), law.points_per_segment, n());
    }

    Vec3 point(const std::vector<Vec3>& x, std::size_t p) const {
        const PointPlace at = place(p);
        return (1 - at.s) * x[at.node] + at.s * x[at.node + 1];
    }

    /// Without the edge where x lies so far from it over one face that it feels only that one.
    Obstacle within_reach(const Obstacle& o, const Vec3& x) const {
        if (!o.at_edge()) return o;
        const double own = glm::dot(x - o.origin, o.normal), beyond = glm::dot(x - o.beyond_origin, o.beyond_normal);
        constexpr double kRoundings = 3;  // more than hair goes in one solve beside the edge's own rounding
        if (std::min(own, beyond) > -kRoundings * law.edge) return o;
        return own >= beyond ? Obstacle{o.origin, o.normal, o.radius} : Obstacle{o.beyond_origin, o.beyond_normal, o.radius};
    }

    /// The two planes of a point over a crease: those of an edge near the nodes beside it, or of
    /// the nodes themselves.
    void lay_crease(std::size_t p, const PointPlace& at, const Obstacle& from, const Obstacle& to) {
        const bool inner = at.s > 0 && at.s < 1;
        const bool near_first = at.s < 1 && from.at_edge(), near_last = at.s > 0 && to.at_edge();
        if (near_first || near_last) {
            const bool both = near_first && near_last;
            const Obstacle &edge = near_first ? from : to, &other = near_first ? to : from;
            const double part = !inner ? 0 : near_first ? at.s : 1 - at.s;
            if (lay_edge(p, edge, other, both, part)) return;
            // The other node is nearer, and on a third face.
            if (both) lay_edge(p, other, edge, false, 0);
            else std::tie(fine[p].origin, fine[p].normal) = std::tie(other.origin, other.normal);
            return;
        }
        lay_parted(p, at, from, to);
    }

    /// The planes of the edge near node `a`, those that node `b` has too interpolated towards
    /// it by `part`; false when b's plane is neither of them and b nearer.
    bool lay_edge(std::size_t p, const Obstacle& a, const Obstacle& b, bool both, double part) {
        Wedge w{{a.origin, a.beyond_origin}, {a.normal, a.beyond_normal}};
        const double straight = glm::dot(b.normal, w.normal[0]), turned = glm::dot(b.normal, w.normal[1]);
        constexpr double kSame = 0.9;  // cos 26°
        if (std::max(straight, turned) < kSame) {
            if (part > 0.5) return false;
            part = 0;
        }
        const auto towards = [&](int i, const Vec3& other_origin, const Vec3& other_normal) {
            if (part == 0 || glm::dot(w.normal[i], other_normal) < kSame) return;
            w.origin[i] += part * (other_origin - w.origin[i]);
            w.normal[i] = glm::normalize(w.normal[i] + part * (other_normal - w.normal[i]));
        };
        const int first = straight >= turned ? 0 : 1;
        towards(first, b.origin, b.normal);
        if (both) towards(1 - first, b.beyond_origin, b.beyond_normal);
        frozen.crease[p] = {1, true, w};
        return true;
    }

    /// A node's plane, or the one beyond the edge near it where that is more like n: which of the
    /// two is its own may change from step to step where it hangs over the edge.
    static Obstacle facing(const Obstacle& o, const Vec3& n) {
        if (!o.at_edge() || glm::dot(o.beyond_normal, n) <= glm::dot(o.normal, n)) return o;
        return {o.beyond_origin, o.beyond_normal, o.radius, o.origin, o.normal};
    }

    /// The planes of the nodes beside a point, or a node's own and the one next to it that
    /// differs most, where they part.
    void lay_parted(std::size_t p, const PointPlace& at, const Obstacle& from, const Obstacle& to) {
        Obstacle a = from, b = to;
        if (at.s == 0 || at.s == 1) {
            const int i = at.s == 0 ? at.node : at.node + 1;
            if (at.s == 1) a = to;
            b = facing(obstacles[i + 1 <= n() ? i + 1 : i - 1], a.normal);
            if (i > 1 && i < n()) {
                const Obstacle before = facing(obstacles[i - 1], a.normal);
                if (glm::dot(a.normal, before.normal) < glm::dot(a.normal, b.normal)) b = before;
            }
        }
        const double alike = glm::dot(a.normal, b.normal);
        constexpr double kAlike = 0.985, kApart = 0.90;  // 10° and 26°, as over smooth surfaces
        const double w = std::clamp((kAlike - alike) / (kAlike - kApart), 0.0, 1.0);
        if (w <= 0) return;
        Crease& c = frozen.crease[p];
        c.share = w * w * (3 - 2 * w);
        // Closest points that coincide are of an edge.
        c.convex = glm::dot(b.origin - a.origin, a.normal - b.normal) < 1e-9;
        c.wedge = {{a.origin, b.origin}, {a.normal, b.normal}};
    }

    Distance distance(std::size_t p, const Vec3& x) const {
        return distance_of(fine[p], frozen.crease[p], law.edge, x);
    }

    /// The plane that a contact point meets, and its unit normal.
    Obstacle met_at(std::size_t p, const std::vector<Vec3>& x) const {
        return met_by(frozen, static_cast<int>(p), x);
    }
    Vec3 normal_at(std::size_t p, const std::vector<Vec3>& x) const {
        return frozen.crease[p].share <= 0 ? fine[p].normal : met_at(p, x).normal;
    }

    /// Planes, radii and tributary lengths of the contact points.
    void lay_points() {
        if (obstacles.empty()) return;
        frozen.crease.assign(static_cast<std::size_t>(law.points_per_segment) * n() + 1, {});
        const int per = law.points_per_segment;
        fine.resize(static_cast<std::size_t>(per) * n() + 1);
        frozen.weight.assign(fine.size(), 0);
        for (std::size_t p = 0; p < fine.size(); ++p) {
            const PointPlace at = place(p);
            const Vec3 x = point(memory.node, p);
            const Obstacle a = within_reach(obstacles[at.node], x), b = within_reach(obstacles[at.node + 1], x);
            const Vec3 normal_sum = (1 - at.s) * a.normal + at.s * b.normal;
            const double size = glm::length(normal_sum);
            fine[p].origin = (1 - at.s) * a.origin + at.s * b.origin;
            fine[p].normal = size > 1e-6 ? normal_sum / size : a.normal;
            fine[p].radius = (1 - at.s) * a.radius + at.s * b.radius;
            if (law.edge > 0) lay_crease(p, at, a, b);
            if (p + 1 < fine.size()) {
                const double half = 0.5 * rod.length[at.node] / per;
                frozen.weight[p] += half;
                frozen.weight[p + 1] += half;
            }
        }
    }

    /// How much the hair's ends give at each contact point: 1/k_e, k_e = 2 P s_e^-2 per length
    /// so that a straight end takes the buckling load P at s_e.
    void lay_give() {
        frozen.give.assign(fine.size(), 0);
        if (law.end_give <= 0 || law.hard || rod.buckling <= 0) return;
        const double soft = law.end_give * law.end_give / (2 * rod.buckling);
        double from_tip = 0;
        for (std::size_t p = fine.size(); p-- > 1;) {
            const double window = 1 - from_tip / (4 * law.end_give);
            if (window <= 0) break;
            frozen.give[p] = soft * window * window / frozen.weight[p];
            from_tip += rod.length[place(p - 1).node] / law.points_per_segment;
        }
    }

    void freeze_friction(const std::vector<Vec3>& x) {
        if (fine.empty() || law.friction <= 0) return;
        for (std::size_t p = 1; p < fine.size(); ++p) {
            frozen.friction[p] = {};
            if (!anchored[p] || normal[p] <= 0) continue;
            const PointPlace at = place(p);
            const Vec3& tangent = shape.tangent[at.s > 0 ? at.node : at.node - 1];
            const Vec3 at_point = point(x, p), plane = normal_at(p, x);
            Friction f = friction_of(law, plane, frozen.weight[p], normal[p], anchor[p], at_point, tangent);
            const bool tip = p + 1 == fine.size();
            const double c = std::min(0.0, glm::dot(tangent, plane));
            if (law.end_friction < 1) f.cap *= tip ? std::max(law.end_friction, 1 - c * c) : 1 - c * c;
            if (tip) {
                f.pore_cap = law.pore_grip * normal[p] * (law.end_friction < 1 ? 1 - c * c : 1) * std::max(0.0, -c);
            }
            frozen.friction[p] = f;
        }
    }

    /// Starts from the shape carried on as it changed in the last solve, if Π is lower there.
    void guess_onward() {
        if (memory.turn.empty() || memory.moved <= 0) return;
        const double part = std::min(2.0, moved / memory.moved);
        const Mat3 frame = clamp_frame(memory.clamp);
        ws.next.tangent.resize(shape.tangent.size());
        for (std::size_t j = 0; j < shape.tangent.size(); ++j) {
            ws.next.tangent[j] = glm::normalize(shape.tangent[j] + part * (frame * memory.turn[j]));
        }
        ws.next.side = transported_sides(memory.clamp, ws.next.tangent);
        evaluate(frozen, shape, ws.at);
        evaluate(frozen, ws.next, ws.trial);
        if (ws.trial.value < ws.at.value) std::swap(shape, ws.next);
    }

    /// Takes the normal forces of the pass; true when they no longer change.
    bool take_normal_forces(int pass) {
        double change = 0, sum = 0;
        for (std::size_t p = 1; p < fine.size(); ++p) {
            const double fresh = ws.at.normal[p];
            change += std::abs(fresh - (law.hard ? frozen.multiplier[p] : normal[p]));
            sum += fresh;
            if (law.hard) frozen.multiplier[p] = fresh;
            if (fresh > 0 && !anchored[p]) {
                anchor[p] = point(ws.at.node, p);
                anchored[p] = 1;
            }
        }
        if (law.friction <= 0 && !law.hard) return true;
        relax(pass);
        return change <= law.pass_tolerance * (sum + kFaint);
    }

    /// Moves N̂ towards the pass' normal forces, by Aitken's rule from the second pass on:
    /// friction lifts or lowers the tuft, so that plain substitution can swing to and fro.
    void relax(int pass) {
        double along = 0, before = 0;
        for (std::size_t p = 1; p < fine.size(); ++p) {
            const double miss = ws.at.normal[p] - normal[p];
            if (pass > 1) {
                along += miss * last_miss[p];
                before += last_miss[p] * last_miss[p];
            }
        }
        // The last miss went in with `relaxation`: ratio = 1 - relaxation (1 - slope of the map).
        const double ratio = before > 0 ? along / before : 0;
        if (pass > 1) relaxation = std::clamp(relaxation / std::max(1 - ratio, 0.2), 0.2, 1.5);
        last_miss.assign(fine.size(), 0);
        for (std::size_t p = 1; p < fine.size(); ++p) {
            last_miss[p] = ws.at.normal[p] - normal[p];
            normal[p] = std::max(0.0, normal[p] + relaxation * last_miss[p]);
        }
    }

    Result run() {
        Result out;
        std::vector<Vec3> x = memory.node;
        for (out.passes = 1;; ++out.passes) {
            freeze_friction(x);
            if (out.passes == 1) guess_onward();
            const NewtonResult r = newton(frozen, shape, ws, law.max_iterations - out.iterations);
            out.iterations += r.iterations;
            x = ws.at.node;
            const bool settled = fine.empty() || take_normal_forces(out.passes);
            out.converged = r.converged && settled;
            if (out.converged || out.passes >= law.max_passes ||
                out.iterations >= law.max_iterations) {
                break;
            }
        }
        finish(out);
        return out;
    }

    /// Forces from the last evaluation; stops and anchors move on.
    void finish(Result& out) {
        const Evaluation& at = ws.at;
        out.moment.resize(n());
        out.dissipation += recovered;
        out.normal_force.assign(n() + 1, 0);
        out.contact_force.assign(n() + 1, Vec3{0});
        for (int j = 0; j < n(); ++j) {
            out.moment[j] = glm::length(at.joint[j].moment + end_moment(frozen));
            const Vec2 turn = at.joint[j].bend - memory.joint[j].bend;
            out.dissipation += law.damping * rod.stiffness[j] * glm::dot(turn, turn);
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
        for (std::size_t p = 0; p < fine.size(); p += law.points_per_segment) out.met.push_back(met_at(p, at.node));
        const Mat3 back = glm::transpose(clamp_frame(memory.clamp));
        memory.turn.resize(shape.tangent.size());
        for (std::size_t j = 0; j < shape.tangent.size(); ++j) {
            memory.turn[j] = back * (shape.tangent[j] - memory.tangent[j]);
        }
        memory.moved = moved;
        memory.tangent = shape.tangent;
        memory.node = at.node;
    }

    void finish_contact(std::size_t p, Result& out) {
        ContactMemory& c = memory.contact[p];
        c.touching = p < fine.size() && ws.at.normal[p] > 0;
        if (!c.touching) {
            c = {};
            return;
        }
        const PointPlace at = place(p);
        c.force = ws.at.normal[p];
        c.multiplier = law.hard ? c.force : 0;
        out.normal_force[at.node] += (1 - at.s) * c.force;
        out.normal_force[at.node + 1] += at.s * c.force;
        const Vec3 x = point(ws.at.node, p);
        const Friction& f = frozen.friction[p];
        const bool sticks = f.cap > 0 && f.stick > 0;
        c.normal = sticks ? f.normal : normal_at(p, ws.at.node);
        Vec3 d = anchored[p] && law.friction > 0 ? x - anchor[p] : Vec3{0};
        d -= glm::dot(d, c.normal) * c.normal;
        c.anchor = x - d;
        if (!sticks) return;
        const double along = glm::dot(d, f.grain);
        const Vec3 side = d - along * f.grain;
        const double q = std::sqrt(f.along * f.along * along * along +
                                   f.across * f.across * glm::dot(side, side));
        const double reach = f.cap / f.stick;
        out.contact_energy += 0.5 * f.stick * std::min(q, reach) * std::min(q, reach);
        if (q > reach) {
            out.dissipation += f.cap * (q - reach);
            c.anchor = x - d * (reach / q);
        }
    }
};

}  // namespace

Result solve(const Rod& rod, Memory& memory, const Clamp& clamp,
             std::span<const Obstacle> obstacles, const Law& law, const Load& load) {
    thread_local Workspace workspace;
    const std::vector<Vec3> before = memory.node;
    const double moved = clamp_distance(memory.clamp, clamp);
    carry(memory, clamp);
    Solver solver{rod, memory, obstacles, law, {}, {}, {}, {}, {}, {}, workspace, moved};
    solver.begin(load, before);
    return solver.run();
}

Probe probe_energy(const Rod& rod, const Memory& memory, std::span<const Obstacle> obstacles,
                   const Law& law, const Load& load, std::span<const double> x) {
    Workspace ws;
    Memory copy = memory;
    Solver solver{rod, copy, obstacles, law, {}, {}, {}, {}, {}, {}, ws, 0};
    solver.begin(load, memory.node);
    for (std::size_t i = 0; i < solver.fine.size() && i < memory.contact.size(); ++i) {
        solver.normal[i] = memory.contact[i].force;
        if (memory.contact[i].force > 0) {
            solver.anchor[i] = memory.contact[i].anchor;
            solver.anchored[i] = 1;
        }
    }
    solver.freeze_friction(copy.node);
    Shape moved;
    advance(solver.shape, x, 1, moved);
    Probe probe;
    evaluate(solver.frozen, moved, ws.at);
    probe.value = ws.at.value;
    differentiate(solver.frozen, moved, ws.at, probe.gradient, ws.hessian);
    return probe;
}

}  // namespace tuft::brush::rod
