#include "brush/rod/coupled_energy.h"

namespace tuft::brush::rod {

namespace {

constexpr int kMaxMoves = 3 * kMaxCoupled, kMaxSteps = 2 * kMaxCoupled;
/// Blocks over the moves x of the nodes (3 a rod) and over the steps u of the segments (2 a rod).
using MoveByMove = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxMoves, kMaxMoves>;
using MoveByStep = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxMoves, kMaxSteps>;
using StepByMove = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxSteps, kMaxMoves>;
using StepByStep = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxSteps, kMaxSteps>;
using Moves = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxMoves, 1>;
using Steps = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxSteps, 1>;
using Arm = Eigen::Matrix<double, 3, 2>;
using Block3 = Eigen::Matrix3d;

Block3 matrix(const Sym3& m) {
    Block3 out;
    out << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
    return out;
}

Eigen::Vector3d vector(const Vec3& v) {
    return {v.x, v.y, v.z};
}

Arm arm_of(const Solver& s, int j) {
    Arm out;
    const double l = s.rod.length[j];
    out.col(0) = l * vector(s.shape.side[j]);
    out.col(1) = l * vector(s.ws.derivatives.second[j]);
    return out;
}

/// What segment j of all rods was eliminated with: u = −rest − move x − inner v.
struct Gain {
    Steps rest;
    StepByMove move;
    StepByStep inner;
};

/// The least of the model over everything outboard of segment j: ½ xᵀ P x + vᵀ Q x + ½ vᵀ R v + p·x + r·v, x the moves
/// of the nodes outboard of the segments and v their steps.
struct Outboard {
    MoveByMove p;
    StepByMove q;
    StepByStep r;
    Moves p1;
    Steps r1;

    explicit Outboard(int k)
        : p(MoveByMove::Zero(3 * k, 3 * k)),
          q(StepByMove::Zero(2 * k, 3 * k)),
          r(StepByStep::Zero(2 * k, 2 * k)),
          p1(Moves::Zero(3 * k)),
          r1(Steps::Zero(2 * k)) {}
};

class BlockElimination {
  public:
    BlockElimination(std::span<const Solver> solvers, std::span<const FrozenPair> pairs, double damping)
        : solvers_(solvers), pairs_(pairs), k_(static_cast<int>(solvers.size())), damping_(damping), out_(k_) {
        for (const Solver& s : solvers) n_ = std::max(n_, s.n());
    }

    bool run() {
        thread_local std::vector<Gain> buffer;
        gain_ = &buffer;
        buffer.resize(n_);
        add_nodes(n_);
        for (int j = n_ - 1; j >= 0; --j) {
            if (!eliminate(j)) return false;
        }
        return true;
    }

    void back_substitute(std::vector<double>& step) const {
        std::size_t size = 0;
        for (const Solver& s : solvers_) size += 2 * static_cast<std::size_t>(s.n());
        step.resize(size);
        Moves moved = Moves::Zero(3 * k_);
        Steps before = Steps::Zero(2 * k_);
        for (int j = 0; j < n_; ++j) {
            const Gain& gain = (*gain_)[j];
            Steps u = -gain.rest;
            if (j > 0) u -= gain.move * moved + gain.inner * before;
            std::size_t first = 0;
            for (int k = 0; k < k_; ++k) {
                const Solver& s = solvers_[k];
                if (j < s.n()) {
                    step[first + 2 * j] = u[2 * k];
                    step[first + 2 * j + 1] = u[2 * k + 1];
                    moved.segment<3>(3 * k) += arm_of(s, j) * u.segment<2>(2 * k);
                }
                first += 2 * static_cast<std::size_t>(s.n());
            }
            before = u;
        }
    }

  private:
    /// Adds the potential of the nodes of number j, by themselves and between neighbours.
    void add_nodes(int j) {
        for (int k = 0; k < k_; ++k) {
            if (j <= solvers_[k].n()) out_.p.block<3, 3>(3 * k, 3 * k) += matrix(solvers_[k].ws.at.curvature[j]);
        }
        for (const FrozenPair& f : pairs_) {
            if (j >= f.nodes) continue;
            const Block3 between = matrix(f.curvature[j]);
            out_.p.block<3, 3>(3 * f.pair->first, 3 * f.pair->second) -= between;
            out_.p.block<3, 3>(3 * f.pair->second, 3 * f.pair->first) -= between;
        }
    }

    double damping_of(const Solver& s, int j) const {
        return damping_ * (s.rod.stiffness[j] + (j + 1 < s.n() ? s.rod.stiffness[j + 1] : 0));
    }

