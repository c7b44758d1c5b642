#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cli/steps/place.h"
#include "stroke/document/document.h"
#include "stroke/journal/entry/entry.h"

/// \file
/// Painting of strokes on a model, for `tuft paint` and `tuft write`. Main thread.
namespace tuft::cli {

/// Where the strokes of a painting command come from.
struct StrokeSource {
    /// Returns the strokes before the model is read, so that a fault of theirs is reported first.
    std::function<std::vector<stroke::JournalEntry>(Console&)> load;
    /// Puts the strokes onto the model, or adds those that depend on it.
    std::function<std::optional<PlacedDrawing>(std::vector<stroke::JournalEntry>&, const stroke::Model&, Console&)>
        place;
};

/// Prepares strokes for the document: layers, masks, groups, presets and films.
void prepare_strokes(std::vector<stroke::JournalEntry>& strokes, stroke::Document& painting, const Paint& arguments,
                     Console& console);

/// Returns the strokes with each flat one of a hand replaced by those in space that the studio's pointer makes of it.
/// `surface`: of the parts that are not hidden; `pixel`: metres at the model. Drawings with a stencil and strokes on
/// the palette stay. Strokes that never aim at the front of the surface are left out, and named.
std::vector<stroke::JournalEntry> draw_with_pointer(const std::vector<stroke::JournalEntry>& strokes,
                                                    stroke::Document& painting, const mesh::SurfaceQuery& surface,
                                                    double pixel, Console& console);

/// Throws `Error` for strokes that cannot be of this model's size.
void check_sizes(const std::vector<stroke::JournalEntry>& strokes, stroke::Document& painting,
                 const stroke::Model& model, const Paint& arguments);

/// Paints strokes as `tuft paint` does and writes all outputs. Returns the exit status.
int paint(const Paint& arguments, const StrokeSource& source);

}  // namespace tuft::cli
