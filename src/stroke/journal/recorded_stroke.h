#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "stroke/journal/entry.h"

/// \file
/// Strokes as a stroke file has them.
namespace tuft::stroke {

/// Something done before a stroke.
using Preparation = std::variant<BrushAction, Dry, WashPalette, Fill>;

EntryKind kind_of(const Preparation& preparation);

/// A preparation in words, "ACTION[:INK][,depth=PART][,amount=PART][,side=PART]": "dip:cinnabar,depth=0.2",
/// "wipe,amount=0.6"; and back, throwing `Error` for anything else.
std::string preparation_text(const Preparation& preparation);
Preparation preparation_of(const std::string& text);

/// One stroke with all that its file says of it; without samples only what is done before it.
struct RecordedStroke : StrokeSamples {
    std::string brush, ink;   ///< presets; empty: as the command line says
    bool on_palette = false;  ///< belongs on the palette, in its frame (palette.h)
    bool erases = false;      ///< see `Tool::eraser`
    PlaceNames names;         ///< layer and mask; empty: as the command line says
    std::uint64_t seed = 0;
    std::string label;
    std::vector<Preparation> before;         ///< what is done first, with its brush
    std::optional<StrokeSettings> settings;  ///< none: as the command line says
};

}  // namespace tuft::stroke
