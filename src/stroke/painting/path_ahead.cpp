#include "stroke/painting/path_ahead.h"

#include <utility>

#include "stroke/gesture/hand.h"

namespace tuft::stroke {

PathAhead::PathAhead(const PaintStroke& stroke, HolderOptions holder, const mesh::SurfaceQuery& query)
    : trace_(stroke.trace),
      settings_(stroke.settings),
      holder_(std::move(holder)),
      query_(query),
      work_(1, 1, [this](std::size_t) { path_ = hand_path(query_, steady(trace_, settings_), holder_); }) {
    work_.begin();
}

HandPath PathAhead::take() {
    work_.wait(0);
    return std::move(path_);
}

}  // namespace tuft::stroke
