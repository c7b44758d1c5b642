#pragma once

#include <span>
#include <vector>

#include "contact/contact.h"
#include "stroke/contact/hair_shape.h"
#include "stroke/contact/tuft_in_hand.h"

/// \file
/// How the hair of a stroke bends and touches, computed ahead of its ink. Wet hair bends and touches in the same way
/// whatever it holds, so strokes can be forecast at the same time, and only their ink is deposited in turn.
/// `StrokeSession` uses a forecast as long as the hair is wet.
namespace tuft::stroke {

/// What a session would compute at one pose of its path.
struct PoseForecast {
    brush::Pose pose;
    contact::Result contact;
    HairShape hair;  ///< of a tuft that touches
};

/// The hair of one stroke along its path.
///
/// Bending depends on the ink by the wetness, which is 1 from `kWetFullness` on, and by splitting, which comes the
/// sooner the less ink is left. A forecast is made with wetness 1 and with the least ink that is wet; it ends where
/// the tuft splits.
class StrokeForecast {
  public:
    struct Options {
        contact::Options contact;
        double cell = 1e-4;  ///< metres, of footprints
    };

    /// Whether a tuft can be forecast: fresh, of hair in a ferrule, and bent by our own rods.
    static bool serves(const brush::Tuft& tuft) { return !tuft.posed && !tuft.split && !tuft.model && !tuft.carried; }

    /// `path`: poses of the resampled path. Cost: that of bending and outlines at every pose.
    StrokeForecast(brush::Tuft tuft, std::span<const brush::Pose> path, const mesh::SurfaceQuery& surface,
                   const Options& options);

    /// Returns the next pose's forecast if it holds for this pose and this hair, else null. The result may be moved
    /// from.
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
