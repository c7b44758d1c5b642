#pragma once

#include <optional>
#include <vector>

#include "brush/tuft/upright_hair.h"
#include "contact/contact.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/footprint.h"

/// \file
/// Where the hair touches at one pose, whatever ink it holds. `HairContact` makes stamps of it; a forecast computes it
/// ahead.
namespace tuft::stroke {

/// Hair on the surface at one pose, in the frame of the contact.
struct HairShape {
    std::vector<footprint::Trail> trails;        ///< of all branches, without the upright hair
    std::vector<footprint::Trail> leapt;         ///< of the pose before, see footprint::leapt_trails; or none
    brush::UprightHair upright;                  ///< `share` 0: none
    std::vector<footprint::Outline> outlines;    ///< of wet hair, which closes its gaps; with `closed` only
    std::optional<footprint::Footprint> closed;  ///< footprint of wet hair, where it was computed
};

/// Whether hair touches, on a triangle of the model.
inline bool touches(const contact::Result& contact) {
    return contact.tuft.touching && contact.triangle != kNone;
}

/// Hair of the last pose that touched, of a tuft with several spines; empty after three poses that did not. Hair that
/// springs forward while it is lifted may be in the air for a pose or two.
struct LastHair {
    std::vector<footprint::Trail> trails;
    Frame frame;
    Vec3 root{0};    ///< metres, world, of the ferrule
    int missed = 0;  ///< poses since then

    /// `at`: pose of the holder at that contact.
    void store(const brush::Tuft& tuft, const brush::Pose& at, const HairShape& hair, const contact::Result& contact);
};

/// Returns the trails and the upright hair of a tuft that touches, and what leapt since `last`.
HairShape find_hair(const brush::Tuft& tuft, const contact::Result& contact, const LastHair& last);

/// Adds outlines and footprint of wet hair. `cell`: metres, of the footprint.
void close_hair(HairShape& hair, const contact::Result& contact, double cell);

}  // namespace tuft::stroke
