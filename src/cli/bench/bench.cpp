#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "brush/tuft/tuft.h"
#include "cli/bench/bench_film.h"
#include "cli/bench/bench_report.h"
#include "cli/bench/bench_strokes.h"
#include "cli/bench/bench_threads.h"
#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/system/cpu_time.h"
#include "core/system/parallel.h"
#include "ink/composite/composite.h"
#include "io/model/read_model.h"

/// Speed on this machine: one thread, CPU time, medians over repeats.
namespace tuft::cli {
namespace {

footprint::Isa isa_of(const std::string& name) {
    if (name == "baseline") return footprint::Isa::baseline;
    if (name == "avx2") return footprint::Isa::avx2;
    return name == "avx512" ? footprint::Isa::avx512 : footprint::best_isa();
}

// Colour of a dirty square of 64 x 64 texels: 16 tiles with all of `films` films of 4 pigments.
double microseconds_per_square(int films, const char* substrate_name) {
    std::vector<ink::Pigment> pigments;
    for (const char* name : {"carbon-black", "cinnabar", "gamboge", "titanium-white"})
        pigments.push_back(ink::load_pigment(name));
    const ink::Substrate substrate = ink::load_substrate(substrate_name);
    std::vector<ink::Plane> planes(16 * 4);
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t t = 0; t < planes[i].size(); ++t)
            planes[i][t] = 0.01f * static_cast<float>((37 * t + 101 * i) % 200);
    std::vector<double> runs;
    double sink = 0;
    for (int repeat = 0; repeat < 60; ++repeat) {
        const double start = thread_cpu_seconds();
        for (std::size_t tile = 0; tile < 16; ++tile) {
            ink::TileFilm film;
            for (std::size_t p = 0; p < 4; ++p) film.pigments[p] = &planes[4 * tile + p];
            const std::vector<ink::TileFilm> stack(static_cast<std::size_t>(films), film);
            sink += ink::shade_films(stack, nullptr, pigments, substrate).colour[0][tile];
        }
        runs.push_back((thread_cpu_seconds() - start) * 1e6);
    }
    return sink < 0 ? 0 : quantile_of(runs, 0.5);
}

struct RodTimes {
    double mean = 0, spread = 0;  // of the means of runs: their median, and the half of their range
    double median = 0, p99 = 0;   // of all solves
};

// Press, drag and lift on a plane, 1 kHz, friction on; some runs.
RodTimes rod_microseconds(const brush::Preset& preset, int runs) {
    constexpr int kSolves = 3000;
    std::vector<double> times, means;
    for (int run = 0; run < runs; ++run) {
        brush::Tuft tuft = brush::make_tuft(preset);
        const double length = tuft.preset.length;
        const brush::ContactPlane plane;
        double sum = 0;
        for (int i = 0; i < kSolves; ++i) {
            const double t = i * 1e-3;
            const double press = std::min({1.0, t / 0.3, std::max(0.0, (3.0 - t) / 0.3)});
            brush::Pose pose;
            pose.time = t;
            pose.position = {0.05 * std::clamp(t - 0.3, 0.0, 2.4), 0.004 * std::sin(6 * t),
                             length * (1.02 - 0.3 * press)};
            const double start = thread_cpu_seconds();
            brush::step(tuft, pose, std::span(&plane, 1), 1e-3);
            times.push_back((thread_cpu_seconds() - start) * 1e6);
            sum += times.back();
        }
        means.push_back(sum / kSolves);
    }
    const auto [lo, hi] = std::minmax_element(means.begin(), means.end());
    const double spread = 0.5 * (*hi - *lo);
    return {quantile_of(means, 0.5), spread, quantile_of(times, 0.5), quantile_of(times, 0.99)};
}

std::string cpu_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

double resident_megabytes() {
    std::ifstream status("/proc/self/status");
    for (std::string key; status >> key; std::getline(status, key)) {
        double kib = 0;
        if (key == "VmRSS:" && status >> kib) return kib / 1024;
    }
    return 0;
}

/// Models to measure on.
std::vector<MeasuredModel> make_models(const Bench& a, std::uint32_t size, Console& console) {
    std::vector<MeasuredModel> models;
    const auto add = [&](const std::string& name, mesh::PolygonSoup soup) {
        stroke::ModelOptions options = model_options(a.surface, console);
        options.unwrap.size = size;
        set_thread_count(0);  // as a user waits for it
        models.push_back(prepare_measured(name, std::move(soup), std::move(options)));
        set_thread_count(1);
    };
    if (!a.model.empty()) {
        add(a.model.stem().string(), io::read_model(a.model, cad_reading(a.model, a.surface)));
    } else {
        add("sphere-100k", sphere(158));
        if (!a.quick) add("sphere-1M", sphere(500));
    }
    return models;
}

/// Figures that need no model.
nlohmann::json measure_parts() {
    nlohmann::json j;
    j["machine"] = cpu_name();
    j["threads"] = 1;
    const RodTimes rod = rod_microseconds(brush::load_preset("mixed-medium"), 5);
    brush::Preset flat_brush = brush::load_preset("flat-12");
    flat_brush.segments = 12;
    const RodTimes flat = rod_microseconds(flat_brush, 2);
    j["flat_microseconds"] = {{"mean", flat.mean},
                              {"median", flat.median},
                              {"p99", flat.p99},
                              {"segments", flat_brush.segments},
                              {"spines", flat_brush.spines}};
    j["rod_microseconds"] = {
        {"mean", rod.mean}, {"mean_spread", rod.spread}, {"median", rod.median}, {"p99", rod.p99}, {"segments", 16}};
    j["composite_microseconds"] = {{"one_film", microseconds_per_square(1, "porcelain")},
                                   {"three_films", microseconds_per_square(3, "porcelain")},
                                   {"texels", 64 * 64},
                                   {"pigments", 4},
                                   {"bands", ink::kBands}};
    return j;
}

/// Figures of one model; `square`: microseconds of the colour of 64 × 64 texels.
nlohmann::json measure_model(const MeasuredModel& c, footprint::Isa isa, double square, Console& console) {
    nlohmann::json m{{"triangles", c.model.mesh->n_triangles()},
                     {"atlas_size", c.model.atlas.size},
                     {"texel_store", c.model.texels.packed.empty() ? "float" : "packed"}};
    static constexpr std::array kOneInk{"carbon"};
    static constexpr std::array kPigments{"carbon", "gamboge", "cinnabar"};
    for (const int texels : {64, 128, 256}) {
        report(console.progress(), "measuring", texels / 256.0);
        const double us = microseconds_per_stamp(c.model, texels, 160, isa, kOneInk);
        m["microseconds_per_stamp"][std::to_string(texels)] = us;
        if (texels == 256) {
            const double three = microseconds_per_stamp(c.model, texels, 160, isa, kPigments);
            m["ns_per_texel"] = {{"one_ink", us * 1e3 / footprint_texels(texels)},
                                 {"pigments", three * 1e3 / footprint_texels(texels)},
                                 {"composite", square * 1e3 / (64 * 64)}};
        }
        m["stamps_per_second"][std::to_string(texels)] = stamps_per_second(c.model, texels);
        m["bristle_stamps_per_second"][std::to_string(texels)] = stamps_per_second(c.model, texels, 0.75);
        m["flat_stamps_per_second"][std::to_string(texels)] = stamps_per_second(c.model, texels, 0, "flat-12");
    }
    const FilmFigures film = measure_film(c.model);
    m["ns_per_texel"]["film_flow"] = film.flow_ns;
    m["ns_per_texel"]["film_step"] = film.step_ns;
    m["ns_per_texel"]["transfer"] = film.transfer_ns;
    if (film.steps_per_second > 0) m["film_steps_per_second"] = film.steps_per_second;
    m["repair_seconds"] = c.repair_seconds;
    m["atlas_seconds"] = c.atlas_seconds;
    m["texel_map_seconds"] = c.map_seconds;
    m["cluster_graph_seconds"] = c.graph_seconds;
    m["first_ink_ms"] = first_ink_milliseconds(c.model, 64);
    return m;
}

void print_model(const std::string& name, const nlohmann::json& m) {
    const auto size = m["atlas_size"].get<std::uint32_t>();
    fmt::print("{} ({} triangles, atlas {} x {}, made in {:.1f} s, texel map {:.2f} s, cluster graph {:.2f} s)\n", name,
               m["triangles"].get<std::size_t>(), size, size, m["atlas_seconds"].get<double>(),
               m["texel_map_seconds"].get<double>(), m["cluster_graph_seconds"].get<double>());
    fmt::print(
        "  first ink {:.1f} ms after the first touch; {:.1f} ns a texel with one ink, {:.1f} with three pigments\n",
        m["first_ink_ms"].get<double>(), m["ns_per_texel"]["one_ink"].get<double>(),
        m["ns_per_texel"]["pigments"].get<double>());
    fmt::print(
        "  wet ink with four pigments: {:.1f} ns a texel and step, {:.1f} with levelling and soaking, {:.1f} both ways "
        "under the brush",
        m["ns_per_texel"]["film_flow"].get<double>(), m["ns_per_texel"]["film_step"].get<double>(),
        m["ns_per_texel"]["transfer"].get<double>());
    if (m.contains("film_steps_per_second"))
        fmt::print("; all of it wet {:.1f} steps/s on two threads", m["film_steps_per_second"].get<double>());
    fmt::print("\n");
    for (const char* texels : {"64", "128", "256"})
        fmt::print(
            "  {:>3} texels wide: deposit {:>7.1f} us a stamp; whole path {:>8.0f} stamps/s; dry, by 500 bristles "
            "{:>6.0f}; a flat {:>6.0f}\n",
            texels, m["microseconds_per_stamp"][texels].get<double>(), m["stamps_per_second"][texels].get<double>(),
            m["bristle_stamps_per_second"][texels].get<double>(), m["flat_stamps_per_second"][texels].get<double>());
}

void print_figures(const nlohmann::json& j) {
    const auto& rod = j["rod_microseconds"];
    const auto& flat = j["flat_microseconds"];
    fmt::print("{}, one thread (preparing: all), {}, CPU time, medians\n", j["machine"].get<std::string>(),
               j["isa"].get<std::string>());
    fmt::print("rod solve, 16 segments: mean {:.1f} +- {:.1f} us, median {:.1f} us, 99 % {:.1f} us\n",
               rod["mean"].get<double>(), rod["mean_spread"].get<double>(), rod["median"].get<double>(),
               rod["p99"].get<double>());
    fmt::print("five coupled spines of a flat, 12 segments: mean {:.0f} us, median {:.0f} us, 99 % {:.0f} us\n",
               flat["mean"].get<double>(), flat["median"].get<double>(), flat["p99"].get<double>());
    fmt::print("colour of 64 x 64 texels, 4 pigments, {} bands: {:.0f} us with one film, {:.0f} us with three\n",
               ink::kBands, j["composite_microseconds"]["one_film"].get<double>(),
               j["composite_microseconds"]["three_films"].get<double>());
    for (const auto& [name, m] : j["models"].items()) print_model(name, m);
    fmt::print("peak memory {:.0f} MiB, at the end {:.0f} MiB\n", j["peak_mb"].get<double>(),
               j["resident_mb"].get<double>());
}

int run_scaling(const Bench& a, Console& console) {
    nlohmann::json j = measure_threads(a, console);
    j["machine"] = cpu_name();
    console.clear();
    if (a.common.json) {
        print_json(j);
    } else {
        fmt::print("{}, medians of wall time\n", cpu_name());
        print_threads(j);
    }
    return 0;
}

}  // namespace

