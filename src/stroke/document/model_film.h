#pragma once

#include <cstdint>
#include <memory>

#include "atlas/texels/seam_links.h"
#include "ink/film/film.h"
#include "stroke/document/mask_set.h"

/// \file
/// Wet ink on the model: the film that `ink` lets flow, and the seams that it flows over. `Document` hands it to wet
/// strokes and to drying.
namespace tuft::stroke {

/// The one film of all layers of a model, made when something is wet. It keeps within one mask at a time.
class ModelFilm {
  public:
    /// `model` must outlive it.
    explicit ModelFilm(const Model& model) : model_(&model) {}

    /// Returns the film, kept within mask `id` of `masks`; 0: free. Throws `Error` as `MaskSet::texels` does. The
    /// mask's texels must stay until another mask or `release`.
    ink::WetFilm& within(std::uint32_t id, const MaskSet& masks);
    /// The film no longer keeps within this mask: its texels go.
    void release(std::uint32_t id);
    /// Links over the model's seams, made at the first call.
    const atlas::SeamLinks& seams();

  private:
    const Model* model_;
    std::unique_ptr<atlas::SeamLinks> seams_;
    std::unique_ptr<ink::WetFilm> film_;
    std::uint32_t mask_ = 0;  ///< id of the mask it keeps within; 0: none
};

}  // namespace tuft::stroke
