#include "ink/film/film_list.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "core/system/parallel.h"
#include "ink/film/tile/fibres.h"

namespace tuft::ink::wet {
namespace {

constexpr std::size_t kMostBeads = 256;
constexpr std::uint32_t kStrip = 16;  // tiles
/// Sides of a tile (`Outcome::sides`) that are all wet where the tiles around it may be reached.
constexpr std::array<std::uint8_t, 9> kTowards{5, 1, 9, 4, 0, 8, 6, 2, 10};

/// Calls fn(i) for the places around a tile that what is wet in it may reach.
template <class Fn>
void each_reached(const Active& tile, Fn&& fn) {
    for (int i = 0; i < 9; ++i)
        if (i != 4 && (tile.outcome.sides & kTowards[i]) == kTowards[i]) fn(i);
}

void look(const Canvas& canvas, Active& tile) {
    tile.outcome.sides = 15;
    tile.seams.wet = true;
    const Plane *w = canvas.liquid(tile.slot, Liquid::film), *s = canvas.liquid(tile.slot, Liquid::pores);
    tile.outcome.most_w = w ? greatest(w->data()) : 0;
    tile.outcome.most_s = s ? greatest(s->data()) : 0;
}

/// The weight to which a texel's links are cut so that they are `most` together: those to texels that nearly lie on it,
/// which are as one with it through less too. What flows through the others stays as it is.
float most_of_links(std::vector<float>& weights, float most) {
    std::sort(weights.begin(), weights.end());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const float each = most / static_cast<float>(weights.size() - i);
        if (weights[i] > each) return each;
        most -= weights[i];
    }
    return std::numeric_limits<float>::infinity();
}

}  // namespace

TileList::TileList(const atlas::TexelMap& m, atlas::SeamLinks s)
    : map(m),
      seams(std::move(s)),
      geometry(m.n_slots()),
      split_geometry(m.n_slots()),
      scratch_{.wanted = {},
               .mark = std::vector<std::uint8_t>(m.n_slots(), 0),
               .place = std::vector<std::uint32_t>(m.n_slots(), kNone)} {
    for (const atlas::SeamLink& l : seams.links) unlimited_.weights.push_back(l.weight);
    unlimited_.taps = seams.taps;
    find_near();
    find_link_areas();
    find_beside();
    limit_links();
}

void TileList::find_beside() {
    beside_.assign(map.n_slots(), 0);
    const auto mark = [&](std::uint32_t slot, int texel) {
        const auto reach = [](int i) { return std::array{i < kBlock, true, i >= kSide - kBlock}; };
        const std::array<bool, 3> across = reach(texel % kSide), along = reach(texel / kSide);
        const std::array<std::uint32_t, 9> near = around(slot);
        for (std::size_t i = 0; i < 9; ++i)
            if (near[i] != kNone && across[i % 3] && along[i / 3]) beside_[near[i]] = 1;
    };
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        for (const atlas::SeamLink& l : links_of(slot)) mark(slot, l.texel);
        for (std::uint32_t i = seams.face_start[slot]; i < seams.face_start[slot + 1]; ++i)
            mark(slot, seams.faces[i].texel);
    }
}

void TileList::split_faces(std::uint32_t slot) {
    std::array<bool, 9> in_zone;
    const std::array<std::uint32_t, 9> near = around(slot);
    for (std::size_t i = 0; i < 9; ++i) in_zone[i] = near[i] != kNone && beside_[near[i]];
    split_geometry[slot] = split(*geometry[slot], in_zone);
}

void TileList::find_near() {
    over_seams_.start.assign(1, 0);
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        const std::size_t first = over_seams_.tiles.size();
        const auto add = [&](std::uint32_t other, std::uint8_t texel, bool linked) {
            if (other == kNone) return;
            const auto row = static_cast<std::uint16_t>(1u << texel / kSide);
            const auto begin = over_seams_.tiles.begin() + static_cast<std::ptrdiff_t>(first);
            const auto at = std::lower_bound(begin, over_seams_.tiles.end(), other,
                                             [](const SeamNeighbour& b, std::uint32_t s) { return b.slot < s; });
            if (at == over_seams_.tiles.end() || at->slot != other)
                over_seams_.tiles.insert(at, {other, kNone, linked, row});
            else
                at->linked |= linked, at->lines |= row;
        };
        for (const atlas::SeamLink& l : links_of(slot)) add(l.other_slot, l.other_texel, true);
        for (std::uint32_t i = seams.tap_start[slot]; i < seams.tap_start[slot + 1]; ++i)
            add(seams.taps[i].other_slot, seams.taps[i].other_texel, false);
        const auto begin = over_seams_.tiles.begin() + static_cast<std::ptrdiff_t>(first);
        for (const atlas::SeamLink& l : links_of(slot)) {
            const auto at = std::lower_bound(begin, over_seams_.tiles.end(), l.other_slot,
                                             [](const SeamNeighbour& b, std::uint32_t s) { return b.slot < s; });
            over_seams_.of_link.push_back(static_cast<std::uint16_t>(at - begin));
        }
        over_seams_.start.push_back(static_cast<std::uint32_t>(over_seams_.tiles.size()));
    }
}

