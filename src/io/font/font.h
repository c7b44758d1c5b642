#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Outline fonts through FreeType, shaped by HarfBuzz. `io/strokes` sets the text of drawings with them, `writer`
/// writes characters of a font.
namespace tuft::io {

/// A glyph of a shaped run. Unit: the em of the font (1); x to the right, y up, origin on the baseline.
struct ShapedGlyph {
    std::size_t character = 0;             ///< first character of the run that it stands for
    Vec2 offset{0};                        ///< em, of its outline from the pen
    double advance = 0;                    ///< em, of the pen to the next glyph
    std::vector<std::vector<Vec2>> rings;  ///< em, closed outlines (nonzero rule), without `offset`
};

/// How a run is shaped.
struct Shaping {
    bool ligatures = true;    ///< off where letters are spaced or placed one by one
    double tolerance = 5e-4;  ///< em, largest distance of a chord from its curve
};

/// Lines of a font, em above the baseline.
struct FontMetrics {
    double ascent = 0.8, descent = -0.2;
    double x_height = 0.5;                     ///< of small letters
    double underline = -0.1, strikeout = 0.3;  ///< middle of the line
    double line_thickness = 0.05;
};

/// One face of a font file. Not shared by threads.
class Font {
  public:
    /// `face` is the number in a collection; its upper 16 bits are a named instance of a variable font, as fontconfig
    /// counts them. Throws `Error` for a damaged file, one above 256 MiB and one without outlines.
    explicit Font(const std::filesystem::path& path, int face = 0);
    ~Font();
    Font(Font&&) noexcept;
    Font& operator=(Font&&) noexcept;

    /// Returns true when the font has a glyph for the character.
    bool has(char32_t code) const;
    const FontMetrics& metrics() const;

    /// Returns the glyphs of a run in one direction, from left to right on the page. The script and the direction are
    /// those of its first character with one. A character without a glyph gives the font's sign for missing ones.
    /// Throws `Error` for a glyph of more than 100,000 points.
    std::vector<ShapedGlyph> shape(std::u32string_view run, const Shaping& shaping = {});

  private:
    struct Face;
    std::unique_ptr<Face> face_;
};

/// Whether a path ends as outline fonts do: .ttf, .otf, .ttc, .otc, .woff, .woff2, .pfb.
bool is_font_file(const std::filesystem::path& path);

}  // namespace tuft::io
