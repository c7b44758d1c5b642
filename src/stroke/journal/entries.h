#pragma once

#include <string>
#include <vector>

#include "stroke/journal/recorded_stroke.h"

/// \file
/// Strokes of stroke files as journal entries; used wherever a file is painted.
namespace tuft::stroke {

struct EntryOptions {
    StrokeSettings settings = {};                ///< of strokes that bring none
    std::string brush, ink;                      ///< presets for all strokes; empty: as the strokes name
    std::string other_ink = "carbon";            ///< of strokes that name none
    PressureFrom pressure = PressureFrom::none;  ///< of flat strokes with made-up pressures
    std::vector<Preparation> prepare = {};       ///< done with each brush before its first stroke; with
                                                 ///< `settings.dip` "each" before every stroke
    bool erases = false;                         ///< all strokes take ink away
};

/// Appends each recorded stroke, after entries for what its file wants done before it. One without samples gives these
/// entries alone. Brushes that no one names stay empty.
void append_entries(std::vector<JournalEntry>& entries, std::vector<RecordedStroke> strokes,
                    const EntryOptions& options);

}  // namespace tuft::stroke
