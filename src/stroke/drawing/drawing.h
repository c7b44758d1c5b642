#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "stroke/drawing/line_width.h"
#include "stroke/journal/journal.h"

/// \file
/// A flat drawing from a file on its way onto a model: size, place and brushes. Called by `tuft paint` and by the
/// studio; the same file at the same place gives the same journal.
namespace tuft::stroke {

/// Preset for lines without a brush.
inline constexpr const char* kDefaultBrush = "wolf-medium";

/// Maps samples and stencil of a flat trace by p' = scale (p − centre), metres, frame of the trace. Line width and
/// times are multiplied by `scale`, which preserves the hand's speed. `mirrored` then flips x, and the stencil's sides
/// with it. Precondition: scale > 0.
void transform_samples(StrokeSamples& trace, const Vec2& centre, double scale, bool mirrored = false);

/// Returns the bounds of the ink of several traces, metres, in one common frame (`add_extent`).
Box extent_of(std::span<StrokeSamples* const> drawing);

/// Width of a line from which it is filled, metres. A liner draws narrower ones in one stroke.
inline constexpr double kWideLine = 1.5e-3;

/// Replaces lines that state their outline (`StrokeSamples::outline`) and are at least `wide` metres wide by masked
/// areas in their ink: they have the ends and corners of the file, which a tuft has not. Areas of lines with one
/// placement are one drawing. An eraser's lines and wet ones are not replaced. Removes the outlines of the others.
/// Precondition: the lines have their place. Invalidates pointers to traces.
void fill_wide_lines(std::vector<JournalEntry>& entries, double wide = kWideLine, AreaEdges edges = AreaEdges::facing);

/// Returns the width that the scale of a drawing refers to, metres: that of its bounds, at least a twentieth of their
/// height.
double width_of(const Box& extent);

/// Moves parts with different placements, such as characters round a bowl, beside each other from left to right: at one
/// placement they would overlap. The gap is 0.15 of a part's larger side. Consecutive traces with one placement are one
/// part.
void arrange_parts(std::span<StrokeSamples* const> drawing);

/// Returns the placement of a drawing at a point of the surface with unit normal `normal`: upright for a person in
/// front of the surface, +x to the right where it is horizontal; then rotated anticlockwise by `turn` radians, seen
/// from outside.
Placement upright_placement(const Vec3& origin, const Vec3& normal, double turn);

/// The same for a person whose right is `right` (any length, not parallel to `normal`).
Placement placement_seen(const Vec3& origin, const Vec3& normal, const Vec3& right, double turn);

/// Returns the unit direction to the right of a person in direction `from` (any length) who looks at the model; +x from
/// straight above and below.
Vec3 reading_right(const Vec3& from);

/// Returns right of an upright drawing on a surface with this unit normal (`upright_placement`).
Vec3 upright_right(const Vec3& normal);

/// Returns the angle about `normal` from `upright` to `right`, radians.
double turn_of(const Vec3& normal, const Vec3& upright, const Vec3& right);

/// Choice of brushes for a drawing.
struct BrushFit {
    bool grow = true;  ///< brushes that the file names are scaled with the drawing
    bool fit = true;   ///< lines with a width get the size of their brush that draws it
    /// Returns the film of an ink by name, metres. Empty: that of the shipped ink, else the default of `ink::Ink`.
    std::function<double(const std::string&)> film = {};
    std::string otherwise;  ///< preset for traces without a brush; empty: `kDefaultBrush`, sized for the drawing
};

/// Placement and size of a drawing.
struct DrawingPlace {
    Placement placement;    ///< `centre` is mapped to its origin; its mapping is not used
    Vec2 centre{0};         ///< metres, frame of the drawing
    double scale = 1;       ///< times the size in the file
    bool mirrored = false;  ///< flipped in x
};

/// Returns pointers to the traces of these entries that are flat, on the model, and without a placement of their own;
/// with `all` also those with one.
std::vector<StrokeSamples*> drawing_in(std::vector<JournalEntry>& entries, bool all);

/// Returns pointers to the areas of these entries that have no placement of their own; with `all` also those with one.
std::vector<FlatArea*> areas_in(std::vector<JournalEntry>& entries, bool all);

/// Adds the bounds of the drawing that an area is part of to a box. Metres, frame of the area.
void add_extent(Box& box, const FlatArea& area);

/// Places the areas of a drawing as `place_drawing` places its traces.
void place_areas(std::span<FlatArea* const> areas, const DrawingPlace& place);

/// Transforms the traces of a drawing (`transform_samples`) and sets origin, right and down of their placements. Their
/// mappings do not change.
void place_drawing(std::span<StrokeSamples* const> drawing, const DrawingPlace& place);

/// Cuts lines with a width that need more ink than their brush holds into pieces, each painted with a fresh brush
/// (`cut_line`). Pieces overlap by the lengths of setting down and lifting, so that no joint shows. Applies to strokes
/// with `DipMode::each` that are not endless. Slows lines down where ink reaches the tip too slowly (`pace_line`).
/// Invalidates pointers to traces.
void redip_long_lines(std::vector<JournalEntry>& entries, const BrushFit& fit, WidthTables& widths);

/// Traces of a drawing that has been placed.
struct PlacedTraces {
    std::vector<StrokeSamples*> traces = {};
    double scale = 1;   ///< times the size in the file
    double extent = 0;  ///< metres, as placed
};

/// Sets the brush of every entry without one, and sizes of brushes as `fit` says. `drawing`: traces of `entries`.
void choose_brushes(std::vector<JournalEntry>& entries, const PlacedTraces& drawing, const BrushFit& fit,
                    WidthTables& widths);

/// A place farther beside the model than this part of its box diagonal is a mistake, not a rounding of its numbers.
inline constexpr double kFarBeside = 0.05;

/// Line widths that a brush cannot draw.
struct WidthMismatch {
    std::string brush;                ///< the last such brush; empty: all widths can be drawn
    double least = 0, most = 0;       ///< of the lines that it cannot draw, metres
    double thinnest = 0, widest = 0;  ///< of this brush, metres
};

/// Sets the pressures of lines with a width so that their ink is as wide (`draw_to_width`, `fit_trajectory`). Their
/// line widths become 0: the entries then hold the hand's motion alone.
WidthMismatch press_to_widths(std::vector<JournalEntry>& entries, WidthTables& widths);

}  // namespace tuft::stroke
