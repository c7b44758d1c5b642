#pragma once

#include <string>

#include "io/image/image.h"
#include "writer/gesture/cells.h"

/// \file
/// The ink of a picture of one character: a photograph, a scan or a rubbing. Called by `tuft write --like`.
namespace tuft::writer {

/// The ink of a picture, and where the character's square lies on it.
struct PictureInk {
    Cells cells;
    Vec2 middle{0};           ///< pixels of the picture, from its upper left corner, of the middle of the square
    double units = 1;         ///< of a pixel of the picture
    double other_colour = 0;  ///< part of the marked pixels that were left out: of another colour than most of them

    /// Returns the pixel at a point of the square.
    Vec2 pixel_at(const Vec2& p) const { return middle + Vec2(p.x - 0.5 * kSide, 0.5 * kSide - p.y) / units; }
};

/// Returns the ink of a picture as cells of 2 units, the box round it in the middle of the character's square.
///
/// Light is the ratio of a pixel to the paper about it, so shading falls out. The paper is the 90th percentile of a
/// block, the largest within three blocks; then the mean of what is no ink, filled from the neighbours where a block
/// has none. The threshold is that of [Otsu1979]. Writing counts as lighter than
/// its paper, as on a rubbing, where deviations from the middle light about a place are skewed to the light. Parts that
/// run along more than a tenth of the border are no ink. Specks below a third and holes below a sixth of the square of
/// the stroke's width are removed, and steps of one cell by majority. Ink of another colour than most of it, such as a
/// seal, is left out: densities −ln(light / paper) of red, green and blue add where inks lie over each other, and the
/// part that is parallel to the ink's is kept. Transparent pixels are white. Throws `Error` with
/// `source` where the picture is smaller than 16 pixels or shows no ink. Cost: linear in the pixels.
/// `threshold` moves the threshold from Otsu's by that part of the distance to the mean of the ink (< 0) or of the
/// paper (> 0), −`kMostThreshold` to `kMostThreshold`: more makes lines thicker.
PictureInk picture_ink(const io::Image8& picture, const std::string& source, double threshold = 0);
inline constexpr double kMostThreshold = 0.9;

/// The cells of `picture_ink`.
Cells ink_of(const io::Image8& picture, const std::string& source, double threshold = 0);

inline constexpr double kCopiedPart = 0.84;  ///< of the square's side: the longer side of the box round the ink

}  // namespace tuft::writer
