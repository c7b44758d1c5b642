#include "app/painter.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

namespace tuft::app {
namespace {

constexpr double kPublishEvery = 0.012;  // seconds
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

void shift(stroke::Stroke& stroke, const RigidMove& move) {
    const auto moved = [&](const Vec3& p) { return move.to + move.rotation * (p - move.from); };
    stroke::Placement& place = stroke.trace.placement;
    if (stroke.trace.flat) {
        place = {moved(place.origin), move.rotation * place.right, move.rotation * place.down, place.laying};
        return;
    }
    for (stroke::TraceSample& s : stroke.trace.samples) {
        s.position = moved(s.position);
        s.rotation = glm::normalize(move.rotation * s.rotation);
    }
}

}  // namespace

Painter::Painter(Work work) : work_(std::move(work)) {
    work_.painting->take_dirty();
    const std::vector<std::string> shipped = ink::list_inks();
    for (const std::string& name : work_.keeper.inks())
        if (std::find(shipped.begin(), shipped.end(), name) == shipped.end()) own_inks_.push_back(work_.painting->ink(name));
    update_.own_inks = own_inks_;
    publish_looks();
    if (work_.painting->palette()) {
        refresh(palette_, *work_.painting);
        update_.palette = palette_;
    }
    steps_.assign(work_.painting->journal().strokes().size(), Step{.made = 1});
    publish(true);
    thread_ = std::thread([this] { run(); });
}

Painter::~Painter() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void Painter::post(Command command) {
    {
        const std::lock_guard lock(mutex_);
        queue_.push_back(std::move(command));
    }
    wake_.notify_all();
}

const atlas::AtlasReport* Painter::atlas_report() {
    const stroke::Model& model = *work_.model;
    if (model.atlas_report.charts > 0) return &model.atlas_report;
    if (!measured_.valid()) measured_ = std::async(std::launch::async, [&model] { return atlas::measure(*model.mesh, model.atlas); }).share();
    return measured_.wait_for(std::chrono::seconds(0)) == std::future_status::ready ? &measured_.get() : nullptr;
}

bool Painter::idle() const {
    const std::lock_guard lock(mutex_);
    return queue_.empty() && !working_;
}

void Painter::wait_idle(double seconds) const {
    std::unique_lock lock(mutex_);
    rests_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return queue_.empty() && !working_; });
}

Update Painter::take() {
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
    update_.own_inks.reset();
    update_.palette.reset();
    update_.on_palette = out.on_palette;
    update_.brush_colour = out.brush_colour;
    update_.looks.reset();
    update_.picked.clear();
    update_.wet = out.wet;
    update_.undo_seconds = out.undo_seconds;
    update_.trouble = out.trouble;
    update_.project = out.project;
    out.waiting = queue_.size() + (working_ ? 1 : 0);
    return out;
}

