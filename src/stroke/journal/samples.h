#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// What a hand did during one stroke, before it meets a model.
namespace tuft::stroke {

/// How flat pen data gets onto the model.
enum class SurfaceMapping {
    wrap,     ///< along the surface: (x, y) is walked as a geodesic from the placement's origin
    drape,    ///< the same on the surface without its narrow grooves, bumps and gaps
    project,  ///< along the placement's normal: first surface met by a ray from outside
};

/// "wrap", "drape", "project", and back; nothing for another name.
std::string_view surface_mapping_name(SurfaceMapping mapping);
std::optional<SurfaceMapping> surface_mapping_named(std::string_view name);

/// Where flat pen data lies: its origin near the surface and the direction of its
/// x (to the right) and y axis (down, as pens and tablets give it), metres, model frame.
struct Placement {
    Vec3 origin{0};
    Vec3 right{1, 0, 0};
    Vec3 down{0, -1, 0};
    SurfaceMapping mapping = SurfaceMapping::wrap;
};

/// One sample of the hand.
struct StrokeSample {
    double time = 0;            ///< seconds since the start of the stroke
    Vec3 position{0};           ///< metres. Flat: x right, y down, z unused.
                                ///< Spatial: the ferrule's mouth, model frame
    double pressure = 0;        ///< flat: 0–1 of the brush's working depth; 0 lifts off
    Vec2 tilt{0};               ///< flat: lean of the holder, radians: towards +x, towards +y (down)
    double roll = 0;            ///< flat: of the ferrule about its own axis, radians, anticlockwise seen from the
                                ///< handle's end; 0: its broad side, x, lies along +x
    Quat rotation{1, 0, 0, 0};  ///< spatial: of the ferrule (see brush::Pose)
};

inline constexpr double kMostRoll = 1e6;  ///< radians; devices that count turns are kept

/// Part of a line of stencil edge stuck on the surface, in the frame of flat samples, metres. What may be painted lies
/// to the side of `inward`, (from.y − to.y, to.x − from.x).
struct StencilEdge {
    Vec2 from{0}, to{0};

    bool operator==(const StencilEdge&) const = default;
};
inline constexpr std::size_t kMaxStencilEdges = 100'000;  ///< edges of one stroke

/// The samples of one stroke from pen down to pen up.
struct StrokeSamples {
    bool flat = true;                   ///< flat pen data with a placement, or poses in space
    Placement placement;                ///< of flat samples
    bool placed = false;                ///< the file says where; else the placement is only a default
    std::vector<StrokeSample> samples;  ///< time never falls
    bool pressed = true;                ///< false: pressures were made up, the device gave none
    double line_width = 0;              ///< metres, as a drawing has it; 0: it says nothing
    std::vector<StencilEdge> stencil;   ///< flat: the hair lays no ink over it, wet ink creeps under; none: it may
                                        ///< go anywhere
};

/// Throws `Error` for samples, a placement or stencil edge that no hand can have made: numbers that are not finite,
/// places beyond `kFarthest`, times beyond three years, pressures, tilts and rolls out of range, rotations and
/// directions that are none.
void check_samples(const StrokeSamples& stroke);

}  // namespace tuft::stroke
