#include "ink/film/film.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <mutex>

#include "core/random.h"
#include "core/system/parallel.h"
#include "ink/film/film_list.h"
#include "ink/film/film_seams.h"
#include "ink/film/film_step.h"
#include "ink/film/film_worker.h"
#include "ink/film/seepage.h"
#include "ink/film/sheet_flow.h"
#include "ink/film/still_air.h"
#include "ink/film/tension.h"
#include "ink/film/tile/paste.h"
#include "ink/texels/drying.h"
#include "ink/texels/pool.h"

namespace tuft::ink {
namespace {

using namespace wet;

constexpr int kLines = 20;  // of memory asked for at once: as many as the processor waits for
constexpr float kFilmsPerMicrometre = 0.1f;
constexpr double kPartOfWait = 0.025, kLeastOfLongWait = 1.5, kLongWait = 5;
constexpr double kLevelEvery = 0.05;

/// What lies on a tile and on those around it.
using Near = std::array<const Sources*, 9>;

/// Copies a plane with a border of one texel from the tiles around; absent planes are zeros, and
/// so are tiles that are not in the list: nothing there can move.
template <class PlaneOf>
bool load(Field& field, const Near& near, PlaneOf&& plane_of) {
    static constexpr Plane kDry{};
    std::array<const float*, 9> planes;
    bool any = false;
    for (int i = 0; i < 9; ++i) {
        const Plane* plane = plane_of(*near[i]);
        any |= plane != nullptr;
        planes[i] = (plane ? plane : &kDry)->data();
    }
    if (any) gather_field(field, planes);
    return any;
}

/// `step` without what it does of its own: for flow that is computed elsewhere.
Step still(Step step) {
    for (float* rate : {&step.flow, &step.levelling, &step.mixing, &step.relief, &step.drying.evaporation,
                        &step.drying.rim, &step.limit.most})
        *rate = 0;
    return step;
}

bool all_zero(const Plane& plane) {
    return std::all_of(plane.begin(), plane.end(), [](float v) { return v == 0.0f; });
}

}  // namespace

struct WetFilm::State : TileList {
    std::vector<std::uint8_t> reported;
    /// [n_slots] of what is dry, film units: found once in an advance, null where it is plain.
    std::vector<std::unique_ptr<Plane>> relief;
    std::vector<std::unique_ptr<Plane>> paste;  ///< [n_slots] what is paste; null: none
    std::vector<std::uint8_t> relief_known;     ///< [n_slots] 1: the relief was looked for
    bool any_relief = false;
    std::unique_ptr<Drips> drips;
    std::vector<Sources> sources;           ///< of the list; empty: not looked up yet
    Part part = Part::whole;                ///< of the step in work
    std::vector<std::uint32_t> part_order;  ///< of `order` what a step in parts, or by tension, goes through
    Tension tension;
    Seepage seepage;
    StillAir air;
    SheetFlow sheets;
    LevelSteps level_steps;
    bool levels = false, seeps = false;  ///< the step in work is one by tension, one through the pores
    std::mutex mutex;
    std::vector<std::unique_ptr<Worker>> workers;  ///< idle ones

    using TileList::TileList;

    std::unique_ptr<Worker> take_worker() {
        const std::lock_guard lock(mutex);
        if (workers.empty()) return std::make_unique<Worker>();
        auto worker = std::move(workers.back());
        workers.pop_back();
        return worker;
    }
    void give_back(std::unique_ptr<Worker> worker) {
        const std::lock_guard lock(mutex);
        workers.push_back(std::move(worker));
    }

    /// Planes for films to come are kept: making them costs as much as a step.
    void end(const Canvas& canvas) {
        list.clear();
        sources.clear();
        if (canvas.wet()) return;
        workers.clear();
        seepage.release();
        sheets.release();
    }

    void report_slot(std::uint32_t slot, const BeforeFn& before) {
        if (!before || reported[slot]) return;
        reported[slot] = 1;
        before(slot);
    }

