#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/svg/style/svg_shapes.h"
#include "io/svg/style/svg_style.h"

/// \file
/// Gradients of SVG drawings (SVG 1.1, 13.2). Called by svg_scene.cpp. Any thread.
namespace tuft::io {

/// Stop of a gradient.
struct SvgStop {
    double at = 0;  ///< 0–1, ascending
    SvgColour colour;
};

/// A gradient in a unit space: linear t = x; radial about the circle of radius 1.
struct SvgGradient {
    bool radial = false;
    SvgMatrix to_unit{1};  ///< from metres
    Vec2 focus{0};         ///< unit space, |focus| < 1
    enum class Spread { pad, reflect, repeat } spread = Spread::pad;
    std::vector<SvgStop> stops;  ///< at least one
};

/// Shape and page that a gradient is used on.
struct SvgGradientUse {
    SvgMatrix matrix{1};   ///< user units to metres
    Vec2 low{0}, high{0};  ///< bounds of the shape, user units
    Vec2 page{1};          ///< size of the page, user units
};

/// Returns the gradient `id` on a shape. Attributes and stops that it lacks are those of the gradient that it refers
/// to, at most 64 of them. Nothing where it paints nothing: no stops, no extent, no such gradient.
std::optional<SvgGradient> svg_gradient(const std::string& id, const SvgGradientUse& use, const SvgIds& ids,
                                        const SvgSheet& sheet, const std::string& source);

}  // namespace tuft::io
