#pragma once

#include <vector>

#include "brush/state/tuft_state.h"

/// Symmetric decoration: the pose is mirrored and turned, and each copy is painted as a
/// stroke of its own, so an unsymmetric model gets its own contact everywhere.
namespace tuft::stroke {

struct Symmetry {
    bool mirror_x = false, mirror_y = false, mirror_z = false;  ///< planes through the centre
    int radial = 1;                                             ///< copies round the axis, 1–32, the original counted
    Vec3 centre{0};                                             ///< metres, model frame
    Vec3 axis{0, 0, 1};                                         ///< unit, of the radial copies

    bool any() const { return mirror_x || mirror_y || mirror_z || radial > 1; }
};

/// x → centre + linear (x − centre), `linear` orthogonal.
struct PoseMap {
    Mat3 linear{1};
    Vec3 centre{0};

    Vec3 point(const Vec3& p) const { return centre + linear * (p - centre); }
    /// A reflection turns the ferrule's frame inside out; its x axis is flipped back, which
    /// changes nothing for a tuft that is the same on both sides.
    brush::Pose pose(const brush::Pose& pose) const;
};

/// All elements but the identity of the group that the planes and the turn generate, in
/// a fixed order, at most 127.
std::vector<PoseMap> symmetry_copies(const Symmetry& symmetry);

}  // namespace tuft::stroke
