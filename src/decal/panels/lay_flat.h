#pragma once

#include <span>
#include <vector>

#include "atlas/seams/chart_mesh.h"

/// \file
/// Laying a panel of film flat at its true size, within a limit of strain. Called by panels.h.
namespace tuft::decal {

/// Principal stretches σ₁ ≥ σ₂ of the map from the sheet onto the model: length on the model over length on the sheet,
/// so σ − 1 is the strain of film that is printed flat and then laid onto the model.
struct Stretch {
    double most = 1, least = 1;

    /// Returns max |σ − 1|.
    double strain() const { return std::max(most - 1, 1 - least); }
};

/// Returns the stretches of each triangle. Infinite where a triangle has no positive area on the sheet. Needles, less
/// high than 1/100 of their longest edge, are 1: what they measure is rounding. [n_triangles of the chart]
std::vector<Stretch> measure_stretch(const atlas::ChartMesh& chart, std::span<const Vec2> flat);

/// Returns the largest strain, max |σ − 1| over all triangles.
double largest_strain(const atlas::ChartMesh& chart, std::span<const Vec2> flat);

/// A panel on the sheet.
struct FlatPanel {
    std::vector<Vec2> flat;  ///< [n_vertices of the chart], metres on the sheet; empty: it cannot be laid flat
    double strain = 0;       ///< `largest_strain`
    bool sound = false;      ///< no triangle is turned over and the border does not cross itself

    bool within(double limit) const { return sound && strain <= limit; }
};

/// Size of a sheet whose strain must be limited.
enum class SheetSize {
    balanced,  ///< the greatest and the least stretch are as far from 1: whether the limit can be met
    nearest,   ///< the true one, or half way to it, where the limit is met there too, else balanced; least strain
};

/// Lays a disk (metres) flat at true size. Developable panels are unrolled triangle by triangle: exact to rounding.
/// Others are laid out as rigid as possible [Liu2008]: Σ area Σ_k (1/σ_k − 1)² is least. Where that strains a triangle
/// by more than `limit`, local and global steps move strain to its neighbours until no triangle exceeds the limit
/// [Bouaziz2014]. The local step clamps both stretches of each triangle into 1 ± limit. The global step takes all
/// vertices to the mean of these targets. Ends early where the least mean of the strain already rules the limit out.
/// With `SheetSize::nearest` one sharp place does not change the size of all, and the largest strain is lowered
/// further, in the same steps, until a try at 2 % less gains less than half of that, or to 0.2 %. Cost: about 0.3 s for
/// 10,000 triangles, up to three times that for `nearest`.
///
/// On a spherical cap of angular radius α the least possible strain is (k − 1)/(k + 1) with k = α / sin α: no map of
/// the cap has a smaller ratio k of its greatest scale to its least [Milnor1969]. A `limit` of 1.1 times that is met,
/// and `nearest` comes within a tenth of it under any limit.
FlatPanel lay_flat(const atlas::ChartMesh& chart, double limit, SheetSize size = SheetSize::nearest);

}  // namespace tuft::decal
