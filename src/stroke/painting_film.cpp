#include "ink/film.h"
#include "stroke/painting.h"

/// What a painting does with wet ink between strokes.
namespace tuft::stroke {

const atlas::SeamLinks& Painting::seams() {
    if (!seams_)
        seams_ = std::make_unique<atlas::SeamLinks>(atlas::build_seam_links(*model_->mesh, model_->atlas, model_->texels));
    return *seams_;
}

ink::WetFilm& Painting::film() {
    if (!film_) film_ = std::make_unique<ink::WetFilm>(model_->texels, seams());
    return *film_;
}

// Undo takes back the tiles; no brush has a part in it. All layers dry.
void Painting::dry(const Stroke& entry) {
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
        if (entry.seconds > 0) film().advance(canvas, entry.seconds, params, keep);
        else film().dry(canvas, params, keep);
    }
    keep_undo(std::move(undo));
}

}  // namespace tuft::stroke
