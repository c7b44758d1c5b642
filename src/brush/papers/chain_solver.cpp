#include "brush/papers/chain_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/papers/active_set.h"
#include "brush/rod/wedge.h"

namespace tuft::brush {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kReferenceCurvature = std::numbers::pi / 2;  ///< [X]
constexpr double kLargestTurn = 0.25;                         ///< radians that a joint turns in one iteration
constexpr double kLeastBend = 1e-5;    ///< radians below which the curvature of |u|^m counts as constant
constexpr double kLeastShift = 1e-7;   ///< of the Hessian's diagonal, relative to the joint
constexpr double kSettled = 1e-7;      ///< lengths a node still moves
constexpr double kCompliance = 1e-10;  ///< compliance of constraints that contradict each other
constexpr double kHold = 100;          ///< σ over 1 + the largest multiplier
constexpr double kArmijo = 1e-4;

Mat3 cross_matrix(const Vec3& v) {
    return Mat3{0, v.z, -v.y, -v.z, 0, v.x, v.y, -v.x, 0};
}

/// exp of a rotation vector, and its left Jacobian: exp(w + δ) = exp(J δ) exp(w).
struct Turn {
    Mat3 rotation{1}, jacobian{1};
};

Turn turn_of(const Vec2& w) {
    const double squared = glm::dot(w, w), angle = std::sqrt(squared);
    const bool small = angle < 1e-4;
    const double sine = small ? 1 - squared / 6 : std::sin(angle) / angle;
    const double versine = small ? 0.5 - squared / 24 : (1 - std::cos(angle)) / squared;
    const double rest = small ? 1.0 / 6 - squared / 120 : (1 - sine) / squared;
    const Mat3 k = cross_matrix({w.x, w.y, 0}), kk = k * k;
    return {Mat3{1} + sine * k + versine * kk, Mat3{1} + versine * k + rest * kk};
}

/// Positions and the rotations by which the bends move them.
struct Kinematics {
    std::vector<Vec3> node;     ///< [n+1]
    std::vector<Vec3> axis[2];  ///< [n] world rotation vector per unit of w_j.x and w_j.y
};

Kinematics kinematics_of(const ChainSpine& spine, const ChainProblem& problem, std::span<const Vec2> bend) {
    Kinematics k;
    k.node.push_back(problem.root);
    Mat3 frame = problem.frame;
    for (std::size_t j = 0; j < bend.size(); ++j) {
        const Turn turn = turn_of(bend[j]);
        const Mat3 moves = frame * turn.jacobian;
        k.axis[0].push_back(moves[0]);
        k.axis[1].push_back(moves[1]);
        frame = frame * turn.rotation;
        k.node.push_back(k.node.back() + spine.length[j] * frame[2]);
    }
    return k;
}

/// |u|^m with its derivatives; the second one for u >= kLeastBend.
struct Power {
    double value = 0;
    Vec2 slope{0};
    double xx = 0, xy = 0, yy = 0;
};

Power power_of(const Vec2& u, double m) {
    const double size = glm::length(u), floor = std::max(size, kLeastBend);
    Power p;
    p.value = std::pow(size, m);
    p.slope = size > 0 ? m * std::pow(size, m - 2) * u : Vec2{0};
    const double k = m * std::pow(floor, m - 2), more = k * (m - 2) / (floor * floor);
    p.xx = k + more * u.x * u.x;
    p.xy = more * u.x * u.y;
    p.yy = k + more * u.y * u.y;
    return p;
}

/// Friction of one node: energy, gradient, Hessian.
struct Drag {
    double value = 0;
    Vec3 slope{0};
    Mat3 hessian{0};
};

Drag drag_of(const ChainFriction& f, const ChainContact& c, const Vec3& x) {
    Drag out;
    if (c.normal_force <= 0 || f.coefficient <= 0) return out;
    const double eps = f.smoothing;
    const Mat3 tangential = Mat3{1} - glm::outerProduct(c.normal, c.normal);
    const Vec3 d = tangential * (x - c.touched);
    const bool isotropic = f.along == Vec3{0};
    const double along = glm::dot(d, f.along);
    const Vec3 across = d - along * f.along;
    const double s = std::hypot(along, eps), t = std::sqrt(glm::dot(across, across) + eps * eps);
    const double k = isotropic ? 0 : 2 * f.grain, l = isotropic ? 1 : 2 * (1 - f.grain);
    const double h = k * (s - eps) + l * (t - eps);
    const Vec3 h_slope = k * along / s * f.along + l / t * across;
    const Mat3 aa = glm::outerProduct(f.along, f.along);
    const Mat3 h_hessian =
        k * eps * eps / (s * s * s) * aa +
        l / t * (tangential - (isotropic ? Mat3{0} : aa) - glm::outerProduct(across, across) / (t * t));
    // Dragged tip last: the motion is against the tip's direction.
    const double rho = std::sqrt(glm::dot(d, d) + eps * eps), cosine = std::max(0.0, -along / rho);
    const double factor = 1 - f.with_hair * std::pow(cosine, 4);
    Vec3 factor_slope{0};
    Mat3 factor_hessian{0};
    if (cosine > 0) {
        const double cube = rho * rho * rho;
        const Vec3 turning = -f.along / rho + along / cube * d;
        const Mat3 both = glm::outerProduct(f.along, d) + glm::outerProduct(d, f.along);
        const Mat3 bending = (both + along * tangential - 3 * along / (rho * rho) * glm::outerProduct(d, d)) / cube;
        factor_slope = -4 * f.with_hair * std::pow(cosine, 3) * turning;
        factor_hessian =
            -4 * f.with_hair * cosine * cosine * (3.0 * glm::outerProduct(turning, turning) + cosine * bending);
    }
    const double mu = f.coefficient * c.normal_force;
    out.value = mu * factor * h;
    out.slope = mu * (factor * h_slope + h * factor_slope);
    out.hessian = mu * (factor * h_hessian + h * factor_hessian + glm::outerProduct(factor_slope, h_slope) +
                        glm::outerProduct(h_slope, factor_slope));
    return out;
}

struct Height {
    double z = 0;
    Vec3 slope{0};
};

Height height_of(const ChainContact& c, const Vec3& x, double rounding) {
    if (c.plane.beyond_normal == Vec3{0}) return {glm::dot(x - c.plane.origin, c.plane.normal), c.plane.normal};
    const Wedge wedge{{c.plane.origin, c.plane.beyond_origin}, {c.plane.normal, c.plane.beyond_normal}};
    const Distance d = edge_distance(wedge, rounding, x);
    return {d.z, d.slope};
}

/// E and the constraints at one w.
struct Evaluation {
    Kinematics at;
    double energy = 0, bend_energy = 0;
    std::vector<Drag> drag;           ///< [n] of nodes 1 … n
    VectorXd room;                    ///< constraints, >= 0 where kept: nodes, then the pore
    std::vector<Vec3> node_gradient;  ///< their gradients by the node's position
    double violation() const {
        double sum = 0;
        for (Index i = 0; i < room.size(); ++i) sum += std::max(0.0, -room[i]);
        return sum;
    }
};

class Sqp {
  public:
    Sqp(const ChainSpine& spine, const ChainProblem& problem)
        : spine_(spine), problem_(problem), count_(spine.length.size()) {
        constraints_ = problem.contact.size() + (problem.pore.active ? 1 : 0);
        multiplier_ = VectorXd::Zero(static_cast<Index>(constraints_));
        for (std::size_t i = 0; i < problem.contact.size(); ++i)
            multiplier_[static_cast<Index>(i)] = problem.contact[i].normal_force;
    }

