#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"

/// \file
/// Sweep of one brush over a flat sheet: line width and contact length at each depth. Called by `tuft brush`, by the
/// fit to a measured sweep (calibrate.h), by the tip lag compensation of `stroke` and by the studio.
namespace tuft::brush {

/// One row of a sweep: a steady straight stroke with an upright holder. Lengths in metres. A column that a table does
/// not have is NaN.
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
/// forward drags its hair; a holder tilted back pushes it ahead. `roll`: radians, of the ferrule's x from the path,
/// anticlockwise about the holder's axis, as turned with the sheet's normal by the smallest rotation to up; at π/2 its
/// broad side is across. Cost: about 4 ms; of a fan 0.25 s.
LinePlace line_place(const Preset& preset, double depth, const Vec2& lean, double roll = 0);

/// Returns CSV text with the columns z_mm,width_mm,drag_mm,offset_mm.
std::string sweep_csv(std::span<const SweepRow> rows);

/// Reads a measured table: z_mm and at least one more of the columns of `sweep_csv`, found by name. A column that the
/// table does not have is NaN in all rows. Skips lines with # and rows whose column `excluded_by_authors` is not 0.
/// Throws `Error` with file and line.
std::vector<SweepRow> read_sweep(const std::string& path);

/// Returns the hair length, metres, from a comment "length NUMBER mm" of the table. Empty without such a comment.
std::optional<double> stated_length(const std::string& path);

}  // namespace tuft::brush
