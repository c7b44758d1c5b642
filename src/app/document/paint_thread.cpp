#include "app/document/paint_thread.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

namespace tuft::app {
namespace {

constexpr double kPublishEvery = 0.012;  // seconds
constexpr std::chrono::seconds kLookOutsideEvery{1};
constexpr std::size_t kPosesAtOnce = 8;  // between two looks at the clock

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class... Fs>
struct Overloaded : Fs... {
    using Fs::operator()...;
};
template <class... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;  // clang 14 does not find it by itself

}  // namespace

PaintThread::PaintThread(Work work) : work_(std::move(work)) {
    work_.painting->take_dirty();
    const std::vector<std::string> shipped = ink::list_inks();
    for (const std::string& name : work_.autosave.inks())
        if (std::find(shipped.begin(), shipped.end(), name) == shipped.end())
            own_inks_.push_back(work_.painting->ink(name));
    update_.own_inks = own_inks_;
    publish_looks();
    if (work_.painting->palette()) {
        refresh(palette_, *work_.painting);
        update_.palette = palette_;
    }
    carried_ = work_.autosave.attachments(io::kReferences);
    publish_snapshots();
    steps_.assign(work_.painting->journal().entries().size(), Step{.made = 1});
    publish(true);
    thread_ = std::thread([this] { run(); });
}

PaintThread::~PaintThread() {
    finish();
}

std::filesystem::path PaintThread::finish() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
    return spared_;
}

void PaintThread::post(Command command) {
    {
        const std::lock_guard lock(mutex_);
        queue_.push_back(std::move(command));
    }
    wake_.notify_all();
}

const atlas::AtlasReport* PaintThread::atlas_report() {
    const stroke::Model& model = *work_.model;
    if (model.atlas_report.charts > 0) return &model.atlas_report;
    if (!measured_.valid())
        measured_ =
            std::async(std::launch::async, [&model] { return atlas::measure(*model.mesh, model.atlas); }).share();
    return measured_.wait_for(std::chrono::seconds(0)) == std::future_status::ready ? &measured_.get() : nullptr;
}

bool PaintThread::idle() const {
    const std::lock_guard lock(mutex_);
    return queue_.empty() && !working_;
}

void PaintThread::wait_idle(double seconds) const {
    std::unique_lock lock(mutex_);
    rests_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return queue_.empty() && !working_; });
}

Update PaintThread::take() {
    const std::lock_guard lock(mutex_);
    Update out = std::move(update_);
    update_.pixels.reset();
    update_.tiles.clear();
    update_.strokes.reset();
    update_.messages.clear();
    update_.tuft.reset();
    update_.done = out.done;
    update_.busy = out.busy;
    update_.fraction = out.fraction;
    update_.fullness = out.fullness;
    update_.can_undo = out.can_undo;
    update_.can_redo = out.can_redo;
    update_.layers = out.layers;
    update_.masks = out.masks;
    update_.thumbnails.clear();
    update_.own_inks.reset();
    update_.palette.reset();
    update_.on_palette = out.on_palette;
    update_.from_outside = false;
    update_.brush_colour = out.brush_colour;
    update_.looks.reset();
    update_.outline.reset();
    update_.snapshots.reset();
    update_.snapshot_picture.reset();
    update_.not_saved.reset();
    update_.picked.clear();
    update_.wet = out.wet;
    update_.undo_seconds = out.undo_seconds;
    update_.trouble = out.trouble;
    update_.project = out.project;
    out.waiting = queue_.size() + (working_ ? 1 : 0);
    return out;
}

