#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "stroke/journal/entry/mask.h"

/// \file
/// The active mask and the next mask. Window thread.
namespace tuft::app {

class PaintThread;

/// Settings of the next mask.
struct MaskChoice {
    stroke::MaskKind kind = stroke::MaskKind::angle;
    double within = 0.7853981634, soft = 0;  ///< radians, angle and its soft range
    bool through = false;                    ///< a lasso also selects occluded surfaces
    std::string group;
    int with = 0;  ///< the active mask: 0 ignored, 1 united, 2 intersected
};

/// The active mask and the lasso.
struct MaskState {
    std::uint32_t active = 0;        ///< restricts strokes; 0: none
    std::uint32_t veiled = 0;        ///< mask whose outside was requested to be dimmed
    std::uint32_t last_next_id = 0;  ///< `MaskTable::next_id` at the last update; 0: none yet
    MaskChoice choice;
    std::vector<Vec2> lasso;  ///< pixels, being drawn
};

/// Restricts strokes to a mask and dims the surface outside it; 0: none.
void choose_mask(MaskState& masks, PaintThread* work, std::uint32_t id);
/// Activates a mask that was just created, and deactivates one that was removed.
void follow_masks(MaskState& masks, PaintThread* work, const stroke::MaskTable& now);

}  // namespace tuft::app
