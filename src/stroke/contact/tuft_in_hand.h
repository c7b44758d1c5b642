#pragma once

#include <string>

#include "brush/tuft/tuft.h"
#include "ink/colour/pigments.h"
#include "ink/exchange/reservoir.h"

/// \file
/// A brush with its ink: between strokes (`BrushesInHand`) and during one (`StrokeSession`).

namespace tuft::stroke {

/// Hair and ink that persist between strokes.
struct BrushInHand {
    brush::Tuft tuft;
    ink::Reservoir reservoir;
    std::string dipped;  ///< name of the ink last dipped into
    std::string named;   ///< name of the ink of the last stroke
};

/// Fullness of the tuft from which its hair is wet.
inline constexpr double kWetFullness = 0.25;

/// Returns the wetness of the hair, 0 dry … 1 wet: x (2 − x), with x = min(1, fullness / `kWetFullness`).
double wetness_of(const ink::Reservoir& reservoir);

/// Returns an empty reservoir for a tuft: a cell per cluster of hair of each bundle.
ink::Reservoir empty_reservoir(const brush::Tuft& tuft);

/// The brush during one stroke: its hair, its ink, and how it bends.
struct TuftInHand {
    BrushInHand brush;
    ink::Ink ink;               ///< dipped into
    brush::TuftState state;     ///< at the last pose
    Quat rotation{1, 0, 0, 0};  ///< of the ferrule at the last pose

    const brush::Preset& preset() const { return brush.tuft.preset; }
    /// Sets the hair's wetness from the reservoir. Friction, cohesion, plasticity and splitting depend on it.
    void update_wetness();
    /// Takes the bent tuft of the next pose. Bending mixes the ink of the bundles; pressed foam holds less.
    void bend(brush::TuftState next, const brush::Pose& pose);
    /// Returns k of the ink's laws: root moment over that of a firm press, clamped to [0, 1]; of a sponge the volume
    /// that it has lost, likewise.
    double stress() const;
    /// Returns how ink that hangs on the tuft drains to `contact` (metres, world). `down`: direction of gravity; zero:
    /// none.
    ink::Drain drain(const brush::Pose& pose, const Vec3& contact, const Vec3& down) const;
};

}  // namespace tuft::stroke
