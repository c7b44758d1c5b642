#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"

/// \file
/// Hair inside the tuft: cohesive bundles and the single bristles in them. They follow the sections of the solved
/// spines. `footprint` and `stroke` read them for contact and ink.
namespace tuft::brush {

/// One drawn hair. It represents all real hairs near it.
struct Bristle {
    Vec2f place{0};       ///< position in the section, unit disc: x along e, y along m
    float end = 1;        ///< end of the hair, fraction of the tuft's length from the root
    float readiness = 0;  ///< seeded, 0–1: bristles of lower readiness give their ink first
    std::uint16_t bundle = 0;
};

/// Strip of a wide ferrule, over its half-width: hair with from ≤ x < to belongs to its spine.
struct HairStrip {
    double from = -1, to = 1;
};

/// All bundles of a tuft, and its drawn bristles.
struct Bundles {
    std::uint64_t seed = 0;
    /// Of a wide ferrule, from −x to +x. Places are then over its half-width and half-thickness, x along the broad
    /// side.
    std::vector<HairStrip> strips;
    int around = 0;           ///< of a ring of spines, the number round the middle one; 0: no ring
    std::vector<Vec2> place;  ///< [n] position in the section, unit disc
    /// [n] seeded, about 1: film that the bundle leaves on the surface, relative to the mean.
    std::vector<double> holds;
    std::vector<double> resists;     ///< [n] seeded, about 1: factor on the splitting threshold
    std::vector<double> separation;  ///< [n] state: 0 joined to the others … 1 separate
    std::vector<Bristle> bristles;
};

/// Distributes `preset.bundles` bundles and `preset.bristles` bristles over the section: Vogel's spiral, perturbed
/// by the seed. The same seed gives the same hair.
Bundles make_bundles(const Preset& preset, std::uint64_t seed);

/// Updates the separation of the bundles by the bifurcation rule, each bundle by its own saturation s_k (0–1):
///
///     ξ k (1 − s_k) > split_at · resists_k  →  separation_k grows over 4 mm of travel;
///     ξ (1 − s_k) < merge_at · resists_k    →  separation_k falls to 0 within 0.1 s.
///
/// Between the thresholds it does not change: separate hair joins again when it is wetted or combed (`rejoin_hair`).
/// `stress` is k in [0, 1], `travel` in metres, `dt` in seconds. The result does not depend on the step size.
void split_bundles(Bundles& bundles, const Preset& preset, double stress, std::span<const double> saturation,
                   double travel, double dt);

/// Joins all bundles: every separation becomes 0.
void rejoin_hair(Bundles& bundles);

/// Returns the current position of a bristle in the section. Separation moves it towards its bundle's centre.
Vec2 place_of(const Bundles& bundles, const Bristle& bristle);

/// Position in a branch of a position in the whole section. The section is cut into `count` strips of equal area from
/// −e to +e, and each strip is mapped to a disc. Order and fractions of the hair are preserved. For one branch it is
/// the identity. A strip of a wide ferrule is mapped to the rectangle of equal area about the disc's middle,
/// half-widths √π/2: side by side the rectangles of neighbours leave no gap. A sector of a ring is mapped to a disc of
/// equal area too, its outer rim towards +x [Shirley1997].
struct BranchPlace {
    int branch = 0;
    Vec2 place{0};
};
BranchPlace in_branch(const Bundles& bundles, const Vec2& place, int count);

/// Cells of a bundle along its length, for its ink: their ends (fraction of the length from the root) and their
/// fractions of the hair's volume.
struct HairCells {
    std::vector<double> ends, capacities;
};
HairCells hair_cells(const Preset& preset);

}  // namespace tuft::brush
