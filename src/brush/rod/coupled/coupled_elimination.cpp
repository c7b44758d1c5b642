#include <algorithm>
#include <cmath>

#include "brush/rod/coupled/coupled_energy.h"
#include "core/simd.h"

namespace tuft::brush::rod {

namespace {

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

constexpr int kMaxMoves = 3 * kMaxCoupled, kMaxSteps = 2 * kMaxCoupled;
constexpr int kLanes = 8;  // columns that are computed together
constexpr int whole_lanes(int columns) {
    return (columns + kLanes - 1) / kLanes * kLanes;
}
/// Columns of a segment's rows: the moves x of the nodes (3 a rod), the steps v of the segments inboard (2 a rod) and
/// the right-hand side; rounded up to whole vectors.
constexpr int kMaxColumns = whole_lanes(kMaxMoves + kMaxSteps + 1);

/// Rows of segment j of all rods as it was eliminated: with U = Rᵀ R, Z = R⁻ᵀ [X | in | g].
struct Gain {
    double upper[kMaxSteps][kMaxSteps];  ///< R
    double inverse[kMaxSteps];           ///< 1 / its diagonal
    double z[kMaxSteps][kMaxColumns];
};

/// Cholesky factor of the upper half of `a` in place; false where it is not positive definite. Sums run along the rows:
/// the same bits for any width of vectors.
TUFT_CLONES bool factorise(double (&a)[kMaxSteps][kMaxSteps], double (&inverse)[kMaxSteps], int n) {
    for (int j = 0; j < n; ++j) {
        const double* __restrict row = a[j];
        if (!(row[j] > 0)) return false;
        const double f = 1 / std::sqrt(row[j]);
        for (int i = j; i < n; ++i) a[j][i] *= f;
        inverse[j] = f;
        for (int k = j + 1; k < n; ++k) {
            const double g = row[k];
            double* __restrict other = a[k];
            for (int i = k; i < n; ++i) other[i] -= g * row[i];
        }
    }
    return true;
}

/// z ← R⁻ᵀ z; `columns` a multiple of kLanes.
TUFT_CLONES void forward(const double (&upper)[kMaxSteps][kMaxSteps], const double (&inverse)[kMaxSteps], int n,
                         int columns, double (&z)[kMaxSteps][kMaxColumns]) {
    for (int i = 0; i < n; ++i) {
        double* __restrict row = z[i];
        for (int c = 0; c < columns; ++c) row[c] *= inverse[i];
        for (int j = i + 1; j < n; ++j) {
            const double f = upper[i][j];
            double* __restrict other = z[j];
            for (int c = 0; c < columns; c += kLanes)
                for (int lane = 0; lane < kLanes; ++lane) other[c + lane] -= f * row[c + lane];
        }
    }
}

/// gram ← Zᵀ Z, rows [0, rows), of each the columns from its diagonal on; `columns` a multiple of kLanes. Two rows and
/// eight columns at a time, whose sums stay in registers. Each sum runs along the rows of z.
TUFT_CLONES void square(const double (&z)[kMaxSteps][kMaxColumns], int n, int rows, int columns,
                        double (&gram)[kMaxColumns][kMaxColumns]) {
    for (int r = 0; r < rows; r += 2) {  // the second of the last pair may be the right-hand side's, of no use
        for (int c = r / kLanes * kLanes; c < columns; c += kLanes) {
            double first[kLanes] = {}, second[kLanes] = {};
            for (int i = 0; i < n; ++i) {
                const double* __restrict here = z[i] + c;
                const double f = z[i][r], g = z[i][r + 1];
                for (int lane = 0; lane < kLanes; ++lane) first[lane] += f * here[lane];
                for (int lane = 0; lane < kLanes; ++lane) second[lane] += g * here[lane];
            }
            for (int lane = 0; lane < kLanes; ++lane) gram[r][c + lane] = first[lane];
            for (int lane = 0; lane < kLanes; ++lane) gram[r + 1][c + lane] = second[lane];
        }
    }
}

/// The least of the model over everything outboard of segment j: ½ xᵀ P x + vᵀ Q x + ½ vᵀ R v + p·x + r·v, x the moves
/// of the nodes outboard of the segments and v their steps.
struct Outboard {
    double p[kMaxMoves][kMaxMoves]{};
    double q[kMaxSteps][kMaxMoves]{};
    double r[kMaxSteps][kMaxSteps]{};
    double p1[kMaxMoves]{}, r1[kMaxSteps]{};
};

template <class Block, std::size_t N, std::size_t M>
void add_block(double (&to)[N][M], int row, int col, const Block& block) {
    for (int i = 0; i < block.rows(); ++i)
        for (int k = 0; k < block.cols(); ++k) to[row + i][col + k] += block(i, k);
}

/// Buffers of one thread.
struct Scratch {
    Recycled<Gain> gain;
    Outboard out;
    double gram[kMaxColumns][kMaxColumns];
};

class BlockElimination {
  public:
    BlockElimination(std::span<const Solver> solvers, std::span<const FrozenPair> pairs, double damping)
        : solvers_(solvers),
          pairs_(pairs),
          k_(static_cast<int>(solvers.size())),
          moves_(3 * k_),
          steps_(2 * k_),
          damping_(damping),
          scratch_(scratch()) {
        for (const Solver& s : solvers) n_ = std::max(n_, s.n());
        scratch_.gain.resize(n_);
        scratch_.out = {};
    }

