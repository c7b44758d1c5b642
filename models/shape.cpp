#include "shape.h"

namespace tuft::models {

void rest_on_ground(Shape& shape) {
    Box box;
    for (const Vec3& p : shape.points) box.add(p);
    const Vec3 base{box.centre().x, box.centre().y, box.lo.z};
    for (Vec3& p : shape.points) p -= base;
}

}  // namespace tuft::models
