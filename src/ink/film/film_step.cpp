#include "ink/film/film_step.h"

#include <algorithm>
#include <cmath>

namespace tuft::ink::wet {
namespace {

constexpr double kLongestStep = 0.25;  // seconds: between flow, soaking and drying
constexpr double kLongestSoaked = 1;   // the same where nothing stands on the surface
// What may leave a texel in one step, of what it has: less than all of it together.
constexpr double kFlowPart = 0.5, kMixingPart = 0.2;
// What links add to the stiffness k of a tile's own faces, 4 at least: of what a texel has less than kFlowPart (k +
// kSeamPart) / (k + kSeamStiffness) leaves it, 0.92 at most.
constexpr double kSeamStiffness = 2;
static_assert(kFlowPart * (4 + kSeamPart) < 4 + kSeamStiffness);
// The same where flows are held back: texels inside charts have 4 sides and 4 corners through which half as much goes,
// those at seams 0.4 of that and the rest over links. Together with mixing no more than all.
constexpr double kLimitPart = 0.75, kFaces = 6, kLimitPartOfLinks = 0.5;
// Of the shortest step: ink runs off ridges at once; fronts run fast while there is liquid on the
// surface.
constexpr double kStepOnRelief = 0.2, kStepOfFilm = 0.5;
constexpr int kMostParts = 64;
// Steps by tension are doubled where Σ curvature² keeps the one part, or no texel changes by so much of its thickness;
// halved where it keeps but the other. What decays by 1 / (1 + z) in place of e^−z has a rate that is off by z / 2.
constexpr double kSlow = 0.9, kFast = 0.8, kLittle = 2e-3, kMuch = 5e-3, kVeryMuch = 0.1;

/// What flows fastest: least seconds in which a tile's part as small as 1 / stiffness of that could
/// flow off.
struct Deepest {
    double stiffness = 4, w = 0;

    void take(const Active& tile) {
        const auto own = static_cast<double>(tile.faces.stiffness);
        stiffness = std::max({stiffness, own, tile.seams.links.empty() ? 0 : std::max(4.0, own) + kSeamStiffness});
        w = std::max(w, static_cast<double>(tile.outcome.most_w));
    }
    double rate(const FilmParams& p, double levelling, double area, bool on_relief) const {
        const double over_ridges = on_relief ? p.levelling * std::max(0.0, w - p.ridge) : 0;
        return stiffness / area *
               (p.mobility * (w - p.threshold) + std::max(levelling * std::max(0.0, w - p.retained), over_ridges));
    }
};

Step part_of(const Step& step, int parts, double stiffness) {
    const float part = 1 / static_cast<float>(parts);
    Step out = step;
    for (float* rate : {&out.flow, &out.levelling, &out.mixing, &out.relief}) *rate *= part;
    out.limit.flow = static_cast<float>(kFlowPart / stiffness);
    out.limit.most = out.drying.evaporation = out.drying.rim = 0;
    return out;
}

}  // namespace

StepChoice choose_step(const FilmParams& p, const TileList& tiles, const StepState& state, double left) {
    const auto [on_relief, beads, slower] = state;
    const double texel_size = tiles.map.texel_size;
    const double area = texel_size * texel_size;
    const double levelling = glm::length(p.weight.down) > 0 ? 0 : p.levelling;
    Deepest all, beside;
    for (const Active& tile : tiles.list) {
        all.take(tile);
        if (tiles.beside_seam(tile.slot)) beside.take(tile);
    }
    const double stiffness = all.stiffness;
    StepChoice out;
    double dt = beads ? kBeadStep : (all.w > 0 ? kLongestStep : kLongestSoaked) * slower;
    const double flow = all.rate(p, levelling, area, on_relief);
    if (flow > 0) dt = std::min(dt, kFlowPart / flow);
    const double mixing = p.mixing / area * stiffness;
    if (mixing > 0) dt = std::min(dt, kMixingPart / mixing);
    const double shortest = p.shortest_step * (on_relief ? kStepOnRelief : all.w > 0 ? kStepOfFilm : 1);
    const bool limited = dt < shortest;
    dt = std::max(dt, shortest);
    dt = left / std::ceil(left / dt * (1 - 1e-12));
    Step& step = out.step;
    step.flow = static_cast<float>(p.mobility * dt / area);
    step.levelling = static_cast<float>(levelling * dt / area);
    step.limit.flow = static_cast<float>(kFlowPart / stiffness);
    step.limit.most = limited ? static_cast<float>(kLimitPart / kFaces) * kFlowAreaUnit : 0;
    step.limit.most_of_link = static_cast<float>(kLimitPartOfLinks);
    step.threshold = static_cast<float>(p.threshold);
    step.pin = static_cast<float>(p.pin);
    step.mixing = static_cast<float>(std::min(p.mixing * dt / area, kMixingPart / stiffness));
    step.grip = static_cast<float>(p.grip);
    step.pores = static_cast<float>(p.pores.capacity);
    step.passing = static_cast<float>(1 - p.pores.retention);
    step.drying.evaporation = static_cast<float>(p.drying.evaporation * dt);
    step.drying.rim = static_cast<float>(p.drying.rim_evaporation * dt / (texel_size * p.drying.rim_depth));
    step.drying.rim_depth = static_cast<float>(p.drying.rim_depth);
    step.retained = static_cast<float>(p.retained);
    step.relief = static_cast<float>(p.levelling * dt / area);
    step.ridge = static_cast<float>(p.ridge);
    out.dt = dt;
    if (!limited || !(beside.w > 0)) return out;
    const double longest = std::max(beside.rate(p, levelling, area, on_relief) / kFlowPart, mixing / kMixingPart);
    out.parts = std::clamp(static_cast<int>(std::ceil(dt * longest)), 2, kMostParts) / 2 * 2;
    out.part = part_of(step, out.parts, beside.stiffness);
    return out;
}

void LevelSteps::set(double least_step, double slower) {
    const double longer = slower > 1 ? 2 * slower : 1;
    least = least_step * longer, most = kLongest * longer;
    shortest = slower > 1 ? least : kShortest * least / kStep;
    seconds = std::clamp(seconds, slower > 1 ? least : 0, most);
}

void LevelSteps::grow() {
    seconds = std::min(2 * seconds, most);
}

void LevelSteps::follow(double bends, double change) {
    if (bends > kSlow || change < kLittle)
        grow();
    else if (bends < kFast && change > kMuch)
        seconds = std::max(0.5 * seconds, change > kVeryMuch ? shortest : least);
}

}  // namespace tuft::ink::wet
