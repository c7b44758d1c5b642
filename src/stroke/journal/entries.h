#pragma once

#include <string>
#include <vector>

#include "stroke/journal/recorded_stroke.h"

/// \file
/// Strokes of stroke files as journal entries. Called by `tuft paint` and by the studio.
namespace tuft::stroke {

/// How strokes of a file become entries.
struct EntryOptions {
    StrokeSettings settings = {};                ///< of strokes without settings
    std::string brush, ink;                      ///< presets for all strokes; empty: those that the strokes name
    std::string other_ink = "carbon";            ///< of strokes that name no ink
    PressureFrom pressure = PressureFrom::none;  ///< of flat strokes whose pressures were made up
    std::vector<Preparation> prepare = {};       ///< before the first stroke of each brush; with `DipMode::each` before
                                                 ///< every stroke
    bool erases = false;                         ///< all strokes are an eraser's
};

/// Appends an entry per recorded stroke, each after entries for its `before`. A stroke without samples gives those
/// alone. `group.name` of an entry is its stroke's; ids stay 0. A brush that neither file nor options name stays empty.
void append_entries(std::vector<JournalEntry>& entries, std::vector<RecordedStroke> strokes,
                    const EntryOptions& options);

}  // namespace tuft::stroke
