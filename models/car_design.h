#pragma once

#include <array>
#include <vector>

#include "curve.h"

/// The design lines of the coupé, full size in millimetres: s is measured from the
/// nose backwards, y to the left from the middle, z up from the ground.
namespace tuft::models {

/// The control cage lies on a box of `kStations` × 2 `kMiddle` × `kTop` cells:
/// stations i from nose corner to tail corner, columns j from the left shoulder
/// over the middle to the right one, rows r from the floor up to the shoulder.
inline constexpr int kStations = 33;
inline constexpr int kMiddle = 9;
inline constexpr int kTop = 8;

struct WheelDesign {
    double s = 0;            ///< of the axle, mm
    double z = 0;            ///< of the axle, mm
    double outer_y = 0;      ///< half width at the tyre's outer face, mm
    double arch_radius = 0;  ///< mm
    int first_station = 0;   ///< the panel around the arch runs from this station
    int last_station = 0;    ///< to this one
    int top_row = 0;         ///< and from the floor to this row
};

class CarDesign {
  public:
    CarDesign();

    double length() const;
    /// The point of the left half (j <= kMiddle) on the box's surface: (s, y, z).
    Vec3 point(int i, int j, int r) const;
    /// The nose at half width `y` on row `r`.
    Vec3 nose(double y, int r) const;
    /// Half width of the flank at a point of the side view.
    double flank_y(double s, double z) const;
    /// How far the fender stands out around the wheel arches, mm.
    double flare(double s, double z) const;

    std::array<WheelDesign, 2> wheels;

  private:
    Vec3 ring(double u, int r) const;
    double ring_u(int i, int j, int r) const;
    Vec3 top(int i, int j) const;

    PlaneLine plan_;
    std::vector<Curve> row_inset_, row_height_;  ///< [kTop + 1] over the length of the plan line
    std::vector<Curve> rail_, screen_, middle_;  ///< [3]: s over the station; y and z over s
    std::vector<Curve> waist_, window_top_;      ///< [2]: y and z over s
};

}  // namespace tuft::models