int run(const Bench& a) {
    check_bench_report(a);
    Console console(a.common.quiet);
    if (!a.scaling.empty()) return run_scaling(a, console);
    set_thread_count(1);
    const std::uint32_t size = a.surface.atlas_size > 0 ? a.surface.atlas_size : a.quick ? 2048 : 4096;
    const footprint::Isa isa = std::min(isa_of(a.isa), footprint::best_isa());
    const std::vector<MeasuredModel> models = make_models(a, size, console);
    nlohmann::json j = measure_parts();
    for (const MeasuredModel& c : models) {
        const nlohmann::json& m = j["models"][c.name] =
            measure_model(c, isa, j["composite_microseconds"]["one_film"].get<double>(), console);
        if (j.contains("microseconds_per_stamp")) continue;
        for (const char* key :
             {"microseconds_per_stamp", "stamps_per_second", "bristle_stamps_per_second", "flat_stamps_per_second",
              "ns_per_texel", "atlas_seconds", "texel_map_seconds", "cluster_graph_seconds", "first_ink_ms"})
            j[key] = m[key];
        j["model"] = fmt::format("{} at {} x {}", c.name, size, size);
    }
    j["peak_mb"] = peak_megabytes();
    j["resident_mb"] = resident_megabytes();
    j["isa"] = isa == footprint::Isa::avx512 ? "avx512" : isa == footprint::Isa::avx2 ? "avx2" : "baseline";
    if (!a.report.empty()) write_bench_report(a, j, console);
    console.clear();
    if (a.common.json)
        print_json(j);
    else
        print_figures(j);
    if (!a.report.empty() && !a.common.json) fmt::print("wrote {}\n", a.report.string());
    return 0;
}

}  // namespace tuft::cli
