#include "stroke/deposit/stamp_target.h"

#include <algorithm>

#include "ink/texels/relief.h"

namespace tuft::stroke {

StampTarget::StampTarget(const Model& model, ink::Canvas& canvas, const ink::Substrate& substrate,
                         const MaskTexels* mask, PlanScratchPool& scratch)
    : model_(model),
      canvas_(canvas),
      mask_(mask),
      scratch_(scratch),
      grain_rms_(substrate.relief),
      grain_length_(substrate.relief_length) {}

void StampTarget::prepare_grain() {
    if (grain_.empty()) grain_.resize(model_.texels.n_slots());
}

const StampTarget::Grain& StampTarget::grain(std::uint32_t slot) {
    if (!grain_[slot]) {
        grain_[slot] = std::make_unique<Grain>();
        atlas::TexelShape buffer;
        ink::relief_of_tile(atlas::shape_of(model_.texels, slot, buffer), static_cast<double>(grain_length_),
                            *grain_[slot]);
    }
    return *grain_[slot];
}

void StampTarget::expose_grain(std::uint32_t slot, std::array<float, atlas::kTileTexels>& exposure, double film) {
    ink::expose_relief(exposure, grain(slot), grain_rms_, static_cast<float>(film));
}

void StampTarget::snapshot(std::uint32_t slot) {
    if (!before_.contains(slot)) before_.emplace(slot, canvas_.snapshot(slot));
}

std::vector<ink::TileSnapshot> StampTarget::take_snapshots() {
    std::vector<ink::TileSnapshot> tiles;
    tiles.reserve(before_.size());
    for (auto& [slot, tile] : before_) tiles.push_back(std::move(tile));
    before_.clear();
    std::sort(tiles.begin(), tiles.end(),
              [](const ink::TileSnapshot& a, const ink::TileSnapshot& b) { return a.slot < b.slot; });
    return tiles;
}

}  // namespace tuft::stroke
