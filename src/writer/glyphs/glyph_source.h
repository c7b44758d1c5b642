#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "writer/glyphs/glyph.h"

/// \file
/// Sources of strokes that people have. Called by `tuft write`. Any thread; a source is not shared by threads.
namespace tuft::writer {

/// Characters by code.
class GlyphSource {
  public:
    virtual ~GlyphSource() = default;
    /// Returns the character, nothing where the source has none. Throws `Error` with file and fault for a damaged one.
    virtual std::optional<Glyph> find(char32_t code) = 0;
    /// Returns the units by which the second of two characters moves towards the first.
    virtual double kerning(char32_t /*first*/, char32_t /*second*/) { return 0; }
    /// Returns the characters of a line as they are set, in order of writing. The base does `find` for each and takes
    /// `kerning` from the advances; a font shapes the line (ligatures, kerning). Nothing at characters that are
    /// missing.
    virtual std::vector<std::optional<Glyph>> find_line(const std::u32string& line);
};

/// Opens a source by what it is:
/// - a folder with `CHARACTER.json` (hanzi-writer-data: "strokes" as SVG paths, "medians"),
/// - a folder with `CODE.svg`, five hexadecimal digits (KanjiVG: a path of each stroke, `kvg:type`; `CODE-FORM.svg` is
///   not read),
/// - `graphics.txt` (Make Me a Hanzi), one JSON object a line with "character", or a folder with it,
/// - an SVG font (`font` with open paths in `glyph`), or a folder with some,
/// - an outline font (.ttf, .otf, .ttc, .woff2 …) through FreeType, or the name of an installed one's family.
/// Throws `Error` where it is none of these.
std::unique_ptr<GlyphSource> open_glyphs(const std::filesystem::path& path);

/// Returns the folder of the bundled characters.
std::filesystem::path bundled_glyphs();

/// Returns the glyphs of a text's lines from the first of `sources` that has each; blanks are glyphs without strokes. A
/// full-width form that none has is the character that it is a form of, in the middle of a square.
/// Throws `Error` that names all missing characters in one line.
std::vector<std::vector<Glyph>> glyphs_of(const std::vector<std::u32string>& lines,
                                          const std::vector<GlyphSource*>& sources);

/// Readers of one file each, for tests and fuzzers. `source` is named in errors. `code` is set in the result.
Glyph parse_hanzi_json(std::string_view text, char32_t code, const std::string& source);
Glyph parse_kanji_svg(std::string_view text, char32_t code, const std::string& source);
/// Returns the character as `parse_hanzi_json` reads it back, coordinates to 0.005 units; classes of strokes are not
/// stored. Precondition: it has strokes, and each has an outline.
std::string hanzi_json_of(const Glyph& glyph);
/// Characters of a line font.
struct LineFontGlyphs {
    std::vector<Glyph> glyphs;
    /// Units by which the second of two characters moves towards the first (`hkern` with `u1`, `u2`, `k`).
    std::map<std::pair<char32_t, char32_t>, double> kerning;
};
LineFontGlyphs parse_line_font(std::string_view text, const std::string& source);

}  // namespace tuft::writer
