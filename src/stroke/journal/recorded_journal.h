#pragma once

#include <span>
#include <vector>

#include "stroke/journal/recorded_stroke.h"

/// \file
/// A journal as recorded strokes, for files that other work can be made from.
namespace tuft::stroke {

struct RecordedJournal {
    std::vector<RecordedStroke> strokes;  ///< with names of layers and masks, and settings
    std::size_t left_out = 0;             ///< entries that a stroke file cannot say: changes of layers and masks
};

/// The entries in their order without the hidden ones. What is no stroke becomes one without samples that has it
/// `before`. Painted on the same model in the same atlas they leave the same texels, as long as each layer is added on
/// top when it is first painted on, and masks have been made.
RecordedJournal record(std::span<const JournalEntry> entries);

}  // namespace tuft::stroke