    bool run() {
        add_nodes(n_);
        for (int j = n_ - 1; j >= 0; --j) {
            if (!eliminate(j)) return false;
        }
        return true;
    }

    void back_substitute(Recycled<double>& step) const {
        std::size_t size = 0;
        for (const Solver& s : solvers_) size += 2 * static_cast<std::size_t>(s.n());
        step.resize(size);
        double x[kMaxMoves]{}, v[kMaxSteps]{}, u[kMaxSteps]{};
        for (int j = 0; j < n_; ++j) {
            const Gain& gain = scratch_.gain[j];
            // R u = −[Z_x x + Z_in v + z_g].
            for (int i = 0; i < steps_; ++i) {
                double sum = gain.z[i][moves_ + steps_];
                for (int c = 0; j > 0 && c < moves_; ++c) sum += gain.z[i][c] * x[c];
                for (int c = 0; j > 0 && c < steps_; ++c) sum += gain.z[i][moves_ + c] * v[c];
                u[i] = -sum;
            }
            for (int i = steps_; i-- > 0;) {
                for (int k = i + 1; k < steps_; ++k) u[i] -= gain.upper[i][k] * u[k];
                u[i] *= gain.inverse[i];
            }
            std::size_t first = 0;
            for (int k = 0; k < k_; ++k) {
                const Solver& s = solvers_[k];
                if (j < s.n()) {
                    step[first + 2 * j] = u[2 * k];
                    step[first + 2 * j + 1] = u[2 * k + 1];
                    const Eigen::Vector3d moved = arm_of(s, j) * Eigen::Vector2d(u[2 * k], u[2 * k + 1]);
                    for (int i = 0; i < 3; ++i) x[3 * k + i] += moved[i];
                }
                first += 2 * static_cast<std::size_t>(s.n());
            }
            std::copy(u, u + steps_, v);
        }
    }

  private:
    static Scratch& scratch() {
        thread_local Scratch buffer;
        return buffer;
    }

    /// Adds the potential of the nodes of number j, by themselves and between neighbours.
    void add_nodes(int j) {
        Outboard& out = scratch_.out;
        for (int k = 0; k < k_; ++k) {
            if (j <= solvers_[k].n()) add_block(out.p, 3 * k, 3 * k, matrix(solvers_[k].ws.at.curvature[j]));
        }
        for (const FrozenPair& f : pairs_) {
            if (j >= f.nodes) continue;
            const Block3 between = -matrix(f.curvature[j]);
            add_block(out.p, 3 * f.pair->first, 3 * f.pair->second, between);
            add_block(out.p, 3 * f.pair->second, 3 * f.pair->first, between);
        }
    }

