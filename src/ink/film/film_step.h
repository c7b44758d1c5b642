#pragma once

#include <span>

#include "ink/film/film_list.h"

namespace tuft::ink::wet {

inline constexpr double kBeadStep = 0.05;     // seconds: a bead goes a texel or a few

/// The longest stable step of the listed tiles, seconds, no longer than `left` and no shorter than
/// `FilmParams::shortest_step` says, and its rates. `texel_size` in metres; `on_relief`: any of
/// them lies on dry relief; `beads`: some run.
double choose_step(const FilmParams& p, std::span<const Active> list, double texel_size, bool on_relief, bool beads,
                   double left, Step& step);

}  // namespace tuft::ink::wet
