#pragma once

#include <array>
#include <vector>

#include "brush/preset.h"
#include "core/types.h"

/// How far the hand of a leaning holder runs ahead of the ink.
namespace tuft::stroke {

/// What a lean of the holder adds to the lead of one brush (see `drag_lead`), from steady strokes of
/// it at a grid of leans and depths, made as they are asked for (some 25 ms for each of the grid's
/// leans). Up to 0.05 rad, as a hand holds a brush upright, it adds nothing; from 0.15 rad all.
class LeanedLead {
  public:
    explicit LeanedLead(brush::Preset preset) : preset_(std::move(preset)) {}

    /// Metres ahead along the path and to its left that the hand must be further than that of an upright holder,
    /// so that the line lies where the path is. `lean`: radians along the path and to its left, the
    /// axis' up ∝ normal + tan(lean.x) ahead + tan(lean.y) left. `depth`: metres of the unbent tip
    /// below the surface.
    Vec2 at(double depth, const Vec2& lean);

  private:
    static constexpr std::array kAlong{-0.8, -0.4, -0.2, 0.0, 0.2, 0.4, 0.8};
    static constexpr std::array kAcross{0.0, 0.4, 0.8};
    static constexpr std::array kDepths{0.05, 0.15, 0.3, 0.5, 0.7, 1.0};  // of the working depth

    const std::vector<Vec2>& node(std::size_t i, std::size_t j);
    Vec2 of_node(std::size_t i, std::size_t j, double depth);

    brush::Preset preset_;
    std::array<std::vector<Vec2>, kAlong.size() * kAcross.size()> nodes_;  // ahead and left by depth
};

}  // namespace tuft::stroke
