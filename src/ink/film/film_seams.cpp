#include "ink/film/film_seams.h"

#include <algorithm>
#include <cmath>

namespace tuft::ink::wet {
namespace {

/// Of a tile's `others`.
const SeamNeighbour* other_of(const Active& tile, std::uint32_t slot) {
    return &*std::lower_bound(tile.seams.others.begin(), tile.seams.others.end(), slot,
                              [](const SeamNeighbour& b, std::uint32_t s) { return b.slot < s; });
}

/// On a texel of a tile in the list, or of none.
std::array<float, 2> liquid_at(std::span<const Sources> sources, std::uint32_t index, int texel) {
    if (index == kNone) return {};
    return {at(sources[index].liquid[0], texel), at(sources[index].liquid[1], texel)};
}

/// `rim_slope` of the texels whose neighbours lie over a seam.
void slopes_over_seams(const SeamTile& at_seam, const Step& step, Work& work) {
    const auto& [tiles, sources, part, index] = at_seam;
    const Active& tile = tiles.list[index];
    const Geometry& g = tiles.faces_of(tile.slot, part);
    const SeamNeighbour* other = tile.seams.others.data();
    work.sloping = true;
    for (std::size_t i = 0; i < tile.seams.taps.size();) {
        const std::uint8_t texel = tile.seams.taps[i].texel;
        const int k = field_of(texel), column = texel % kSide, row = texel / kSide;
        const float here = std::min(work.total[k], step.drying.rim_depth);
        std::array<float, 4> beyond{};
        std::array<bool, 4> tapped{};
        for (; i < tile.seams.taps.size() && tile.seams.taps[i].texel == texel; ++i) {
            const atlas::SeamTap& tap = tile.seams.taps[i];
            tapped[tap.side] = true;
            if (tap.other_slot == kNone) {
                beyond[tap.side] +=
                    tap.weight * work.total[k + tap.other_texel % 3 - 1 + (tap.other_texel / 3 - 1) * kRow];
                continue;
            }
            if (other->slot != tap.other_slot) other = other_of(tile, tap.other_slot);
            if (other->place == kNone) continue;
            const Sources& there = sources[other->place];
            beyond[tap.side] +=
                tap.weight * (at(there.liquid[0], tap.other_texel) + at(there.liquid[1], tap.other_texel));
        }
        if (!(here > 0)) continue;
        const auto drop = [&](int side, int conductance, int neighbour) {
            if (conductance == 0 && !tapped[side]) return 0.0f;
            return std::max(0.0f, here - (tapped[side] ? std::max(0.0f, beyond[side]) : work.total[neighbour]));
        };
        const int side = Geometry::right_of(column, row);
        const float across = drop(0, g.gx[side], k + 1) + drop(2, g.gx[side - 1], k - 1);
        const float along = drop(1, g.gy[texel + kSide], k + kRow) + drop(3, g.gy[texel], k - kRow);
        work.rim_slope[texel] = std::sqrt(across * across + along * along);
    }
}

}  // namespace

void cross_seams(const SeamTile& at_seam, int pigments, const Step& step, bool thin, Work& work, Crossing& crossing) {
    const auto& [tiles, sources, part, index] = at_seam;
    const Active& tile = tiles.list[index];
    crossing.clear(tile.seams.links.size(), pigments);
    if (tile.seams.links.empty()) return;
    for (std::size_t i = 0; i < tile.seams.links.size(); ++i) {
        const atlas::SeamLink& l = tile.seams.links[i];
        const std::uint32_t other = tile.seams.others[tile.seams.link_others[i]].place;
        const std::array<float, 2> here = liquid_at(sources, static_cast<std::uint32_t>(index), l.texel),
                                   there = liquid_at(sources, other, l.other_texel);
        const float t = here[0] + here[1], u = there[0] + there[1];
        thin = thin || u < step.drying.rim_depth;
        if (!(t + u > 0) || other == kNone || part == Part::outside) continue;
        for (int p = 0; p < pigments; ++p)
            crossing.beyond[static_cast<std::size_t>(p) * crossing.links + crossing.size] =
                at(sources[other].open[p], l.other_texel);
        for (int p = 0; p < pigments; ++p)
            crossing.pigments |= static_cast<std::uint32_t>(sources[other].open[p] != nullptr) << p;
        SeamLanes& lanes = crossing.lanes[crossing.size / kSide];
        const std::size_t lane = crossing.size % kSide;
        const bool both = t > 0 && u > 0;  // then what pins rims has no say, and lies in memory far away
        lanes.grain[0][lane] = both ? 0 : tiles.geometry[tile.slot]->grain[field_of(l.texel)];
        lanes.grain[1][lane] = both ? 0 : tiles.geometry[l.other_slot]->grain[field_of(l.other_texel)];
        lanes.z[0][lane] = at(sources[index].relief, l.texel);
        lanes.z[1][lane] = at(sources[other].relief, l.other_texel);
        crossing.add(l, tile.seams.link_areas[i], {here[0], there[0]}, {here[1], there[1]});
    }
    wet::seam_fluxes(std::span(crossing.lanes).first((crossing.size + kSide - 1) / kSide), step);
    for (std::size_t i = 0; i < crossing.size; ++i) {
        const SeamLanes& l = crossing.lanes[i / kSide];
        work.dw[crossing.texels[i]] -= l.through[i % kSide];
    }
    if (step.drying.rim > 0 && thin) slopes_over_seams(at_seam, step, work);
}

}  // namespace tuft::ink::wet
