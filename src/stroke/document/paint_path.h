#pragma once

#include "stroke/placement/placement.h"
#include "stroke/session/session.h"

/// \file
/// One stroke of the journal through a session. `Document` calls it for strokes one after the other and side by side.
namespace tuft::stroke {

/// Readies a session for the poses of a path. Throws `Error` as `StrokeSession::check_length` does.
void begin_path(StrokeSession& session, const HandPath& path, const ProgressFn& progress);

/// Paints the poses [from, to) of a path.
void paint_poses(StrokeSession& session, std::span<const brush::Pose> poses, std::size_t from, std::size_t to);

/// Fills in how deep within the model a flat stroke was placed.
void note_origin(StrokeReport& report, const PaintStroke& stroke, const mesh::SurfaceQuery& surface);

}  // namespace tuft::stroke
