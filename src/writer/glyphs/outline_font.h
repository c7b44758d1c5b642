#pragma once

#include <filesystem>
#include <memory>

#include "writer/glyphs/glyph_source.h"

/// \file
/// Characters of outline fonts (io/font). Called by glyph_source.cpp.
namespace tuft::writer {

/// Opens a font, of a collection the face of a number (`io::Font`). Throws `Error` for a damaged one.
std::unique_ptr<GlyphSource> open_outline_font(const std::filesystem::path& path, int face = 0);

}  // namespace tuft::writer
