#include "app/paint/stroke_painter.h"

#include <algorithm>
#include <utility>

#include "core/files/disk_cache.h"
#include "stroke/document/drawing_inks.h"
#include "stroke/document/fit.h"
#include "stroke/drawing/copies.h"

namespace tuft::app {

void StrokePainter::begin(const BeginStroke& command) {
    cancel();
    current_ = command;
    context_.publisher.set_brush(command.brush, command.layer == stroke::kPaletteLayer);
    if (const stroke::BrushInHand* held = context_.work.document->brushes().find(command.brush);
        command.as_it_is && held)
        current_.ink = held->named;
    context_.work.autosave.prepare(*context_.work.document, command.brush, command.ink);
    if (!command.tip_ink.empty()) undone_before_ = context_.work.document->journal().undone();
    load_tip(command, loads_);
    stroke::PaintStroke stroke{.trace = {.flat = false}, .brush = command.brush, .ink = current_.ink};
    if (command.persistent || loads_ > 0) stroke.settings.dip = stroke::DipMode::persistent;
    if (command.wet) stroke.settings.film = stroke::FilmModel::wet;
    stroke.layer = current_.layer = context_.layer_of(command.layer);
    stroke.mask = command.mask;
    if (command.erases) stroke.tool = stroke::Tool::eraser;
    context_.work.document->begin(std::move(stroke));
}

// A brush with another ink in its tip is loaded before every stroke: dipped, the tip wiped, the tip
// dipped into the other ink. Counts the entries that this makes.
void StrokePainter::load_tip(const BeginStroke& command, std::size_t& made) {
    if (command.tip_ink.empty() || command.persistent || command.erases) return;
    context_.work.autosave.prepare(*context_.work.document, command.brush, command.tip_ink);
    const stroke::BrushAction steps[] = {
        {.what = stroke::Dip{}, .brush = command.brush, .ink = command.ink},
        {.what = stroke::Wipe{.depth = command.tip_depth}, .brush = command.brush, .dip = stroke::DipMode::persistent},
        {.what = stroke::Dip{.depth = command.tip_depth},
         .brush = command.brush,
         .ink = command.tip_ink,
         .dip = stroke::DipMode::persistent}};
    for (const stroke::BrushAction& step : steps) {
        context_.work.document->paint(step);
        context_.work.autosave.add(context_.work.document->journal().entries().back());
        ++made;
    }
}

void StrokePainter::extend(const ExtendStroke& command, bool goes_on) {
    if (!context_.work.document->session()) return;
    context_.work.document->extend(command.poses, [this] { context_.publisher.publish_if_due(); });
    context_.publisher.set_done(command.requested_at);
    if (goes_on)
        context_.publisher.publish_if_due();
    else
        context_.publisher.publish();
}

void StrokePainter::end() {
    stroke::Document& document = *context_.work.document;
    if (!document.session()) return;
    document.end();
    context_.work.autosave.add(document.journal().entries().back());
    const stroke::JournalEntry original = document.journal().entries().back();
    EditHistory& history = context_.history;
    history.add({.made = 1 + std::exchange(loads_, 0), .joined = current_.joined && !history.done.empty()});
    context_.publisher.publish(true);
    add_copies(original, history.done.back().made);
}

void StrokePainter::add_copies(const stroke::JournalEntry& original, std::size_t& made) {
    for (const stroke::PoseMap& map : stroke::symmetry_copies(current_.symmetry)) {
        load_tip(current_, made);
        stroke::JournalEntry copy = stroke::copy_of(original, map, stroke::CopyReading::mirrored);
        copy.label = "symmetric to " + std::to_string(original.id);
        context_.work.document->paint(std::move(copy));
        context_.work.autosave.add(context_.work.document->journal().entries().back());
        ++made;
        context_.publisher.publish(true);
    }
}

void StrokePainter::cancel() {
    if (!context_.work.document->session()) return;
    context_.work.document->cancel();
    drop_loads();
    context_.publisher.publish(true);
}

void StrokePainter::drop_loads() {
    if (loads_ == 0) return;
    for (; loads_ > 0; --loads_) {
        const std::uint64_t id = context_.work.document->journal().entries().back().id;
        context_.work.document->undo();
        context_.work.autosave.remove(id);
    }
    context_.work.document->restore_undone(std::move(undone_before_));
}

std::function<double(const std::string&)> StrokePainter::film_of_inks() const {
    return
        [this](const std::string& ink) { return context_.work.document->materials().ink(ink).film * ink::kFilmUnit; };
}

// The drawing in brushes and pressures that give its widths.
std::vector<stroke::JournalEntry> StrokePainter::entries_of(PaintDrawing& command) {
    PlacedWriting& drawing = command.drawing;
    drawing.fit.film = film_of_inks();
    const std::vector<stroke::StrokeSamples*> traces = stroke::drawing_in(drawing.entries, true);
    stroke::choose_brushes(drawing.entries, {traces, drawing.scale, drawing.extent}, drawing.fit, widths_);
    stroke::redip_long_lines(drawing.entries, drawing.fit, widths_);
    stroke::press_to_widths(drawing.entries, widths_);
    return std::move(drawing.entries);
}

// Puts entries onto the layer and within the mask of their group.
void StrokePainter::direct(std::vector<stroke::JournalEntry>& entries, const GroupSettings& settings) {
    for (stroke::JournalEntry& entry : entries) {
        if (stroke::Fill* fill = entry.as<stroke::Fill>()) {
            fill->layer = context_.layer_of(settings.layer);
            fill->mask = settings.mask;
        }
        if (stroke::PaintStroke* stroke = entry.as<stroke::PaintStroke>()) {
            stroke->layer = context_.layer_of(settings.layer);
            stroke->mask = settings.mask;
            if (settings.wet) stroke->settings.film = stroke::FilmModel::wet;
        }
        context_.work.document->check_layer(entry);
    }
}

namespace {

/// Inks of entries that are named by colours (`#rrggbb`) and are not known yet.
std::vector<std::string> new_colours_of(const std::vector<stroke::JournalEntry>& entries,
                                        const stroke::Materials& materials) {
    std::vector<std::string> colours;
    for (const stroke::JournalEntry& entry : entries)
        for (std::string& ink : stroke::inks_of(entry))
            if (ink.starts_with('#') && !materials.has_ink(ink)) colours.push_back(std::move(ink));
    return colours;
}

}  // namespace

void StrokePainter::paint_drawing(PaintDrawing& command) {
    cancel();
    const ProgressFn shown = context_.progress("Placing the drawing");
    shown("", 0);
    direct(command.drawing.entries, command.group);  // a locked layer refuses it before any ink is mixed
    stroke::Document& document = *context_.work.document;
    const std::uint64_t before = document.journal().next_id();
    // Of a drawing that is refused no ink stays, or the next one would be mixed from its pigments. Brushes are chosen
    // by the film of inks, so that those of lines are mixed from there on.
    const std::vector<std::string> colours = new_colours_of(command.drawing.entries, document.materials());
    const auto forget_unused = [&] {
        if (document.journal().next_id() != before) return;
        std::vector<std::string> unused;
        for (const std::string& colour : colours)  // the project file has the others
            if (std::ranges::find(context_.own_inks, colour, &ink::Ink::name) == context_.own_inks.end())
                unused.push_back(colour);
        document.forget_inks(unused);
    };
    try {
        std::vector<stroke::JournalEntry> entries = entries_of(command);
        direct(entries, command.group);
        stroke::mix_drawing_inks(entries, document);
        paint_group(std::move(entries), command.group, shown);
    } catch (...) {
        forget_unused();
        throw;
    }
    forget_unused();
}

void StrokePainter::paint_text(PaintText& command) {
    cancel();
    const ProgressFn plans = context_.progress("Planning the strokes of the text");
    plans("", 0);
    writer::TextHand hand{.options = {}, .fit = command.fit, .cache = DiskCache(cache_folder("writer"))};
    hand.options.brush = command.brush;
    hand.options.ink = hand.options.other_ink = command.ink;
    stroke::BrushFit fit;
    fit.film = film_of_inks();
    std::vector<stroke::JournalEntry> entries =
        lettering_entries(command.text, command.place, hand, fit, widths_, plans);
    direct(entries, command.group);
    paint_group(std::move(entries), command.group, context_.progress("Writing the text"));
}

// Paints entries and their symmetric copies as one undo step, each copy as a group.
void StrokePainter::paint_group(std::vector<stroke::JournalEntry> entries, const GroupSettings& settings,
                                const ProgressFn& shown) {
    const std::size_t in_group = std::max<std::size_t>(1, entries.size());
    std::vector<stroke::JournalEntry> all = std::move(entries);
    for (const stroke::PoseMap& map : stroke::symmetry_copies(settings.symmetry))
        for (std::size_t i = 0; i < in_group && i < all.size(); ++i)
            all.push_back(stroke::copy_of(all[i], map, stroke::CopyReading::upright));
    const auto length_of = [&](const std::string& brush) {
        return context_.work.document->materials().brush(brush).length;
    };
    if (const Message fault = stroke::size_fault(all, length_of, *context_.work.model->query); !fault.empty())
        throw Error(Message("The model does not suit the drawing: {}", fault));
    if (const Message doubt = stroke::size_doubt(all, *context_.work.model->query); !doubt.empty())
        context_.outbox.report(doubt);
    for (const stroke::JournalEntry& entry : all) context_.work.document->check_size(entry);
    context_.history.undone.clear();
    context_.history.done.push_back({});
    stroke::EntryGroup group;
    double ink = 0;
    bool touched = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!shown("", static_cast<double>(i) / static_cast<double>(all.size()))) break;
        context_.prepare(all[i]);
        if (i % in_group == 0 && !settings.name.empty())
            group = {context_.work.document->journal().next_group_id(), settings.name};
        all[i].group = group;
        const stroke::StrokeReport report = context_.work.document->paint(std::move(all[i]));
        ink += report.ink_given;
        touched = touched || report.touched() || report.met;
        context_.work.autosave.add(context_.work.document->journal().entries().back());
        ++context_.history.done.back().made;
        context_.publisher.publish(true);
    }
    const auto& parts = context_.work.document->parts().table().parts;
    if (ink == 0 && touched && settings.mask == 0 && context_.history.done.back().made == all.size() &&
        std::ranges::any_of(parts, [](const stroke::Part& part) { return part.locked && !part.hidden; }))
        context_.outbox.report("The drawing leaves no ink: what it meets is locked");
    if (context_.history.done.back().made == 0) context_.history.done.pop_back();
    context_.publisher.publish(true);
}

}  // namespace tuft::app
