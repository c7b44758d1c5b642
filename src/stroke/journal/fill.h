#pragma once

#include <cstdint>
#include <string>

#include "core/geometry/types.h"

/// Ink laid over a whole part of a model at once.
namespace tuft::stroke {

/// What is filled.
enum class Region {
    all,    ///< the whole model
    part,   ///< what hangs together with the surface at `Fill::at`
    chart,  ///< the chart of the atlas at `Fill::at`
};

/// How the second ink or film takes the place of the first.
enum class Gradient {
    none,   ///< it does not
    along,  ///< t = (p − from)·(to − from) / |to − from|²
    round,  ///< t = |p − from| / |to − from|
};

/// A fill: at the point p the film is film + t (to_film − film), of which the part t is the
/// second ink; t is kept to [0, 1]. Metres, model frame; film units of wet ink.
struct Fill {
    double film = 1.8;
    Gradient gradient = Gradient::none;
    double to_film = 1.8;
    std::string to_ink;  ///< empty: the same
    Vec3 from{0}, to{0};
    Region region = Region::all;
    Vec3 at{0};  ///< a point on or near the surface, for `part` and `chart`

    bool operator==(const Fill&) const = default;
};

/// Throws `Error` for numbers out of range and gradients without length.
void check_fill(const Fill& fill);

/// t at a point.
double along_gradient(const Fill& fill, const Vec3& point);

/// Words for regions and gradients; back throws `Error` for any other.
std::string name_of(Region region);
std::string name_of(Gradient gradient);
Region region_of(const std::string& name);
Gradient gradient_of(const std::string& name);

}  // namespace tuft::stroke