void PaintThread::run() {
    for (;;) {
        Command command;
        {
            std::unique_lock lock(mutex_);
            working_ = false;
            if (queue_.empty()) rests_.notify_all();
            const bool asked = wake_.wait_for(lock, kLookOutsideEvery, [this] { return quit_ || !queue_.empty(); });
            working_ = true;
            if (!asked) {
                lock.unlock();
                look_outside();
                continue;
            }
            if (queue_.empty()) break;
            command = std::move(queue_.front());
            queue_.pop_front();
        }
        try {
            perform(command);
        } catch (const Cancelled&) {
            say("Stopped; everything is as it was.");
            publish(true);
        } catch (const std::exception& error) {
            work_.painting->cancel();
            drop_loads();
            say(error.what());
            publish(true);
        }
        draw_thumbnails();
        if (work_.autosave.unkept()) look_outside();
    }
    if (work_.painting->in_stroke()) end();
    look_outside();
    Autosave& autosave = work_.autosave;
    autosave.retry(work_.source, work_.frame, *work_.painting);
    if (autosave.unkept() && !work_.spare.empty() &&
        autosave.start(work_.spare, work_.source, work_.frame, *work_.painting).empty())
        spared_ = work_.spare;
    autosave.store_canvas(*work_.painting);
}

namespace {

// What a person who only looks at a project may not ask for.
bool changes_work(const Command& command) {
    return std::visit(
        Overloaded{[](const BeginStroke&) { return true; }, [](const PaintDrawing&) { return true; },
                   [](const ActOnBrush&) { return true; }, [](const UndoStroke&) { return true; },
                   [](const RedoStroke&) { return true; }, [](const EditStrokes&) { return true; },
                   [](const AttachToProject&) { return true; }, [](const DetachFromProject&) { return true; },
                   [](const TakeSnapshot&) { return true; }, [](const RenameSnapshot&) { return true; },
                   [](const RestoreSnapshot&) { return true; }, [](const FillModel&) { return true; },
                   [](const ChangeLayers&) { return true; }, [](const ChangeMasks&) { return true; },
                   [](const auto&) { return false; }},
        command);
}

}  // namespace

void PaintThread::perform(Command& command) {
    stop_ = false;
    if (work_.autosave.viewing() && changes_work(command))
        return say("This project is only looked at; File > Save as... makes a copy to work on.");
    std::visit(Overloaded{[this](BeginStroke& c) { begin(c); },
                          [this](ExtendStroke& c) { extend(c); },
                          [this](EndStroke&) { end(); },
                          [this](ActOnBrush& c) { care(c); },
                          [this](PaintDrawing& c) { paint_drawing(c); },
                          [this](CancelStroke&) { cancel(); },
                          [this](UndoStroke&) { undo(); },
                          [this](RedoStroke&) { redo(); },
                          [this](SaveProject& c) {
                              const std::string fault =
                                  work_.autosave.start(c.path, work_.source, work_.frame, *work_.painting);
                              say(fault.empty() ? "Saved as " + c.path.string() : fault);
                              publish();
                              if (fault.empty()) return;
                              const std::lock_guard lock(mutex_);
                              update_.not_saved = {c.path, fault};
                          },
                          [this](RetryKeeping&) {
                              work_.autosave.retry(work_.source, work_.frame, *work_.painting);
                              publish();
                          },
                          [this](FillModel& c) { fill(c); },
                          [this](ChangeLayers& c) { change_layers(c); },
                          [this](SendTexture& c) {
                              publish();
                              work_.texture->show_wetness(c.wetness, *work_.painting);
                              send_pixels();
                          },
                          [this](PickInk& c) { pick(c); },
                          [this](TakeInk& c) { add_ink(std::move(c.ink)); },
                          [this](RecolourInk& c) { recolour(c); },
                          [this](PreviewSubstrate& c) { preview_substrate(c); },
                          [this](ChangeMasks& c) { change_masks(c); },
                          [this](ShowMask& c) { show_mask(c); },
                          [this](LookFrom& c) { thumbnails_.look_from(*work_.model, c.camera); },
                          [this](ExportModel& c) { export_model(c); },
                          [this](EditStrokes& c) { edit(c); },
                          [this](HighlightStrokes& c) { highlight(c); },
                          [this](AttachToProject& c) {
                              work_.autosave.attach(c.kind, c.attachment);
                              publish();
                          },
                          [this](DetachFromProject& c) {
                              work_.autosave.detach(c.kind, c.name);
                              publish_snapshots();
                              publish();
                          },
                          [this](TakeSnapshot& c) { take_snapshot(c); },
                          [this](RenameSnapshot& c) { rename_snapshot(c); },
                          [this](ShowSnapshot& c) { show_snapshot(c); },
                          [this](RestoreSnapshot& c) { restore_snapshot(c); }},
               command);
}

