#include "app/view/model_colours.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace tuft::app {
namespace {

std::array<std::uint8_t, 4> rgb(const Vec3& c) {
    const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0))); };
    return {byte(c.x), byte(c.y), byte(c.z), 255};
}

Vec3 from_hue(double hue, double chroma, double light) {
    const auto wave = [&](double shift) { return light + chroma * std::cos(6.283185307179586 * (hue - shift)); };
    return {wave(0), wave(1.0 / 3), wave(2.0 / 3)};
}

}  // namespace

TriangleColours chart_colours(const atlas::Atlas& atlas) {
    TriangleColours colours;
    colours.reserve(atlas.triangle_chart.size());
    for (const std::uint32_t chart : atlas.triangle_chart) {
        // Steps of the golden ratio round the hues.
        const double hue = std::fmod(0.61803398875 * chart, 1.0), light = 0.58 + 0.12 * (uniform(7, chart) - 0.5);
        colours.push_back(rgb(from_hue(hue, 0.26, light)));
    }
    return colours;
}

TriangleColours stretch_colours(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas) {
    TriangleColours colours;
    colours.reserve(mesh.n_triangles());
    const double mean = 1.0 / (std::max(1e-12, atlas.texel_size) * atlas.size);
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 a = mesh.position(t, 1) - mesh.position(t, 0), b = mesh.position(t, 2) - mesh.position(t, 0);
        const Vec2 u = Vec2(atlas.corner_uvs[3 * t + 1]) - Vec2(atlas.corner_uvs[3 * t]),
                   v = Vec2(atlas.corner_uvs[3 * t + 2]) - Vec2(atlas.corner_uvs[3 * t]);
        // Edges in the triangle's plane: a = (x, 0), b = (y, z).
        const double x = glm::length(a), y = x > 0 ? glm::dot(a, b) / x : 0,
                     z = std::sqrt(std::max(0.0, glm::dot(b, b) - y * y));
        if (x <= 0 || z <= 0) {
            colours.push_back({128, 128, 128, 255});
            continue;
        }
        const Vec2 du = u / x, dv = (v - y * du) / z;
        const double scale = std::sqrt(0.5 * (glm::dot(du, du) + glm::dot(dv, dv))) / mean;
        const double s = std::clamp(std::log(std::max(1e-9, scale)) / std::log(1.5), -1.0, 1.0);
        const Vec3 grey(0.72), end = s > 0 ? Vec3(0.86, 0.20, 0.12) : Vec3(0.14, 0.34, 0.84);
        colours.push_back(rgb(grey + std::abs(s) * (end - grey)));
    }
    return colours;
}

}  // namespace tuft::app
