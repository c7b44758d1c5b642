#pragma once

#include <algorithm>
#include <array>

#include "brush/rod/rod.h"
#include "brush/rod/sym3.h"
#include "brush/rod/wedge.h"
#include "core/system/recycled.h"

/// \file
/// Energy Π of the rod and its derivatives, for frozen friction and multipliers. Internal to the rod solver.
namespace tuft::brush::rod {

/// Returns the clamp's frame: tangent, side and their cross product as columns.
inline Mat3 clamp_frame(const Clamp& c) {
    return {c.tangent, c.side, glm::cross(c.tangent, c.side)};
}

/// Position of contact point p: x = (1 − s) x_j + s x_{j+1}.
struct PointPlace {
    int node = 0;
    double s = 0;
};

/// Position on the hair as a linear combination of nodes, x = Σ w_k x_{first+k}, and the hair's direction there
/// towards the root, Σ d_k x_{first+k}.
struct Stencil {
    int first = 0, count = 0;
    double w[3] = {0, 0, 0}, d[3] = {0, 0, 0};

    Vec3 at(const Recycled<Vec3>& node) const { return sum(node, w); }
    Vec3 inwards(const Recycled<Vec3>& node) const { return sum(node, d); }

  private:
    Vec3 sum(const Recycled<Vec3>& node, const double* f) const {
        Vec3 x{0};
        for (int k = 0; k < count; ++k) x += f[k] * node[first + k];
        return x;
    }
};

/// Contact points [begin, end) nearest to node k. All their stencils use the same nodes.
struct PointRange {
    int begin = 0, end = 0;
};
inline PointRange points_of(int k, int per_segment, int segments) {
    const int half = per_segment / 2;
    return {std::max(1, per_segment * k - half),
            k < segments ? per_segment * (k + 1) - half : per_segment * segments + 1};
}

/// Crease beside a contact point: the planes of an edge near it, or of two neighbouring nodes.
struct Crease {
    double share = 0;  ///< 0: no crease, one plane; 1: a sharp crease
    bool convex = true;
    RoundedEdge edge;  ///< a concave crease uses its planes only
};

/// Returns the distance of x from the plane of `o`, or from both planes of a crease, rounded by `edge` where it is
/// concave.
Distance distance_of(const Obstacle& o, const Crease& crease, double edge, const Vec3& x);

/// An edge presses on little more than a point of the hair, which passes from contact point to contact point as the
/// hair moves over it: there the length of each is taken in pieces.
inline constexpr int kPieces = 4;
struct HairPiece {
    Stencil at;
    double weight = 0;  ///< its length; 0: beyond an end of the hair
    double radius = 0, compliance = 0;
};

struct Frozen;

/// Returns the plane that contact point p meets. At an edge it is the plane of the mean force on the point.
Obstacle met_by(const Frozen& frozen, int p, const Recycled<Vec3>& node);

struct Evaluation;

/// Returns true when all points of node k are out of reach of one plane.
bool is_clear(const Frozen& frozen, int k, const Evaluation& at);

/// `compute_patches` finds the patches of the nodes. `turn_patches` sets their axes from the friction of their points.
void compute_patches(Frozen& frozen);
void turn_patches(Frozen& frozen);

/// Adds the points of the patch of node k to `out` and returns their potential. Without `derivatives` it changes
/// nothing else.
double add_patch(const Frozen& frozen, int k, bool derivatives, Evaluation& out);

/// Adds contact point p to the slopes and curvatures of its nodes and returns its potential. Without `derivatives` it
/// changes nothing.
double add_contact(const Frozen& frozen, int p, bool derivatives, Evaluation& out);

/// Friction of one contact point, constant during one Newton solve.
struct Friction {
    double cap = 0;    ///< μ N̂, force at slip
    double stick = 0;  ///< force per displacement while sticking
    Vec3 anchor{0};
    Vec3 normal{0, 0, 1};          ///< unit, of the surface
    Vec3 grain{0};                 ///< unit, in the plane, along the hair towards the tip; zero: isotropic
    double along = 1, across = 1;  ///< factors on displacement along the grain and across
    double pore_cap = 0;           ///< resistance to motion along the grain
};

/// Contact points of a node that all meet planes of one normal, away from creases and without end compliance. Their
/// potential depends on heights along the normal and positions along and across the hair, which are linear in the
/// nodes.
struct Patch {
    bool flat = false;
    Vec3 normal{0, 0, 1}, along{1, 0, 0}, across{0, 1, 0};
    double along2 = 1, across2 = 1;  ///< factors of friction, squared
    double reach = 0;                ///< greatest height at which a point has a force
};
/// Node in the frame of its contact plane. Units of L.
struct PatchPoint {
    double height = 0;  ///< of the plane along the patch's normal, from the clamp
    Vec2 anchor{0};     ///< along the hair and across, from the clamp
};

/// What places and stencils of contact points were computed for.
struct PointGrid {
    Recycled<double> length;  ///< [n] of the segments
    int per_segment = 0;
    bool round = false;  ///< see `rounded`
};

/// Contact points of a rod, root to tip, then one per wall. All arrays are of the points; those of the contact are
/// empty without obstacles.
struct ContactPoints {
    Recycled<PointPlace> place;
    Recycled<Stencil> stencil;
    PointGrid placed;
    std::size_t walls_from = 0;           ///< index of the first point of a wall
    std::span<const Obstacle> obstacles;  ///< or empty
    Recycled<Crease> crease;
    Recycled<std::array<HairPiece, kPieces>> piece;  ///< of those over a convex crease
    Recycled<double> weight;                         ///< tributary lengths
    Recycled<Friction> friction;
    Recycled<double> multiplier;  ///< hard contact
    Recycled<double> compliance;  ///< end compliance: displacement per force
    Recycled<PatchPoint> spot;    ///< of those on patches
};

/// Constants of one Newton solve.
struct Frozen {
    const Rod* rod = nullptr;
    const Recycled<JointMemory>* joint = nullptr;
    const Law* law = nullptr;
    Load load;
    Clamp clamp;
    ContactPoints points;
    Recycled<Patch> patch;  ///< of the nodes, or none
};

/// Unit tangent t and unit normal s of every segment. The pair (s, t × s) is parallel-transported along the rod.
struct Shape {
    Recycled<Vec3> tangent, side;
};

/// φ = θ/sin θ, χ = -dφ/dc and dχ/dc as functions of c = cos θ.
struct AngleFunctions {
    double phi = 1, chi = 0, dchi = 0;
};

/// Bend of a joint, its moment and stiffness. Units of B0/L.
struct JointForce {
    Vec2 bend{0};                      ///< w: log of the outer tangent at the inner one
    AngleFunctions angle;              ///< of its angle
    Vec2 moment{0};                    ///< ∂ψ/∂w
    double d00 = 0, d01 = 0, d11 = 0;  ///< ∂²ψ/∂w²
    double energy = 0;
};

/// Value of Π and the terms of its derivatives. Reused between calls.
struct Evaluation {
    double value = 0;
    double contact = 0;          ///< part of it: indentation, end compliance, adhesion; no friction
    Recycled<Vec3> node;         ///< [n+1]
    Recycled<Vec3> slope;        ///< [n+1] ∂V/∂x_i of contact, friction and load
    Recycled<Sym3> curvature;    ///< [n+1] ∂²V/∂x_i²
    Recycled<Sym3> coupling;     ///< [n] ∂²V/∂x_i∂x_{i+1}
    Recycled<Sym3> across;       ///< [n] ∂²V/∂x_i∂x_{i+2}, the last of them 0
    Recycled<double> normal;     ///< of the contact points, normal force
    Recycled<JointForce> joint;  ///< [n]
};

/// Replaces each second derivative m over nodes k and l of a stencil by f(k, l, m).
template <class F>
void for_pairs(const Stencil& at, Evaluation& out, const F& f) {
    for (int k = 0; k < at.count; ++k) out.curvature[at.first + k] = f(k, k, out.curvature[at.first + k]);
    for (int k = 0; k + 1 < at.count; ++k) out.coupling[at.first + k] = f(k, k + 1, out.coupling[at.first + k]);
    if (at.count > 2) out.across[at.first] = f(0, 2, out.across[at.first]);
}

/// Adds curvature · f(k, l) to the second derivatives over nodes k and l of a stencil.
template <class F>
void add_curvature(const Stencil& at, const Sym3& curvature, Evaluation& out, const F& f) {
    for_pairs(at, out, [&](int k, int l, Sym3 sum) { return sum += f(k, l) * curvature; });
}

inline void add_slope(const Stencil& at, const double* w, const Vec3& slope, Evaluation& out) {
    for (int k = 0; k < at.count; ++k) out.slope[at.first + k] += w[k] * slope;
}

/// Adds the derivatives of a potential of the place `at` over that place.
inline void add_potential(const Stencil& at, const Vec3& slope, const Sym3& curvature, Evaluation& out) {
    add_slope(at, at.w, slope, out);
    add_curvature(at, curvature, out, [&](int k, int l) { return at.w[k] * at.w[l]; });
}

/// Computes the sides by parallel transport from the clamp along the rod.
void transport_sides(const Clamp& clamp, const Recycled<Vec3>& tangents, Recycled<Vec3>& sides);

/// Returns the load's end moment in the frame of any inner segment (plane bending).
Vec2 end_moment(const Frozen& frozen);

/// Evaluates Π and its terms. Joint moments in `out` exclude the end moment, whose work is part of Π.
void evaluate(const Frozen& frozen, const Shape& shape, Evaluation& out);

/// Returns Π alone. The rest of `out` is undefined afterwards.
double value_of(const Frozen& frozen, const Shape& shape, Evaluation& out);

/// A 2 × 2 matrix by rows, not symmetric.
struct Mat2 {
    double m[2][2] = {{0, 0}, {0, 0}};
};

/// First and second derivatives of Π with respect to steps along (side, tangent × side) of every segment. The
/// second derivatives exclude the nodes' curvatures through the lever arms.
struct Derivatives {
    struct Joint {
        double p[2], q[2];          ///< outer tangent in the inner segment's sides; inner tangent in the outer's
        double r[2][2];             ///< sides of the inner segment in those of the outer
        double ja[2][2], jb[2][2];  ///< ∂w with respect to steps of the inner and the outer segment
    };
    struct Segment {
        Mat2 own;      ///< with respect to its own steps
        Mat2 inboard;  ///< [i][k] with respect to step i of the inner neighbour and its own step k
    };
    Recycled<Joint> joint;      ///< [n]
    Recycled<double> gradient;  ///< [2n]
    Recycled<Vec3> second;      ///< [n] tangent × side
    Recycled<Segment> segment;  ///< [n]
};
/// `differentiate` computes the first derivatives; `differentiate_twice` adds the second for the same shape.
void differentiate(const Frozen& frozen, const Shape& shape, const Evaluation& at, Derivatives& out);
void differentiate_twice(const Frozen& frozen, const Shape& shape, const Evaluation& at, Derivatives& out);

/// Second-order expansion of Π about `shape`: views of what was computed there. `derivatives` holds both orders.
struct QuadraticModel {
    const Rod& rod;
    const Shape& shape;
    const Evaluation& at;
    const Derivatives& derivatives;
};

/// Buffer of `descend`: steps of each segment as functions of its inner node's displacement and of the inner
/// neighbour's steps.
struct Elimination {
    struct Gain {
        double rest[2] = {0, 0};
        Vec3 move[2] = {Vec3{0}, Vec3{0}};
        Mat2 inner;
    };
    Recycled<Gain> gain;
};

/// Solves (H + damping · (stiffness of the joints beside each segment)) u = −gradient for the steps u [2n], radians.
/// `damping` ≥ 0. With the node displacements as further unknowns, x_{j+1} = x_j + l_j T_j u_j, each segment couples
/// to its neighbours only, and elimination from tip to root costs O(n). Returns false where the matrix is not positive
/// definite.
bool descend(const QuadraticModel& model, double damping, Elimination& work, Recycled<double>& step);

/// Computes the lower half of H [2n × 2n, column major].
void fill_hessian(const QuadraticModel& model, Recycled<double>& hessian);

/// Computes the shape after steps u [2n] scaled by `scale`.
void advance(const Shape& from, std::span<const double> u, double scale, Shape& to);

/// Returns moment, stiffness and energy of joint j at bend w. `memory` holds its plastic state.
JointForce joint_force(const Rod& rod, int j, const JointMemory& memory, const Vec2& w);

/// Updates the plastic elements of joint j to bend w. Returns the energy dissipated by yielding.
double commit_joint(const Rod& rod, int j, JointMemory& memory, const Vec2& w);

/// Recovers the set of joint j over Δt/T = `time`. An element whose strain s opposes its set p = w − s creeps, s ←
/// s e^{−x time}, with x = clamp((t_rig − |p|/α_f)/(t_rig − t_ela)). A small set recovers fully; a set of t_rig
/// times the elastic range does not recover. Returns the dissipated energy, ≥ 0: a held bend gains no energy.
/// Source: after [Xu2004], eq. 5.10.
double recover_joint(const Rod& rod, int j, JointMemory& memory, double time);

/// Returns the energy stored in the plastic elements of joint j.
double stored_energy(const Rod& rod, int j, const JointMemory& memory, const Vec2& w);

/// Returns the log map w of `outer` at the inner segment (a, side): length θ in the direction of bending.
Vec2 bend_of(const Vec3& a, const Vec3& side, const Vec3& outer);

}  // namespace tuft::brush::rod
