#pragma once

#include <algorithm>
#include <vector>

#include "brush/rod/rod.h"
#include "brush/rod/sym3.h"
#include "brush/rod/wedge.h"

/// Inside of the rod solver: Π and its derivatives for frozen friction and multipliers.
namespace tuft::brush::rod {

inline Mat3 clamp_frame(const Clamp& c) {
    return {c.tangent, c.side, glm::cross(c.tangent, c.side)};
}

/// Where contact point p lies: x = (1 - s) x_j + s x_{j+1}.
struct PointPlace {
    int node = 0;
    double s = 0;
};

/// A place of the hair among the nodes, x = Σ w_k x_{first+k}, and the hair's direction there towards the
/// root, Σ d_k x_{first+k}.
struct Stencil {
    int first = 0, count = 0;
    double w[3] = {0, 0, 0}, d[3] = {0, 0, 0};

    Vec3 at(const std::vector<Vec3>& node) const { return sum(node, w); }
    Vec3 inwards(const std::vector<Vec3>& node) const { return sum(node, d); }

  private:
    Vec3 sum(const std::vector<Vec3>& node, const double* f) const {
        Vec3 x{0};
        for (int k = 0; k < count; ++k) x += f[k] * node[first + k];
        return x;
    }
};

/// Contact points [begin, end) nearest to node k, all of whose stencils lie among the same nodes.
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
    double share = 0;  ///< 0: none, the point has one plane; 1: a sharp one
    bool convex = true;
    Wedge wedge;
};

/// From the plane of `o`, and over a crease from both its planes, rounded by `edge`.
Distance distance_of(const Obstacle& o, const Crease& crease, double edge, const Vec3& x);

struct Frozen;

/// The one plane that contact point p meets; over an edge that of the mean force on its hair.
Obstacle met_by(const Frozen& frozen, int p, const std::vector<Vec3>& node);

struct Evaluation;

/// True where the points of node k are all out of reach of one plane.
bool all_clear(const Frozen& frozen, int k, const Evaluation& at);

/// Finds the patches round the nodes; and sets their frames by their points' friction.
void lay_patches(Frozen& frozen);
void turn_patches(Frozen& frozen);

/// Adds the points of the patch round node k; returns their potential. Without `derivatives` nothing else.
double add_patch(const Frozen& frozen, int k, bool derivatives, Evaluation& out);

/// Adds contact point p to the slopes and curvatures of its nodes; returns its potential.
double add_contact(const Frozen& frozen, int p, Evaluation& out);

/// Friction of one contact point, frozen during one Newton solve.
struct Friction {
    double cap = 0;    ///< μ N̂, force at slip
    double stick = 0;  ///< force per displacement while sticking
    Vec3 anchor{0};
    Vec3 normal{0, 0, 1};          ///< unit, of the surface
    Vec3 grain{0};                 ///< unit, in the plane, along the hair towards the tip; zero: isotropic
    double along = 1, across = 1;  ///< factors on displacement along the grain and across
    double pore_cap = 0;           ///< force against being pushed along the grain
};

/// The contact points of a node where they all meet planes of one normal, away
/// from creases, with ends that do not give: their potential goes by heights along the normal and
/// by places along the hair and across it, which are linear in the nodes.
struct Patch {
    bool flat = false;
    Vec3 normal{0, 0, 1}, along{1, 0, 0}, across{0, 1, 0};
    double along2 = 1, across2 = 1;  ///< factors of friction, squared
    double reach = 0;                ///< greatest height from which a point is felt
};
struct PatchPoint {
    double height = 0;  ///< of the plane along the patch's normal, from the clamp
    Vec2 anchor{0};     ///< along the hair and across, from the clamp
};

/// Everything that stays fixed during one Newton solve.
struct Frozen {
    const Rod* rod = nullptr;
    const std::vector<JointMemory>* joint = nullptr;
    std::span<const Obstacle> obstacles;  ///< of the contact points, or none
    std::vector<PointPlace> place;        ///< of the contact points
    std::vector<Stencil> stencil;         ///< of the contact points
    std::vector<double> laid_length;      ///< segments for which place and stencil were laid,
    int laid_per = 0;                     ///< points per segment,
    bool laid_round = false;              ///< and whether rounded
    std::size_t walls_from = 0;           ///< contact points of walls are those from here on
    std::vector<Crease> crease;           ///< of the contact points
    std::vector<double> weight;           ///< of the contact points, tributary lengths
    const Law* law = nullptr;
    Load load;
    Clamp clamp;
    std::vector<Friction> friction;  ///< of the contact points
    std::vector<double> multiplier;  ///< of the contact points
    std::vector<double> give;        ///< of the contact points, end-on displacement per force
    std::vector<Patch> patch;        ///< of the nodes, or none
    std::vector<PatchPoint> spot;    ///< of the contact points on patches
};

/// Unit tangent t and unit normal s of every segment; the pair (s, t × s) moves without spin.
struct Shape {
    std::vector<Vec3> tangent, side;
};

/// φ = θ/sin θ, χ = -dφ/dc and dχ/dc as functions of c = cos θ.
struct AngleFunctions {
    double phi = 1, chi = 0, dchi = 0;
};

