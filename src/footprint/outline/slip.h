#pragma once

#include <array>
#include <span>

#include "footprint/outline/cuts.h"

/// How hair goes over the surface from one stamp to the next.
namespace tuft::footprint {

/// Trails in another frame near their own, as if they lay on one plane.
void change_frame(std::vector<Trail>& trails, const Frame& from, const Frame& to);

/// What lies down of the hair of a trail's cuts, seen across its own motion: ∫ |sin ψ| ds in
/// metres, ψ the angle between the hair and the way that it went, by its place in the section.
///
/// Each cluster of hair goes its own way: that of the trail's middle, and of the section that widens,
/// narrows or turns under it. Sub-spines that part, hair that a press spreads and a tuft that rolls
/// over draw hair sideways, whatever the hand does. Hair that stays where it was has no way and
/// measures nothing.
class Across {
  public:
    /// For cuts [begin, end) of a trail. `before`: the trails of the stamp before in the same
    /// frame; where none goes with this one, all hair goes along `way` (unit, or zero).
    Across(const Trail& trail, std::size_t begin, std::size_t end, std::span<const Trail> before, const Vec2& way);

    /// Of hair at x in [-1, 1] along the sections' e, metres.
    double at(double x) const;
    /// Sine of the angle between the way of that hair, on the mean of what lies down of it, and
    /// `way`; 0 without either.
    double off_way(double x, const Vec2& way) const;
    /// Mean sine of the angle between that hair and its own way, 0 along itself to 1 across.
    double off_itself(double x) const { return length_ > 0 ? at(x) / length_ : 0; }

  private:
    static constexpr std::size_t kPlaces = 17;
    std::array<double, kPlaces> measure_{};
    std::array<Vec2, kPlaces> went_{};
    double length_ = 0;  // metres of hair
};

}  // namespace tuft::footprint
