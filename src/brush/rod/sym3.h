#pragma once

#include "core/geometry/types.h"

/// \file
/// Symmetric 3 × 3 matrices for the second derivatives of contact potentials.
namespace tuft::brush {

/// Symmetric 3 × 3 matrix.
struct Sym3 {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    Sym3& operator+=(const Sym3& m) {
        xx += m.xx;
        xy += m.xy;
        xz += m.xz;
        yy += m.yy;
        yz += m.yz;
        zz += m.zz;
        return *this;
    }
    Vec3 operator*(const Vec3& v) const {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
    }
};

inline Sym3 operator*(double f, const Sym3& m) {
    return {f * m.xx, f * m.xy, f * m.xz, f * m.yy, f * m.yz, f * m.zz};
}

inline Sym3 operator+(Sym3 a, const Sym3& b) {
    return a += b;
}

/// v vᵀ
inline Sym3 outer(const Vec3& v) {
    return {v.x * v.x, v.x * v.y, v.x * v.z, v.y * v.y, v.y * v.z, v.z * v.z};
}

/// ½ (u vᵀ + v uᵀ)
inline Sym3 symmetric(const Vec3& u, const Vec3& v) {
    return {u.x * v.x, 0.5 * (u.x * v.y + u.y * v.x), 0.5 * (u.x * v.z + u.z * v.x),
            u.y * v.y, 0.5 * (u.y * v.z + u.z * v.y), u.z * v.z};
}

}  // namespace tuft::brush
