#pragma once

#include <span>

#include "ink/film/film_list.h"

namespace tuft::ink::wet {

inline constexpr double kBeadStep = 0.05;  // seconds: a bead goes a texel or a few

/// A step, and into how many parts it is divided for what flows beside seams: blocks of texels end
/// there, and where flows are held back texels would lag behind. 0: all goes in one.
struct Chosen {
    double dt = 0;  ///< seconds
    Step step;
    int parts = 0;
    Step part;  ///< flow and mixing only
};
/// The longest stable step of the listed tiles, no longer than `left` seconds and no shorter than
/// `FilmParams::shortest_step` says. `texel_size` in metres; `on_relief`: any of
/// them lies on dry relief; `beads`: some run.
Chosen choose_step(const FilmParams& p, const TileList& tiles, double texel_size, bool on_relief, bool beads,
                   double left);

}  // namespace tuft::ink::wet
