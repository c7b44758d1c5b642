#include <algorithm>
#include <cmath>

#include "brush/rod/rod_energy.h"
#include "core/simd.h"

namespace tuft::brush::rod {

namespace {

using Joint = Derivatives::Joint;

/// Unit tangent of a segment and its two normals.
struct SegmentAxes {
    Vec3 tangent{0, 0, -1}, side{1, 0, 0}, second{0, 1, 0};
};

/// Of the joint between an inner segment a and an outer one b.
void compute_joint(const JointForce& jf, const SegmentAxes& a, const SegmentAxes& b, Joint& out) {
    const AngleFunctions& f = jf.angle;
    const double c = glm::dot(a.tangent, b.tangent);
    out.p[0] = glm::dot(a.side, b.tangent);
    out.p[1] = glm::dot(a.second, b.tangent);
    out.q[0] = glm::dot(b.side, a.tangent);
    out.q[1] = glm::dot(b.second, a.tangent);
    out.r[0][0] = glm::dot(a.side, b.side);
    out.r[0][1] = glm::dot(a.side, b.second);
    out.r[1][0] = glm::dot(a.second, b.side);
    out.r[1][1] = glm::dot(a.second, b.second);
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 2; ++k) {
            out.ja[i][k] = -f.chi * out.p[i] * out.p[k] - (i == k ? f.phi * c : 0);
            out.jb[i][k] = -f.chi * out.p[i] * out.q[k] + f.phi * out.r[i][k];
        }
    }
}

/// Blocks of the Hessian of one joint between inner segment a and outer b.
struct JointBlocks {
    Mat2 aa, ab, bb;
};

/// Jᵀ D J plus the moment times the second derivative of w; c is the cosine of the angle.
JointBlocks joint_blocks(const JointForce& jf, const Joint& joint, double c) {
    const auto& [p, q, r, ja, jb] = joint;
    const AngleFunctions& f = jf.angle;
    const double m[2] = {jf.moment.x, jf.moment.y};
    const double d[2][2] = {{jf.d00, jf.d01}, {jf.d01, jf.d11}};
    const double mp = m[0] * p[0] + m[1] * p[1];
    const double rm[2] = {r[0][0] * m[0] + r[1][0] * m[1], r[0][1] * m[0] + r[1][1] * m[1]};
    double dja[2][2], djb[2][2];
    for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < 2; ++i) {
            dja[i][k] = d[i][0] * ja[0][k] + d[i][1] * ja[1][k];
            djb[i][k] = d[i][0] * jb[0][k] + d[i][1] * jb[1][k];
        }
    }
    JointBlocks out;
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 2; ++k) {
            const double id = i == k ? 1 : 0;
            if (k <= i) {
                out.aa.m[i][k] = ja[0][i] * dja[0][k] + ja[1][i] * dja[1][k] +
                                 (f.chi * c - 0.5 * f.phi) * (m[i] * p[k] + p[i] * m[k]) + f.chi * c * mp * id -
                                 f.dchi * mp * p[i] * p[k];
                out.bb.m[i][k] = jb[0][i] * djb[0][k] + jb[1][i] * djb[1][k] + (f.chi * c - f.phi) * mp * id -
                                 f.chi * (q[i] * rm[k] + rm[i] * q[k]) - f.dchi * mp * q[i] * q[k];
            }
            out.ab.m[i][k] = ja[0][i] * djb[0][k] + ja[1][i] * djb[1][k] + (f.chi * c - f.phi) * m[i] * q[k] -
                             f.chi * p[i] * rm[k] - f.chi * mp * r[i][k] - f.dchi * mp * p[i] * q[k];
        }
    }
    out.aa.m[0][1] = out.aa.m[1][0];
    out.bb.m[0][1] = out.bb.m[1][0];
    return out;
}

/// 2n × 2n, column major, of which the lower half is filled.
struct Lower {
    Recycled<double>& h;
    std::size_t size;

    double& operator()(int row, int col) {
        return h[static_cast<std::size_t>(col) * size + static_cast<std::size_t>(row)];
    }
};

}  // namespace

