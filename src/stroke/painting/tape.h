#pragma once

#include <span>
#include <vector>

#include "footprint/footprint.h"
#include "mesh/surface_query.h"
#include "stroke/journal/trace.h"

/// Tape on the surface: a stroke goes over its edges, ink does not.
namespace tuft::stroke {

/// A straight piece of tape on the model; metres, model frame.
struct LaidPiece {
    Vec3 from{0}, to{0};
    Vec3 inward{0};  ///< unit, along the surface: towards what may be painted
};

/// The tape of a stroke on the model.
class LaidTape {
  public:
    LaidTape() = default;
    /// Lays the tape of a flat trace as its samples are laid (`lay`), in pieces of 1 mm, of more
    /// where that would be over 100,000. Pieces past the surface's edge are left out. Empty for
    /// traces in space.
    LaidTape(const mesh::SurfaceQuery& query, const Trace& trace);

    bool empty() const { return pieces_.empty(); }
    std::span<const LaidPiece> pieces() const { return pieces_; }

    /// Takes off a footprint's coverage what lies beyond the tape: of a cell with its centre at a
    /// distance d inside the part 1/2 + d / cell stays, kept to [0, 1]; where no tape crosses the
    /// footprint, all of it or nothing. The tape is seen along the frame's normal; what lies
    /// further from the frame's plane than the footprint is wide belongs to another side of the
    /// model.
    void cut_off(footprint::Footprint& footprint) const;

  private:
    void gather();
    std::vector<TapeEdge> seen_from(const footprint::Footprint& footprint, double reach) const;

    /// Pieces that follow each other, in a sphere.
    struct Run {
        std::uint32_t begin, end;
        Vec3 centre;
        double radius;
    };
    std::vector<LaidPiece> pieces_;
    std::vector<Run> runs_;
};

/// Metres from a place to the nearest edge, positive where one may paint; +∞ without edges. Where
/// two edges are equally near, which is off their common end, the one that the place is further
/// beside says on which side it lies: sharp corners, in and out.
double inside_tape(std::span<const TapeEdge> tape, const Vec2& place);

}  // namespace tuft::stroke
