#pragma once

#include <span>
#include <vector>

#include "stroke/journal/recorded_stroke.h"

/// \file
/// A journal as recorded strokes, to be written to a stroke file. Called by `tuft export` and by the studio.
namespace tuft::stroke {

/// A journal as strokes of a file.
struct RecordedJournal {
    std::vector<RecordedStroke> strokes;  ///< with settings, and the names of layers and masks
    std::size_t left_out = 0;             ///< entries that a stroke file cannot hold: edits of layers and masks
};

/// Returns the entries in order, without hidden ones. Other entries than strokes become the `before` of a stroke
/// without samples. Painted on the same model and atlas, the strokes give the same texels, provided that each layer is
/// added on top when it is first painted on, and that the masks exist.
RecordedJournal record(std::span<const JournalEntry> entries);

}  // namespace tuft::stroke
