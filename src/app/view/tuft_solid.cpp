#include "app/view/tuft_solid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/surface/tuft_surface.h"
#include "core/ease.h"
#include "ink/composite/composite.h"

namespace tuft::app {
namespace {

const Vec3f kHair{0.21f, 0.14f, 0.085f}, kFerrule{0.32f, 0.22f, 0.11f}, kBamboo{0.42f, 0.30f, 0.15f};

// A tube round the holder's axis.
struct Tube {
    double from = 0, to = 0;                ///< metres above the ferrule's mouth
    double from_radius = 0, to_radius = 0;  ///< metres
    Vec3f colour{1};                        ///< linear
};

// `mouth`: origin in the ferrule's mouth, normal along the holder.
void add_tube(render::GlSolid& solid, const Frame& mouth, const Tube& tube) {
    constexpr std::uint32_t sides = 24;
    const auto base = static_cast<std::uint32_t>(solid.positions.size());
    for (int ring = 0; ring < 2; ++ring)
        for (std::uint32_t i = 0; i < sides; ++i) {
            const double a = 2 * std::numbers::pi * i / sides;
            const Vec3 out = std::cos(a) * mouth.t + std::sin(a) * mouth.b;
            const double radius = ring ? tube.to_radius : tube.from_radius, height = ring ? tube.to : tube.from;
            solid.positions.push_back(Vec3f(mouth.origin + radius * out + height * mouth.n));
            solid.normals.push_back(Vec3f(out));
            solid.colours.push_back(tube.colour);
        }
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t j = (i + 1) % sides;
        for (const std::uint32_t v : {i, j, sides + j, i, sides + j, sides + i}) solid.triangles.push_back(base + v);
    }
}

Vec3f linear_of(unsigned colour) {
    Vec3f linear;
    for (int c = 0; c < 3; ++c) linear[c] = ink::srgb_decode(static_cast<float>((colour >> (8 * c)) & 255) / 255);
    return linear;
}

}  // namespace

// Wet hair is dark: of the ink's light a part stays in it. The root keeps its own colour.
Vec3f hair_colour(double from_tip, unsigned ink) {
    const auto inked = static_cast<float>(1 - std::clamp((from_tip - 0.35) / 0.5, 0.0, 1.0));
    return glm::mix(kHair, 0.85f * linear_of(ink), smooth_step(inked));
}

render::GlSolid solid_of(const brush::TuftState& tuft, unsigned ink) {
    render::GlSolid solid;
    if (tuft.branches.empty()) return solid;
    const brush::TuftSurface surface = brush::make_tuft_surface(tuft);
    const Recycled<brush::Section>& spine = tuft.branches.front().sections;
    const double length = std::max(1e-6, glm::distance(spine.front().centre, spine.back().centre));
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        solid.positions.push_back(Vec3f(surface.positions[i]));
        solid.normals.push_back(Vec3f(surface.normals[i]));
        const double from_root = glm::distance(surface.positions[i], spine.back().centre);
        solid.colours.push_back(hair_colour(1 - from_root / length, ink));
    }
    solid.triangles = surface.triangles;
    const brush::Section& root = tuft.branches.front().sections.back();
    const double r = std::max(root.a, root.b);
    const Vec3 up = -root.tangent;
    const Frame mouth = make_frame(root.centre, up);
    add_tube(solid, mouth, {0, 2.2 * r, 1.06 * r, 1.12 * r, kFerrule});
    add_tube(solid, mouth, {2.2 * r, 16 * r, 0.95 * r, 0.85 * r, kBamboo});
    return solid;
}

}  // namespace tuft::app
