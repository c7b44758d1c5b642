#include "stroke/painting/painted_model.h"

#include <utility>

#include "stroke/painting/tile_reach.h"
#include "stroke/placement/drape.h"
#include "stroke/surface/flat_texels.h"
#include "stroke/surface/surface_stencil.h"

namespace tuft::stroke {

PaintedModel::PaintedModel(const Model& m, const DocumentOptions& options)
    : model(m),
      record_forces(options.record_forces),
      layers(m.texels.n_slots()),
      masks(m),
      parts(m),
      materials(options.substrate, layers, options.tip_lags),
      appearance(m, materials, layers, palette, parts),
      film(m),
      history(options.undo_bytes),
      scratch{.flat_texels = nullptr, .plans = std::make_unique<PlanScratchPool>(), .tile_reach = nullptr} {}

PaintedModel::~PaintedModel() = default;

ink::Canvas& PaintedModel::canvas(std::uint32_t layer) {
    return layer == kPaletteLayer ? palette.canvas_with(layers.pigments()) : layers.canvas(layer);
}

PaintTarget PaintedModel::target(std::uint32_t layer, std::uint32_t mask) {
    if (layer == kPaletteLayer) {
        Palette::Plate& plate = palette.plate();
        return {.model = plate.model,
                .surface = *plate.model.query,
                .substrate = plate.substrate,
                .canvas = canvas(layer),
                .on_palette = true};
    }
    return {.model = model,
            .surface = surface(),
            .substrate = materials.substrate(),
            .canvas = canvas(layer),
            .mask = parts.open_texels(mask, masks),
            .substrates = parts.substrates()};
}

ink::WetFilm& PaintedModel::film_within(std::uint32_t mask) {
    return film.within(mask, parts.open_texels(mask, masks));
}

// A pigment that is new to the document comes with the colour it was painted with.
ink::Mix PaintedModel::mix_of(const std::string& ink) {
    const std::size_t before = layers.pigments().size();
    const ink::Mix mix = layers.mix_of(materials.ink(ink));
    if (layers.pigments().size() != before) appearance.apply_recolours();
    return mix;
}

brush::Preset PaintedModel::preset_of(const std::string& brush, brush::SpineMethod spine) const {
    brush::Preset preset = materials.brush(brush);
    if (spine != brush::SpineMethod::rod) preset.spine = spine;
    return preset;
}

// What was made for the parts as they were: the film's stencil, areas mapped to the surface, the lines of drapes,
// the colours of the texels.
void PaintedModel::set_parts(PartTable table) {
    if (table == parts.table()) return;
    film.release();
    scratch.flat_texels.reset();
    scratch.drapes.reset();
    const bool same = have_same_substrates(table, parts.table());
    std::vector<std::uint32_t> slots;
    const auto add_slots = [&] {
        const ink::SubstrateMap* map = same ? nullptr : parts.substrates();
        for (std::uint32_t slot = 0; map && slot < map->of_slot.size(); ++slot)
            if (map->differs(slot)) slots.push_back(slot);
    };
    add_slots();
    parts.set_table(std::move(table));
    add_slots();
    layers.mark_changed(slots);
}

void PaintedModel::record(UndoRecord record) {
    history.add(std::move(record), layers.pigments().size());
}

void PaintedModel::take_back(UndoRecord record) {
    restore(record.tiles);
    if (record.masks) masks.set_table(std::move(*record.masks));
    if (record.parts) set_parts(std::move(*record.parts));
    if (record.layers) {
        const bool brings_canvas = record.layers->canvas.has_value();
        layers.restore(std::move(*record.layers));
        if (brings_canvas) appearance.apply_recolours();
    }
    if (record.brush) brushes.restore(std::move(*record.brush));
    forget_pigments();
}

void PaintedModel::restore(const std::vector<LayerTiles>& tiles) {
    for (const LayerTiles& of_layer : tiles)
        for (const ink::TileSnapshot& tile : of_layer.tiles) canvas(of_layer.layer).restore(tile);
}

void PaintedModel::forget_pigments() {
    if (history.n_pigments() >= layers.pigments().size()) return;
    layers.forget_pigments(history.n_pigments());
    palette.forget_pigments(history.n_pigments());
}

void PaintedModel::clear() {
    layers.clear();
    palette.clear();
    masks.set_table({});
    set_parts({});
    brushes.clear();
    history.clear(0);
    forget_pigments();
}

}  // namespace tuft::stroke
