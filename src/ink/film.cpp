#include "ink/film.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "ink/drips.h"
#include "ink/drying.h"
#include "ink/film_tile.h"

namespace tuft::ink {
namespace {

using namespace wet;

constexpr double kLongestStep = 0.25;  // seconds: between flow, soaking and drying
// What may leave a texel in one step, of what it has: less than all of it together.
constexpr double kFlowPart = 0.5, kMixingPart = 0.2;
constexpr double kBeadStep = 0.05;     // seconds: a bead goes a texel or a few
constexpr std::size_t kMostBeads = 256;
constexpr double kSeamPart = 4;        // conductances over seams together, over the texel's area
constexpr double kLeastMixing = 2e-10; // m²/s
constexpr double kStirring = 0.02;     // film units: mixing over mobility
constexpr double kRimLength = 1e-3;    // metres: what the rim of a wet spot adds to its area, as for drying

using PlanePtr = std::unique_ptr<Plane>;

/// A tile in the list of a step.
struct Active {
    std::uint32_t slot = kNone;
    std::array<std::uint32_t, 9> around{};  ///< places in the list, row by row, this one in the middle
    std::array<const Plane*, 2> liquid{};   ///< as the step finds them
    std::array<const Plane*, kMaxPigments> open{};
    std::span<const atlas::SeamLink> links;
    Outcome outcome;
    bool seam_wet = false;
    bool spreads = true;                    ///< wet in other places than before the step
    bool idle = false;                      ///< nothing wet in sight
    PlanePtr w, s;                          ///< of the step's end; between steps: spare
    std::array<PlanePtr, kMaxPigments> p;
    std::uint32_t pigments = 0;             ///< bits: those computed
    std::unique_ptr<std::array<std::uint8_t, kTexels>> closing;  ///< where outcome.closing

    bool wet() const { return outcome.most_w + outcome.most_s > 0; }
};

/// Copies a plane with a border of one texel from the tiles around; absent planes are zeros, and
/// so are tiles that are not in the list: nothing there can move.
template <class PlaneOf>
bool load(Field& field, const std::vector<Active>& list, const std::array<std::uint32_t, 9>& around,
          PlaneOf&& plane_of) {
    static constexpr Plane kDry{};
    std::array<const float*, 9> planes;
    bool any = false;
    for (int i = 0; i < 9; ++i) {
        const Plane* plane = around[i] == kNone ? nullptr : plane_of(list[around[i]]);
        any |= plane != nullptr;
        planes[i] = (plane ? plane : &kDry)->data();
    }
    if (any) gather(field, planes);
    return any;
}

float at(const Plane* plane, int t) { return plane ? (*plane)[t] : 0; }

bool all_zero(const Plane& plane) {
    return std::all_of(plane.begin(), plane.end(), [](float v) { return v == 0.0f; });
}

}  // namespace

FilmParams film_params(const Substrate& substrate, const Vec3& down) {
    FilmParams p;
    p.mobility = static_cast<double>(substrate.diffusion);
    // Wet in wet, surface tension stirs more than molecules move: as wide as water itself spreads.
    p.mixing = std::max(kLeastMixing, kStirring * p.mobility);
    p.threshold = static_cast<double>(substrate.threshold);
    p.pin = 2 * static_cast<double>(substrate.edge);
    p.absorbency = static_cast<double>(substrate.absorbency);
    p.pores = static_cast<double>(substrate.pores);
    p.evaporation = static_cast<double>(substrate.evaporation);
    p.rim_evaporation = p.evaporation * static_cast<double>(substrate.edge) * kRimLength;
    p.stain = p.pores / (p.pores + 2);
    if (glm::length(down) > 0) p.down = glm::normalize(down);
    return p;
}

struct WetFilm::State {
    const atlas::TexelMap& map;
    atlas::SeamLinks seams;
    std::vector<std::unique_ptr<Geometry>> geometry;
    std::vector<std::uint8_t> mark;  ///< [n_slots] scratch
    std::vector<std::uint32_t> place;  ///< [n_slots] scratch
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> others;  ///< of the list: slots over
                                                                             ///< seams, places in the list
    std::vector<Active> list;
    std::vector<std::uint8_t> told;
    std::unique_ptr<Drips> drips;
    std::vector<PlanePtr> spare;  ///< planes for tiles to come: making them costs as much as a step

