#pragma once

#include <vector>

#include "brush/state/tuft_state.h"

/// \file
/// Symmetric decoration: poses mirrored and rotated. Called by the studio, which paints each copy as a stroke of its
/// own: on an asymmetric model every copy has its own contact.
namespace tuft::stroke {

/// Copies that each stroke gets.
struct Symmetry {
    bool mirror_x = false, mirror_y = false, mirror_z = false;  ///< in the planes through the centre across x, y, z
    int radial = 1;                                             ///< copies round the axis with the original, 1–32
    Vec3 centre{0};                                             ///< metres, model frame
    Vec3 axis{0, 0, 1};                                         ///< unit, of the radial copies

    bool any() const { return mirror_x || mirror_y || mirror_z || radial > 1; }
};

/// The map x → centre + linear (x − centre), metres, `linear` orthogonal.
struct PoseMap {
    Mat3 linear{1};
    Vec3 centre{0};

    Vec3 point(const Vec3& p) const { return centre + linear * (p - centre); }
    /// Maps a pose. After a reflection the ferrule's y axis is flipped to make its frame right-handed again: every
    /// tuft is symmetric in y, and a slant, along x, is mirrored with the pose.
    brush::Pose pose(const brush::Pose& pose) const;
};

/// Returns the elements, without the identity, of the group that the reflections and the rotation generate, in a fixed
/// order; at most 127.
std::vector<PoseMap> symmetry_copies(const Symmetry& symmetry);

}  // namespace tuft::stroke
