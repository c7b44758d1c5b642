#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/strokes/inkml.h"
#include "stroke/journal/recorded_stroke.h"

/// Drawings: SVG 1.1 (W3C Recommendation, 16 August 2011).
namespace tuft::io {

/// A drawing as flat traces, in the order of the file: `path` (all commands),
/// `line`, `polyline`, `polygon`, `rect`, `circle`, `ellipse`, under the `transform`s of their groups,
/// and once more wherever a `use` names them.
/// Curves become chords that stay within `tolerance` of them; elliptical arcs after appendix F.6.5. What
/// is not displayed, and what lies in `defs`, is left out. `stroke-width` (as an attribute, in a style, by a class
/// of a style sheet, inherited, grown by transforms) becomes `StrokeSamples::line_width` where there is a `stroke`.
/// What has a `fill` is filled by lines within stencil edge (`area_lines`, with `fill-rule`), under its stroke if it
/// has one, whatever its colour; white is the background and fills nothing. What has neither is drawn along its
/// outlines, and so is what has no area and no `stroke`; other styles are not looked at. Where a trace has a width,
/// pressures say which part of it is drawn, 0.5 the whole. One user unit is what `width` and `viewBox` say, else 1/96
/// inch. Pace and pressure are those of `parse_inkml` for traces that have none.
///
/// Throws `Error` with the file's name: not SVG, nothing to draw in it, a number that is none,
/// absurd sizes.
struct SvgOptions {
    double tolerance = 2e-5;  ///< metres
    InkmlOptions ink;         ///< pace, pressure, limits
};
std::vector<stroke::RecordedStroke> read_svg(const std::filesystem::path& path, const SvgOptions& options = {});
std::vector<stroke::RecordedStroke> parse_svg(std::string_view text, const std::string& source,
                                              const SvgOptions& options = {});

/// Traces of an `.svg` drawing, or else of an InkML file.
std::vector<stroke::RecordedStroke> read_strokes(const std::filesystem::path& path, const InkmlOptions& options = {});

}  // namespace tuft::io
