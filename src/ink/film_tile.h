#pragma once

#include <array>
#include <cstdint>

#include "atlas/seam_links.h"
#include "ink/film.h"

/// One tile of the wet film with a border of one texel, as its kernels see it; inside `ink`
/// only. Field k = (row + 1) * 18 + column + 1; faces: between k and k + 1, k and k + 18, and the
/// diagonals of the square k, k + 1, k + 18, k + 19.
namespace tuft::ink::wet {

inline constexpr int kTexels = atlas::kTileTexels;
inline constexpr int kSide = atlas::kTile;
inline constexpr int kRow = kSide + 2;
inline constexpr int kField = kRow * kRow;      // 324
inline constexpr int kPadded = kField + kRow + 14;  // so that k + kRow + 1 may be read

using Field = std::array<float, kPadded>;

inline constexpr int field_of(int texel) { return (texel / kSide + 1) * kRow + texel % kSide + 1; }

/// What the metric says of a tile: made once, never changed.
struct alignas(64) Geometry {
    Field gx{}, gy{};       ///< length over distance of a face, at most 4 times the smaller area
    Field gd{};             ///< of a diagonal: > 0 from k to k + 19, < 0 (its size) from k + 1 to k + 18
    Field inverse_area{};   ///< mean texel's area over the texel's; 0 outside the charts
    Field grain{};          ///< pin of the place, over the mean
    std::array<float, kTexels> inverse{};  ///< inverse_area without the border
    float stiffness = 0;    ///< greatest Σ conductances over area
    float smallest = 1;     ///< area, over the mean
    bool diagonals = false;
};
Geometry make_geometry(const atlas::TexelMap& map, std::uint32_t slot);

/// Downhill of each face for one direction of weight: conductance × (height of the one end
/// less that of the other) over a texel's length.
struct alignas(64) Slopes {
    Field x{}, y{};
    float steepest = 0;     ///< greatest size of them
};
Slopes make_slopes(const atlas::TexelMap& map, std::uint32_t slot, const Geometry& geometry,
                   const Vec3& down);

/// FilmParams for one step, in texels: rates times the step's length.
struct Step {
    float flow = 0;        ///< D dt / A per film unit
    float levelling = 0;   ///< L dt / A per film unit above hold
    float limit = 0;       ///< of flow × thickness, so that nothing gets negative
    float threshold = 0, pin = 0;
    float mixing = 0;      ///< D_p dt / A
    float soak = 0;        ///< part drawn in by empty pores: 1 − exp(−a dt)
    float pores = 0;
    float evaporation = 0; ///< film units
    float rim = 0;         ///< film units more, per dry neighbour
    float hold = 0;
    float weight = 0;      ///< `FilmParams::weight` dt over a texel's length
    float run = 0;         ///< part of a texel's liquid that weight may take through a face, at most
};

/// The fields of a tile in work.
struct alignas(64) Work {
    Field w{}, s{}, total{};       ///< liquid
    Field fw_x, fw_y, fs_x, fs_y;  ///< fluxes of w and s through faces, film units · mean area
    Field ax, bx, ay, by;          ///< carriers of pigment: flux = a c(k) + b c(k + 1 or 18)
    Field fw_d, fs_d, ad, bd;
    Field c{};                     ///< concentration of one pigment
    std::array<float, kTexels> dw, ds, dp, dry_neighbours;
};

/// total = w + s, and what goes through the faces. `slopes` may be null.
void fluxes(Work& work, const Geometry& g, const Slopes* slopes, const Step& step);
/// dw, ds and dry_neighbours of the texels from the fluxes.
void liquid_changes(Work& work, const Geometry& g);
/// c = p / total where there is liquid; p given as a field.
void concentrations(Work& work, const Field& p);
/// dp of the texels from c.
void pigment_changes(Work& work, const Geometry& g);

/// What a texel's liquid became.
struct Outcome {
    float most_w = 0, most_s = 0;
    bool closing = false;          ///< some texel had liquid and has none
    double evaporated = 0;         ///< film · mean area
    std::uint8_t sides = 0;        ///< wet texels in the first, last row, first, last column: bits 0–3
};
/// Numbers from −½ to ½ for the 256 texels, another sequence for each seed. Sums are rounded
/// after adding so many units of their last place: small changes are kept on average, where
/// rounding to the nearest would favour, at each power of two, the side below it.
const float* dither(std::uint64_t seed);

/// w and s [256] become those of `work` with dw, ds, then soaking and evaporation; `closing` [256] is
/// 1 where a texel that was wet is wet no more.
Outcome local_step(float* w, float* s, const Work& work, const Geometry& g, const Step& step,
                   std::uint64_t seed, std::uint8_t* closing);
/// p [256] = before + dp, never below 0.
void add_pigment(float* p, const Work& work, const Field& before, std::uint64_t seed);

/// The same expressions for two texels that face each other over a seam.
struct SeamFlux {
    float w = 0, s = 0;  ///< from the first to the second
    float a = 0, b = 0;  ///< pigment: a c1 + b c2
};
SeamFlux seam_flux(float weight, float slope, const std::array<float, 2>& w,
                   const std::array<float, 2>& s, const std::array<float, 2>& grain,
                   const Step& step);

}  // namespace tuft::ink::wet
