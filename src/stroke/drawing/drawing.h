#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "stroke/drawing/line_width.h"
#include "stroke/journal/journal.h"

/// \file
/// A flat drawing on its way from a file onto a model. `tuft paint` and the studio both place
/// drawings by these functions, so the same file at the same place gives the same journal.
namespace tuft::stroke {

/// Preset of lines that name no brush.
inline constexpr const char* kDefaultBrush = "wolf-medium";

/// Maps everything that a flat trace holds in its own frame by p' = scale (p − centre), metres:
/// samples and stencil edges. The line width grows by `scale`; so do the times, which keeps the
/// hand's speed. `mirrored` then flips x: what was painted still lies on the inner side of its
/// stencil. Precondition: scale > 0.
void transform_trace(Trace& trace, const Vec2& centre, double scale, bool mirrored = false);

/// Bounds of the ink of several traces, metres, their own frames taken as one (`add_extent`).
Box extent_of(std::span<Trace* const> drawing);

/// Width in metres by which the scale of a drawing is said: of its bounds; of what is next to no
/// width, a twentieth of its height.
double width_of(const Box& extent);

/// Moves parts that their file puts at different places, such as characters round a bowl, beside
/// each other from left to right: at one place they would cover each other. The gap is 0.15 of a
/// part's larger side. Traces that follow each other with the same placement are one part.
void arrange_parts(std::span<Trace* const> drawing);

/// The placement of a drawing at a point of the surface with the unit normal `normal`: upright as
/// seen by a person who stands before the surface, and with +x to the right where it lies flat;
/// then turned anticlockwise by `turn` radians as seen from outside.
Placement upright_placement(const Vec3& origin, const Vec3& normal, double turn);

/// The same as seen by a person whose right is `right` (any length, not along `normal`).
Placement placement_seen(const Vec3& origin, const Vec3& normal, const Vec3& right, double turn);

/// Unit direction to the right of a person at `from` (any length, from the model) who looks at the
/// model; +x above and below it.
Vec3 reading_right(const Vec3& from);

/// Right of an upright drawing on a surface with this unit normal (`upright_placement`).
Vec3 upright_right(const Vec3& normal);

/// Angle in radians by which a placement with +x along `upright` must turn about `normal` so that
/// +x points along `right`.
double turn_of(const Vec3& normal, const Vec3& upright, const Vec3& right);

/// Which brushes a drawing is painted with.
struct BrushFit {
    bool grow = true;  ///< brushes that the file names grow and shrink with the drawing
    bool fit = true;   ///< lines with a width get the size of their brush that draws it
    /// Thickness in metres that an ink of this name leaves; empty: of the shipped inks, else of
    /// `ink::Ink` as it is made.
    std::function<double(const std::string&)> film = {};
    std::string otherwise;  ///< preset of traces that name none; empty: kDefaultBrush in a size
                            ///< that suits the drawing
};

/// Where and how large a drawing comes to lie.
struct DrawingPlace {
    Placement placement;  ///< its origin comes under `centre`; its mapping is not used
    Vec2 centre{0};       ///< metres, frame of the drawing
    double scale = 1;
    bool mirrored = false;  ///< flipped from left to right
};

/// Pointers to the traces of these entries that are flat strokes of the model and have no place of
/// their own; with `all` also those that have one.
std::vector<Trace*> drawing_in(std::vector<Stroke>& entries, bool all);

/// Places a drawing: transforms its traces (`transform_trace`) and gives them origin, right and
/// down of the placement. Each trace keeps its mapping.
void place_drawing(std::span<Trace* const> drawing, const DrawingPlace& place);

/// Replaces lines with a width that need more ink than their brush holds by pieces of them, each
/// with a fresh brush
/// (`cut_line`); pieces overlap by what setting down and lifting take, so that no joint shows. Only
/// strokes that begin with a fresh brush and may run dry. Where ink comes to the tip too slowly,
/// the hand goes slower (`pace_line`). Invalidates pointers to traces.
void redip_long_lines(std::vector<Stroke>& entries, const BrushFit& fit, WidthTables& widths);

/// Names the brush of every entry that has none, in the sizes that `fit` asks for. `drawing`
/// (traces of `entries`) has been placed with `scale` and is `extent` metres large now.
void choose_brushes(std::vector<Stroke>& entries, std::span<Trace* const> drawing, double scale, double extent,
                    const BrushFit& fit, WidthTables& widths);

/// Line widths that a brush could not draw.
struct WidthMismatch {
    std::string brush;                ///< the last one; empty: all widths are drawn
    double least = 0, most = 0;       ///< metres, asked for
    double thinnest = 0, widest = 0;  ///< metres, that this brush draws
};

/// Sets the pressures of lines with a width so that they come out as wide (`draw_to_width`,
/// `fit_trajectory`). The entries then hold the hand's motion alone: their line widths are 0.
WidthMismatch press_to_widths(std::vector<Stroke>& entries, WidthTables& widths);

}  // namespace tuft::stroke