void Painter::run() {
    for (;;) {
        Command command;
        {
            std::unique_lock lock(mutex_);
            working_ = false;
            if (queue_.empty()) rests_.notify_all();
            wake_.wait(lock, [this] { return quit_ || !queue_.empty(); });
            if (queue_.empty()) break;
            command = std::move(queue_.front());
            queue_.pop_front();
            working_ = true;
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
    }
    if (work_.painting->in_stroke()) end();
    if (work_.keeper.behind()) work_.keeper.rewrite(work_.source, work_.frame, *work_.painting);
    work_.keeper.store_canvas(*work_.painting);
}

void Painter::perform(Command& command) {
    stop_ = false;
    std::visit(Overloaded{[this](BeginStroke& c) { begin(c); }, [this](ExtendStroke& c) { extend(c); },
                          [this](EndStroke&) { end(); },
                          [this](CareForBrush& c) { care(c); }, [this](PaintTraces& c) { paint_traces(c); },
                          [this](CancelStroke&) { cancel(); },
                          [this](UndoStroke&) { undo(); }, [this](RedoStroke&) { redo(); },
                          [this](SaveProject& c) {
                              const std::string fault =
                                  work_.keeper.start(c.path, work_.source, work_.frame, *work_.painting);
                              say(fault.empty() ? "Saved as " + c.path.string() : fault);
                              publish();
                          },
                          [this](FillModel& c) { fill(c); }, [this](ChangeLayers& c) { change_layers(c); },
                          [this](SendTexture& c) {
                              publish();
                              work_.texture->show_wetness(c.wetness, *work_.painting);
                              send_pixels();
                          },
                          [this](PickInk& c) { pick(c); }, [this](TakeInk& c) { add_ink(std::move(c.ink)); },
                          [this](RecolourInk& c) { recolour(c); }, [this](ShowOn& c) { show_on(c); },
                          [this](ChangeMasks& c) { change_masks(c); }, [this](ShowMask& c) { show_mask(c); },
                          [this](ExportModel& c) { export_model(c); }, [this](EditStroke& c) { edit(c); }},
               command);
}

void Painter::say(std::string message) {
    const std::lock_guard lock(mutex_);
    update_.messages.push_back(std::move(message));
}

ProgressFn Painter::progress(const std::string& name) {
    return [this, name](std::string_view, double fraction) {
        const std::lock_guard lock(mutex_);
        update_.busy = name;
        update_.fraction = fraction;
        return !stop_.load();
    };
}

// Hands over what changed. Only this thread calls it (or the maker, before there is one).
void Painter::publish(bool strokes_changed) {
    stroke::Painting& painting = *work_.painting;
    std::vector<render::TilePixels> tiles = work_.texture->refresh(painting.take_dirty(), painting);
    if (strokes_changed) {
        const auto& strokes = painting.journal().strokes();
        // Entries that are still right stay; ids and order tell.
        std::size_t same = 0;
        while (same < lines_.size() && same < strokes.size() && lines_[same].id == strokes[same].id &&
               lines_[same].brush == strokes[same].trace.brush && lines_[same].ink == strokes[same].trace.ink &&
               lines_[same].hidden == strokes[same].hidden)
            ++same;
        lines_.resize(same);
        for (; same < strokes.size(); ++same) lines_.push_back(stroke_line(strokes[same]));
    }
    const std::vector<std::uint32_t> wells = painting.take_palette_dirty();
    if (!wells.empty()) refresh(palette_, painting, wells);
    if (strokes_changed) look_at_brush();
    const brush::TuftState* tuft = painting.tuft();
    const std::lock_guard lock(mutex_);
    if (update_.tiles.empty()) update_.tiles = std::move(tiles);
    else {
        std::set<std::uint32_t> fresh;
        for (const render::TilePixels& tile : tiles) fresh.insert(tile.tile);
        std::erase_if(update_.tiles, [&](const render::TilePixels& t) { return fresh.contains(t.tile); });
        update_.tiles.insert(update_.tiles.end(), tiles.begin(), tiles.end());
    }
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
    update_.wet = std::ranges::any_of(painting.canvases(), [](const stroke::LayerTexels& l) { return l.canvas->wet(); });
    update_.can_undo = !steps_.empty();
    update_.undo_seconds = undo_seconds_;
    update_.can_redo = !undone_.empty();
    update_.project = work_.keeper.path();
    update_.trouble = work_.keeper.trouble();
    if (!update_.trouble.empty() && work_.keeper.waiting() > 0)
        update_.trouble += " (" + std::to_string(work_.keeper.waiting()) + " strokes wait in memory)";
    last_publish_ = now();
}

void Painter::begin(const BeginStroke& command) {
    cancel();
    current_ = command;
    if (const stroke::BrushInHand* held = work_.painting->held(command.brush); command.as_it_is && held) current_.ink = held->named;
    work_.keeper.prepare(*work_.painting, command.brush, command.ink);
    if (!command.tip_ink.empty()) undone_before_ = work_.painting->journal().undone();
    load_tip(command, loads_);
    stroke::Stroke stroke;
    stroke.trace.flat = false;
    stroke.trace.brush = command.brush;
    stroke.trace.ink = current_.ink;
    if (command.carry || loads_ > 0) stroke.settings.dip = "carry";
    if (command.wet) stroke.settings.film = "wet";
    stroke.layer = command.layer;
    stroke.mask = command.mask;
    stroke.trace.erases = command.erases;
    work_.painting->begin(std::move(stroke));
}

void Painter::care(const CareForBrush& command) {
    work_.keeper.prepare(*work_.painting, command.brush, command.ink);
    stroke::Stroke entry;
    entry.action = command.action;
    entry.trace.flat = false;
    entry.trace.brush = command.brush;
    // A brush that is not held yet begins full of the chosen ink.
    if (command.action == stroke::Action::dip || !work_.painting->held(command.brush)) entry.trace.ink = command.ink;
    entry.seconds = command.seconds;
    entry.extent = command.extent;
    entry.settings.dip = "carry";
    act(std::move(entry));
}

void Painter::change_layers(const ChangeLayers& command) {
    stroke::Stroke entry;
    entry.action = stroke::Action::layer;
    entry.trace.flat = false;
    entry.trace.label = command.edit.layer.name;
    if (command.edit.what == stroke::LayerChange::remove)
        if (const stroke::Layer* layer = work_.painting->layers().find(command.edit.layer.id)) entry.trace.label = layer->name;
    entry.edit = command.edit;
    act(std::move(entry));
}

void Painter::fill(const FillModel& command) {
    progress("Filling")("", 0);
    work_.keeper.prepare(*work_.painting, "", command.ink);
    stroke::Stroke entry;
    entry.action = stroke::Action::fill;
    entry.trace.flat = false;
    entry.trace.ink = command.ink;
    entry.fill = command.fill;
    entry.layer = command.layer;
    entry.mask = command.mask;
    act(std::move(entry));
}

// An entry that is done at once.
void Painter::act(stroke::Stroke entry) {
    cancel();
    work_.painting->paint(std::move(entry));
    work_.keeper.add(work_.painting->journal().strokes().back());
    steps_.push_back({.made = 1});
    undone_.clear();
    publish(true);
}

void Painter::paint_traces(PaintTraces& command) {
    cancel();
    std::vector<stroke::Trace> all = command.traces;
    for (const stroke::PoseMap& map : stroke::symmetry_copies(command.symmetry)) {
        if (glm::determinant(map.linear) < 0) continue;
        for (stroke::Trace trace : command.traces) {
            stroke::Placement& p = trace.placement;
            p = {map.point(p.origin), map.linear * p.right, map.linear * p.down, p.laying};
            all.push_back(std::move(trace));
        }
    }
    undone_.clear();
    steps_.push_back({});
    const ProgressFn shown = progress("Laying it down");
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!shown("", static_cast<double>(i) / static_cast<double>(all.size()))) break;
        work_.keeper.prepare(*work_.painting, all[i].brush, all[i].ink);
        stroke::Stroke entry{.trace = std::move(all[i]), .layer = command.layer, .mask = command.mask};
        if (command.wet) entry.settings.film = "wet";
        work_.painting->paint(std::move(entry));
        work_.keeper.add(work_.painting->journal().strokes().back());
        ++steps_.back().made;
        publish(true);
    }
    if (steps_.back().made == 0) steps_.pop_back();
    publish(true);
}

