#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

/// \file
/// Short names for the vector types of all modules. Physics uses `double`; texels and GPU data use `float`. Units
/// are SI: metres, kilograms, seconds, newtons, radians. Frames are right-handed.
namespace tuft {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using Mat3 = glm::dmat3;
using Quat = glm::dquat;
using Vec2f = glm::vec2;
using Vec3f = glm::vec3;
using Vec4f = glm::vec4;

/// "No such element", for 32-bit indices.
inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Right-handed orthonormal frame: columns t, b, n with t × b = n.
struct Frame {
    Vec3 origin{0};   ///< world
    Vec3 t{1, 0, 0};  ///< unit, world
    Vec3 b{0, 1, 0};  ///< unit, world
    Vec3 n{0, 0, 1};  ///< unit, world; of a surface: its normal

    Vec3 to_local(const Vec3& p_world) const {  ///< coordinates along t, b and n
        const Vec3 d = p_world - origin;
        return {glm::dot(d, t), glm::dot(d, b), glm::dot(d, n)};
    }
    Vec3 to_world(const Vec3& p_local) const { return origin + p_local.x * t + p_local.y * b + p_local.z * n; }
};

/// Returns a frame at `origin` whose n is `normal` (unit length). t is the projection of `hint` onto the plane of t
/// and b. Where `hint` is parallel to the normal, t is any direction of that plane.
Frame make_frame(const Vec3& origin, const Vec3& normal, const Vec3& hint = Vec3{1, 0, 0});

/// Rotates `v` by the smallest rotation that takes unit vector `from` to unit vector `to`. For opposite vectors
/// this is a half turn about any axis normal to them.
Vec3 parallel_transport(const Vec3& v, const Vec3& from, const Vec3& to);

/// Axis-aligned box, metres. Empty until the first `add`.
struct Box {
    Vec3 lo{std::numeric_limits<double>::infinity()};
    Vec3 hi{-std::numeric_limits<double>::infinity()};

    /// Grows the box so that it holds p.
    void add(const Vec3& p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    bool empty() const { return lo.x > hi.x; }
    Vec3 size() const { return empty() ? Vec3{0} : hi - lo; }
    Vec3 centre() const { return empty() ? Vec3{0} : 0.5 * (lo + hi); }
    double diagonal() const { return glm::length(size()); }
};

}  // namespace tuft
