#include "brush/rod/rod_edge.h"

#include <algorithm>
#include <cmath>

#include "brush/rod/rod_law.h"

namespace tuft::brush::rod {

namespace {

/// A piece shortened along itself by `s`.
struct Shortened {
    double s = 0, depth = 0;
    double miss = 0;         // s / compliance less the force along the hair
    LineDistance distance;   // of the piece from the surface
    NormalForce push, pull;  // of the contact, and of the wet film

    double force() const { return push.force - pull.force; }
};

/// A piece of hair that shortens, over a crease.
class PieceOverEdge {
  public:
    PieceOverEdge(const Frozen& frozen, int p, const HairPiece& piece, const Recycled<Vec3>& node)
        : law_(*frozen.law),
          obstacle_(frozen.points.obstacles[p]),
          crease_(frozen.points.crease[p]),
          piece_(piece),
          x(piece.at.at(node)),
          inwards(piece.at.inwards(node)),
          line_(crease_.edge, x, inwards),
          height_(glm::dot(x - obstacle_.origin, obstacle_.normal)),
          climb_(glm::dot(inwards, obstacle_.normal)) {}

    /// Where the piece stands.
    Shortened stand() const;
    Distance distance_at(double s) const { return distance_of(obstacle_, crease_, law_.edge, x + s * inwards); }

  private:
    LineDistance line_at(double s) const;
    Shortened at(double s) const;
    double slope(const Shortened& at) const;
    double surely_short(const Shortened& from) const;
    Shortened between(Shortened low, Shortened high) const;

    const Law& law_;
    const Obstacle& obstacle_;
    const Crease& crease_;
    const HairPiece& piece_;

  public:
    const Vec3 x, inwards;  // where it is, and its direction to the root

