#include "atlas/unwrap/atlas_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atlas/pack/coverage.h"
#include "atlas/pack/raster.h"
#include "atlas/seams/half_edges.h"
#include "core/random.h"

namespace tuft::atlas {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kPaper{24, 26, 30};
constexpr double kRange = 0.2;  // stretch at the ends of the colour scale

Colour mix(const Colour& a, const Colour& b, double t) {
    Colour c;
    for (int k = 0; k < 3; ++k) c[k] = static_cast<std::uint8_t>(std::lround((1 - t) * a[k] + t * b[k]));
    return c;
}

/// Hues spread by the golden angle, so that neighbours in the list differ.
Colour chart_colour(std::uint32_t chart) {
    const double hue = std::fmod(chart * 0.6180339887498949, 1.0) * 6;
    const double light = 0.75 + 0.25 * uniform(7, chart);
    const auto channel = [&](double shift) {
        const double h = std::fmod(hue + shift, 6.0);
        const double x = std::clamp(std::min(h, 4 - h), 0.0, 1.0);
        return static_cast<std::uint8_t>(std::lround(255 * light * (0.45 + 0.5 * x)));
    };
    return {channel(0), channel(4), channel(2)};
}

Colour stretch_colour(double stretch) {
    constexpr Colour kSmall{40, 90, 220}, kMean{245, 245, 240}, kLarge{215, 35, 30};
    const double t = std::clamp((stretch - 1) / kRange, -1.0, 1.0);
    return mix(kMean, t < 0 ? kSmall : kLarge, std::abs(t));
}

/// Larger singular value of the map from UV, in metres of the mean texel, to surface.
double triangle_stretch(const mesh::TriangleMesh& mesh, const Atlas& atlas, std::size_t t) {
    const double unit = atlas.texel_size * atlas.size;
    const Vec3 e1 = mesh.position(t, 1) - mesh.position(t, 0);
    const Vec3 e2 = mesh.position(t, 2) - mesh.position(t, 0);
    const Vec2 d1 = unit * (Vec2(atlas.corner_uvs[3 * t + 1]) - Vec2(atlas.corner_uvs[3 * t]));
    const Vec2 d2 = unit * (Vec2(atlas.corner_uvs[3 * t + 2]) - Vec2(atlas.corner_uvs[3 * t]));
    const double det = d1.x * d2.y - d1.y * d2.x;
    if (det == 0 || !std::isfinite(det)) return 1;
    const Vec3 su = (e1 * d2.y - e2 * d1.y) / det, sv = (e2 * d1.x - e1 * d2.x) / det;
    const double a = glm::dot(su, su), b = glm::dot(su, sv), c = glm::dot(sv, sv);
    const double stretch = std::sqrt(0.5 * (a + c + std::sqrt((a - c) * (a - c) + 4 * b * b)));
    return std::isfinite(stretch) ? stretch : 1;
}

class Canvas {
  public:
    Canvas(AtlasPicture& picture, std::uint32_t side) : picture_(picture), side_(side) {}

    void set(std::uint32_t square, std::uint32_t x, std::uint32_t row, const Colour& colour) {
        if (x >= side_ || row >= side_) return;
        const std::size_t at = 3 * ((std::size_t{side_} - 1 - row) * picture_.width + square * side_ + x);
        std::copy(colour.begin(), colour.end(), picture_.rgb.begin() + static_cast<std::ptrdiff_t>(at));
    }

    void line(std::uint32_t square, const Vec2f& a_uv, const Vec2f& b_uv, const Colour& colour) {
        if (!is_finite(a_uv) || !is_finite(b_uv)) return;
        const Vec2 a(a_uv), b(b_uv);
        const double length = std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)) * side_;
        const int steps = static_cast<int>(std::min(length, 4.0 * side_)) + 1;
        for (int i = 0; i <= steps; ++i) {
            const Vec2 p = (a + (b - a) * (double(i) / steps)) * double(side_);
            if (p.x >= 0 && p.y >= 0 && p.x < side_ && p.y < side_)
                set(square, static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y), colour);
        }
    }

  private:
    AtlasPicture& picture_;
    std::uint32_t side_;
};

}  // namespace

AtlasPicture draw_atlas(const mesh::TriangleMesh& mesh, const Atlas& atlas, const AtlasPictureOptions& options) {
    AtlasPicture picture;
    const std::uint32_t side = std::max(options.side, 1u);
    picture.width = 2 * side;
    picture.height = side;
    picture.rgb.resize(3 * std::size_t{picture.width} * picture.height);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = kPaper[i % 3];

    Canvas canvas(picture, side);
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const std::array<Vec2f, 3> uv{atlas.corner_uvs[3 * t], atlas.corner_uvs[3 * t + 1],
                                      atlas.corner_uvs[3 * t + 2]};
        const Colour chart = chart_colour(atlas.triangle_chart[t]);
        const Colour stretch = stretch_colour(triangle_stretch(mesh, atlas, t));
        raster_rows(uv, side, [&](std::uint32_t row, std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t x = first; x <= last; ++x) {
                canvas.set(0, x, row, chart);
                canvas.set(1, x, row, stretch);
            }
        });
    }
    const std::vector<std::uint8_t> seam = uv_seams(twin_half_edges(mesh), atlas.corner_uvs);
    for (std::uint32_t h = 0; h < seam.size(); ++h) {
        if (!seam[h]) continue;
        const Colour border = mix(chart_colour(atlas.triangle_chart[h / 3]), {0, 0, 0}, 0.55);
        canvas.line(0, atlas.corner_uvs[h], atlas.corner_uvs[next_half(h)], border);
    }
    return picture;
}

}  // namespace tuft::atlas
