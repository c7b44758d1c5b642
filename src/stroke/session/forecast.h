#pragma once

#include <span>
#include <vector>

#include "contact/contact.h"
#include "stroke/contact/hair_shape.h"
#include "stroke/contact/tuft_in_hand.h"

/// \file
/// Bending and contact of a stroke's hair, computed before its ink is deposited. Both do not depend on the ink of wet
/// hair. Strokes are forecast at the same time; their ink is deposited in turn. `StrokeSession` uses a forecast as long
/// as the hair is wet.
namespace tuft::stroke {

/// Contact and hair at one pose of a path, as the session would compute them.
struct PoseForecast {
    brush::Pose pose;
    contact::Result contact;
    HairShape hair;  ///< of a tuft that touches
};

/// The hair of one stroke along its path.
///
/// Bending depends on the ink in two respects. The wetness is 1 from `kWetFullness` on. Splitting comes sooner with
/// less ink. A forecast assumes wetness 1 and the least ink that is wet. It ends where the tuft splits.
class StrokeForecast {
  public:
    struct Options {
        contact::Options contact;
        ClosedHairOptions closed;
    };

    /// Returns true for a tuft that can be forecast: fresh, hair in a ferrule, bent by the rods of `brush/rod`.
    static bool serves(const brush::Tuft& tuft) { return !tuft.posed && !tuft.split && !tuft.model && !tuft.carried; }

    /// `path`: poses of the resampled path. Cost: that of bending and outlines at every pose.
    StrokeForecast(brush::Tuft tuft, std::span<const brush::Pose> path, const mesh::SurfaceQuery& surface,
                   const Options& options);

    /// Returns the forecast of the next pose where it is valid for this pose and this hair, else null. The result may
    /// be moved from.
    PoseForecast* next(const brush::Pose& pose, const brush::Tuft& hair);
    /// Sets the hair and the memory of the contact to what they are after the poses returned by `next`. Bundles,
    /// wetness and ink of `hair` stay. Cost: bending at all those poses, or nothing at the end of the path.
    void catch_up(brush::Tuft& hair, contact::Memory& memory);

  private:
    brush::Tuft bend_to(std::size_t end, contact::Memory& memory) const;

    const mesh::SurfaceQuery& surface_;
    Options options_;
    brush::Tuft start_, end_;
    contact::Memory end_memory_;
    std::vector<brush::Pose> path_;
    std::vector<PoseForecast> poses_;  ///< up to where the tuft splits
    std::size_t next_ = 0;
};

}  // namespace tuft::stroke