  private:
    LineOverEdge line_;
    double height_, climb_;  // over the point's own plane
};

inline LineDistance PieceOverEdge::line_at(double s) const {
    const LineDistance d = line_.at(s);
    const double own = height_ + s * climb_, share = crease_.share;
    return {own + share * (d.z - own), climb_ + share * (d.slope - climb_), share * d.bend};
}

inline Shortened PieceOverEdge::at(double s) const {
    const LineDistance d = line_at(s);
    Shortened out{.s = s, .depth = piece_.radius - d.z, .distance = d};
    out.push = normal_force(law_.normal, piece_.weight, piece_.radius, out.depth, 0);
    out.pull = adhesion(law_.adhesion, piece_.weight, -out.depth);
    out.miss = s / piece_.compliance - out.force() * d.slope;
    return out;
}

// ∂miss/∂s
inline double PieceOverEdge::slope(const Shortened& at) const {
    const LineDistance& d = at.distance;
    return 1 / piece_.compliance + (at.push.stiffness + at.pull.stiffness) * d.slope * d.slope - at.force() * d.bend;
}

// How much less the piece may be shortened than at `from` with a miss that is surely positive: the force along the hair
// is at most that of the contact and of the film, and the contact grows no faster than hair goes along itself.
inline double PieceOverEdge::surely_short(const Shortened& from) const {
    constexpr double kRounding = 1e-9;
    const double along = glm::length(inwards), pull = law_.adhesion.strength * piece_.weight;
    const double spare = from.s / piece_.compliance - (from.push.force + pull) * along;
    const double stiffest = (law_.normal.stiffness + law_.normal.core_stiffness) * piece_.weight;
    return std::max(0.0, (1 - kRounding) * spare / (1 / piece_.compliance + stiffest * along * along));
}

// Bracketed from outside, where hair that comes from its root meets the surface.
Shortened PieceOverEdge::stand() const {
    const Shortened whole = at(0);
    if (whole.push.force <= 0) return whole;
    constexpr int kSteps = 12;
    const double step = 3 * law_.normal.end_compliance / kSteps;
    Shortened high = at(kSteps * step);
    if (high.miss <= 0) return high;
    // A step brings hair no nearer to the surface than it is long: as far as neither contact nor film can begin, no
    // sign changes.
    const double off = -high.depth - law_.adhesion.range - 1e-9;
    const int clear = std::clamp(static_cast<int>(off / step), 0, kSteps - 1);
    if (clear > 0) high = at((kSteps - clear) * step);
    Shortened low = high;
    for (int k = kSteps - clear; k > 0;) {
        const int next = std::max(0, k - 1 - static_cast<int>(surely_short(high) / step));
        low = next > 0 ? at(next * step) : whole;
        if (low.miss <= 0) {
            if (next + 1 < k) high = at((next + 1) * step);
            break;
        }
        high = low;
        k = next;
    }
    return low.miss >= 0 ? low : between(low, high);
}

// Newton's method, by halves where it leaves the bracket.
Shortened PieceOverEdge::between(Shortened low, Shortened high) const {
    Shortened mid = low;
    double s = (low.s * high.miss - high.s * low.miss) / (high.miss - low.miss);
    for (int i = 0; i < 60 && high.s - low.s > 1e-15; ++i) {
        mid = at(s);
        if (std::abs(mid.miss) < 1e-12 * (1 + mid.push.force)) break;
        (mid.miss > 0 ? high : low) = mid;
        s = mid.s - mid.miss / slope(mid);
        if (!(s > low.s && s < high.s)) s = 0.5 * (low.s + high.s);
    }
    return mid;
}

/// Adds the derivatives of a piece that stands at `st`. With y = x + s i and ψ(y) the contact's potential:
/// E = s²/(2 compliance) + ψ, E_x = ψ', E_i = s ψ'.
void add_piece(const HairPiece& piece, const PieceOverEdge& hair, const Shortened& st, Evaluation& out) {
    const Stencil& at = piece.at;
    const double force = st.force();
    const Distance at_surface = hair.distance_at(st.s);
    const Vec3& n = at_surface.slope;
    const Vec3 slope = -force * n;
    Sym3 xx = (st.push.stiffness + st.pull.stiffness) * outer(n);
    xx += -force * at_surface.bend * outer(at_surface.across);
    if (st.s > 0) {
        const Vec3 ci = xx * hair.inwards, b = slope + st.s * ci;
        const double total = std::max(1 / piece.compliance + glm::dot(hair.inwards, ci), 0.01 / piece.compliance);
        const Sym3 ii = st.s * st.s * xx + -1 / total * outer(b);
        const Sym3 mixed = 2 * st.s * xx + -2 / total * symmetric(ci, b);
        xx += -1 / total * outer(ci);
        add_slope(at, at.d, st.s * slope, out);
        add_slope(at, at.w, slope, out);
        for_pairs(at, out, [&](int k, int l, Sym3 sum) {
            sum += 0.5 * (at.w[k] * at.d[l] + at.d[k] * at.w[l]) * mixed;
            sum += at.d[k] * at.d[l] * ii;
            return sum += at.w[k] * at.w[l] * xx;
        });
        return;
    }
    add_potential(at, slope, xx, out);
}

/// What presses on the pieces of one point that stand on one face, over the same nodes. It is along one normal, so that
/// its derivatives are sums of numbers.
class OnFace {
  public:
    /// Adds a piece with the potential's derivatives over its height.
    void add(const Stencil& at, double slope, double curvature) {
        const double* w = at.w;
        for (int k = 0; k < 3; ++k) {
            slope_[k] += w[k] * slope;
            own_[k] += w[k] * w[k] * curvature;
        }
        next_[0] += w[0] * w[1] * curvature;
        next_[1] += w[1] * w[2] * curvature;
        far_ += w[0] * w[2] * curvature;
        empty_ = false;
    }

    /// Adds the sums to the nodes of `at`; `gradient` is that of the height.
    void add_to(const Stencil& at, const Vec3& gradient, Evaluation& out) const {
        if (empty_) return;
        const Sym3 square = outer(gradient);
        add_slope(at, slope_, gradient, out);
        add_curvature(at, square, out, [&](int k, int l) { return l == k ? own_[k] : l == k + 1 ? next_[k] : far_; });
    }

  private:
    double slope_[3] = {0, 0, 0}, own_[3] = {0, 0, 0}, next_[2] = {0, 0}, far_ = 0;
    bool empty_ = true;
};

/// Pieces of one contact point that keep their length, over both faces of its crease.
class RigidPieces {
  public:
    RigidPieces(const Frozen& frozen, int p, bool derivatives, Evaluation& out)
        : law_(*frozen.law),
          obstacle_(frozen.points.obstacles[p]),
          crease_(frozen.points.crease[p]),
          point_(p),
          derivatives_(derivatives),
          out_(out) {}

