#include <algorithm>
#include <cmath>

#include "app/document/paint_thread.h"
#include "ink/composite/composite.h"
#include "ink/spectra/kubelka_munk.h"
#include "stroke/surface/mask_texels.h"

/// Inks of the work's own, how it is shown, and masks: on the painter's thread.
namespace tuft::app {

// A brush with another ink in its tip is loaded before every stroke: dipped, the tip wiped, the tip
// dipped into the other ink. Counts the entries that this makes.
void PaintThread::load_tip(const BeginStroke& command, std::size_t& made) {
    if (command.tip_ink.empty() || command.carry || command.erases) return;
    work_.autosave.prepare(*work_.painting, command.brush, command.tip_ink);
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
        work_.painting->paint(std::move(entry));
        work_.autosave.add(work_.painting->journal().strokes().back());
        ++made;
    }
}

void PaintThread::add_ink(ink::Ink ink) {
    const auto known = [&](const std::string& name) {
        const std::vector<std::string> shipped = ink::list_inks(), kept = work_.autosave.inks();
        return std::find(shipped.begin(), shipped.end(), name) != shipped.end() ||
               std::find(kept.begin(), kept.end(), name) != kept.end();
    };
    const std::string wanted = ink.name;
    for (int n = 2; known(ink.name); ++n) ink.name = wanted + "-" + std::to_string(n);
    work_.painting->use_ink(ink);
    work_.autosave.prepare(*work_.painting, "", ink.name);
    own_inks_.push_back(work_.painting->ink(ink.name));
    publish();
    const std::lock_guard lock(mutex_);
    update_.own_inks = own_inks_;
    update_.picked = ink.name;
}

void PaintThread::pick(const PickInk& command) {
    stroke::Document& painting = *work_.painting;
    std::optional<ink::Ink> ink = painting.ink_of(
        command.on_palette ? painting.pick_palette(command.point) : painting.pick(command.point), "mixture");
    if (!ink) return say("There is no ink here to pick up.");
    add_ink(std::move(*ink));
}

// The mixture in the brush last painted with, for its picture.
void PaintThread::look_at_brush() {
    brush_colour_.reset();
    const stroke::BrushInHand* held = work_.painting->held(current_.brush);
    if (!held) return;
    const std::vector<ink::Pigment>& pigments = work_.painting->canvas().pigments();
    const ink::Mix mix = held->reservoir.mix();
    ink::Ink ink;
    for (std::size_t p = 0; p < pigments.size(); ++p)
        if (mix[p] > 0) ink.parts.push_back({pigments[p], static_cast<double>(mix[p])});
    if (ink.parts.empty()) return;
    const ink::Rgb linear = ink::colour_of_film(ink, {0.88f, 0.88f, 0.88f});
    brush_colour_.emplace();
    for (std::size_t c = 0; c < 3; ++c)
        (*brush_colour_)[c] = static_cast<std::uint8_t>(std::lround(255 * ink::srgb_encode(linear[c])));
}

void PaintThread::publish_looks() {
    const stroke::Document& painting = *work_.painting;
    Appearance looks{.recolours = painting.recolours(),
                     .substrate = painting.substrate().name,
                     .painted_on = painting.painted_on().name,
                     .roughness = painting.substrate().roughness};
    const std::lock_guard lock(mutex_);
    update_.looks = std::move(looks);
}

void PaintThread::recolour(const RecolourInk& command) {
    work_.painting->recolour(command.name, command.wanted);
    work_.autosave.store_looks(*work_.painting);
    publish();
    publish_looks();
}

void PaintThread::preview_substrate(const PreviewSubstrate& command) {
    stroke::Document& painting = *work_.painting;
    if (command.substrate == painting.painted_on().name)
        painting.preview_substrate(std::nullopt);
    else
        painting.preview_substrate(ink::load_substrate(command.substrate));
    work_.autosave.store_looks(painting);
    painting.take_dirty();
    work_.texture->refresh_all(painting);
    thumbnails_.forget();
    publish();
    send_pixels();
    publish_looks();
}

// When nothing else is asked for, and no stroke is in work.
void PaintThread::draw_thumbnails() {
    stroke::Document& painting = *work_.painting;
    if (painting.in_stroke() || !thumbnails_.waiting(painting)) return;
    {
        const std::lock_guard lock(mutex_);
        if (!queue_.empty()) return;
    }
    std::vector<Thumbnail> changed = thumbnails_.draw(painting);
    const std::lock_guard lock(mutex_);
    for (Thumbnail& picture : changed) {
        std::erase_if(update_.thumbnails, [&](const Thumbnail& t) { return t.layer == picture.layer; });
        update_.thumbnails.push_back(std::move(picture));
    }
}

void PaintThread::send_pixels() {
    render::MapPixels pixels = work_.texture->pixels();
    const std::lock_guard lock(mutex_);
    update_.pixels = std::move(pixels);
    update_.tiles.clear();
}

void PaintThread::change_masks(const ChangeMasks& command) {
    const auto entry_of = [&](const stroke::MaskEdit& edit) {
        stroke::Stroke entry;
        entry.action = stroke::Action::mask;
        entry.trace.flat = false;
        const stroke::Mask* known = work_.painting->masks().find(edit.mask.id);
        entry.trace.label = known ? known->name : edit.mask.name;
        entry.mask_edit = edit;
        return entry;
    };
    if (command.edit.remove) return act(entry_of(command.edit));
    const stroke::MaskTexels texels = stroke::evaluate(command.edit.mask, work_.painting->masks(), *work_.model);
    bool any = false;
    for (std::uint32_t slot = 0; slot < work_.model->texels.n_slots() && !any; ++slot) any = !texels.none(slot);
    if (!any) return say("Nothing of the model lies in this mask.");
    act(entry_of(command.edit));
    if (command.with == 0) return;
    const stroke::Mask& made = work_.painting->masks().masks.back();
    stroke::MaskEdit both;
    both.mask.name = made.name + (command.how == stroke::MaskKind::unite ? " +" : " \xc3\x97");
    both.mask.kind = command.how;
    both.mask.of = {command.with, made.id};
    act(entry_of(both));
    steps_.back().joined = true;
}

void PaintThread::show_mask(const ShowMask& command) {
    const bool there = command.id != 0 && work_.painting->masks().find(command.id);
    work_.texture->show_veil(there ? &work_.painting->mask(command.id) : nullptr, *work_.painting);
    publish();
    send_pixels();
}

}  // namespace tuft::app
