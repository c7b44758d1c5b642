#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/strokes/inkml.h"
#include "stroke/journal/recorded_stroke.h"

/// \file
/// Drawings in SVG 1.1 (W3C Recommendation, 16 August 2011). Called by `cli` and by the studio. Any thread.
namespace tuft::io {

/// How a drawing is painted.
enum class SvgPainting {
    brush,      ///< in one ink, by lines of a brush
    areas,      ///< in its colours, each area masked and filled (svg_areas.h)
    automatic,  ///< in its colours where it has any but black, else by a brush
};

/// Options of `read_svg`.
struct SvgOptions {
    SvgPainting painting = SvgPainting::brush;
    std::vector<std::string> groups;  ///< only shapes in these layers and named groups; empty: all
    double tolerance = 2e-5;          ///< metres, largest distance of a chord from its curve
    /// metres, as the file is written; with `brush` and without `outlines`, lines from this width on are filled by
    /// lines of a brush, with the ends, corners and dashes that the file says
    double wide = 8e-3;
    bool outlines = false;  ///< with `brush`: lines state what they cover (`StrokeSamples::outline`)
    /// of pictures that the drawing refers to; empty: none is read from files. `read_svg` takes the drawing's own.
    std::filesystem::path folder;
    InkmlOptions ink;  ///< speed, pressure and limits
};

/// Reads a drawing as flat traces, in the order of the file: `path` (all commands), `line`, `polyline`, `polygon`,
/// `rect`, `circle`, `ellipse`, `text` as outlines of installed fonts (svg_text.h), under the `transform`s of their
/// groups and once for each `use`. Content of `defs` and elements that are not displayed are skipped. Curves become
/// chords; elliptical arcs follow appendix F.6.5. One user unit is given by `width` and `viewBox`, else it is 1/96
/// inch.
///
/// An element with `stroke` is drawn along its outlines with `stroke-width` as `StrokeSamples::line_width`. The width
/// may be an attribute, a style, a rule of a style sheet or inherited; transforms scale it. An element with `fill` is
/// filled by lines with a stencil (`area_lines`, by `fill-rule`), before its stroke and whatever the colour. White is
/// the background and is not filled. An element without either is drawn along its outlines, and so is one without area
/// and `stroke`. Other styles are ignored.
///
/// With `SvgPainting::areas` the shapes become fills with `stroke::Region::outline` instead: strokes with their ends,
/// corners and dashes, gradients, opacities, clip paths, masks, patterns, markers, `use` of symbols and inner drawings
/// in their frames. Images are stencils: black ink by their darkness (svg_image.h). What stays out is reported by
/// `InkmlOptions::note`: images that cannot be read, filters, blend modes, animation.
///
/// `RecordedStroke::group` is the layer, or the outermost group with a name (`inkscape:label`, `data-name`, `id`).
///
/// With `SvgPainting::brush` each dash is a line. A point with round or square ends is a short one.
///
/// In traces with a width the pressure is the fraction of the width to draw, 0.5 for all of it. Other traces have speed
/// and pressure as by `parse_inkml`.
///
/// Throws `Error` with the file's name where the file is no SVG, has nothing to draw, has an invalid number or exceeds
/// a limit.
std::vector<stroke::RecordedStroke> read_svg(const std::filesystem::path& path, const SvgOptions& options = {});
std::vector<stroke::RecordedStroke> parse_svg(std::string_view text, const std::string& source,
                                              const SvgOptions& options = {});

/// Reads the traces of an `.svg` drawing, else of an InkML file.
std::vector<stroke::RecordedStroke> read_strokes(const std::filesystem::path& path, const SvgOptions& options);
std::vector<stroke::RecordedStroke> read_strokes(const std::filesystem::path& path, const InkmlOptions& options = {});

}  // namespace tuft::io
