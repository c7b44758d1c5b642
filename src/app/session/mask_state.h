#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "stroke/journal/mask.h"

namespace tuft::app {

class PaintThread;

/// The mask that is made next.
struct MaskChoice {
    stroke::MaskKind kind = stroke::MaskKind::angle;
    double within = 0.7853981634, soft = 0;  ///< radians
    bool through = false;                    ///< a lasso takes what lies behind too
    std::string group;
    int with = 0;  ///< the chosen mask: 0 as it is, 1 united with it, 2 only within it
};

struct MaskState {
    std::uint32_t active = 0;        ///< strokes stay within it; 0: none
    std::uint32_t veiled = 0;        ///< mask whose veil was requested
    std::uint32_t last_next_id = 0;  ///< `MaskTable::next_id` at the last look; 0: none yet
    MaskChoice choice;
    std::vector<Vec2> lasso;  ///< pixels, while it is drawn
};

/// Keeps strokes to a mask and veils what it leaves out; 0: none.
void choose_mask(MaskState& masks, PaintThread* work, std::uint32_t id);
/// Chooses a mask that was just made; one that is gone holds nothing back.
void follow_masks(MaskState& masks, PaintThread* work, const stroke::MaskTable& now);

}  // namespace tuft::app
