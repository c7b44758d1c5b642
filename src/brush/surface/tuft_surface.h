#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "brush/tuft/tuft.h"
#include "core/system/recycled.h"

/// \file
/// The tuft's surface as triangles. `render`, `app` and the calibration draw it or bound it.
namespace tuft::brush {

/// Fineness of the triangles.
struct TuftSurfaceOptions {
    int points_per_ring = 24;
    int rings_between_nodes = 2;  ///< spline-interpolated rings added between two sections
};

/// Triangles of the bent tuft.
struct TuftSurface {
    std::vector<Vec3> positions;           ///< metres, world
    std::vector<Vec3> normals;             ///< unit, outward, one per position
    std::vector<std::uint32_t> triangles;  ///< 3 indices each, counter-clockwise from outside
    int points_per_ring = 0;               ///< ring k holds positions [k * p, (k+1) * p), root first
    int rings = 0;                         ///< of all branches; the tip of each closes with one point
};

/// Returns the carried shape of a tuft that has one, without rings: its mesh, or its hairs as thin tubes. Of others:
/// rings of ellipses along Catmull–Rom splines through the sections of every branch. Between joined spines of a
/// wide ferrule strips above and below close the surface; their positions follow those of the rings.
TuftSurface make_tuft_surface(const TuftState& state, const TuftSurfaceOptions& options = {});

/// Returns the sections of one branch with `between` more in every gap, tip first. Centres, axes, semi-axes, moment
/// and pressure are interpolated by a cubic spline.
Recycled<Section> refine_sections(std::span<const Section> sections, int between);

}  // namespace tuft::brush
