#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "stroke/journal/mask.h"
#include "stroke/surface/model.h"

/// A mask evaluated on the texels of a model.
namespace tuft::stroke {

/// Coverage of texels, 0–255; tiles that are covered all or not at all take no room.
class MaskTexels {
  public:
    explicit MaskTexels(std::size_t n_slots) : place_(n_slots, kNone_) {}

    void set(std::uint32_t slot, const std::array<std::uint8_t, atlas::kTileTexels>& coverage);
    std::uint8_t coverage(std::uint32_t slot, int texel) const;
    bool none(std::uint32_t slot) const { return place_[slot] == kNone_; }
    /// exposure *= coverage; nothing is multiplied where all is covered.
    void apply(std::uint32_t slot, std::span<float, atlas::kTileTexels> exposure) const;
    std::size_t memory_bytes() const;

  private:
    static constexpr std::uint32_t kNone_ = 0xffffffff, kAll_ = 0xfffffffe;
    std::vector<std::uint32_t> place_;  ///< [n_slots]
    std::vector<std::array<std::uint8_t, atlas::kTileTexels>> parts_;
};

/// Evaluates a mask on a model's texels. Groups and charts have hard edges, a lasso's are a texel
/// wide, an angle's as soft as asked. The same bits for any number of threads. Throws `Error`
/// for groups that the mesh does not have.
MaskTexels evaluate(const Mask& mask, const MaskTable& table, const Model& model);

}  // namespace tuft::stroke
