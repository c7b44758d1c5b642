#pragma once

#include <optional>

#include "brush/tuft/upright_hair.h"
#include "contact/contact.h"
#include "core/system/recycled.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/footprint.h"
#include "footprint/outline/rough_edge.h"

/// \file
/// Where the hair touches at one pose, whatever ink it holds. `HairContact` makes stamps of it; a forecast computes it
/// ahead.
namespace tuft::stroke {

/// Path of the hand over the surface, as far as it touched.
struct SurfacePath {
    bool touching = false;  ///< at the last pose
    double travel = 0;      ///< metres
    Vec3 course{0};         ///< displacement without pressing and lifting, mean over 2 mm; metres, world
    Vec3 position{0};       ///< of the ferrule at the last pose, metres, world
};

/// Hair on the surface at one pose, in the frame of the contact.
struct HairShape {
    Recycled<footprint::Trail> trails;           ///< of all branches, without the upright hair
    Recycled<footprint::Trail> leapt;            ///< of the pose before, see footprint::leapt_trails; or none
    brush::UprightHair upright;                  ///< `share` 0: none
    SurfacePath hand;                            ///< up to this pose
    footprint::EdgeHair edge;                    ///< at the edge of wet hair
    Recycled<footprint::Outline> outlines;       ///< of wet hair, which closes its gaps; with `closed` only
    std::optional<footprint::Footprint> closed;  ///< footprint of wet hair, where it was computed
};

/// Whether hair touches, on a triangle of the model.
inline bool touches(const contact::Result& contact) {
    return contact.tuft.touching && contact.triangle != kNone;
}

/// What of the last poses the next one needs. Trails are those of the last pose that touched, of a tuft with several
/// spines; empty after three poses that did not: hair that springs forward while it is lifted may be in the air for a
/// pose or two.
struct LastHair {
    Recycled<footprint::Trail> trails;
    Frame frame;
    Vec3 root{0};      ///< metres, world, of the ferrule
    int missed = 0;    ///< poses since then
    SurfacePath hand;  ///< of any tuft

    /// `at`: pose of the holder at that contact.
    void store(const brush::Tuft& tuft, const brush::Pose& at, const HairShape& hair, const contact::Result& contact);
};

/// Returns the trails, the upright hair and the edge of a tuft that touches, and what leapt since `last`.
HairShape find_hair(const brush::Tuft& tuft, const contact::Result& contact, const LastHair& last);

/// Options of the footprints of wet hair.
struct ClosedHairOptions {
    double cell = 1e-4;  ///< metres, of the footprints
    bool rough = false;  ///< ink that stays where hair leaves it; false: the edge is smooth, as liquid levels it
    footprint::EdgeGrain grain;  ///< of the substrate, for a rough edge
};

/// Returns the edge of wet hair.
footprint::RoughEdge edge_of(const HairShape& hair, const ClosedHairOptions& options);

/// Adds outlines and footprint of wet hair.
void close_hair(HairShape& hair, const contact::Result& contact, const ClosedHairOptions& options);

}  // namespace tuft::stroke
