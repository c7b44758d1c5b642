#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/types.h"

/// The models that tuft ships, made from a few numbers each. Millimetres, z up,
/// resting on z = 0, centred on the z axis, faces counter-clockwise from outside.
namespace tuft::models {

struct Shape {
    std::vector<Vec3> points;                             ///< millimetres
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `points`
};

/// Porcelain, turned on the wheel: closed surfaces with a real wall.
Shape make_bowl();   ///< ⌀ 150 × 67
Shape make_plate();  ///< ⌀ 262 × 28
Shape make_vase();   ///< ⌀ 156 × 283, pear-shaped

/// A coupé in clay at 1:4, front towards +x: body, wheels, mirrors, door handles, grille.
Shape make_car();

/// Plain shapes with known answers, for tests.
Shape make_sheet();       ///< 200 × 200 in z = 0, open, facing +z
Shape make_sphere();      ///< radius 50
Shape make_cylinder();    ///< radius 40, height 120, capped
Shape make_torus();       ///< radii 60 and 25
Shape make_thin_plate();  ///< 120 × 120 × 1, closed

/// What is wrong with the shape as a solid, or "": every edge must have two faces that
/// run along it in opposite directions, and every component a positive volume.
std::string solid_defect(const Shape& shape);

/// Moves the shape so that it rests on z = 0 and its bounding box is centred on the z axis.
void rest_on_ground(Shape& shape);

}  // namespace tuft::models
