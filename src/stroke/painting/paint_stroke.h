#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "stroke/painting/painted_model.h"
#include "stroke/painting/path_ahead.h"
#include "stroke/placement/placement.h"
#include "stroke/session/session.h"

/// \file
/// One stroke of the journal: its brush is taken up, led over the model by a session, and put down. `Document` calls
/// this for strokes one after the other, `StrokeBatch` for strokes side by side.
namespace tuft::stroke {

/// Throws `Error` for a stroke of the model that is too large: its brush is too wide for the texels, or its path is at
/// least twice the longest that is painted. Paints nothing and maps nothing to the surface.
void check_size(const PaintedModel& painted, const JournalEntry& entry);

/// Returns how a stroke takes its brush up.
BrushStart brush_start(PaintedModel& painted, const PaintStroke& stroke);
/// Returns the brush as the stroke begins with it. Safe beside others while no brush is put down.
BrushInHand take_up(const PaintedModel& painted, const PaintStroke& stroke, const BrushStart& start);
/// Returns what a session begins with, but for the brush and its ink. `plan`: tiles that the stroke may use; null: all,
/// and with them the links over the seams.
SessionInput session_input(PaintedModel& painted, PaintStroke stroke, const TilePlan* plan);
/// Returns the session of a stroke, with its brush.
std::unique_ptr<StrokeSession> make_session(PaintedModel& painted, PaintStroke stroke);
/// Puts the brush of a finished stroke down and records what it changed. `n_pigments`: that the document has met with
/// it.
StrokeReport put_down(PaintedModel& painted, std::uint64_t id, const PaintStroke& stroke, SessionResult result,
                      std::size_t n_pigments);

/// Returns how the holder of a stroke of the model is led.
HolderOptions holder_of(PaintedModel& painted, const PaintStroke& stroke);
/// Returns the path of a stroke's ferrule. Throws `Error` for a stroke without samples.
HandPath path_of(PaintedModel& painted, const PaintStroke& stroke);
/// Begins to compute the path of an entry whose turn comes next; null where it has none.
std::unique_ptr<PathAhead> plan_path_ahead(PaintedModel& painted, const JournalEntry& entry);

/// Readies a session for the poses of a path. Throws `Error` as `StrokeSession::check_length` does.
void begin_path(StrokeSession& session, const HandPath& path, const ProgressFn& progress);
/// Paints the poses [from, to) of a path.
void paint_poses(StrokeSession& session, std::span<const brush::Pose> poses, std::size_t from, std::size_t to);
/// Fills in how deep within the model a flat stroke was placed.
void note_origin(StrokeReport& report, const PaintStroke& stroke, const mesh::SurfaceQuery& surface);

}  // namespace tuft::stroke