struct JointForce {
    Vec2 bend{0};                      ///< w: log of the outer tangent at the inner one
    AngleFunctions angle;              ///< of its angle
    Vec2 moment{0};                    ///< ∂ψ/∂w
    double d00 = 0, d01 = 0, d11 = 0;  ///< ∂²ψ/∂w²
    double energy = 0;
};

/// Value of Π and what its derivatives are made of. Reused between calls.
struct Evaluation {
    double value = 0;
    double contact = 0;             ///< of it: indentation, ends that give, the film; no friction
    std::vector<Vec3> node;         ///< [n+1]
    std::vector<Vec3> slope;        ///< [n+1] ∂V/∂x_i of contact, friction and load
    std::vector<Sym3> curvature;    ///< [n+1] ∂²V/∂x_i²
    std::vector<Sym3> coupling;     ///< [n] ∂²V/∂x_i∂x_{i+1}
    std::vector<Sym3> across;       ///< [n] ∂²V/∂x_i∂x_{i+2}, the last of them 0
    std::vector<double> normal;     ///< of the contact points, normal force
    std::vector<JointForce> joint;  ///< [n]
};

/// Sides by parallel transport from the clamp along the rod.
void transport_sides(const Clamp& clamp, const std::vector<Vec3>& tangents, std::vector<Vec3>& sides);

/// The load's end moment in the frame of any inner segment (plane bending).
Vec2 end_moment(const Frozen& frozen);

/// Joint moments in `out` are less the end moment, whose work is part of Π.
void evaluate(const Frozen& frozen, const Shape& shape, Evaluation& out);

/// Π alone; leaves `out` of use for nothing else.
double value_of(const Frozen& frozen, const Shape& shape, Evaluation& out);

struct Mat2 {
    double m[2][2] = {{0, 0}, {0, 0}};
};

/// First and second derivatives of Π over steps along (side, tangent × side) of every segment; the
/// second ones but for what the nodes' curvatures add through the lever arms.
struct Derivatives {
    struct Joint {
        double p[2], q[2];          ///< outer tangent over the inner segment's sides; and the other way round
        double r[2][2];             ///< sides of the inner over those of the outer segment
        double ja[2][2], jb[2][2];  ///< ∂w over steps of the inner and of the outer segment
    };
    struct Segment {
        Mat2 own;      ///< over its own steps
        Mat2 inboard;  ///< [i][k] over step i of the segment inboard and its own step k
    };
    std::vector<Joint> joint;      ///< [n]
    std::vector<double> gradient;  ///< [2n]
    std::vector<Vec3> second;      ///< [n] tangent × side
    std::vector<Segment> segment;  ///< [n]
};
/// The first ones, and then the second ones of the same shape.
void differentiate(const Frozen& frozen, const Shape& shape, const Evaluation& at, Derivatives& out);
void differentiate_twice(const Frozen& frozen, const Shape& shape, const Evaluation& at, Derivatives& out);

/// Buffer of `descend`: steps of each segment by the move of its inner node and the steps inboard.
struct Elimination {
    struct Gain {
        double rest[2] = {0, 0};
        Vec3 move[2] = {Vec3{0}, Vec3{0}};
        Mat2 inner;
    };
    std::vector<Gain> gain;
};

/// Solves (H + damping · (stiffness of the joints beside each segment)) u = -gradient for the steps
/// u [2n], by elimination from the tip to the root: with the moves of the nodes as further unknowns,
/// x_{j+1} = x_j + l_j T_j u_j, each segment only meets its neighbours. O(n). False where the matrix
/// is not positive definite.
bool descend(const Rod& rod, const Shape& shape, const Evaluation& at, const Derivatives& derivatives, double damping,
             Elimination& work, std::vector<double>& step);

/// Lower half of H [2n × 2n, column major].
void fill_hessian(const Rod& rod, const Shape& shape, const Evaluation& at, const Derivatives& derivatives,
                  std::vector<double>& hessian);

/// The shape after steps u [2n] scaled by `scale`.
void advance(const Shape& from, std::span<const double> u, double scale, Shape& to);

/// Moment, stiffness and energy of joint j at bend w; what the stops do is in `memory`.
JointForce joint_force(const Rod& rod, int j, const JointMemory& memory, const Vec2& w);

/// Moves the stops of joint j to bend w; returns the energy lost by yielding.
double commit_joint(const Rod& rod, int j, JointMemory& memory, const Vec2& w);

/// Lets the set of joint j go back for Δt/T = `time`: a stop whose strain s is opposed to its set
/// p = w - s creeps, s ← s e^{-x time}, with x = clamp((t_rig - |p|/α_f)/(t_rig - t_ela)): all of a
/// small set returns, nothing of one that is t_rig times the elastic range. Returns the energy
/// lost, never negative: nothing is gained from a held bend. After Xu et al. 2004, eq. 5.10.
double recover_joint(const Rod& rod, int j, JointMemory& memory, double time);

/// Energy stored in the stops of joint j.
double stored_energy(const Rod& rod, int j, const JointMemory& memory, const Vec2& w);

/// Log map w of `outer` at the inner segment (a, side): θ along the direction of bending.
Vec2 bend_of(const Vec3& a, const Vec3& side, const Vec3& outer);

}  // namespace tuft::brush::rod
