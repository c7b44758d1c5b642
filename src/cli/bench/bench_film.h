#pragma once

#include <functional>

#include "stroke/surface/model.h"

/// \file
/// Speed of wet ink, for `tuft bench`.
namespace tuft::cli {

/// Measured times.
struct FilmFigures {
    double flow_ns =
        0;  ///< per wet texel and step, four pigments, one thread, CPU time; no ripples level, nothing soaks
    double step_ns = 0;           ///< the same with levelling and soaking into bisque
    double transfer_ns = 0;       ///< per covered texel and stamp, ink both ways, four pigments
    double steps_per_second = 0;  ///< of a whole wet atlas, two threads, wall time; 0: not measured (beyond 2048²)
};

/// Measures on the model's atlas. Runs for some seconds.
FilmFigures measure_film(const stroke::Model& model);

/// Puts the whole atlas under a film of water with four pigments. Returns a function that advances it and returns the
/// wall time of a step, the mean of ten and more. The model must outlive it.
std::function<double()> wet_atlas(const stroke::Model& model);

}  // namespace tuft::cli
