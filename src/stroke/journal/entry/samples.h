#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// What a hand did during one stroke, before it meets a model. Pens, stroke files and projects make `StrokeSamples`;
/// placement/placement.h maps them onto a model.
namespace tuft::stroke {

/// How flat pen data is mapped onto the model (placement/placement.h).
enum class SurfaceMapping {
    wrap,     ///< along the triangles: straightest geodesics from the placement's origin
    drape,    ///< along the smoothed surface, without narrow grooves, bumps and gaps
    project,  ///< along the placement's normal: the first hit of a ray from outside
};

/// Returns "wrap", "drape" or "project".
std::string_view surface_mapping_name(SurfaceMapping mapping);
/// Returns the mapping of that name; nothing for another name.
std::optional<SurfaceMapping> surface_mapping_named(std::string_view name);

/// Position of flat pen data on a model, metres, model frame: its origin, near the surface, and the directions of its
/// x axis (to the right) and y axis (down, as pens and tablets report it), of any length but 0.
struct Placement {
    Vec3 origin{0};
    Vec3 right{1, 0, 0};
    Vec3 down{0, -1, 0};
    SurfaceMapping mapping = SurfaceMapping::wrap;

    bool operator==(const Placement&) const = default;
};

/// One sample of the hand.
struct StrokeSample {
    double time = 0;            ///< seconds since the start of the stroke
    Vec3 position{0};           ///< metres. Flat: x right, y down, z unused. In space: the ferrule's mouth, model frame
    double pressure = 0;        ///< flat: part of the brush's working depth, 0–1; 0: pen up
    Vec2 tilt{0};               ///< flat: lean of the holder towards +x and towards +y (down), radians
    double roll = 0;            ///< flat: of the ferrule about its own axis, radians, anticlockwise seen from the
                                ///< handle's end; 0: its broad side, x, is along +x
    Quat rotation{1, 0, 0, 0};  ///< in space: of the ferrule (`brush::Pose`)
};

inline constexpr double kMostRoll = 1e6;  ///< radians; whole turns that a device counts are retained

/// A straight part of a stencil's edge, metres, frame of flat samples. The part that may be painted lies towards
/// (from.y − to.y, to.x − from.x).
struct StencilEdge {
    Vec2 from{0}, to{0};

    bool operator==(const StencilEdge&) const = default;
};
inline constexpr std::size_t kMaxStencilEdges = 100'000;  ///< edges of one stroke

/// The samples of one stroke from pen down to pen up.
struct StrokeSamples {
    bool flat = true;                   ///< flat pen data with a placement; false: poses in space
    Placement placement;                ///< of flat samples
    bool placed = false;                ///< the file gives a placement; false: it is a default
    std::vector<StrokeSample> samples;  ///< in order of time; times may repeat
    bool pressed = true;                ///< the device measured pressure; false: it was made up
    double line_width = 0;              ///< metres, from a drawing; 0: not stated
    std::vector<StencilEdge> stencil;   ///< flat: hair leaves no ink beyond it, wet ink creeps under it; empty: no
                                        ///< stencil
    /// Of a line of a drawing until it is painted: rings that enclose, by the nonzero rule, what it covers with its
    /// ends and corners; metres, frame of the samples. Not stored.
    std::vector<std::vector<Vec2>> outline;
};

/// Throws `Error` for samples, a placement or a stencil that no hand can have made: numbers that are not finite, points
/// beyond `kFarthest`, times beyond three years, pressures, tilts and rolls out of range, rotations and directions of
/// length 0.
void check_samples(const StrokeSamples& stroke);

}  // namespace tuft::stroke
