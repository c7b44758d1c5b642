#include "stroke/deposit/stamp_target.h"

#include <algorithm>

#include "ink/exchange/film_tone.h"
#include "ink/texels/pool.h"
#include "ink/texels/relief.h"

namespace tuft::stroke {

StampTarget::StampTarget(const Model& model, ink::Canvas& canvas, const ink::Substrate& substrate,
                         const TargetLimits& limits, PlanScratchPool& scratch)
    : model_(model), canvas_(canvas), substrate_(substrate), limits_(limits), scratch_(scratch) {}

const StampTarget::Grain& StampTarget::grain(std::uint32_t slot) {
    std::unique_ptr<Grain>& found = grain_.at(slot);
    if (!found) {
        found = std::make_unique<Grain>();
        atlas::TexelShape buffer;
        ink::relief_of_tile(atlas::shape_of(model_.texels, slot, buffer),
                            static_cast<double>(substrate(slot).relief_length), *found);
    }
    return *found;
}

void StampTarget::expose_grain(std::uint32_t slot, std::array<float, atlas::kTileTexels>& exposure, double film) {
    ink::expose_relief(exposure, grain(slot), substrate(slot).relief, static_cast<float>(film));
}

void StampTarget::apply_grain(std::uint32_t slot, std::span<float, atlas::kTileTexels> tone, float share) {
    if (share > 0) ink::apply_grain(tone, grain(slot), share);
}

bool StampTarget::may_use(std::uint32_t slot) const {
    const TilePlan* plan = limits_.plan;
    if (!plan) return true;
    const auto use = std::ranges::lower_bound(*plan, slot, {}, &TileUse::slot);
    return use != plan->end() && use->slot == slot && use->first <= part_ && part_ <= use->last;
}

void StampTarget::snapshot(std::uint32_t slot) {
    if (!may_use(slot)) throw OutsideTiles();
    if (!before_.try_emplace(slot).second) return;
    before_[slot] = canvas_.snapshot(slot);
    if (on_relief_ || !canvas_.has_film(slot, ink::kFirstDryFilm)) return;
    const ink::Plane height = ink::dry_relief(canvas_, slot);
    on_relief_ = *std::max_element(height.begin(), height.end()) > static_cast<float>(ink::kPlain);
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
