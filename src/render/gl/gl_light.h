#pragma once

#include <cmath>

#include "render/gl/gl_camera.h"

/// \file
/// Light of the window, and the CPU twin of shaders/common/light.glsl: the same functions under the same names. A
/// test compares both.
namespace tuft::render {

/// Light of the window: two soft lamps under a dome. Shaders have the same formulas (shaders/common).
struct GlLight {
    Vec3f key{0, 0, 1}, fill{0, 0, 1};                                       ///< unit, world, towards the lamps
    Vec3f key_light{0.52f, 0.51f, 0.49f}, fill_light{0.10f, 0.11f, 0.125f};  ///< linear radiance
    Vec3f ground{0.24f, 0.235f, 0.23f}, sky{0.54f, 0.555f, 0.58f};           ///< of the dome
    float relief = 0;  ///< exaggeration of the height of thin ink; thick paint is not exaggerated; 0: no relief

    bool operator==(const GlLight&) const = default;
};

/// Lamps of the window.
enum class LightRig { studio, window, raking };

/// Returns the light of a rig; the lamps are fixed relative to the camera.
GlLight make_light(LightRig rig, const GlCamera& camera);

/// Returns the light of a lamp seen in direction `dir`, 1 at its middle.
inline float soft_box(const Vec3f& dir, const Vec3f& to_light, float sharpness) {
    return std::exp(sharpness * (glm::dot(dir, to_light) - 1.0f));
}

/// Returns the mirrored light from direction `dir`, blurred by the roughness of the surface.
inline Vec3f surroundings(const GlLight& l, const Vec3f& dir, float roughness) {
    const float sharp = glm::mix(90.0f, 5.0f, roughness);
    return glm::mix(l.ground, l.sky, 0.5f + 0.5f * dir.z) + 5.0f * l.key_light * soft_box(dir, l.key, sharp) +
           5.0f * l.fill_light * soft_box(dir, l.fill, sharp);
}

/// Returns the light on a surface of normal `n`, unit.
inline Vec3f irradiance(const GlLight& l, const Vec3f& n) {
    const float k = std::max(0.0f, 0.15f + 0.85f * glm::dot(n, l.key));
    const float f = std::max(0.0f, 0.25f + 0.75f * glm::dot(n, l.fill));
    return glm::mix(l.ground, l.sky, 0.5f + 0.35f * n.z) + l.key_light * k + l.fill_light * f;
}

/// Returns the reflectance of a coat of refractive index 1.5 by the cosine to the view [Schlick1994].
inline float coat_fresnel(float cos_view) {
    return 0.04f + 0.96f * std::pow(1.0f - glm::clamp(cos_view, 0.0f, 1.0f), 5.0f);
}

/// Returns the colour of mesh.frag at a point seen from direction `to_eye`, linear, before encoding.
inline Vec3f glazed(const GlLight& l, const Vec3f& base, Vec3f n, const Vec3f& to_eye, float roughness) {
    if (glm::dot(n, to_eye) < 0) n = -n;
    const float fresnel = glm::mix(coat_fresnel(glm::dot(n, to_eye)), 0.02f, glm::smoothstep(0.4f, 0.8f, roughness));
    return (1.0f - fresnel) * base * irradiance(l, n) + fresnel * surroundings(l, glm::reflect(-to_eye, n), roughness);
}

}  // namespace tuft::render
