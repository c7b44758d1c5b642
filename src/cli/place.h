#pragma once

#include <vector>

#include "cli/arguments.h"
#include "cli/console.h"
#include "stroke/journal/journal.h"
#include "stroke/painting/model.h"

/// Where drawings and handwriting without a place of their own go.
namespace tuft::cli {

/// Metres below the surface of a closed model from which on a place or a ferrule is noted as inside it: facets of a fine
/// mesh lie within the curve that they stand for by less.
inline constexpr double kInsideNoted = 1e-4;

/// Puts flat strokes that have no place of their own, or all of them when a place is given,
/// onto the model: as one drawing, upright, its middle at the nearest point to the place, else
/// at the model's front (-y side) where there is room for it, as near to the middle as can be. Without a width
/// given, a drawing that has no place and is larger than that room, or tiny beside the model, is scaled to fit, with a note. Scaling keeps the
/// hand's speed; the brushes that the files name grow and shrink with the drawing. What had no place is draped; `--laying` says how all flat strokes lie.
void place_strokes(std::vector<stroke::Stroke>& strokes, const stroke::Model& model,
                   const Paint& arguments, Console& console);

/// Turns the view to the side the strokes are on, when they are on one side.
void look_at_strokes(View& view, const std::vector<stroke::Stroke>& strokes,
                     const stroke::Model& model);

}  // namespace tuft::cli
