#pragma once

#include <span>
#include <vector>

#include "brush/tuft/bundles.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/footprint.h"

/// Single hairs on the surface. A tuft full of ink touches in one closed shape; one that runs
/// dry in the lines of its bristles: flying white.
namespace tuft::footprint {

/// Which cells of which bundles touch, [bundles * cells] with cell c of bundle k at
/// k * cells + c, root first: parts that sum to one, in proportion to the length of hair of a
/// cell that lies on the surface. A bundle lies on it where it is in the lower half of its
/// section and the section's underside at its place is at or below the surface. Where no bundle
/// does, the foremost cells share. `ends` is that of brush::hair_cells.
std::vector<float> contact_cells(std::span<const Trail> trails, const brush::Bundles& bundles, int branches,
                                 std::span<const double> ends);

/// A cluster of a bundle that lies on the surface.
struct HairContactPoint {
    std::uint32_t bundle = 0;
    Vec2 at{0};         ///< metres, in the stamp's (u, v)
    double along = 0;   ///< part of the tuft's length from the root
    double length = 0;  ///< of hair, part of the tuft's
};

/// The clusters that `contact_cells` counts, one by one. About 10 µs.
std::vector<HairContactPoint> hair_contact_points(std::span<const Trail> trails, const brush::Bundles& bundles,
                                                  int branches);

/// How wet the hair is where it touches.
struct HairInk {
    std::span<const double> wet;  ///< [bundles] film a bundle brings over the film that closes the
                                  ///< gaps between its hairs; 1 and more: closed
    double travel = 0;            ///< metres of the stroke so far: bristles roll as they are drawn
    Vec2 way{0};                  ///< unit, where the tuft is drawn, in the stamp's (u, v); zero: it stands
    std::span<const Trail> before =
        {};             ///< of the stamp before, in this one's frame: each hair's own way; none: all go `way`
    double lands = 0;   ///< 0–1: how much of the hand's motion is pressing or lifting
    Vec2 course{0};     ///< where the hand goes, but for what it goes by pressing and lifting, any length, in (u, v);
                        ///< zero: nowhere
    double swings = 0;  ///< 0–1: sine of the angle between the way of the tuft over its last millimetre and `course`
};

/// Film that a bundle brings over the film that closes its gaps,
///
///     wet = s h / (s_c (1 + v / v_c)),
///
/// s its saturation, h what it holds over the mean, v the speed (m/s): ink has no time to fill
/// the gaps of fast hair. s_c = 0.4, v_c = 0.7 m/s: a full tuft closes up to 0.6 m/s.
double wetness_of_bundle(double saturation, double holds, double speed);

struct HairMarks {
    Footprint footprint;
    double closed_area = 0;  ///< m², of the outlines
};

/// Picture of the bristles' marks inside the outlines of the trails. Each bristle of the lower half that gives
/// ink leaves a streak along the hair, 90 µm wide, as thick as hair with the ink that clings to it; between
/// bristles side by side it closes gaps of wet / (1 − wet) mean spacings. A bristle gives ink or none: the thread under
/// it breaks where its bundle's wetness falls below what it needs, which differs from one to the next, the less ready
/// ones first, and along the way, over 12 mm for all of a bundle and over 4 mm for it alone. Dry hair touches with a
/// part of what lies down of it,
///
///     0.1 + 1.25 wet²,   and no more than measures max(1, wet / (2 (1 − wet)²)) streaks across its motion (`Across`):
///
/// drawn sideways it has ink for no wider a way. From wetness 0.7 on ink stands out beyond the outermost hair, from 0.9
/// on as far as it bridges.
///
/// Hair that a press spreads, that closes again in a lifted tuft, or swings round with one that leans, is swept off the
/// hand's course. Dry hair draws no line by that: while the hand presses or lifts a thread needs
///
///     lands S((max(sin ψ, min(sin φ, sin χ), sin φ − 0.25) − 0.08) / 0.27)
///
/// of what its need lacks to 1 more wetness, ψ the angle between the hair's way and the tuft's, φ that of the hair's
/// way or of the tuft's over its last millimetre, the larger one, to the course, χ that of the hair's way to itself, S
/// the smooth step. Hair that trails behind the hand round a curve goes off the course, but along itself, and draws
/// together where the stroke runs out: both go on to its end. While the hand presses or lifts hair touches with no more
/// than measures
///
///     max(1, (1 − 0.75 lands) wet / (2 (1 − wet)²))
///
/// streaks across its motion and, by `lands`, across the course: hair set down across it prints no bars. Strokes begin
/// and end ragged, along themselves.
///
/// All this is of the hair and of the way, in metres, and the same for any sampling and texel. Areas are exact at the
/// edges. As the wetness of every bundle goes to 1 it closes into the picture of `rasterise`. All 500 bristles: about
/// 0.2 ms.
HairMarks hair_marks(std::span<const Trail> trails, std::span<const Outline> outlines, const brush::Bundles& bundles,
                     int branches, const HairInk& ink, const Frame& frame, std::uint32_t triangle, double cell);

}  // namespace tuft::footprint
