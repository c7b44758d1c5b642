#include "ink/film/tension.h"

#include <algorithm>
#include <cmath>

#include "ink/film/drips.h"
#include "ink/film/film_seams.h"

namespace tuft::ink::wet {
namespace {

constexpr std::size_t kGrain = 8;  // tiles
constexpr double kSteep = 0.1;     // sin α: where beads may run
constexpr int kLeastCycles = 2, kMostCycles = 3;
constexpr float kMissing = 0.1f, kLeastMissing = 1e-6f;  // of the greatest change, film units: a texel may be off
constexpr int kSweepsBefore = 2, kSweepsAfter = 2, kSweepsOfLast = 8;

/// Copies the border of one cell from the tiles around.
template <int N>
void take_border(std::array<float, Grid<N>::kPadded>& to, const std::array<const float*, 9>& from) {
    const auto copy = [&](int column, int row, std::size_t tile, int its_column, int its_row) {
        to[static_cast<std::size_t>(Grid<N>::at(column, row))] =
            from[tile] ? from[tile][Grid<N>::at(its_column, its_row)] : 0;
    };
    for (int i = 0; i < N; ++i) {
        copy(i, -1, 1, i, N - 1);
        copy(i, N, 7, i, 0);
        copy(-1, i, 3, N - 1, i);
        copy(N, i, 5, 0, i);
    }
    copy(-1, -1, 0, N - 1, N - 1);
    copy(N, -1, 2, 0, N - 1);
    copy(-1, N, 6, N - 1, 0);
    copy(N, N, 8, 0, 0);
}

/// Of the tiles around in the list, in the set or not: the set ends between them, not the liquid.
void set_liquid(TensionTile& tile, const Active& active, std::span<const Sources> sources) {
    static constexpr Plane kDry{};
    std::array<const float*, 9> planes;
    for (std::size_t i = 0; i < 9; ++i) {
        const std::uint32_t at = active.around[i];
        const Plane* w = at == kNone ? nullptr : sources[at].liquid[0];
        planes[i] = (w ? w : &kDry)->data();
    }
    gather_field(tile.w, planes);
}

/// Place in the list of the tile beyond a link of `active`.
std::uint32_t place_beyond(const Active& active, std::size_t link) {
    return active.seams.others[active.seams.link_others[link]].place;
}

void set_coarse_grids(TensionTile& t) {
    sum_faces(t.grid, t.links, 1);
    coarsen(t.grid, t.grid2);
    sum_faces(t.grid2, t.links, 0.5f);
    coarsen(t.grid2, t.grid4);
    sum_faces(t.grid4, t.links, 0.25f);
    coarsen(t.grid4, t.grid8);
    sum_faces(t.grid8, t.links, 0.125f);
    coarsen(t.grid8, t.grid16);
    sum_faces(t.grid16, t.links, 0.0625f);
}

void find_change(TensionTile& t) {
    t.change = t.share = 0;
    for (int i = 0; i < kTexels; ++i) {
        const auto k = static_cast<std::size_t>(field_of(i));
        if (!(t.mobility[k] > 0)) continue;
        const float change = std::abs(t.grid.v[k]);
        t.change = std::max(t.change, change);
        t.share = std::max(t.share, change / t.w[k]);
    }
}

}  // namespace

template <class Fn>
void Tension::each(Fn&& fn) {
    tiles_.each(kGrain, fn);
}

void Tension::start(const FilmParams& params, const atlas::TexelMap& map) {
    if (steep_.empty() || params.weight.down != params_.weight.down) steep_.assign(map.n_slots(), -1);
    params_ = params;
    held_ = static_cast<float>(std::max(params.ripples.held, params.threshold));
    held_on_steep_ = std::max(held_, static_cast<float>(params.weight.trail));
}

void Tension::look_at(const atlas::TexelMap& map, std::uint32_t slot) {
    if (steep_[slot] >= 0) return;
    bool any = false;
    for (int t = 0; t < kTexels && !any; ++t)
        any = map.tiles[slot].cluster[t] != atlas::kNoCluster &&
              glm::length(glm::cross(Vec3(map.normal(slot, t)), params_.weight.down)) > kSteep;
    steep_[slot] = any;
}

bool Tension::find(const TileList& tiles, std::span<const std::unique_ptr<Plane>> relief) {
    const auto& list = tiles.list;
    const auto bead = static_cast<float>(Drips::least(params_));
    std::vector<std::uint8_t> wanted(list.size(), 0);
    const auto each_beside = [&](const Active& tile, auto&& visit) {
        for (const std::uint32_t i : tile.around)
            if (i != kNone) visit(i);
        for (const SeamNeighbour& other : tile.seams.others)
            if (other.linked && other.place != kNone) visit(other.place);
    };
    for (std::size_t at = 0; at < list.size(); ++at) {
        if (list[at].ripples.strong) wanted[at] = 1;
        if (!list[at].ripples.faint) continue;
        bool rims = false;
        each_beside(list[at], [&](std::uint32_t i) { rims = rims || list[i].ripples.rims; });
        if (!rims) each_beside(list[at], [&](std::uint32_t i) { wanted[i] = 1; });
    }
    for (const Active& tile : list)
        if (tile.outcome.most_w >= bead && steep_[tile.slot] == 1)
            each_beside(tile, [&](std::uint32_t i) { wanted[i] = 0; });
    places_.clear();
    for (std::uint32_t i = 0; i < list.size(); ++i)
        if (wanted[i] && list[i].outcome.most_w > held_on(list[i].slot) && !relief[list[i].slot]) places_.push_back(i);
    return !places_.empty();
}

void Tension::cross_seams(std::uint32_t place, std::span<const Sources> sources, int pigments, float grip, Work& work,
                          Crossing& crossing) const {
    const TensionTile& tile = *this->tile(place);
    crossing.clear(tile.links.size(), pigments);
    for (const TensionLink& l : tile.links) {
        const TensionTile& beyond = tiles_[l.other];
        const auto here = static_cast<std::size_t>(field_of(l.texel)),
                   there = static_cast<std::size_t>(field_of(l.other_texel));
        const Sources& from = sources[beyond.place];
        const float total = at(from.liquid[0], l.other_texel) + at(from.liquid[1], l.other_texel);
        const LinkFlow c = flow_over_link(l, {tile.w[here], beyond.w[there]}, {tile.grid.p[here], beyond.grid.p[there]},
                                          {work.rate[here], 1 / std::max(total, grip)});
        work.dw[l.texel] -= c.flow;
        for (int p = 0; p < pigments; ++p) {
            const Plane* open = from.open[static_cast<std::size_t>(p)];
            crossing.beyond[static_cast<std::size_t>(p) * crossing.links + crossing.size] = at(open, l.other_texel);
            crossing.pigments |= static_cast<std::uint32_t>(open != nullptr) << p;
        }
        SeamLanes& lanes = crossing.lanes[crossing.size / kSide];
        lanes.a[crossing.size % kSide] = c.a;
        lanes.b[crossing.size % kSide] = c.b;
        crossing.texels[crossing.size++] = l.texel;
    }
}

void Tension::begin(const TileList& tiles, std::span<const Sources> sources, float mobility) {
    take_tiles(tiles);
    // Each step reads what the one before left in the tiles around.
    each([&](TensionTile& t) { open_tile(t, tiles.list[t.place], sources, mobility); });
    each([&](TensionTile& t) { close_rims(t, tiles.list[t.place]); });
    each([&](TensionTile& t) {
        for (int i = 0; i < kTexels; ++i)
            t.mobility[static_cast<std::size_t>(field_of(i))] = t.inner[static_cast<std::size_t>(i)];
    });
    each([&](TensionTile& t) {
        take_mobility(t);
        set_faces(t, *tiles.list[t.place].faces.geometry);
        link_over_seams(t, tiles.list[t.place]);
        set_coarse_grids(t);
    });
}

void Tension::take_tiles(const TileList& tiles) {
    tiles_.take(places_, tiles.list.size());
    for (const auto& tile : tiles_) tile->held = held_on(tiles.list[tile->place].slot);
}

void Tension::open_tile(TensionTile& t, const Active& active, std::span<const Sources> sources, float mobility) const {
    for (std::size_t i = 0; i < 9; ++i) t.around[i] = in_set(active.around[i]);
    set_liquid(t, active, sources);
    open_texels(t, *active.faces.geometry, mobility);
    for (std::size_t i = 0; i < active.seams.links.size(); ++i) {
        const atlas::SeamLink& l = active.seams.links[i];
        const std::uint32_t at = place_beyond(active, i);
        const Plane* w = at == kNone ? nullptr : sources[at].liquid[0];
        if (!w || !((*w)[l.other_texel] > t.held)) t.mobility[static_cast<std::size_t>(field_of(l.texel))] = 0;
    }
}

void Tension::take_mobility(TensionTile& t) const {
    std::array<const float*, 9> around{};
    for (std::size_t i = 0; i < 9; ++i)
        if (t.around[i] != kNone) around[i] = tiles_[t.around[i]].mobility.data();
    take_border<16>(t.mobility, around);
}

void Tension::close_rims(TensionTile& t, const Active& active) const {
    take_mobility(t);
    hold_rims(t, *active.faces.geometry);
    for (std::size_t i = 0; i < active.seams.links.size(); ++i) {
        const std::uint32_t other = in_set(place_beyond(active, i));
        const auto there = static_cast<std::size_t>(field_of(active.seams.links[i].other_texel));
        if (other != kNone && !(tiles_[other].mobility[there] > 0)) t.inner[active.seams.links[i].texel] = 0;
    }
}

void Tension::link_over_seams(TensionTile& t, const Active& active) const {
    t.links.clear();
    for (std::size_t i = 0; i < active.seams.links.size(); ++i) {
        const atlas::SeamLink& l = active.seams.links[i];
        const std::uint32_t other = in_set(place_beyond(active, i));
        if (other == kNone) continue;
        const auto here = static_cast<std::size_t>(field_of(l.texel)),
                   there = static_cast<std::size_t>(field_of(l.other_texel));
        const float m0 = t.mobility[here], m1 = tiles_[other].mobility[there];
        if (!(m0 > 0 && m1 > 0)) continue;
        t.links.push_back(
            {other, l.texel, l.other_texel, l.weight, l.weight * (0.5f * (m0 + m1)), active.seams.link_areas[i]});
        t.grid.e[l.texel] += l.weight * (t.w[here] - tiles_[other].w[there]) * t.grid.inverse[l.texel];
    }
}

template <int N>
void Tension::exchange(TensionTile& tile) {
    Grid<N>& g = tile.of<N>();
    std::array<const float*, 9> v{}, p{};
    for (std::size_t i = 0; i < 9; ++i)
        if (tile.around[i] != kNone) {
            const Grid<N>& other = tiles_[tile.around[i]].template of<N>();
            v[i] = other.v.data();
            p[i] = other.p.data();
        }
    take_border<N>(g.v, v);
    take_border<N>(g.p, p);
    if (tile.links.empty()) return;
    constexpr int kPart = kSide / N;
    const auto column = [](int texel) { return texel % kSide / kPart; };
    const auto line = [](int texel) { return texel / kSide / kPart; };
    for (const TensionLink& l : tile.links) {
        const auto i = static_cast<std::size_t>(line(l.texel) * N + column(l.texel));
        g.beyond_v[i] = g.beyond_p[i] = 0;
    }
    for (const TensionLink& l : tile.links) {
        const auto i = static_cast<std::size_t>(line(l.texel) * N + column(l.texel));
        const auto k = static_cast<std::size_t>(Grid<N>::at(column(l.other_texel), line(l.other_texel)));
        const Grid<N>& other = tiles_[l.other].template of<N>();
        const float part = g.inverse[i] / kPart;
        g.beyond_v[i] += l.conductance * part * other.v[k];
        g.beyond_p[i] += l.mobility * part * other.p[k];
    }
}

template <int N>
void Tension::relax_all() {
    each([&](TensionTile& t) { relax(t.of<N>()); });
    each([&](TensionTile& t) { exchange<N>(t); });
}

template <int N>
void Tension::cycle() {
    if constexpr (N == 1) {
        for (int i = 0; i < kSweepsOfLast; ++i) relax_all<1>();
    } else {
        for (int i = 0; i < kSweepsBefore; ++i) relax_all<N>();
        each([&](TensionTile& t) { t.missing = restrict_residual(t.of<N>(), t.of<N / 2>()); });
        cycle<N / 2>();
        each([&](TensionTile& t) { prolong(t.of<N / 2>(), t.of<N>()); });
        each([&](TensionTile& t) { exchange<N>(t); });
        for (int i = 0; i < kSweepsAfter; ++i) relax_all<N>();
    }
}

Tension::TensionResult Tension::solve(const TileList& tiles, std::span<const Sources> sources, double dt) {
    const double area = tiles.map.texel_size * tiles.map.texel_size;
    begin(tiles, sources,
          static_cast<float>(params_.ripples.tension / (3 * params_.ripples.viscosity) * dt *
                             (kFilmUnit * kFilmUnit * kFilmUnit) / (area * area)));
    const auto square = [](const TensionTile& t, auto&& curvature) {
        double sum = 0;
        for (int i = 0; i < kTexels; ++i) {
            const auto c = static_cast<double>(curvature(i));
            sum += static_cast<double>(t.grid.area[static_cast<std::size_t>(i)]) * c * c;
        }
        return sum;
    };
    each([&](TensionTile& t) { t.bent = square(t, [&](int i) { return t.grid.e[static_cast<std::size_t>(i)]; }); });
    for (int i = 1; i <= kMostCycles; ++i) {
        cycle<16>();
        if (i < kLeastCycles) continue;
        each([&](TensionTile& t) {
            t.missing = restrict_residual(t.grid, t.grid2);
            find_change(t);
        });
        float missing = 0, change = 0;
        for (const auto& t : tiles_) missing = std::max(missing, t->missing), change = std::max(change, t->change);
        if (missing < std::max(kMissing * change, kLeastMissing)) break;
    }
    each([&](TensionTile& t) {
        t.bends = square(t, [&](int i) { return t.grid.p[static_cast<std::size_t>(field_of(i))]; });
    });
    double bent = 0, bends = 0;
    float share = 0;
    for (const auto& t : tiles_) bent += t->bent, bends += t->bends, share = std::max(share, t->share);
    return {bent > 0 ? bends / bent : 1, static_cast<double>(share)};
}

}  // namespace tuft::ink::wet