void PaintThread::say(std::string message) {
    const std::lock_guard lock(mutex_);
    update_.messages.push_back(std::move(message));
}

ProgressFn PaintThread::progress(const std::string& name) {
    return [this, name](std::string_view, double fraction) {
        const std::lock_guard lock(mutex_);
        update_.busy = name;
        update_.fraction = fraction;
        return !stop_.load();
    };
}

// Hands over what changed. Only this thread calls it (or the maker, before there is one).
void PaintThread::publish(bool strokes_changed) {
    stroke::Document& painting = *work_.painting;
    const std::vector<std::uint32_t> dirty = painting.take_dirty();
    thumbnails_.touch(dirty);
    std::vector<render::TilePixels> tiles = work_.texture->refresh(dirty, painting);
    if (strokes_changed) {
        const auto& strokes = painting.journal().entries();
        // Entries that are still right stay; ids and order tell.
        std::size_t same = 0;
        while (same < lines_.size() && same < strokes.size() && lines_[same].id == strokes[same].id &&
               lines_[same].brush == stroke::brush_of(strokes[same]) &&
               lines_[same].ink == stroke::ink_of(strokes[same]) && lines_[same].hidden == strokes[same].hidden &&
               lines_[same].group == strokes[same].group)
            ++same;
        lines_.resize(same);
        for (; same < strokes.size(); ++same) lines_.push_back(stroke_line(strokes[same]));
    }
    const std::vector<std::uint32_t> wells = painting.take_palette_dirty();
    if (!wells.empty()) refresh(palette_, painting, wells);
    if (strokes_changed) look_at_brush();
    const brush::TuftState* tuft = painting.tuft();
    send_tiles(std::move(tiles));
    const std::lock_guard lock(mutex_);
    if (strokes_changed) update_.strokes = lines_;
    update_.tuft = tuft ? *tuft : brush::TuftState{};
    update_.on_palette = tuft && current_.layer == stroke::kPaletteLayer;
    if (!wells.empty()) update_.palette = palette_;
    update_.brush_colour = brush_colour_;
    update_.done = asked_;
    update_.busy.clear();
    update_.fraction = 0;
    const stroke::BrushInHand* held = work_.painting->held(current_.brush);
    update_.fullness = held ? held->reservoir.fullness() : 1;
    update_.layers = painting.layers();
    update_.masks = painting.masks();
    update_.wet =
        std::ranges::any_of(painting.canvases(), [](const stroke::LayerTexels& l) { return l.canvas->wet(); });
    update_.can_undo = !steps_.empty() && !work_.autosave.viewing();
    update_.undo_seconds = undo_seconds_;
    update_.can_redo = !undone_.empty();
    update_.project = work_.autosave.path();
    update_.trouble = work_.autosave.trouble();
    update_.unkept = work_.autosave.waiting();
    update_.behind = work_.autosave.behind();
    update_.viewing = work_.autosave.viewing();
    last_publish_ = now();
}

void PaintThread::send_tiles(std::vector<render::TilePixels> tiles) {
    const std::lock_guard lock(mutex_);
    std::set<std::uint32_t> fresh;
    for (const render::TilePixels& tile : tiles) fresh.insert(tile.tile);
    std::erase_if(update_.tiles, [&](const render::TilePixels& t) { return fresh.contains(t.tile); });
    update_.tiles.insert(update_.tiles.end(), std::make_move_iterator(tiles.begin()),
                         std::make_move_iterator(tiles.end()));
}

