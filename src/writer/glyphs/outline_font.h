#pragma once

#include <filesystem>
#include <memory>

#include "writer/glyphs/glyph_source.h"

/// \file
/// Characters of outline fonts (io/font). Called by glyph_source.cpp.
namespace tuft::writer {

/// Opens a font, of a collection its first face. Throws `Error` for a damaged one.
std::unique_ptr<GlyphSource> open_outline_font(const std::filesystem::path& path);

}  // namespace tuft::writer
