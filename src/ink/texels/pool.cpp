#include "ink/texels/pool.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "core/system/parallel.h"
#include "ink/elementary.h"
#include "ink/texels/halo.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels, kSide = atlas::kTile;
constexpr float kPart = 0.2f;  // of what could flow, to each of four sides
constexpr int kMostSteps = 96;
constexpr float kHeightUnit = 1e-5f;  // metres of paint in a film unit of height

using Texels = std::array<float, kN>;

struct Tile : HaloTile {
    alignas(64) Texels relief, near, film;           ///< film units of height, 0–1, film units
    alignas(64) Texels area, inverse;                ///< m² and 1 / m², of texels; 0 outside of charts
    alignas(64) Halo surface, level, slack, spread;  ///< of a step: z + T, T, ⟨T − ridge_film⟩, ⟨T − pin⟩
    alignas(64) Halo nearness, size;                 ///< n, area
    alignas(64) std::array<Halo, 2> faces;           ///< flux to the right and upwards of a texel
    alignas(64) std::array<Texels, kMaxPigments> loose, fixed;  ///< of the open film: what settles, and what lay there
    std::vector<float> over;                                    ///< flux out over each link
    unsigned pigments = 0;                                      ///< of which there is loose ink
};

/// A texel at one end of a face, film units: surface, film, and what of it may leave to wet and to dry texels.
struct PoolEnd {
    float surface, level, slack, spread;
};

/// Flux from a to b, film units, times n; antisymmetric.
inline float flux(const PoolEnd& a, const PoolEnd& b, float n) {
    const float drop = a.surface - b.surface;
    const float from_a = b.level > 0 ? a.slack : a.spread, from_b = a.level > 0 ? b.slack : b.spread;
    return kPart * n * (smaller(from_a, positive(drop)) - smaller(from_b, positive(-drop)));
}

/// Fluxes from each texel to that `to` further on in the halo.
TUFT_CLONES void face_fluxes(float* __restrict out, const Tile& tile, int to) {
    const Halo &z = tile.surface, &l = tile.level, &s = tile.slack, &p = tile.spread, &n = tile.nearness,
               &area = tile.size;
    for (int y = -1; y < kSide; ++y)
        for (int x = -1; x < kSide; ++x) {
            const int a = halo_at(x, y), b = a + to;
            out[a] = flux({z[a], l[a], s[a], p[a]}, {z[b], l[b], s[b], p[b]},
                          smaller(n[a], n[b]) * smaller(area[a], area[b]));
        }
}

TUFT_CLONES void film_after(float* __restrict film, const float* __restrict right, const float* __restrict up,
                            const float* __restrict inverse) {
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const int k = halo_at(x, y);
            const int t = y * kSide + x;
            film[t] += ((right[k - 1] - right[k]) + (up[k - kHaloRow] - up[k])) * inverse[t];
        }
}

/// What a face brings of a pigment whose part of the film is c at its ends.
inline float pigment_flow(float f, float c_from, float c_to) {
    return f > 0 ? f * c_from : f * c_to;
}

TUFT_CLONES void pigment_after(float* __restrict p, const float* __restrict right, const float* __restrict up,
                               const float* __restrict c, const float* __restrict inverse) {
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const int k = halo_at(x, y), below = k - kHaloRow, above = k + kHaloRow;
            const float d = (pigment_flow(right[k - 1], c[k - 1], c[k]) - pigment_flow(right[k], c[k], c[k + 1])) +
                            (pigment_flow(up[below], c[below], c[k]) - pigment_flow(up[k], c[k], c[above]));
            const int t = y * kSide + x;
            p[t] = positive(p[t] + d * inverse[t]);
        }
}

TUFT_CLONES void prepare(Tile& tile, Texels& surface, Texels& slack, Texels& spread, float ridge_film, float pin) {
    for (int t = 0; t < kN; ++t) {
        surface[t] = tile.relief[t] + tile.film[t];
        slack[t] = positive(tile.film[t] - ridge_film);
        spread[t] = positive(tile.film[t] - pin);
    }
}

const float* snapshot_plane(const TileSnapshot& before, int pigment) {
    if (!(before.planes >> pigment & 1)) return nullptr;
    int place = 0;
    for (int p = 0; p < pigment; ++p) place += before.planes >> p & 1;
    return before.amounts.data() + place * kN;
}

