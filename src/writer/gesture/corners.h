#pragma once

#include "writer/gesture/sides.h"

/// \file
/// Sides at the corners of centre lines that are not the typeface's. Called by `SideTable::predict`.
namespace tuft::writer {

/// Limits predicted sides at corners by the edges of both arms. The table knows corners of a typeface's centre lines,
/// which are cut; of a line drawn to the corner itself it predicts a ball outside and spikes inside.
///
/// An arm's edge is a parallel to its axis, the chord from 100 to 40 units off the corner. Within 60 units along the
/// line the outer side ends at most 6 units beyond the outer edge of either arm: its outer side 40 units off, at most
/// 1.2 times that arm's median one. (Of 2,491 corners of hanzi-writer-data 10 % end more than 0 to 24 units beyond, by
/// kind.) At a sharp corner, such as the root of a hook, it is at most 1.6 times as long as the wider of these sides
/// and 6 units. Within 110 units the inner side ends at most 6 units beyond the inner edge of its own arm, the median
/// of that arm's inner sides, and reaches that median less 8 units. A first segment of less than 70 units is a head
/// (heads.h), whose sides stay.
void limit_corners(const StrokeLine& line, StrokeSides& sides);

}  // namespace tuft::writer
