#pragma once

#include <algorithm>
#include <exception>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "ink/canvas/canvas.h"
#include "ink/colour/pigments.h"
#include "ink/colour/substrate_map.h"
#include "stroke/deposit/plan_scratch_pool.h"
#include "stroke/surface/mask_texels.h"
#include "stroke/surface/model.h"

/// \file
/// The texels of one stroke. `StrokeSession` owns the target; deposit models write to it.

namespace tuft::stroke {

/// Thrown before a stroke reads or writes ink of a tile that it may not use.
struct OutsideTiles : std::exception {
    const char* what() const noexcept override { return "the stroke leaves the tiles planned for it"; }
};

/// A tile that a stroke may use while the parts `first` to `last` of its path are painted.
struct TileUse {
    std::uint32_t slot = kNone;
    std::uint32_t first = 0, last = 0;
};

/// Tiles that a stroke may use, ascending by slot.
using TilePlan = std::vector<TileUse>;

/// What limits a stroke on its texels. All that is referred to must outlive the target.
struct TargetLimits {
    const MaskTexels* mask = nullptr;               ///< texels that may change; null: all
    const TilePlan* plan = nullptr;                 ///< tiles that may be used; null: all
    const ink::SubstrateMap* substrates = nullptr;  ///< of the model's parts; null: one substrate everywhere
    float standing = 0;                             ///< film units of the ink that stand on any substrate
};

/// The canvas that a stroke writes to, with its mask, the substrate's grain, and copies of tiles before the stroke, for
/// undo.
class StampTarget {
  public:
    using Grain = std::array<float, atlas::kTileTexels>;

    /// All must outlive it. Grain and capacity of a tile are those of the substrate of most of its texels.
    StampTarget(const Model& model, ink::Canvas& canvas, const ink::Substrate& substrate, const TargetLimits& limits,
                PlanScratchPool& scratch);

    const Model& model() const { return model_; }
    const atlas::TexelMap& texels() const { return model_.texels; }
    ink::Canvas& canvas() { return canvas_; }
    const MaskTexels* mask() const { return limits_.mask; }
    /// Returns the film units that stay on a texel of a tile, all inks together. `otherwise`: where all parts are of
    /// one substrate.
    float capacity(std::uint32_t slot, float otherwise) const {
        return limits_.substrates ? std::max(substrate(slot).capacity, limits_.standing) : otherwise;
    }
    PlanScratchPool& scratch() { return scratch_; }

    /// Sets the part of the path that is painted now, for the plan.
    void set_part(std::uint32_t part) { part_ = part; }

    /// Must be called by one thread before `expose_grain` and `apply_grain` of that tile.
    void prepare_grain(std::uint32_t slot) { grain_.try_emplace(slot); }
    /// Reduces a tile's exposure to the part of the grain that hair with `film` metres of ink under it reaches. One
    /// thread per tile.
    void expose_grain(std::uint32_t slot, std::array<float, atlas::kTileTexels>& exposure, double film);

    /// Multiplies the film of a tile's texels by that of ink which stands in the grain (ink/exchange/film_tone.h). One
    /// thread per tile.
    void apply_grain(std::uint32_t slot, std::span<float, atlas::kTileTexels> tone, float share);

    /// Copies a tile, unless it was copied before. Deposit models call it before every use of the tile's ink. Throws
    /// `OutsideTiles`.
    void snapshot(std::uint32_t slot);
    /// Whether a tile so far was rough with dry paint before the stroke.
    bool on_relief() const { return on_relief_; }
    /// Copies so far by slot.
    const std::unordered_map<std::uint32_t, ink::TileSnapshot>& snapshots() const { return before_; }
    /// Returns the copies, ascending by slot, and forgets them.
    std::vector<ink::TileSnapshot> take_snapshots();

  private:
    const Grain& grain(std::uint32_t slot);
    bool may_use(std::uint32_t slot) const;
    const ink::Substrate& substrate(std::uint32_t slot) const {
        return limits_.substrates ? limits_.substrates->of(slot, substrate_) : substrate_;
    }

    const Model& model_;
    ink::Canvas& canvas_;
    const ink::Substrate& substrate_;
    TargetLimits limits_;
    std::uint32_t part_ = 0;
    PlanScratchPool& scratch_;
    std::unordered_map<std::uint32_t, std::unique_ptr<Grain>> grain_;  ///< by slot, evaluated at first use by dry hair
    std::unordered_map<std::uint32_t, ink::TileSnapshot> before_;
    bool on_relief_ = false;
};

}  // namespace tuft::stroke