/// Reads a tile; whether there is relief on it.
bool read(Tile& tile, const Canvas& canvas, const atlas::TexelMap& map, const TileSnapshot& before,
          const PoolOptions& options) {
    tile.relief = dry_relief(canvas, tile.slot);
    for (float& z : tile.relief) z *= 1e-6f / kHeightUnit;
    tile.film.fill(0);
    for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p) {
        const Plane* now = canvas.plane(tile.slot, p);
        if (!now) continue;
        const float* was = snapshot_plane(before, p);
        const float height = canvas.pigments()[p].height / kHeightUnit;
        for (int t = 0; t < kN; ++t) {
            tile.fixed[p][t] = was ? smaller(was[t], (*now)[t]) : 0;
            tile.loose[p][t] = (*now)[t] - tile.fixed[p][t];
            tile.film[t] += tile.loose[p][t] / static_cast<float>(options.strength);
            tile.relief[t] += tile.fixed[p][t] * height;
            if (tile.loose[p][t] > 0) tile.pigments |= 1u << p;
        }
    }
    bool any = false;
    for (int t = 0; t < kN; ++t) {
        tile.relief[t] = positive(tile.relief[t] - static_cast<float>(kPlain * 1e-6) / kHeightUnit);
        const bool out =
            map.tiles[tile.slot].cluster[t] == atlas::kNoCluster || (options.free && !options.free(tile.slot, t));
        const float area = out ? 0 : map.tiles[tile.slot].area[t];
        tile.area[t] = area;
        tile.inverse[t] = area > 0 ? 1 / area : 0;
        tile.near[t] = area > 0 && tile.relief[t] > 0 ? 1.0f : 0.0f;
        any = any || tile.near[t] > 0;
    }
    return any;
}

class Pool {
  public:
    Pool(std::vector<Tile>& tiles, const PoolOptions& options) : tiles_(tiles), o_(options) {}

    /// How near relief is, falling by `decay` from texel to texel.
    void find_near(float decay) {
        std::vector<Texels> next(tiles_.size());
        for (int step = 0; step < std::min(static_cast<int>(1 / decay), kMostSteps); ++step) {
            each([&](std::size_t i) {
                Tile& tile = tiles_[i];
                fill(tile.nearness, tile, [](const Tile& t) -> const Texels& { return t.near; });
                for (int y = 0; y < kSide; ++y)
                    for (int x = 0; x < kSide; ++x) {
                        const int k = halo_at(x, y);
                        const Halo& n = tile.nearness;
                        const float best = std::max({n[k - 1], n[k + 1], n[k - kHaloRow], n[k + kHaloRow]}) - decay;
                        next[i][y * kSide + x] = tile.area[y * kSide + x] > 0 ? std::max(n[k], best) : 0;
                    }
                for (const auto& [place, link] : tile.links)
                    next[i][link.texel] = std::max(next[i][link.texel], tiles_[place].near[link.other_texel] - decay);
            });
            each([&](std::size_t i) { tiles_[i].near = next[i]; });
        }
        each([&](std::size_t i) {
            fill(tiles_[i].nearness, tiles_[i], [](const Tile& t) -> const Texels& { return t.near; });
            fill(tiles_[i].size, tiles_[i], [](const Tile& t) -> const Texels& { return t.area; });
        });
    }

    void step() {
        each([&](std::size_t i) {
            prepare(tiles_[i], surface_[i], slack_[i], spread_[i], static_cast<float>(o_.ridge_film),
                    static_cast<float>(o_.pin));
        });
        each([&](std::size_t i) {
            Tile& tile = tiles_[i];
            const auto from = [&](const std::vector<Texels>& all) {
                return
                    [&](const Tile& t) -> const Texels& { return all[static_cast<std::size_t>(&t - tiles_.data())]; };
            };
            fill(tile.surface, tile, from(surface_));
            fill(tile.slack, tile, from(slack_));
            fill(tile.spread, tile, from(spread_));
            fill(tile.level, tile, [](const Tile& t) -> const Texels& { return t.film; });
            face_fluxes(tile.faces[0].data(), tile, 1);
            face_fluxes(tile.faces[1].data(), tile, kHaloRow);
            tile.over.clear();
            for (const auto& [place, link] : tile.links) {
                const int a = link.texel, b = link.other_texel;
                const float n = smaller(tile.near[a], tiles_[place].near[b]) * smaller(link.weight, 1) *
                                smaller(tile.area[a], tiles_[place].area[b]);
                tile.over.push_back(flux(end_at(i, a), end_at(place, b), n));
            }
        });
        for (int p = 0; p < kMaxPigments; ++p) {
            const bool any =
                std::any_of(tiles_.begin(), tiles_.end(), [p](const Tile& t) { return t.pigments >> p & 1; });
            if (any) transport(p);
        }
        each([&](std::size_t i) {
            Tile& tile = tiles_[i];
            film_after(tile.film.data(), tile.faces[0].data(), tile.faces[1].data(), tile.inverse.data());
            for (std::size_t k = 0; k < tile.over.size(); ++k) {
                const int t = tile.links[k].second.texel;
                tile.film[t] -= tile.over[k] * tile.inverse[t];
            }
            for (float& t : tile.film) t = positive(t);
        });
    }

