#pragma once

#include <filesystem>
#include <memory>

#include "writer/glyphs/glyph_source.h"

/// \file
/// Outline fonts through FreeType, shaped by HarfBuzz. Called by glyph_source.cpp.
namespace tuft::writer {

/// Whether a path ends as outline fonts do: .ttf, .otf, .ttc, .otc, .woff, .woff2, .pfb.
bool is_outline_font(const std::filesystem::path& path);

/// Opens a font, of a collection its first face. Throws `Error` for a damaged one.
std::unique_ptr<GlyphSource> open_outline_font(const std::filesystem::path& path);

}  // namespace tuft::writer
