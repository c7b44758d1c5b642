#include "cli/device/device_trials.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>

#include "brush/preset/preset.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/random.h"
#include "core/system/cpu_time.h"
#include "core/system/parallel.h"

namespace tuft::cli {
namespace {

using haptic::HandMotion;
using haptic::TrialOptions;
using haptic::TrialReport;

constexpr int kMotions = static_cast<int>(HandMotion::slide) + 1;

enum class Where { above, edge, groove };

void add(Places& places, ContactModel model, const std::string& name, Where where) {
    places.surface.push_back(model.surface.get());
    places.place.push_back(where == Where::above
                               ? haptic::place_above(*places.surface.back(), name)
                               : haptic::place_at_edge(*places.surface.back(), name, where == Where::groove));
    places.models.push_back(std::move(model));
}

/// One trial: its result, where it was, and what it cost.
struct Tried {
    TrialReport report;
    std::string where;
    double cpu_seconds = 0;
};
using TrialFn = std::function<Tried(std::size_t)>;

/// Trials of one kind.
struct Kind {
    std::string name;
    std::size_t n = 0;
    std::size_t per_thread = 8;  // at a time
    bool keep_seconds = false;
};

/// Trials first to first + n - 1, side by side. Those that an interrupt left undone are empty.
std::vector<std::optional<Tried>> try_some(std::size_t first, std::size_t n, const TrialFn& trial, bool keep_seconds) {
    std::vector<std::optional<Tried>> batch(n);
    const auto try_range = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double start = thread_cpu_seconds();
            Tried tried = trial(first + i);
            tried.cpu_seconds = thread_cpu_seconds() - start;
            tried.report.forces = {};
            tried.report.roots = {};
            if (!keep_seconds) tried.report.solves.seconds = {};
            batch[i] = std::move(tried);
        }
    };
    try {
        parallel_for(n, 1, try_range);
    } catch (const Cancelled&) {
        return batch;
    }
    return batch;
}

/// Runs all trials of a kind, some at a time so that their forces do not fill the memory.
TrialsDone run_all(const Kind& kind, const TrialFn& trial, Console& console, Trials& trials) {
    const ProgressFn progress = console.progress();
    const std::size_t at_once = kind.per_thread * static_cast<std::size_t>(thread_count());
    TrialsDone done;
    while (trials.complete && done.count < kind.n) {
        if (progress) progress(kind.name, static_cast<double>(done.count) / static_cast<double>(kind.n));
        for (const std::optional<Tried>& tried :
             try_some(done.count, std::min(at_once, kind.n - done.count), trial, kind.keep_seconds)) {
            trials.complete = trials.complete && tried.has_value();
            if (!trials.complete) break;
            if (tried->report.least_energy < trials.worst.least_energy) trials.least_energy_at = tried->where;
            if (tried->report.largest_step > trials.worst.largest_step) trials.largest_step_at = tried->where;
            haptic::merge(trials.worst, tried->report);
            ++done.count;
            done.cpu_seconds += tried->cpu_seconds;
        }
    }
    return done;
}

std::string where_of(const std::string& brush, const haptic::TrialPlace& place, HandMotion motion) {
    return fmt::format("{}, {}, {}", brush, place.name, haptic::name_of(motion));
}

std::vector<brush::Tuft> tufts_of(const DeviceWork& a) {
    if (a.trial.all_brushes && a.spine == "table")
        throw UsageError("--all-brushes: the query table bends no brush of several spines");
    std::vector<brush::Tuft> tufts;
    for (const std::string& name : a.trial.all_brushes ? brush::list_presets() : std::vector{a.brush})
        tufts.push_back(brush::make_tuft(brush_in_hand(a, name)));
    return tufts;
}

void try_motions(const DeviceWork& a, const Places& places, Console& console, Trials& trials) {
    const std::vector<brush::Tuft> tufts = tufts_of(a);
    const std::size_t of_a_brush = places.place.size() * kMotions;
    const TrialFn trial = [&](std::size_t i) {
        const brush::Tuft& tuft = tufts[i / of_a_brush];
        const std::size_t p = i % of_a_brush / kMotions;
        const auto motion = static_cast<HandMotion>(i % kMotions);
        return Tried{run_trial(tuft, *places.surface[p], haptic::hand_path(motion, places.place[p], tuft.preset),
                               trial_options(a, tuft.preset)),
                     where_of(tuft.preset.name, places.place[p], motion)};
    };
    trials.motions =
        run_all({.name = "motions", .n = tufts.size() * of_a_brush, .keep_seconds = true}, trial, console, trials);
}

