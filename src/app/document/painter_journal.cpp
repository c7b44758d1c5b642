#include <algorithm>
#include <chrono>
#include <utility>

#include "app/document/painter.h"

/// Going back over the journal, and changing what is in it: on the painter's thread.
namespace tuft::app {
namespace {

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

void Painter::undo() {
    cancel();
    const auto start = std::chrono::steady_clock::now();
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
    undo_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
    painting->restore_undone(old.journal().undone());
    replace_painting(std::move(painting));
}

// The same model with other strokes on it.
void Painter::replace_painting(std::unique_ptr<stroke::Painting> painting) {
    for (const stroke::LayerTexels& layer : work_.painting->canvases())
        for (const std::uint32_t slot : layer.canvas->touched_slots()) painting->canvas().mark_dirty(slot);
    work_.painting = std::move(painting);
    lines_.clear();
    if (!palette_.rgb.empty()) {
        refresh(palette_, *work_.painting);
        const std::lock_guard lock(mutex_);
        update_.palette = palette_;
    }
    publish(true);
}

}  // namespace tuft::app
