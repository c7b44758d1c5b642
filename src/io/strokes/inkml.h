#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stroke/journal/recorded_stroke.h"

/// \file
/// Stroke files in InkML 1.0 (W3C Recommendation, 20 September 2011). Called by `cli` and by the studio. Any thread.
namespace tuft::io {

/// Options of `read_inkml`.
struct InkmlOptions {
    double metres_per_unit = 1e-3;  ///< of X, Y, Z where the file declares neither unit nor resolution
    double full_force = 1;          ///< newtons of F equal to pressure 1 where the file declares no maximum
    double pen_speed = 0.06;        ///< m/s, for traces without a time channel or sample rate
    double flat_pressure = 0.5;     ///< 0–1, mean of the default pressure, for traces without P and F
    double max_extent = 1000;       ///< metres; larger coordinates are refused
    std::size_t max_bytes = std::size_t{1} << 30;
    std::size_t max_samples = 10'000'000;
    bool actions = false;  ///< also returns traces without points, which hold brush actions only
    std::function<void(const Message&)> note = {};  ///< called with one line for each kind of skipped content
};

/// Reads the pen-down traces of a file, in order.
///
/// Supported: `traceFormat` with regular and intermittent channels, units, `min`, `max`, `default`, and resolution in
/// `channelProperty`; contexts, ink sources and brushes by reference or as the current ones; `traceGroup`; continued
/// traces; explicit values, first (') and second (") differences, `*` and `?`, booleans, hexadecimal numbers. Canvas
/// transforms are not supported.
///
/// Channels; others are skipped:
///
/// | channel | meaning |
/// |---|---|
/// | X, Y, Z | position, lengths |
/// | P, F | pressure; force in newtons |
/// | T | time, ms unless declared, from the start of the trace |
/// | OTx, OTy | tilt towards +x and +y, degrees unless declared rad |
/// | OA, OE | azimuth from +x towards +y, and elevation, degrees unless declared rad |
/// | OR | roll: rotation about the pen's own axis, anticlockwise seen from its end, degrees unless declared rad |
/// | QW, QX, QY, QZ | rotation of the ferrule, a unit quaternion (own channels) |
///
/// A trace with Z or a quaternion is in space. Any other is flat: its y points down and it needs a placement.
///
/// Own annotations are children of `ink`, `traceGroup`, `brush` or `trace`. Inner ones override outer ones:
///
/// | annotation | value |
/// |---|---|
/// | tuft:brush, tuft:ink | name of a preset |
/// | tuft:layer, tuft:mask | name of a layer; of a mask of the project |
/// | tuft:label | any text |
/// | tuft:seed | whole number |
/// | tuft:origin | "x y z", mm, model frame |
/// | tuft:right, tuft:down | "x y z", direction of the drawing's +x and +y |
/// | tuft:mapping | wrap, drape or project |
/// | tuft:stencil | edges, four numbers X Y X Y each, metres; ink stays to the right of each edge where Y points down |
/// | tuft:tool, tuft:on | brush or eraser; model or palette |
/// | tuft:settings | `stroke::json_of` a journal's settings |
/// | tuft:clock | kept: T is not shifted to start at 0 |
///
/// On a `trace` only, brush actions before the trace, in the order written: tuft:dip (an ink, or empty: the trace's
/// own), tuft:wipe, tuft:rinse, tuft:reshape, tuft:wash (of the palette), tuft:dry (seconds, or empty: until dry),
/// tuft:fill (an ink, or empty: the trace's own). A dip or wipe may have the numbers of stroke::Dip or stroke::Wipe as
/// attributes. A fill may have the attributes film, region (all, part, chart), at, gradient (none, along, round),
/// to_film, to_ink, from and to of stroke::Fill; points are "x y z" in mm, or in metres with a trailing m.
///
/// Flat traces without P and F get a pressure that rises at the start, falls at the end and falls with speed, taken
/// over 60 ms. P without a declared range is 0–1, or scaled by its largest value.
///
/// Throws `Error` with file and line where the file is not well formed or no InkML, has no traces, has a value that is
/// no finite number, a point with too few values, a dangling reference, or exceeds a limit.
std::vector<stroke::RecordedStroke> read_inkml(const std::filesystem::path& path, const InkmlOptions& options = {});

/// Parses InkML text as `read_inkml` does. `source` names it in errors.
std::vector<stroke::RecordedStroke> parse_inkml(std::string_view text, const std::string& source,
                                                const InkmlOptions& options = {});

/// Precision of written numbers.
enum class Digits {
    /// Metres, seconds, radians, each number with the fewest digits that restore every bit. As the reader returns them:
    /// directions and rotations of unit length to 1e-14, tilts within 85 degrees, pressures within 0–1.
    exact,
    /// Millimetres, milliseconds, degrees, for people. Errors at most: positions 1e-9 m (flat: 5e-7 m), times 1e-6 s,
    /// pressures 1e-5, tilts and rolls 1e-4 rad, rotations 1e-9.
    rounded,
};

/// Returns InkML text with explicit values. Traces with the same placement, brush, ink and settings form a
/// `traceGroup`.
std::string inkml_text(std::span<const stroke::RecordedStroke> traces, const std::string& title = {},
                       Digits digits = Digits::exact);

/// Writes the text of `inkml_text` atomically. Throws `Error`.
void write_inkml(const std::filesystem::path& path, std::span<const stroke::RecordedStroke> traces,
                 const std::string& title = {}, Digits digits = Digits::exact);

}  // namespace tuft::io
