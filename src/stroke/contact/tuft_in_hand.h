#pragma once

#include <string>

#include "brush/tuft/tuft.h"
#include "ink/colour/pigments.h"
#include "ink/exchange/reservoir.h"

namespace tuft::stroke {

/// A brush as it persists between two strokes.
struct BrushInHand {
    brush::Tuft tuft;
    ink::Reservoir reservoir;
    std::string dipped;  ///< the ink it was last dipped into
    std::string named;   ///< the ink that its last stroke named
};

/// 0 dry … 1 wet: hair is wet while it holds ink; the last quarter of its fill leaves it to dry.
double wetness_of(const ink::Reservoir& reservoir);

/// A new brush's reservoir, empty: a cell for each cluster of each bundle of its hair.
ink::Reservoir empty_reservoir(const brush::Tuft& tuft);

/// The brush during one stroke: its hair, its ink, and how it bends.
struct TuftInHand {
    BrushInHand brush;
    ink::Ink ink;               ///< that it was dipped into
    brush::TuftState state;     ///< at the last pose
    Quat rotation{1, 0, 0, 0};  ///< of the ferrule at the last pose

    const brush::Preset& preset() const { return brush.tuft.preset; }
    /// Tells the hair how much ink it holds: friction, cohesion, plasticity and splitting depend on it.
    void update_wetness();
    /// Takes over the bent tuft of the next pose. Bending mixes what the bundles hold.
    void bend(brush::TuftState next, const brush::Pose& pose);
    /// k in [0, 1] of the ink's laws: root moment over that of a firm press.
    double stress() const;
    /// How what hangs on the tuft runs to the contact at `contact` (metres, world); `down`: the direction of weight,
    /// zero without.
    ink::Drain drain(const brush::Pose& pose, const Vec3& contact, const Vec3& down) const;
};

}  // namespace tuft::stroke