    /// Returns the potential of a piece.
    double add(const HairPiece& piece) {
        const Vec3 x = piece.at.at(out_.node);
        const EdgeHeight over = edge_height(crease_.edge, x);
        const double own = glm::dot(x - obstacle_.origin, obstacle_.normal);
        const double depth = piece.radius - (own + crease_.share * (over.z - own));
        const NormalForce push = normal_force(law_.normal, piece.weight, piece.radius, depth, 0);
        const NormalForce pull = adhesion(law_.adhesion, piece.weight, -depth);
        if (push.force == pull.force) return 0;
        const double energy = push.energy + pull.energy;
        if (!derivatives_) return energy;
        out_.normal[point_] += push.force;
        const double slope = pull.force - push.force, curvature = push.stiffness + pull.stiffness;
        if (over.face < 0) {
            const Distance d = distance_of(obstacle_, crease_, law_.edge, x);
            add_potential(piece.at, slope * d.slope, curvature * outer(d.slope) + slope * d.bend * outer(d.across),
                          out_);
            return energy;
        }
        if (nodes_ && nodes_->first != piece.at.first) flush();
        nodes_ = &piece.at;
        face_[over.face].add(piece.at, slope, curvature);
        return energy;
    }

    /// Adds what is summed to the nodes.
    void flush() {
        if (!nodes_) return;
        for (int i = 0; i < 2; ++i) {
            const Vec3& n = crease_.edge.wedge.normal[i];
            face_[i].add_to(*nodes_, obstacle_.normal + crease_.share * (n - obstacle_.normal), out_);
            face_[i] = {};
        }
    }

  private:
    const Law& law_;
    const Obstacle& obstacle_;
    const Crease& crease_;
    int point_;
    bool derivatives_;
    Evaluation& out_;
    OnFace face_[2];
    const Stencil* nodes_ = nullptr;
};

}  // namespace

bool is_clear_of_edge(const Frozen& frozen, int p, const Vec3& x) {
    const Obstacle& o = frozen.points.obstacles[p];
    const Crease& crease = frozen.points.crease[p];
    const double own = glm::dot(x - o.origin, o.normal), z = own + crease.share * (edge_height(crease.edge, x).z - own);
    const double length = frozen.rod->length[frozen.points.place[p].node] / frozen.law->points_per_segment;
    return z - o.radius >= frozen.law->adhesion.range + length;
}

double add_hair_at_edge(const Frozen& frozen, int p, bool derivatives, Evaluation& out) {
    double energy = 0;
    RigidPieces rigid(frozen, p, derivatives, out);
    for (const HairPiece& piece : frozen.points.piece[p]) {
        if (piece.weight <= 0) continue;
        if (piece.compliance <= 0) {
            energy += rigid.add(piece);
            continue;
        }
        const PieceOverEdge hair(frozen, p, piece, out.node);
        const Shortened st = hair.stand();
        if (st.push.force == st.pull.force) continue;
        energy += st.push.energy + st.pull.energy;
        if (st.s > 0) energy += st.s * st.s / (2 * piece.compliance);
        if (!derivatives) continue;
        out.normal[p] += st.push.force;
        add_piece(piece, hair, st, out);
    }
    rigid.flush();
    return energy;
}

Obstacle mean_plane_at_edge(const Frozen& frozen, int p, const Recycled<Vec3>& node, const Obstacle& here) {
    double total = 0;
    Vec3 normal{0}, origin{0};
    for (const HairPiece& piece : frozen.points.piece[p]) {
        if (piece.weight <= 0) continue;
        Vec3 x = piece.at.at(node);
        double force = 0;
        if (piece.compliance > 0) {
            const PieceOverEdge hair(frozen, p, piece, node);
            const Shortened st = hair.stand();
            x += st.s * hair.inwards;
            force = st.push.force;
        }
        const Distance d = distance_of(frozen.points.obstacles[p], frozen.points.crease[p], frozen.law->edge, x);
        if (piece.compliance <= 0)
            force = normal_force(frozen.law->normal, piece.weight, piece.radius, piece.radius - d.z, 0).force;
        if (force <= 0) continue;
        total += force;
        normal += force * d.slope;
        origin += force * (x - d.z * d.slope);
    }
    const double mean = glm::length(normal);
    return mean > 1e-6 * total && total > 0 ? Obstacle{origin / total, normal / mean, here.radius} : here;
}

}  // namespace tuft::brush::rod
