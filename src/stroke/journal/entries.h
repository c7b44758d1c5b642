#pragma once

#include <string>
#include <vector>

#include "stroke/journal/journal.h"

/// \file
/// Traces of stroke files as journal entries; used wherever a file is painted.
namespace tuft::stroke {

struct EntryOptions {
    Settings settings = {};                 ///< of traces that bring none
    std::string brush, ink;                 ///< presets for all traces; empty: as the traces name
    std::string other_ink = "carbon";       ///< of traces that name none
    std::string pressure = "none";          ///< as `Settings::pressure`, of flat traces with made-up pressures
    std::vector<BrushAction> prepare = {};  ///< done with each brush before its first stroke; with
                                            ///< `settings.dip` "each" before every stroke
    bool erases = false;                    ///< all strokes take ink away
};

/// Appends each trace as a stroke, after entries for what its file wants done with the brush before
/// it. A trace without samples gives these entries alone. Brushes that no one names stay empty.
void append_entries(std::vector<Stroke>& entries, std::vector<Trace> traces, const EntryOptions& options);

}  // namespace tuft::stroke
