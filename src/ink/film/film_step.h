#pragma once

#include <span>

#include "ink/film/film_list.h"

/// \file
/// Step length of the wet film. Internal to the wet film (film.h).
namespace tuft::ink::wet {

inline constexpr double kBeadStep = 0.05;  // seconds: a bead goes a texel or a few

/// A step and its division for the flow beside seams: blocks of texels end there, and limited flows would let
/// texels lag behind. 0 parts: no division.
struct StepChoice {
    double dt = 0;  ///< seconds
    Step step;
    int parts = 0;
    Step part;  ///< flow and mixing only
};
/// What else bounds a step.
struct StepState {
    bool on_relief = false;  ///< any of the tiles has dry relief
    bool beads = false;      ///< some beads run
    double slower = 1;       ///< how many times as slowly it dries
};
/// Returns the longest stable step of the listed tiles, at most `left` seconds and at least
/// `FilmParams::shortest_step`.
StepChoice choose_step(const FilmParams& p, const TileList& tiles, const StepState& state, double left);

/// Lengths of the steps by tension, seconds.
struct LevelSteps {
    static constexpr double kStep = 0.1, kLongest = 1.6, kShortest = 0.0125;

    double seconds = kStep;  ///< of the next one
    double shortest = kShortest, least = kStep, most = kLongest;

    /// `slower`: how many times as slowly it dries, which is all that moves in a long wait.
    void set(double least_step, double slower);
    void grow();
    /// After a step: `bends`, Σ curvature² over that before it; `change`, the greatest, of the thickness.
    void follow(double bends, double change);
};

}  // namespace tuft::ink::wet