    /// Sheets and beads run for the time of a step. Whether any did.
    bool run_down(Canvas& canvas, const FilmParams& params, double dt, const BeforeFn& before) {
        if (!(glm::length(params.weight.down) > 0)) return false;
        const std::vector<std::uint32_t> written =
            sheets.run(canvas, *this, dt, [&](std::uint32_t slot) { report_slot(slot, before); });
        if (!written.empty()) search_tile(canvas, written), sources.clear();
        return run_beads(canvas, params, dt, before) || sheets.fast();
    }
    bool run_beads(Canvas& canvas, const FilmParams& params, double dt, const BeforeFn& before) {
        const std::vector<Drips::Seed> seeds =
            seeds_of_beads(canvas, params, [&](std::uint32_t slot, int t) { return sheets.runs_at(slot, t); });
        if (seeds.empty()) return false;
        if (!drips) drips = std::make_unique<Drips>(map, seams, medium().free);
        const std::vector<std::uint32_t> written =
            drips->run(canvas, seeds, params, dt, [&](std::uint32_t slot) { report_slot(slot, before); });
        if (written.empty()) return false;
        search_tile(canvas, written);
        return true;
    }

    void forget_relief() {
        if (any_relief) relief.clear();
        relief.resize(map.n_slots());
        paste.clear();
        paste.resize(map.n_slots());
        relief_known.assign(map.n_slots(), 0);
        any_relief = false;
    }

    void feel(const Canvas& canvas, std::uint32_t slot) {
        if (relief_known[slot]) return;
        relief_known[slot] = 1;
        Plane z = dry_relief(canvas, slot);
        const Plane stands = paste_height(canvas, slot);
        paste[slot] = greatest(stands.data()) > 0 ? std::make_unique<Plane>(stands) : nullptr;
        for (int t = 0; t < kTexels && paste[slot]; ++t) z[t] += stands[t];
        float most = 0;
        for (float& v : z)
            most = std::max(most, v = std::max(0.0f, v - static_cast<float>(kPlain)) * kFilmsPerMicrometre);
        relief[slot] = most > 0 ? std::make_unique<Plane>(z) : nullptr;
    }

    /// Paste that liquid has come to in the step lies below it from now on. Whether there was any.
    bool bed_flooded(Canvas& canvas) {
        bool any = false;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::uint32_t slot = list[i].slot;
            if (!paste[slot]) continue;
            std::array<float, kTexels> liquid;
            for (int t = 0; t < kTexels; ++t) liquid[t] = at(sources[i].liquid[0], t) + at(sources[i].liquid[1], t);
            if (!bed_paste(canvas, slot, *paste[slot], liquid, 0)) continue;
            relief_known[slot] = 0;
            any = true;
        }
        return any;
    }

