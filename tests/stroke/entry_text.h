#pragma once

#include <string>

#include "stroke/journal/entry/entry_json.h"

/// Journal entries through their stored form and back.
namespace tuft::stroke {

inline JournalEntry written_and_read(const JournalEntry& entry) {
    StrokeSamples trace = samples_of(entry);
    trace.stencil.clear();  // is in the text
    return entry_of({.id = entry.id,
                     .hidden = entry.hidden,
                     .brush = brush_of(entry),
                     .ink = ink_of(entry),
                     .label = entry.label,
                     .seed = seed_of(entry),
                     .trace = trace},
                    entry_json(entry));
}

}  // namespace tuft::stroke
