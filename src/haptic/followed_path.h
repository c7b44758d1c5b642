#pragma once

#include <filesystem>
#include <vector>

#include "haptic/device/simulated.h"
#include "haptic/recording.h"

/// \file
/// The hand of a simulated arm on a way that is given: a table, or what an arm once recorded.
namespace tuft::haptic {

/// Where a hand wants to be at a time.
struct TimedPlace {
    double time = 0;            ///< s
    Vec3 position{0};           ///< m, arm's frame
    Quat rotation{1, 0, 0, 0};  ///< of the holder
    std::uint32_t buttons = 0;
};

/// Reads columns t,x,y,z or t,x,y,z,qw,qx,qy,qz in seconds and metres, or a recording (recording.h). Times rise, and
/// count from the first row. The places of a recording, read in counts, become their means over 8 ms. Throws `Error`
/// with file and line.
std::vector<TimedPlace> read_followed_path(const std::filesystem::path& file);

/// A path through these places in turn, with a velocity that has no jump; it stays at the first one before and at the
/// last one after. Precondition: at least one place; times rise.
HandPath followed_path(std::vector<TimedPlace> places);

}  // namespace tuft::haptic
