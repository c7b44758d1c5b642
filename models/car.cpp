#include "cage.h"
#include "car_parts.h"

namespace tuft::models {

Shape make_car() {
    const CarDesign design;
    Shape car = make_car_body(design);
    append(car, make_car_trim(design));
    for (const WheelDesign& w : design.wheels) {
        Shape wheel = make_car_wheel();
        for (Vec3& p : wheel.points) p += Vec3{0.5 * design.length() - w.s, w.outer_y, w.z};
        append(car, wheel);
        append(car, mirrored(wheel));
    }
    for (Vec3& p : car.points) p *= 0.25;  // the clay is made at 1:4
    rest_on_ground(car);
    return car;
}

}  // namespace tuft::models
