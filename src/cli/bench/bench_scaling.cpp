#include "cli/bench/bench_scaling.h"

#include <array>
#include <nlohmann/json.hpp>

#include "cli/bench/bench_strokes.h"
#include "cli/bench/bench_threads.h"
#include "cli/steps/steps.h"
#include "core/system/parallel.h"

namespace tuft::cli {
namespace {

constexpr int kStampTexels = 64;
constexpr std::array kOneInk{"carbon"};

MeasuredModel make(const Bench& a, Console& console, int n, std::uint32_t size) {
    stroke::ModelOptions options = model_options(a.surface, console);
    options.unwrap.size = size;
    return prepare_measured("sphere", sphere(n), std::move(options));
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
    nlohmann::json j = measure_threads(a, console);
    j["triangles"] = by_triangles(a, console);
    j["texels"] = by_texels(a, console);
    j["stamp"] = by_stamp(a, console);
    return j;
}

}  // namespace tuft::cli
