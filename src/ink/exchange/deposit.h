#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ink/canvas/canvas.h"
#include "ink/exchange/stamped_tile.h"

/// \file
/// Deposit of ink from the tuft onto texels. Called by `stroke` for every tile of every stamp.
namespace tuft::ink {

/// Fractions of the wet ink by plane of a canvas; their sum is at most 1.
using Mix = std::array<float, kMaxPigments>;

/// The planes of an ink's pigments in a canvas (added when new) and their fractions.
Mix mix_of(Canvas& canvas, const Ink& ink);

/// Ink of one stamp; `stamp_deposit` fills it.
struct DepositParams {
    Mix mix{};                         ///< mixture that leaves the tuft
    float target = 1.8f;               ///< c: film units of this ink under full coverage
    float transfer_length = 0.08e-3f;  ///< s0, metres of travel
    float capacity = 8;                ///< film units that stay on a texel, all inks together
    float extinction = 0;              ///< ε: extinction of the ink's film, per film unit; 0: ignored
};

/// ε of an ink: 2K + S of its mixture, weighted over the bands by luminance.
float extinction_of(const Ink& ink);

/// Coefficients of `deposit`, computed once for all tiles of a stamp.
struct DepositLaw {
    float rate = 0;                            ///< 1 − exp(−ds/s0)
    float hidden = 0, inverse_extinction = 0;  ///< 1 − exp(−ε c) and 1/ε; 0: g(f) = c f
};
/// `ds`: metres of travel of the stamp; at 0 nothing is deposited.
DepositLaw deposit_law(const DepositParams& params, double ds);

/// Computes g(f) of `deposit` for a tile: the film that texels of coverage f converge to.
void film_goals(std::span<float, atlas::kTileTexels> goal, std::span<const float, atlas::kTileTexels> coverage,
                const DepositParams& params);

/// Deposits one stamp on one tile:
///
///     dw = max(0, min(g(f), w + C − W) − w) (1 − exp(−ds/s0))
///     g(f) = −ln(1 − f (1 − exp(−ε c))) / ε,   g(f) = c f for ε = 0
///
/// with f the texel's coverage, c the target, w the film of this ink already there (the smallest w_p / mix_p over
/// its pigments), W all film and C the capacity. The film converges to g(f) ≤ g(1) = c for any number and size of
/// steps: stamps do not bead, and no number of passes exceeds the capacity. The film thins towards the edge of the
/// contact so that a half-covered texel looks half covered: this preserves the antialiasing of f although a film
/// hides exponentially. Another ink is added to what is there; nothing is removed.
///
/// `law`: `deposit_law` of the same `params`, which holds the travel ds of the stamp. `tone` [256]: factor on g(f) of
/// each texel, about 1 (film_tone.h); empty: 1.
///
/// Returns the ink given, film·m²: the sum of the stored amounts times the texels' areas, so tuft and texels balance.
/// Different threads may process different slots. The bits do not depend on the instruction set. Cost: about 0.2 µs.
double deposit(Canvas& canvas, const CoveredTile& tile, const DepositParams& params, const DepositLaw& law,
               std::span<const float> tone = {});

}  // namespace tuft::ink
