#include "brush/rod/rod_energy.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/simd.h"

namespace tuft::brush::rod {

namespace {

/// Bend at which the hairs of a joint lie on each other and stiffen, radians; more than any
/// smooth shape has between two segments.
constexpr double kFullBend = 1.2;
constexpr double kFullBendStiffness = 20;  ///< times the joint's own

/// Coefficients of θ/sin θ = Σ a_k v^k, v = (1 - cos θ)/2: a_{k+1}/a_k = 2(k+1)/(2k+3).
constexpr int kTerms = 12;
constexpr std::array<double, kTerms> kAngleSeries = [] {
    std::array<double, kTerms> a{1};
    for (int k = 0; k + 1 < kTerms; ++k) a[k + 1] = a[k] * 2 * (k + 1) / (2 * k + 3);
    return a;
}();

AngleFunctions angle_functions(double c, const Vec2& p) {
    const double v = 0.5 * (1 - c);
    if (v < 0.03) {                                                // 20°; what is left out is less than 1e-16
        double f = kAngleSeries[kTerms - 1], slope = 0, bend = 0;  // bend: half of the second derivative
        for (int k = kTerms - 1; k-- > 0;) {
            bend = bend * v + slope;
            slope = slope * v + f;
            f = f * v + kAngleSeries[k];
        }
        return {f, 0.5 * slope, -0.5 * bend};
    }
    double s = glm::length(p);
    const double theta = std::atan2(s, c);
    s = std::max(s, 1e-3);  // folded flat back: only reached from absurd poses
    const double d = s - theta * c;
    return {theta / s, d / (s * s * s), -(theta * s * s - 3 * c * d) / (s * s * s * s * s)};
}

/// Made when the program starts: the first hair that yields must not allocate.
const Quadrature kFibreRule = gauss_legendre(kFibres);

struct Fibre {
    double stiffness, limit;
};

Fibre fibre(const Rod& rod, int j, int f) {
    const Quadrature& q = kFibreRule;
    return {3 * rod.plastic_share * rod.stiffness[j] * q.x[f] * q.x[f] * q.w[f], rod.yield[j] / q.x[f]};
}

/// Constants of all fibres of a joint, see `fibre`.
struct FibreLaw {
    double stiffness, yield;  ///< of the joint: three times its plastic part
    const double *place, *weight;
};

/// Energy, moment and stiffness of each fibre; `xy` with the other sign.
struct FibreTerms {
    double energy[kFibres], x[kFibres], y[kFibres], xx[kFibres], xy[kFibres], yy[kFibres];
};

/// Of elements at the strain (x, y) that yield at their limits.
TUFT_CLONES void compute_fibres(const FibreLaw& law, const double* __restrict x, const double* __restrict y,
                                FibreTerms& __restrict out) {
    const double* __restrict place = law.place, * __restrict weight = law.weight;
    const double stiffness = law.stiffness, yield = law.yield;
    for (int f = 0; f < kFibres; ++f) {
        const double k = stiffness * place[f] * place[f] * weight[f], limit = yield / place[f];
        const double size = __builtin_sqrt(x[f] * x[f] + y[f] * y[f]);
        const double dx = x[f] / size, dy = y[f] / size, most = k * limit, round = most / size;
        const bool holds = size <= limit;
        out.energy[f] = holds ? 0.5 * k * size * size : most * (size - 0.5 * limit);
        out.x[f] = holds ? k * x[f] : most * dx;
        out.y[f] = holds ? k * y[f] : most * dy;
        out.xx[f] = holds ? k : round * dy * dy;
        out.xy[f] = holds ? 0 : round * dx * dy;
        out.yy[f] = holds ? k : round * dx * dx;
    }
}

void add_full_bend(double k, const Vec2& w, JointForce& out) {
    const double angle = glm::length(w), over = angle - kFullBend;
    if (over <= 0) return;
    const double kf = kFullBendStiffness * k;
    const Vec2 d = w / angle;
    out.energy += 0.5 * kf * over * over;
    out.moment += kf * over * d;
    const double round = kf * over / angle;
    out.d00 += kf * d.x * d.x + round * d.y * d.y;
    out.d01 += (kf - round) * d.x * d.y;
    out.d11 += kf * d.y * d.y + round * d.x * d.x;
}

}  // namespace

namespace {

struct Bend {
    Vec2 w{0};
    AngleFunctions angle;
};

Bend bend_between(const Vec3& a, const Vec3& side, const Vec3& outer) {
    const Vec2 p{glm::dot(side, outer), glm::dot(glm::cross(a, side), outer)};
    const AngleFunctions f = angle_functions(glm::dot(a, outer), p);
    return {f.phi * p, f};
}

}  // namespace

Vec2 bend_of(const Vec3& a, const Vec3& side, const Vec3& outer) {
    return bend_between(a, side, outer).w;
}

JointForce joint_force(const Rod& rod, int j, const JointMemory& memory, const Vec2& w) {
    JointForce out;
    out.bend = w;
    const double k = rod.stiffness[j];
    if (!memory.yielded && glm::dot(w, w) <= rod.yield[j] * rod.yield[j]) {
        out.energy = 0.5 * k * glm::dot(w, w);
        out.moment = k * w;
        out.d00 = out.d11 = k;
    } else {
        const double k_rest = (1 - rod.plastic_share) * k;
        out.energy = 0.5 * k_rest * glm::dot(w, w);
        out.moment = k_rest * w;
        out.d00 = out.d11 = k_rest;
        const Quadrature& q = kFibreRule;
        double x[kFibres], y[kFibres];
        for (int f = 0; f < kFibres; ++f) {
            const Vec2 s = memory.yielded ? memory.stop[f] + (w - memory.bend) : w;
            x[f] = s.x;
            y[f] = s.y;
        }
        FibreTerms terms;
        compute_fibres({3 * rod.plastic_share * k, rod.yield[j], q.x.data(), q.w.data()}, x, y, terms);
        for (int f = 0; f < kFibres; ++f) {
            out.energy += terms.energy[f];
            out.moment += Vec2{terms.x[f], terms.y[f]};
            out.d00 += terms.xx[f];
            out.d01 -= terms.xy[f];
            out.d11 += terms.yy[f];
        }
    }
    add_full_bend(k, w, out);
    return out;
}

double commit_joint(const Rod& rod, int j, JointMemory& memory, const Vec2& w) {
    double lost = 0;
    if (!memory.yielded && glm::dot(w, w) <= rod.yield[j] * rod.yield[j]) {
        memory.bend = w;
        return lost;
    }
    double size_of[kFibres];
    for (int f = 0; f < kFibres; ++f) {
        Vec2& s = memory.stop[f];
        s = memory.yielded ? s + (w - memory.bend) : w;
        size_of[f] = glm::length(s);
    }
    for (int f = 0; f < kFibres; ++f) {
        const Fibre fb = fibre(rod, j, f);
        Vec2& s = memory.stop[f];
        const double size = size_of[f];
        if (size > fb.limit) {
            lost += fb.stiffness * fb.limit * (size - fb.limit);
            s *= fb.limit / size;
        }
    }
    memory.yielded = true;
    memory.bend = w;
    return lost;
}

double recover_joint(const Rod& rod, int j, JointMemory& memory, double time) {
    constexpr double kElastic = 1, kRigid = 12;
    if (!memory.yielded || time <= 0) return 0;
    double lost = 0, left = 0;
    double x_before = 0, keep = 1;  // e^{−x time}: most elements have the same x
    for (int f = 0; f < kFibres; ++f) {
        const Fibre fb = fibre(rod, j, f);
        Vec2& s = memory.stop[f];
        const Vec2 set = memory.bend - s;
        if (glm::dot(s, set) < 0) {
            const double far = glm::length(set) / fb.limit;
            const double x = std::clamp((kRigid - far) / (kRigid - kElastic), 0.0, 1.0);
            if (x != x_before) keep = std::exp(-x * time);
            x_before = x;
            lost += 0.5 * fb.stiffness * (1 - keep * keep) * glm::dot(s, s);
            s *= keep;
        }
        const Vec2 after = memory.bend - s;
        left = std::max(left, glm::dot(after, after));
    }
    // What is left is less than any shape shows: the joint is as new.
    if (std::sqrt(left) < 1e-9) memory.yielded = false;
    return lost;
}

double stored_energy(const Rod& rod, int j, const JointMemory& memory, const Vec2& w) {
    JointForce limit;
    add_full_bend(rod.stiffness[j], w, limit);
    if (!memory.yielded) return limit.energy + 0.5 * rod.stiffness[j] * glm::dot(w, w);
    double sum = limit.energy + 0.5 * (1 - rod.plastic_share) * rod.stiffness[j] * glm::dot(w, w);
    for (int f = 0; f < kFibres; ++f) {
        sum += 0.5 * fibre(rod, j, f).stiffness * glm::dot(memory.stop[f], memory.stop[f]);
    }
    return sum;
}

void transport_sides(const Clamp& clamp, const Recycled<Vec3>& tangents, Recycled<Vec3>& sides) {
    sides.resize(tangents.size());
    Vec3 t = clamp.tangent, s = clamp.side;
    for (std::size_t j = 0; j < tangents.size(); ++j) {
        s = parallel_transport(s, t, tangents[j]);
        t = tangents[j];
        s = glm::normalize(s - glm::dot(s, t) * t);
        sides[j] = s;
    }
}

Vec2 end_moment(const Frozen& frozen) {
    const Clamp& c = frozen.clamp;
    const Vec3& toward = frozen.load.toward;
    return frozen.load.end_moment * Vec2{glm::dot(c.side, toward), glm::dot(glm::cross(c.tangent, c.side), toward)};
}

namespace {

/// Backward Euler: the joint resists its turn since the last solve.
double add_damping(const Frozen& frozen, int j, JointForce& joint) {
    const double k = frozen.law->joints.damping * frozen.rod->stiffness[j];
    if (k <= 0) return 0;
    const Vec2 turn = joint.bend - (*frozen.joint)[j].bend;
    joint.moment += k * turn;
    joint.d00 += k;
    joint.d11 += k;
    return 0.5 * k * glm::dot(turn, turn);
}

}  // namespace

namespace {

/// Π of the joints and the load; computes the nodes.
double add_joints(const Frozen& frozen, const Shape& shape, Evaluation& out) {
    const Rod& rod = *frozen.rod;
    const int n = rod.segments();
    out.node.resize(n + 1);
    out.joint.resize(n);
    double value = 0;
    const Vec2 moment = end_moment(frozen);
    Vec3 a = frozen.clamp.tangent, side = frozen.clamp.side;
    out.node[0] = frozen.clamp.position;
    for (int j = 0; j < n; ++j) {
        const Vec3& b = shape.tangent[j];
        const Bend bend = bend_between(a, side, b);
        out.joint[j] = joint_force(rod, j, (*frozen.joint)[j], bend.w);
        out.joint[j].angle = bend.angle;
        // A dead moment at the end does the same work in every joint.
        value += out.joint[j].energy - glm::dot(moment, out.joint[j].bend);
        out.joint[j].moment -= moment;
        value += add_damping(frozen, j, out.joint[j]);
        out.node[j + 1] = out.node[j] + rod.length[j] * b;
        a = b;
        side = shape.side[j];
    }
    return value - glm::dot(frozen.load.tip_force, out.node[n]);
}

double add_contacts(const Frozen& frozen, bool derivatives, Evaluation& out) {
    if (frozen.points.obstacles.empty()) return 0;
    const int per = frozen.law->points_per_segment;
    double value = 0;
    for (int k = 0; k <= frozen.rod->segments(); ++k) {
        if (frozen.patch[k].flat) {
            value += add_patch(frozen, k, derivatives, out);
        } else if (!is_clear(frozen, k, out)) {
            const PointRange range = points_of(k, per, frozen.rod->segments());
            for (int p = range.begin; p < range.end; ++p) value += add_contact(frozen, p, derivatives, out);
        }
    }
    for (std::size_t p = frozen.points.walls_from; p < frozen.points.obstacles.size(); ++p) {
        value += add_contact(frozen, static_cast<int>(p), derivatives, out);
    }
    return value;
}

}  // namespace

double value_of(const Frozen& frozen, const Shape& shape, Evaluation& out) {
    const double joints = add_joints(frozen, shape, out);
    return joints + add_contacts(frozen, false, out);
}

void evaluate(const Frozen& frozen, const Shape& shape, Evaluation& out) {
    const int n = frozen.rod->segments();
    out.slope.assign(n + 1, Vec3{0});
    out.curvature.assign(n + 1, Sym3{});
    out.coupling.assign(n, Sym3{});
    out.across.assign(n, Sym3{});
    out.normal.assign(frozen.points.obstacles.size(), 0.0);
    out.contact = 0;
    const double joints = add_joints(frozen, shape, out);
    out.slope[n] -= frozen.load.tip_force;
    out.value = joints + add_contacts(frozen, true, out);
}

void advance(const Shape& from, std::span<const double> u, double scale, Shape& to) {
    const std::size_t n = from.tangent.size();
    to.tangent.resize(n);
    to.side.resize(n);
    for (std::size_t j = 0; j < n; ++j) {
        const Vec3 &t = from.tangent[j], &s = from.side[j];
        const Vec3 moved = glm::normalize(t + scale * (u[2 * j] * s + u[2 * j + 1] * glm::cross(t, s)));
        const Vec3 side = parallel_transport(s, t, moved);
        to.tangent[j] = moved;
        to.side[j] = glm::normalize(side - glm::dot(side, moved) * moved);
    }
}

}  // namespace tuft::brush::rod
