#pragma once

#include <algorithm>
#include <vector>

#include "brush/state/tuft_state.h"
#include "ink/exchange/erase.h"

/// \file
/// What a stroke did, for people and scripts. `StrokeSession` fills it in; `tuft paint`, the studio and fit.h read it.
namespace tuft::stroke {

/// Forces at one sample of the hand, world frame.
struct ForceRecord {
    brush::Pose pose;      ///< of the ferrule at the sample's time
    Vec3 force{0};         ///< newtons, of the surface on the tuft: normal force and friction
    Vec3 device_force{0};  ///< newtons, for a haptic device (`contact::Result::device_force`: gain, proximity, clamp),
                           ///< filtered by the mass of the wet hair (brush/tuft/tuft.h)
    Vec3 torque{0};        ///< N·m, of `force` about the ferrule's mouth
    double moment = 0;     ///< N·m, bending moment at the ferrule
};

/// How far a tuft ran out of ink over a stroke.
struct Dryness {
    double full_at_start = 1;  ///< part of the tuft's capacity that it held before the stroke, 0–1
    double from = -1;          ///< metres of the path after which the tuft was never wet again for 5 mm; < 0: it was
                               ///< wet at the end
    double path = 0;           ///< metres after `from` on which a stamp left less than 0.6 of a full film, gaps between
                               ///< hairs counted, and less than 0.9 of what the ink of the start would have left there
};

/// Poses and places of a stroke that lie within a closed model. They are held on its surface.
struct InsideModel {
    std::size_t poses = 0;  ///< whose ferrule would be below the surface
    double deepest = 0;     ///< metres below the surface, of the deepest of them
    double origin = 0;      ///< metres below the surface of the origin of a flat stroke's placement
};

/// What a stroke or a fill did.
struct StrokeReport {
    std::uint64_t stroke_id = 0;  ///< of its entry in the journal
    std::size_t samples = 0;
    std::size_t stamps = 0;       ///< poses at which the tuft touched
    std::size_t unconverged = 0;  ///< of them, solved only to the iteration limit
    double ink_given = 0;         ///< film·m², now on the texels
    bool met = false;             ///< an area of a drawing lies on texels of visible parts, locked ones among them
    double ink_left = 0;          ///< film·m², in the tuft
    double path = 0;              ///< metres of the hand while the tuft touched
    Dryness dryness;
    ink::Amounts removed;  ///< by an eraser, of all films of its layer, film·m²
    double nearest = 0;    ///< metres: least distance of tuft and model; 0 when it touched
    InsideModel inside;
    std::vector<ForceRecord> forces;  ///< one per sample of the stroke, in order; with `record_forces` only

    bool touched() const { return stamps > 0; }
    /// Whether a full brush ran out of ink: it was dry on a twentieth of the path or more, and on most of what came
    /// after `dryness.from`.
    bool ran_dry() const {
        return dryness.full_at_start > 0.95 && dryness.from > 0 &&
               dryness.path > std::max(0.05 * path, 0.5 * (path - dryness.from));
    }
};

}  // namespace tuft::stroke
