#include "core/text/units.h"

namespace tuft {

std::optional<double> metres_per(std::string_view unit) {
    if (unit == "um") return 1e-6;
    if (unit == "mm") return 1e-3;
    if (unit == "cm") return 1e-2;
    if (unit == "m") return 1.0;
    if (unit == "in") return 0.0254;
    if (unit == "ft") return 0.3048;
    return std::nullopt;
}

}  // namespace tuft
