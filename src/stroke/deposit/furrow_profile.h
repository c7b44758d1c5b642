#pragma once

#include <vector>

#include "ink/film/paste.h"
#include "stroke/contact/hair_contact.h"

namespace tuft::stroke {

/// How firmly each bundle lies over the width of the patch, from stamp to stamp: bundles come to lie otherwise within
/// 1.5 mm of travel, and a furrow deepens and fades over 9 mm.
class FurrowProfile {
  public:
    /// The bundles at the next stamp: place over the patch's width, 0–1, and firmness over the firmest.
    std::vector<ink::BundleFirmness> advance(const TuftInHand& tuft, const HairContact& hair, double travel);

  private:
    std::vector<double> firmness_;  // [bundles]
    double updated_at_ = 0;         // travel
};

}  // namespace tuft::stroke
