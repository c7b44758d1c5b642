#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ink/canvas/canvas.h"
#include "ink/exchange/stamped_tile.h"

/// \file
/// Removal of ink from texels, and uniform coats over parts of a surface. Called by `stroke` for erasers and fills.
namespace tuft::ink {

/// Amounts removed from a tile or added to it: film·m² by pigment plane, and liquid.
struct Amounts {
    std::array<double, kMaxPigments> pigment{};  ///< by plane
    double liquid = 0;                           ///< on the surface and in its pores

    double sum() const;  ///< of the pigments
    Amounts& operator+=(const Amounts& other);
};

/// State of a tile at the start of an eraser stroke: pigment and liquid in all films together, film units, and
/// their opacity ε W.
struct EraseStart {
    Plane film, hides;
};
EraseStart erase_start(const Canvas& canvas, std::uint32_t slot);

/// Strength of an eraser.
struct EraseParams {
    double transfer_length = 0.08e-3;  ///< s0, metres of travel
    double strength = 1;               ///< 0–1, by the pressure
};

/// Erases one stamp from a tile. With ρ = W / W₀ the remaining fraction of the start W₀,
///
///     dρ = −max(0, ρ − q(f)) (1 − exp(−strength ds / s0))
///     q(f) = −ln(min(1, f + exp(−ε W₀))) / ε W₀
///
/// with f the texel's coverage. Liquid is absorbed by the hair without rubbing: there the change is immediate.
/// Under full coverage all ink is removed, for any step size. A texel of apparent coverage c = 1 − exp(−ε W₀) (see
/// `deposit`) ends with c − f: edges through ink are smooth, and nothing is left at the rim where c = f. Pigments
/// of all films, dry, open and soaked, and liquid are removed in proportion. Film never grows. Less than 1e-6 film
/// units, which is invisible, is removed at once. Different threads may process different slots. The bits do not
/// depend on the instruction set. Returns the removed amounts.
Amounts erase(Canvas& canvas, const StampedTile& tile, const EraseStart& start, const EraseParams& params);

/// Takes `part` [256] (0–1) of all films, dry, open and soaked, and of the liquid off each texel of a tile: a painter
/// cleans the surface within a mask. Less than 1e-6 film units is taken whole. Returns the removed amounts.
Amounts take_part(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> area,
                  std::span<const float, atlas::kTileTexels> part);

/// A coat for one tile: texel t gets `film` [256] film units of wet ink with the mixture (1 − towards) · first +
/// towards · second, fractions of the wet ink by plane.
struct Coat {
    std::array<float, kMaxPigments> first{}, second{};
    alignas(64) std::array<float, atlas::kTileTexels> film, towards;
};

/// Adds a coat to the open film, up to `capacity` film units in all per texel. Returns the added pigments, film·m².
Amounts add_coat(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> area, const Coat& coat,
                 float capacity);

}  // namespace tuft::ink
