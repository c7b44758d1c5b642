#include "ink/film.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "ink/drying.h"
#include "ink/film_tile.h"

namespace tuft::ink {
namespace {

using namespace wet;

constexpr double kLongestStep = 0.25;  // seconds: between flow, soaking and drying
// What may leave a texel in one step, of what it has: less than all of it together.
constexpr double kFlowPart = 0.5, kMixingPart = 0.2, kWeightPart = 0.25;
constexpr double kSeamPart = 4;        // conductances over seams together, over the texel's area
constexpr double kRimLength = 1e-3;    // metres: what the rim of a wet spot adds to its area, as for drying

using PlanePtr = std::unique_ptr<Plane>;

/// A tile in the list of a step.
struct Active {
    std::uint32_t slot = kNone;
    std::array<std::uint32_t, 9> around{};  ///< slots, row by row, this one in the middle
    std::span<const atlas::SeamLink> links;
    Outcome outcome;
    bool seam_wet = false;
    bool idle = false;                      ///< nothing wet in sight
    PlanePtr w, s;                          ///< of the step's end; between steps: spare
    std::array<PlanePtr, kMaxPigments> p;
    std::uint32_t pigments = 0;             ///< bits: those computed
    std::array<std::uint8_t, kTexels> closing{};

    bool wet() const { return outcome.most_w + outcome.most_s > 0; }
};

/// Copies a plane with a border of one texel from the tiles around; absent planes are zeros.
template <class PlaneOf>
bool load(Field& field, const std::array<std::uint32_t, 9>& around, PlaneOf&& plane_of) {
    std::array<const Plane*, 9> planes;
    bool any = false;
    for (int i = 0; i < 9; ++i) {
        planes[i] = around[i] == kNone ? nullptr : plane_of(around[i]);
        any |= planes[i] != nullptr;
    }
    if (!any) return false;
    const auto row_from = [&](int field_row, int tiles, int row) {
        float* to = &field[field_row * kRow];
        const Plane *left = planes[tiles], *here = planes[tiles + 1], *right = planes[tiles + 2];
        to[0] = left ? (*left)[row * kSide + kSide - 1] : 0;
        if (here) std::copy_n(&(*here)[row * kSide], kSide, to + 1);
        else std::fill_n(to + 1, kSide, 0.0f);
        to[kSide + 1] = right ? (*right)[row * kSide] : 0;
    };
    row_from(0, 0, kSide - 1);
    for (int row = 0; row < kSide; ++row) row_from(row + 1, 3, row);
    row_from(kSide + 1, 6, 0);
    return true;
}

float at(const Plane* plane, int t) { return plane ? (*plane)[t] : 0; }

void put_new(PlanePtr& to, const Plane* from) {
    if (!to) to = std::make_unique<Plane>();
    if (from) *to = *from;
    else to->fill(0);
}

bool all_zero(const Plane& plane) {
    return std::all_of(plane.begin(), plane.end(), [](float v) { return v == 0.0f; });
}

}  // namespace

FilmParams film_params(const Substrate& substrate, const Vec3& down) {
    FilmParams p;
    p.mobility = static_cast<double>(substrate.diffusion);
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
    std::vector<std::unique_ptr<Slopes>> slopes;
    std::vector<std::uint8_t> mark;  ///< [n_slots] scratch
    Vec3 down{0};
    std::vector<Active> list;
    std::vector<std::uint8_t> told;

    State(const atlas::TexelMap& m, atlas::SeamLinks s)
        : map(m), seams(std::move(s)), geometry(m.n_slots()), slopes(m.n_slots()), mark(m.n_slots(), 0) {
        limit_links();
    }

    /// Scales links so that what goes over seams stays within what a step allows a texel.
    void limit_links() {
        const double mean = map.texel_size * map.texel_size;
        std::vector<float> scale(seams.links.size());
        std::vector<std::array<float, kTexels>> of_slot;  // only of slots with links
        std::vector<std::uint32_t> place(map.n_slots(), kNone);
        for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
            if (seams.start[slot] == seams.start[slot + 1]) continue;
            place[slot] = static_cast<std::uint32_t>(of_slot.size());
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
                l.weight *= std::min(of_slot[place[slot]][l.texel], of_slot[place[l.other_slot]][l.other_texel]);
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
        list.clear();
        for (const std::uint32_t slot : canvas.wet_slots()) {
            Active tile;
            tile.slot = slot;
            tile.outcome.sides = 15;
            tile.seam_wet = true;
            const Plane *w = canvas.liquid(slot, Liquid::film), *s = canvas.liquid(slot, Liquid::pores);
            for (int t = 0; t < kTexels; ++t) {
                tile.outcome.most_w = std::max(tile.outcome.most_w, at(w, t));
                tile.outcome.most_s = std::max(tile.outcome.most_s, at(s, t));
            }
            list.push_back(std::move(tile));
        }
        spread(canvas);
    }

    /// The list becomes the wet tiles and those that liquid may reach in the next step.
    void spread(const Canvas& canvas) {
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
            next[i].around = around(wanted[i]);
            next[i].links = links_of(wanted[i]);
            mark[wanted[i]] = 0;
        }
        list = std::move(next);
        (void)canvas;
    }

