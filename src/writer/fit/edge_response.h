#pragma once

#include <array>
#include <span>
#include <vector>

#include "writer/gesture/cells.h"

/// \file
/// How the edge of ink answers to changes of a path: linear in its distance. Called by knuckle_fit.h, which searches
/// there and bends the tuft only for what it finds.
namespace tuft::writer {

/// Returns the distance of each cell's centre from the line at half of a coverage (0–1, [cells of `frame`]) which is
/// smoothed over its neighbours, units, positive in the ink, at most `kMostDistance`. Beside the edge it is that over
/// the gradient; from there the nearest point of the edge is handed on from cell to cell (within a tenth of a unit of
/// the exact one). Cost: 60 ns a cell.
std::vector<float> edge_distances(const Cells& frame, std::span<const float> coverage);
inline constexpr float kMostDistance = 24;  ///< units

/// Distances d(c) = d(c₀) + Σ gₖ (cₖ − c₀ₖ) over `N` numbers that change a path.
template <std::size_t N>
class EdgeResponse {
  public:
    using Numbers = std::array<double, N>;

    explicit EdgeResponse(std::vector<float> at_zero) : base_(std::move(at_zero)) {
        for (std::vector<float>& g : slopes_) g.assign(base_.size(), 0);
    }

    /// Takes the slope of one number from the distances at `step` of it.
    void set_slope(std::size_t k, double step, std::span<const float> distances) {
        for (std::size_t i = 0; i < base_.size(); ++i) slopes_[k][i] = (distances[i] - base_[i]) / float(step);
    }

    std::vector<float> distances(const Numbers& c) const {
        std::vector<float> d = base_;
        for (std::size_t k = 0; k < N; ++k) {
            const auto by = static_cast<float>(c[k] - at_[k]);
            if (by == 0) continue;
            for (std::size_t i = 0; i < d.size(); ++i) d[i] += by * slopes_[k][i];
        }
        return d;
    }

    /// Takes in what is drawn at `c`: the least change of the slopes that explains it [Broyden1965]. With `moves` it
    /// becomes c₀.
    void learn(const Numbers& c, std::vector<float> drawn, bool moves) {
        const std::vector<float> expected = distances(c);
        double squared = 0;
        for (std::size_t k = 0; k < N; ++k) squared += (c[k] - at_[k]) * (c[k] - at_[k]);
        for (std::size_t k = 0; k < N && squared > 0; ++k) {
            const auto by = static_cast<float>((c[k] - at_[k]) / squared);
            if (by == 0) continue;
            for (std::size_t i = 0; i < drawn.size(); ++i) slopes_[k][i] += by * (drawn[i] - expected[i]);
        }
        if (moves) at_ = c, base_ = std::move(drawn);
    }

    const Numbers& at() const { return at_; }

  private:
    Numbers at_{};                              // c₀
    std::vector<float> base_;                   // units, [cells]
    std::array<std::vector<float>, N> slopes_;  // units per unit of a number, [cells]
};

}  // namespace tuft::writer
