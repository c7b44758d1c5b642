#include <algorithm>
#include <array>

#include "core/system/parallel.h"
#include "stroke/painting/painting.h"
#include "stroke/surface/fill_region.h"

/// Fills and gradients.
namespace tuft::stroke {
namespace {

// The water that comes with a coat.
void pour(ink::Canvas& canvas, std::uint32_t slot, const ink::Coat& coat) {
    if (std::none_of(coat.film.begin(), coat.film.end(), [](float f) { return f > 0; })) return;
    ink::Plane& liquid = canvas.touch_liquid(slot, ink::Liquid::film);
    for (std::size_t t = 0; t < liquid.size(); ++t) liquid[t] += coat.film[t];
}

}  // namespace

StrokeReport Document::lay_fill(const Stroke& entry) {
    check_fill(entry.fill);
    const Fill& fill = entry.fill;
    const ink::Mix first = mix_of(entry.trace.ink);
    const ink::Mix second = fill.to_ink.empty() ? first : mix_of(fill.to_ink);
    const bool on_palette = entry.layer == kPaletteLayer;
    const Model& model = target_model(entry);
    const std::vector<std::uint8_t> charts = charts_of(fill, model);
    ink::Canvas& canvas = this->canvas(entry.layer);
    const MaskTexels* mask = entry.mask && !on_palette ? &this->mask(entry.mask) : nullptr;
    const atlas::TexelMap& map = model.texels;

    std::vector<std::uint32_t> slots;
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (std::uint32_t k = map.cluster_start[slot]; k < map.cluster_start[slot + 1]; ++k)
            if (charts[map.cluster_chart[k]] && (slots.empty() || slots.back() != slot)) slots.push_back(slot);
    if (mask) std::erase_if(slots, [mask](std::uint32_t slot) { return mask->none(slot); });
    Undo undo{.stroke_id = entry.id};
    LayerTiles& before = undo.before.emplace_back(LayerTiles{.layer = entry.layer, .tiles = {}});
    for (const std::uint32_t slot : slots) before.tiles.push_back(canvas.snapshot(slot));

    std::vector<ink::Amounts> laid(slots.size());
    parallel_for(slots.size(), 16, [&](std::size_t begin, std::size_t end) {
        ink::Coat coat;
        coat.first = first;
        coat.second = second;
        for (std::size_t i = begin; i < end; ++i) {
            const atlas::TexelTile& tile = map.tiles[slots[i]];
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                const std::uint8_t cluster = tile.cluster[t];
                const bool in =
                    cluster != atlas::kNoCluster && charts[map.cluster_chart[map.cluster_start[slots[i]] + cluster]];
                const double along = in ? along_gradient(fill, Vec3(map.position(slots[i], t))) : 0;
                const double film =
                    fill.gradient == Gradient::none ? fill.film : fill.film + along * (fill.to_film - fill.film);
                coat.film[t] = in ? static_cast<float>(film) : 0.0f;
                coat.towards[t] = static_cast<float>(along);
            }
            if (mask) mask->apply(slots[i], coat.film);
            laid[i] = ink::lay_coat(canvas, slots[i], tile.area, coat, substrate_of(entry).capacity);
            if (on_palette) pour(canvas, slots[i], coat);
        }
    });
    keep_undo(std::move(undo));
    StrokeReport report{.stroke_id = entry.id};
    for (const ink::Amounts& a : laid) report.ink_given += a.sum();
    return report;
}

}  // namespace tuft::stroke