    std::vector<Texels> surface_, slack_, spread_;

  private:
    PoolEnd end_at(std::size_t tile, int texel) const {
        return {surface_[tile][texel], tiles_[tile].film[texel], slack_[tile][texel], spread_[tile][texel]};
    }

    void transport(int p) {
        each([&](std::size_t i) {  // parts of the film
            const Tile& tile = tiles_[i];
            for (int t = 0; t < kN; ++t) slack_[i][t] = tile.film[t] > 0 ? tile.loose[p][t] / tile.film[t] : 0;
        });
        each([&](std::size_t i) {
            Tile& tile = tiles_[i];
            fill(tile.slack, tile,
                 [&](const Tile& t) -> const Texels& { return slack_[static_cast<std::size_t>(&t - tiles_.data())]; });
            pigment_after(tile.loose[p].data(), tile.faces[0].data(), tile.faces[1].data(), tile.slack.data(),
                          tile.inverse.data());
            for (std::size_t k = 0; k < tile.over.size(); ++k) {
                const auto& [place, link] = tile.links[k];
                float& here = tile.loose[p][link.texel];
                here =
                    positive(here - pigment_flow(tile.over[k], slack_[i][link.texel], slack_[place][link.other_texel]) *
                                        tile.inverse[link.texel]);
            }
        });
    }
    template <class Fn>
    void each(Fn fn) {
        parallel_for(tiles_.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) fn(i);
        });
    }
    template <class Field>
    void fill(Halo& out, const Tile& tile, Field field) const {
        fill_halo(out, tiles_, tile, field);
    }

    std::vector<Tile>& tiles_;
    const PoolOptions& o_;
};

}  // namespace

Plane dry_relief(const Canvas& canvas, std::uint32_t slot) {
    Plane sum;
    sum.fill(0);
    for (int film = kFirstDryFilm; film < kOpenFilm; ++film)
        for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
            if (const Plane* w = canvas.film_plane(slot, film, p)) {
                const float height = 1e6f * canvas.pigments()[p].height;
                for (int t = 0; t < kN; ++t) sum[t] += (*w)[t] * height;
            }
    return sum;
}

void pool(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams,
          std::span<const TileSnapshot* const> before, const PoolOptions& options) {
    std::vector<std::uint32_t> slots;
    slots.reserve(before.size());
    for (const TileSnapshot* tile : before) slots.push_back(tile->slot);
    std::vector<Tile> tiles = halo_tiles<Tile>(map, seams, slots);
    bool any = false;
    for (std::size_t i = 0; i < tiles.size(); ++i) any = read(tiles[i], canvas, map, *before[i], options) || any;
    if (!any) return;
    Pool work(tiles, options);
    work.surface_.resize(tiles.size());
    work.slack_.resize(tiles.size());
    work.spread_.resize(tiles.size());
    const double reach = std::max(options.reach / map.texel_size, 1.0);  // texels
    work.find_near(static_cast<float>(1 / reach));
    // What is drawn off a ridge goes a texel in five steps, and levels as heat does.
    const int steps = std::min(static_cast<int>(std::ceil(5 * reach + reach * reach / 2)), kMostSteps);
    for (int k = 0; k < steps; ++k) work.step();
    for (Tile& tile : tiles) {
        if (std::all_of(tile.near.begin(), tile.near.end(), [](float n) { return n == 0; })) continue;
        for (int p = 0; p < kMaxPigments; ++p) {
            const bool here = std::any_of(tile.loose[p].begin(), tile.loose[p].end(), [](float v) { return v > 0; });
            if (!canvas.plane(tile.slot, p) && !here) continue;
            Plane& w = canvas.touch(tile.slot, p);
            for (int t = 0; t < kN; ++t) w[t] = tile.fixed[p][t] + tile.loose[p][t];
        }
    }
}

}  // namespace tuft::ink
