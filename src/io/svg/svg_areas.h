#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/svg/svg_scene.h"
#include "stroke/journal/recorded_stroke.h"

/// \file
/// Shapes of an SVG drawing as masked areas in its colours. Called by svg.cpp. Any thread.
namespace tuft::io {

/// ΔE2000 up to which two colours of a drawing become one ink.
inline constexpr double kSameInk = 1;

/// Returns true when a shape has a colour other than black. A white page does not count, other white does.
bool has_colours(const SvgScene& scene);

/// Returns a shape whose stroke does not grow with transforms (`fixed_width`) in metres, any other as it is. `unit`:
/// metres of a unit of the page.
SvgShape svg_with_own_width(SvgShape shape, double unit);

/// Returns rings that enclose, by the nonzero rule, what the stroke of a shape covers, with its dashes; metres. `unit`:
/// metres of a unit of the page, for strokes of fixed width.
std::vector<Ring> svg_stroke_outline(const SvgShape& shape, double unit, double tolerance);

/// Returns the areas of a scene, back to front: the fill and the stroke of each shape as a `stroke::FlatArea`, in inks
/// named by their colours (`#rrggbb`). A colour within `kSameInk` of an earlier one takes its ink. Gradients get stops
/// at most 8 ΔE2000 apart, colours between them mixed in sRGB (SVG 1.1, 13.2.4). Clip paths and masks cut the areas; a
/// mask with a gradient grades the film. What lies beside the page is cut off. A white shape over the whole page below
/// all others is the background and is left out. Areas reach under later ones
/// at the edges that they share (svg_seams.h). Adds to `scene.losses` what is not painted. Throws `Error` for too many
/// points or pieces.
std::vector<stroke::RecordedStroke> svg_areas(SvgScene& scene, const std::string& source, double tolerance);

}  // namespace tuft::io
