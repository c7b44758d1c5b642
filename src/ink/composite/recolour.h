#pragma once

#include "ink/canvas/canvas.h"

/// Another look for what is painted already.
namespace tuft::ink {

/// Makes the film of `painted` look like `wanted` without touching an amount: where the ink
/// left f_p W of its pigments, Σ f_p W K'_p = W Σ f'_q K_q, the same for S and height, with f' and
/// q the new recipe. A pigment that is in both recipes keeps its plane, scaled by f'/f; what is
/// new is shared by the ink's planes in their proportions. Roughness is averaged likewise.
/// Names of planes stay. Pigments of the ink that the canvas does not hold are left out.
///
/// A plane belongs to every ink that has its pigment: those change with it. Every tile
/// becomes dirty.
void recolour(Canvas& canvas, const Ink& painted, const Ink& wanted);

/// Pigments that both inks hold, by name: changing one changes the other.
std::vector<std::string> shared_pigments(const Ink& a, const Ink& b);

}  // namespace tuft::ink
