#pragma once

#include <span>
#include <vector>

#include "stroke/gesture/symmetry.h"
#include "stroke/journal/entry/entry.h"

/// \file
/// Symmetric copies of strokes and areas: the other flank, copies round an axis. Called by `tuft paint` and by the
/// studio.
namespace tuft::stroke {

/// How a flat drawing is read in a copy beyond a mirror plane.
enum class CopyReading {
    mirrored,       ///< as in a mirror
    upright_parts,  ///< as in a mirror, but parts with a name in `FlatArea::upright` as the original, at their places
    upright,        ///< as the original, about the origin of its placement
};

/// Returns an entry mapped by a symmetry. A flat trace or area with placement (o, r, d) goes to (M o, ∓M r, M d). Below
/// a reflection its x is flipped: it meets the mirror image of every point, and its placement stays right-handed. Poses
/// in space are mapped by `PoseMap::pose`. Other entries do not change.
JournalEntry copy_of(const JournalEntry& entry, const PoseMap& map, CopyReading reading);

/// Returns the copies of these entries by every element of a symmetry, one after the other, each in a group of its own
/// named `name`, with ids from `first_group` on. Layers, masks and fills of the whole model are not copied.
std::vector<JournalEntry> symmetric_copies(std::span<const JournalEntry> entries, const Symmetry& symmetry,
                                           CopyReading reading, const EntryGroup& first_group);

}  // namespace tuft::stroke