void PaintThread::begin(const BeginStroke& command) {
    cancel();
    current_ = command;
    if (const stroke::BrushInHand* held = work_.painting->held(command.brush); command.as_it_is && held)
        current_.ink = held->named;
    work_.autosave.prepare(*work_.painting, command.brush, command.ink);
    if (!command.tip_ink.empty()) undone_before_ = work_.painting->journal().undone();
    load_tip(command, loads_);
    stroke::PaintStroke stroke{.trace = {.flat = false}, .brush = command.brush, .ink = current_.ink};
    if (command.carry || loads_ > 0) stroke.settings.dip = stroke::DipMode::carry;
    if (command.wet) stroke.settings.film = stroke::FilmModel::wet;
    stroke.layer = current_.layer = layer_of(command.layer);
    stroke.mask = command.mask;
    if (command.erases) stroke.tool = stroke::Tool::eraser;
    work_.painting->begin(std::move(stroke));
}

void PaintThread::care(const ActOnBrush& command) {
    work_.autosave.prepare(*work_.painting, command.brush, command.ink);
    if (command.action == stroke::EntryKind::dry) return act(stroke::Dry{.seconds = command.seconds});
    if (command.action == stroke::EntryKind::wash) return act(stroke::WashPalette{});
    stroke::BrushAction action{.kind = stroke::brush_action_of(command.action),
                               .brush = command.brush,
                               .extent = command.extent,
                               .dip = stroke::DipMode::carry};
    // A brush that is not held yet begins full of the chosen ink.
    if (action.kind == stroke::BrushActionKind::dip || !work_.painting->held(command.brush)) action.ink = command.ink;
    act(std::move(action));
}

void PaintThread::change_layers(const ChangeLayers& command) {
    const stroke::LayerTable& table = work_.painting->layers();
    stroke::LayerEdit edit = command.edit;
    std::string label = edit.layer.name;
    if (edit.what == stroke::LayerChange::remove)
        if (const stroke::Layer* layer = table.find(edit.layer.id)) label = layer->name;
    // The button may be pressed twice before the first new layer is shown.
    if (stroke::Layer& layer = edit.layer; edit.what == stroke::LayerChange::add) {
        if (layer.id < table.next_id) {
            layer.id = 0;
            edit.place = static_cast<std::uint32_t>(table.layers.size());
        }
        const std::string stem = layer.name.substr(0, layer.name.find_last_not_of("0123456789") + 1);
        for (std::size_t n = table.layers.size() + 1; table.find(std::string_view(layer.name)); ++n)
            layer.name = stem + std::to_string(n);
        label = layer.name;
    }
    act({std::move(edit), std::move(label)});
}

void PaintThread::fill(const FillModel& command) {
    progress("Filling")("", 0);
    work_.autosave.prepare(*work_.painting, "", command.ink);
    stroke::Fill fill = command.fill;
    fill.ink = command.ink;
    fill.layer = layer_of(command.layer);
    fill.mask = command.mask;
    act(std::move(fill));
}

std::uint32_t PaintThread::layer_of(std::uint32_t asked) const {
    const stroke::LayerTable& table = work_.painting->layers();
    if (asked != kNewestLayer) return asked;
    return table.find(table.next_id - 1) ? table.next_id - 1 : table.layers.back().id;
}

// An entry that is done at once.
void PaintThread::act(stroke::JournalEntry entry) {
    cancel();
    work_.painting->paint(std::move(entry));
    work_.autosave.add(work_.painting->journal().entries().back());
    steps_.push_back({.made = 1});
    undone_.clear();
    publish(true);
}

