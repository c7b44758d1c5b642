#pragma once

#include <functional>
#include <vector>

#include "decal/panels/select_film.h"
#include "decal/polygons.h"
#include "decal/print_surface.h"

/// \file
/// Cut lines of the film: where film lies round what is painted on a panel. Called by sheet.h.
namespace tuft::decal {

/// Distances of cut lines, metres.
struct OutlineOptions {
    double bleed = 0.003;      ///< film beyond the paint
    double join = 0.01;        ///< islands of paint nearer than this to each other share a piece of film
    double least_side = 0.01;  ///< short side of the smallest piece: what fingers can hold
    double texel = 1e-4;       ///< of the coverage
    /// Returns how far the film may reach beyond a seam with the panels of a label, metres. Infinite: nothing is
    /// painted there, and the seam is like any border of the film.
    std::function<double(std::uint32_t label)> overlap;
};

/// Returns what the panels have to cover for these cut lines. Film of a wide bleed goes on beyond them in the plane.
FilmReach film_reach(double bleed, double join);

/// One piece of film: an outer ring and its holes, in the panel's plane.
struct Outline {
    Region film;
    double paint_area = 0;  ///< m² of coverage inside it, of the panel's own triangles
};

/// Returns the pieces of film of a panel. The film is the closing of the paint: all that is within g of it and more
/// than g − bleed from what is not. So the cut line runs `bleed` outside the paint and bridges gaps; with g = (¼ join²
/// + bleed²) / 2 bleed two points `join` apart share a piece, and broad islands a little further apart do too. Inner
/// corners of a piece have a radius of half the bleed at least, or of 1 mm, at most 5: film tears from sharper ones.
/// Holes smaller than a disc of radius 3 max(bleed, join / 2) are film. The film ends at seams, or `overlap` beyond
/// them. Beyond other borders of the panel it goes on in the plane. The paint ends where its coverage is a half, found
/// between the nodes of a grid (paint_field.h) of cells of a texel, at least 0.1 mm, and at most 4 million of them;
/// distances from there are those of level_set.h. So the line is within a tenth of a cell and 10 µm. Pieces with less
/// than 0.05 mm² of paint are left out.
std::vector<Outline> find_outlines(const FilmMesh& film, const Panel& panel, const PrintSurface& surface,
                                   const CoverageFn& coverage, const OutlineOptions& options);

}  // namespace tuft::decal
