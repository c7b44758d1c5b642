#include "cli/bench_scaling.h"

#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/bench_strokes.h"
#include "cli/steps.h"
#include "core/system/parallel.h"

namespace tuft::cli {
namespace {

constexpr int kStrokes = 40, kStampTexels = 64;
constexpr std::array kOneInk{"carbon"};

MeasuredModel make(const Bench& a, Console& console, int n, std::uint32_t size) {
    stroke::ModelOptions options = model_options(a.surface, console);
    options.unwrap.size = size;
    return prepare_measured("sphere", sphere(n), std::move(options));
}

/// 1, 2, 4, … and the number of cores.
std::vector<int> thread_counts() {
    set_thread_count(0);
    const int most = thread_count();
    std::vector<int> counts;
    for (int n = 1; n < most; n *= 2) counts.push_back(n);
    counts.push_back(most);
    return counts;
}

/// Wall time of strokes with fresh brushes all round the model.
double painting_seconds(const stroke::Model& model, int repeats) {
    std::vector<double> runs;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        stroke::Document painting(model);
        std::vector<stroke::JournalEntry> strokes;
        for (int i = 0; i < kStrokes; ++i)
            strokes.emplace_back(
                drag(model, painting, kStampTexels, "mixed-medium", 2 * std::numbers::pi * i / kStrokes));
        const double start = wall_seconds();
        painting.paint(std::move(strokes), [](const stroke::JournalEntry&, const stroke::StrokeReport&) {});
        runs.push_back(wall_seconds() - start);
    }
    return quantile_of(runs, 0.5);
}

nlohmann::json by_threads(const Bench& a, Console& console) {
    nlohmann::json rows;
    for (const int n : thread_counts()) {
        set_thread_count(n);
        const MeasuredModel m = make(a, console, a.quick ? 79 : 158, 2048);
        rows.push_back({{"threads", n},
                        {"paint_seconds", painting_seconds(m.model, a.quick ? 1 : 3)},
                        {"prepare_seconds", m.all_seconds}});
    }
    set_thread_count(1);
    return rows;
}

nlohmann::json by_triangles(const Bench& a, Console& console) {
    nlohmann::json rows;
    for (const int n : a.quick ? std::vector{25, 79, 158} : std::vector{25, 79, 158, 250, 500}) {
        const MeasuredModel m = make(a, console, n, 2048);
        rows.push_back({{"triangles", m.model.mesh->n_triangles()},
                        {"stamps_per_second", stamps_per_second(m.model, kStampTexels, 0, "mixed-medium", 3)},
                        {"prepare_seconds", m.all_seconds}});
    }
    return rows;
}

nlohmann::json by_texels(const Bench& a, Console& console) {
    nlohmann::json rows;
    for (const std::uint32_t size :
         a.quick ? std::vector{512u, 1024u, 2048u} : std::vector{512u, 1024u, 2048u, 4096u, 8192u}) {
        const MeasuredModel m = make(a, console, 79, size);
        rows.push_back({{"size", size},
                        {"stamps_per_second", stamps_per_second(m.model, kStampTexels, 0, "mixed-medium", 3)},
                        {"prepare_seconds", m.all_seconds}});
    }
    return rows;
}

nlohmann::json by_stamp(const Bench& a, Console& console) {
    nlohmann::json rows;
    const MeasuredModel m = make(a, console, 79, 2048);
    for (const int texels : a.quick ? std::vector{16, 64, 256} : std::vector{16, 32, 64, 128, 256})
        rows.push_back(
            {{"texels", texels},
             {"microseconds_per_stamp", microseconds_per_stamp(m.model, texels, 160, footprint::best_isa(), kOneInk)},
             {"stamps_per_second", stamps_per_second(m.model, texels, 0, "mixed-medium", 3)}});
    return rows;
}

}  // namespace

nlohmann::json measure_scaling(const Bench& a, Console& console) {
    nlohmann::json j{{"strokes", kStrokes}};
    j["threads"] = by_threads(a, console);
    j["triangles"] = by_triangles(a, console);
    j["texels"] = by_texels(a, console);
    j["stamp"] = by_stamp(a, console);
    return j;
}

}  // namespace tuft::cli
