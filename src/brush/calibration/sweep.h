#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"
#include "core/system/progress.h"

/// \file
/// Sweep of one brush over a flat sheet: line width and contact length at each depth, and the fit of a preset to a
/// measured sweep. Called by `tuft brush`, by the tip lag compensation of `stroke` and by the studio.
namespace tuft::brush {

/// One row of a sweep: a steady straight stroke with an upright holder. Lengths in metres.
struct SweepRow {
    double depth = 0;   ///< of the ferrule below the height where the tip first touches
    double width = 0;   ///< of the painted line
    double drag = 0;    ///< length of the contact patch along the stroke
    double offset = 0;  ///< distance of the patch's root-side end behind the foot of the holder's axis
};

/// The measured columns.
inline constexpr double SweepRow::*kSweepColumns[] = {&SweepRow::width, &SweepRow::drag, &SweepRow::offset};

/// A steady stroke along +x at one depth.
struct SteadyTuft {
    SweepRow row;
    std::vector<Vec2> spine;  ///< nodes, tip first: metres ahead of the axis' foot, metres over the sheet
};
SteadyTuft sweep_at(const Preset& preset, double depth);

/// Computes one row per depth (metres). Each drag lasts until it is steady, at most three hair lengths.
std::vector<SweepRow> sweep_depth(const Preset& preset, std::span<const double> depths);

/// Position of the line of a steady straight stroke along +x over the sheet z = 0, relative to the foot of the
/// unbent tip, metres.
struct LinePlace {
    double behind = 0;  ///< distance behind: mean of the two widest places of the patch
    double aside = 0;   ///< middle of the line, to the left (+y)
};

/// Computes the line's position for a tilted holder: up ∝ (tan lean.x, tan lean.y, 1), radians. A holder tilted
/// forward drags its hair; a holder tilted back pushes it ahead. Cost: about 4 ms.
LinePlace line_place(const Preset& preset, double depth, const Vec2& lean);

/// Returns CSV text with the columns z_mm,width_mm,drag_mm,offset_mm.
std::string sweep_csv(std::span<const SweepRow> rows);

/// Reads a measured table with the columns of `sweep_csv`, found by name. Skips lines with # and rows whose column
/// `excluded_by_authors` is not 0. Throws `Error` with file and line.
std::vector<SweepRow> read_sweep(const std::string& path);

/// Returns the hair length, metres, from a comment "length NUMBER mm" of the table. Empty without such a comment.
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

/// Fits radius, taper, stiffness along the hair, side stiffness, flattening, friction and wet film of `start`.
/// Precondition: the hair length of `start` is that of the measured brush. Method: least squares from several
/// starts, then a simplex search on the worst column. Deterministic. Cost: about 20 ms per evaluation.
Calibration calibrate(const Preset& start, std::span<const SweepRow> measured, const CalibrateOptions& options = {});

}  // namespace tuft::brush
