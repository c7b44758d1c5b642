#include <cmath>
#include <vector>

#include "cage.h"
#include "car_parts.h"

namespace tuft::models {

namespace {

/// From the design's (s, y, z) to x forward from the middle of the length.
Vec3 place(const CarDesign& design, const Vec3& p) {
    return {0.5 * design.length() - p.x, p.y, p.z};
}

Shape make_mirror(const CarDesign& design) {
    Cage housing = make_block({2, 3, 2}, [&](const Vec3& u) {
        const double out = 0.5 * (u.y + 1);  // 0 at the car, 1 at the tip
        const double deep = 58 * (1 - 0.35 * out) * (u.x > 0.5 ? 1 - 0.25 * u.z * u.z : 1);
        return place(design,
                     {1915 - deep * u.x + 38 * out, 962 + 116 * u.y, 1036 + 6 * out + 68 * (1 - 0.3 * out) * u.z});
    });
    const std::vector<std::uint32_t> glass{0, 1, 2, 3, 4, 5};
    const CarveLoop loops[] = {{7, 0, 1.5}, {9, 12, 1.5}};
    carve(housing, glass, {.sharp = 0}, loops);
    Shape mirror = triangulate(subdivide(housing, 2));
    const Cage stalk = make_block({1, 2, 1}, [&](const Vec3& u) {
        return place(design, {1905 - 34 * u.x, 862 + 62 * u.y, 988 + 14 * u.y + 14 * u.z});
    });
    append(mirror, triangulate(subdivide(stalk, 2)));
    return mirror;
}

Shape make_door_handle(const CarDesign& design) {
    const Cage handle = make_block({4, 1, 1}, [&](const Vec3& u) {
        const double s = 2650 + 112 * u.x, z = 788 + 15 * u.z;
        const double out = u.y > 0 ? 22 - 12 * u.x * u.x : -12;
        return place(design, {s, design.flank_y(s, z) + out, z});
    });
    Shape shape = triangulate(subdivide(handle, 2));
    for (auto& t : shape.triangles) std::swap(t[1], t[2]);  // s runs against x
    return shape;
}

/// A bar across the grille, at a height between rows 3 (0) and 5 (1).
Shape make_grille_bar(const CarDesign& design, double height) {
    const Cage bar = make_block({8, 1, 1}, [&](const Vec3& u) {
        const double y = (500 - 55 * height) * u.x;
        const Vec3 low = design.nose(y, 3), mid = design.nose(y, 4), high = design.nose(y, 5);
        const double t = 2 * height - 1;
        const Vec3 on = mid + 0.5 * t * (high - low) + 0.5 * t * t * (high + low - 2.0 * mid);
        return place(design, {on.x + 30 - 18 * u.y, y, on.z + 7 * u.z});
    });
    Shape shape = triangulate(subdivide(bar, 1));
    for (auto& t : shape.triangles) std::swap(t[1], t[2]);  // the block's axes are left-handed
    return shape;
}

}  // namespace

Shape make_car_trim(const CarDesign& design) {
    Shape trim;
    for (const Shape& part : {make_mirror(design), make_door_handle(design)}) {
        append(trim, part);
        append(trim, mirrored(part));
    }
    for (const double height : {0.2, 0.4, 0.6, 0.8}) append(trim, make_grille_bar(design, height));
    return trim;
}

}  // namespace tuft::models
