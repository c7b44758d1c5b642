#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/svg/style/svg_shapes.h"
#include "io/svg/style/svg_style.h"

/// \file
/// Patterns of SVG drawings: their elements and the grid of their tiles (SVG 1.1, 13.3). Called by svg_scene.cpp only.
/// Any thread.
namespace tuft::io {

/// Elements of a pattern: the one that a paint names, then those that it refers to. Attributes and content that one
/// lacks are those of the next.
std::vector<pugi::xml_node> svg_pattern_chain(const std::string& id, const SvgIds& ids);
/// Returns the first attribute of that name in a chain; empty: none has it.
std::string svg_chain_text(const std::vector<pugi::xml_node>& chain, const char* name);

/// Where the tiles of a pattern lie on a shape, user units.
struct SvgPatternGrid {
    Vec2 corner{0}, tile{0};  ///< of the first tile
    SvgMatrix matrix{1};      ///< patternTransform
    Vec2 from{0}, to{0};      ///< whole numbers: tiles that reach the shape
};

/// Returns the grid over a shape with these bounds on a page of this size; nothing where no tile has an area. Throws
/// `Error` for more than 20,000 tiles.
std::optional<SvgPatternGrid> svg_pattern_grid(const std::vector<pugi::xml_node>& chain,
                                               const std::pair<Vec2, Vec2>& bounds, const Vec2& page,
                                               const std::string& source);

}  // namespace tuft::io
