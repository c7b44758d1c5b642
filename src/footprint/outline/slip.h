#pragma once

#include <array>
#include <span>

#include "core/system/recycled.h"
#include "footprint/outline/cuts.h"

/// \file
/// Motion of the hair over the surface from one stamp to the next. Used by hair.h and by `stroke`.
namespace tuft::footprint {

/// Transforms trails to a nearby frame, as if both frames were in one plane.
void change_frame(Recycled<Trail>& trails, const Frame& from, const Frame& to);

/// Length of touching hair projected across its own motion: ∫ |sin ψ| ds in metres, by position in the section. ψ
/// is the angle between the hair and its displacement.
///
/// Each part of the hair has its own displacement: that of the trail's middle plus that of a section that widens,
/// narrows or rotates. Separating sub-spines, spreading hair and a rolling tuft draw hair sideways, whatever the
/// hand does. Hair at rest measures 0.
class TransverseLength {
  public:
    /// `before`: the previous stamp's trails in the same frame. Where none matches this trail, all hair moves along
    /// `direction` (unit, or zero).
    TransverseLength(const TrailPart& part, std::span<const Trail> before, const Vec2& direction);

    /// Returns the length across the motion, metres, of hair at x in [−1, 1] along the sections' e.
    double at(double x) const;
    /// Returns the sine of the angle between the mean displacement of that hair and `direction`; 0 without either.
    double sine_to(double x, const Vec2& direction) const;
    /// Returns the mean sine of the angle between that hair and its displacement: 0 along itself, 1 across.
    double mean_sine(double x) const { return length_ > 0 ? at(x) / length_ : 0; }

  private:
    static constexpr std::size_t kPlaces = 17;
    std::array<double, kPlaces> measure_{};  // metres
    std::array<Vec2, kPlaces> displacement_{};
    double length_ = 0;  // metres of hair
};

}  // namespace tuft::footprint