    ChainSolution solve(std::span<const Vec2> start);

  private:
    Evaluation evaluate(std::span<const Vec2> bend) const;
    VectorXd gradient(const Evaluation& e, std::span<const Vec2> bend) const;
    MatrixXd hessian(const Evaluation& e, std::span<const Vec2> bend) const;
    MatrixXd constraint_rows(const Evaluation& e) const;
    std::size_t node_of(std::size_t constraint) const {
        return constraint < problem_.contact.size() ? constraint + 1 : count_;
    }
    /// The step of the quadratic programme; updates the multipliers.
    VectorXd step_of(const Evaluation& e, std::span<const Vec2> bend);
    void finish(const Evaluation& e, ChainSolution& out) const;

    const ChainSpine& spine_;
    const ChainProblem& problem_;
    std::size_t count_, constraints_ = 0;
    double shift_ = 0;
    VectorXd multiplier_;
};

Evaluation Sqp::evaluate(std::span<const Vec2> bend) const {
    Evaluation e;
    e.at = kinematics_of(spine_, problem_, bend);
    const double m = spine_.exponent;
    double change = 0;
    for (std::size_t j = 0; j < count_; ++j) {
        e.bend_energy += spine_.coefficient[j] * power_of(bend[j] - problem_.rest[j], m).value;
        change += problem_.change_weight * spine_.coefficient[j] * power_of(bend[j] - problem_.before[j], m).value;
    }
    e.energy = e.bend_energy + change;
    e.room.resize(static_cast<Index>(constraints_));
    for (std::size_t i = 0; i < problem_.contact.size(); ++i) {
        const ChainContact& c = problem_.contact[i];
        e.drag.push_back(drag_of(problem_.friction, c, e.at.node[i + 1]));
        e.energy += e.drag.back().value;
        const Height h = height_of(c, e.at.node[i + 1], problem_.edge_rounding);
        e.room[static_cast<Index>(i)] = h.z - c.radius;
        e.node_gradient.push_back(h.slope);
    }
    if (problem_.pore.active) {
        const ChainPore& pore = problem_.pore;
        e.room[e.room.size() - 1] = pore.reach - glm::dot(pore.direction, e.at.node.back() - pore.tip);
        e.node_gradient.push_back(-pore.direction);
    }
    return e;
}

VectorXd Sqp::gradient(const Evaluation& e, std::span<const Vec2> bend) const {
    VectorXd g(static_cast<Index>(2 * count_));
    Vec3 force{0}, moment{0};  // of the friction outboard, about the origin
    for (std::size_t j = count_; j-- > 0;) {
        if (!e.drag.empty()) {
            force += e.drag[j].slope;
            moment += glm::cross(e.at.node[j + 1], e.drag[j].slope);
        }
        const Vec3 about = moment - glm::cross(e.at.node[j], force);
        const Vec2 own = spine_.coefficient[j] *
                         (power_of(bend[j] - problem_.rest[j], spine_.exponent).slope +
                          problem_.change_weight * power_of(bend[j] - problem_.before[j], spine_.exponent).slope);
        g[static_cast<Index>(2 * j)] = own.x + glm::dot(e.at.axis[0][j], about);
        g[static_cast<Index>(2 * j + 1)] = own.y + glm::dot(e.at.axis[1][j], about);
    }
    return g;
}

MatrixXd Sqp::constraint_rows(const Evaluation& e) const {
    MatrixXd rows = MatrixXd::Zero(static_cast<Index>(constraints_), static_cast<Index>(2 * count_));
    for (std::size_t i = 0; i < constraints_; ++i) {
        const Vec3 x = e.at.node[node_of(i)];
        for (std::size_t j = 0; j < node_of(i); ++j) {
            const Vec3 about = glm::cross(x - e.at.node[j], e.node_gradient[i]);
            for (int k = 0; k < 2; ++k)
                rows(static_cast<Index>(i), static_cast<Index>(2 * j) + k) = glm::dot(e.at.axis[k][j], about);
        }
    }
    return rows;
}

MatrixXd Sqp::hessian(const Evaluation& e, std::span<const Vec2> bend) const {
    const Index size = static_cast<Index>(2 * count_);
    MatrixXd h = MatrixXd::Zero(size, size);
    // Gradient of the Lagrangian by each node's position, and what friction adds to the second derivative.
    std::vector<Vec3> pull(count_, Vec3{0});
    for (std::size_t i = 0; i < e.drag.size(); ++i) pull[i] += e.drag[i].slope;
    for (std::size_t i = 0; i < constraints_; ++i)
        pull[node_of(i) - 1] -= multiplier_[static_cast<Index>(i)] * e.node_gradient[i];
    // Second moments outboard of each joint about the origin: Σ x pullᵀ and the force; Σ K, Σ [x]K, Σ [x]K[x]ᵀ.
    Mat3 second{0}, k0{0}, k1{0}, k2{0};
    Vec3 force{0};
    for (std::size_t b = count_; b-- > 0;) {
        const Vec3& x = e.at.node[b + 1];
        second += glm::outerProduct(x, pull[b]);
        force += pull[b];
        if (!e.drag.empty()) {
            const Mat3 cross = cross_matrix(x), kb = e.drag[b].hessian;
            k0 += kb;
            k1 += cross * kb;
            k2 += cross * kb * glm::transpose(cross);
        }
        const Vec3& p = e.at.node[b];
        Mat3 turning = second - glm::outerProduct(p, force);
        const double trace = turning[0][0] + turning[1][1] + turning[2][2];
        turning -= Mat3{trace};
        const Mat3 cross_b = cross_matrix(p);
        // Σ [x − p_a] K [x − p_b]ᵀ = (k2 − k1 [p_b]ᵀ) − [p_a] (k1ᵀ − k0 [p_b]ᵀ)
        const Mat3 inner = k2 - k1 * glm::transpose(cross_b), outer = glm::transpose(k1) - k0 * glm::transpose(cross_b);
        for (std::size_t a = 0; a <= b; ++a) {
            const Mat3 sum = turning + inner - cross_matrix(e.at.node[a]) * outer;
            for (int k = 0; k < 2; ++k) {
                for (int l = 0; l < 2; ++l) {
                    const double value = glm::dot(e.at.axis[k][a], sum * e.at.axis[l][b]);
                    const Index row = static_cast<Index>(2 * a) + k, column = static_cast<Index>(2 * b) + l;
                    if (a == b) {
                        h(row, column) += 0.5 * value;
                        h(column, row) += 0.5 * value;
                    } else {
                        h(row, column) = h(column, row) = value;
                    }
                }
            }
        }
        const Power own = power_of(bend[b] - problem_.rest[b], spine_.exponent);
        const Power change = power_of(bend[b] - problem_.before[b], spine_.exponent);
        const double c = spine_.coefficient[b], w = c * problem_.change_weight;
        const Index at = static_cast<Index>(2 * b);
        h(at, at) += c * own.xx + w * change.xx;
        h(at, at + 1) += c * own.xy + w * change.xy;
        h(at + 1, at) += c * own.xy + w * change.xy;
        h(at + 1, at + 1) += c * own.yy + w * change.yy;
    }
    return h;
}

VectorXd Sqp::step_of(const Evaluation& e, std::span<const Vec2> bend) {
    MatrixXd h = hessian(e, bend);
    VectorXd g = gradient(e, bend);
    const MatrixXd rows = constraint_rows(e);
    // Hair under pressure is stable only where its constraints hold it. ½ σ (room + aδ)² of the active ones changes no
    // step that keeps them, and makes the Hessian definite beside them.
    const double hold = constraints_ > 0 ? kHold * (1 + multiplier_.maxCoeff()) : 0;
    for (Index i = 0; i < rows.rows(); ++i) {
        if (multiplier_[i] <= 0) continue;
        h += hold * rows.row(i).transpose() * rows.row(i);
        g += hold * e.room[i] * rows.row(i).transpose();
    }
    Eigen::LLT<MatrixXd> factor;
    while (true) {
        MatrixXd shifted = h;
        for (Index j = 0; j < h.rows(); ++j)
            shifted(j, j) += (shift_ + kLeastShift) * spine_.coefficient[static_cast<std::size_t>(j / 2)];
        factor.compute(shifted);
        if (factor.info() == Eigen::Success || shift_ > 1e12) break;
        shift_ = std::max(4 * shift_, 1e-3);
    }
    VectorXd free = -factor.solve(g);
    if (constraints_ == 0) return free;
    // Dual: min ½ λᵀ(A H⁻¹ Aᵀ)λ + λᵀ(room + A free), λ >= 0; step = free + H⁻¹ Aᵀ λ.
    const MatrixXd answer = factor.solve(rows.transpose());
    MatrixXd dual = rows * answer;
    dual.diagonal().array() += kCompliance;
    const VectorXd room = e.room + rows * free;
    const std::size_t n = constraints_;
    const std::vector<double> found =
        minimise_nonnegative({dual.data(), n * n}, {room.data(), n}, {multiplier_.data(), n});
    multiplier_ = Eigen::Map<const VectorXd>(found.data(), static_cast<Index>(n));
    return free + answer * multiplier_;
}

void Sqp::finish(const Evaluation& e, ChainSolution& out) const {
    out.node = e.at.node;
    out.bend_energy = e.bend_energy;
    out.dissipation = e.energy - e.bend_energy;
    out.pressure.assign(count_ + 1, 0);
    out.force.assign(count_ + 1, Vec3{0});
    for (std::size_t i = 0; i < e.drag.size(); ++i) out.force[i + 1] -= e.drag[i].slope;
    for (std::size_t i = 0; i < constraints_; ++i) {
        const double f = multiplier_[static_cast<Index>(i)];
        out.force[node_of(i)] += f * e.node_gradient[i];
        if (i < problem_.contact.size()) out.pressure[i + 1] = f;
    }
}

ChainSolution Sqp::solve(std::span<const Vec2> start) {
    ChainSolution out;
    out.bend.assign(start.begin(), start.end());
    Evaluation now = evaluate(out.bend);
    double penalty = 0;
    for (; out.iterations < problem_.max_iterations && !out.converged; ++out.iterations) {
        const VectorXd step = step_of(now, out.bend);
        double largest = 0;
        for (std::size_t j = 0; j < count_; ++j) {
            const Index at = static_cast<Index>(2 * j);
            largest = std::max(largest, std::hypot(step[at], step[at + 1]));
        }
        if (!std::isfinite(largest)) break;
        penalty = std::max(penalty, multiplier_.size() > 0 ? 1.5 * multiplier_.maxCoeff() : 0.0);
        const double merit = now.energy + penalty * now.violation();
        const double slope = gradient(now, out.bend).dot(step) - penalty * now.violation();
        double part = largest > kLargestTurn ? kLargestTurn / largest : 1;
        std::vector<Vec2> tried(count_);
        Evaluation next;
        bool better = false;
        for (int halving = 0; halving < 8 && !better; ++halving) {
            for (std::size_t j = 0; j < count_; ++j) {
                const Index at = static_cast<Index>(2 * j);
                tried[j] = out.bend[j] + part * Vec2{step[at], step[at + 1]};
            }
            next = evaluate(tried);
            const double gain = next.energy + penalty * next.violation() - merit;
            better = gain <= kArmijo * part * std::min(slope, 0.0) + 1e-14 * (1 + std::abs(merit));
            if (!better) part *= 0.5;
        }
        double moved = 0;
        for (std::size_t i = 0; i <= count_; ++i)
            moved = std::max(moved, glm::length(next.at.node[i] - now.at.node[i]) / part);
        if (better) {
            out.bend = tried;
            now = std::move(next);
            shift_ *= part == 1 ? 0.25 : 1;
            if (shift_ < 1e-3) shift_ = 0;
        } else {
            shift_ = std::max(8 * shift_, 1e-2);
        }
        out.converged = moved < kSettled;
    }
    finish(now, out);
    return out;
}

}  // namespace

