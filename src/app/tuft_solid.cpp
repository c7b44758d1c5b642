#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/studio.h"
#include "brush/skin.h"

namespace tuft::app {
namespace {

const Vec3f kHair{0.050f, 0.042f, 0.038f}, kFerrule{0.32f, 0.22f, 0.11f}, kBamboo{0.42f, 0.30f, 0.15f};

// A tube round the holder's axis between two heights above the ferrule's mouth.
void add_tube(render::GlSolid& solid, const Vec3& mouth, const Vec3& up, double r0, double r1, double from, double to,
              const Vec3f& colour) {
    constexpr std::uint32_t sides = 24;
    const Frame f = make_frame(mouth, up);
    const auto base = static_cast<std::uint32_t>(solid.positions.size());
    for (int ring = 0; ring < 2; ++ring)
        for (std::uint32_t i = 0; i < sides; ++i) {
            const double a = 2 * std::numbers::pi * i / sides;
            const Vec3 out = std::cos(a) * f.t + std::sin(a) * f.b;
            solid.positions.push_back(Vec3f(mouth + (ring ? r1 : r0) * out + (ring ? to : from) * up));
            solid.normals.push_back(Vec3f(out));
            solid.colours.push_back(colour);
        }
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t j = (i + 1) % sides;
        for (const std::uint32_t v : {i, j, sides + j, i, sides + j, sides + i}) solid.triangles.push_back(base + v);
    }
}

}  // namespace

render::GlSolid solid_of(const brush::TuftState& tuft) {
    render::GlSolid solid;
    if (tuft.branches.empty()) return solid;
    const brush::Skin skin = brush::make_skin(tuft);
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        solid.positions.push_back(Vec3f(skin.positions[i]));
        solid.normals.push_back(Vec3f(skin.normals[i]));
        solid.colours.push_back(kHair);
    }
    solid.triangles = skin.triangles;
    const brush::Section& root = tuft.branches.front().sections.back();
    const double r = std::max(root.a, root.b);
    const Vec3 up = -root.tangent;
    add_tube(solid, root.centre, up, 1.06 * r, 1.12 * r, 0, 2.2 * r, kFerrule);
    add_tube(solid, root.centre, up, 0.95 * r, 0.85 * r, 2.2 * r, 16 * r, kBamboo);
    return solid;
}

}  // namespace tuft::app
