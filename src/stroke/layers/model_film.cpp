#include "stroke/layers/model_film.h"

#include <utility>

namespace tuft::stroke {

const atlas::SeamLinks& ModelFilm::seams() {
    if (!seams_)
        seams_ =
            std::make_unique<atlas::SeamLinks>(atlas::build_seam_links(*model_->mesh, model_->atlas, model_->texels));
    return *seams_;
}

ink::WetFilm& ModelFilm::within(std::uint32_t id, const MaskTexels* texels) {
    if (!film_) film_ = std::make_unique<ink::WetFilm>(model_->texels, seams());
    if (id == mask_) return *film_;
    ink::WetFilm::FreeFn free;
    if (texels) free = [texels](std::uint32_t slot, int texel) { return texels->coverage(slot, texel); };
    film_->keep_within(std::move(free));
    mask_ = id;
    return *film_;
}

void ModelFilm::release(std::uint32_t id) {
    if (id == mask_) release();
}

void ModelFilm::release() {
    if (film_ && mask_) film_->keep_within({});
    mask_.reset();
}

}  // namespace tuft::stroke
