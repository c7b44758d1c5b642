#pragma once

#include <string>

#include "io/image/image.h"
#include "writer/gesture/cells.h"

/// \file
/// The ink of a picture of one character: a photograph, a scan or a rubbing. Called by `tuft write --like`.
namespace tuft::writer {

/// Returns the ink of a picture as cells of 2 units, the box round it in the middle of the character's square.
///
/// Light is the ratio of a pixel to the paper about it, so shading falls out. The paper is the 90th percentile of a
/// block, the largest within three blocks; then the mean of what is no ink, filled from the neighbours where a block
/// has none. The threshold is Otsu's (1979). The writing is lighter than its
/// ground, as on a rubbing, where deviations from the middle light about a place are skewed to the light. Parts that
/// run along more than a tenth of the border are no ink. Specks below a third and holes below a sixth of the square of
/// the stroke's width are removed, and steps of one cell by majority. Transparent pixels are white. Throws `Error` with
/// `source` where the picture is smaller than 16 pixels or shows no ink. Cost: linear in the pixels.
Cells ink_of(const io::Image8& picture, const std::string& source);

inline constexpr double kCopiedPart = 0.84;  ///< of the square's side: the longer side of the box round the ink

/// Returns the boundaries of cells as closed lines through corners of cells, the area on the left, smoothed over
/// `passes` neighbours by (¼ ½ ¼).
std::vector<Ring> boundaries(const Cells& cells, int passes);

}  // namespace tuft::writer
