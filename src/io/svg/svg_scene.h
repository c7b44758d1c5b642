#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/strokes/inkml.h"
#include "io/strokes/shape.h"
#include "io/svg/style/svg_shapes.h"
#include "io/svg/style/svg_style.h"
#include "io/svg/svg_gradient.h"
#include "io/svg/svg_image.h"
#include "io/svg/svg_losses.h"

namespace pugi {
class xml_node;
}

/// \file
/// An SVG drawing as a list of painted shapes, back to front (SVG 1.1, W3C 2011). Called by svg.cpp. Any thread.
namespace tuft::io {

struct SvgShape;

/// A mask. Light parts of it show the masked shape, dark and unpainted parts hide it.
struct SvgMask {
    std::vector<SvgShape> shapes;
    bool alpha = false;  ///< counts opacity alone, not light
};

/// Gradients of a shape; null where its paint is none.
using SvgGradientPtr = std::shared_ptr<const SvgGradient>;

/// One shape with its inherited properties.
struct SvgShape {
    std::vector<SvgLine> lines;  ///< user units
    SvgMatrix matrix{1};         ///< user units to metres
    SvgStyle style;
    double opacity = 1;                     ///< of the shape and of all groups round it
    std::size_t film = 0;                   ///< number of the outermost translucent group or shape; 0: none
    double film_opacity = 1;                ///< of that group and what is round it
    bool fixed_width = false;               ///< its stroke does not grow with transforms
    std::vector<std::size_t> clips, masks;  ///< indices into the scene: all of them apply
    SvgGradientPtr fill_gradient, stroke_gradient;
    SvgPicturePtr picture;  ///< that fills it, in place of the style's paint
    std::string group;      ///< the outermost group that is a layer or has a name; empty: none
    std::string upright;    ///< the group that a mirrored copy keeps readable; empty: none
};

/// Shapes of a drawing, with clip paths and masks.
struct SvgScene {
    std::vector<SvgShape> shapes;
    std::vector<Shape> clips;  ///< metres
    std::vector<SvgMask> masks;
    Vec2 page{0};     ///< metres, size of the page; 0: unknown
    double unit = 0;  ///< metres of a unit of the page
    SvgLosses losses;
};

/// Options of reading a drawing.
struct SvgSceneOptions {
    /// For lines of a brush: no clip paths, masks, patterns, markers and frames of inner drawings; they are counted as
    /// losses, as are opacities and gradients.
    bool brush = true;
    double tolerance = 2e-5;  ///< metres, largest distance of a chord from its curve
    std::size_t max_points = 10'000'000;
    std::filesystem::path folder;  ///< of pictures; empty: none is read
};

/// Reads the shapes of a drawing. Throws `Error` with `source` where a limit is exceeded: depth of groups and of
/// references, elements (those of each `use` counted), bytes of attributes, tiles of a pattern.
SvgScene read_svg_scene(const pugi::xml_node& svg, const std::string& source, const SvgSceneOptions& options);

}  // namespace tuft::io
