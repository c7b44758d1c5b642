#pragma once

#include <span>

#include "ink/exchange/deposit.h"

/// \file
/// Several stamps of one ink on one tile. Called by `stroke` for every tile of a batch of stamps.
namespace tuft::ink {

/// Deposits stamps one after the other, each by the law of `deposit`, with its bits. What all of them give is summed
/// once, over the change of each texel: stamps lie over each other, and a sum for each costs as much as its deposit.
class TileDeposit {
  public:
    /// `area` and `tone` [256] as in `deposit`; they and the canvas must outlive it.
    TileDeposit(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> area,
                std::span<const float> tone = {})
        : canvas_(canvas), slot_(slot), area_(area), tone_(tone) {}
    TileDeposit(const TileDeposit&) = delete;
    TileDeposit& operator=(const TileDeposit&) = delete;

    /// Deposits a stamp of the given coverage, 0–1. Precondition: nothing else changes the tile between stamps.
    void add(std::span<const float, atlas::kTileTexels> coverage, const DepositParams& params, const DepositLaw& law);
    /// Returns the ink given by all stamps, film·m². Call it once, after the last.
    double finish();

  private:
    /// The rows of the tile that a stamp covers: texels `begin` to `end`.
    struct CoveredRows {
        int begin = 0, end = 0;
        const float *coverage = nullptr, *tone = nullptr;  ///< [end − begin]
    };

    void add_alone(int pigment, const CoveredRows& rows, const DepositParams& params, const DepositLaw& law);
    void add_among_others(const CoveredRows& rows, const DepositParams& params, const DepositLaw& law);
    void sum_alone();

    Canvas& canvas_;
    std::uint32_t slot_;
    std::span<const float, atlas::kTileTexels> area_;
    std::span<const float> tone_;
    double given_ = 0;  // film·m², summed so far
    int alone_ = -1;    // plane of an ink of one pigment, without others on the tile, whose change is not summed yet
    float alone_part_ = 1;      // fraction of the ink that it is
    bool changed_ = false;      // that plane
    alignas(64) Plane before_;  // that plane when it was summed last
};

}  // namespace tuft::ink
