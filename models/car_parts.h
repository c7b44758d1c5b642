#pragma once

#include "car_design.h"
#include "shape.h"

namespace tuft::models {

/// Full size, millimetres, x forward from the middle of the length, y left, z up.
Shape make_car_body(const CarDesign& design);

/// Tyre and rim, axle along y through the origin, outer face to the left at y = 0.
Shape make_car_wheel();

}  // namespace tuft::models
