#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"
#include "core/system/progress.h"

/// What one brush leaves on a flat sheet at each depth, and the fit of a preset to
/// measurements of it.
namespace tuft::brush {

/// Steady straight stroke, holder upright. Lengths in metres.
struct SweepRow {
    double depth = 0;   ///< of the ferrule below the height where the tip first touches
    double width = 0;   ///< of the line left behind
    double drag = 0;    ///< length of the contact patch along the stroke
    double offset = 0;  ///< end of the patch nearer to the root, behind the foot of the holder's axis
};

/// Drags each depth until steady (at most three hair lengths). Depths in metres.
std::vector<SweepRow> sweep_depth(const Preset& preset, std::span<const double> depths);

/// Where the line of a steady straight stroke along +x over the sheet z = 0 lies, seen from the foot
/// of the unbent tip, metres.
struct LinePlace {
    double behind = 0;  ///< mean of the two places where the patch is widest
    double aside = 0;   ///< middle of the line, to the left (+y)
};

/// The same for a holder that leans: up ∝ (tan lean.x, tan lean.y, 1), radians. A holder that leans
/// ahead pulls its hair behind it, one that leans back pushes it ahead. About 4 ms.
LinePlace line_place(const Preset& preset, double depth, const Vec2& lean);

/// CSV text with the columns z_mm,width_mm,drag_mm,offset_mm.
std::string sweep_csv(std::span<const SweepRow> rows);

/// Reads a measured table: columns by name as in `sweep_csv`, lines with # ignored, rows whose
/// column `excluded_by_authors` is not 0 skipped. Throws `Error` with file and line.
std::vector<SweepRow> read_sweep(const std::string& path);

/// Hair length in metres that a comment of the table states as "length NUMBER mm"; nothing else.
std::optional<double> stated_length(const std::string& path);

struct CalibrateOptions {
    SweepRow repeatability{0, 1.4e-3, 0.5e-3, 0.7e-3};  ///< one standard deviation of each column
    int max_evaluations = 1200;
    ProgressFn progress;
};

struct Calibration {
    Preset preset;
    SweepRow rms;     ///< root mean square residual of each column (depth unused)
    double cost = 0;  ///< twelfth-power mean of the columns' rms over repeatability
    int evaluations = 0;
};

/// Fits radius, taper, stiffness along the hair, side stiffness, flattening, friction and wet film
/// of `start`, whose hair length must be the measured brush's: least squares from several
/// beginnings, then a simplex search on the worst column. Deterministic. About 20 ms per evaluation.
Calibration calibrate(const Preset& start, std::span<const SweepRow> measured, const CalibrateOptions& options = {});

}  // namespace tuft::brush
