#include "app/state/mask_state.h"

#include "app/paint/paint_thread.h"

namespace tuft::app {

void choose_mask(MaskState& masks, PaintThread* work, std::uint32_t id) {
    masks.active = id;
    if (masks.veiled == id || !work) return;
    masks.veiled = id;
    work->post(ShowMask{id});
}

void follow_masks(MaskState& masks, PaintThread* work, const stroke::MaskTable& now) {
    if (now.next_id > masks.last_next_id && masks.last_next_id > 0 && !now.masks.empty())
        choose_mask(masks, work, now.masks.back().id);
    else if (masks.active != 0 && !now.find(masks.active))
        choose_mask(masks, work, 0);
    masks.last_next_id = now.next_id;
}

}  // namespace tuft::app