    void prepare(const Canvas& canvas) {
        sources.resize(list.size());
        parallel_for(list.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                auto& g = geometry[list[i].slot];
                if (!g) g = std::make_unique<Geometry>(make_geometry(map, seams, list[i].slot, medium()));
                list[i].faces.stiffness = g->stiffness;
                list[i].faces.geometry = g.get();
                list[i].faces.diagonals = g->gd.get();
                feel(canvas, list[i].slot);
                tension.look_at(map, list[i].slot);
                air.complete(map, list[i].slot);
                find_planes(canvas, i);
            }
        });
        for (const Active& tile : list) any_relief = any_relief || relief[tile.slot];
    }

    /// On relief the liquid's own surface levels, and not its depth.
    TileNeighbours beside(const Active& tile, const Near& near) const {
        const auto blocks = [](const Active& a, const Sources& s) {
            return s.relief ? std::uint16_t{0} : a.faces.geometry->blocks;
        };
        TileNeighbours out{.here = blocks(tile, *near[4])};
        constexpr std::array kSides{3, 5, 1, 7};
        for (std::size_t i = 0; i < 4; ++i) {
            const Sources& from = *near[kSides[i]];
            const Plane* plane = from.liquid[static_cast<std::size_t>(Liquid::film)];
            if (!plane) continue;
            out.liquid[i] = plane->data();
            out.blocks[i] = blocks(list[tile.around[kSides[i]]], from);
        }
        return out;
    }

    void compute(std::size_t index, int pigments, const Step& step, std::uint64_t number, Worker& worker) {
        Active& tile = list[index];
        Work& work = worker.work;
        const Geometry& g = faces_of(tile.slot, part);
        static constexpr Sources kNothing{};
        Near near;
        for (int i = 0; i < 9; ++i) near[i] = tile.around[i] == kNone ? &kNothing : &sources[tile.around[i]];
        const bool any_w = load(work.w, near, [](const Sources& a) { return a.liquid[0]; });
        if (!any_w) work.w.fill(0);
        const bool any_s = load(work.s, near, [](const Sources& a) { return a.liquid[1]; });
        if (!any_s) work.s.fill(0);
        work.on_relief = any_relief && load(work.z, near, [](const Sources& a) { return a.relief; });
        Ahead& ahead = worker.ahead;
        ahead.fetch(kLines);
        if (seeps) {
            seepage.flow(static_cast<std::uint32_t>(index), *this, sources, pigments, work, worker.crossing);
        } else if (levels) {
            tension_flow(work, g, tension.tile(index)->grid, step.grip);
            tension.cross_seams(static_cast<std::uint32_t>(index), sources, pigments, step.grip, work, worker.crossing);
        } else {
            const bool thin = fluxes(work, g, step);
            if (step.limit.most > 0 && any_w) film_block_flow(work, g, beside(tile, near), step);
            if (step.searches) {
                const float held = tension.held_on(tile.slot);
                tile.ripples =
                    any_w && tile.outcome.most_w > held ? find_ripples(work.w, g, held) : Ripples{.rims = true};
            }
            ahead.fetch(2 * kLines);
            cross_seams({*this, sources, part, index}, pigments, step, thin, work, worker.crossing);
        }
        ahead.fetch(kLines);
        // From what is there and nothing else: the same whenever this journal is painted.
        const std::uint64_t seed = hash_bits(hash_bits(tile.slot, number),
                                             std::bit_cast<std::uint32_t>(tile.outcome.most_w + tile.outcome.most_s));
        const Outcome before = tile.outcome;
        const bool seam_was = tile.seams.wet;
        tile.outcome = {};
        tile.pigments = 0;
        // Through the pores liquid goes several texels in a step.
        tile.idle = !seeps && !any_w && !any_s && worker.crossing.size == 0;
        if (tile.idle) return;
        give(tile.w, worker.spare[0]);
        give(tile.s, worker.spare[1]);
        std::array<std::uint8_t, kTexels> closing;
        ahead.fetch(kLines);
        const float* factors = step.drying.evaporation > 0 ? air.of(tile.slot, worker.drying) : nullptr;
        tile.outcome = local_step({tile.w->data(), tile.s->data(), closing, factors}, work, g, step, seed);
        if (tile.outcome.closing) {
            if (!tile.closing) tile.closing = std::make_unique<std::array<std::uint8_t, kTexels>>();
            *tile.closing = closing;
        }
        tile.seams.wet = false;
        for (const atlas::SeamLink& l : tile.seams.links)
            tile.seams.wet = tile.seams.wet || (*tile.w)[l.texel] + (*tile.s)[l.texel] > 0;
        // Until the list is looked at: a step may have parts.
        tile.spreads = tile.spreads || before.sides != tile.outcome.sides || seam_was != tile.seams.wet ||
                       (before.most_w + before.most_s > 0) != tile.wet();
        for (int p = 0; p < pigments; ++p)
            compute_pigment(index, near, p, seed + 1 + static_cast<std::uint64_t>(p), worker);
    }

    void compute_pigment(std::size_t index, const Near& near, int p, std::uint64_t seed, Worker& worker) {
        Active& tile = list[index];
        Work& work = worker.work;
        const Geometry& g = faces_of(tile.slot, part);
        bool any = load(work.p, near, [p](const Sources& a) { return a.open[p]; });
        if (!any) work.p.fill(0);
        const Crossing& crossing = worker.crossing;
        any = any || (crossing.pigments >> p & 1);
        if (!any) return;
        worker.ahead.fetch(kLines);
        const float* beyond = crossing.beyond.data() + static_cast<std::size_t>(p) * crossing.links;
        for (std::size_t i = 0; i < crossing.size; ++i) {
            const SeamLanes& l = crossing.lanes[i / kSide];
            const int texel = crossing.texels[i];
            work.dp[texel] -= l.a[i % kSide] * work.p[field_of(texel)] + l.b[i % kSide] * beyond[i];
        }
        give(tile.p[p], worker.spare[2 + p]);
        pigment_step(tile.p[p]->data(), work, g, crossing.size > 0, seed);
        for (std::size_t i = 0; i < crossing.size; ++i) work.dp[crossing.texels[i]] = 0;
        worker.ahead.fetch(kLines);
        tile.pigments |= 1u << p;
    }

    static void give(PlanePtr& plane, std::vector<PlanePtr>& spare) {
        if (spare.empty()) {
            plane = std::make_unique<Plane>();
        } else {
            plane = std::move(spare.back());
            spare.pop_back();
        }
    }

    /// What `look_ahead` reads.
    void look_far_ahead(std::size_t index) const {
        const auto fetch = [](const auto& what) {
            for (std::size_t i = 0; i < sizeof what; i += 64)
                __builtin_prefetch(reinterpret_cast<const char*>(&what) + i, 0, 2);
        };
        fetch(list[index]);
        fetch(sources[index]);
    }

    /// Lists the memory of a tile that this thread comes to soon: nobody takes its planes away before.
    void look_ahead(std::size_t index, Ahead& ahead) const {
        ahead.clear();
        const auto planes_of = [&](std::uint32_t at, std::size_t begin, std::size_t end) {
            if (at == kNone) return;
            for (const Plane* plane : sources[at].liquid) ahead.add(plane, begin, end);
            for (const Plane* plane : sources[at].open) ahead.add(plane, begin, end);
        };
        const Active& tile = list[index];
        planes_of(static_cast<std::uint32_t>(index), 0, sizeof(Plane));
        for (const int above : {7, 8})
            planes_of(tile.around[above], 0, 64);  // the row below was read before, and is at hand
        for (const SeamNeighbour& other : tile.seams.others)
            for (unsigned lines = other.lines; lines && other.place != kNone; lines &= lines - 1) {
                const std::size_t line = 64 * static_cast<std::size_t>(std::countr_zero(lines));
                planes_of(other.place, line, line + 64);
            }
        ahead.add(tile.faces.geometry, 0, offsetof(Geometry, grain));
        ahead.add(tile.faces.diagonals, 0, sizeof(Geometry::Diagonals));
    }

    void find_planes(const Canvas& canvas, std::size_t index) {
        const std::uint32_t slot = list[index].slot;
        Sources& from = sources[index];
        from.liquid = {canvas.liquid(slot, Liquid::film), canvas.liquid(slot, Liquid::pores)};
        for (int p = 0; p < kMaxPigments; ++p) from.open[p] = canvas.plane(slot, p);
        from.relief = relief[slot].get();
    }

    /// Puts into the canvas what a step made of a tile, when nobody needs what was there any more.
    void commit(Canvas& canvas, std::size_t index, float stain, Spare& spare) {
        Active& tile = list[index];
        if (tile.idle) return;
        Sources& from = sources[index];
        const auto put_liquid = [&](Liquid where, PlanePtr& plane, float most) {
            const Plane*& known = from.liquid[static_cast<std::size_t>(where)];
            if (most > 0) {
                known = plane.get();
                canvas.swap_liquid(tile.slot, where, plane);
            } else if (known) {
                known = nullptr;
                PlanePtr none;
                canvas.swap_liquid(tile.slot, where, none);
            }
            if (plane) spare[static_cast<std::size_t>(where)].push_back(std::move(plane));
        };
        put_liquid(Liquid::film, tile.w, tile.outcome.most_w);
        put_liquid(Liquid::pores, tile.s, tile.outcome.most_s);
        for (int p = 0; p < kMaxPigments; ++p) {
            if (!(tile.pigments >> p & 1)) continue;
            if (from.open[p] || !all_zero(*tile.p[p])) {
                from.open[p] = tile.p[p].get();
                canvas.swap_open(tile.slot, p, tile.p[p]);
            }
            if (tile.p[p]) spare[2 + p].push_back(std::move(tile.p[p]));
        }
        if (!tile.outcome.closing) return;
        close_films(canvas, tile.slot, *tile.closing, stain);
        find_planes(canvas, index);
    }

    static bool last_reader(std::atomic<std::uint32_t>& readers, bool alone) {
        if (!alone) return readers.fetch_sub(1, std::memory_order_acq_rel) == 1;
        const std::uint32_t left = readers.load(std::memory_order_relaxed) - 1;
        readers.store(left, std::memory_order_relaxed);
        return left == 0;
    }

    /// Counts who reads a tile's planes among those that a step goes through, the others stay as
    /// they are.
    std::span<const std::uint32_t> going() {
        const auto set = [&](std::uint32_t i, std::uint32_t n) { readers[i].store(n, std::memory_order_relaxed); };
        if (part != Part::inside && !levels && !seeps) {
            for (std::uint32_t i = 0; i < list.size(); ++i) set(i, n_readers[i]);
            return order;
        }
        part_order.clear();
        for (const std::uint32_t i : order)
            if (seeps ? seepage.tile(i) != nullptr : levels ? tension.tile(i) != nullptr : beside_seam(list[i].slot))
                part_order.push_back(i);
        for (std::uint32_t i = 0; i < list.size(); ++i) {
            set(i, 0);
            list[i].idle = true;
        }
        for (const std::uint32_t i : part_order)
            for_each_read_tile(
                i, [&](std::uint32_t read) { set(read, readers[read].load(std::memory_order_relaxed) + 1); });
        return part_order;
    }

    /// `number`: of the step, another one for each of its parts.
    void step(Canvas& canvas, const FilmParams& params, const Step& rates, std::uint64_t number, FilmReport& report) {
        const bool alone = thread_count() == 1;
        const std::span<const std::uint32_t> tiles = going();
        const int pigments = static_cast<int>(canvas.pigments().size());
        parallel_for(tiles.size(), 16, [&](std::size_t begin, std::size_t end) {
            std::unique_ptr<Worker> worker = take_worker();
            worker->ahead.clear();
            for (std::size_t i = begin; i < end; ++i) {
                // The tile after the next: the next one's side is read already with this one.
                if (i + 2 < end)
                    look_ahead(tiles[i + 2], worker->ahead);
                else
                    worker->ahead.clear();
                if (i + 4 < end) look_far_ahead(tiles[i + 4]);
                for_each_read_tile(tiles[i], [&](std::uint32_t read) {
                    if (readers[read].load(std::memory_order_relaxed) == 1) canvas.expect(list[read].slot);
                });
                compute(tiles[i], pigments, rates, number, *worker);
                for_each_read_tile(tiles[i], [&](std::uint32_t read) {
                    if (last_reader(readers[read], alone))
                        commit(canvas, read, static_cast<float>(params.drying.stain), worker->spare);
                });
            }
            give_back(std::move(worker));
        });
        const double area = map.texel_size * map.texel_size;
        for (const std::uint32_t i : tiles) report.evaporated += list[i].outcome.evaporated * area;
        report.tile_steps += tiles.size();
    }

    /// Takes a step, and adds the tiles into which it spread.
    void step_faces(Canvas& canvas, const FilmParams& params, const FaceStep& face_step, FilmReport& report,
                    const BeforeFn& before) {
        if (sources.empty()) prepare(canvas);
        for (const Active& tile : list) report_slot(tile.slot, before);
        part = face_step.faces;
        if (part != Part::whole)
            for (const Active& tile : list)
                if (beside_seam(tile.slot) && !split_geometry[tile.slot]) split_faces(tile.slot);
        step(canvas, params, face_step.rates, face_step.number, report);
        const bool bedded = bed_flooded(canvas);
        if (changed()) spread(), sources.clear();
        if (bedded) sources.clear();
    }

    /// Ripples level for `seconds`, in steps of `level_steps.seconds`, which grows while all is slow.
    void level(Canvas& canvas, const FilmParams& params, double seconds, const Step& last, FilmReport& report) {
        if (!tension.find(*this, relief)) {
            level_steps.grow();
            return;
        }
        const Step rates = still(last);
        part = Part::whole;
        std::uint64_t n = 0;
        for (double left = seconds; left > 0;) {
            const double dt = left / std::ceil(left / level_steps.seconds * (1 - 1e-9));
            if (sources.empty()) prepare(canvas);
            const Tension::TensionResult solved = tension.solve(*this, sources, dt);
            levels = true;
            step(canvas, params, rates, report.steps | ++n << 48, report);
            levels = false;
            left = dt < left * (1 - 1e-9) ? left - dt : 0;
            level_steps.follow(solved.bends, solved.change);
        }
    }

    /// Liquid soaks into the pores and goes through them for `seconds`.
    void seep(Canvas& canvas, const FilmParams& params, double seconds, const Step& last, FilmReport& report,
              const BeforeFn& before) {
        const Step rates = still(last);
        part = Part::whole;
        std::uint64_t n = 0;
        for (double left = seconds; left > 0 && !list.empty();) {
            if (sources.empty()) prepare(canvas);
            if (!seepage.find(*this, sources)) return;
            for (const Active& tile : list) report_slot(tile.slot, before);
            const bool fed =
                std::any_of(list.begin(), list.end(), [](const Active& t) { return t.outcome.most_w > 0; });
            const double most = fed ? seepage.fresh_step(map) : left;
            const double dt = seepage.solve(*this, sources, left > most ? left / std::ceil(left / most) : left);
            seeps = true;
            step(canvas, params, rates, report.steps | ++n << 56, report);
            seeps = false;
            if (changed()) spread(), sources.clear();
            left = dt < left * (1 - 1e-9) ? left - dt : 0;
        }
    }

    void step_in_parts(Canvas& canvas, const FilmParams& params, const StepChoice& chosen, FilmReport& report,
                       const BeforeFn& before) {
        const std::uint64_t number = report.steps++;
        const auto inside = [&](int first, int last) {
            for (int i = first; i < last && !list.empty(); ++i)
                step_faces(canvas, params, {Part::inside, chosen.part, number | (i + 1ull) << 40}, report, before);
        };
        inside(0, chosen.parts / 2);
        if (!list.empty())
            step_faces(canvas, params, {chosen.parts ? Part::outside : Part::whole, chosen.step, number}, report,
                       before);
        inside(chosen.parts / 2, chosen.parts);
    }
};

