#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stroke/journal/recorded_stroke.h"

/// Stroke files: InkML 1.0 (W3C Recommendation, 20 September 2011).
namespace tuft::io {

struct InkmlOptions {
    double metres_per_unit = 1e-3;  ///< of X, Y, Z where the file declares neither unit nor resolution
    double flat_width = 0;          ///< metres: scales all flat traces together to this width; 0: as written
    double full_force = 1;          ///< newtons of F that count as pressure 1 where no maximum is declared
    double pen_speed = 0.06;        ///< m/s, for traces without a time channel or sample rate
    double flat_pressure = 0.5;     ///< middle of the default pressure, for traces without P and F
    double max_extent = 1000;       ///< metres; coordinates beyond are refused
    std::size_t max_bytes = std::size_t{1} << 30;
    std::size_t max_samples = 10'000'000;
    bool actions = false;  ///< keeps traces without points that say what is done with a brush
    std::function<void(const std::string&)> note = {};  ///< takes one line on what of the file is left out
};

/// The pen-down traces of a file, in order.
///
/// Understood: `traceFormat` with regular and intermittent channels, units, `min`, `max`,
/// `default`, and `channelProperty` resolution; contexts, ink sources, brushes and
/// canvas-free definitions by reference or as the current ones; `traceGroup`s; continued
/// traces; explicit values, first (') and second (") differences, `*` and `?`, booleans and
/// hexadecimal numbers. Channels: X, Y, Z (lengths); P, or F in newtons; T (ms unless
/// declared, rebased to the start of the trace); OTx and OTy (tilt towards +x and +y),
/// or OA and OE (azimuth from +x towards +y, elevation), and OR (rotation about
/// the pen's own axis, anticlockwise seen from its end: the roll), in degrees unless declared rad;
/// QW, QX, QY, QZ: rotation of the ferrule (own channels). Others are skipped.
///
/// A trace is in space when it has Z or a quaternion, else flat: then `y` grows downwards
/// and it needs a placement. Own names, as `annotation` children of `ink`, `traceGroup`,
/// `brush` or `trace`, inner ones overriding outer ones:
///
///     tuft:brush    preset name          tuft:origin  "x y z" in mm, model frame
///     tuft:ink      preset name          tuft:right   "x y z" direction of +x
///     tuft:seed     whole number         tuft:down    "x y z" direction of +y
///     tuft:label    any text             tuft:mapping wrap | project
///     tuft:mask     name of a mask that the project has
///     tuft:stencil edge     edges that no ink of a trace gets over: X Y X Y each, metres, what may be painted to the
///     right of
///                   their way where Y points down
///     tuft:layer    name of a layer      tuft:tool    brush | eraser
///     tuft:on       model | palette      tuft:settings  stroke::to_json of a journal's settings
///     tuft:clock    kept: T is not rebased
///
/// and, on a `trace` only, what is done with the brush before it, in the order written:
/// tuft:dip (an ink's name, or empty: the trace's own), tuft:wipe, tuft:rinse,
/// tuft:reshape, tuft:wash (of the palette), tuft:dry (seconds, or empty: until all is dry), tuft:fill (an ink's name,
/// or empty: the trace's own) with the attributes film, region (all, part, chart), at, gradient (none, along, round),
/// to_film, to_ink, from, to: see stroke::Fill, points "x y z" in mm, or followed by m in metres. A dip or wipe may
/// have attributes depth and amount, 0–1, and side, -1–1: see stroke::Extent.
///
/// Flat traces without P and F get pressure that swells in and tapers out over their length
/// and falls with speed; P without a declared range is 0–1, or scaled by its largest value.
///
/// Throws `Error` with file and line: not well formed, not InkML, no traces, a value that is
/// no finite number, too few values in a point, a reference to nothing, absurd sizes.
std::vector<stroke::RecordedStroke> read_inkml(const std::filesystem::path& path, const InkmlOptions& options = {});

/// The same from text; `source` names it in errors.
std::vector<stroke::RecordedStroke> parse_inkml(std::string_view text, const std::string& source,
                                                const InkmlOptions& options = {});

/// How many digits are written.
enum class Digits {
    exact,    ///< metres, seconds, radians, each number with the fewest digits that give it back to the
              ///< bit; directions and rotations must be of unit length to 1e-14, tilts within 85
              ///< degrees and pressures within 0–1, as the reader has them
    rounded,  ///< for people: millimetres, milliseconds, degrees. Positions agree to 1e-9 m (flat:
              ///< 5e-7 m), times to 1e-6 s, pressures to 1e-5, tilts and rolls to 1e-4 rad, rotations to 1e-9
};

/// InkML text with explicit values: traces that share a placement, brush, ink and settings form
/// a `traceGroup`.
std::string inkml_text(std::span<const stroke::RecordedStroke> traces, const std::string& title = {},
                       Digits digits = Digits::exact);

/// Writes the text atomically.
void write_inkml(const std::filesystem::path& path, std::span<const stroke::RecordedStroke> traces,
                 const std::string& title = {}, Digits digits = Digits::exact);

}  // namespace tuft::io