void differentiate(const Frozen& frozen, const Shape& shape, const Evaluation& at, Derivatives& out) {
    const Rod& rod = *frozen.rod;
    const int n = rod.segments();
    out.gradient.assign(2 * n, 0);
    out.second.resize(n);
    out.joint.resize(n);
    const Clamp& clamp = frozen.clamp;
    SegmentAxes inner{clamp.tangent, clamp.side, glm::cross(clamp.tangent, clamp.side)};
    for (int j = 0; j < n; ++j) {
        const SegmentAxes outer_axes{shape.tangent[j], shape.side[j], glm::cross(shape.tangent[j], shape.side[j])};
        out.second[j] = outer_axes.second;
        Joint& joint = out.joint[j];
        compute_joint(at.joint[j], inner, outer_axes, joint);
        const Vec2& m = at.joint[j].moment;
        for (int i = 0; i < 2; ++i) {
            out.gradient[2 * j + i] += joint.jb[0][i] * m.x + joint.jb[1][i] * m.y;
            if (j > 0) out.gradient[2 * (j - 1) + i] += joint.ja[0][i] * m.x + joint.ja[1][i] * m.y;
        }
        inner = outer_axes;
    }
    // Forces outboard of a segment, seen through its lever arm.
    Vec3 slope{0};
    for (int b = n - 1; b >= 0; --b) {
        slope += at.slope[b + 1];
        out.gradient[2 * b] += rod.length[b] * glm::dot(shape.side[b], slope);
        out.gradient[2 * b + 1] += rod.length[b] * glm::dot(out.second[b], slope);
    }
}

void differentiate_twice(const Frozen& frozen, const Shape& shape, const Evaluation& at, Derivatives& out) {
    const Rod& rod = *frozen.rod;
    const int n = rod.segments();
    out.segment.resize(n);
    for (int j = 0; j < n; ++j) {
        const Vec3& inner = j > 0 ? shape.tangent[j - 1] : frozen.clamp.tangent;
        const JointBlocks jb = joint_blocks(at.joint[j], out.joint[j], glm::dot(inner, shape.tangent[j]));
        out.segment[j] = {jb.bb, jb.ab};
        for (int i = 0; j > 0 && i < 2; ++i) {
            for (int k = 0; k < 2; ++k) out.segment[j - 1].own.m[i][k] += jb.aa.m[i][k];
        }
    }
    Vec3 slope{0};
    for (int b = n - 1; b >= 0; --b) {
        slope += at.slope[b + 1];
        const double straight = -rod.length[b] * glm::dot(shape.tangent[b], slope);
        out.segment[b].own.m[0][0] += straight;
        out.segment[b].own.m[1][1] += straight;
    }
}