/// Of each texel its links share the area; a link takes the smaller of its ends' parts, so that both hold the same.
void TileList::find_link_areas() {
    const double mean = map.texel_size * map.texel_size;
    std::vector<std::array<std::uint16_t, kTexels>> n_links(map.n_slots());
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (const atlas::SeamLink& l : links_of(slot)) ++n_links[slot][l.texel];
    const auto part = [&](std::uint32_t slot, std::uint8_t texel) {
        return static_cast<double>(map.tiles[slot].area[texel]) / (mean * n_links[slot][texel]);
    };
    link_areas_.clear();
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (const atlas::SeamLink& l : links_of(slot))
            link_areas_.push_back(static_cast<float>(std::min(part(slot, l.texel), part(l.other_slot, l.other_texel))));
}

void TileList::set_unevenness(double unevenness, double fibrous) {
    if (unevenness == medium_.unevenness && fibrous == medium_.fibrous) return;
    medium_.unevenness = unevenness;
    medium_.fibrous = fibrous;
    search_again();
}

void TileList::set_free(WetFilm::FreeFn free) {
    if (!free && !medium_.free) return;
    medium_.free = std::move(free);
    search_again();
}

void TileList::search_again() {
    ++faces_version_;
    for (auto& g : geometry) g.reset();
    for (auto& g : split_geometry) g.reset();
    EaseOfFlow ease(medium_, map.texel_size), beyond(medium_, map.texel_size);
    const auto root = [&](EaseOfFlow& of, std::uint32_t slot, int texel) {
        return of.root_at(Vec3(map.position(slot, texel)), Vec3(map.normal(slot, texel)));
    };
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (std::uint32_t i = seams.start[slot]; i < seams.start[slot + 1]; ++i) {
            atlas::SeamLink& l = seams.links[i];
            double weight = static_cast<double>(unlimited_.weights[i]);
            if (medium_.unevenness > 0) weight *= root(ease, slot, l.texel) * root(beyond, l.other_slot, l.other_texel);
            if (medium_.free) weight *= passing(medium_.free(slot, l.texel), medium_.free(l.other_slot, l.other_texel));
            l.weight = static_cast<float>(weight);
        }
    limit_links();
    close_taps();
}

/// Where a stencil edge lies on a tap, nothing slopes that way: the texel itself takes the tap's place.
void TileList::close_taps() {
    seams.taps = unlimited_.taps;
    if (!medium_.free) return;
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (std::uint32_t i = seams.tap_start[slot], next = i; i < seams.tap_start[slot + 1]; i = next) {
            const atlas::SeamTap first = unlimited_.taps[i];
            bool closed = false;
            for (; next < seams.tap_start[slot + 1] && unlimited_.taps[next].texel == first.texel &&
                   unlimited_.taps[next].side == first.side;
                 ++next)
                if (const atlas::SeamTap& tap = unlimited_.taps[next]; tap.other_slot != kNone)
                    closed = closed ||
                             passing(medium_.free(slot, tap.texel), medium_.free(tap.other_slot, tap.other_texel)) == 0;
            if (!closed) continue;
            for (std::uint32_t k = i; k < next; ++k)
                seams.taps[k] = {kNone, k == i ? 1.0f : 0.0f, first.texel, 4, first.side};
        }
}

void TileList::limit_links() {
    const double mean = map.texel_size * map.texel_size;
    std::vector<float> most(seams.links.size());  // of the texel that a link starts at
    std::vector<float> weights;
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (std::uint32_t i = seams.start[slot], next = i; i < seams.start[slot + 1]; i = next) {
            const std::uint8_t texel = seams.links[i].texel;
            weights.clear();
            for (; next < seams.start[slot + 1] && seams.links[next].texel == texel; ++next)
                weights.push_back(seams.links[next].weight);
            const double all = kSeamPart * static_cast<double>(map.tiles[slot].area[texel]) / mean;
            std::fill(most.begin() + i, most.begin() + next, most_of_links(weights, static_cast<float>(all)));
        }
    // Both texels hold a link with the same weight.
    const auto cut = [&](std::uint32_t slot, std::uint32_t i) {
        const atlas::SeamLink& l = seams.links[i];
        const auto begin = seams.links.begin() + seams.start[l.other_slot],
                   end = seams.links.begin() + seams.start[l.other_slot + 1];
        const auto back = std::lower_bound(begin, end, std::tuple(l.other_texel, slot, l.texel),
                                           [](const atlas::SeamLink& a, const auto& key) {
                                               return std::tuple(a.texel, a.other_slot, a.other_texel) < key;
                                           });
        return std::min(most[i], most[static_cast<std::size_t>(back - seams.links.begin())]);
    };
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (std::uint32_t i = seams.start[slot]; i < seams.start[slot + 1]; ++i)
            seams.links[i].weight = std::min(seams.links[i].weight, cut(slot, i));
}

