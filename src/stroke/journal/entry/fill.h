#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/geometry/types.h"
#include "stroke/journal/entry/flat_area.h"
#include "stroke/journal/entry/layers.h"

/// \file
/// Fills and gradients: ink over a whole part of a model. `Document` carries them out (painting/apply_fill.h).
namespace tuft::stroke {

/// Part of the model that is filled.
enum class Region {
    all,      ///< the whole model
    part,     ///< the connected component at `Fill::at`
    chart,    ///< the chart of the atlas at `Fill::at`
    outline,  ///< `Fill::area`: masked, so that it covers what lies there
};

/// Parameter t of a gradient at a point p, clamped to [0, 1].
enum class Gradient {
    none,   ///< t = 0
    along,  ///< t = (p − from)·(to − from) / |to − from|²
    round,  ///< t = |p − from| / |to − from|
};

/// A fill. At a point p the film is film + t (to_film − film), film units of wet ink, of which the part t is the second
/// ink. Points in metres, model frame.
struct Fill {
    std::string ink;                    ///< name of the first ink
    std::uint32_t layer = kFirstLayer;  ///< id of the layer filled, or `kPaletteLayer`
    std::uint32_t mask = 0;             ///< id of the mask it stays within; 0: none
    PlaceNames names;                   ///< of a stroke file, until `layer` and `mask` are set
    double film = 1.8;                  ///< film units where t is 0
    Gradient gradient = Gradient::none;
    double to_film = 1.8;  ///< film units where t is 1
    std::string to_ink;    ///< name of the second ink; empty: the first one
    Vec3 from{0}, to{0};   ///< of the gradient
    Region region = Region::all;
    Vec3 at{0};  ///< on or near the surface, for `Region::part` and `chart`

    /// For `Region::outline`, else none. `ink` is that of its first stop; film and gradient are its own.
    std::optional<FlatArea> area;

    bool operator==(const Fill&) const = default;
};

/// Returns the fill of an area. Precondition: it has a stop.
Fill fill_of_area(FlatArea area);

/// Throws `Error` for numbers out of range and for a gradient whose ends coincide.
void check_fill(const Fill& fill);

/// Returns t at a point.
double along_gradient(const Fill& fill, const Vec3& point);

/// Words for regions and gradients, the names of their constants, and back. Back throws `Error` for any other word.
std::string name_of(Region region);
std::string name_of(Gradient gradient);
Region region_of(const std::string& name);
Gradient gradient_of(const std::string& name);

}  // namespace tuft::stroke
