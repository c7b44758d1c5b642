#pragma once

#include "ink/canvas/canvas.h"

/// \file
/// Recolouring of painted ink. Called by `stroke`, `tuft` and the studio's ink panel.
namespace tuft::ink {

/// Changes the optical properties of the pigments of `painted` so that its films look like `wanted`; no amount
/// changes. Where the ink left f_p W of its pigments, Σ f_p W K'_p = W Σ f'_q K_q, the same for S and height, with
/// f' and q the new recipe. A pigment of both recipes retains its plane, scaled by f'/f. New pigments are
/// distributed over the ink's planes in their proportions. Roughness is averaged likewise. Names of planes do not
/// change. Pigments that the canvas does not have are ignored.
///
/// A plane is shared by all inks with its pigment: they all change. Every tile becomes dirty.
void recolour(Canvas& canvas, const Ink& painted, const Ink& wanted);

/// Pigments that both inks hold, by name: changing one changes the other.
std::vector<std::string> shared_pigments(const Ink& a, const Ink& b);

}  // namespace tuft::ink
