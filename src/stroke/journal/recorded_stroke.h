#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "stroke/journal/entry/entry.h"

/// \file
/// Strokes of a stroke file (InkML, SVG). `io/strokes` reads and writes them; entries.h makes journal entries of them.
namespace tuft::stroke {

/// An entry that a stroke file has before a stroke.
using Preparation = std::variant<BrushAction, Dry, WashPalette, Fill>;

/// Returns the kind of the entry that a preparation becomes.
EntryKind kind_of(const Preparation& preparation);

/// Returns a preparation as "ACTION[:INK][,depth=PART][,amount=PART][,side=PART][,time=SECONDS]", such as
/// "dip:cinnabar,depth=0.2" or "wipe,amount=0.6", and back. Back throws `Error` for any other text.
std::string preparation_text(const Preparation& preparation);
Preparation preparation_of(const std::string& text);

/// A stroke as its file has it. Without samples it stands for its `before` alone.
struct RecordedStroke : StrokeSamples {
    std::string brush, ink;   ///< names of presets; empty: those of the command line
    bool on_palette = false;  ///< on the palette, in its frame (layers/palette.h)
    bool erases = false;      ///< `Tool::eraser`
    PlaceNames names;         ///< of layer and mask; empty: those of the command line
    std::uint64_t seed = 0;
    std::string label;
    std::string group;                       ///< of a drawing's file: a name; empty: the file's own
    std::vector<Preparation> before;         ///< performed before the stroke, with its brush
    std::optional<StrokeSettings> settings;  ///< none: those of the command line
};

}  // namespace tuft::stroke
