#include "render/gl/gl_light.h"

namespace tuft::render {

GlLight make_light(LightRig rig, const GlCamera& c) {
    const auto beside = [&](double right, double up, double forward) {
        return glm::normalize(Vec3f(right * c.right + up * c.up + forward * c.forward));
    };
    GlLight l;
    l.key = beside(-0.55, 0.75, -0.35);
    l.fill = beside(0.8, 0.15, -0.55);
    if (rig == LightRig::window) {
        l.key = beside(-0.9, 0.3, -0.35);
        l.key_light = {0.62f, 0.66f, 0.72f};
        l.fill_light = {0.05f, 0.05f, 0.055f};
        l.ground = {0.17f, 0.16f, 0.15f};
        l.sky = {0.40f, 0.42f, 0.46f};
        l.relief = 1;
    } else if (rig == LightRig::raking) {
        l.key = beside(-0.97, 0.22, -0.05);
        l.key_light = {0.85f, 0.83f, 0.78f};
        l.fill_light = {0.03f, 0.03f, 0.035f};
        l.ground = {0.14f, 0.14f, 0.14f};
        l.sky = {0.26f, 0.265f, 0.275f};
        l.relief = 12;
    }
    return l;
}

}  // namespace tuft::render
