#pragma once

#include <cstdint>
#include <vector>

#include "brush/tuft/tuft.h"

/// The tuft's surface as plain triangles, to draw it and to bound it.
namespace tuft::brush {

struct TuftSurfaceOptions {
    int points_per_ring = 24;
    int rings_between_nodes = 2;  ///< spline-interpolated rings added between two sections
};

struct TuftSurface {
    std::vector<Vec3> positions;           ///< metres, world
    std::vector<Vec3> normals;             ///< unit, outward, one per position
    std::vector<std::uint32_t> triangles;  ///< 3 indices each, counter-clockwise from outside
    int points_per_ring = 0;               ///< ring k holds positions [k * p, (k+1) * p), root first
    int rings = 0;                         ///< of all branches; the tip of each closes with one point
};

/// Rings of ellipses along Catmull–Rom splines through the sections of every branch.
TuftSurface make_tuft_surface(const TuftState& state, const TuftSurfaceOptions& options = {});

/// Sections of one branch, resampled with `between` more sections in every gap by a
/// cubic spline (centres, axes, semi-axes, moment, pressure), tip first.
std::vector<Section> refine_sections(const std::vector<Section>& sections, int between);

}  // namespace tuft::brush
