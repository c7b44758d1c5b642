#pragma once

#include <algorithm>
#include <vector>

#include "brush/state/tuft_state.h"
#include "ink/exchange/erase.h"

namespace tuft::stroke {

/// Forces at one sample of the hand.
struct ForceRecord {
    brush::Pose pose;      ///< that the sample held the brush in, at the sample's time
    Vec3 force{0};         ///< newtons, of the surface on the tuft: normal and friction
    Vec3 device_force{0};  ///< newtons, for a haptic device: contact::Result::device_force (gain,
                           ///< proximity, clamp), which has come through the mass of the wet
                           ///< hair (brush/tuft/tuft.h), so that a tip that slips does not knock
    Vec3 torque{0};        ///< N·m, of `force` about the ferrule's mouth
    double moment = 0;     ///< N·m, bending moment at the ferrule
};

/// What a stroke or a fill did.
struct StrokeReport {
    std::uint64_t stroke_id = 0;
    std::size_t samples = 0;
    std::size_t stamps = 0;       ///< poses at which the tuft touched
    std::size_t unconverged = 0;  ///< of them, solved only to the iteration limit
    double ink_given = 0;         ///< film·m², now on the texels
    double ink_left = 0;          ///< film·m², in the tuft
    double path = 0;              ///< metres that the hand went while the tuft touched
    double dry_from =
        -1;  ///< metres of `path` after which the brush was never wet again for 5 mm; < 0: it was wet at the end
    double dry_path =
        0;  ///< metres after `dry_from` on which a stamp left less than 0.6 of a full film, gaps between hairs counted
    double full_at_start = 1;         ///< part of the tuft's capacity that it held before the stroke
    ink::Amounts removed;             ///< by an eraser, of all films of its layer
    double nearest = 0;               ///< metres: least distance of tuft and model; 0 when it touched
    std::size_t inside = 0;           ///< poses whose ferrule would be within the model: it was held on the surface
    double deepest = 0;               ///< metres that it would be below the surface at most
    double origin_inside = 0;         ///< metres that the origin of the stroke's placement lies within the model
    std::vector<ForceRecord> forces;  ///< one for each sample of the stroke, in order; only when asked for

    bool touched() const { return stamps > 0; }
    /// A full brush ran out of ink on the way: it was dry on a twentieth of it or more, and on most of what came after
    /// `dry_from`.
    bool ran_dry() const {
        return full_at_start > 0.95 && dry_from > 0 && dry_path > std::max(0.05 * path, 0.5 * (path - dry_from));
    }
};

}  // namespace tuft::stroke
