#pragma once

#include "stroke/surface/model.h"

/// Speed of wet ink, for `tuft bench`.
namespace tuft::cli {

struct FilmFigures {
    double step_ns = 0;           ///< per wet texel and step, four pigments, one thread, CPU time
    double transfer_ns = 0;       ///< per covered texel and touch, ink both ways, four pigments
    double steps_per_second = 0;  ///< of a whole atlas that is wet all over, two threads, wall time; 0: not
                                  ///< taken (atlas beyond 2048²)
};
FilmFigures measure_film(const stroke::Model& model);

}  // namespace tuft::cli
