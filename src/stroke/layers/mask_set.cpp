#include "stroke/layers/mask_set.h"

#include <utility>

#include "core/error.h"

namespace tuft::stroke {

const MaskTexels& MaskSet::texels(std::uint32_t id) const {
    const Mask* mask = table_.find(id);
    if (!mask) throw Error(Message("there is no mask {}", id));
    const auto found = texels_.find(id);
    if (found != texels_.end()) return found->second;
    return texels_.emplace(id, evaluate(*mask, table_, *model_)).first->second;
}

MaskTable MaskSet::edit(const MaskEdit& edit) {
    MaskTable table = table_;
    apply(table, edit);
    texels_.erase(edit.mask.id);
    return std::exchange(table_, std::move(table));
}

}  // namespace tuft::stroke
