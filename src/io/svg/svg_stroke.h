#pragma once

#include <vector>

#include "io/svg/style/svg_shapes.h"
#include "io/svg/style/svg_style.h"

/// \file
/// Outlines of SVG strokes (SVG 1.1, 11.4). Called by svg_areas.cpp. Any thread.
namespace tuft::io {

/// Returns a line as its dashes; a closed line ends where it begins. Unchanged without dashes. At most
/// `kMostDashes`, then the line unchanged.
std::vector<SvgLine> svg_dashed(const SvgLine& line, const std::vector<double>& dashes, double offset);
inline constexpr std::size_t kMostDashes = 100'000;

/// Returns rings that enclose, by the nonzero rule, what a stroke of `style` covers: all points within half the width
/// of the line, with its ends and corners. Round ends and corners are chords within `tolerance` user units. User units.
std::vector<SvgLine> svg_stroke_rings(const SvgLine& line, const SvgStyle& style, double tolerance);

}  // namespace tuft::io
