#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ink/canvas/canvas.h"

/// Ink off the texels, and ink laid over whole parts of a surface.
namespace tuft::ink {

/// What left a tile, or came onto it: film·m² by pigment plane, and liquid.
struct Amounts {
    std::array<double, kMaxPigments> pigment{};
    double liquid = 0;

    double sum() const;  ///< of the pigments
    Amounts& operator+=(const Amounts& other);
};

/// A tile as the eraser found it: pigment and liquid in all films together, film units, and ε W,
/// how much of what is below they hide.
struct EraseStart {
    Plane film, hides;
};
EraseStart erase_start(const Canvas& canvas, std::uint32_t slot);

struct EraseParams {
    double transfer_length = 0.08e-3;  ///< s0, metres of travel
    double strength = 1;               ///< 0–1, by the pressure
};

/// Takes one stamp's share of ink off a tile. With ρ = W / W₀ what is left of the start W₀,
///
///     dρ = −max(0, ρ − q(f)) (1 − exp(−strength ds / s0))
///     q(f) = −ln(min(1, f + exp(−ε W₀))) / ε W₀
///
/// at once where there is liquid, which hair draws up without rubbing;
/// f the texel's coverage: under full coverage all goes, in whatever steps the eraser passes. A texel that looks
/// covered by c = 1 − exp(−ε W₀) (see `deposit`) looks covered by c − f in the end: edges through ink are smooth,
/// and at the rim of what is erased by its own stroke, where c = f, nothing is left.
/// Pigments of all films, dry, open and soaked, and liquid go in proportion. Film never grows;
/// less than 1e-6 film units, which nobody can see, go at once. Slots may be done by different
/// threads; the bits do not depend on the instruction set. Returns what was taken away.
Amounts erase(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> coverage,
              std::span<const float, atlas::kTileTexels> area, double ds, const EraseStart& start,
              const EraseParams& params);

/// A coat for one tile: on texel t the film `film` [256], film units of wet ink, made of
/// (1 − towards) · first + towards · second, parts of the wet ink by plane.
struct Coat {
    std::array<float, kMaxPigments> first{}, second{};
    alignas(64) std::array<float, atlas::kTileTexels> film, towards;
};

/// Lays a coat into the open film, on top of what is there or into it where it is still open; no
/// more than `capacity` film units lie on a texel then. Returns the pigments laid, film·m².
Amounts lay_coat(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> area, const Coat& coat,
                 float capacity);

}  // namespace tuft::ink
