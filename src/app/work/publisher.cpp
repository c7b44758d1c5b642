#include "app/work/publisher.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <span>

#include "ink/composite/match.h"
#include "ink/spectra/kubelka_munk.h"
#include "io/project/attachments.h"
#include "stroke/journal/tables.h"
#include "stroke/session/session.h"

namespace tuft::app {
namespace {

constexpr double kPublishEvery = 0.012;  // seconds
constexpr double kPublishRest = 3;       // times as long as publishing takes, for painting between

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Publisher::Publisher(PaintWork& work, const EditHistory& history, Outbox& outbox)
    : work_(work), history_(history), outbox_(outbox) {
    if (!work_.document->palette().canvas()) return;
    refresh(palette_, work_.document->palette());
    outbox_.change([&](Update& update) { update.events.palette = palette_; });
}

void Publisher::publish(bool journal_changed) {
    const double begin = now();
    stroke::Document& document = *work_.document;
    const std::vector<std::uint32_t> dirty = document.appearance().take_dirty();
    thumbnails_.touch(dirty);
    std::vector<render::TilePixels> tiles = work_.texture->refresh(dirty, document);
    if (journal_changed) update_lines();
    const std::vector<std::uint32_t> wells = document.appearance().take_palette_dirty();
    if (!wells.empty()) refresh(palette_, document.palette(), wells);
    if (journal_changed) update_brush_colour();
    send_tiles(std::move(tiles));
    const brush::TuftState* tuft = document.session() ? &document.session()->tuft() : nullptr;
    const stroke::BrushInHand* held = document.brushes().find(brush_);
    const Autosave& file = work_.autosave;
    const std::shared_ptr<const mesh::SurfaceQuery> surface = document.parts().surface();
    outbox_.change([&](Update& update) {
        if (journal_changed) update.events.strokes = lines_;
        if (!wells.empty()) update.events.palette = palette_;
        PaintStatus& status = update.status;
        status.surface = surface;
        status.document = {.layers = document.layers().table(),
                           .masks = document.masks().table(),
                           .parts = document.parts().table(),
                           .can_undo = !history_.done.empty() && !file.viewing(),
                           .can_redo = !history_.undone.empty(),
                           .wet = std::ranges::any_of(document.layers().canvases(),
                                                      [](const auto& layer) { return layer.canvas->wet(); }),
                           .undo_seconds = undo_seconds_};
        status.brush = {.tuft = tuft ? *tuft : brush::TuftState{},
                        .on_palette = tuft && on_palette_,
                        .fullness = held ? held->reservoir.fullness() : 1,
                        .wetness = held ? stroke::wetness_of(held->reservoir) : 1,
                        .colour = brush_colour_};
        status.progress = {.done = done_};
        status.file = {.project = file.path(),
                       .trouble = file.trouble(),
                       .unsaved = file.waiting(),
                       .behind = file.behind(),
                       .viewing = file.viewing()};
    });
    last_publish_ = now();
    publish_seconds_ = last_publish_ - begin;
}

void Publisher::publish_if_due() {
    if (now() - last_publish_ > std::max(kPublishEvery, kPublishRest * publish_seconds_)) publish();
}

// Entries that are still right stay; ids and order tell.
void Publisher::update_lines() {
    const auto& strokes = work_.document->journal().entries();
    std::size_t same = 0;
    while (same < lines_.size() && same < strokes.size() && lines_[same].id == strokes[same].id &&
           lines_[same].brush == stroke::brush_of(strokes[same]) && lines_[same].ink == stroke::ink_of(strokes[same]) &&
           lines_[same].hidden == strokes[same].hidden && lines_[same].group == strokes[same].group)
        ++same;
    lines_.resize(same);
    std::optional<stroke::PartTable> parts;  // before the entry
    for (; same < strokes.size(); ++same) {
        lines_.push_back(stroke_line(strokes[same]));
        const auto* edit = strokes[same].as<stroke::PartEdit>();
        if (!edit) continue;
        if (!parts) parts = stroke::parts_after(std::span(strokes).first(same));
        lines_.back().part_changes = part_changes(*parts, *edit);
        stroke::apply(*parts, *edit);
    }
}

// The mixture in the brush last painted with, for its picture.
void Publisher::update_brush_colour() {
    brush_colour_.reset();
    const stroke::BrushInHand* held = work_.document->brushes().find(brush_);
    if (!held) return;
    const std::vector<ink::Pigment>& pigments = work_.document->layers().pigments();
    const ink::Mix mix = held->reservoir.mix();
    ink::Ink ink;
    for (std::size_t p = 0; p < pigments.size(); ++p)
        if (mix[p] > 0) ink.parts.push_back({pigments[p], static_cast<double>(mix[p])});
    if (ink.parts.empty()) return;
    const stroke::Document& document = *work_.document;
    if (!held->dipped.empty()) ink.film = document.materials().ink(held->dipped).film;
    const ink::Rgb linear = ink::colour_on(ink, document.appearance().substrate());
    brush_colour_.emplace();
    for (std::size_t c = 0; c < 3; ++c)
        (*brush_colour_)[c] = static_cast<std::uint8_t>(std::lround(255 * ink::srgb_encode(linear[c])));
}

void Publisher::send_tiles(std::vector<render::TilePixels> tiles) {
    std::set<std::uint32_t> fresh;
    for (const render::TilePixels& tile : tiles) fresh.insert(tile.tile);
    outbox_.change([&](Update& update) {
        std::vector<render::TilePixels>& all = update.events.texels.tiles;
        std::erase_if(all, [&](const render::TilePixels& t) { return fresh.contains(t.tile); });
        all.insert(all.end(), std::make_move_iterator(tiles.begin()), std::make_move_iterator(tiles.end()));
    });
}

void Publisher::send_texture() {
    render::MapPixels pixels = work_.texture->pixels();
    outbox_.change([&](Update& update) {
        update.events.texels.pixels = std::move(pixels);
        update.events.texels.tiles.clear();
    });
}

void Publisher::publish_appearance() {
    const stroke::Appearance& shown = work_.document->appearance();
    Appearance appearance{.recolours = shown.recolours(),
                          .substrate = shown.substrate().name,
                          .painted_on = work_.document->materials().substrate().name,
                          .roughness = shown.substrate().roughness,
                          .document = shown.substrate(),
                          .is_preview = shown.has_preview_substrate()};
    outbox_.change([&](Update& update) { update.events.appearance = std::move(appearance); });
}

void Publisher::publish_snapshots() {
    std::vector<SnapshotLine> lines;
    for (const io::Attachment& a : work_.autosave.attachments(io::kSnapshots)) lines.push_back(line_of(a));
    outbox_.change([&](Update& update) { update.events.snapshots = std::move(lines); });
}

void Publisher::draw_thumbnails() {
    stroke::Document& document = *work_.document;
    if (document.session() || !thumbnails_.waiting(document)) return;
    std::vector<Thumbnail> changed = thumbnails_.draw(document);
    outbox_.change([&](Update& update) {
        for (Thumbnail& picture : changed) {
            std::vector<Thumbnail>& all = update.events.thumbnails;
            std::erase_if(all, [&](const Thumbnail& t) { return t.layer == picture.layer; });
            all.push_back(std::move(picture));
        }
    });
}

void Publisher::look_from(const render::GlCamera& camera) {
    thumbnails_.look_from(*work_.model, camera);
}

void Publisher::forget_journal() {
    lines_.clear();
    if (palette_.rgb.empty()) return;
    refresh(palette_, work_.document->palette());
    outbox_.change([&](Update& update) { update.events.palette = palette_; });
}

void Publisher::set_brush(const std::string& name, bool on_palette) {
    brush_ = name;
    on_palette_ = on_palette;
}

}  // namespace tuft::app