    State(const atlas::TexelMap& m, atlas::SeamLinks s)
        : map(m), seams(std::move(s)), geometry(m.n_slots()), mark(m.n_slots(), 0), place(m.n_slots(), kNone) {
        limit_links();
    }

    /// Scales links so that what goes over seams stays within what a step allows a texel.
    void limit_links() {
        const double mean = map.texel_size * map.texel_size;
        std::vector<float> scale(seams.links.size());
        std::vector<std::array<float, kTexels>> of_slot;  // only of slots with links
        std::vector<std::uint32_t> index(map.n_slots(), kNone);
        for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
            if (seams.start[slot] == seams.start[slot + 1]) continue;
            index[slot] = static_cast<std::uint32_t>(of_slot.size());
            std::array<float, kTexels>& sums = of_slot.emplace_back();
            sums.fill(0);
            for (const atlas::SeamLink& l : links_of(slot)) sums[l.texel] += l.weight;
            for (int t = 0; t < kTexels; ++t) {
                const double most = kSeamPart * static_cast<double>(map.tiles[slot].area[t]) / mean;
                sums[t] = static_cast<double>(sums[t]) > most ? static_cast<float>(most) / sums[t] : 1;
            }
        }
        for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
            for (std::uint32_t i = seams.start[slot]; i < seams.start[slot + 1]; ++i) {
                atlas::SeamLink& l = seams.links[i];
                l.weight *= std::min(of_slot[index[slot]][l.texel], of_slot[index[l.other_slot]][l.other_texel]);
            }
    }

    std::span<const atlas::SeamLink> links_of(std::uint32_t slot) const {
        return std::span(seams.links).subspan(seams.start[slot], seams.start[slot + 1] - seams.start[slot]);
    }

    std::array<std::uint32_t, 9> around(std::uint32_t slot) const {
        std::array<std::uint32_t, 9> out;
        const auto n = static_cast<std::int64_t>(map.tiles_per_side);
        const std::int64_t tx = map.tile_of_slot[slot] % n, ty = map.tile_of_slot[slot] / n;
        for (int i = 0; i < 9; ++i) {
            const std::int64_t x = tx + i % 3 - 1, y = ty + i / 3 - 1;
            out[i] = x < 0 || y < 0 || x >= n || y >= n
                         ? kNone : map.slot_of_tile[static_cast<std::size_t>(y * n + x)];
        }
        return out;
    }

