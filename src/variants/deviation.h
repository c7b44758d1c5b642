#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stroke/journal/entry/entry.h"
#include "variants/task.h"

/// \file
/// Deviations of placements and hands from what was planned, drawn from a seed. Applied to strokes that are placed on a
/// model already. Any thread.
namespace tuft::variants {

/// Returns a standard normal number [BoxMuller1958], the same for the same seed and counter.
double normal_number(std::uint64_t seed, std::uint64_t counter);

/// Smooth random function of the path length s, metres, with standard deviation `spread` and correlation
///
///     exp(−Δs² / 2 length²),
///
/// as a sum of 48 waves with random wave numbers [Rahimi2007]. Both hold exactly in the mean over seeds.
class RandomDeviation {
  public:
    RandomDeviation(double spread, double length, std::uint64_t seed);
    double at(double s) const;

  private:
    struct Wave {
        double number, phase;
    };
    std::vector<Wave> waves_;
    double amplitude_;
};

/// Changes strokes and areas on the model as the deviation of this seed says, with independent normal numbers z of the
/// tolerance's standard deviations.
///
/// Flat ones: p' = (1 + z_scale) p + (z_x, z_y) in the frame of their placement, whose axes turn by z_turn about its
/// normal. All placements of the drawing deviate alike, each about its own origin. Pressures are multiplied by
/// 1 + z_pressure, one z for each stroke, and stay in [0, 1].
///
/// Strokes in space are those of a fixture: they move rigidly, by z along each model axis, and turn about the middle of
/// their box by a rotation vector of three z.
///
/// Then the path of each stroke deviates by a `RandomDeviation` along each axis. Entries on the palette stay as they
/// are.
void deviate(std::vector<stroke::JournalEntry>& entries, const Tolerance& tolerance, std::uint64_t seed);

}  // namespace tuft::variants