    /// Adds the shear of the pairs' segments j along the hair: ψ'' (∇u)(∇u)ᵀ + ψ' ∇∇u over the moves of the nodes
    /// outboard and the steps of the segments.
    void add_shear(int j) {
        Outboard& out = scratch_.out;
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
            const Block3 moves = shear.stiffness * mean * mean.transpose();
            constexpr double kSign[2] = {-1, 1};  // of d = x₂ − x₁
            for (int i = 0; i < 2; ++i) {
                const Eigen::Matrix<double, 2, 3> mixed =
                    shear.stiffness * by_step[i] * mean.transpose() + shear.force * turn[i];
                for (int k = 0; k < 2; ++k) {
                    add_block(out.p, 3 * side[i], 3 * side[k], Block3(kSign[i] * kSign[k] * moves));
                    add_block(out.q, 2 * side[i], 3 * side[k], Eigen::Matrix<double, 2, 3>(kSign[k] * mixed));
                    add_block(out.r, 2 * side[i], 2 * side[k],
                              Eigen::Matrix2d(shear.stiffness * by_step[i] * by_step[k].transpose()));
                }
            }
        }
    }

    int columns() const { return whole_lanes(moves_ + steps_ + 1); }

    double damping_of(const Solver& s, int j) const {
        return damping_ * (s.rod.stiffness[j] + (j + 1 < s.n() ? s.rod.stiffness[j + 1] : 0));
    }

    bool eliminate(int j) {
        add_shear(j);
        Outboard& out = scratch_.out;
        Gain& gain = scratch_.gain[j];
        // Rows of U: own + R + AᵀPA + QA + (QA)ᵀ; of Xᵀ: AᵀP + Q.
        for (int i = 0; i < steps_; ++i) {
            std::copy(out.r[i], out.r[i] + steps_, gain.upper[i]);
            std::copy(out.q[i], out.q[i] + moves_, gain.z[i]);
            std::fill(gain.z[i] + moves_, gain.z[i] + moves_ + steps_, 0.0);
            gain.z[i][moves_ + steps_] = out.r1[i];
            std::fill(gain.z[i] + moves_ + steps_ + 1, gain.z[i] + columns(), 0.0);
        }
        double pa[kMaxSteps][kMaxMoves], qa[kMaxSteps][kMaxSteps]{};
        for (int k = 0; k < k_; ++k) {
            const Solver& s = solvers_[k];
            const bool there = j < s.n();
            const Arm arm = there ? arm_of(s, j) : Arm::Zero();
            arms_[k] = arm;
            for (int i = 0; i < 2; ++i) {
                const double *p0 = out.p[3 * k], *p1 = out.p[3 * k + 1], *p2 = out.p[3 * k + 2];
                for (int c = 0; c < moves_; ++c)
                    pa[2 * k + i][c] = arm(0, i) * p0[c] + arm(1, i) * p1[c] + arm(2, i) * p2[c];
                for (int r = 0; r < steps_; ++r)
                    qa[r][2 * k + i] =
                        out.q[r][3 * k] * arm(0, i) + out.q[r][3 * k + 1] * arm(1, i) + out.q[r][3 * k + 2] * arm(2, i);
                gain.z[2 * k + i][moves_ + steps_] +=
                    arm(0, i) * out.p1[3 * k] + arm(1, i) * out.p1[3 * k + 1] + arm(2, i) * out.p1[3 * k + 2];
            }
        }
        for (int i = 0; i < steps_; ++i) {
            for (int k = i / 2; k < k_; ++k) {
                const Arm& arm = arms_[k];
                const double* row = pa[i] + 3 * k;
                for (int c = 0; c < 2; ++c)
                    gain.upper[i][2 * k + c] += row[0] * arm(0, c) + row[1] * arm(1, c) + row[2] * arm(2, c) +
                                                qa[i][2 * k + c] + qa[2 * k + c][i];
            }
            for (int c = 0; c < moves_; ++c) gain.z[i][c] += pa[i][c];
        }
        for (int k = 0; k < k_; ++k) {
            const Solver& s = solvers_[k];
            if (j >= s.n()) {
                gain.upper[2 * k][2 * k] = gain.upper[2 * k + 1][2 * k + 1] = 1;
                continue;
            }
            const Mat2& m = s.ws.derivatives.segment[j].own;
            const double damped = damping_ > 0 ? damping_of(s, j) : 0;
            gain.upper[2 * k][2 * k] += m.m[0][0] + damped;
            gain.upper[2 * k][2 * k + 1] += m.m[1][0];
            gain.upper[2 * k + 1][2 * k + 1] += m.m[1][1] + damped;
            for (int i = 0; i < 2; ++i) gain.z[2 * k + i][moves_ + steps_] += s.ws.derivatives.gradient[2 * j + i];
        }
        if (!factorise(gain.upper, gain.inverse, steps_)) return false;
        if (j > 0) couple_inboard(j, gain);
        forward(gain.upper, gain.inverse, steps_, columns(), gain.z);
        if (j > 0) reduce_inboard(j, gain);
        return true;
    }

