#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ink/canvas/canvas.h"

/// Ink from the tuft onto texels.
namespace tuft::ink {

/// Parts of the wet ink by plane of a canvas; their sum is at most 1.
using Mix = std::array<float, kMaxPigments>;

/// The planes of an ink's pigments in a canvas (added when new) and their fractions.
Mix mix_of(Canvas& canvas, const Ink& ink);

struct DepositParams {
    Mix mix{};                         ///< what leaves the tuft
    float target = 1.8f;               ///< c: film units of this ink under full coverage
    float transfer_length = 0.08e-3f;  ///< s0, metres of travel
    float capacity = 8;                ///< film units that stay on a texel, all inks together
    float extinction = 0;              ///< ε: how fast the ink's film hides, per film unit; 0: not regarded
};

/// ε of an ink: 2K + S of its mixture, weighted over the bands by luminance.
float extinction_of(const Ink& ink);

/// What `deposit` needs of its parameters and the way, worked out once for all tiles of a stamp.
struct DepositLaw {
    float rate = 0;                            ///< 1 − exp(−ds/s0)
    float hidden = 0, inverse_extinction = 0;  ///< 1 − exp(−ε c) and 1/ε; 0: g(f) = c f
};
DepositLaw deposit_law(const DepositParams& params, double ds);

/// g(f) of `deposit` for a tile: the film that texels with coverage f tend to.
void film_goals(std::span<float, atlas::kTileTexels> goal, std::span<const float, atlas::kTileTexels> coverage,
                const DepositParams& params);

/// Lays down one stamp on one tile:
///
///     dw = max(0, min(g(f), w + C − W) − w) (1 − exp(−ds/s0))
///     g(f) = −ln(1 − f (1 − exp(−ε c))) / ε,   g(f) = c f for ε = 0
///
/// with f the texel's coverage, c the target, w the film of this very ink that is there
/// already (the least w_p / mix_p over the ink's pigments), W all film and C the capacity.
/// The film tends to g(f) ≤ g(1) = c however often and in whatever steps the tuft passes:
/// stamps do not bead, and any number of passes gives no more than the capacity. The film
/// thins towards the edge of the contact so that a texel covered by half looks half
/// covered, which is what keeps the antialiasing of f in spite of a film that hides
/// exponentially. Another ink goes on top of what is there; nothing there is removed.
///
/// `coverage` [256], 0–1; `area` [256], m² of surface per texel; `ds` metres of travel
/// the stamp stands for. Returns the ink given, film·m²: the sum of what was really
/// stored times `area`, so tuft and texels balance. Different slots may be done by
/// different threads; the bits do not depend on the instruction set. About 0.2 µs.
double deposit(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> coverage,
               std::span<const float, atlas::kTileTexels> area, double ds, const DepositParams& params);
double deposit(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> coverage,
               std::span<const float, atlas::kTileTexels> area, const DepositParams& params, const DepositLaw& law);

}  // namespace tuft::ink