void Painter::extend(const ExtendStroke& command) {
    if (!work_.painting->in_stroke()) return;
    const std::span<const brush::Pose> poses(command.poses);
    for (std::size_t i = 0; i < poses.size(); i += kPosesAtOnce) {
        work_.painting->extend(poses.subspan(i, std::min(kPosesAtOnce, poses.size() - i)));
        if (now() - last_publish_ > kPublishEvery) publish();
    }
    asked_ = command.asked;
    publish();
}

void Painter::end() {
    stroke::Painting& painting = *work_.painting;
    if (!painting.in_stroke()) return;
    painting.end();
    work_.keeper.add(painting.journal().strokes().back());
    const stroke::Stroke original = painting.journal().strokes().back();
    steps_.push_back({.made = 1 + std::exchange(loads_, 0), .joined = current_.joined && !steps_.empty()});
    std::size_t& made = steps_.back().made;
    undone_.clear();
    publish(true);
    for (const stroke::PoseMap& map : stroke::symmetry_copies(current_.symmetry)) {
        load_tip(current_, made);
        stroke::Stroke copy = original;
        copy.trace.label = "symmetric to " + std::to_string(original.id);
        for (stroke::TraceSample& sample : copy.trace.samples) {
            const brush::Pose pose = map.pose({sample.position, sample.rotation, sample.time});
            sample.position = pose.position;
            sample.rotation = pose.rotation;
        }
        painting.paint(std::move(copy));
        work_.keeper.add(painting.journal().strokes().back());
        ++made;
        publish(true);
    }
}

