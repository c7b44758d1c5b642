#pragma once

#include <span>

#include "brush/tuft/tuft.h"
#include "core/system/recycled.h"
#include "footprint/outline/footprint.h"
#include "footprint/outline/hair.h"

/// \file
/// Contact patch of a carried shape (brush/tuft/geometry_tuft.h): what lies below the surface. Called by `stroke` for
/// every stamp, in place of outlines of ellipses; the picture goes the same way from there.
///
/// A mesh is cut where the height of its skin over the surface, interpolated over each triangle, is `film`: closed
/// polygons, as many as there are. Where the middle of a section of hair lies deeper, it is cut there, at its widest,
/// and the film stands out beside it. Regions are inside an odd number of them (even–odd), so a hollow shape leaves a
/// ring. A hair is the stadium round each of its parts below the surface. Open pores of foam are discs without contact.
namespace tuft::footprint {

/// Polygon in the stamp's (u, v), metres, counter-clockwise outside, clockwise round a hole.
using Polygon = Recycled<Vec2>;

/// Ink on a tuft that carries a shape.
struct ShapeOptions {
    double film = 0.1e-3;  ///< metres, ink on the skin or the hair
    double wetness = 1;    ///< 0–1: ink spans the rims of pores and stands out beside hairs
};

/// Returns the polygons of a mesh. Empty where nothing touches.
Recycled<Polygon> section_polygons(const brush::CarriedShape& carried, const brush::TuftShape& shape,
                                   const Frame& frame, const ShapeOptions& options = {});

/// Wetness and motion of single hairs, for `hair_polygons`.
struct LineInk {
    std::span<const double> wet = {};  ///< [bundles] as in `HairInk`; empty: full
    double travel = 0;                 ///< metres of the stroke so far
    std::uint64_t seed = 0;
};

/// Returns the stadiums of the hairs of polylines. `width` is a hair's own, metres. With w the wetness of its bundle, a
/// hair marks while w > n, n of each hair fixed for three quarters and changing along the stroke for one; it marks
/// width + 2 film min(1, w) wide.
Recycled<Polygon> hair_polygons(const brush::CarriedShape& carried, const brush::TuftShape& shape, const Frame& frame,
                                double width, const LineInk& ink, const ShapeOptions& options = {});

/// Returns the polygons of a tuft's shape, mesh or hair, in full ink and without pores.
Recycled<Polygon> shape_polygons(const brush::Tuft& tuft, const brush::TuftShape& shape, const Frame& frame,
                                 const ShapeOptions& options = {});

/// Returns the radius of a pore's mouth where the skin is pressed by `depth`, metres:
///
///     r = r₀ √(1 − depth/shut_depth) + q (1 − √(1 − ⟨1 − depth/q⟩²)),   q = 0.6 r₀ [X].
///
/// Foam that is pressed does not bulge, so its pores keep their width until its cells are shut: `shut_depth` is its
/// height times the strain ε_D of foam.h. Their rims are round with radius q: skin that only just touches touches with
/// the ridges between the pores.
double open_radius(double rest, double depth, double shut_depth);

/// Removes the open pores of foam from its picture; ink spans 0.3 film wetness of each rim.
void open_pores(const brush::CarriedShape& carried, const brush::TuftShape& shape, const ShapeOptions& options,
                Footprint& footprint);

/// Returns the union of polygons of positive sense, less those of negative sense, as a picture; see `rasterise`.
Footprint rasterise_polygons(std::span<const Polygon> polygons, const Frame& frame, std::uint32_t triangle,
                             double cell);

/// Multiplies the coverage of `footprint` by that of `by`: marks of single hairs inside a shape.
void clip_footprint(Footprint& footprint, const Footprint& by);

/// Returns which parts of which bundles touch, as `hair_contact_points` does; at most about 400.
Recycled<HairContactPoint> shape_contact_points(const brush::CarriedShape& carried, const brush::TuftShape& shape,
                                                const Frame& frame, double film);

/// Returns the contact fractions of all cells, as `contact_cells` does.
Recycled<float> shape_contact_cells(std::span<const HairContactPoint> points, std::size_t bundles,
                                    std::span<const double> ends);

}  // namespace tuft::footprint