    void begin(const Canvas& canvas) {
        told.assign(map.n_slots(), 0);
        const std::vector<std::uint32_t> wet = canvas.wet_slots();
        list.clear();
        list.resize(wet.size());
        parallel_for(wet.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                Active& tile = list[i];
                tile.slot = wet[i];
                look_at(canvas, tile);
            }
        });
        spread();
    }

    /// The list becomes the wet tiles and those that liquid may reach in the next step.
    void spread() {
        std::vector<std::uint32_t> wanted;
        const auto want = [&](std::uint32_t slot) {
            if (slot == kNone || mark[slot]) return;
            mark[slot] = 1;
            wanted.push_back(slot);
        };
        for (const Active& tile : list) {
            if (!tile.wet()) continue;
            want(tile.slot);
            const std::array<std::uint32_t, 9> near = around(tile.slot);
            constexpr std::array<std::uint8_t, 9> sides{5, 1, 9, 4, 0, 8, 6, 2, 10};
            for (int i = 0; i < 9; ++i)
                if (i != 4 && (tile.outcome.sides & sides[i]) == sides[i]) want(near[i]);
            if (tile.seam_wet)
                for (const atlas::SeamLink& l : links_of(tile.slot)) want(l.other_slot);
        }
        std::sort(wanted.begin(), wanted.end());
        std::vector<Active> next(wanted.size());
        std::size_t k = 0;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            while (k < list.size() && list[k].slot < wanted[i]) ++k;
            if (k < list.size() && list[k].slot == wanted[i]) next[i] = std::move(list[k]);
            next[i].slot = wanted[i];
            next[i].links = links_of(wanted[i]);
            place[wanted[i]] = static_cast<std::uint32_t>(i);
            mark[wanted[i]] = 0;
        }
        list = std::move(next);
        for (Active& tile : list) {
            tile.around = around(tile.slot);
            for (std::uint32_t& slot : tile.around) slot = slot == kNone ? kNone : place[slot];
        }
        others.assign(list.size(), {});
        for (std::size_t i = 0; i < list.size(); ++i)
            for (const atlas::SeamLink& l : list[i].links)
                if (others[i].empty() || others[i].back().first != l.other_slot)
                    others[i].push_back({l.other_slot, place[l.other_slot]});
        for (const Active& tile : list) place[tile.slot] = kNone;
    }

    /// Gives the tiles planes for the results of a step, those of the same places as far as there are any.
    void equip(const Canvas& canvas) {
        const int pigments = static_cast<int>(canvas.pigments().size());
        const auto give = [&](PlanePtr& plane) {
            if (plane) return;
            if (spare.empty()) {
                plane = std::make_unique<Plane>();
            } else {
                plane = std::move(spare.back());
                spare.pop_back();
            }
        };
        for (Active& tile : list) {
            give(tile.w);
            give(tile.s);
            for (int p = 0; p < pigments; ++p) give(tile.p[p]);
        }
    }

    void keep_spare(const Canvas& canvas) {
        const auto take = [&](PlanePtr& plane) {
            if (plane) spare.push_back(std::move(plane));
        };
        for (std::size_t i = list.size(); i-- > 0;) {
            for (int p = kMaxPigments; p-- > 0;) take(list[i].p[p]);
            take(list[i].s);
            take(list[i].w);
        }
        list.clear();
        if (!canvas.wet()) spare.clear();
    }

    void tell(std::uint32_t slot, const BeforeFn& before) {
        if (!before || told[slot]) return;
        told[slot] = 1;
        before(slot);
    }

    static void look_at(const Canvas& canvas, Active& tile) {
        tile.outcome.sides = 15;
        tile.seam_wet = true;
        const Plane *w = canvas.liquid(tile.slot, Liquid::film), *s = canvas.liquid(tile.slot, Liquid::pores);
        tile.outcome.most_w = w ? greatest(w->data()) : 0;
        tile.outcome.most_s = s ? greatest(s->data()) : 0;
    }

    /// Where beads may start: of each cube of a grain's length the place that gives way first, the
    /// lowest first, so that it does not matter how the surface lies in the atlas.
    std::vector<Drips::Seed> seeds_of_beads(const Canvas& canvas, const FilmParams& params) const {
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
                if (w[t] < least) continue;
                const Vec3 at(map.position(tile.slot, t));
                const auto cell = [](double x) { return static_cast<std::int32_t>(std::floor(x / kGrainLength)); };
                const std::array cube{cell(at.x), cell(at.y), cell(at.z)};
                const float grain = geometry[tile.slot]->grain[field_of(t)];
                auto same = std::find_if(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
                                         [&](const Found& f) { return f.cube == cube; });
                if (same == found.end()) same = found.insert(found.end(), Found{cube, 0, 0, {}});
                if (w[t] > same->weak * grain)
                    *same = {cube, w[t] / grain, static_cast<float>(-glm::dot(params.down, at)),
                             {{tile.slot, static_cast<std::uint8_t>(t)}, static_cast<double>(grain)}};
            }
        }
        std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
            return a.cube != b.cube ? a.cube < b.cube : a.weak > b.weak;
        });
        found.erase(std::unique(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.cube == b.cube; }),
                    found.end());
        std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.height < b.height; });
        std::vector<Drips::Seed> seeds;
        for (std::size_t i = 0; i < std::min(found.size(), kMostBeads); ++i) seeds.push_back(found[i].seed);
        return seeds;
    }

    /// Beads run for the time of a step. Whether any did.
    bool run_beads(Canvas& canvas, const FilmParams& params, double dt, const BeforeFn& before) {
        if (!(glm::length(params.down) > 0)) return false;
        const std::vector<Drips::Seed> seeds = seeds_of_beads(canvas, params);
        if (seeds.empty()) return false;
        if (!drips) drips = std::make_unique<Drips>(map, seams);
        const std::vector<std::uint32_t> written =
            drips->run(canvas, seeds, params, dt, [&](std::uint32_t slot) { tell(slot, before); });
        if (written.empty()) return false;
        const std::size_t listed = list.size();
        for (const std::uint32_t slot : written) {
            const auto at = std::lower_bound(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(listed), slot,
                                             [](const Active& a, std::uint32_t s) { return a.slot < s; });
            const bool known = at != list.begin() + static_cast<std::ptrdiff_t>(listed) && at->slot == slot;
            if (!known) {
                list.emplace_back();
                list.back().slot = slot;
            }
            look_at(canvas, known ? *at : list.back());
        }
        std::sort(list.begin(), list.end(), [](const Active& a, const Active& b) { return a.slot < b.slot; });
        spread();
        return true;
    }

    /// Whether other tiles may be reached after this step than before it.
    bool changed() const {
        return std::any_of(list.begin(), list.end(), [](const Active& tile) { return tile.spreads; });
    }

    void prepare() {
        parallel_for(list.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (auto& g = geometry[list[i].slot]; !g) g = std::make_unique<Geometry>(make_geometry(map, list[i].slot));
        });
    }

    /// The longest stable step, seconds, and its rates.
    double choose(const FilmParams& p, double left, bool beads, Step& step) const {
        const double area = map.texel_size * map.texel_size;
        const double levelling = glm::length(p.down) > 0 ? 0 : p.levelling;
        double stiffness = kSeamPart, most_w = 0, most_s = 0;
        for (const Active& tile : list) {
            const Geometry& g = *geometry[tile.slot];
            stiffness = std::max(stiffness, static_cast<double>(g.stiffness) + (tile.links.empty() ? 0 : kSeamPart / 2));
            most_w = std::max(most_w, static_cast<double>(tile.outcome.most_w));
            most_s = std::max(most_s, static_cast<double>(tile.outcome.most_s));
        }
        double dt = beads ? kBeadStep : kLongestStep;
        const double free = std::max(0.0, most_w - p.hold);
        const double flow = stiffness / area *
                            std::max(p.mobility * (most_w - p.threshold) + levelling * free,
                                     p.pores > 0 ? p.mobility * most_s : 0.0);
        if (flow > 0) dt = std::min(dt, kFlowPart / flow);
        const double mixing = p.mixing / area * stiffness;
        if (mixing > 0) dt = std::min(dt, kMixingPart / mixing);
        dt = std::max(dt, p.shortest_step);
        dt = left / std::ceil(left / dt * (1 - 1e-12));
        step.flow = static_cast<float>(p.mobility * dt / area);
        step.levelling = static_cast<float>(levelling * dt / area);
        step.limit = static_cast<float>(kFlowPart / stiffness);
        step.threshold = static_cast<float>(p.threshold);
        step.pin = static_cast<float>(p.pin);
        step.mixing = static_cast<float>(std::min(p.mixing * dt / area, kMixingPart / stiffness));
        step.grip = static_cast<float>(p.grip);
        step.soak = static_cast<float>(-std::expm1(-p.absorbency * dt));
        step.pores = static_cast<float>(p.pores);
        step.evaporation = static_cast<float>(p.evaporation * dt);
        step.rim = static_cast<float>(p.rim_evaporation * dt / map.texel_size);
        step.hold = static_cast<float>(p.hold);
        return dt;
    }

    /// Fluxes over the seams of a tile: added to dw, ds; what pigments need is kept.
    struct Carried {
        std::uint8_t texel, other_texel;
        const Active* other;
        float out, in;  ///< dp = −out p(texel) + in p(other)
    };
    void seam_fluxes(std::size_t index, const Step& step, Work& work, std::vector<Carried>& carried) const {
        const Active& tile = list[index];
        const Geometry& g = *geometry[tile.slot];
        carried.clear();
        std::array<float, kTexels> dry;
        if (!tile.links.empty()) dry.fill(0);
        const Active* other = nullptr;
        for (const atlas::SeamLink& l : tile.links) {
            if (!other || other->slot != l.other_slot) {
                const auto found = std::find_if(others[index].begin(), others[index].end(),
                                                [&](const auto& o) { return o.first == l.other_slot; });
                other = found->second == kNone ? nullptr : &list[found->second];
            }
            const std::array<float, 2> here{at(tile.liquid[0], l.texel), at(tile.liquid[1], l.texel)};
            const std::array<float, 2> there{other ? at(other->liquid[0], l.other_texel) : 0,
                                             other ? at(other->liquid[1], l.other_texel) : 0};
            const float t = here[0] + here[1], u = there[0] + there[1];
            if (!(t + u > 0) || !other) continue;
            if (!(u > 0)) dry[l.texel] += l.weight;
            // One order for both sides, so that both have the same numbers.
            const bool first = tile.slot != l.other_slot ? tile.slot < l.other_slot : l.texel < l.other_texel;
            const float g0 = g.grain[field_of(l.texel)], g1 = geometry[l.other_slot]->grain[field_of(l.other_texel)];
            const SeamFlux f = first ? seam_flux(l.weight, {here[0], there[0]}, {here[1], there[1]}, {g0, g1}, step)
                                     : seam_flux(l.weight, {there[0], here[0]}, {there[1], here[1]}, {g1, g0}, step);
            const float sign = first ? -1.0f : 1.0f, inverse = g.inverse[l.texel];
            work.dw[l.texel] += sign * f.w * inverse;
            work.ds[l.texel] += sign * f.s * inverse;
            carried.push_back({l.texel, l.other_texel, other, first ? f.a : -f.b, first ? -f.b : f.a});
        }
        for (std::size_t i = 0; i < tile.links.size(); ++i) {
            const std::uint8_t t = tile.links[i].texel;
            if (i > 0 && tile.links[i - 1].texel == t) continue;
            if (dry[t] > 0) work.dry_neighbours[t] = std::sqrt(work.dry_neighbours[t] * work.dry_neighbours[t] + dry[t] * dry[t]);
        }
    }

    void compute(std::size_t index, int pigments, const Step& step, std::uint64_t number, Work& work,
                 std::vector<Carried>& carried) {
        Active& tile = list[index];
        const Geometry& g = *geometry[tile.slot];
        const bool any_w = load(work.w, list, tile.around, [](const Active& a) { return a.liquid[0]; });
        if (!any_w) work.w.fill(0);
        const bool any_s = load(work.s, list, tile.around, [](const Active& a) { return a.liquid[1]; });
        if (!any_s) work.s.fill(0);
        fluxes(work, g, step);
        liquid_changes(work, g, step);
        seam_fluxes(index, step, work, carried);
        // From what is there and nothing else: the same whenever this journal is painted.
        const std::uint64_t seed =
            hash_bits(hash_bits(tile.slot, number),
                      std::bit_cast<std::uint32_t>(tile.outcome.most_w + tile.outcome.most_s));
        const Outcome before = tile.outcome;
        const bool seam_was = tile.seam_wet;
        tile.outcome = {};
        tile.pigments = 0;
        tile.idle = !any_w && !any_s && carried.empty();
        if (tile.idle) return;
        std::array<std::uint8_t, kTexels> closing;
        tile.outcome = local_step(tile.w->data(), tile.s->data(), work, g, step, seed, closing);
        if (tile.outcome.closing) {
            if (!tile.closing) tile.closing = std::make_unique<std::array<std::uint8_t, kTexels>>();
            *tile.closing = closing;
        }
        tile.seam_wet = false;
        for (const atlas::SeamLink& l : tile.links)
            tile.seam_wet = tile.seam_wet || (*tile.w)[l.texel] + (*tile.s)[l.texel] > 0;
        tile.spreads = before.sides != tile.outcome.sides || seam_was != tile.seam_wet ||
                       (before.most_w + before.most_s > 0) != tile.wet();
        for (int p = 0; p < pigments; ++p) {
            bool any = load(work.p, list, tile.around, [p](const Active& a) { return a.open[p]; });
            if (!any) work.p.fill(0);
            for (const Carried& c : carried) any = any || c.other->open[p];
            if (!any) continue;
            if (!carried.empty()) work.dp.fill(0);
            for (const Carried& c : carried) {
                const int k = field_of(c.texel);
                const float there = at(c.other->open[p], c.other_texel);
                work.dp[c.texel] += (c.in * there - c.out * work.p[k]) * g.inverse[c.texel];
            }
            pigment_step(tile.p[p]->data(), work, g, !carried.empty(), seed + 1 + static_cast<std::uint64_t>(p));
            tile.pigments |= 1u << p;
        }
    }

    /// Planes lie here and there: without a word beforehand the processor waits for each.
    void fetch(const Active& tile) const {
        const auto all_of = [](const void* from, std::size_t bytes) {
            for (std::size_t i = 0; from && i < bytes; i += 64) __builtin_prefetch(static_cast<const char*>(from) + i);
        };
        for (const Plane* plane : tile.liquid) all_of(plane, sizeof(Plane));
        for (const Plane* plane : tile.open) all_of(plane, sizeof(Plane));
        all_of(geometry[tile.slot].get(), sizeof(Geometry));
        for (const PlanePtr* plane : {&tile.w, &tile.s}) all_of(plane->get(), sizeof(Plane));
        for (const PlanePtr& plane : tile.p) all_of(plane.get(), sizeof(Plane));
    }

    void find_planes(const Canvas& canvas, Active& tile) const {
        tile.liquid = {canvas.liquid(tile.slot, Liquid::film), canvas.liquid(tile.slot, Liquid::pores)};
        for (int p = 0; p < kMaxPigments; ++p) tile.open[p] = canvas.plane(tile.slot, p);
    }

    static void commit(Canvas& canvas, Active& tile, float stain) {
        if (tile.idle) return;
        const auto put_liquid = [&](Liquid where, PlanePtr& plane, float most) {
            if (most > 0) {
                canvas.swap_liquid(tile.slot, where, plane);
            } else if (canvas.liquid(tile.slot, where)) {
                PlanePtr none;
                canvas.swap_liquid(tile.slot, where, none);
            }
        };
        put_liquid(Liquid::film, tile.w, tile.outcome.most_w);
        put_liquid(Liquid::pores, tile.s, tile.outcome.most_s);
        for (int p = 0; p < kMaxPigments; ++p)
            if (tile.pigments >> p & 1 && (canvas.plane(tile.slot, p) || !all_zero(*tile.p[p])))
                canvas.swap_open(tile.slot, p, tile.p[p]);
        if (tile.outcome.closing) close_films(canvas, tile.slot, *tile.closing, stain);
    }

    void step(Canvas& canvas, const FilmParams& params, const Step& rates, FilmReport& report) {
        parallel_for(list.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) find_planes(canvas, list[i]);
        });
        const int pigments = static_cast<int>(canvas.pigments().size());
        parallel_for(list.size(), 4, [&](std::size_t begin, std::size_t end) {
            const auto work = std::make_unique<Work>();
            std::vector<Carried> carried;
            for (std::size_t i = begin; i < end; ++i) {
                if (i + 2 < end) fetch(list[i + 2]);
                compute(i, pigments, rates, report.steps, *work, carried);
            }
        });
        parallel_for(list.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) commit(canvas, list[i], static_cast<float>(params.stain));
        });
        const double area = map.texel_size * map.texel_size;
        for (const Active& tile : list) report.evaporated += tile.outcome.evaporated * area;
        ++report.steps;
        report.tile_steps += list.size();
    }
};

