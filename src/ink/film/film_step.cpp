#include "ink/film/film_step.h"

#include <algorithm>
#include <cmath>

namespace tuft::ink::wet {
namespace {

constexpr double kLongestStep = 0.25;  // seconds: between flow, soaking and drying
// What may leave a texel in one step, of what it has: less than all of it together.
constexpr double kFlowPart = 0.5, kMixingPart = 0.2;
// What links add to the stiffness k of a tile's own faces, 4 at least: of what a texel has less than kFlowPart (k + kSeamPart) /
// (k + kSeamStiffness) leaves it, 0.92 at most.
constexpr double kSeamStiffness = 2;
static_assert(kFlowPart * (4 + kSeamPart) < 4 + kSeamStiffness);
// The same where flows are held back: texels inside charts have 4 sides and 4 corners through which half as much goes,
// those at seams 0.4 of that and the rest over links. Together with mixing no more than all.
constexpr double kHeldPart = 0.75, kFaces = 6, kHeldPartOfLinks = 0.5;
// Of the shortest step: ink runs off ridges at once; no blocks lie over seams; fronts run fast while there is liquid on
// the surface.
constexpr double kStepOnRelief = 0.2, kStepAtSeams = 0.4, kStepOfFilm = 0.5;

}  // namespace

double choose_step(const FilmParams& p, std::span<const Active> list, double texel_size, bool on_relief, bool beads,
                   double left, Step& step) {
    const double area = texel_size * texel_size;
    const double levelling = glm::length(p.down) > 0 ? 0 : p.levelling;
    double stiffness = 4, most_w = 0, most_s = 0;
    bool at_seams = false;
    for (const Active& tile : list) {
        at_seams = at_seams || (tile.seam_wet && !tile.links.empty());
        stiffness = std::max(stiffness, static_cast<double>(tile.stiffness));
        if (!tile.links.empty()) stiffness = std::max(stiffness, std::max(4.0, static_cast<double>(tile.stiffness)) + kSeamStiffness);
        most_w = std::max(most_w, static_cast<double>(tile.outcome.most_w));
        most_s = std::max(most_s, static_cast<double>(tile.outcome.most_s));
    }
    double dt = beads ? kBeadStep : kLongestStep;
    const double free = std::max(0.0, most_w - p.hold);
    const double over_ridges = on_relief ? p.levelling * std::max(0.0, most_w - p.ridge) : 0;
    const double flow = stiffness / area *
                        std::max(p.mobility * (most_w - p.threshold) + std::max(levelling * free, over_ridges),
                                 p.pores > 0 ? p.mobility * most_s : 0.0);
    if (flow > 0) dt = std::min(dt, kFlowPart / flow);
    const double mixing = p.mixing / area * stiffness;
    if (mixing > 0) dt = std::min(dt, kMixingPart / mixing);
    const double shortest = p.shortest_step * (on_relief ? kStepOnRelief : at_seams ? kStepAtSeams : most_w > 0 ? kStepOfFilm : 1);
    const bool held = dt < shortest;
    dt = std::max(dt, shortest);
    dt = left / std::ceil(left / dt * (1 - 1e-12));
    step.flow = static_cast<float>(p.mobility * dt / area);
    step.levelling = static_cast<float>(levelling * dt / area);
    step.limit = static_cast<float>(kFlowPart / stiffness);
    step.most = held ? static_cast<float>(kHeldPart / kFaces) * kRoomUnit : 0;
    step.most_of_link = static_cast<float>(kHeldPartOfLinks);
    step.threshold = static_cast<float>(p.threshold);
    step.pin = static_cast<float>(p.pin);
    step.mixing = static_cast<float>(std::min(p.mixing * dt / area, kMixingPart / stiffness));
    step.grip = static_cast<float>(p.grip);
    step.soak = static_cast<float>(-std::expm1(-p.absorbency * dt));
    step.pores = static_cast<float>(p.pores);
    step.passing = static_cast<float>(1 - p.retention);
    step.evaporation = static_cast<float>(p.evaporation * dt);
    step.rim = static_cast<float>(p.rim_evaporation * dt / (texel_size * p.rim_depth));
    step.rim_depth = static_cast<float>(p.rim_depth);
    step.hold = static_cast<float>(p.hold);
    step.relief = static_cast<float>(p.levelling * dt / area);
    step.ridge = static_cast<float>(p.ridge);
    return dt;
}

}  // namespace tuft::ink::wet
