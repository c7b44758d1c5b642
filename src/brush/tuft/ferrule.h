#pragma once

#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"
#include "core/system/recycled.h"

/// \file
/// Ferrule of a tuft: where its spines are set in, how long their hair is, and how they stand to each other at rest.
///
/// The mouth is |x/a|^q + |y/b|^q ≤ 1 with a = width/2, b = radius (half the thickness), x the broad side. It is cut
/// into K strips of equal area; a spine stands at the centroid of each. Lengths over the width, with s = x/a:
///
///     even  L          toe  L − h (1 − √(1 − s²))  (filbert)          slant  L − h (1 − s/s_K)/2  (sword)
///
/// s_K is that of the last spine: a sword's outermost spines end where its hair does.
/// A round mouth, a = b = R, holds a ring: one spine in the middle and K − 1 around it. The middle cell is a disc of
/// radius R/√K, the others are equal sectors of what is left; each is a disc of the same area at rest. Neighbours touch
/// along a face: along that disc's rim, or along the line between two sectors.
///
/// A fan's hair leans by splay · s to the side. A strip of pitch p and mean thickness t is an ellipse at rest,
/// semi-axes p/√π and t/√π: its area is that of the strip. Where a fan's strips widen, they thin, so that the area
/// stays.
///
/// Ferrule frame: origin in the middle of the mouth, x along the broad side, −z along the hair. Metres, radians.
namespace tuft::brush {

/// Place and share of one spine in its ferrule, at rest.
struct FerruleSpine {
    double x = 0;              ///< m, place on the broad side
    double y = 0;              ///< m, place across it
    double lean = 0;           ///< rad, of the hair towards +x
    double share = 1;          ///< of the hair; all shares sum to one
    double length = 1;         ///< of its hair over the tuft's
    double pitch = 0;          ///< m, width of the strip at the mouth; of a disc √π times its radius
    double thick = 0;          ///< m, mean thickness of the strip at the mouth; likewise
    double from = -1, to = 1;  ///< ends of the strip over the half-width a
    double edge_short = 0;     ///< m, by how much the hair of a toe ends earlier at an outermost strip's free edge
};

/// Returns true for a tuft that looks different when it is turned about its axis: a wide ferrule, or a form of its own.
inline bool can_be_turned(const Preset& preset) {
    return preset.spines > 1 || preset.geometry;
}

/// Returns the spines from −x to +x; one that holds all for a round tuft.
std::vector<FerruleSpine> ferrule_spines(const Preset& preset);

/// Returns true for a wide ferrule that a model of the papers bends: one skin over all of it, whatever K is.
inline bool has_one_skin(const Preset& preset) {
    return has_broad_side(preset) && preset.spine != SpineMethod::rod;
}

/// Lengths of the hair of a row: less towards the edges of a toe and towards one end of a blade.
class HairLengths {
  public:
    /// `preset` must outlive it.
    explicit HairLengths(const Preset& preset);
    /// Returns the length at s = x/a, −1 to 1, over the tuft's.
    double at(double s) const;

  private:
    const Preset& preset_;
    double outermost_ = 1;  // s of the last spine of a blade
};

/// Returns the strip that is the whole mouth of a wide ferrule.
FerruleSpine single_spine(const Preset& preset);

/// Returns the corners of a spine's part of the mouth, convex, anticlockwise, about the spine and over the semi-axes of
/// its ellipse at rest; none for a disc. Error of its width in any direction: 0.5 %.
Recycled<Vec2> strip_corners(const Preset& preset, const FerruleSpine& spine);

/// Two spines whose hair touches.
struct FerruleNeighbours {
    int first = 0, second = 1;
    Vec2 direction{1, 0};  ///< unit, from the first to the second, ferrule frame
    double face = 0;       ///< m, width of the face between them at the mouth; 0: the thickness of their strips
};

/// Returns the pairs of neighbours of `ferrule_spines`; first < second but for the last of a ring.
std::vector<FerruleNeighbours> ferrule_neighbours(const Preset& preset);

/// Returns the height of the faces between neighbours over the distance of their spines: a row's 2 b K/w; a ring's
/// mean.
double face_over_pitch(const Preset& preset);

/// Returns the half-thickness of the mouth over b at s = x/a: (1 − |s|^q)^{1/q}.
double mouth_height(const Preset& preset, double s);

/// Returns the outline of a wide ferrule's mouth, anticlockwise from +x, closed by its first point; none for a round
/// tuft. Ferrule frame, metres.
std::vector<Vec2> mouth_outline(const Preset& preset);

/// Returns by how much a strip has widened at `along` metres from the mouth: 1 without splay.
double widening(const Preset& preset, double along);

/// Half-widths of a strip's ellipse at the fraction u of the tuft's length from the root. x: along the broad side; y:
/// across it, with the taper of `rest_radius`; a disc has it in both. Metres.
Vec2 rest_half_widths(const Preset& preset, const FerruleSpine& spine, double u);

}  // namespace tuft::brush