ChainSpine make_chain_spine(const Profile& profile, std::span<const double> lengths, double exponent) {
    ChainSpine spine{{lengths.begin(), lengths.end()}, {}, exponent};
    const Quadrature gauss = gauss_legendre(8);
    const double power = -1 / (exponent - 1);
    double s = 0;
    for (std::size_t j = 0; j < lengths.size(); ++j) {
        const double from = j > 0 ? s - 0.5 * lengths[j - 1] : 0, to = s + 0.5 * lengths[j];
        double sum = 0;
        for (std::size_t k = 0; k < gauss.x.size(); ++k) {
            const double b = bending_stiffness(profile, from + (to - from) * gauss.x[k]);
            sum += (to - from) * gauss.w[k] * std::pow(b * std::pow(kReferenceCurvature, 2 - exponent), power);
        }
        spine.coefficient.push_back(std::pow(sum, 1 - exponent) / exponent);
        s += lengths[j];
    }
    return spine;
}

std::vector<Vec3> chain_nodes(const ChainSpine& spine, const Vec3& root, const Mat3& frame,
                              std::span<const Vec2> bend) {
    ChainProblem problem;
    problem.root = root;
    problem.frame = frame;
    return kinematics_of(spine, problem, bend).node;
}

ChainSolution solve_chain(const ChainSpine& spine, std::span<const Vec2> start, const ChainProblem& problem) {
    return Sqp(spine, problem).solve(start);
}

}  // namespace tuft::brush
