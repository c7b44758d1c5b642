#pragma once

#include "footprint/stamp/stamp.h"

/// The picture of a footprint moved straight over many of its cells.
namespace tuft::footprint {

/// Mean of the bilinear picture P over the motion, E(x) = ∫₀¹ P(x + ρ w) dρ with w = `shift` /
/// cell: the picture is sheared so that the motion runs along one axis, and the integral is the
/// difference of two prefix sums along it. Fills pairs, width, height, gain and the one sub-pose
/// that leads from cells into the sheared picture, of `jobs`. Exact along the motion; across it
/// the shear interpolates between two cells. Cost: that of the picture's cells and of those it
/// passes over, 0.3 ns each, however long the motion.
void sweep(const Footprint& footprint, const Vec2& shift, StampJobs& jobs, SweepScratch& scratch);

/// The same with the largest value on the way, M(x) = max_ρ P(x + ρ w), what the picture passes over at
/// all: E + part (M − E). A hair drawn sideways leaves an area, not a thin film of its own width's share.
void sweep_over(const Footprint& footprint, const Vec2& shift, float part, StampJobs& jobs, SweepScratch& scratch);

}  // namespace tuft::footprint
