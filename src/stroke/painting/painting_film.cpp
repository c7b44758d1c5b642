#include "ink/film/film.h"
#include "stroke/painting/painting.h"

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

/// The mask that was last painted through on a layer, of entries before this one.
std::uint32_t Document::tape_on(std::uint32_t layer, std::uint64_t before_id) const {
    std::map<std::uint32_t, std::uint32_t> masks;  // by layer
    for (const Stroke& s : journal_.strokes()) {
        if (before_id && s.id == before_id) break;
        if (s.hidden) continue;
        if (s.action == Action::stroke || s.action == Action::fill) masks[s.layer] = s.mask;
        if (s.action != Action::layer) continue;
        // A copy is wet as far as the original; of two merged layers the mask of the upper one goes on.
        if (s.edit.what == LayerChange::duplicate) masks[s.edit.layer.id] = masks[s.edit.other];
        if (s.edit.what == LayerChange::merge && masks[s.edit.layer.id]) masks[s.edit.other] = masks[s.edit.layer.id];
    }
    const std::uint32_t mask = masks[layer];
    return masks_.find(mask) ? mask : 0;
}

void Document::take_back(const std::vector<LayerTiles>& before) {
    for (const LayerTiles& of_layer : before)
        for (const ink::TileSnapshot& tile : of_layer.tiles) canvas(of_layer.layer).restore(tile);
}

// Undo takes back the tiles; no brush has a part in it. All layers dry.
void Document::dry(const Stroke& entry, const ProgressFn& progress) {
    const ink::FilmParams params = ink::film_params(substrate_, entry.settings.down);
    Undo undo{.stroke_id = entry.id};
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
            ink::WetFilm& film = this->film(tape_on(layer.id, entry.id));
            if (entry.seconds > 0)
                film.advance(canvas, entry.seconds, params, keep, progress);
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
