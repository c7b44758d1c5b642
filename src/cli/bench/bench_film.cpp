#include "cli/bench/bench_film.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/system/clock.h"
#include "core/system/parallel.h"
#include "ink/exchange/transfer.h"
#include "ink/film/film.h"

namespace tuft::cli {
namespace {

constexpr std::size_t kMostTiles = 4096;
constexpr std::array kInks{"carbon", "cinnabar", "gamboge", "indigo"};

double median(std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
}

/// The first `tiles` tiles under a wavy film of water with four pigments.
ink::Canvas wet_canvas(const stroke::Model& model, std::size_t tiles) {
    ink::Canvas canvas(model.texels.n_slots());
    for (const char* name : kInks) canvas.add_pigment(ink::load_ink(name).parts[0].pigment);
    for (std::uint32_t slot = 0; slot < std::min(tiles, model.texels.n_slots()); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            if (model.texels.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            const Vec3f p = model.texels.position(slot, t) * 2000.0f;
            canvas.touch_liquid(slot, ink::Liquid::film)[t] = 2 + 0.5f * std::sin(p.x) * std::sin(p.y + p.z);
            for (std::size_t k = 0; k < kInks.size(); ++k)
                canvas.touch(slot, static_cast<int>(k))[t] = 0.5f + 0.4f * std::sin(p.z * static_cast<float>(k + 1));
        }
    return canvas;
}

double wet_texels(const ink::Canvas& canvas) {
    double n = 0;
    for (const std::uint32_t slot : canvas.wet_slots()) {
        const ink::Plane *w = canvas.liquid(slot, ink::Liquid::film), *s = canvas.liquid(slot, ink::Liquid::pores);
        for (int t = 0; t < atlas::kTileTexels; ++t) n += (w && (*w)[t] > 0) || (s && (*s)[t] > 0);
    }
    return n;
}

/// A film that stays wet, advanced as painting does it.
struct FilmRun {
    FilmRun(const stroke::Model& model, ink::WetFilm& on, std::size_t tiles, bool whole = true)
        : film(on), canvas(wet_canvas(model, tiles)), params(ink::film_params(ink::load_substrate("bisque"))) {
        if (!whole) params.ripples.level = false, params.pores.capacity = 0;
        const double area = model.texels.texel_size * model.texels.texel_size;
        dt = 0.005 * area / (params.mobility * 3);
        film.advance(canvas, dt, params);
    }

    /// Time of a step: the mean of ten and more.
    double step_seconds(clockid_t clock) {
        params.shortest_step = 0;
        const double start = clock_seconds(clock);
        std::size_t steps = 0;
        while (steps < 10) steps += film.advance(canvas, 60 * dt, params).steps;
        return (clock_seconds(clock) - start) / static_cast<double>(steps);
    }

    ink::WetFilm& film;
    ink::Canvas canvas;
    ink::FilmParams params;
    double dt = 0;
};

struct StepTime {
    double seconds = 0, per_texel = 0;  ///< of one step
};

/// Medians of nine runs.
StepTime step_time(const stroke::Model& model, ink::WetFilm& film, std::size_t tiles, clockid_t clock,
                   bool whole = true) {
    FilmRun run(model, film, tiles, whole);
    std::vector<double> runs, per_texel;
    for (int i = 0; i < 9; ++i) {
        runs.push_back(run.step_seconds(clock));
        per_texel.push_back(runs.back() / wet_texels(run.canvas));  // it spreads a little
    }
    return {median(runs), median(per_texel)};
}

double transfer_seconds(const stroke::Model& model, std::size_t tiles) {
    ink::Canvas canvas = wet_canvas(model, tiles);
    ink::Reservoir tuft = ink::make_reservoir(50);
    ink::Mix mix{};
    for (std::size_t k = 0; k < kInks.size(); ++k) mix[k] = 0.25f;
    ink::dip(tuft, mix);
    ink::SurfaceLiquid liquid;
    ink::NodeAreas areas;
    areas.fill(1e-5);
    const ink::NodeContact nodes = ink::node_contact(tuft, {}, {}, {});
    refresh(liquid, tuft, {}, nodes, areas, {.dt = 0.1});
    const double ds = 1e-4;
    const ink::TransferParams p = transfer_params(liquid, tuft, {}, areas, {}, {.ds = ds, .dt = 2e-3, .stress = 0.5});
    std::array<float, atlas::kTileTexels> coverage;
    coverage.fill(0.8f);
    // As under a patch of 64 × 64 texels, and mostly between two nodes.
    ink::TexelPlaces places;
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        places.along[t] = 1.2f + static_cast<float>(t / atlas::kTile) * (ink::kAlong - 1) / 64.0f;
        places.across[t] = 3.1f + static_cast<float>(t % atlas::kTile) * (ink::kAcross - 1) / 64.0f;
    }
    ink::HatBasis hats;
    ink::NodeContents given{};
    std::vector<double> runs;
    for (int i = 0; i < 9; ++i) {
        const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        for (std::uint32_t slot = 0; slot < tiles; ++slot) {
            ink::hat_basis(hats, places, coverage);
            ink::transfer(canvas, {{slot, coverage, model.texels.tiles[slot].area, ds}, places, hats}, p, given);
        }
        runs.push_back(clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start);
    }
    return median(runs) / static_cast<double>(tiles * atlas::kTileTexels);
}

}  // namespace

std::function<double()> wet_atlas(const stroke::Model& model) {
    const auto film =
        std::make_shared<ink::WetFilm>(model.texels, atlas::build_seam_links(*model.mesh, model.atlas, model.texels));
    const auto run = std::make_shared<FilmRun>(model, *film, model.texels.n_slots());
    return [film, run] { return run->step_seconds(CLOCK_MONOTONIC); };
}

FilmFigures measure_film(const stroke::Model& model) {
    FilmFigures out;
    const std::size_t tiles = std::min(kMostTiles, model.texels.n_slots());
    ink::WetFilm film(model.texels, atlas::build_seam_links(*model.mesh, model.atlas, model.texels));
    const int threads = thread_count();
    set_thread_count(1);
    out.flow_ns = 1e9 * step_time(model, film, tiles, CLOCK_THREAD_CPUTIME_ID, false).per_texel;
    out.step_ns = 1e9 * step_time(model, film, tiles, CLOCK_THREAD_CPUTIME_ID).per_texel;
    out.transfer_ns = 1e9 * transfer_seconds(model, std::min<std::size_t>(tiles, 1024));
    if (model.atlas.size <= 2048) {
        set_thread_count(2);
        out.steps_per_second = 1 / step_time(model, film, model.texels.n_slots(), CLOCK_MONOTONIC).seconds;
    }
    set_thread_count(threads);
    return out;
}

}  // namespace tuft::cli
