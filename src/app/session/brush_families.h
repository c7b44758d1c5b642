#pragma once

#include <string>
#include <vector>

#include "brush/preset/preset.h"

/// \file
/// Brushes in groups, as a shop hangs them. Called by the panels that list them.
namespace tuft::app {

/// Brushes of one make.
struct BrushFamily {
    std::string title;               ///< English, has an entry in the catalogues
    std::vector<std::string> names;  ///< from short to long hair
};

/// Returns the family of a brush: "own" for a file; "goat", "mixed" or "wolf" for pointed brushes named after their
/// hair; by its build "sponge" for foam, "flat" for a broad side, "liner" for hair of at least six thicknesses, else
/// "round".
std::string family_of(const std::string& name, const brush::Preset& preset);

/// Returns the families of these brushes, each once: goat, mixed, wolf, flat, liner, round, sponge, own. Throws `Error`
/// where a brush cannot be read.
std::vector<BrushFamily> brush_families(const std::vector<std::string>& names);

/// Returns true for a brush of a file of the user: a name with a folder, or ending in .toml.
bool is_own_brush(const std::string& name);

}  // namespace tuft::app
