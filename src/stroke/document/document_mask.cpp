#include "stroke/document/document.h"

/// What a painting does with its masks.
namespace tuft::stroke {

const MaskTexels& Document::mask(std::uint32_t id) {
    const Mask* mask = masks_.find(id);
    if (!mask) throw Error(Message("there is no mask {}", id));
    const auto found = mask_texels_.find(id);
    if (found != mask_texels_.end()) return found->second;
    return mask_texels_.emplace(id, evaluate(*mask, masks_, *model_)).first->second;
}

void Document::edit_masks(std::uint64_t entry_id, const MaskEdit& edit) {
    MaskTable table = masks_;
    apply(table, edit);
    // An id may come back with another mask after an undo.
    const std::uint32_t id = edit.mask.id;
    if (id == film_mask_ && film_) film(0);
    mask_texels_.erase(id);
    keep_undo({.stroke_id = entry_id, .masks = std::move(masks_)});
    masks_ = std::move(table);
}

}  // namespace tuft::stroke
