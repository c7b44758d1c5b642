#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/query/surface_query.h"
#include "writer/glyphs/glyph.h"

/// \file
/// Where the characters of a text stand: in lines, in columns, or along a path on the model. Called by `tuft write`.
namespace tuft::writer {

enum class Direction {
    horizontal,  ///< from left to right, lines from the top down
    vertical,    ///< from the top down, columns from right to left
    rim,         ///< round the model, level
    curve,       ///< along a line on the model
};
/// Words of the command line, in the order of the values.
inline constexpr std::array<const char*, 4> kDirectionNames{"horizontal", "vertical", "rim", "curve"};
inline const char* name_of(Direction direction) {
    return kDirectionNames[static_cast<std::size_t>(direction)];
}
std::optional<Direction> direction_named(std::string_view name);

/// Size and spacing of a text.
struct LayoutOptions {
    Direction direction = Direction::horizontal;
    double side = 0.05;          ///< metres, of a character's square
    double spacing = 1.05;       ///< of characters: part of their advance
    double line_spacing = 1.25;  ///< parts of the side

    bool operator==(const LayoutOptions&) const = default;
};

/// Splits a text at newlines ("\n" and the two characters \ n); at least one line. Characters without a form, such as
/// selectors of variants, joiners and byte order marks, are left out.
std::vector<std::u32string> lines_of(std::string_view text);

/// How a character stands in a column, by the property Vertical_Orientation [UAX50].
enum class ColumnForm {
    upright,   ///< as on a line (U)
    corner,    ///< upright, its ink moved to the opposite corner of the square: 、。，．, small kana (Tu)
    sideways,  ///< turned clockwise by a quarter: Latin, digits, brackets, dashes (R, Tr)
};
ColumnForm column_form(char32_t code);

/// Returns a glyph as it stands in a column. A sideways one is as wide as a square, and its advance on a line is its
/// length in the column.
Glyph in_column(Glyph glyph);

/// Puts a quarter of the side between a Han character or kana and a Latin, Greek or Cyrillic letter or a digit beside
/// it ([JLREQ2020] 3.2.6), as `Glyph::after` of the first of them.
void space_scripts(std::vector<Glyph>& line);

/// Returns the lower left corner of each glyph's square, metres, y down, in lines of glyphs. Squares of one line stand
/// `spacing` times their advance, in columns their length (`in_column`), and the space after them apart. Lines and
/// columns are centred on each other. In columns squares are centred on the column.
std::vector<std::vector<Vec2>> place_in_lines(const std::vector<std::vector<Glyph>>& lines,
                                              const LayoutOptions& options);

/// A line on the model, metres, model frame.
struct ModelPath {
    std::vector<Vec3> points;
    std::vector<Vec3> normals;  ///< unit, outward. [points]
    bool closed = false;        ///< the last point is joined to the first

    double length() const;
};

/// A place on a path and the directions of a character there.
struct PathPlace {
    Vec3 position{0}, right{1, 0, 0}, normal{0, 0, 1};  ///< metres; unit, orthogonal
};

/// Returns the place at a length along a path; a closed one goes round. Direction over ±`reach` metres.
PathPlace place_on(const ModelPath& path, double along, double reach);

/// Returns lengths along a path at which the middles of glyphs stand: half of one advance and half of the next apart,
/// times `spacing`, centred on `middle`. Throws `Error` when a closed path is shorter than the text.
std::vector<double> place_along(const ModelPath& path, const std::vector<Glyph>& glyphs, double middle,
                                const LayoutOptions& options);

/// Returns the part of the mesh's section with the level plane through `through` that is nearest to it, from the point
/// nearest to it on. A reader outside sees it run to the right. Throws `Error` where the plane meets no surface.
/// Cost: one pass over the triangles.
ModelPath level_section(const mesh::SurfaceQuery& query, const Vec3& through);

}  // namespace tuft::writer
