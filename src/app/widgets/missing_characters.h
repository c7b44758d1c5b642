#pragma once

#include <set>

struct ImDrawData;
struct ImFont;

/// \file
/// Characters that were drawn and have no glyph yet. A font with all characters of all scripts takes seconds to
/// rasterise and a hundred megabytes; names of files and layers need some of them. Called by `Ui`.
namespace tuft::app {

/// Gives every character of Unicode's first plane from U+0180 on that a built font lacks a placeholder, but for those
/// of `absent`: no font of the system has them, so they stay "?". A placeholder is `advance` pixels wide and shows
/// nothing. Its texture coordinates are (high byte, low byte) of the character, plus the fraction of a white texel.
void add_placeholders(ImFont& font, const std::set<unsigned>& absent, float advance);

/// Returns the characters whose placeholders were drawn. Cost: 1 ns per vertex.
std::set<unsigned> drawn_placeholders(const ImDrawData& drawn);

}  // namespace tuft::app
