#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/console.h"
#include "stroke/journal/journal.h"
#include "stroke/surface/model.h"

/// Where drawings and handwriting without a place of their own go.
namespace tuft::cli {

/// Metres below the surface of a closed model from which on a ferrule is noted as inside it: facets of a fine mesh lie
/// within the curve that they stand for by less.
inline constexpr double kInsideNoted = 1e-4;
/// The same of a place: one that is read off the model to the millimetre lies within 0.87 mm of it.
inline double place_inside_noted(const Box& model) {
    return std::min(1e-3, 0.01 * model.diagonal());
}

/// Where a drawing was put.
struct PlacedDrawing {
    Vec3 at{0}, normal{0, 0, 1};  ///< metres; unit: the surface under its middle
    Vec2 size{0};                 ///< metres, of its ink, as the drawing has its sides
    std::string side;             ///< stroke::side_name; empty: a point was named
    Vec2 free{0};                 ///< metres, as seen, of the largest calm area of that side; 0: none was found
    double part = 0;              ///< of it that the drawing takes, by the longer way
};

/// Puts flat strokes that have no place of their own, or all of them when a place or a side is given, onto the model:
/// as one drawing, its middle at the point nearest to the place, else in the middle of the largest calm area of a side
/// (stroke::find_free_area), upright unless the arguments say who reads it. Without a width given, a drawing without a
/// place that takes more than 0.9 or less than 0.15 of that area is scaled to 0.6 of it, with a note. Scaling keeps the
/// hand's speed; the brushes that the files name grow and shrink with the drawing. What had no place is draped;
/// `--mapping` says how all flat strokes lie. Nothing when no stroke is flat. Throws `Error` when a side that was asked
/// for has no such area.
std::optional<PlacedDrawing> place_strokes(std::vector<stroke::Stroke>& strokes, const stroke::Model& model,
                                           const Paint& arguments, Console& console);

/// Turns the view to the side the strokes are on, when they are on one side.
void look_at_strokes(View& view, const std::vector<stroke::Stroke>& strokes, const stroke::Model& model);

}  // namespace tuft::cli