void Painter::cancel() {
    if (!work_.painting->in_stroke()) return;
    work_.painting->cancel();
    drop_loads();
    publish(true);
}

// A stroke that does not come leaves no entry of its loading, and what could be redone before it still can.
void Painter::drop_loads() {
    if (loads_ == 0) return;
    for (; loads_ > 0; --loads_) {
        const std::uint64_t id = work_.painting->journal().strokes().back().id;
        work_.painting->undo();
        work_.keeper.remove(id);
    }
    work_.painting->restore_undone(std::move(undone_before_));
}

void Painter::undo() {
    cancel();
    const double start = now();
    for (bool more = true; more && !steps_.empty();) {
        const Step& step = steps_.back();
        more = step.joined;
        if (step.change) put(*step.change, true);
        for (std::size_t i = 0; i < step.made && work_.painting->journal().can_undo(); ++i) {
            const std::uint64_t id = work_.painting->journal().strokes().back().id;
            work_.painting->undo();
            work_.keeper.remove(id);
        }
        undone_.push_back(std::move(steps_.back()));
        steps_.pop_back();
    }
    undo_seconds_ = now() - start;
    publish(true);
}

void Painter::redo() {
    cancel();
    for (bool more = true; more && !undone_.empty(); more = !undone_.empty() && undone_.back().joined) {
        const Step& step = undone_.back();
        if (step.change) put(*step.change, false);
        for (std::size_t i = 0; i < step.made; ++i)
            if (work_.painting->redo()) work_.keeper.add(work_.painting->journal().strokes().back());
        steps_.push_back(std::move(undone_.back()));
        undone_.pop_back();
    }
    publish(true);
}

void Painter::edit(const EditStroke& command) {
    cancel();
    const std::vector<stroke::Stroke>& strokes = work_.painting->journal().strokes();
    const auto at = std::find_if(strokes.begin(), strokes.end(), [&](const auto& s) { return s.id == command.id; });
    if (at == strokes.end()) return;
    Change change{.at = static_cast<std::size_t>(at - strokes.begin()), .before = *at, .after = {}};
    if (!command.remove) {
        stroke::Stroke& after = change.after.emplace(*at);
        if (command.hidden) after.hidden = *command.hidden;
        if (command.brush) after.trace.brush = *command.brush;
        if (command.ink) after.trace.ink = *command.ink;
        if (command.move) shift(after, *command.move);
        if (command.brush || command.ink) work_.keeper.prepare(*work_.painting, after.trace.brush, after.trace.ink);
    }
    put(change, false);
    work_.painting->restore_undone({});
    undone_.clear();
    steps_.push_back({.change = std::move(change), .joined = command.joined && !steps_.empty()});
    publish(true);
}

// Changes an entry, or changes it back, and paints all strokes anew.
void Painter::put(const Change& change, bool back) {
    const stroke::Stroke& from = change.before;
    std::vector<stroke::Stroke> strokes = work_.painting->journal().strokes();
    const auto at = strokes.begin() + static_cast<std::ptrdiff_t>(change.at);
    if (!change.after && back) strokes.insert(at, from);
    else if (!change.after) strokes.erase(at);
    else *at = back ? from : *change.after;
    rewrite(std::move(strokes));
    if (!change.after && !back) return work_.keeper.remove(from.id);
    if (change.after && change.after->hidden != from.hidden) return work_.keeper.set_hidden(from.id, back ? from.hidden : change.after->hidden);
    // Rows can only be added and taken out: the file is written anew, whole or not at all.
    work_.keeper.rewrite(work_.source, work_.frame, *work_.painting);
}

// Ground, brushes, inks and looks as the journal's strokes were painted with.
void Painter::take_presets(stroke::Painting& painting) {
    stroke::Painting& own = *work_.painting;
    painting.use_substrate(own.painted_on());
    if (own.shown_elsewhere()) painting.show_on(own.substrate());
    for (const stroke::Stroke& s : own.journal().strokes()) {
        if (stroke::has_brush(s.action)) painting.use_brush(own.brush(s.trace.brush));
        if (!s.trace.ink.empty()) painting.use_ink(own.ink(s.trace.ink));
    }
    for (const auto& [name, wanted] : own.recolours()) {
        painting.use_ink(own.ink(name));
        painting.recolour(name, wanted);
    }
}

