#pragma once

#include <span>
#include <vector>

#include "footprint/outline/footprint.h"
#include "mesh/query/surface_query.h"
#include "stroke/journal/entry/samples.h"

/// \file
/// The stencil of a stroke on the surface: the tuft passes its edges, ink does not. Called by `StrokeSession`.
namespace tuft::stroke {

/// A straight segment of a stencil's edge on the model; metres, model frame.
struct StencilSegment {
    Vec3 from{0}, to{0};
    Vec3 inward{0};  ///< unit, along the surface: towards the part that may be painted
};

/// The stencil of one stroke, mapped onto the model.
class SurfaceStencil {
  public:
    SurfaceStencil() = default;
    /// Maps the stencil of a flat trace like its samples (`map_to_surface`), in segments of 1 mm, longer ones where
    /// there would be more than 100,000. Segments past a border of the surface are left out. Empty for traces in space.
    SurfaceStencil(const mesh::SurfaceQuery& query, const StrokeSamples& trace);

    bool empty() const { return pieces_.empty(); }
    std::span<const StencilSegment> clusters() const { return pieces_; }

    /// Multiplies a footprint's coverage by clamp(1/2 + d / cell, 0, 1), with d the distance of a cell's centre inside
    /// the edge; by 0 or 1 where no edge crosses the footprint. The edge is projected along the frame's normal.
    /// Segments farther from the frame's plane than the footprint is wide belong to another side of the model and are
    /// ignored.
    void cut_off(footprint::Footprint& footprint) const;

  private:
    void find_clusters();
    std::vector<StencilEdge> seen_from(const footprint::Footprint& footprint, double reach) const;

    /// Consecutive segments and their bounding sphere.
    struct Run {
        std::uint32_t begin, end;
        Vec3 centre;
        double radius;
    };
    std::vector<StencilSegment> pieces_;
    std::vector<Run> runs_;
};

/// Returns the signed distance from a point to the nearest edge, metres, positive where it may be painted; +∞ without
/// edges. Of two equally near edges, which share the nearest end, the one with the larger distance to the side gives
/// the sign: so sharp corners, inner and outer, are right.
double inside_stencil(std::span<const StencilEdge> edges, const Vec2& point);

}  // namespace tuft::stroke
