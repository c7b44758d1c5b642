#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/overloaded.h"
#include "ink/exchange/uptake.h"
#include "stroke/document/apply_area.h"
#include "stroke/document/apply_fill.h"
#include "stroke/document/document.h"
#include "stroke/journal/tables.h"

/// What each kind of entry does, but for strokes.
namespace tuft::stroke {
namespace {

constexpr double kDryLimit = 3600;  // seconds, in which all is dry

// Tiles of a canvas that are about to change.
LayerTiles tiles_of(std::uint32_t layer, const ink::Canvas& canvas) {
    LayerTiles tiles{layer, {}};
    for (const std::uint32_t slot : canvas.touched_slots()) tiles.tiles.push_back(canvas.snapshot(slot));
    return tiles;
}

/// Part of the tuft's length that a dip wets: what is in the dish, and as far as ink rises over it.
double wetted_part(const Dip& dip, const brush::Preset& preset) {
    const double rise = ink::uptake_height(
        {.surface_tension = preset.surface_tension, .pore_radius = ink::pore_radius_of(preset.hair_diameter)},
        dip.time);
    return std::min(1.0, dip.depth + rise / preset.length);
}

void change_brush(BrushInHand& brush, const BrushAction& action, const ink::Mix& mix) {
    std::visit(
        Overloaded{[&](const Dip& dip) {
                       ink::dip(brush.reservoir, mix,
                                {.depth = wetted_part(dip, brush.tuft.preset), .level = dip.amount, .side = dip.side});
                       brush.dipped = action.ink;
                   },
                   [&](const Wipe& wipe) {
                       ink::wipe(brush.reservoir, wipe.amount, {.depth = wipe.depth, .side = wipe.side});
                   },
                   [&](const Rinse&) {
                       ink::rinse(brush.reservoir);
                       brush::reset(brush.tuft);
                   },
                   [&](const Reshape&) { brush::reshape(brush.tuft); }},
        action.what);
    brush.tuft.ink_left = brush.reservoir.fullness();
    brush.tuft.wetness = wetness_of(brush.reservoir);
}

}  // namespace

ink::Canvas& Document::canvas(std::uint32_t layer) {
    return layer == kPaletteLayer ? palette_.canvas_with(layers_.pigments()) : layers_.canvas(layer);
}

// Masks are of the model's texels.
PaintTarget Document::target(std::uint32_t layer, std::uint32_t mask) {
    if (layer == kPaletteLayer) {
        Palette::Plate& plate = palette_.plate();
        return {.model = plate.model,
                .surface = *plate.model.query,
                .substrate = plate.substrate,
                .canvas = canvas(layer),
                .on_palette = true};
    }
    return {.model = model_,
            .surface = surface(),
            .substrate = materials_.substrate(),
            .canvas = canvas(layer),
            .mask = parts_.open_texels(mask, masks_),
            .substrates = parts_.substrates()};
}

// A pigment that is new to the document comes with the colour it was painted with.
ink::Mix Document::mix_of(const std::string& name) {
    const std::size_t before = layers_.pigments().size();
    const ink::Mix mix = layers_.mix_of(materials_.ink(name));
    if (layers_.pigments().size() != before) appearance_.apply_recolours();
    return mix;
}

brush::Preset Document::preset_of(const std::string& name, brush::SpineMethod spine) const {
    brush::Preset preset = materials_.brush(name);
    if (spine != brush::SpineMethod::rod) preset.spine = spine;
    return preset;
}

void Document::act(std::uint64_t id, const BrushAction& action) {
    const ink::Mix mix = mix_of(action.ink);
    BrushInHand brush = brushes_.take_up({.preset = preset_of(action.brush, action.spine),
                                          .name = action.brush,
                                          .ink = action.ink,
                                          .mix = mix,
                                          .seed = action.seed,
                                          .dip = action.dip});
    change_brush(brush, action, mix);
    record({.entry = id, .brush = brushes_.put_down(action.brush, std::move(brush))});
}

/// The mask that was last painted through on a layer, by entries before this one.
std::uint32_t Document::stencil_mask_on(std::uint32_t layer, std::uint64_t before) const {
    const std::vector<JournalEntry>& all = journal_.entries();
    const auto end = std::ranges::find(all, before, &JournalEntry::id);
    const std::uint32_t mask = last_mask_on({all.begin(), end}, layer);
    return masks_.table().find(mask) ? mask : 0;
}

// All layers dry. No brush has a part in it.
void Document::dry(std::uint64_t id, const Dry& wait, const ProgressFn& progress) {
    const ink::FilmParams params = ink::film_params(materials_.substrate(), wait.down);
    UndoRecord undo{.entry = id};
    for (const Layer& layer : layers_.table().layers) {
        ink::Canvas& canvas = layers_.canvas(layer.id);
        LayerTiles& before = undo.tiles.emplace_back(LayerTiles{.layer = layer.id, .tiles = {}});
        std::vector<std::uint8_t> copied(canvas.n_slots(), 0);
        const auto copy = [&](std::uint32_t slot) {
            if (copied[slot]) return;
            copied[slot] = 1;
            before.tiles.push_back(canvas.snapshot(slot));
        };
        try {
            ink::WetFilm& film = film_within(stencil_mask_on(layer.id, id));
            if (wait.seconds > 0)
                film.advance(canvas, wait.seconds, params, copy, progress);
            else
                film.dry(canvas, params, copy, kDryLimit, progress);
        } catch (...) {
            restore(undo.tiles);
            throw;
        }
    }
    record(std::move(undo));
}

void Document::wash(std::uint64_t id) {
    ink::Canvas& canvas = this->canvas(kPaletteLayer);
    UndoRecord undo{.entry = id};
    undo.tiles.push_back(tiles_of(kPaletteLayer, canvas));
    canvas.clear();
    record(std::move(undo));
}

FillResult Document::fill_area(const Fill& fill) {
    const FlatArea& area = *fill.area;
    if (fill.layer == kPaletteLayer) throw Error("an area of a drawing lies on the model, not on the palette");
    std::vector<ink::Mix> mixes;
    std::vector<double> films;
    for (const AreaStop& stop : area.stops) {
        mixes.push_back(mix_of(stop.ink));
        films.push_back(stop.film >= 0 ? stop.film : stop.opacity * materials_.ink(stop.ink).film);
    }
    const FlatFrame frame{area.placement, area.low, area.high, area.edges};
    if (!scratch_.flat_texels || scratch_.flat_texels->frame() != frame)
        scratch_.flat_texels = std::make_unique<FlatTexels>(model_, surface(), frame);
    return apply_area(fill, target(fill.layer, fill.mask), *scratch_.flat_texels, mixes, films);
}

StrokeReport Document::fill(std::uint64_t id, const Fill& fill) {
    check_fill(fill);
    FillResult result;
    if (fill.area) {
        result = fill_area(fill);
    } else {
        FillMixes mixes{.first = mix_of(fill.ink)};
        mixes.second = fill.to_ink.empty() ? mixes.first : mix_of(fill.to_ink);
        result = apply_fill(fill, target(fill.layer, fill.mask), mixes);
    }
    UndoRecord undo{.entry = id};
    undo.tiles.push_back({fill.layer, std::move(result.before)});
    record(std::move(undo));
    return {.stroke_id = id, .ink_given = result.ink_given, .met = result.met};
}

void Document::edit_layers(std::uint64_t id, const LayerEdit& edit) {
    record({.entry = id, .layers = layers_.edit(edit)});
}

void Document::edit_masks(std::uint64_t id, const MaskEdit& edit) {
    film_.release(edit.mask.id);
    parts_.release_mask(edit.mask.id);
    record({.entry = id, .masks = masks_.edit(edit)});
}

void Document::edit_parts(std::uint64_t id, const PartEdit& edit) {
    PartTable before = parts_.table(), after = before;
    apply(after, edit);
    set_parts(std::move(after));
    record({.entry = id, .parts = std::move(before)});
}

// What was made for the parts as they were: the film's stencil, areas mapped to the surface, the lines of drapes,
// the colours of the texels.
void Document::set_parts(PartTable table) {
    if (table == parts_.table()) return;
    film_.release();
    scratch_.flat_texels.reset();
    scratch_.drapes.reset();
    const bool same = have_same_substrates(table, parts_.table());
    std::vector<std::uint32_t> slots;
    const auto add_slots = [&] {
        const ink::SubstrateMap* map = same ? nullptr : parts_.substrates();
        for (std::uint32_t slot = 0; map && slot < map->of_slot.size(); ++slot)
            if (map->differs(slot)) slots.push_back(slot);
    };
    add_slots();
    parts_.set_table(std::move(table));
    add_slots();
    layers_.mark_changed(slots);
}

ink::WetFilm& Document::film_within(std::uint32_t mask) {
    return film_.within(mask, parts_.open_texels(mask, masks_));
}

}  // namespace tuft::stroke
