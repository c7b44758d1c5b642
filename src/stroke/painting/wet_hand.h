#pragma once

#include "ink/film/film.h"
#include "ink/film/paste.h"
#include "ink/touch/transfer.h"
#include "stroke/painting/stamper.h"

namespace tuft::stroke {

/// What a stroke with wet ink has in hand besides the tuft: the liquid on the touching hair, and
/// time that the film has not seen yet. The film is stepped by the samples' time, every 50 ms.
class WetHand {
  public:
    /// All must outlive it.
    WetHand(ink::WetFilm& film, ink::Canvas& canvas, const ink::FilmParams& params)
        : film_(&film), canvas_(&canvas), params_(params) {}

    /// Time goes by, touching or not.
    void pass(Stamper& stamper, double seconds, const ProgressFn& progress);
    /// How a tuft is pressed: 0–1, and newtons on the surface.
    struct Press {
        double stress = 0, force = 0;
    };
    /// One stamp of a tuft whose bundles lie at `tines`: ink goes both ways, and what the hair does
    /// not hold runs down. Returns the liquid given less what was taken, film·m².
    double lay(Stamper& stamper, const Stamp& stamp, ink::Reservoir& tuft, const ink::Touch& touch,
               const ink::NodeTouch& nodes, std::span<const ink::Tine> tines, const Press& press,
               const ink::Drain& drain);
    /// The tuft is lifted for good: what is on the hair goes into it.
    void end(Stamper& stamper, ink::Reservoir& tuft, const ink::Touch& touch, const ink::NodeTouch& nodes,
             const ProgressFn& progress);

  private:
    void advance(Stamper& stamper, const ProgressFn& progress);

    ink::WetFilm* film_;
    ink::Canvas* canvas_;
    ink::FilmParams params_;
    ink::Skin skin_;
    double pending_ = 0;   ///< seconds
    double since_ = 0;     ///< seconds since the last stamp
    double step_ = 0;      ///< seconds since the last sample, touching or not
};

}  // namespace tuft::stroke
