#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stroke/journal/fill.h"

/// Strokes as a device or a file gives them, before they meet a model.
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
struct TraceSample {
    double time = 0;            ///< seconds since the start of the trace
    Vec3 position{0};           ///< metres. Flat: x right, y down, z unused.
                                ///< Spatial: the ferrule's mouth, model frame
    double pressure = 0;        ///< flat: 0–1 of the brush's working depth; 0 lifts off
    Vec2 tilt{0};               ///< flat: lean of the holder, radians: towards +x, towards +y (down)
    Quat rotation{1, 0, 0, 0};  ///< spatial: of the ferrule (see brush::Pose)
};

/// What a hand does with a brush.
enum class Action {
    stroke,   ///< paints
    dip,      ///< fills the tuft up with ink; what is in it stays and mixes
    rinse,    ///< washes it: no ink left, hair straight and together
    reshape,  ///< combs it: hair straight and together, ink stays
    dry,      ///< waits while the ink on the model flows and dries
    layer,    ///< changes the table of layers; no brush has a part in it
    mask,     ///< changes the table of masks; likewise
    fill,     ///< lays ink over a whole part of the model; likewise
    wipe,     ///< draws it over a rag: part of its ink goes
    wash,     ///< washes the palette clean
};

/// How far a brush is dipped, or wiped.
struct Extent {
    double depth = 1;   ///< part of the tuft's length, from the tip, 0–1
    double amount = 1;  ///< dip: part of its room up to which hair is filled, 0–1.5, above 1 dripping wet:
                        ///< the rest runs down onto what wet ink touches; wipe: part of its ink that goes, 0–1
    double side = 0;    ///< part of the tuft's width, from the right flank (> 0) or the left one (< 0), −1–1;
                        ///< 0: all of it. Right is the side of the ferrule's +x, of the stroke's right hand
                        ///< edge where that is drawn away from the hand

    bool operator==(const Extent&) const = default;
};

/// Something done with the brush between two strokes.
struct BrushAction {
    Action action = Action::dip;
    std::string ink;     ///< to dip into; empty: the ink of the stroke after it
    double seconds = 0;  ///< to dry for; 0: until all is dry
    Fill fill = {};
    Extent extent = {};
};

/// A care in words, "ACTION[:INK][,depth=PART][,amount=PART][,side=PART]": "dip:cinnabar,depth=0.2",
/// "wipe,amount=0.6"; and back, throwing `Error` for anything else.
std::string action_text(const BrushAction& care);
BrushAction action_of_text(const std::string& text);

/// Part of a line of stencil edge stuck on the surface, in the frame of a flat trace, metres. What may be painted lies
/// to the side of `inward`, (from.y − to.y, to.x − from.x).
struct StencilEdge {
    Vec2 from{0}, to{0};

    bool operator==(const StencilEdge&) const = default;
};
inline constexpr std::size_t kMaxStencilEdges = 100'000;  ///< edges of one stroke

/// One stroke from touch to lift.
struct Trace {
    bool flat = true;                  ///< flat pen data with a placement, or poses in space
    Placement placement;               ///< for flat traces
    bool placed = false;               ///< the file says where; else the placement is only a default
    std::vector<TraceSample> samples;  ///< time never falls
    std::string brush, ink;            ///< preset names; empty: as the command line says
    bool on_palette = false;           ///< belongs on the palette, in its frame (palette.h)
    bool erases = false;               ///< takes ink away, wet and dry, where it would leave some
    std::string mask;                  ///< name of the mask it keeps to; empty: as the command line says
    std::string layer;                 ///< name of the layer; empty: as the command line says
    std::uint64_t seed = 0;
    std::string label;      ///< free text for people: a character, a stroke's name
    bool pressed = true;    ///< false: pressures were made up, the device gave none
    double line_width = 0;  ///< metres, as a drawing has it; 0: it says nothing
    std::vector<StencilEdge>
        stencil;  ///< flat: the hair lays no ink over it, wet ink creeps under; none: it may go anywhere
    std::vector<BrushAction> before;  ///< what a file wants done with the brush first
    std::string settings;             ///< as a file wants them, see `to_json` in journal.h; empty: as
                                      ///< the command line says
};

}  // namespace tuft::stroke