// Paints all strokes anew beside what is there, then puts it in its place.
void Painter::rewrite(std::vector<stroke::Stroke> strokes) {
    stroke::Painting& old = *work_.painting;
    auto painting = std::make_unique<stroke::Painting>(*work_.model);
    take_presets(*painting);
    for (const stroke::Stroke& s : strokes) {  // a change may name new ones
        if (stroke::has_brush(s.action)) painting->use_brush(old.brush(s.trace.brush));
        for (const std::string& ink : stroke::inks_of(s)) painting->use_ink(old.ink(ink));
    }
    painting->replay(std::move(strokes), progress("Painting again"));
    for (const stroke::LayerTexels& layer : old.canvases())
        for (const std::uint32_t slot : layer.canvas->touched_slots()) painting->canvas().mark_dirty(slot);
    painting->restore_undone(old.journal().undone());
    work_.painting = std::move(painting);
    lines_.clear();
    if (!palette_.rgb.empty()) {
        refresh(palette_, *work_.painting);
        const std::lock_guard lock(mutex_);
        update_.palette = palette_;
    }
    publish(true);
}

StrokeLine stroke_line(const stroke::Stroke& stroke) {
    StrokeLine line{.id = stroke.id, .action = stroke.action, .brush = stroke.trace.brush, .ink = stroke.trace.ink, .label = stroke.trace.label,
                    .hidden = stroke.hidden, .erases = stroke.trace.erases, .on_palette = stroke.layer == stroke::kPaletteLayer};
    const auto& samples = stroke.trace.samples;
    if (samples.empty()) return line;
    Vec3 normal(0);
    Vec3 mean(0);
    for (const stroke::TraceSample& s : samples) {
        normal += stroke.trace.flat ? Vec3(0, 0, 1) : glm::normalize(s.rotation) * Vec3(0, 0, 1);
        mean += s.position / static_cast<double>(samples.size());
    }
    if (glm::length(normal) < 1e-9) normal = {0, 0, 1};
    normal = glm::normalize(normal);
    // Seen from outside with z, or else y, upwards.
    const Vec3 above = std::abs(normal.z) < 0.95 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    Vec3 right = glm::normalize(glm::cross(above, normal));
    Vec3 down = -glm::cross(normal, right);
    if (stroke.trace.flat) right = {1, 0, 0}, down = {0, 1, 0};
    double lo_x = 0, hi_x = 0, lo_y = 0, hi_y = 0, lo_z = 1e9, hi_z = -1e9;
    const std::size_t n = std::min<std::size_t>(40, samples.size());
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < n; ++i) {
        const stroke::TraceSample& s = samples[i * (samples.size() - 1) / std::max<std::size_t>(1, n - 1)];
        const Vec3 d = s.position - mean;
        points.emplace_back(glm::dot(d, right), glm::dot(d, down), stroke.trace.flat ? -s.pressure : glm::dot(d, normal));
        lo_x = std::min(lo_x, points.back().x), hi_x = std::max(hi_x, points.back().x);
        lo_y = std::min(lo_y, points.back().y), hi_y = std::max(hi_y, points.back().y);
        lo_z = std::min(lo_z, points.back().z), hi_z = std::max(hi_z, points.back().z);
    }
    const double span = std::max({hi_x - lo_x, hi_y - lo_y, 1e-4});
    if (!stroke.trace.flat && !line.on_palette)
        for (std::size_t i = 0; i < n; ++i) line.places.emplace_back(samples[i * (samples.size() - 1) / std::max<std::size_t>(1, n - 1)].position);
    for (const Vec3& p : points)
        line.way.emplace_back(0.5 + (p.x - 0.5 * (lo_x + hi_x)) / span, 0.5 + (p.y - 0.5 * (lo_y + hi_y)) / span,
                              (hi_z - p.z) / std::max(1e-6, hi_z - lo_z));
    for (std::size_t i = 1; i < samples.size(); ++i)
        line.length += glm::distance(samples[i - 1].position, samples[i].position);
    return line;
}

}  // namespace tuft::app
