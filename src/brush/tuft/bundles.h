#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"

/// The hair within the tuft: bundles that stick together, and single bristles in them. They
/// follow the sections of the solved spines; here is what is their own.
namespace tuft::brush {

/// One drawn hair; it stands for all real ones near it.
struct Bristle {
    Vec2f place{0};       ///< in the section, unit disc: x along e, y along m
    float end = 1;        ///< where it ends, part of the tuft's length from the root
    float readiness = 0;  ///< seeded, 0–1: those of less give up their ink first
    std::uint16_t bundle = 0;
};

struct Bundles {
    std::uint64_t seed = 0;
    std::vector<Vec2> place;         ///< [n] in the section, unit disc
    std::vector<double> holds;       ///< [n] seeded, about 1: film it brings to the surface, over the mean
    std::vector<double> resists;     ///< [n] seeded, about 1: factor on the splitting threshold
    std::vector<double> separation;  ///< [n] state: 0 with the others … 1 drawn together by itself
    std::vector<Bristle> bristles;
};

/// Spreads `preset.bundles` bundles and `preset.bristles` bristles over the section, evenly
/// (Vogel's spiral) and shaken by the seed. The same seed gives the same hair.
Bundles make_bundles(const Preset& preset, std::uint64_t seed);

/// Bundles part from the others where bending and lack of ink pass the threshold of the
/// bifurcation rule, each by its own saturation s_k (0–1):
///
///     ξ k (1 − s_k) > split_at · resists_k  →  apart_k grows over 4 mm of travel;
///     ξ (1 − s_k) < merge_at · resists_k    →  water draws it back within 0.1 s.
///
/// Between the two it stays as it is: hair that is parted comes together when wetted, or
/// combed (`gather`). `stress` is k in [0, 1], `travel` metres, `dt` seconds; steps of any size
/// give the same.
void split_bundles(Bundles& bundles, const Preset& preset, double stress, std::span<const double> saturation,
                   double travel, double dt);

/// Combs all bundles together.
void gather(Bundles& bundles);

/// Where a bristle lies in the section now: drawn to its bundle's middle as that parts.
Vec2 place_of(const Bundles& bundles, const Bristle& bristle);

/// A place in the whole section as one in the sub-spine that took its hair: the section is cut
/// into `count` strips of equal area from −e to +e, each made round again. Strips and shares
/// of the hair are kept; for one sub-spine nothing changes.
struct BranchPlace {
    int branch = 0;
    Vec2 place{0};
};
BranchPlace in_branch(const Vec2& place, int count);

/// Division of a bundle along its length for its ink: where cells end (part of the length from
/// the root) and the part of the hair's volume in each.
struct HairCells {
    std::vector<double> ends, capacities;
};
HairCells hair_cells(const Preset& preset);

}  // namespace tuft::brush
