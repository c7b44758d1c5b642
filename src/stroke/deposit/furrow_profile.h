#pragma once

#include <vector>

#include "core/system/recycled.h"
#include "ink/film/tile/paste.h"
#include "stroke/contact/hair_contact.h"

/// \file
/// Furrows that bundles of hair draw in paste. Called by deposit_paste.cpp.

namespace tuft::stroke {

/// Firmness of each bundle over the width of the patch, from stamp to stamp. The order of bundles changes within 1.5 mm
/// of travel; a furrow deepens and fades over 9 mm.
class FurrowProfile {
  public:
    /// Returns the bundles at the next stamp, after `travel` metres of the stroke: position over the patch's width,
    /// 0–1, and firmness relative to the firmest bundle.
    Recycled<ink::BundleFirmness> advance(const TuftInHand& tuft, const HairContact& hair, double travel);

  private:
    std::vector<double> firmness_;  // [bundles]
    double updated_at_ = 0;         // travel
};

}  // namespace tuft::stroke
