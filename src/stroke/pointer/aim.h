#pragma once

#include <optional>

#include "core/geometry/ray.h"
#include "mesh/query/surface_query.h"

/// \file
/// What a cursor aims at. Called by pointer_input.h and by the tools of the window.
namespace tuft::stroke {

/// Where the cursor points at one time.
struct Aim {
    Ray ray;
    Vec3 view_right{1, 0, 0}, view_up{0, 0, 1};  ///< unit, of the camera
    double metres_per_pixel = 1e-4;              ///< at the model
    double time = 0;                             ///< seconds
    double pressure = -1;                        ///< 0–1 of a pen; negative: none
    std::optional<Vec2> tilt;                    ///< of a pen, as `PointerSettings::tilt`
    double turn = 0;                             ///< radians, rotation of a pen about its axis, clockwise from above
    Vec4f section{0};                            ///< cut plane; hidden parts of the model are not hit
};

/// Surface point that an aim hits.
struct AimedSurface {
    Vec3 position{0};      ///< metres
    Vec3 normal{0, 0, 1};  ///< unit, towards the eye, levelled as far as the holder does (`HolderOptions::steady`)
    double distance = 0;   ///< metres from the eye
    bool bridged = false;  ///< over a gap or groove
    bool back = false;     ///< the surface shows its back there
    bool inside = false;   ///< it does so to the inside of a body: it is seen through a hole
};

/// Returns the first surface point on the aim's ray that its section does not hide.
std::optional<mesh::SurfacePoint> aim_at(const mesh::SurfaceQuery& surface, const Aim& aim);

/// Whether an aim hits the back of a surface from inside of a body, through a hole: nothing is set down there. The back
/// of an open sheet is none. Cost: 64 rays.
bool is_through_a_hole(const mesh::SurfaceQuery& surface, const mesh::SurfacePoint& hit, const Aim& aim);

/// The surface as a hand with a brush follows it: over gaps, and level on a lip. By the rays round one aim, since a
/// hand in motion has no path ahead of it as `level_surface` (placement/levelling.h) needs.
class LevelledView {
  public:
    /// `reach`: metres round an aim in which gaps are bridged; `steady`: radius that a holder levels, metres.
    LevelledView(const mesh::SurfaceQuery& surface, double reach, double steady)
        : surface_(surface), reach_(reach), steady_(steady) {}

    /// Returns the surface that the aim hits. Over a gap narrower than twice the reach it is the surface on both sides,
    /// found by pairs of rays on opposite sides of the aim. On a plane their mean depth is that of the aim. Cost: 24
    /// rays for gaps, 48 for the normal.
    std::optional<AimedSurface> find(const Aim& aim) const;
    /// Returns the normal at a hit of the aim, unit, towards the eye. On a lip a few millimetres wide it is that of the
    /// wall beside it: the mean over what is seen of the surface within `steady`, where the surface's own is far from
    /// it. On the wall it is the surface's own, with the lip in that radius or without.
    Vec3 normal(const Aim& aim, const mesh::SurfacePoint& hit) const;

  private:
    std::optional<AimedSurface> find_gap(const Aim& aim, double centre) const;

    const mesh::SurfaceQuery& surface_;
    double reach_, steady_;
};

inline constexpr double kSlanting = 0.35;  ///< cosine to the line of sight under which a gap and an edge look alike
/// Radii of levelling round an aim, in which a place belongs to the surface that a holder levels.
inline constexpr double kSameSurface = 1.5;

}  // namespace tuft::stroke
