#pragma once

#include "car_design.h"
#include "shape.h"

namespace tuft::models {

/// Full size, millimetres, x forward from the middle of the length, y left, z up.
Shape make_car_body(const CarDesign& design);

/// Mirrors, door handles and the bars of the grille; frame as the body's.
Shape make_car_trim(const CarDesign& design);

/// Tyre and rim, axle along y through the origin, outer face to the left at y = 0.
Shape make_car_wheel();

}  // namespace tuft::models
