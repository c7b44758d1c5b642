#include "stroke/painting/perform_entry.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/error.h"
#include "core/overloaded.h"
#include "ink/exchange/uptake.h"
#include "stroke/journal/tables.h"
#include "stroke/painting/apply_area.h"
#include "stroke/painting/apply_fill.h"
#include "stroke/surface/flat_texels.h"

namespace tuft::stroke {
namespace {

constexpr double kDryLimit = 3600;               // seconds, in which all is dry where the air moves
constexpr double kStillAirDryLimit = 48 * 3600;  // in which still air dries a full plate

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

/// The mask that was last painted through on a layer.
std::uint32_t stencil_mask_on(const PaintedModel& painted, std::uint32_t layer, std::span<const JournalEntry> earlier) {
    const std::uint32_t mask = last_mask_on(earlier, layer);
    return painted.masks.table().find(mask) ? mask : 0;
}

FillResult fill_area(PaintedModel& painted, const Fill& fill) {
    const FlatArea& area = *fill.area;
    if (fill.layer == kPaletteLayer) throw Error("an area of a drawing lies on the model, not on the palette");
    std::vector<ink::Mix> mixes;
    std::vector<double> films;
    for (const AreaStop& stop : area.stops) {
        mixes.push_back(painted.mix_of(stop.ink));
        films.push_back(stop.film >= 0 ? stop.film : stop.opacity * painted.materials.ink(stop.ink).film);
    }
    const FlatFrame frame{area.placement, area.low, area.high, area.edges};
    if (!painted.scratch.flat_texels || painted.scratch.flat_texels->frame() != frame)
        painted.scratch.flat_texels = std::make_unique<FlatTexels>(painted.model, painted.surface(), frame);
    return apply_area(fill, painted.target(fill.layer, fill.mask), *painted.scratch.flat_texels, mixes, films);
}

}  // namespace

void perform_action(PaintedModel& painted, std::uint64_t id, const BrushAction& action) {
    const ink::Mix mix = painted.mix_of(action.ink);
    BrushInHand brush = painted.brushes.take_up({.preset = painted.preset_of(action.brush, action.spine),
                                                 .name = action.brush,
                                                 .ink = action.ink,
                                                 .mix = mix,
                                                 .seed = action.seed,
                                                 .dip = action.dip});
    change_brush(brush, action, mix);
    painted.record({.entry = id, .brush = painted.brushes.put_down(action.brush, std::move(brush))});
}

void perform_drying(PaintedModel& painted, std::uint64_t id, const Dry& wait, std::span<const JournalEntry> earlier,
                    const ProgressFn& progress) {
    const ink::FilmParams params = ink::film_params(painted.materials.substrate(), wait.down);
    UndoRecord undo{.entry = id};
    for (const Layer& layer : painted.layers.table().layers) {
        ink::Canvas& canvas = painted.layers.canvas(layer.id);
        LayerTiles& before = undo.tiles.emplace_back(LayerTiles{.layer = layer.id, .tiles = {}});
        std::vector<std::uint8_t> copied(canvas.n_slots(), 0);
        const auto copy = [&](std::uint32_t slot) {
            if (copied[slot]) return;
            copied[slot] = 1;
            before.tiles.push_back(canvas.snapshot(slot));
        };
        try {
            ink::WetFilm& film = painted.film_within(stencil_mask_on(painted, layer.id, earlier));
            if (wait.seconds > 0)
                film.advance(canvas, wait.seconds, params, copy, progress);
            else
                film.dry(canvas, params, copy, params.drying.still_air > 0 ? kStillAirDryLimit : kDryLimit, progress);
        } catch (...) {
            painted.restore(undo.tiles);
            throw;
        }
    }
    painted.record(std::move(undo));
}

void perform_wash(PaintedModel& painted, std::uint64_t id) {
    ink::Canvas& canvas = painted.canvas(kPaletteLayer);
    UndoRecord undo{.entry = id};
    undo.tiles.push_back(tiles_of(kPaletteLayer, canvas));
    canvas.clear();
    painted.record(std::move(undo));
}

StrokeReport perform_fill(PaintedModel& painted, std::uint64_t id, const Fill& fill) {
    check_fill(fill);
    FillResult result;
    if (fill.area) {
        result = fill_area(painted, fill);
    } else {
        FillMixes mixes{.first = painted.mix_of(fill.ink)};
        mixes.second = fill.to_ink.empty() ? mixes.first : painted.mix_of(fill.to_ink);
        result = apply_fill(fill, painted.target(fill.layer, fill.mask), mixes);
    }
    UndoRecord undo{.entry = id};
    undo.tiles.push_back({fill.layer, std::move(result.before)});
    painted.record(std::move(undo));
    return {.stroke_id = id, .ink_given = result.ink_given, .met = result.met};
}

void edit_layers(PaintedModel& painted, std::uint64_t id, const LayerEdit& edit) {
    painted.record({.entry = id, .layers = painted.layers.edit(edit)});
}

void edit_masks(PaintedModel& painted, std::uint64_t id, const MaskEdit& edit) {
    painted.film.release(edit.mask.id);
    painted.parts.release_mask(edit.mask.id);
    painted.record({.entry = id, .masks = painted.masks.edit(edit)});
}

void edit_parts(PaintedModel& painted, std::uint64_t id, const PartEdit& edit) {
    PartTable before = painted.parts.table(), after = before;
    apply(after, edit);
    painted.set_parts(std::move(after));
    painted.record({.entry = id, .parts = std::move(before)});
}

void check_layer(const PaintedModel& painted, const JournalEntry& entry) {
    if (const PartEdit* edit = entry.as<PartEdit>()) {
        std::vector<std::string> names;
        for (const Part& part : edit->parts) names.push_back(part.name);
        check_part_names(*painted.model.mesh, names);
    }
    if (const MaskEdit* edit = entry.as<MaskEdit>(); edit && !edit->remove)
        check_groups(edit->mask, *painted.model.mesh);
    if (!entry.as<PaintStroke>() && !entry.as<Fill>()) return;
    if (on_palette(entry)) return;
    const std::uint32_t id = layer_of(entry), mask = mask_of(entry);
    const Layer* layer = painted.layers.table().find(id);
    if (!layer) throw Error(Message("there is no layer {} to paint on", id));
    if (mask && !painted.masks.table().find(mask)) throw Error(Message("there is no mask {}", mask));
    if (layer->locked)
        throw Error(Message("layer '{}' is locked; unlock it or paint on another one", title_of(*layer)));
}

void settle(const PaintedModel& painted, PaintStroke& stroke) {
    if (stroke.layer == kPaletteLayer) stroke.settings.film = FilmModel::wet;
    if (!stroke.erases() && !painted.brushes.find(stroke.brush)) stroke.settings.dip = DipMode::each;
}

void settle(const PaintedModel& painted, EntryContent& content) {
    std::visit(Overloaded{[&](PaintStroke& stroke) { settle(painted, stroke); },
                          [&](BrushAction& action) {
                              const BrushInHand* last = painted.brushes.find(action.brush);
                              if (!last) action.dip = DipMode::each;
                              if (last && action.ink.empty()) action.ink = last->dipped;
                          },
                          [](const Dry&) {}, [](const WashPalette&) {}, [](const Fill&) {},
                          [&](LayerEdit& edit) {
                              const bool is_new = edit.what == LayerChange::add || edit.what == LayerChange::duplicate;
                              if (is_new && edit.layer.id == 0) edit.layer.id = painted.layers.table().next_id;
                          },
                          [&](MaskEdit& edit) {
                              if (!edit.remove && edit.mask.id == 0) edit.mask.id = painted.masks.table().next_id;
                          },
                          [](const PartEdit&) {}},
               content);
}

}  // namespace tuft::stroke
