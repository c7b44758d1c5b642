#pragma once

#include "decal/panels/film_mesh.h"

/// \file
/// What film has to cover: the paint and what lies round it. Called by sheet.h.
namespace tuft::decal {

/// Distances from the paint, metres.
struct FilmReach {
    double bleed = 0.003;  ///< film beyond the paint; half a millimetre more is taken
    double around = 0;     ///< ≥ bleed: film also fills what the closing of the paint by it does, less the bleed
    double hole = 0;       ///< holes smaller than a disc of this radius are film
};

/// Returns the part of `model` with more than half coverage, and what the surface reaches from there within `bleed`
/// without turning by more than 35°. With `around` also what is further from the paint than that, but further than
/// around − bleed from all that is beyond `around`: it bridges gaps, as the cut line does (outline.h).
///
/// Triangles that are painted in part, and those round them, are halved at their longest edges [Rivara1984] until these
/// are shorter than half the bleed, or than the root of 1/30,000 of their area where that is more; the film ends on
/// straight lines in them. Distances are those of the straight lines to the paint that is nearest along edges. Coverage
/// is sampled every `texel` metres. Each connected part gets a label. The same bits for any number of threads.
FilmMesh select_film(const mesh::TriangleMesh& model, const CoverageFn& coverage, const FilmReach& reach, double texel);

/// Whether more than half coverage lies anywhere in a triangle of the film, sampled every `texel` metres.
bool is_painted(const FilmMesh& film, std::uint32_t triangle, const CoverageFn& coverage, double texel);

}  // namespace tuft::decal
