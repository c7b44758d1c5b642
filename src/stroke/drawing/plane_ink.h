#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "brush/preset/preset.h"
#include "footprint/outline/footprint.h"
#include "stroke/placement/placement.h"

/// What a trace leaves on a plane, without texels.
namespace tuft::stroke {

/// Coverage of the plane in cells, whose tiles are there where something is.
class PlaneInk {
  public:
    explicit PlaneInk(double cell) : cell_(cell) {}

    /// The larger of what is there and a footprint in the plane's own frame, with cells of this
    /// picture, at a time.
    void add(const footprint::Footprint& footprint, double time);
    /// Coverage at a point, metres, 0–1: bilinear between the middles of cells.
    double at(const Vec2& p) const;
    /// When half of the cell at a point was first covered, seconds of the trace; negative: never.
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

/// The area that a brush full of ink touches that is led along a flat trace over a plane; metres, x
/// right and y up, which is the trace's -y. The same hand (`lead_hand`, `pose_holder`), resampling,
/// tuft and outlines as those of a stroke on a model, in steps of `step`; some 0.1 ms each.
PlaneInk plane_ink(const Trace& trace, const brush::Preset& preset, const HolderOptions& options, double step,
                   double cell);

}  // namespace tuft::stroke
