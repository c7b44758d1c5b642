#include "cli/bench/bench_threads.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "cli/bench/bench_film.h"
#include "cli/bench/bench_strokes.h"
#include "cli/steps/steps.h"
#include "core/system/clock.h"
#include "core/system/parallel.h"

namespace tuft::cli {
namespace {

constexpr std::size_t kMostRounds = 5;
constexpr int kStrokes = 40, kManyStrokes = 400, kWetStrokes = 8;
constexpr int kShortSamples = 121;

/// Something that is measured: the name of its figure, and what returns the wall time of one run.
struct Workload {
    std::string key;
    std::function<double()> run;
};

/// CPU time of all threads of this process, seconds.
double all_cpu_seconds() {
    return clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
}

double seconds_of(const std::function<void()>& work) {
    const double start = wall_seconds();
    work();
    return wall_seconds() - start;
}

std::vector<int> thread_counts(const Bench& a) {
    if (!a.scaling.empty()) return a.scaling;
    set_thread_count(0);
    const int most = thread_count();
    std::vector<int> counts;
    for (int n = 1; n < most; n *= 2) counts.push_back(n);
    counts.push_back(most);
    return counts;
}

/// Strokes with fresh brushes all over a sphere, in five rows of height; each stroke far from the one before.
std::vector<stroke::JournalEntry> strokes_over(const stroke::Model& model, int n, int samples,
                                               stroke::FilmModel film = stroke::FilmModel::still) {
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    std::vector<stroke::JournalEntry> entries;
    for (int i = 0; i < n; ++i) {
        stroke::PaintStroke s = dragged(model, {.turn = i * golden, .height = 0.35 * (i % 5 - 2), .samples = samples});
        s.settings.film = film;
        entries.emplace_back(std::move(s));
    }
    return entries;
}

/// Strokes on a model, painted or replayed into an empty document.
class StrokesOnModel {
  public:
    StrokesOnModel(const stroke::Model& model, std::vector<stroke::JournalEntry> entries)
        : model_(model), entries_(std::move(entries)) {}

    double paint() const {
        stroke::Document painting(model_);
        painting.use(dragged_brush(model_, {}));
        std::vector<stroke::JournalEntry> entries = entries_;
        return seconds_of([&] { painting.paint(std::move(entries), stroke::EntryDoneFn()); });
    }
    double replay() const {
        stroke::Document painting(model_);
        painting.use(dragged_brush(model_, {}));
        std::vector<stroke::JournalEntry> entries = entries_;
        for (std::size_t i = 0; i < entries.size(); ++i) entries[i].id = i + 1;
        return seconds_of([&] { painting.replay(std::move(entries)); });
    }

  private:
    const stroke::Model& model_;
    std::vector<stroke::JournalEntry> entries_;
};

double prepare_seconds(const Bench& a, Console& console) {
    stroke::ModelOptions options = model_options(a.surface, console);
    options.unwrap.size = a.quick ? 2048 : 4096;
    return prepare_measured("sphere", sphere(a.quick ? 158 : 500), std::move(options)).all_seconds;
}

/// Wall and CPU times by workload and number of threads.
struct Times {
    std::map<std::string, std::map<int, std::vector<double>>> wall, cpu;
};

/// Returns the seconds that the round took.
double measure_round(const Workload& work, const std::vector<int>& counts, Times& times, const ProgressFn& progress) {
    return seconds_of([&] {
        for (std::size_t k = 0; k < counts.size(); ++k) {
            report(progress, "measuring", static_cast<double>(k) / static_cast<double>(counts.size()));
            set_thread_count(counts[k]);
            const double cpu = all_cpu_seconds();
            times.wall[work.key][counts[k]].push_back(work.run());
            times.cpu[work.key][counts[k]].push_back(all_cpu_seconds() - cpu);
        }
    });
}

Times measure(const std::vector<Workload>& works, const std::vector<int>& counts, double most_seconds,
              Console& console) {
    Times times;
    std::map<std::string, double> round_seconds;
    double spent = 0;
    for (std::size_t round = 0; round < kMostRounds; ++round)
        for (const Workload& work : works) {
            if (round > 0 && spent + round_seconds[work.key] > most_seconds) continue;
            round_seconds[work.key] = measure_round(work, counts, times, console.progress());
            spent += round_seconds[work.key];
        }
    return times;
}

nlohmann::json rows_of(const Times& times, const std::vector<int>& counts) {
    nlohmann::json j;
    for (const int n : counts) {
        nlohmann::json row{{"threads", n}};
        for (const auto& [key, runs] : times.wall) {
            row[key + "_seconds"] = quantile_of(runs.at(n), 0.5);
            row[key + "_cpu_seconds"] = quantile_of(times.cpu.at(key).at(n), 0.5);
            j["rounds"][key] = runs.at(n).size();
        }
        j["threads"].push_back(std::move(row));
    }
    return j;
}

}  // namespace

nlohmann::json measure_threads(const Bench& a, Console& console) {
    const std::vector<int> counts = thread_counts(a);
    set_thread_count(0);
    stroke::ModelOptions options = model_options(a.surface, console);
    options.unwrap.size = 2048;
    const MeasuredModel m = prepare_measured("sphere", sphere(a.quick ? 79 : 158), std::move(options));
    const StrokesOnModel strokes(m.model, strokes_over(m.model, kStrokes, 401));
    const StrokesOnModel many(m.model, strokes_over(m.model, a.quick ? kManyStrokes / 4 : kManyStrokes, kShortSamples));
    const StrokesOnModel wet(m.model, strokes_over(m.model, kWetStrokes, 401, stroke::FilmModel::wet));
    const Times times = measure({{"prepare", [&] { return prepare_seconds(a, console); }},
                                 {"paint", [&] { return strokes.paint(); }},
                                 {"replay", [&] { return strokes.replay(); }},
                                 {"paint_many", [&] { return many.paint(); }},
                                 {"wet_strokes", [&] { return wet.paint(); }},
                                 {"hand", [&] { return hand_seconds(m.model, {}); }},
                                 {"film_step", wet_atlas(m.model)}},
                                counts, a.seconds, console);
    set_thread_count(1);
    return rows_of(times, counts);
}

void print_threads(const nlohmann::json& measured) {
    static constexpr std::array<std::pair<const char*, const char*>, 7> kColumns{{{"paint", "40 strokes"},
                                                                                  {"replay", "replayed"},
                                                                                  {"paint_many", "many short"},
                                                                                  {"wet_strokes", "wet strokes"},
                                                                                  {"hand", "hand"},
                                                                                  {"film_step", "film step"},
                                                                                  {"prepare", "preparing"}}};
    fmt::print("{:>7}", "threads");
    for (const auto& [key, title] : kColumns)
        fmt::print("{:>17}", fmt::format("{} (x{})", title, measured["rounds"][key].get<int>()));
    fmt::print("\n");
    const nlohmann::json& first = measured["threads"].front();
    for (const nlohmann::json& row : measured["threads"]) {
        fmt::print("{:>7}", row["threads"].get<int>());
        for (const auto& [key, title] : kColumns) {
            const std::string figure = std::string(key) + "_seconds";
            const double seconds = row[figure].get<double>();
            fmt::print("{:>8.4f} s {:>5.2f} x", seconds, first[figure].get<double>() / seconds);
        }
        fmt::print("\n");
    }
}

}  // namespace tuft::cli
