#pragma once

#include "core/system/work_ahead.h"
#include "stroke/journal/entry/entry.h"
#include "stroke/placement/placement.h"

/// \file
/// The path of a flat stroke, computed by another thread while the stroke before it is painted. Called by `Document`
/// for strokes that are painted one after the other.
namespace tuft::stroke {

/// Path of one stroke of the model.
class PathAhead {
  public:
    /// Begins at once. `query` and what `holder` refers to must outlive it.
    PathAhead(const PaintStroke& stroke, HolderOptions holder, const mesh::SurfaceQuery& query);

    /// Returns the path, once it is computed. Throws what `hand_path` threw. Once.
    HandPath take();

  private:
    StrokeSamples trace_;
    StrokeSettings settings_;
    HolderOptions holder_;
    const mesh::SurfaceQuery& query_;
    HandPath path_;
    WorkAhead work_;  // uses the others
};

}  // namespace tuft::stroke
