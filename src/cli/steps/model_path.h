#pragma once

#include <filesystem>
#include <string>

#include "cli/arguments/arguments.h"
#include "cli/steps/console.h"
#include "cli/steps/place.h"
#include "writer/layout/text_layout.h"

/// \file
/// Paths on a model, and drawings repeated along them: `tuft write --direction`, `tuft paint --along`. Main thread.
namespace tuft::cli {

/// A path, and the length on it at which the middle of a text stands, metres.
struct PathOnModel {
    writer::ModelPath path;
    double middle = 0;
};

/// Returns the level section of the model at `--place`, else in front of it at 0.62 of its height (a rim).
PathOnModel rim_path(const stroke::Model& model, const Paint& arguments);

/// Returns the border, edge or crease nearest to `--place`, at most 50 mm and a tenth of the model's diagonal away
/// (`writer::feature_line`), and notes which.
PathOnModel edge_path(const stroke::Model& model, const Paint& arguments, Console& console);

/// Returns the first flat line of a stroke file, placed as the arguments say. A line whose ends meet is closed. Throws
/// `Error` where it has none.
PathOnModel curve_path(const stroke::Model& model, const Paint& arguments, const std::filesystem::path& file,
                       Console& console);

/// Number of copies of `--repeat`: 0 for "fit". Throws `UsageError` for any other text.
int repeats_of(const std::string& text);

/// Repeats flat strokes along the path of `--along` (`writer::band_of`, `writer::repeat_along`): those without a place
/// of their own, or all of them when the arguments give a point. Else the strokes are as `place_strokes` leaves them.
PlacedDrawing place_along(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                          const Paint& arguments, Console& console);

}  // namespace tuft::cli
