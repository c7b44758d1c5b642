#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "atlas/texels/seam_links.h"
#include "ink/film/film.h"
#include "stroke/surface/mask_texels.h"
#include "stroke/surface/model.h"

/// \file
/// Wet ink on the model: the film that `ink` lets flow, and the seams that it flows over. `Document` hands it to wet
/// strokes and to drying.
namespace tuft::stroke {

/// The one film of all layers of a model, made when something is wet. It keeps within one mask at a time.
class ModelFilm {
  public:
    /// `model` must outlive it.
    explicit ModelFilm(const Model& model) : model_(&model) {}

    /// Returns the film, kept within `texels` (null: free), which mask `id` (0: none) leaves open. They must stay, and
    /// be the same for the same id, until another mask or `release`.
    ink::WetFilm& within(std::uint32_t id, const MaskTexels* texels);
    /// The film no longer keeps within this mask: its texels go.
    void release(std::uint32_t id);
    /// The film keeps within no texels.
    void release();
    /// Links over the model's seams, made at the first call.
    const atlas::SeamLinks& seams();

  private:
    const Model* model_;
    std::unique_ptr<atlas::SeamLinks> seams_;
    std::unique_ptr<ink::WetFilm> film_;
    std::optional<std::uint32_t> mask_;  ///< id of the mask whose texels it keeps within; nothing: free
};

}  // namespace tuft::stroke