    void prepare(const Vec3& towards) {
        if (towards != down) {
            for (auto& s : slopes) s.reset();
            down = towards;
        }
        const bool heavy = glm::length(down) > 0;
        parallel_for(list.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t slot = list[i].slot;
                if (!geometry[slot]) geometry[slot] = std::make_unique<Geometry>(make_geometry(map, slot));
                if (heavy && !slopes[slot])
                    slopes[slot] = std::make_unique<Slopes>(make_slopes(map, slot, *geometry[slot], down));
            }
        });
    }

    /// The longest stable step, seconds, and its rates.
    double choose(const FilmParams& p, double left, Step& step) const {
        const double area = map.texel_size * map.texel_size;
        double stiffness = kSeamPart, most_w = 0, most_s = 0, steepest = 0, smallest = 1;
        for (const Active& tile : list) {
            const Geometry& g = *geometry[tile.slot];
            stiffness = std::max(stiffness, static_cast<double>(g.stiffness) + (tile.links.empty() ? 0 : kSeamPart / 2));
            smallest = std::min(smallest, static_cast<double>(g.smallest));
            most_w = std::max(most_w, static_cast<double>(tile.outcome.most_w));
            most_s = std::max(most_s, static_cast<double>(tile.outcome.most_s));
            if (slopes[tile.slot]) steepest = std::max(steepest, static_cast<double>(slopes[tile.slot]->steepest));
        }
        const double run = kWeightPart / 2 * smallest;
        double dt = kLongestStep;
        const double flow = p.mobility / area * stiffness * std::max(most_w - p.threshold, p.pores > 0 ? most_s : 0.0);
        if (flow > 0) dt = std::min(dt, kFlowPart / flow);
        const double mixing = p.mixing / area * stiffness;
        if (mixing > 0) dt = std::min(dt, kMixingPart / mixing);
        const double free = std::max(0.0, most_w - p.hold);
        const double speed = p.weight / map.texel_size * free * free * steepest;
        if (speed > 0) dt = std::min(dt, run / speed);
        dt = std::max(dt, p.shortest_step);
        dt = left / std::ceil(left / dt * (1 - 1e-12));
        step.flow = static_cast<float>(p.mobility * dt / area);
        step.limit = static_cast<float>(kFlowPart / stiffness);
        step.threshold = static_cast<float>(p.threshold);
        step.pin = static_cast<float>(p.pin);
        step.mixing = static_cast<float>(std::min(p.mixing * dt / area, kMixingPart / stiffness));
        step.soak = static_cast<float>(-std::expm1(-p.absorbency * dt));
        step.pores = static_cast<float>(p.pores);
        step.evaporation = static_cast<float>(p.evaporation * dt);
        step.rim = static_cast<float>(p.rim_evaporation * dt / map.texel_size);
        step.hold = static_cast<float>(p.hold);
        step.weight = static_cast<float>(p.weight * dt / map.texel_size);
        step.run = static_cast<float>(run);
        return dt;
    }

    /// Fluxes over the seams of a tile: added to dw, ds; what pigments need is kept.
    struct Carried {
        std::uint8_t texel, other_texel;
        std::uint32_t other_slot;
        float out, in;  ///< dp = −out c(texel) + in c(other)
        float other_total;
    };
    void seam_fluxes(const Canvas& canvas, Active& tile, const Step& step, Work& work,
                     std::vector<Carried>& carried) const {
        const Plane *w = canvas.liquid(tile.slot, Liquid::film), *s = canvas.liquid(tile.slot, Liquid::pores);
        const Geometry& g = *geometry[tile.slot];
        carried.clear();
        std::uint32_t other = kNone;
        const Plane *ow = nullptr, *os = nullptr;
        for (const atlas::SeamLink& l : tile.links) {
            if (l.other_slot != other) {
                other = l.other_slot;
                ow = canvas.liquid(other, Liquid::film);
                os = canvas.liquid(other, Liquid::pores);
            }
            const std::array<float, 2> here{at(w, l.texel), at(s, l.texel)}, there{at(ow, l.other_texel), at(os, l.other_texel)};
            const float t = here[0] + here[1], u = there[0] + there[1];
            if (!(t + u > 0)) continue;
            if (!(u > 0)) work.dry_neighbours[l.texel] += l.weight;
            // One order for both sides, so that both have the same numbers.
            const bool first = tile.slot != other ? tile.slot < other : l.texel < l.other_texel;
            const float g0 = g.grain[field_of(l.texel)], g1 = geometry[other]->grain[field_of(l.other_texel)];
            const Vec3 p0(map.position(tile.slot, l.texel)), p1(map.position(other, l.other_texel));
            const auto slope = [&](const Vec3& from, const Vec3& to) {
                if (!slopes[tile.slot]) return 0.0f;
                return l.weight * static_cast<float>(glm::dot(down, to - from) / map.texel_size);
            };
            const SeamFlux f = first ? seam_flux(l.weight, slope(p0, p1), {here[0], there[0]}, {here[1], there[1]}, {g0, g1}, step)
                                     : seam_flux(l.weight, slope(p1, p0), {there[0], here[0]}, {there[1], here[1]}, {g1, g0}, step);
            const float sign = first ? -1.0f : 1.0f, inverse = g.inverse[l.texel];
            work.dw[l.texel] += sign * f.w * inverse;
            work.ds[l.texel] += sign * f.s * inverse;
            carried.push_back({l.texel, l.other_texel, other, first ? f.a : -f.b, first ? -f.b : f.a, u});
        }
    }

    void compute(const Canvas& canvas, Active& tile, const Step& step, std::uint64_t number, Work& work,
                 std::vector<Carried>& carried) const {
        const Geometry& g = *geometry[tile.slot];
        const auto liquid = [&](Liquid where) { return [&canvas, where](std::uint32_t slot) { return canvas.liquid(slot, where); }; };
        const bool any_w = load(work.w, tile.around, liquid(Liquid::film));
        if (!any_w) work.w.fill(0);
        const bool any_s = load(work.s, tile.around, liquid(Liquid::pores));
        if (!any_s) work.s.fill(0);
        fluxes(work, g, slopes[tile.slot] ? slopes[tile.slot].get() : nullptr, step);
        liquid_changes(work, g);
        seam_fluxes(canvas, tile, step, work, carried);
        // From what is there and nothing else: the same whenever this journal is painted.
        const std::uint64_t seed =
            hash_bits(hash_bits(tile.slot, number),
                      std::bit_cast<std::uint32_t>(tile.outcome.most_w + tile.outcome.most_s));
        tile.outcome = {};
        tile.pigments = 0;
        tile.idle = !any_w && !any_s && carried.empty();
        if (tile.idle) return;
        put_new(tile.w, canvas.liquid(tile.slot, Liquid::film));
        put_new(tile.s, canvas.liquid(tile.slot, Liquid::pores));
        tile.outcome = local_step(tile.w->data(), tile.s->data(), work, g, step, seed, tile.closing.data());
        tile.seam_wet = false;
        for (const atlas::SeamLink& l : tile.links)
            tile.seam_wet = tile.seam_wet || (*tile.w)[l.texel] + (*tile.s)[l.texel] > 0;
        alignas(64) Field field{};
        for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p) {
            bool any = load(field, tile.around, [&](std::uint32_t slot) { return canvas.plane(slot, p); });
            if (!any) field.fill(0);
            for (const Carried& c : carried) any = any || canvas.plane(c.other_slot, p);
            if (!any) continue;
            concentrations(work, field);
            pigment_changes(work, g);
            for (const Carried& c : carried) {
                const float there = c.other_total > 0 ? at(canvas.plane(c.other_slot, p), c.other_texel) / c.other_total : 0;
                work.dp[c.texel] += (c.in * there - c.out * work.c[field_of(c.texel)]) * g.inverse[c.texel];
            }
            put_new(tile.p[p], canvas.plane(tile.slot, p));
            add_pigment(tile.p[p]->data(), work, seed + 1 + static_cast<std::uint64_t>(p));
            tile.pigments |= 1u << p;
        }
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
        if (tile.outcome.closing) close_films(canvas, tile.slot, tile.closing, stain);
    }

    void step(Canvas& canvas, const FilmParams& params, const Step& rates, FilmReport& report) {
        parallel_for(list.size(), 4, [&](std::size_t begin, std::size_t end) {
            const auto work = std::make_unique<Work>();
            std::vector<Carried> carried;
            for (std::size_t i = begin; i < end; ++i) compute(canvas, list[i], rates, report.steps, *work, carried);
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
    for (double left = seconds; left > 0 && !s.list.empty();) {
        s.prepare(params.down);
        if (before)
            for (const Active& tile : s.list)
                if (!s.told[tile.slot]) {
                    s.told[tile.slot] = 1;
                    before(tile.slot);
                }
        Step step;
        const double dt = s.choose(params, left, step);
        s.step(canvas, params, step, report);
        left = dt < left * (1 - 1e-9) ? left - dt : 0;
        s.spread(canvas);
    }
    s.list.clear();
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
