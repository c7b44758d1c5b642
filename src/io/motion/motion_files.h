#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "motion/trajectory.h"
#include "stroke/journal/recorded_stroke.h"

/// \file
/// Trajectories as files: a neutral list (JSON, CSV) and programs for robots and plotters. Called by `tuft trajectory`;
/// `io::read_strokes` reads JSON and CSV back.
namespace tuft::io {

/// A frame: position in metres and rotation.
struct MotionFrame {
    Vec3 position{0};
    Quat rotation{1, 0, 0, 0};
};

/// A trajectory and what it is painted with.
struct MotionProgram {
    motion::Trajectory trajectory;
    std::vector<stroke::RecordedStroke> strokes;  ///< [n_strokes] brush, ink, settings …; their samples are not used
    MotionFrame base;                             ///< of the model in the robot's base frame
    MotionFrame tool{{0, 0, 0.1}, {1, 0, 0, 0}};  ///< TCP in the flange frame
    motion::Limits limits;
    std::string title;  ///< see `program_title`
};

/// Returns where the TCP is for a pose of the ferrule, in the robot's base frame. The TCP's z axis points out of the
/// tool, along the hair; its x axis is the ferrule's.
MotionFrame tcp_of(const brush::Pose& pose, const MotionFrame& base);

/// Returns the name of a program in a file: the file's, as KUKA's controllers ask for, in the letters, digits and _
/// that all languages take, at most 24 of them. It is none of their words, in any case.
std::string program_title(const std::filesystem::path& file);

/// Writes a program; the extension chooses the form.
///
/// | extension | form | one point |
/// |---|---|---|
/// | .json | neutral list, read by `read_trajectory` | seconds, metres, quaternion, newtons; ferrule, model frame |
/// | .csv | the same as a table, read likewise; JSON in the first row of a stroke says what it is painted with | mm |
/// | .urscript, .script | URScript of Universal Robots | `movep` (strokes) and `movel`: m, rotation vector |
/// | .mod | RAPID of ABB | `MoveL` with `\T`: mm, quaternion |
/// | .src | KRL of KUKA | `LIN` with `$VEL.CP`: mm, degrees A B C about z, y, x |
/// | .gcode, .nc | G-code of a plotter over a flat sheet | `G1`: mm, mm/min, of the ferrule's mouth |
///
/// Where the hand rests the tool waits (`sleep`, `WaitTime`, `WAIT SEC`, `G4`). A way slower than 0.1 mm/s keeps its
/// time too: by `t`, `\T`, or, in KRL, by a wait at its end.
///
/// Throws `Error` for another extension, for G-code of strokes whose holder leans by more than 3°, and where the file
/// cannot be written.
void write_trajectory(const std::filesystem::path& path, const MotionProgram& program);
std::string trajectory_json(const MotionProgram& program);
std::string trajectory_csv(const MotionProgram& program);
std::string urscript_text(const MotionProgram& program);
std::string rapid_text(const MotionProgram& program);
std::string krl_text(const MotionProgram& program);
std::string gcode_text(const MotionProgram& program);
/// Whether `write_trajectory` writes a file of this name in G-code.
bool is_gcode(const std::filesystem::path& path);

/// Returns the strokes of a trajectory in JSON or CSV (by the extension), in space, with what they are painted with.
/// Their times are the hand's, which the file has beside the tool's: hair trails by its speed, and a tool that keeps
/// limits is slower. A file without them, or with the column `hand_s` taken out, is read on the tool's clock, and
/// paints what the tool would.
///
/// A table of another program, such as a robot's log, needs the columns t_s, x_mm, y_mm, z_mm, qw, qx, qy and qz, named
/// in its first row, in any order: the ferrule's mouth in the model's frame, hair along −z. With a column `kind` only
/// the rows that say "stroke" count, with a column `stroke` rows of one number are one stroke. Without `stroke_json`
/// brush, ink and settings are those of the command line.
///
/// Throws `Error` with the file, for JSON that `trajectory_json` cannot have written and a table that lacks a column or
/// a number.
std::vector<stroke::RecordedStroke> read_trajectory(const std::filesystem::path& path);
std::vector<stroke::RecordedStroke> parse_trajectory_csv(std::string_view text, const std::string& source);

}  // namespace tuft::io