std::span<const atlas::SeamLink> TileList::links_of(std::uint32_t slot) const {
    return std::span(seams.links).subspan(seams.start[slot], seams.start[slot + 1] - seams.start[slot]);
}

std::array<std::uint32_t, 9> TileList::around(std::uint32_t slot) const {
    std::array<std::uint32_t, 9> out;
    const auto n = static_cast<std::int64_t>(map.tiles_per_side);
    const std::int64_t tx = map.tile_of_slot[slot] % n, ty = map.tile_of_slot[slot] / n;
    for (int i = 0; i < 9; ++i) {
        const std::int64_t x = tx + i % 3 - 1, y = ty + i / 3 - 1;
        out[i] = x < 0 || y < 0 || x >= n || y >= n ? kNone : map.slot_of_tile[static_cast<std::size_t>(y * n + x)];
    }
    return out;
}

void TileList::begin(const Canvas& canvas) {
    const std::vector<std::uint32_t> wet = canvas.wet_slots();
    list.clear();
    list.resize(wet.size());
    parallel_for(wet.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Active& tile = list[i];
            tile.slot = wet[i];
            look(canvas, tile);
        }
    });
    spread();
}

/// Sets what lies beyond the seams of a tile, but for `others`.
void TileList::use_seams(Active& tile) const {
    const std::uint32_t first = seams.start[tile.slot], first_tap = seams.tap_start[tile.slot];
    ActiveSeams& own = tile.seams;
    own.links = links_of(tile.slot);
    own.link_others = std::span(over_seams_.of_link).subspan(first, own.links.size());
    own.link_areas = std::span(link_areas_).subspan(first, own.links.size());
    own.taps = std::span(seams.taps).subspan(first_tap, seams.tap_start[tile.slot + 1] - first_tap);
}

/// Sets the places of the tiles round each tile of the list and over its seams.
void TileList::find_neighbours() {
    for (Active& tile : list) {
        tile.around = around(tile.slot);
        tile.absent = 0;
        for (int i = 0; i < 9; ++i) {
            std::uint32_t& at = tile.around[i];
            if (at == kNone) continue;
            at = scratch_.place[at];
            if (at == kNone) tile.absent |= 1u << i;
        }
    }
    others_.clear();
    for (const Active& tile : list)
        for (std::uint32_t i = over_seams_.start[tile.slot]; i < over_seams_.start[tile.slot + 1]; ++i)
            others_.push_back({over_seams_.tiles[i].slot, scratch_.place[over_seams_.tiles[i].slot],
                               over_seams_.tiles[i].linked, over_seams_.tiles[i].lines});
    std::size_t from = 0;
    for (Active& tile : list) {
        const std::size_t n = over_seams_.start[tile.slot + 1] - over_seams_.start[tile.slot];
        tile.seams.others = std::span<const SeamNeighbour>(others_).subspan(from, n);
        from += n;
    }
}

void TileList::spread() {
    std::vector<std::uint32_t> wanted;
    const auto want = [&](std::uint32_t slot) {
        if (slot == kNone || scratch_.mark[slot]) return;
        scratch_.mark[slot] = 1;
        wanted.push_back(slot);
    };
    for (const Active& tile : list) {
        if (!tile.wet()) continue;
        want(tile.slot);
        const std::array<std::uint32_t, 9> near = around(tile.slot);
        each_reached(tile, [&](int i) { want(near[i]); });
        if (tile.seams.wet)
            for (const atlas::SeamLink& l : links_of(tile.slot)) want(l.other_slot);
    }
    std::sort(wanted.begin(), wanted.end());
    std::vector<Active> next(wanted.size());
    std::size_t k = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        while (k < list.size() && list[k].slot < wanted[i]) ++k;
        if (k < list.size() && list[k].slot == wanted[i]) next[i] = std::move(list[k]);
        next[i].slot = wanted[i];
        use_seams(next[i]);
        scratch_.place[wanted[i]] = static_cast<std::uint32_t>(i);
        scratch_.mark[wanted[i]] = 0;
    }
    list = std::move(next);
    find_neighbours();
    for (const Active& tile : list) scratch_.place[tile.slot] = kNone;
    readers = std::make_unique<std::atomic<std::uint32_t>[]>(list.size());
    n_readers.assign(list.size(), 0);
    for (std::size_t i = 0; i < list.size(); ++i) for_each_read_tile(i, [&](std::uint32_t read) { ++n_readers[read]; });
    put_in_order();
}

