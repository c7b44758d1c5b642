#include "stroke/document/document.h"

#include <algorithm>
#include <utility>

#include "core/overloaded.h"
#include "stroke/document/path_ahead.h"
#include "stroke/document/tile_reach.h"
#include "stroke/journal/tables.h"
#include "stroke/session/session.h"
#include "stroke/surface/flat_texels.h"
#include "stroke/surface/mask_texels.h"

/// The journal: painting, replaying, taking back. What one entry does is in document_entries.cpp and
/// document_stroke.cpp.
namespace tuft::stroke {

Document::Document(const Model& model, const DocumentOptions& options)
    : model_(model),
      options_(options),
      layers_(model.texels.n_slots()),
      masks_(model),
      parts_(model),
      materials_(options.substrate, layers_, options.tip_lags),
      appearance_(model, materials_, layers_, palette_, parts_),
      film_(model),
      history_(options.undo_bytes),
      scratch_{.flat_texels = nullptr, .plans = std::make_unique<PlanScratchPool>(), .tile_reach = nullptr} {}

Document::~Document() = default;

void Document::use(const brush::Preset& preset) {
    materials_.use(preset);
    brushes_.drop(preset.name);
}

// Before the hand begins: what it may not do. A replay may, since the lock came after it.
void Document::check_layer(const JournalEntry& entry) const {
    if (const PartEdit* edit = entry.as<PartEdit>()) {
        std::vector<std::string> names;
        for (const Part& part : edit->parts) names.push_back(part.name);
        check_part_names(*model_.mesh, names);
    }
    if (const MaskEdit* edit = entry.as<MaskEdit>(); edit && !edit->remove) check_groups(edit->mask, *model_.mesh);
    if (!entry.as<PaintStroke>() && !entry.as<Fill>()) return;
    if (on_palette(entry)) return;
    const std::uint32_t id = layer_of(entry), mask = mask_of(entry);
    const Layer* layer = layers_.table().find(id);
    if (!layer) throw Error(Message("there is no layer {} to paint on", id));
    if (mask && !masks_.table().find(mask)) throw Error(Message("there is no mask {}", mask));
    if (layer->locked)
        throw Error(Message("layer '{}' is locked; unlock it or paint on another one", title_of(*layer)));
}

// A brush that is not held is fresh; the entry says so, for replays that hold it.
void Document::settle(PaintStroke& stroke) const {
    if (stroke.layer == kPaletteLayer) stroke.settings.film = FilmModel::wet;
    if (!stroke.erases() && !brushes_.find(stroke.brush)) stroke.settings.dip = DipMode::each;
}

// The same of any entry; new layers and masks get their ids.
void Document::settle(EntryContent& content) const {
    std::visit(Overloaded{[&](PaintStroke& stroke) { settle(stroke); },
                          [&](BrushAction& action) {
                              const BrushInHand* last = brushes_.find(action.brush);
                              if (!last) action.dip = DipMode::each;
                              if (last && action.ink.empty()) action.ink = last->dipped;
                          },
                          [](const Dry&) {}, [](const WashPalette&) {}, [](const Fill&) {},
                          [&](LayerEdit& edit) {
                              const bool is_new = edit.what == LayerChange::add || edit.what == LayerChange::duplicate;
                              if (is_new && edit.layer.id == 0) edit.layer.id = layers_.table().next_id;
                          },
                          [&](MaskEdit& edit) {
                              if (!edit.remove && edit.mask.id == 0) edit.mask.id = masks_.table().next_id;
                          },
                          [](const PartEdit&) {}},
               content);
}

StrokeReport Document::paint(JournalEntry entry, const ProgressFn& progress) {
    check_layer(entry);
    settle(entry.content);
    entry.id = journal_.next_id();
    StrokeReport report;
    try {
        report = perform(entry, progress);
    } catch (...) {
        forget_pigments();
        throw;
    }
    journal_.append(std::move(entry));
    return report;
}

// `path`: of a stroke, where it was computed ahead.
StrokeReport Document::perform(const JournalEntry& entry, const ProgressFn& progress, PathAhead* path) {
    if (!entry.as<PaintStroke>()) cancel();
    const std::uint64_t id = entry.id;
    const auto done = [id] { return StrokeReport{.stroke_id = id}; };
    return std::visit(Overloaded{[&](const PaintStroke& stroke) {
                                     return draw(id, stroke, path ? path->take() : path_of(stroke), progress);
                                 },
                                 [&](const BrushAction& action) { return act(id, action), done(); },
                                 [&](const Dry& wait) { return dry(id, wait, progress), done(); },
                                 [&](const WashPalette&) { return wash(id), done(); },
                                 [&](const Fill& coat) { return fill(id, coat); },
                                 [&](const LayerEdit& edit) { return edit_layers(id, edit), done(); },
                                 [&](const MaskEdit& edit) { return edit_masks(id, edit), done(); },
                                 [&](const PartEdit& edit) { return edit_parts(id, edit), done(); }},
                      entry.content);
}

void Document::paint(std::vector<JournalEntry> entries, const EntryDoneFn& done, const ProgressFn& progress) {
    const EntrySteps steps{.prepare =
                               [this](JournalEntry& entry, std::size_t ahead) {
                                   check_layer(entry);
                                   settle(entry.content);
                                   entry.id = journal_.next_id() + ahead;
                               },
                           .append =
                               [&](JournalEntry& entry, StrokeReport report) {
                                   journal_.append(std::move(entry));
                                   if (done) done(journal_.entries().back(), std::move(report));
                               }};
    try {
        perform_all(entries, steps, progress);
    } catch (...) {
        forget_pigments();
        throw;
    }
}

std::vector<StrokeReport> Document::replay(std::vector<JournalEntry> entries, const ProgressFn& progress) {
    std::vector<StrokeReport> reports;
    perform_all(entries,
                {.prepare = {},
                 .append =
                     [&](JournalEntry& entry, StrokeReport report) {
                         if (!entry.hidden && entry.as<PaintStroke>()) reports.push_back(std::move(report));
                         journal_.restore(std::move(entry));
                     }},
                progress);
    return reports;
}

void Document::adopt(std::vector<JournalEntry> entries, std::vector<LayerCanvas> canvases, std::uint64_t last) {
    for (const LayerCanvas& layer : canvases) {
        const Model& model = layer.layer == kPaletteLayer ? palette_.model() : model_;
        if (layer.canvas.n_slots() != model.texels.n_slots()) throw Error("the stored texels belong to another atlas");
    }
    if (!fits(entries, last)) throw Error("the stored texels belong to other strokes");
    const auto at = std::ranges::find(entries, last, &JournalEntry::id);
    const auto rest = at == entries.end() ? at : at + 1;
    LayerTable table = layers_after({entries.begin(), rest});
    MaskTable masks = masks_after({entries.begin(), rest});
    PartTable parts = parts_after({entries.begin(), rest});
    palette_.clear();
    const auto of_palette = std::ranges::find(canvases, kPaletteLayer, &LayerCanvas::layer);
    if (of_palette != canvases.end()) {
        palette_.plate().canvas = std::move(of_palette->canvas);
        canvases.erase(of_palette);
    }
    layers_.replace(std::move(table), std::move(canvases));
    masks_.set_table(std::move(masks));
    set_parts(std::move(parts));
    brushes_.clear();
    history_.clear(layers_.pigments().size());
    std::vector<JournalEntry> after(std::make_move_iterator(rest), std::make_move_iterator(entries.end()));
    for (auto entry = entries.begin(); entry != rest; ++entry) journal_.restore(std::move(*entry));
    replay(std::move(after));
    appearance_.apply_recolours();
}

namespace {

/// Whether the tables of layers, masks and parts are all that the entry changes: no texel was taken away.
bool changes_tables_only(const JournalEntry& entry) {
    const LayerEdit* edit = entry.as<LayerEdit>();
    return entry.as<MaskEdit>() || entry.as<PartEdit>() ||
           (edit && edit->what != LayerChange::remove && edit->what != LayerChange::merge);
}

}  // namespace

bool Document::undo() {
    cancel();
    if (!journal_.can_undo()) return false;
    journal_.undo();
    const JournalEntry& entry = journal_.undone().back();
    if (entry.hidden) return true;
    if (std::optional<UndoRecord> record = history_.take(entry.id)) {
        take_back(std::move(*record));
    } else if (changes_tables_only(entry)) {
        layers_.set_table(layers_after(journal_.entries()));
        masks_.set_table(masks_after(journal_.entries()));
        set_parts(parts_after(journal_.entries()));
    } else {
        repaint_all();
    }
    return true;
}

bool Document::redo() {
    cancel();
    if (!journal_.redo()) return false;
    if (const JournalEntry& entry = journal_.entries().back(); !entry.hidden) perform(entry, {});
    return true;
}

void Document::repaint_all() {
    layers_.clear();
    palette_.clear();
    masks_.set_table({});
    set_parts({});
    brushes_.clear();
    history_.clear(0);
    forget_pigments();
    std::vector<JournalEntry> entries = journal_.entries();
    perform_all(entries, {.prepare = {}, .append = [](JournalEntry&, StrokeReport) {}}, {});
}

// The entry is done: this is what it changed.
void Document::record(UndoRecord record) {
    history_.add(std::move(record), layers_.pigments().size());
}

void Document::take_back(UndoRecord record) {
    restore(record.tiles);
    if (record.masks) masks_.set_table(std::move(*record.masks));
    if (record.parts) set_parts(std::move(*record.parts));
    if (record.layers) {
        const bool brings_canvas = record.layers->canvas.has_value();
        layers_.restore(std::move(*record.layers));
        if (brings_canvas) appearance_.apply_recolours();
    }
    if (record.brush) brushes_.restore(std::move(*record.brush));
    forget_pigments();
}

void Document::restore(const std::vector<LayerTiles>& tiles) {
    for (const LayerTiles& of_layer : tiles)
        for (const ink::TileSnapshot& tile : of_layer.tiles) canvas(of_layer.layer).restore(tile);
}

// Pigments of what is taken back are as if they had never been met: a replay meets the others in its own order.
void Document::forget_pigments() {
    if (history_.n_pigments() >= layers_.pigments().size()) return;
    layers_.forget_pigments(history_.n_pigments());
    palette_.forget_pigments(history_.n_pigments());
}

std::vector<LayerTexels> all_canvases(const Document& document) {
    std::vector<LayerTexels> all = document.layers().canvases();
    const ink::Canvas* palette = document.palette().canvas();
    if (palette && !palette->touched_slots().empty()) all.push_back({kPaletteLayer, palette});
    return all;
}

}  // namespace tuft::stroke
