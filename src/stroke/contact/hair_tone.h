#pragma once

#include <span>

#include "footprint/outline/hair.h"
#include "footprint/outline/rough_edge.h"
#include "ink/exchange/film_tone.h"
#include "ink/exchange/reservoir.h"

/// \file
/// Film by place across wet hair. Called by `HairContact`.
///
/// At the distance x beside the path of the hand
///
///     film(x) = 1 + 0.5 (L(x) − 1) + 0.04 w k(x / 0.16 mm, travel / 20 mm),    divided by its mean,
///
/// L(x) is the load of the touching bundles round x relative to their mean: saturation times `Bundles::holds`, weighted
/// by their length on the surface. k is value noise, of unit rms: strands of a few hairs. w falls from 1 to 0 where a
/// texel grows from half of a strand to 1.25 of it. A profile within 1 % of its mean is even: nobody sees it.
namespace tuft::stroke {

/// Profile of the film across the hair, computed anew as the hand goes on.
class HairTone {
  public:
    /// Computes the profile anew where the hand has gone 0.5 mm since the last time. `points`: of the touching hair,
    /// called then. `edge`: hair and hand at this pose; `cell`: metres, of the footprint.
    template <class Points>
    void update(const footprint::EdgeHair& edge, double cell, const ink::Reservoir& reservoir,
                const brush::Bundles& bundles, Points&& points) {
        if (computed_ && edge.travel >= updated_at_ && edge.travel < updated_at_ + kStep) return;
        compute(edge, cell, reservoir, bundles, points());
    }
    /// Forgets the profile: the hair left the surface.
    void clear() { computed_ = false; }

    /// Returns the profile in space at this pose; `contrast` 0–1: part of its departure from the mean.
    ink::FilmTone at(const footprint::EdgeHair& edge, const Frame& frame, double contrast) const;

  private:
    static constexpr double kStep = 0.5e-3;  // metres of travel
    void compute(const footprint::EdgeHair& edge, double cell, const ink::Reservoir& reservoir,
                 const brush::Bundles& bundles, std::span<const footprint::HairContactPoint> points);

    bool computed_ = false, even_ = true;
    double updated_at_ = 0;
    double from_ = 0, to_ = 0;  // metres beside the path of the hand: first and last sample
    std::array<float, ink::kToneSamples> film_;
};

}  // namespace tuft::stroke