namespace {

/// Eliminates the steps from tip to root into `work`. Returns false where a pivot is not positive definite.
TUFT_CLONES bool eliminate(const QuadraticModel& model, double damping, Elimination& work) {
    const auto& [rod, shape, at, d] = model;
    const int n = rod.segments();
    work.gain.resize(n);
    // ½ xᵀPx + Σ_k (Q_k·x) v_k + ½ vᵀRv + p·x + r·v, x the move of the node outboard of segment j
    // and v its steps: the least of Π's model over everything further out.
    Sym3 big_p = at.curvature[n];
    Vec3 big_q[2] = {Vec3{0}, Vec3{0}}, p{0};
    Mat2 big_r;
    double r[2] = {0, 0};
    for (int j = n - 1;; --j) {
        const double l = rod.length[j];
        const Vec3 arm[2] = {l * shape.side[j], l * d.second[j]};
        const Vec3 pa[2] = {big_p * arm[0], big_p * arm[1]};
        const Mat2& own = d.segment[j].own;
        const double damped = damping > 0 ? damping * (rod.stiffness[j] + (j + 1 < n ? rod.stiffness[j + 1] : 0)) : 0;
        // The steps of segment j: their own matrix, and its inverse.
        const double u00 =
            own.m[0][0] + big_r.m[0][0] + glm::dot(arm[0], pa[0]) + 2 * glm::dot(big_q[0], arm[0]) + damped;
        const double u10 = own.m[1][0] + big_r.m[1][0] + glm::dot(arm[1], pa[0]) + glm::dot(big_q[0], arm[1]) +
                           glm::dot(big_q[1], arm[0]);
        const double u11 =
            own.m[1][1] + big_r.m[1][1] + glm::dot(arm[1], pa[1]) + 2 * glm::dot(big_q[1], arm[1]) + damped;
        const double det = u00 * u11 - u10 * u10;
        if (!(u00 > 0) || !(det > 0)) return false;
        const double i00 = u11 / det, i10 = -u10 / det, i11 = u00 / det;
        const double g[2] = {d.gradient[2 * j] + r[0] + glm::dot(arm[0], p),
                             d.gradient[2 * j + 1] + r[1] + glm::dot(arm[1], p)};
        Elimination::Gain& gain = work.gain[j];
        gain.rest[0] = i00 * g[0] + i10 * g[1];
        gain.rest[1] = i10 * g[0] + i11 * g[1];
        if (j == 0) return true;
        // The node before x_j moves by x less the steps there, v: V_{j-1,j+1} couples those to x and to u.
        const Sym3& far = at.across[j - 1];
        const Sym3 coupling = at.coupling[j] + far;
        const double before = rod.length[j - 1];
        const Vec3 far_arm[2] = {before * (far * shape.side[j - 1]), before * (far * d.second[j - 1])};
        const Vec3 x0 = pa[0] + big_q[0] + coupling * arm[0], x1 = pa[1] + big_q[1] + coupling * arm[1];
        gain.move[0] = i00 * x0 + i10 * x1;
        gain.move[1] = i10 * x0 + i11 * x1;
        Mat2 in = d.segment[j].inboard;
        for (int i = 0; i < 2; ++i) {
            for (int k = 0; k < 2; ++k) in.m[i][k] -= glm::dot(far_arm[i], arm[k]);
            gain.inner.m[0][i] = i00 * in.m[i][0] + i10 * in.m[i][1];
            gain.inner.m[1][i] = i10 * in.m[i][0] + i11 * in.m[i][1];
        }
        big_p += 2 * coupling + at.curvature[j];
        big_p += -1.0 * (symmetric(x0, gain.move[0]) + symmetric(x1, gain.move[1]));
        p -= gain.rest[0] * x0 + gain.rest[1] * x1;
        for (int i = 0; i < 2; ++i) {
            big_q[i] = -far_arm[i] - (in.m[i][0] * gain.move[0] + in.m[i][1] * gain.move[1]);
            r[i] = -(in.m[i][0] * gain.rest[0] + in.m[i][1] * gain.rest[1]);
            for (int k = 0; k <= i; ++k) {
                big_r.m[i][k] = -(in.m[i][0] * gain.inner.m[0][k] + in.m[i][1] * gain.inner.m[1][k]);
            }
        }
    }
}

/// Computes the steps from root to tip by what `eliminate` left in `work`.
void substitute(const QuadraticModel& model, const Elimination& work, Recycled<double>& step) {
    const auto& [rod, shape, at, d] = model;
    const int n = rod.segments();
    Vec3 moved{0};
    double before[2] = {0, 0};
    for (int j = 0; j < n; ++j) {
        const Elimination::Gain& gain = work.gain[j];
        double u[2];
        for (int k = 0; k < 2; ++k) {
            u[k] = -gain.rest[k];
            if (j > 0)
                u[k] -= glm::dot(gain.move[k], moved) + gain.inner.m[k][0] * before[0] + gain.inner.m[k][1] * before[1];
            step[2 * j + k] = u[k];
        }
        moved += rod.length[j] * (u[0] * shape.side[j] + u[1] * d.second[j]);
        before[0] = u[0];
        before[1] = u[1];
    }
}

}  // namespace

bool descend(const QuadraticModel& model, double damping, Elimination& work, Recycled<double>& step) {
    step.resize(2 * model.rod.segments());
    if (!eliminate(model, damping, work)) return false;
    substitute(model, work, step);
    return true;
}

void fill_hessian(const QuadraticModel& model, Recycled<double>& hessian) {
    const auto& [rod, shape, at, d] = model;
    const int n = rod.segments();
    const auto size = static_cast<std::size_t>(2 * n);
    hessian.assign(size * size, 0);
    Lower h{hessian, size};
    Sym3 stiffness;
    for (int b = n - 1; b >= 0; --b) {
        stiffness += at.curvature[b + 1];
        if (b + 1 < n) stiffness += 2 * (at.coupling[b + 1] + at.across[b + 1]);
        // Segments inboard of b also move the node at its inner end, and all but the next the one before it.
        const Sym3 next = stiffness + at.coupling[b] + at.across[b], further = b > 0 ? next + at.across[b - 1] : next;
        const double lb = rod.length[b];
        const Vec3 tb[2] = {shape.side[b], d.second[b]};
        for (int k = 0; k < 2; ++k) {
            const Vec3 own = lb * lb * (stiffness * tb[k]), near = lb * (next * tb[k]), y = lb * (further * tb[k]);
            for (int i = 0; i < 2; ++i) {
                h(2 * b + k, 2 * b + i) += d.segment[b].own.m[k][i] + glm::dot(tb[i], own);
                if (b > 0) h(2 * b + k, 2 * (b - 1) + i) += d.segment[b].inboard.m[i][k];
            }
            for (int c = 0; c < b; ++c) {
                const Vec3& from = c + 1 == b ? near : y;
                h(2 * b + k, 2 * c) += rod.length[c] * glm::dot(shape.side[c], from);
                h(2 * b + k, 2 * c + 1) += rod.length[c] * glm::dot(d.second[c], from);
            }
        }
    }
}

}  // namespace tuft::brush::rod