/// Hands of any weight and grip, one second each with a motion of its own.
void try_hands(const DeviceWork& a, const Places& places, Console& console, Trials& trials) {
    const std::vector<brush::Tuft> tufts = tufts_of(a);
    const TrialFn trial = [&](std::size_t i) {
        const std::size_t hand = static_cast<std::size_t>(a.trial.first_hand) + i;
        const brush::Tuft& tuft = tufts[hand % tufts.size()];
        Random random(static_cast<std::uint64_t>(hand) + 1);
        TrialOptions options = trial_options(a, tuft.preset);
        options.seconds = 2;
        options.hand = {.mass = 0.02 * std::pow(25.0, random.uniform()),  // a finger … an arm
                        .damping = random.uniform(1, 12),
                        .stiffness = 50 * std::pow(20.0, random.uniform())};
        const std::size_t p = random.bits() % places.place.size();
        const auto motion = static_cast<HandMotion>(random.bits() % kMotions);
        const std::uint64_t seed = random.bits() | 1;
        return Tried{
            run_trial(tuft, *places.surface[p], haptic::hand_path(motion, places.place[p], tuft.preset, seed), options),
            fmt::format("{}, hand {}", where_of(tuft.preset.name, places.place[p], motion), hand)};
    };
    trials.hands = run_all({.name = "hands", .n = static_cast<std::size_t>(a.trial.hands)}, trial, console, trials);
}

void try_hours(const DeviceWork& a, const Places& places, Console& console, Trials& trials) {
    const brush::Tuft tuft = brush::make_tuft(brush_in_hand(a, a.brush));
    constexpr double kPart = 60;  // s of one motion
    const TrialFn trial = [&](std::size_t part) {
        TrialOptions options = trial_options(a, tuft.preset);
        options.seconds = kPart;
        const std::size_t p = part % places.place.size();
        const HandMotion motion =
            haptic::kPaintingMotions[part / places.place.size() % std::size(haptic::kPaintingMotions)];
        return Tried{run_trial(tuft, *places.surface[p],
                               haptic::hand_path(motion, places.place[p], tuft.preset, part + 1), options),
                     fmt::format("{}, minute {}", where_of(tuft.preset.name, places.place[p], motion), part)};
    };
    const auto parts = static_cast<std::size_t>(std::ceil(a.trial.hours * 3600 / kPart));
    trials.hours = run_all({.name = "hours", .n = parts, .per_thread = 1}, trial, console, trials);
}

}  // namespace

Places places_of(const DeviceWork& a) {
    Places places;
    if (!a.model.empty()) {
        add(places, load_contact_model(a.model), "model", Where::above);
        add(places, load_contact_model(a.model), "edge", Where::edge);
        return places;
    }
    add(places, load_contact_model("sheet"), "sheet", Where::above);
    add(places, load_contact_model("bowl"), "bowl", Where::above);
    add(places, load_contact_model("bowl"), "rim", Where::edge);
    add(places, load_contact_model("car"), "roof", Where::above);
    add(places, load_contact_model("car"), "car's edge", Where::edge);
    add(places, load_contact_model("car"), "shut line", Where::groove);
    add(places, load_contact_model("plate"), "plate's edge", Where::edge);
    return places;
}

TrialOptions trial_options(const DeviceWork& a, const brush::Preset& preset) {
    TrialOptions options;
    options.law = {.limits = haptic::device_preset(a.arm.simulate),
                   .gain = preset.force_gain,
                   .delay = 1e-3 * a.simulation.delay_ms,
                   .restore = a.restore};
    options.delay = 1e-3 * a.simulation.delay_ms;
    options.jitter = jitter_of(a);
    options.solver = solver_options(a, preset);
    return options;
}

Trials run_trials(const DeviceWork& a, const Places& places, Console& console) {
    Trials trials;
    try_motions(a, places, console, trials);
    try_hands(a, places, console, trials);
    try_hours(a, places, console, trials);
    return trials;
}

}  // namespace tuft::cli