    /// Adds the shear of the pairs' segments j along the hair: ψ'' (∇u)(∇u)ᵀ + ψ' ∇∇u over the moves of the nodes
    /// outboard and the steps of the segments.
    void add_shear(int j) {
        for (const FrozenPair& f : pairs_) {
            if (j >= static_cast<int>(f.shear.size())) continue;
            const SegmentShear& shear = f.shear[j];
            const int side[2] = {f.pair->first, f.pair->second};
            Eigen::Vector2d by_step[2];
            Eigen::Matrix<double, 2, 3> turn[2];  // ∂²u over a step and d
            for (int i = 0; i < 2; ++i) {
                const Solver& s = solvers_[side[i]];
                const Eigen::Vector3d t1 = vector(s.shape.side[j]), t2 = vector(s.ws.derivatives.second[j]);
                const Eigen::Vector3d half = vector(shear.half_distance);
                by_step[i] = {half.dot(t1), half.dot(t2)};
                turn[i].row(0) = 0.5 * t1.transpose();
                turn[i].row(1) = 0.5 * t2.transpose();
            }
            const Eigen::Vector3d mean = vector(shear.mean);
            constexpr double kSign[2] = {-1, 1};  // of d = x₂ − x₁
            for (int i = 0; i < 2; ++i) {
                for (int k = 0; k < 2; ++k) {
                    out_.p.block<3, 3>(3 * side[i], 3 * side[k]) +=
                        kSign[i] * kSign[k] * shear.stiffness * mean * mean.transpose();
                    out_.q.block<2, 3>(2 * side[i], 3 * side[k]) +=
                        kSign[k] * (shear.stiffness * by_step[i] * mean.transpose() + shear.force * turn[i]);
                    out_.r.block<2, 2>(2 * side[i], 2 * side[k]) +=
                        shear.stiffness * by_step[i] * by_step[k].transpose();
                }
            }
        }
    }

    bool eliminate(int j) {
        add_shear(j);
        MoveByStep arms = MoveByStep::Zero(3 * k_, 2 * k_), x(3 * k_, 2 * k_);
        for (int k = 0; k < k_; ++k) {
            if (j < solvers_[k].n()) arms.block<3, 2>(3 * k, 2 * k) = arm_of(solvers_[k], j);
        }
        for (int k = 0; k < k_; ++k)
            x.middleCols<2>(2 * k).noalias() = out_.p.middleCols<3>(3 * k) * arms.block<3, 2>(3 * k, 2 * k);
        StepByStep own(2 * k_, 2 * k_);
        for (int k = 0; k < k_; ++k)
            own.middleRows<2>(2 * k).noalias() = arms.block<3, 2>(3 * k, 2 * k).transpose() * x.middleRows<3>(3 * k);
        StepByStep qa(2 * k_, 2 * k_);
        for (int k = 0; k < k_; ++k)
            qa.middleCols<2>(2 * k).noalias() = out_.q.middleCols<3>(3 * k) * arms.block<3, 2>(3 * k, 2 * k);
        own += out_.r + qa + qa.transpose();
        x += out_.q.transpose();
        Steps g = out_.r1;
        for (int k = 0; k < k_; ++k) {
            const Solver& s = solvers_[k];
            if (j >= s.n()) {
                own.block<2, 2>(2 * k, 2 * k).setIdentity();
                continue;
            }
            const Mat2& m = s.ws.derivatives.segment[j].own;
            const double damped = damping_ > 0 ? damping_of(s, j) : 0;
            // The lower half of m is filled.
            own(2 * k, 2 * k) += m.m[0][0] + damped;
            own(2 * k + 1, 2 * k) += m.m[1][0];
            own(2 * k, 2 * k + 1) += m.m[1][0];
            own(2 * k + 1, 2 * k + 1) += m.m[1][1] + damped;
            g[2 * k] += s.ws.derivatives.gradient[2 * j];
            g[2 * k + 1] += s.ws.derivatives.gradient[2 * j + 1];
            g.segment<2>(2 * k).noalias() += arms.block<3, 2>(3 * k, 2 * k).transpose() * out_.p1.segment<3>(3 * k);
        }
        const Eigen::LLT<StepByStep> factor(own);
        if (factor.info() != Eigen::Success) return false;
        Gain& gain = (*gain_)[j];
        gain.rest = factor.solve(g);
        if (j > 0) move_inboard(j, arms, x, factor, gain);
        return true;
    }

