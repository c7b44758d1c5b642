#pragma once

#include <span>

#include "brush/tuft/bundles.h"
#include "core/system/recycled.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/footprint.h"
#include "footprint/outline/rough_edge.h"

/// \file
/// Marks of single hairs on the surface. A full tuft touches in one closed shape; a dry one in the lines of its
/// bristles (flying white). Called by `stroke` for every stamp.
namespace tuft::footprint {

/// Returns the contact fractions of all cells, [bundles * cells] with cell c of bundle k at k * cells + c, root
/// first. They sum to one and are proportional to the length of hair of a cell on the surface. A bundle touches
/// where it is in the lower half of its section and the section's underside at its position is at or below the
/// surface. Where no bundle touches, the cells nearest the tip share. `ends` is that of brush::hair_cells.
Recycled<float> contact_cells(std::span<const Trail> trails, const brush::Bundles& bundles, int branches,
                              std::span<const double> ends);

/// A part of a bundle that touches the surface.
struct HairContactPoint {
    std::uint32_t bundle = 0;  ///< of the tuft
    Vec2 at{0};                ///< metres, in the stamp's (u, v)
    double along = 0;          ///< fraction of the tuft's length from the root
    double length = 0;         ///< of hair, fraction of the tuft's length
};

/// Returns the parts that `contact_cells` counts, one by one. Cost: about 10 µs.
Recycled<HairContactPoint> hair_contact_points(std::span<const Trail> trails, const brush::Bundles& bundles,
                                               int branches);

/// Hair that touches the surface.
struct TouchingHair {
    std::span<const Trail> trails;      ///< touching parts of the branches, in the stamp's (u, v)
    std::span<const Outline> outlines;  ///< of the trails; bound the marks
    const brush::Bundles& bundles;      ///< of the tuft
    int branches = 1;                   ///< of the tuft; more than 1: split
    RoughEdge edge = {};                ///< of the outlines
};

/// Wetness and motion of the touching hair.
struct HairInk {
    /// [bundles] film of a bundle over the film that closes the gaps between its hairs; ≥ 1: closed.
    std::span<const double> wet;
    double travel = 0;  ///< metres of the stroke so far: the phase of the bristles' rolling
    Vec2 direction{0};  ///< unit, direction of the tuft's motion in (u, v); zero: at rest
    /// Previous stamp's, in this one's frame: give each hair's direction; empty: `direction`.
    std::span<const Trail> before = {};
    double press_share = 0;  ///< 0–1: fraction of the hand's motion that is pressing or lifting
    /// Direction of the hand's motion without pressing and lifting, any length, in (u, v); zero: at rest.
    Vec2 course{0};
    /// 0–1: sine of the angle between the tuft's motion over its last millimetre and `course`.
    double sine_to_course = 0;
    /// 0–1: part of the picture that is single hairs; the rest is closed, also where ink spans hairs of other lengths.
    double apart = 1;
    std::span<const signed char> sides = {};  ///< of `keep_sides`; empty: where each section is
};

/// Keeps which broad side of each strip faces away from the surface: by branch, the sign of the height of its
/// thickness, 0 for none yet. Hair that stands keeps the side on which it lay: the hair of the other one would leave a
/// bar of its own as a stroke ends.
void keep_sides(std::span<const Trail> trails, Recycled<signed char>& sides);

/// Returns the film of a bundle over the film that closes its gaps,
///
///     wet = s h / (s_c (1 + v / v_c)),
///
/// with saturation s, h the film it leaves relative to the mean, and speed v (m/s): ink has no time to fill the
/// gaps of fast hair. s_c = 0.4, v_c = 0.7 m/s: a full tuft closes up to 0.6 m/s.
double wetness_of_bundle(double saturation, double holds, double speed);

/// Result of `draw_hair_marks`.
struct HairMarks {
    Footprint footprint;     ///< picture of the marks
    double closed_area = 0;  ///< m², of the outlines
};

/// Returns the picture of the bristles' marks inside the outlines of the trails, c (1 − apart (1 − m)), with the
/// coverage c of the outlines, which is that of `rasterise` (rough_edge.h), and m of the marks. Areas are exact at the
/// edges. As the wetness of every bundle goes to 1, m goes to 1 in the outline of each trail. All lengths are in
/// metres along hair and path, so the result does not depend on sampling or texel size. Cost: about 0.2 ms for all 500
/// bristles.
///
/// Streaks. Each inked bristle of the lower half leaves a streak along the hair, 90 µm wide: a hair and the ink
/// that adheres to it. Between adjacent bristles it closes gaps of wet / (1 − wet) mean spacings. From wetness 0.7
/// on, ink extends beyond the outermost hair; from 0.9 on, by its full bridging width.
///
/// Threads. The ink thread under a bristle breaks where its bundle's wetness falls below its need. The need varies
/// between bristles, lower readiness first, and along the path: over 12 mm for a whole bundle and over 4 mm for one
/// bristle. Dry hair touches with the fraction 0.1 + 1.25 wet² of its length on the surface, and with at most
/// max(1, wet / (2 (1 − wet)²)) streaks across its motion (`TransverseLength`): drawn sideways it has ink for no
/// wider path.
///
/// Off course. Hair leaves the hand's course when a press spreads it, when a lifted tuft closes, or when it swings
/// round with a tilting tuft. Dry hair draws no line then. While the hand presses or lifts, a thread needs more
/// wetness by
///
///     press_share S((max(sin ψ, min(sin φ, sin χ), sin φ − 0.25) − 0.08) / 0.27)
///
/// of what its need lacks to 1. ψ is the angle between the directions of hair and tuft. φ is the larger angle to
/// the course of the hair's direction and of the tuft's motion over its last millimetre. χ is the angle between the
/// hair's motion and the hair itself. S is the smooth step. Hair that trails behind the hand round a curve leaves
/// the course along itself, and hair draws together where the stroke ends: both continue to the end. So does the hair
/// of a row, each spine of which goes its own way. While the hand
/// presses or lifts, hair touches with at most
///
///     max(1, (1 − 0.75 press_share) wet / (2 (1 − wet)²))
///
/// streaks across its motion and, weighted by `press_share`, across the course: hair set down across the course
/// prints no bars. Strokes begin and end ragged, along themselves.
HairMarks draw_hair_marks(const TouchingHair& hair, const HairInk& ink, const PicturePlane& plane);

}  // namespace tuft::footprint
