#pragma once

#include <array>

#include "core/geometry/types.h"

/// \file
/// Light of the photographer's studio: three soft boxes or a lamp from the side, a dim dome and a floor. "Light" is
/// irradiance over π, so a white matt surface shows its light as its colour. Internal to `render/picture`.
namespace tuft::render {

/// Flat rectangular lamp that shines towards its normal; its radiance falls off smoothly
/// over the last part `kEdge` on each side of its border.
struct SoftBox {
    static constexpr float kEdge = 0.12f;
    Vec3f centre{0};               ///< metres
    Vec3f u{1, 0, 0}, v{0, 1, 0};  ///< half axes, metres
    Vec3f normal{0, 0, 1};         ///< unit, towards the subject
    Vec3f radiance{1};             ///< linear, towards the normal
};

/// Lamps, dome and floor about the object.
struct Studio {
    std::array<SoftBox, 3> boxes;  ///< key, fill, rim
    Vec3f centre{0};               ///< of the object
    float radius = 1;              ///< of its bounding sphere, metres
    bool floor = true;
    float floor_z = 0;         ///< metres
    Vec3f floor_albedo{0.5f};  ///< linear reflectance
    float scale = 1;           ///< exposure, already in all radiances
    float dome = 1;            ///< factor on the dome's light
    bool raking = false;
};

/// Studio for an object in `bounds`, seen from `azimuth` (lights turned by `turn` more).
/// Exposed so that a white matt face turned half up, half to the key light shows `white`.
Studio make_studio(const Box& bounds, double azimuth, double turn, bool floor, double exposure);

/// Camera and light of a studio with raking light.
struct RakingLight {
    Vec3f right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};  ///< unit, of the camera, world frame
    double turn = 0;                                      ///< radians, of the lamp clockwise about `forward`
    bool floor = true;
    double exposure = 1;  ///< > 0, as in `make_studio`
};

/// Returns a studio that shows relief: one small lamp grazes the surfaces that the camera sees, from its left, and a
/// dim dome surrounds them. Exposed as above for a face towards the camera.
Studio make_raking_studio(const Box& bounds, const RakingLight& light);

/// Radiance of the dome from a direction (unit).
Vec3f dome_radiance(const Studio& studio, const Vec3f& direction);

/// Radiance of the boxes along a ray, blurred by a coat of the given roughness.
Vec3f box_radiance(const Studio& studio, const Vec3f& origin, const Vec3f& direction, float roughness);

/// A point of a box seen from p, with the light it would give a face with normal n.
struct BoxSample {
    Vec3f direction{0};  ///< unit, from p
    float distance = 0;  ///< metres
    Vec3f light{0};      ///< radiance · cos · cos · area / distance² / π
};
BoxSample sample_box(const SoftBox& box, const Vec3f& p, const Vec3f& n, const Vec2f& s);

/// Light on a face without anything in the way, floor included; closed studio only.
Vec3f open_light(const Studio& studio, const Vec3f& p, const Vec3f& n);

/// Colour of the backdrop at picture position (x, y) in [0, 1]², y down.
Vec3f backdrop(float x, float y);

}  // namespace tuft::render