    /// The model over the moves of the nodes inboard of segment j and over the steps of the segments there.
    void move_inboard(int j, const MoveByStep& arms, MoveByStep& x, const Eigen::LLT<StepByStep>& factor, Gain& gain) {
        StepByMove far = StepByMove::Zero(2 * k_, 3 * k_);
        StepByStep in = StepByStep::Zero(2 * k_, 2 * k_);
        for (int k = 0; k < k_; ++k) {
            const Solver& s = solvers_[k];
            if (j >= s.n()) continue;
            const Evaluation& at = s.ws.at;
            const Block3 across = matrix(at.across[j - 1]), coupling = matrix(at.coupling[j]) + across;
            const auto arm = arms.block<3, 2>(3 * k, 2 * k);
            x.block<3, 2>(3 * k, 2 * k) += coupling * arm;
            far.block<2, 3>(2 * k, 3 * k) = (across * arm_of(s, j - 1)).transpose();
            const Mat2& inboard = s.ws.derivatives.segment[j].inboard;
            auto block = in.block<2, 2>(2 * k, 2 * k);
            block << inboard.m[0][0], inboard.m[0][1], inboard.m[1][0], inboard.m[1][1];
            block -= far.block<2, 3>(2 * k, 3 * k) * arm;
            out_.p.block<3, 3>(3 * k, 3 * k) += 2 * coupling;
        }
        gain.move = factor.solve(StepByMove(x.transpose()));
        gain.inner = factor.solve(StepByStep(in.transpose()));
        add_nodes(j);
        out_.p.noalias() -= x * gain.move;
        out_.p1.noalias() -= x * gain.rest;
        out_.q = -far;
        out_.q.noalias() -= in * gain.move;
        out_.r1.noalias() = -(in * gain.rest);
        out_.r.noalias() = -(in * gain.inner);
    }

    std::span<const Solver> solvers_;
    std::span<const FrozenPair> pairs_;
    int k_ = 0, n_ = 0;
    double damping_ = 0;
    Outboard out_;
    std::vector<Gain>* gain_ = nullptr;
};

}  // namespace

bool CoupledSystem::descend(double damping) {
    BlockElimination elimination(solvers_, pairs_, damping);
    if (!elimination.run()) return false;
    elimination.back_substitute(step_);
    return true;
}

namespace {

/// Moves of node i of one rod by its steps. [3 × 2n]
Eigen::MatrixXd node_by_steps(const Solver& s, int i) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3, 2 * s.n());
    for (int j = 0; j < i; ++j) out.block<3, 2>(0, 2 * j) = arm_of(s, j);
    return out;
}

}  // namespace

Eigen::MatrixXd CoupledSystem::dense() const {
    Eigen::Index size = 0;
    std::vector<Eigen::Index> first;
    for (const Solver& s : solvers_) {
        first.push_back(size);
        size += 2 * s.n();
    }
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
    std::vector<double> own;
    for (std::size_t k = 0; k < solvers_.size(); ++k) {
        const Solver& s = solvers_[k];
        fill_hessian(s.rod, s.shape, s.ws.at, s.ws.derivatives, own);
        const Eigen::MatrixXd lower = Eigen::Map<const Eigen::MatrixXd>(own.data(), 2 * s.n(), 2 * s.n());
        out.block(first[k], first[k], 2 * s.n(), 2 * s.n()) = lower.selfadjointView<Eigen::Lower>();
    }
    for (const FrozenPair& f : pairs_) {
        const Solver &a = solvers_[f.pair->first], &b = solvers_[f.pair->second];
        const Eigen::Index at = first[f.pair->first], bt = first[f.pair->second];
        for (int i = 1; i < f.nodes; ++i) {
            const Eigen::MatrixXd x = node_by_steps(a, i), y = node_by_steps(b, i);
            const Eigen::MatrixXd block = -x.transpose() * matrix(f.curvature[i]) * y;
            out.block(at, bt, block.rows(), block.cols()) += block;
            out.block(bt, at, block.cols(), block.rows()) += block.transpose();
            if (f.shear.empty()) continue;
            const int j = i - 1;
            const SegmentShear& shear = f.shear[j];
            Eigen::MatrixXd d = Eigen::MatrixXd::Zero(3, size), t = Eigen::MatrixXd::Zero(3, size);
            d.block(0, at, 3, x.cols()) = -x;
            d.block(0, bt, 3, y.cols()) = y;
            t.block<3, 2>(0, at + 2 * j) = arm_of(a, j) / a.rod.length[j];
            t.block<3, 2>(0, bt + 2 * j) = arm_of(b, j) / b.rod.length[j];
            const Eigen::RowVectorXd by =
                vector(shear.mean).transpose() * d + vector(shear.half_distance).transpose() * t;
            const Eigen::MatrixXd turn = 0.5 * t.transpose() * d;
            out += shear.stiffness * by.transpose() * by + shear.force * (turn + turn.transpose());
        }
    }
    return out;
}

}  // namespace tuft::brush::rod
