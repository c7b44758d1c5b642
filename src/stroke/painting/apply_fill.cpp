#include "stroke/painting/apply_fill.h"

#include <algorithm>
#include <array>

#include "core/system/parallel.h"
#include "ink/exchange/erase.h"
#include "stroke/surface/fill_region.h"

namespace tuft::stroke {
namespace {

// The water that comes with a coat.
void pour(ink::Canvas& canvas, std::uint32_t slot, const ink::Coat& coat) {
    if (std::none_of(coat.film.begin(), coat.film.end(), [](float f) { return f > 0; })) return;
    ink::Plane& liquid = canvas.touch_liquid(slot, ink::Liquid::film);
    for (std::size_t t = 0; t < liquid.size(); ++t) liquid[t] += coat.film[t];
}

// Slots with texels of these charts that the mask does not cover up, ascending.
std::vector<std::uint32_t> slots_of(const std::vector<std::uint8_t>& charts, const PaintTarget& target) {
    const atlas::TexelMap& map = target.model.texels;
    std::vector<std::uint32_t> slots;
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (std::uint32_t k = map.cluster_start[slot]; k < map.cluster_start[slot + 1]; ++k)
            if (charts[map.cluster_chart[k]] && (slots.empty() || slots.back() != slot)) slots.push_back(slot);
    if (target.mask) std::erase_if(slots, [&](std::uint32_t slot) { return target.mask->none(slot); });
    return slots;
}

// Film and share of the second ink on each texel of a slot.
void set_coat(ink::Coat& coat, const Fill& fill, const atlas::TexelMap& map, const std::vector<std::uint8_t>& charts,
              std::uint32_t slot) {
    const atlas::TexelTile& tile = map.tiles[slot];
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const std::uint8_t cluster = tile.cluster[t];
        const bool in = cluster != atlas::kNoCluster && charts[map.cluster_chart[map.cluster_start[slot] + cluster]];
        const double along = in ? along_gradient(fill, Vec3(map.position(slot, t))) : 0;
        const double film =
            fill.gradient == Gradient::none ? fill.film : fill.film + along * (fill.to_film - fill.film);
        coat.film[t] = in ? static_cast<float>(film) : 0.0f;
        coat.towards[t] = static_cast<float>(along);
    }
}

}  // namespace

FillResult apply_fill(const Fill& fill, const PaintTarget& target, const FillMixes& mixes) {
    check_fill(fill);
    const std::vector<std::uint8_t> charts = charts_of(fill, target.model, target.surface);
    const std::vector<std::uint32_t> slots = slots_of(charts, target);
    FillResult result;
    for (const std::uint32_t slot : slots) result.before.push_back(target.canvas.snapshot(slot));

    const atlas::TexelMap& map = target.model.texels;
    std::vector<ink::Amounts> added(slots.size());
    parallel_for(slots.size(), 16, [&](std::size_t begin, std::size_t end) {
        ink::Coat coat;
        coat.first = mixes.first;
        coat.second = mixes.second;
        for (std::size_t i = begin; i < end; ++i) {
            set_coat(coat, fill, map, charts, slots[i]);
            if (target.mask) target.mask->apply(slots[i], coat.film);
            added[i] =
                ink::add_coat(target.canvas, slots[i], map.tiles[slots[i]].area, coat, target.capacity(slots[i]));
            if (target.on_palette) pour(target.canvas, slots[i], coat);
        }
    });
    for (const ink::Amounts& a : added) result.ink_given += a.sum();
    return result;
}

}  // namespace tuft::stroke
