#include <algorithm>

#include "ink/film/film.h"
#include "stroke/document/document.h"

/// What a painting does with wet ink between strokes.
namespace tuft::stroke {
namespace {

constexpr double kDryLimit = 3600;  // seconds, in which all is dry

}  // namespace

const atlas::SeamLinks& Document::seams() {
    if (!seams_)
        seams_ =
            std::make_unique<atlas::SeamLinks>(atlas::build_seam_links(*model_->mesh, model_->atlas, model_->texels));
    return *seams_;
}

ink::WetFilm& Document::film(std::uint32_t mask) {
    if (!film_) film_ = std::make_unique<ink::WetFilm>(model_->texels, seams());
    if (mask == film_mask_) return *film_;
    ink::WetFilm::FreeFn free;
    if (mask)
        free = [texels = &this->mask(mask)](std::uint32_t slot, int texel) { return texels->coverage(slot, texel); };
    film_->keep_within(std::move(free));
    film_mask_ = mask;
    return *film_;
}

/// The mask that was last painted through on a layer, by entries before this one.
std::uint32_t Document::stencil_mask_on(std::uint32_t layer, std::uint64_t before_id) const {
    const std::vector<JournalEntry>& all = journal_.entries();
    auto end = all.end();
    if (before_id) end = std::ranges::find(all, before_id, &JournalEntry::id);
    const std::uint32_t mask = last_mask_on({all.begin(), end}, layer);
    return masks_.find(mask) ? mask : 0;
}

void Document::take_back(const std::vector<LayerTiles>& before) {
    for (const LayerTiles& of_layer : before)
        for (const ink::TileSnapshot& tile : of_layer.tiles) canvas(of_layer.layer).restore(tile);
}

// Undo takes back the tiles; no brush has a part in it. All layers dry.
void Document::dry(std::uint64_t id, const Dry& wait, const ProgressFn& progress) {
    const ink::FilmParams params = ink::film_params(substrate_, wait.down);
    Undo undo{.stroke_id = id};
    for (const Layer& layer : layers_.layers) {
        ink::Canvas& canvas = this->canvas(layer.id);
        LayerTiles& before = undo.before.emplace_back(LayerTiles{.layer = layer.id, .tiles = {}});
        std::vector<std::uint8_t> kept(canvas.n_slots(), 0);
        const auto keep = [&](std::uint32_t slot) {
            if (kept[slot]) return;
            kept[slot] = 1;
            before.tiles.push_back(canvas.snapshot(slot));
        };
        try {
            ink::WetFilm& film = this->film(stencil_mask_on(layer.id, id));
            if (wait.seconds > 0)
                film.advance(canvas, wait.seconds, params, keep, progress);
            else
                film.dry(canvas, params, keep, kDryLimit, progress);
        } catch (...) {
            take_back(undo.before);
            throw;
        }
    }
    keep_undo(std::move(undo));
}

}  // namespace tuft::stroke