WetFilm::WetFilm(const atlas::TexelMap& map, atlas::SeamLinks seams)
    : state_(std::make_unique<State>(map, std::move(seams))) {}
WetFilm::~WetFilm() = default;
WetFilm::WetFilm(WetFilm&&) noexcept = default;

void WetFilm::keep_within(FreeFn free) {
    state_->set_free(std::move(free));
}

FilmReport WetFilm::advance(Canvas& canvas, double seconds, const FilmParams& params, const BeforeFn& before,
                            const ProgressFn& progress) {
    FilmReport report;
    State& s = *state_;
    if (!params.drying.goes_on) s.air.forget();
    if (!canvas.wet() || !(seconds > 0)) return report;
    s.reported.assign(s.map.n_slots(), 0);
    s.forget_relief();
    s.tension.start(params, s.map);
    s.seepage.start(params);
    s.air.start(params, s.map);
    s.set_unevenness(params.unevenness, params.pores.retention);  // fibres sieve
    s.sheets.start(params, s, params.drying.goes_on);
    s.begin(canvas);
    double beads = 0;  // seconds that they have not run yet
    bool running = glm::length(params.weight.down) > 0;
    // A long wait ends with what is level; how it became so needs not be followed at every moment.
    const double least = s.level_steps.seconds = std::clamp(kPartOfWait * seconds, LevelSteps::kStep, kLeastOfLongWait);
    double rippled = params.ripples.unlevelled;  // seconds in which ripples have not levelled yet
    for (double left = seconds; left > 0 && !s.list.empty();) {
        if (progress && !progress("drying", 1 - left / seconds)) {
            s.end(canvas);
            throw Cancelled();
        }
        if (s.sources.empty()) s.prepare(canvas);
        s.air.look(s, s.sources);
        const double slower = seconds > kLongWait && !s.sheets.run_on() ? s.air.slower() : 1;
        s.level_steps.set(least, slower);
        StepChoice chosen = choose_step(params, s, {s.any_relief, running, slower}, left);
        const double dt = chosen.dt;
        s.air.slow_down(chosen.step);
        s.air.pass(dt);
        left = dt < left * (1 - 1e-9) ? left - dt : 0;
        rippled += dt;
        const bool level = params.ripples.tension > 0 && params.ripples.level &&
                           (rippled > 0.9 * std::max(s.level_steps.seconds, kLevelEvery) || left == 0);
        if (level) chosen.step.searches = true;
        s.step_in_parts(canvas, params, chosen, report, before);
        if (params.pores.capacity > 0) s.seep(canvas, params, dt, chosen.step, report, before);
        if (level && !s.list.empty()) s.level(canvas, params, rippled, chosen.step, report);
        if (level) rippled = 0;
        beads += dt;
        if (beads > 0.9 * kBeadStep || left == 0) {
            running = s.run_down(canvas, params, beads, before);
            if (running) s.sources.clear();
            beads = 0;
        }
    }
    s.end(canvas);
    return report;
}

FilmReport WetFilm::dry(Canvas& canvas, const FilmParams& params, const BeforeFn& before, double limit,
                        const ProgressFn& progress) {
    FilmReport report;
    constexpr double kAtOnce = 60;
    FilmParams now = params;
    for (double left = limit; left > 0 && canvas.wet(); left -= kAtOnce) {
        const FilmReport part = advance(canvas, std::min(left, kAtOnce), now, before, progress);
        now.drying.goes_on = true;
        report.steps += part.steps;
        report.tile_steps += part.tile_steps;
        report.evaporated += part.evaporated;
    }
    if (before)
        for (const std::uint32_t slot : canvas.touched_slots())
            if (canvas.has_film(slot, kOpenFilm) || canvas.liquid(slot, Liquid::film) ||
                canvas.liquid(slot, Liquid::pores))
                before(slot);
    report.evaporated += dry_all(canvas, state_->map);
    return report;
}

}  // namespace tuft::ink
