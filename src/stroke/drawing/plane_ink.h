#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "brush/preset/preset.h"
#include "footprint/outline/footprint.h"
#include "stroke/placement/placement.h"

/// \file
/// Ink of a trace on a plane, without texels. Called by fit_trajectory.h, which compares it with the drawing.
namespace tuft::stroke {

/// Coverage of the plane in square cells of `cell` metres, stored in sparse tiles.
class PlaneInk {
  public:
    explicit PlaneInk(double cell) : cell_(cell) {}

    /// Takes the maximum of the coverage and a footprint at `time` (seconds). The footprint has cells of the same size,
    /// in the plane's frame.
    void add(const footprint::Footprint& footprint, double time);
    /// Returns the coverage at a point (metres), 0–1, bilinear between centres of cells.
    double at(const Vec2& p) const;
    /// Returns the time at which half of the cell at a point was first covered, seconds; negative: never.
    double when(const Vec2& p) const;
    double cell() const { return cell_; }

  private:
    static constexpr int kTile = 32;  // cells
    struct Tile {
        std::array<std::uint8_t, kTile * kTile> coverage{};
        std::array<float, kTile * kTile> first{};
    };
    const Tile* tile(std::int64_t i, std::int64_t j, std::size_t& cell) const;
    double value(std::int64_t i, std::int64_t j) const;

    double cell_;
    std::unordered_map<std::uint64_t, Tile> tiles_;
};

/// Returns the area that a full brush touches along a flat trace on a plane. Frame: metres, x to the right, y up (−y of
/// the trace). Holder (`compensate_tip_lag`, `pose_holder`), resampling, tuft and outlines are those of a stroke on a
/// model, in steps of `step` metres. Cost: 0.1 ms per step.
PlaneInk plane_ink(const StrokeSamples& trace, const brush::Preset& preset, const HolderOptions& options, double step,
                   double cell);

}  // namespace tuft::stroke