    /// Completes the rows of segment j by what couples it to the nodes and segments inboard.
    void couple_inboard(int j, Gain& gain) {
        for (int k = 0; k < k_; ++k) {
            const Solver& s = solvers_[k];
            if (j >= s.n()) continue;
            const Evaluation& at = s.ws.at;
            const Block3 across = matrix(at.across[j - 1]), coupling = matrix(at.coupling[j]) + across;
            add_block(gain.z, 2 * k, 3 * k, Eigen::Matrix<double, 2, 3>((coupling * arms_[k]).transpose()));
            far_[k] = (across * arm_of(s, j - 1)).transpose();
            const Mat2& inboard = s.ws.derivatives.segment[j].inboard;
            Eigen::Matrix2d in;  // by the steps inboard and its own
            in << inboard.m[0][0], inboard.m[0][1], inboard.m[1][0], inboard.m[1][1];
            in -= far_[k] * arms_[k];
            add_block(gain.z, 2 * k, moves_ + 2 * k, Eigen::Matrix2d(in.transpose()));
        }
    }

    /// The model over the moves of the nodes inboard of segment j and over the steps of the segments there.
    void reduce_inboard(int j, const Gain& gain) {
        Outboard& out = scratch_.out;
        const int last = moves_ + steps_;
        square(gain.z, steps_, last, columns(), scratch_.gram);
        const auto& gram = scratch_.gram;
        for (int i = 0; i < moves_; ++i) {
            for (int c = i; c < moves_; ++c) {
                out.p[i][c] -= gram[i][c];
                out.p[c][i] = out.p[i][c];
            }
            for (int c = 0; c < steps_; ++c) out.q[c][i] = -gram[i][moves_ + c];
            out.p1[i] -= gram[i][last];
        }
        for (int i = 0; i < steps_; ++i) {
            for (int c = i; c < steps_; ++c) out.r[i][c] = out.r[c][i] = -gram[moves_ + i][moves_ + c];
            out.r1[i] = -gram[moves_ + i][last];
        }
        for (int k = 0; k < k_; ++k) {
            const Solver& s = solvers_[k];
            if (j >= s.n()) continue;
            const Block3 coupling = matrix(s.ws.at.coupling[j]) + matrix(s.ws.at.across[j - 1]);
            add_block(out.p, 3 * k, 3 * k, Block3(2 * coupling));
            add_block(out.q, 2 * k, 3 * k, Eigen::Matrix<double, 2, 3>(-far_[k]));
        }
        add_nodes(j);
    }

    std::span<const Solver> solvers_;
    std::span<const FrozenPair> pairs_;
    int k_ = 0, moves_ = 0, steps_ = 0, n_ = 0;
    double damping_ = 0;
    Scratch& scratch_;
    Arm arms_[kMaxCoupled];
    Eigen::Matrix<double, 2, 3> far_[kMaxCoupled];
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
    Recycled<Eigen::Index> first;
    for (const Solver& s : solvers_) {
        first.push_back(size);
        size += 2 * s.n();
    }
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
    Recycled<double> own;
    for (std::size_t k = 0; k < solvers_.size(); ++k) {
        const Solver& s = solvers_[k];
        fill_hessian({s.rod, s.shape, s.ws.at, s.ws.derivatives}, own);
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
