#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments/arguments.h"
#include "cli/steps/console.h"
#include "stroke/drawing/drawing.h"
#include "stroke/journal/journal.h"
#include "stroke/surface/model.h"

/// \file
/// Placement of flat drawings on the model, for `tuft paint`. Main thread.
namespace tuft::cli {

/// Depth in metres below the surface of a closed model from which a ferrule is reported as inside. Facets of a fine
/// mesh deviate from their curve by less.
inline constexpr double kInsideNoted = 1e-4;
/// Returns the same depth for a placement, metres: a point read off the model to the millimetre is within 0.87 mm of
/// it.
inline double place_inside_noted(const Box& model) {
    return std::min(1e-3, 0.01 * model.diagonal());
}

/// Where `place_strokes` put a drawing.
struct PlacedDrawing {
    Vec3 at{0}, normal{0, 0, 1};  ///< metres; unit, of the surface at the drawing's centre
    Vec2 size{0};                 ///< metres, of the ink, along the drawing's axes
    std::string side;             ///< stroke::side_name; empty: a point was given
    Vec2 free{0};                 ///< metres, in projection, of the side's largest free area; 0: none found
    double part = 0;              ///< fraction of that area's length that the drawing takes, the larger of both
    int repeats = 0;              ///< copies along a path; 0: it is not repeated
    double step = 0, path = 0;    ///< metres between their middles, and of the path
};

/// Places flat strokes on the model as one drawing: those without a placement, or all of them when the arguments give a
/// point or a side.
///
/// Its centre is at the surface point nearest to the given point, else in the middle of the largest free area of a side
/// (stroke::find_free_area). The drawing is upright unless the arguments give the reader's direction. Without a given
/// width, a drawing on a free area that takes more than 0.9 or less than 0.15 of it is scaled to 0.6, with a note.
/// Scaling retains the hand's speed and scales the brushes that the files name. Strokes without a placement are draped;
/// `--mapping` overrides the mapping of all flat strokes.
///
/// Returns nothing when no stroke is flat. Throws `Error` when the given side has no free area.
std::optional<PlacedDrawing> place_strokes(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                                           const Paint& arguments, Console& console);

/// Sets the mapping of flat strokes and areas: that of `--mapping`, else `drape` for those without a placement.
void set_mappings(std::vector<stroke::JournalEntry>& strokes, const Paint& arguments);

/// Last step of every placement: chooses brushes, fills wide lines, dips for long ones and sets the pressures of
/// widths. `drawing`: traces of `strokes`; the pointers are invalid afterwards.
void finish_strokes(std::vector<stroke::JournalEntry>& strokes, const stroke::PlacedTraces& drawing,
                    const Paint& arguments, Console& console);

/// Sets the view's direction to the side that the strokes are on; unchanged when they are on several.
void look_at_strokes(View& view, const std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model);

}  // namespace tuft::cli