void PaintThread::paint_drawing(PaintDrawing& command) {
    cancel();
    const ProgressFn shown = progress("Placing the drawing");
    shown("", 0);
    PlacedWriting& drawing = command.drawing;
    drawing.fit.film = [this](const std::string& ink) { return work_.painting->ink(ink).film * ink::kFilmUnit; };
    stroke::choose_brushes(drawing.entries, stroke::drawing_in(drawing.entries, true), drawing.scale, drawing.extent,
                           drawing.fit, widths_);
    stroke::redip_long_lines(drawing.entries, drawing.fit, widths_);
    stroke::press_to_widths(drawing.entries, widths_);
    std::vector<stroke::JournalEntry> all = drawing.entries;
    const std::size_t in_group = std::max<std::size_t>(1, all.size());
    for (const stroke::PoseMap& map : stroke::symmetry_copies(command.symmetry)) {
        const double reads =
            glm::determinant(map.linear) < 0 ? -1 : 1;  // with its right turned back it reads as the original
        for (stroke::JournalEntry entry : drawing.entries) {
            if (stroke::PaintStroke* stroke = entry.as<stroke::PaintStroke>()) {
                stroke::Placement& p = stroke->trace.placement;
                p = {map.point(p.origin), reads * (map.linear * p.right), map.linear * p.down, p.mapping};
            }
            all.push_back(std::move(entry));
        }
    }
    undone_.clear();
    steps_.push_back({});
    stroke::EntryGroup group;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!shown("", static_cast<double>(i) / static_cast<double>(all.size()))) break;
        work_.autosave.prepare(*work_.painting, stroke::brush_of(all[i]), stroke::ink_of(all[i]));
        if (stroke::PaintStroke* stroke = all[i].as<stroke::PaintStroke>()) {
            stroke->layer = layer_of(command.layer);
            stroke->mask = command.mask;
            if (command.wet) stroke->settings.film = stroke::FilmModel::wet;
        }
        if (i % in_group == 0 && !command.name.empty())
            group = {work_.painting->journal().next_group_id(), command.name};
        all[i].group = group;
        work_.painting->paint(std::move(all[i]));
        work_.autosave.add(work_.painting->journal().entries().back());
        ++steps_.back().made;
        publish(true);
    }
    if (steps_.back().made == 0) steps_.pop_back();
    publish(true);
}

void PaintThread::extend(const ExtendStroke& command) {
    if (!work_.painting->in_stroke()) return;
    const std::span<const brush::Pose> poses(command.poses);
    for (std::size_t i = 0; i < poses.size(); i += kPosesAtOnce) {
        work_.painting->extend(poses.subspan(i, std::min(kPosesAtOnce, poses.size() - i)));
        if (now() - last_publish_ > kPublishEvery) publish();
    }
    asked_ = command.asked;
    publish();
}

void PaintThread::end() {
    stroke::Document& painting = *work_.painting;
    if (!painting.in_stroke()) return;
    painting.end();
    work_.autosave.add(painting.journal().entries().back());
    const stroke::JournalEntry original = painting.journal().entries().back();
    steps_.push_back({.made = 1 + std::exchange(loads_, 0), .joined = current_.joined && !steps_.empty()});
    std::size_t& made = steps_.back().made;
    undone_.clear();
    publish(true);
    for (const stroke::PoseMap& map : stroke::symmetry_copies(current_.symmetry)) {
        load_tip(current_, made);
        stroke::JournalEntry copy = original;
        copy.label = "symmetric to " + std::to_string(original.id);
        for (stroke::StrokeSample& sample : std::get<stroke::PaintStroke>(copy.content).trace.samples) {
            const brush::Pose pose = map.pose({sample.position, sample.rotation, sample.time});
            sample.position = pose.position;
            sample.rotation = pose.rotation;
        }
        painting.paint(std::move(copy));
        work_.autosave.add(painting.journal().entries().back());
        ++made;
        publish(true);
    }
}

void PaintThread::cancel() {
    if (!work_.painting->in_stroke()) return;
    work_.painting->cancel();
    drop_loads();
    publish(true);
}

// A stroke that does not come leaves no entry of its loading, and what could be redone before it still can.
void PaintThread::drop_loads() {
    if (loads_ == 0) return;
    for (; loads_ > 0; --loads_) {
        const std::uint64_t id = work_.painting->journal().entries().back().id;
        work_.painting->undo();
        work_.autosave.remove(id);
    }
    work_.painting->restore_undone(std::move(undone_before_));
}

}  // namespace tuft::app
