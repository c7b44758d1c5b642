#include "stroke/document/document.h"

#include <algorithm>
#include <utility>

#include "core/overloaded.h"
#include "core/system/parallel.h"
#include "stroke/journal/tables.h"
#include "stroke/painting/paint_stroke.h"
#include "stroke/painting/path_ahead.h"
#include "stroke/painting/perform_entry.h"
#include "stroke/painting/stroke_batch.h"
#include "stroke/session/session.h"

/// The journal: painting, replaying, taking back. What one entry does is in stroke/painting.
namespace tuft::stroke {

Document::Document(const Model& model, const DocumentOptions& options) : painted_(model, options) {}

Document::~Document() = default;

void Document::check_layer(const JournalEntry& entry) const {
    stroke::check_layer(painted_, entry);
}

void Document::check_size(const JournalEntry& entry) const {
    stroke::check_size(painted_, entry);
}

void Document::use(const brush::Preset& preset) {
    painted_.materials.use(preset);
    painted_.brushes.drop(preset.name);
}

StrokeReport Document::paint(JournalEntry entry, const ProgressFn& progress) {
    check_layer(entry);
    settle(painted_, entry.content);
    entry.id = journal_.next_id();
    StrokeReport report;
    try {
        report = perform(entry, progress);
    } catch (...) {
        painted_.forget_pigments();
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
    return std::visit(
        Overloaded{
            [&](const PaintStroke& stroke) {
                return draw(id, stroke, path ? path->take() : path_of(painted_, stroke), progress);
            },
            [&](const BrushAction& action) { return perform_action(painted_, id, action), done(); },
            [&](const Dry& wait) { return perform_drying(painted_, id, wait, entries_before(id), progress), done(); },
            [&](const WashPalette&) { return perform_wash(painted_, id), done(); },
            [&](const Fill& coat) { return perform_fill(painted_, id, coat); },
            [&](const LayerEdit& edit) { return edit_layers(painted_, id, edit), done(); },
            [&](const MaskEdit& edit) { return edit_masks(painted_, id, edit), done(); },
            [&](const PartEdit& edit) { return edit_parts(painted_, id, edit), done(); }},
        entry.content);
}

void Document::paint(std::vector<JournalEntry> entries, const EntryDoneFn& done, const ProgressFn& progress) {
    const EntrySteps steps{.prepare =
                               [this](JournalEntry& entry, std::size_t ahead) {
                                   check_layer(entry);
                                   settle(painted_, entry.content);
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
        painted_.forget_pigments();
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
        const Model& model = layer.layer == kPaletteLayer ? painted_.palette.model() : painted_.model;
        if (layer.canvas.n_slots() != model.texels.n_slots()) throw Error("the stored texels belong to another atlas");
    }
    if (!fits(entries, last)) throw Error("the stored texels belong to other strokes");
    const auto at = std::ranges::find(entries, last, &JournalEntry::id);
    const auto rest = at == entries.end() ? at : at + 1;
    LayerTable table = layers_after({entries.begin(), rest});
    MaskTable masks = masks_after({entries.begin(), rest});
    PartTable parts = parts_after({entries.begin(), rest});
    painted_.palette.clear();
    const auto of_palette = std::ranges::find(canvases, kPaletteLayer, &LayerCanvas::layer);
    if (of_palette != canvases.end()) {
        painted_.palette.plate().canvas = std::move(of_palette->canvas);
        canvases.erase(of_palette);
    }
    painted_.layers.replace(std::move(table), std::move(canvases));
    painted_.masks.set_table(std::move(masks));
    painted_.set_parts(std::move(parts));
    painted_.brushes.clear();
    painted_.history.clear(painted_.layers.pigments().size());
    std::vector<JournalEntry> after(std::make_move_iterator(rest), std::make_move_iterator(entries.end()));
    for (auto entry = entries.begin(); entry != rest; ++entry) journal_.restore(std::move(*entry));
    replay(std::move(after));
    painted_.appearance.apply_recolours();
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
    if (std::optional<UndoRecord> record = painted_.history.take(entry.id)) {
        painted_.take_back(std::move(*record));
    } else if (changes_tables_only(entry)) {
        painted_.layers.set_table(layers_after(journal_.entries()));
        painted_.masks.set_table(masks_after(journal_.entries()));
        painted_.set_parts(parts_after(journal_.entries()));
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

std::span<const JournalEntry> Document::entries_before(std::uint64_t id) const {
    const std::vector<JournalEntry>& all = journal_.entries();
    return {all.begin(), std::ranges::find(all, id, &JournalEntry::id)};
}

void Document::repaint_all() {
    painted_.clear();
    std::vector<JournalEntry> entries = journal_.entries();
    perform_all(entries, {.prepare = {}, .append = [](JournalEntry&, StrokeReport) {}}, {});
}

void Document::begin(JournalEntry entry) {
    check_layer(entry);
    cancel();
    in_work_.session = make_session(painted_, std::get<PaintStroke>(entry.content));
    if (thread_count() > 1) in_work_.session->forecast_hand();
    in_work_.entry = std::move(entry);
}

void Document::extend(std::span<const brush::Pose> poses, const std::function<void()>& painted) {
    in_work_.session->extend(poses, painted);
}

StrokeReport Document::end() {
    in_work_.entry.content = in_work_.session->stroke();
    StrokeReport report = finish_session(journal_.next_id());
    journal_.append(std::move(in_work_.entry));
    return report;
}

void Document::cancel() {
    if (!in_work_.session) return;
    std::vector<LayerTiles> before;
    before.push_back({in_work_.session->stroke().layer, in_work_.session->take_snapshots()});
    painted_.restore(before);
    in_work_.session.reset();
    painted_.forget_pigments();
}

// Ends the stroke in work without a word to the journal.
StrokeReport Document::finish_session(std::uint64_t id) {
    StrokeReport report = put_down(painted_, id, in_work_.session->stroke(), in_work_.session->finish(),
                                   painted_.layers.pigments().size());
    in_work_.session.reset();
    return report;
}

StrokeReport Document::draw(std::uint64_t id, const PaintStroke& stroke, const HandPath& path,
                            const ProgressFn& progress) {
    cancel();
    in_work_.session = make_session(painted_, stroke);
    try {
        begin_path(*in_work_.session, path, progress);
        if (thread_count() > 1 && !watcher_) {
            if (std::unique_ptr<StrokeForecast> forecast = in_work_.session->forecast(path.poses)) {
                forecast->compute_ahead();
                in_work_.session->use(std::move(forecast));
            }
        }
        const std::size_t n = path.poses.size();
        if (!watcher_) paint_poses(*in_work_.session, path.poses, 0, n);
        for (std::size_t i = 0; watcher_ && i < n; ++i) {
            paint_poses(*in_work_.session, path.poses, i, i + 1);
            watcher_(*in_work_.session, static_cast<double>(i + 1) / static_cast<double>(n));
        }
        StrokeReport report = finish_session(id);
        note_origin(report, stroke, painted_.target(stroke.layer, 0).surface);
        return report;
    } catch (...) {
        cancel();
        throw;
    }
}

void Document::perform_all(std::vector<JournalEntry>& entries, const EntrySteps& steps, const ProgressFn& progress) {
    cancel();
    const double all = std::max<double>(1.0, static_cast<double>(entries.size()));
    std::size_t i = 0;
    // Reports the next `n` entries.
    const auto part_of = [&](std::size_t n) -> ProgressFn {
        return [&progress, all, n, first = i](std::string_view phase, double part) {
            return !progress || progress(phase, (static_cast<double>(first) + part * static_cast<double>(n)) / all);
        };
    };
    std::unique_ptr<PathAhead> path;  // of entry i, or null
    while (i < entries.size()) {
        StrokeBatch batch(painted_);
        if (!watcher_) batch.take_in(std::span(entries).subspan(i), steps.prepare);
        if (batch.size() > 1) {
            batch.paint(part_of(batch.size()));
            const std::size_t appended = batch.append(steps.append);
            i += appended;
            if (appended > 0) path.reset();
            if (appended == batch.size()) continue;
        }
        JournalEntry& entry = entries[i];
        if (steps.prepare) steps.prepare(entry, 0);
        const std::unique_ptr<PathAhead> own = std::exchange(path, nullptr);
        if (thread_count() > 1 && i + 1 < entries.size() && !paints_beside_others(entries[i + 1]))
            path = plan_path_ahead(painted_, entries[i + 1]);
        StrokeReport report = entry.hidden ? StrokeReport{} : perform(entry, part_of(1), own.get());
        steps.append(entry, std::move(report));
        ++i;
    }
}

std::vector<LayerTexels> all_canvases(const Document& document) {
    std::vector<LayerTexels> all = document.layers().canvases();
    const ink::Canvas* palette = document.palette().canvas();
    if (palette && !palette->touched_slots().empty()) all.push_back({kPaletteLayer, palette});
    return all;
}

}  // namespace tuft::stroke