void TileList::put_in_order() {
    order.clear();
    const std::uint32_t strips = (map.tiles_per_side + kStrip - 1) / kStrip;
    std::vector<std::uint32_t> start(strips + 1, 0);
    const auto strip_of = [&](const Active& tile) { return map.tile_of_slot[tile.slot] % map.tiles_per_side / kStrip; };
    for (const Active& tile : list) ++start[strip_of(tile) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    order.resize(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) order[start[strip_of(list[i])]++] = static_cast<std::uint32_t>(i);
}

bool TileList::changed() {
    bool any = false;
    for (Active& tile : list) any |= std::exchange(tile.spreads, false);
    if (!any) return false;
    scratch_.wanted.assign(list.size(), 0);
    bool more = false;
    for (std::size_t at = 0; at < list.size() && !more; ++at) {
        const Active& tile = list[at];
        if (!tile.wet()) continue;
        scratch_.wanted[at] = 1;
        each_reached(tile, [&](int i) {
            if (tile.around[i] != kNone)
                scratch_.wanted[tile.around[i]] = 1;
            else
                more = more || (tile.absent >> i & 1);
        });
        if (!tile.seams.wet) continue;
        for (const SeamNeighbour& other : tile.seams.others) {
            if (!other.linked) continue;
            if (other.place != kNone)
                scratch_.wanted[other.place] = 1;
            else
                more = true;
        }
    }
    return more || std::find(scratch_.wanted.begin(), scratch_.wanted.end(), 0) != scratch_.wanted.end();
}

void TileList::search_tile(const Canvas& canvas, std::span<const std::uint32_t> slots) {
    const std::size_t listed = list.size();
    for (const std::uint32_t slot : slots) {
        const auto end = list.begin() + static_cast<std::ptrdiff_t>(listed);
        const auto at =
            std::lower_bound(list.begin(), end, slot, [](const Active& a, std::uint32_t s) { return a.slot < s; });
        const bool known = at != end && at->slot == slot;
        if (!known) {
            list.emplace_back();
            list.back().slot = slot;
        }
        look(canvas, known ? list[static_cast<std::size_t>(at - list.begin())] : list.back());
    }
    std::sort(list.begin(), list.end(), [](const Active& a, const Active& b) { return a.slot < b.slot; });
    spread();
}

std::vector<Drips::Seed> TileList::seeds_of_beads(const Canvas& canvas, const FilmParams& params,
                                                  const std::function<bool(std::uint32_t, int)>& in_sheet) const {
    struct Found {
        std::array<std::int32_t, 3> cube;
        float weak, height;
        Drips::Seed seed;
    };
    std::vector<Found> found;
    for (const Active& tile : list) {
        const auto least = static_cast<float>(Drips::least(params));
        if (tile.outcome.most_w < least) continue;
        const Plane& w = *canvas.liquid(tile.slot, Liquid::film);
        const std::size_t first = found.size();
        for (int t = 0; t < kTexels; ++t) {
            if (w[t] < least || in_sheet(tile.slot, t)) continue;
            const Vec3 at(map.position(tile.slot, t));
            const auto cell = [](double x) { return static_cast<std::int32_t>(std::floor(x / kGrainLength)); };
            const std::array cube{cell(at.x), cell(at.y), cell(at.z)};
            const float grain = geometry[tile.slot]->grain[field_of(t)];
            auto same = std::find_if(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
                                     [&](const Found& f) { return f.cube == cube; });
            if (same == found.end()) same = found.insert(found.end(), Found{cube, 0, 0, {}});
            if (w[t] > same->weak * grain)
                *same = {cube,
                         w[t] / grain,
                         static_cast<float>(-glm::dot(params.weight.down, at)),
                         {{tile.slot, static_cast<std::uint8_t>(t)}, static_cast<double>(grain)}};
        }
    }
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
        return a.cube != b.cube ? a.cube < b.cube : a.weak > b.weak;
    });
    found.erase(
        std::unique(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.cube == b.cube; }),
        found.end());
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.height < b.height; });
    std::vector<Drips::Seed> seeds;
    seeds.reserve(std::min(found.size(), kMostBeads));
    for (std::size_t i = 0; i < std::min(found.size(), kMostBeads); ++i) seeds.push_back(found[i].seed);
    return seeds;
}

}  // namespace tuft::ink::wet
