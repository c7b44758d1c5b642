#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "ink/canvas/canvas.h"
#include "ink/colour/pigments.h"
#include "stroke/deposit/plan_scratch_pool.h"
#include "stroke/surface/mask_texels.h"
#include "stroke/surface/model.h"

namespace tuft::stroke {

/// The texels that one stroke writes to, with what every way of writing needs: the mask, the grain of the substrate,
/// and copies of the tiles as they were before the stroke, for undo.
class StampTarget {
  public:
    using Grain = std::array<float, atlas::kTileTexels>;

    /// All must outlive it. `mask`: what the stroke may change; null: everything.
    StampTarget(const Model& model, ink::Canvas& canvas, const ink::Substrate& substrate, const MaskTexels* mask,
                PlanScratchPool& scratch);

    const Model& model() const { return model_; }
    const atlas::TexelMap& texels() const { return model_.texels; }
    ink::Canvas& canvas() { return canvas_; }
    const MaskTexels* mask() const { return mask_; }
    PlanScratchPool& scratch() { return scratch_; }

    /// Must be called before `expose_grain` is, by one thread.
    void prepare_grain();
    /// Leaves of a tile's exposure what hair with `film` metres of ink under it reaches of the grain. Called by the
    /// one thread that works on the tile.
    void expose_grain(std::uint32_t slot, std::array<float, atlas::kTileTexels>& exposure, double film);

    /// Copies a tile as it is now, unless it was copied already.
    void snapshot(std::uint32_t slot);
    /// Slots copied so far, in no order.
    const std::unordered_map<std::uint32_t, ink::TileSnapshot>& snapshots() const { return before_; }
    /// Hands the copies over, by slot, and forgets them.
    std::vector<ink::TileSnapshot> take_snapshots();

  private:
    const Grain& grain(std::uint32_t slot);

    const Model& model_;
    ink::Canvas& canvas_;
    const MaskTexels* mask_;
    PlanScratchPool& scratch_;
    float grain_rms_, grain_length_;             ///< metres, of the substrate
    std::vector<std::unique_ptr<Grain>> grain_;  ///< by slot, evaluated when dry hair comes there
    std::unordered_map<std::uint32_t, ink::TileSnapshot> before_;
};

}  // namespace tuft::stroke
