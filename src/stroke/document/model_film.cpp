#include "stroke/document/model_film.h"

#include <utility>

namespace tuft::stroke {

const atlas::SeamLinks& ModelFilm::seams() {
    if (!seams_)
        seams_ =
            std::make_unique<atlas::SeamLinks>(atlas::build_seam_links(*model_->mesh, model_->atlas, model_->texels));
    return *seams_;
}

ink::WetFilm& ModelFilm::within(std::uint32_t id, const MaskSet& masks) {
    if (!film_) film_ = std::make_unique<ink::WetFilm>(model_->texels, seams());
    if (id == mask_) return *film_;
    ink::WetFilm::FreeFn free;
    if (id)
        free = [texels = &masks.texels(id)](std::uint32_t slot, int texel) { return texels->coverage(slot, texel); };
    film_->keep_within(std::move(free));
    mask_ = id;
    return *film_;
}

void ModelFilm::release(std::uint32_t id) {
    if (!film_ || id == 0 || id != mask_) return;
    film_->keep_within({});
    mask_ = 0;
}

}  // namespace tuft::stroke
