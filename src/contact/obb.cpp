#include "contact/obb.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tuft::contact {

Mat3 principal_axes(const Mat3& symmetric) {
    // Cyclic Jacobi rotations ([Golub2013] 8.5); a 3 × 3 matrix needs few sweeps.
    Mat3 a = symmetric, v(1.0);
    for (int sweep = 0; sweep < 16; ++sweep) {
        const double off = std::abs(a[0][1]) + std::abs(a[0][2]) + std::abs(a[1][2]);
        const double size = std::abs(a[0][0]) + std::abs(a[1][1]) + std::abs(a[2][2]);
        if (!(off > 1e-15 * size)) break;
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0) continue;
                const double tau = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const double t = std::copysign(1.0, tau) / (std::abs(tau) + std::hypot(1.0, tau));
                const double c = 1 / std::hypot(1.0, t), s = t * c;
                Mat3 j(1.0);
                j[p][p] = j[q][q] = c;
                j[q][p] = s;  // row p, column q
                j[p][q] = -s;
                a = glm::transpose(j) * a * j;
                v = v * j;
            }
        }
    }
    int order[3] = {0, 1, 2};
    std::sort(order, order + 3, [&](int i, int k) { return a[i][i] > a[k][k]; });
    Mat3 out(v[order[0]], v[order[1]], v[order[2]]);
    out[0] = glm::normalize(out[0]);
    out[1] = glm::normalize(out[1] - glm::dot(out[0], out[1]) * out[0]);
    out[2] = glm::cross(out[0], out[1]);
    return out;
}

Obb obb_of(std::span<const Vec3> points, double margin) {
    Obb box;
    if (points.empty()) return box;
    Vec3 mean{0};
    for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
    Mat3 covariance(0.0);
    for (const Vec3& p : points) covariance += glm::outerProduct(p - mean, p - mean);
    box.axes = principal_axes(covariance);
    Vec3 lo(std::numeric_limits<double>::infinity()), hi = -lo;
    for (const Vec3& p : points) {
        const Vec3 local = (p - mean) * box.axes;
        lo = glm::min(lo, local);
        hi = glm::max(hi, local);
    }
    box.centre = mean + box.axes * (0.5 * (lo + hi));
    box.half = 0.5 * (hi - lo) + margin;
    return box;
}

Obb obb_of(const Box& box) {
    Obb out;
    out.centre = box.centre();
    out.half = 0.5 * box.size();
    return out;
}

bool overlap(const Obb& a, const Obb& b) {
    const Mat3 r = glm::transpose(a.axes) * b.axes;  // r[j][i]: axis j of b along axis i of a
    const Vec3 t = (b.centre - a.centre) * a.axes;
    double m[3][3];
    for (int i = 0; i < 3; ++i) {
        double reach = a.half[i];
        for (int j = 0; j < 3; ++j) {
            // Near-parallel edges give a null cross product; the bias keeps that axis harmless.
            m[i][j] = std::abs(r[j][i]) + 1e-12;
            reach += b.half[j] * m[i][j];
        }
        if (std::abs(t[i]) > reach) return false;
    }
    for (int j = 0; j < 3; ++j) {
        const double reach = b.half[j] + a.half[0] * m[0][j] + a.half[1] * m[1][j] + a.half[2] * m[2][j];
        if (std::abs(glm::dot(t, r[j])) > reach) return false;
    }
    for (int i = 0; i < 3; ++i) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const double reach =
                a.half[i1] * m[i2][j] + a.half[i2] * m[i1][j] + b.half[j1] * m[i][j2] + b.half[j2] * m[i][j1];
            if (std::abs(t[i2] * r[j][i1] - t[i1] * r[j][i2]) > reach) return false;
        }
    }
    return true;
}

}  // namespace tuft::contact
