#pragma once

#include "footprint/outline/footprint.h"

namespace tuft::footprint {

/// Rounds a contact patch off towards its edge, as thick paint is there: at the distance d inside
/// the edge the coverage is that of a quadrant of an ellipse, √(1 − (1 − d / length)²), from
/// `length` metres on what it was. Distances are taken between blocks of cells a sixth of `length`
/// wide, to a tenth of it; some 2 ns a cell.
void round_edges(Footprint& footprint, double length);

}  // namespace tuft::footprint
