#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "stroke/journal/entry/mask.h"
#include "stroke/surface/model.h"

/// \file
/// Coverage of a model's texels by a mask. Made once per mask by `MaskSet`; read by strokes, fills and the wet film.
namespace tuft::stroke {

/// Coverage of texels, 0–255. Tiles of full or no coverage take no memory. Reading is safe in several threads.
class MaskTexels {
  public:
    /// No coverage on any of `n_slots` tiles.
    explicit MaskTexels(std::size_t n_slots) : place_(n_slots, kNone_) {}

    void set(std::uint32_t slot, const std::array<std::uint8_t, atlas::kTileTexels>& coverage);
    std::uint8_t coverage(std::uint32_t slot, int texel) const;
    /// Whether no texel of the tile is covered.
    bool none(std::uint32_t slot) const { return place_[slot] == kNone_; }
    /// Multiplies the exposure by coverage / 255; tiles of full coverage do not change a bit.
    void apply(std::uint32_t slot, std::span<float, atlas::kTileTexels> exposure) const;
    std::size_t memory_bytes() const;

  private:
    static constexpr std::uint32_t kNone_ = 0xffffffff, kAll_ = 0xfffffffe;
    std::vector<std::uint32_t> place_;  ///< [n_slots]
    std::vector<std::array<std::uint8_t, atlas::kTileTexels>> parts_;
};

/// Evaluates a mask of `table` on a model's texels. Edges of groups and charts are hard, those of a lasso one texel
/// wide, as are those of `clear`, those of an angle as soft as its `soft`. The same bits for any number of threads.
/// Groups that the mesh lacks, as a revised one may, cover nothing.
MaskTexels evaluate(const Mask& mask, const MaskTable& table, const Model& model);

/// Throws `Error` for a new mask of groups that the mesh lacks.
void check_groups(const Mask& mask, const mesh::TriangleMesh& mesh);

}  // namespace tuft::stroke
