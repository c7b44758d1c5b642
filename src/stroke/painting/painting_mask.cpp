#include "stroke/painting/painting.h"

/// What a painting does with its masks.
namespace tuft::stroke {

MaskTable masks_after(std::span<const Stroke> entries) {
    MaskTable table;
    for (const Stroke& entry : entries)
        if (entry.action == Action::mask && !entry.hidden) apply(table, entry.mask_edit);
    return table;
}

void keep_to_named_masks(std::vector<Stroke>& strokes, const MaskTable& table, const std::string& name) {
    for (Stroke& s : strokes) {
        if ((s.action != Action::stroke && s.action != Action::fill) || s.layer == kPaletteLayer) continue;
        const std::string& wanted = s.trace.mask.empty() ? name : s.trace.mask;
        if (wanted.empty()) continue;
        const Mask* mask = table.find(wanted);
        if (!mask) throw Error("there is no mask '" + wanted + "'; make it with 'tuft mask'");
        s.mask = mask->id;
    }
}

const MaskTexels& Document::mask(std::uint32_t id) {
    const Mask* mask = masks_.find(id);
    if (!mask) throw Error("there is no mask " + std::to_string(id));
    const auto found = mask_texels_.find(id);
    if (found != mask_texels_.end()) return found->second;
    return mask_texels_.emplace(id, evaluate(*mask, masks_, *model_)).first->second;
}

void Document::edit_masks(const Stroke& entry) {
    MaskTable table = masks_;
    apply(table, entry.mask_edit);
    // An id may come back with another mask after an undo.
    const std::uint32_t id = entry.mask_edit.mask.id;
    if (id == film_mask_ && film_) film(0);
    mask_texels_.erase(id);
    keep_undo({.stroke_id = entry.id, .masks = std::move(masks_)});
    masks_ = std::move(table);
}

}  // namespace tuft::stroke