WetFilm::WetFilm(const atlas::TexelMap& map, atlas::SeamLinks seams)
    : state_(std::make_unique<State>(map, std::move(seams))) {}
WetFilm::~WetFilm() = default;
WetFilm::WetFilm(WetFilm&&) noexcept = default;

FilmReport WetFilm::advance(Canvas& canvas, double seconds, const FilmParams& params, const BeforeFn& before) {
    FilmReport report;
    if (!canvas.wet() || !(seconds > 0)) return report;
    State& s = *state_;
    s.begin(canvas);
    double beads = 0;  // seconds that they have not run yet
    bool running = glm::length(params.down) > 0;
    for (double left = seconds; left > 0 && !s.list.empty();) {
        s.prepare();
        s.equip(canvas);
        for (const Active& tile : s.list) s.tell(tile.slot, before);
        Step step;
        const double dt = s.choose(params, left, running, step);
        s.step(canvas, params, step, report);
        left = dt < left * (1 - 1e-9) ? left - dt : 0;
        if (s.changed()) s.spread();
        beads += dt;
        if (beads > 0.9 * kBeadStep || left == 0) {
            running = s.run_beads(canvas, params, beads, before);
            beads = 0;
        }
    }
    s.keep_spare(canvas);
    return report;
}

FilmReport WetFilm::dry(Canvas& canvas, const FilmParams& params, const BeforeFn& before, double limit) {
    FilmReport report;
    constexpr double kAtOnce = 60;
    for (double left = limit; left > 0 && canvas.wet(); left -= kAtOnce) {
        const FilmReport part = advance(canvas, std::min(left, kAtOnce), params, before);
        report.steps += part.steps;
        report.tile_steps += part.tile_steps;
        report.evaporated += part.evaporated;
    }
    if (before)
        for (const std::uint32_t slot : canvas.touched_slots())
            if (canvas.has_film(slot, kOpenFilm) || canvas.liquid(slot, Liquid::film) || canvas.liquid(slot, Liquid::pores))
                before(slot);
    report.evaporated += dry_all(canvas, state_->map);
    return report;
}

}  // namespace tuft::ink
