#pragma once

#include <span>
#include <vector>

#include "footprint/outline/footprint.h"
#include "mesh/query/surface_query.h"
#include "stroke/journal/trace.h"

/// Tape on the surface: a stroke goes over its edges, ink does not.
namespace tuft::stroke {

/// A straight cluster of stencil edge on the model; metres, model frame.
struct StencilSegment {
    Vec3 from{0}, to{0};
    Vec3 inward{0};  ///< unit, along the surface: towards what may be painted
};

/// The stencil edge of a stroke on the model.
class SurfaceStencil {
  public:
    SurfaceStencil() = default;
    /// Lays the stencil edge of a flat trace as its samples are laid (`lay`), in clusters of 1 mm, of more
    /// where that would be over 100,000. Pieces past the surface's edge are left out. Empty for
    /// traces in space.
    SurfaceStencil(const mesh::SurfaceQuery& query, const Trace& trace);

    bool empty() const { return pieces_.empty(); }
    std::span<const StencilSegment> clusters() const { return pieces_; }

    /// Takes off a footprint's coverage what lies beyond the stencil edge: of a cell with its centre at a
    /// distance d inside the part 1/2 + d / cell stays, kept to [0, 1]; where no stencil edge crosses the
    /// footprint, all of it or nothing. The stencil edge is seen along the frame's normal; what lies
    /// further from the frame's plane than the footprint is wide belongs to another side of the
    /// model.
    void cut_off(footprint::Footprint& footprint) const;

  private:
    void gather();
    std::vector<StencilEdge> seen_from(const footprint::Footprint& footprint, double reach) const;

    /// Pieces that follow each other, in a sphere.
    struct Run {
        std::uint32_t begin, end;
        Vec3 centre;
        double radius;
    };
    std::vector<StencilSegment> pieces_;
    std::vector<Run> runs_;
};

/// Metres from a place to the nearest edge, positive where one may paint; +∞ without edges. Where
/// two edges are equally near, which is off their common end, the one that the place is further
/// beside says on which side it lies: sharp corners, in and out.
double inside_stencil(std::span<const StencilEdge> tape, const Vec2& place);

}  // namespace tuft::stroke
