#include "app/paint/stroke_painter.h"

#include <algorithm>
#include <span>
#include <utility>

namespace tuft::app {
namespace {

constexpr std::size_t kPosesAtOnce = 8;  // between two looks at the clock

}  // namespace

void StrokePainter::begin(const BeginStroke& command) {
    cancel();
    current_ = command;
    context_.publisher.set_brush(command.brush, command.layer == stroke::kPaletteLayer);
    if (const stroke::BrushInHand* held = context_.work.document->held(command.brush); command.as_it_is && held)
        current_.ink = held->named;
    context_.work.autosave.prepare(*context_.work.document, command.brush, command.ink);
    if (!command.tip_ink.empty()) undone_before_ = context_.work.document->journal().undone();
    load_tip(command, loads_);
    stroke::Stroke stroke;
    stroke.trace.flat = false;
    stroke.trace.brush = command.brush;
    stroke.trace.ink = current_.ink;
    if (command.carry || loads_ > 0) stroke.settings.dip = "carry";
    if (command.wet) stroke.settings.film = "wet";
    stroke.layer = current_.layer = context_.layer_of(command.layer);
    stroke.mask = command.mask;
    stroke.trace.erases = command.erases;
    context_.work.document->begin(std::move(stroke));
}

// A brush with another ink in its tip is loaded before every stroke: dipped, the tip wiped, the tip
// dipped into the other ink. Counts the entries that this makes.
void StrokePainter::load_tip(const BeginStroke& command, std::size_t& made) {
    if (command.tip_ink.empty() || command.carry || command.erases) return;
    context_.work.autosave.prepare(*context_.work.document, command.brush, command.tip_ink);
    const std::pair<stroke::Action, std::string> steps[] = {
        {stroke::Action::dip, command.ink}, {stroke::Action::wipe, ""}, {stroke::Action::dip, command.tip_ink}};
    for (std::size_t i = 0; i < std::size(steps); ++i) {
        stroke::Stroke entry;
        entry.action = steps[i].first;
        entry.trace.flat = false;
        entry.trace.brush = command.brush;
        entry.trace.ink = steps[i].second;
        entry.settings.dip = i == 0 ? "each" : "carry";
        if (i > 0) entry.extent.depth = command.tip_depth;
        context_.work.document->paint(std::move(entry));
        context_.work.autosave.add(context_.work.document->journal().strokes().back());
        ++made;
    }
}

void StrokePainter::extend(const ExtendStroke& command) {
    if (!context_.work.document->in_stroke()) return;
    const std::span<const brush::Pose> poses(command.poses);
    for (std::size_t i = 0; i < poses.size(); i += kPosesAtOnce) {
        context_.work.document->extend(poses.subspan(i, std::min(kPosesAtOnce, poses.size() - i)));
        context_.publisher.publish_if_due();
    }
    context_.publisher.set_done(command.asked);
    context_.publisher.publish();
}

void StrokePainter::end() {
    stroke::Document& document = *context_.work.document;
    if (!document.in_stroke()) return;
    document.end();
    context_.work.autosave.add(document.journal().strokes().back());
    const stroke::Stroke original = document.journal().strokes().back();
    EditHistory& history = context_.history;
    history.add({.made = 1 + std::exchange(loads_, 0), .joined = current_.joined && !history.done.empty()});
    context_.publisher.publish(true);
    add_copies(original, history.done.back().made);
}

void StrokePainter::add_copies(const stroke::Stroke& original, std::size_t& made) {
    for (const stroke::PoseMap& map : stroke::symmetry_copies(current_.symmetry)) {
        load_tip(current_, made);
        stroke::Stroke copy = original;
        copy.trace.label = "symmetric to " + std::to_string(original.id);
        for (stroke::TraceSample& sample : copy.trace.samples) {
            const brush::Pose pose = map.pose({sample.position, sample.rotation, sample.time});
            sample.position = pose.position;
            sample.rotation = pose.rotation;
        }
        context_.work.document->paint(std::move(copy));
        context_.work.autosave.add(context_.work.document->journal().strokes().back());
        ++made;
        context_.publisher.publish(true);
    }
}

void StrokePainter::cancel() {
    if (!context_.work.document->in_stroke()) return;
    context_.work.document->cancel();
    drop_loads();
    context_.publisher.publish(true);
}

void StrokePainter::drop_loads() {
    if (loads_ == 0) return;
    for (; loads_ > 0; --loads_) {
        const std::uint64_t id = context_.work.document->journal().strokes().back().id;
        context_.work.document->undo();
        context_.work.autosave.remove(id);
    }
    context_.work.document->restore_undone(std::move(undone_before_));
}

// The drawing in brushes and pressures that give its widths, then its symmetric copies.
std::vector<stroke::Stroke> StrokePainter::entries_of(PaintDrawing& command) {
    PlacedWriting& drawing = command.drawing;
    drawing.fit.film = [this](const std::string& ink) {
        return context_.work.document->ink(ink).film * ink::kFilmUnit;
    };
    stroke::choose_brushes(drawing.entries, stroke::drawing_in(drawing.entries, true), drawing.scale, drawing.extent,
                           drawing.fit, widths_);
    stroke::redip_long_lines(drawing.entries, drawing.fit, widths_);
    stroke::press_to_widths(drawing.entries, widths_);
    std::vector<stroke::Stroke> all = drawing.entries;
    for (const stroke::PoseMap& map : stroke::symmetry_copies(command.symmetry)) {
        const double reads =
            glm::determinant(map.linear) < 0 ? -1 : 1;  // with its right turned back it reads as the original
        for (stroke::Stroke entry : drawing.entries) {
            stroke::Placement& p = entry.trace.placement;
            p = {map.point(p.origin), reads * (map.linear * p.right), map.linear * p.down, p.mapping};
            all.push_back(std::move(entry));
        }
    }
    return all;
}

void StrokePainter::paint_drawing(PaintDrawing& command) {
    cancel();
    const ProgressFn shown = context_.progress("Placing the drawing");
    shown("", 0);
    std::vector<stroke::Stroke> all = entries_of(command);
    const std::size_t in_group = std::max<std::size_t>(1, command.drawing.entries.size());
    context_.history.undone.clear();
    context_.history.done.push_back({});
    stroke::EntryGroup group;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!shown("", static_cast<double>(i) / static_cast<double>(all.size()))) break;
        context_.work.autosave.prepare(*context_.work.document, all[i].trace.brush, all[i].trace.ink);
        all[i].layer = context_.layer_of(command.layer);
        all[i].mask = command.mask;
        if (command.wet) all[i].settings.film = "wet";
        if (i % in_group == 0 && !command.name.empty())
            group = {context_.work.document->journal().next_group_id(), command.name};
        all[i].group = group;
        context_.work.document->paint(std::move(all[i]));
        context_.work.autosave.add(context_.work.document->journal().strokes().back());
        ++context_.history.done.back().made;
        context_.publisher.publish(true);
    }
    if (context_.history.done.back().made == 0) context_.history.done.pop_back();
    context_.publisher.publish(true);
}

}  // namespace tuft::app
