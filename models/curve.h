#pragma once

#include <vector>

#include "core/geometry/types.h"

namespace tuft::models {

/// A value over one coordinate: natural cubic splines (C2) through keys, joined at
/// the keys that are corners. Beyond the ends the curve goes on straight.
class Curve {
  public:
    struct Key {
        double at = 0;
        double value = 0;
        bool corner = false;
    };
    /// With `flat_ends` the slope is 0 at both ends: a curve that meets its mirror image.
    explicit Curve(std::vector<Key> keys, bool flat_ends = false);
    double operator()(double at) const;

  private:
    std::vector<Key> keys_;
    std::vector<double> slope_in_, slope_out_;  ///< at each key, from the left and to the right
};

/// A smooth line in the plane walked by length, with its normal to the left hand.
class PlaneLine {
  public:
    explicit PlaneLine(std::vector<Vec2> points);
    double length() const { return length_.back(); }
    Vec2 point(double u) const;
    Vec2 left_normal(double u) const;
    /// The u nearest the start (or the end) where coordinate `axis` passes `value`.
    double find(int axis, double value, bool from_end = false) const;

  private:
    std::vector<Vec2> points_;
    std::vector<double> length_;  ///< from the start to each point
};

double smooth_step(double from, double to, double at);

}  // namespace tuft::models
