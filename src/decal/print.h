#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "decal/polygons.h"
#include "decal/print_surface.h"
#include "ink/composite/composite.h"

/// \file
/// Pictures of pieces of film at true size, from the maps of a decoration. Called by sheet.h.
namespace tuft::decal {

/// Reads a map bilinearly at a UV of the whole atlas, v up, into `out` [channels]. Centres of texels lie at + 0.5;
/// beyond the outermost the value is theirs.
template <class T>
void sample(const ink::AtlasMap<T>& map, const Vec2& uv, float* out) {
    const auto size = static_cast<double>(map.size);
    const double x = std::min(std::max(uv.x * size - 0.5, 0.0), size - 1);
    const double y = std::min(std::max(uv.y * size - 0.5, 0.0), size - 1);
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
    const std::size_t right = i + 1 < map.size ? 1 : 0, up = j + 1 < map.size ? map.size : 0;
    const auto s = static_cast<float>(x - std::floor(x)), t = static_cast<float>(y - std::floor(y));
    const auto n = static_cast<std::size_t>(map.channels);
    const T* p = map.texels.data() + (j * map.size + i) * n;
    for (std::size_t c = 0; c < n; ++c)
        out[c] = (1 - t) * ((1 - s) * static_cast<float>(p[c]) + s * static_cast<float>(p[right * n + c])) +
                 t * ((1 - s) * static_cast<float>(p[up * n + c]) + s * static_cast<float>(p[(up + right) * n + c]));
}

/// Gives texels with less than half coverage, as far as `rings` texels from others, the mean colour of those: at the
/// edge of paint a bilinear read then mixes in no substrate. Both maps are of one size.
void spread_colours(ink::AtlasMap<std::uint8_t>& colour, const ink::AtlasMap<float>& coverage, int rings);

/// Returns the UV of a point of a triangle.
inline Vec2 uv_of(std::span<const Vec2f> corner_uvs, std::uint32_t triangle, const Weights& w) {
    Vec2 uv(0);
    for (std::size_t k = 0; k < 3; ++k) uv += w[k] * Vec2(corner_uvs[3 * std::size_t{triangle} + k]);
    return uv;
}

/// Maps of a decoration, gutters filled. They must outlive it.
struct PrintSource {
    std::span<const Vec2f> corner_uvs;                    ///< [3 n_triangles of the model]
    CoverageFn coverage;                                  ///< of the paint, 0–1
    const ink::AtlasMap<std::uint8_t>* colour = nullptr;  ///< sRGB; null: no picture is made
    const ink::AtlasMap<float>* amounts = nullptr;        ///< film units, a channel for each plate; null: no plates
    std::vector<float> full;                              ///< [n_plates] amount of a tint of 100 %
    std::vector<CoverageFn> plates;                       ///< [n_plates] coverage of each, for outlines; or empty
    double texel = 1e-4;                                  ///< metres
};

/// How a panel's plane lies on a page: p ↦ (c p.x − s p.y, s p.x + c p.y) + offset, metres from the page's lower left.
struct PagePlacement {
    double c = 1, s = 0;
    Vec2 offset{0};

    Vec2 operator()(const Vec2& p) const { return Vec2(c * p.x - s * p.y, s * p.x + c * p.y) + offset; }
    Vec2 inverse(const Vec2& p) const {
        const Vec2 d = p - offset;
        return {c * d.x + s * d.y, -s * d.x + c * d.y};
    }
};

/// Returns a region of the panel's plane as it lies on the page.
Region placed(const Region& region, const PagePlacement& placement);

/// A picture on a page, row 0 at the top.
struct PrintImage {
    int width = 0, height = 0;
    Vec2 origin{0};                                 ///< lower left corner on the page, metres
    double pixel = 0;                               ///< side of a pixel, metres
    std::vector<std::uint8_t> rgb;                  ///< [3 width height] sRGB
    std::vector<std::uint8_t> alpha;                ///< [width height] 255: printed
    std::vector<std::vector<std::uint8_t>> plates;  ///< [n_plates][width height] tint, 255: 100 %
};

/// Draws a piece at `pixel` metres a pixel: what lies inside `film` (in the panel's plane), and of the paint within
/// `bleed` metres of it what hangs together with that. A pixel is the mean of samples a texel apart, at most 4 × 4.
/// Alpha is the coverage of paint; colours are not premultiplied. Throws `Error` for more than 2²⁸ pixels.
PrintImage print_piece(const PrintSurface& surface, const PrintSource& source, const PagePlacement& placement,
                       const Region& film, double bleed, double pixel);

/// Paint at points of a piece, film units and coded colours as they are in the maps.
struct PaintSamples {
    double area = 0;                           ///< m² of film for each
    std::vector<float> cover;                  ///< [n] above 0, at most 1
    std::vector<std::array<float, 3>> colour;  ///< [n] 0–1
    std::vector<float> amounts;                ///< [n n_plates]
};

/// Samples the paint within `film` (in the panel's plane) a texel apart, wider where that were more than four million
/// points. Points without paint are left out.
PaintSamples sample_paint(const PrintSurface& surface, const PrintSource& source, const Region& film);

/// Draws the strain of a piece in colours of `strain_colour`.
PrintImage print_strain(const PrintSurface& surface, const PagePlacement& placement, const Region& printed,
                        double pixel, double limit);

/// Returns the colour of a strain: from white at 0 over yellow and orange to red at `limit`, violet above.
std::array<std::uint8_t, 3> strain_colour(double strain, double limit);

}  // namespace tuft::decal
