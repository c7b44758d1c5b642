#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "brush/tuft/tuft.h"
#include "cli/bench_film.h"
#include "cli/commands.h"
#include "cli/steps.h"
#include "core/system/parallel.h"
#include "ink/composite/composite.h"
#include "ink/exchange/deposit.h"
#include "io/model/read_model.h"
#include "stroke/document/document.h"

/// Speed on this machine: one thread, CPU time, medians over repeats.
namespace tuft::cli {
namespace {

using std::numbers::pi;

double cpu_seconds() {
    timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double wall_seconds() {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

footprint::Isa isa_of(const std::string& name) {
    if (name == "baseline") return footprint::Isa::baseline;
    if (name == "avx2") return footprint::Isa::avx2;
    return name == "avx512" ? footprint::Isa::avx512 : footprint::best_isa();
}

double quantile(std::vector<double> values, double q) {
    std::sort(values.begin(), values.end());
    const auto i = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5);
    return values.empty() ? 0 : values[i];
}

// A sphere of 50 mm with rings of equal height; 4 n² triangles.
mesh::PolygonSoup sphere(int n) {
    mesh::PolygonSoup soup;
    const int rings = n, columns = 2 * n;
    for (int j = 0; j <= rings; ++j)
        for (int i = 0; i < columns; ++i) {
            const double theta = pi * j / rings, phi = 2 * pi * i / columns;
            soup.points.push_back(
                50.0 * Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
        }
    soup.polygon_start.push_back(0);
    const auto at = [&](int j, int i) { return static_cast<std::uint32_t>(j * columns + i % columns); };
    for (int j = 0; j < rings; ++j)
        for (int i = 0; i < columns; ++i) {
            for (const std::uint32_t v : {at(j, i), at(j + 1, i), at(j + 1, i + 1)}) soup.corners.push_back(v);
            soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            for (const std::uint32_t v : {at(j, i), at(j + 1, i + 1), at(j, i + 1)}) soup.corners.push_back(v);
            soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        }
    return soup;
}

// Metres that a unit of the model counts for, so that its surface is as large as that of a sphere of
// 50 mm: texels are about as large on every model then, and so are the brushes, whatever the model's size.
double metres_per_unit(const mesh::PolygonSoup& soup) {
    double area = 0;
    for (std::size_t p = 0; p < soup.n_polygons(); ++p) {
        const auto corner = [&](std::uint32_t c) { return soup.points[soup.corners[soup.polygon_start[p] + c]]; };
        const std::uint32_t n = soup.polygon_start[p + 1] - soup.polygon_start[p];
        for (std::uint32_t c = 2; c < n; ++c)
            area += 0.5 * glm::length(glm::cross(corner(c - 1) - corner(0), corner(c) - corner(0)));
    }
    const double of_sphere = 4 * pi * 0.05 * 0.05;
    return area > 0 && std::isfinite(area) ? std::sqrt(of_sphere / area) : kMillimetre;
}

// A place on the surface and the path that is taken there, along `frame.t`.
struct Step {
    Frame frame;
    std::uint32_t triangle;
};

// Places a texel apart, straight on over the surface from one side of it; left at an edge.
std::vector<Step> path_over(const stroke::Model& model, int n) {
    const Box& box = model.mesh->bounds;
    const Vec3 out{std::cos(0.3), std::sin(0.3), 0};
    const auto hit = model.query->ray(box.centre() + box.diagonal() * out, -glm::normalize(out));
    auto at = hit ? hit : model.query->closest_point(box.centre() + box.diagonal() * out);
    const double texel = model.atlas.texel_size;
    std::vector<Step> path{{make_frame(at->position, at->normal, {-out.y, out.x, 0.0}), at->triangle}};
    while (static_cast<int>(path.size()) < n) {
        const Frame& here = path.back().frame;
        at = model.query->closest_point(here.origin + texel * here.t);
        Vec3 heading = parallel_transport(here.t, here.n, at->normal);
        if (glm::length(at->position - here.origin) < 0.5 * texel) heading = glm::cross(at->normal, heading);
        path.push_back({make_frame(at->position, at->normal, heading), at->triangle});
    }
    return path;
}

// A disc of `texels` across with a soft rim.
footprint::Footprint disc(const stroke::Model& model, int texels, const Step& at) {
    footprint::Footprint f;
    const double texel = model.atlas.texel_size;
    f.frame = at.frame;
    f.triangle = at.triangle;
    f.cell = texel;
    f.width = f.height = texels + 4;
    f.lo = Vec2(-0.5 * f.width * texel);
    f.radius = 0.5 * (texels + 1) * texel;
    f.coverage.resize(static_cast<std::size_t>(f.width) * f.height);
    for (int j = 0; j < f.height; ++j)
        for (int i = 0; i < f.width; ++i) {
            const double r = std::hypot(i + 0.5 - 0.5 * f.width, j + 0.5 - 0.5 * f.height);
            f.coverage[static_cast<std::size_t>(j) * f.width + i] =
                static_cast<std::uint8_t>(255 * std::clamp(0.5 + 0.5 * texels - r, 0.0, 1.0));
        }
    return f;
}

// Deposit alone: planning, evaluating and inking one stamp after the other along the path.
double microseconds_per_stamp(const stroke::Model& model, int texels, int stamps, footprint::Isa isa,
                              std::span<const char* const> inks) {
    ink::Canvas canvas(model.texels.n_slots());
    ink::DepositParams params;
    for (const char* name : inks) {  // in equal parts
        const ink::Ink ink = ink::load_ink(name);
        const ink::Mix mix = ink::mix_of(canvas, ink);
        const auto part = 1 / static_cast<float>(inks.size());
        for (std::size_t p = 0; p < mix.size(); ++p) params.mix[p] += part * mix[p];
        params.extinction += part * ink::extinction_of(ink);
    }
    const footprint::StampOptions options{.isa = isa};
    footprint::PlanScratch scratch;
    const footprint::Surface surface = model.surface();
    alignas(64) std::array<float, atlas::kTileTexels> exposure;
    footprint::Unpacked unpacked;
    std::vector<footprint::Footprint> path;
    for (const Step& at : path_over(model, stamps)) path.push_back(disc(model, texels, at));
    std::vector<double> runs;
    footprint::StampJobs jobs;
    for (int repeat = 0; repeat < 7; ++repeat) {
        bool piecewise = false;
        const double start = cpu_seconds();
        for (const footprint::Footprint& f : path) {
            jobs = footprint::plan_stamp(surface, f, {}, options, scratch, std::move(jobs));
            piecewise = footprint::choose_mode(jobs, piecewise, options);
            const ink::DepositLaw law = ink::deposit_law(params, model.atlas.texel_size);
            for (const footprint::TileJob& job : jobs.tiles) {
                const atlas::TexelTile& tile = model.texels.tiles[job.slot];
                if (footprint::evaluate_tile(model.texels, jobs, job, unpacked, exposure))
                    ink::deposit(canvas, job.slot, exposure, tile.area, params, law);
            }
        }
        runs.push_back((cpu_seconds() - start) / stamps * 1e6);
    }
    return quantile(runs, 0.5);
}

double footprint_texels(int texels) {
    return pi / 4 * texels * texels;
}

// The whole path: a brush as thick as makes lines of about `texels` across, dragged along
// the path; hand samples at 1 kHz and a stamp per texel.
stroke::PaintStroke drag(const stroke::Model& model, stroke::Document& painting, int texels,
                         const char* brush = "mixed-medium") {
    brush::Preset preset = brush::load_preset(brush);
    const double scale = texels * model.atlas.texel_size / brush::tuft_width(preset);
    preset.name = "bench";
    preset.length *= scale;
    preset.radius *= scale;
    preset.width *= scale;
    preset.stiffness *= std::pow(scale, 4);
    preset.capacity = 1e-4;
    painting.use(preset);
    stroke::PaintStroke s;
    s.trace.flat = false;
    s.brush = "bench";
    s.ink = "carbon";
    const std::vector<Step> path = path_over(model, 401);
    const int reach = texels / 2;
    for (int i = 0; i <= 400; ++i) {
        // The hand keeps to the mean of the normals over the width of the line.
        Vec3 n{0};
        for (int k = std::max(0, i - reach); k <= std::min(400, i + reach); ++k) n += path[k].frame.n;
        n = glm::length(n) > 0 ? glm::normalize(n) : path[i].frame.n;
        const double press = std::min(1.0, i / 60.0) * 0.25 * preset.length;
        stroke::StrokeSample p;
        p.time = i * 1e-3;
        p.position = path[i].frame.origin + (preset.length - press) * n;
        const Frame f = make_frame(Vec3{0}, n, glm::cross(n, path[i].frame.t));
        p.rotation = glm::quat_cast(Mat3(f.t, f.b, f.n));
        s.trace.samples.push_back(p);
    }
    return s;
}

// With `wiped` of its ink gone the tuft no longer closes: every one of its bristles is drawn and
// inked by itself.
double stamps_per_second(const stroke::Model& model, int texels, double wiped = 0, const char* brush = "mixed-medium") {
    stroke::Document painting(model);
    stroke::PaintStroke s = drag(model, painting, texels, brush);
    const stroke::BrushAction wipe{
        .kind = stroke::BrushActionKind::wipe, .brush = s.brush, .ink = s.ink, .extent = {.amount = wiped}};
    if (wiped > 0) s.settings.dip = stroke::DipMode::persistent;
    std::vector<double> runs;
    for (int repeat = 0; repeat < 5; ++repeat) {
        if (wiped > 0) painting.paint(wipe);
        const double start = cpu_seconds();
        const stroke::StrokeReport report = painting.paint(s);
        runs.push_back(static_cast<double>(report.stamps) / (cpu_seconds() - start));
    }
    return quantile(runs, 0.5);
}

// From the sample at which the tuft first touches to ink on the texels, in a painting that has
// just been opened: milliseconds of wall time for all that is computed between.
double first_ink_milliseconds(const stroke::Model& model, int texels) {
    std::vector<double> runs;
    for (int repeat = 0; repeat < 5; ++repeat) {
        stroke::Document painting(model);
        stroke::PaintStroke s = drag(model, painting, texels);
        const std::vector<brush::Pose> poses = stroke::spatial_poses(s.trace);
        s.trace.samples.clear();
        const double start = wall_seconds();
        painting.begin(s);
        for (std::size_t i = 0; i < poses.size() && painting.appearance().take_dirty().empty(); ++i)
            painting.extend(std::span(&poses[i], 1));
        runs.push_back((wall_seconds() - start) * 1e3);
    }
    return quantile(runs, 0.5);
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
        const double start = cpu_seconds();
        for (std::size_t tile = 0; tile < 16; ++tile) {
            ink::TileFilm film;
            for (std::size_t p = 0; p < 4; ++p) film.pigments[p] = &planes[4 * tile + p];
            const std::vector<ink::TileFilm> stack(static_cast<std::size_t>(films), film);
            sink += ink::shade_films(stack, nullptr, pigments, substrate).colour[0][tile];
        }
        runs.push_back((cpu_seconds() - start) * 1e6);
    }
    return sink < 0 ? 0 : quantile(runs, 0.5);
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
            const double start = cpu_seconds();
            brush::step(tuft, pose, std::span(&plane, 1), 1e-3);
            times.push_back((cpu_seconds() - start) * 1e6);
            sum += times.back();
        }
        means.push_back(sum / kSolves);
    }
    const auto [lo, hi] = std::minmax_element(means.begin(), means.end());
    const double spread = 0.5 * (*hi - *lo);
    return {quantile(means, 0.5), spread, quantile(times, 0.5), quantile(times, 0.99)};
}

std::string cpu_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

struct Case {
    std::string name;
    stroke::Model model;
    double atlas_seconds = 0, map_seconds = 0, graph_seconds = 0;
};

/// Wall time of the two phases, from the progress that they report.
ProgressFn timed(const ProgressFn& progress, double& map_seconds, double& graph_seconds) {
    return [&map_seconds, &graph_seconds, progress](std::string_view phase, double fraction) {
        double* const seconds = phase == "texel map"       ? &map_seconds
                                : phase == "cluster graph" ? &graph_seconds
                                                           : nullptr;
        if (seconds && fraction == 0) *seconds = -wall_seconds();
        if (seconds && fraction == 1) *seconds += wall_seconds();
        return !progress || progress(phase, fraction);
    };
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
std::vector<Case> make_cases(const Bench& a, std::uint32_t size, Console& console) {
    std::vector<Case> cases;
    const auto add = [&](std::string name, mesh::PolygonSoup soup) {
        stroke::ModelOptions options = model_options(a.surface, console);
        options.unwrap.size = size;
        options.repair.metres_per_unit = metres_per_unit(soup);
        Case c{.name = std::move(name)};
        set_thread_count(0);  // as a user waits for it
        options.progress = timed(console.progress(), c.map_seconds, c.graph_seconds);
        c.model = stroke::prepare_model(std::move(soup), options);
        set_thread_count(1);
        for (const auto& [phase, seconds] : c.model.atlas_report.seconds) c.atlas_seconds += seconds;
        cases.push_back(std::move(c));
    };
    if (!a.model.empty()) {
        add(a.model.stem().string(), io::read_model(a.model, cad_reading(a.model, a.surface)));
    } else {
        add("sphere-100k", sphere(158));
        if (!a.quick) add("sphere-1M", sphere(500));
    }
    return cases;
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
nlohmann::json measure_model(Case& c, footprint::Isa isa, double square, Console& console) {
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
    m["ns_per_texel"]["film_step"] = film.step_ns;
    m["ns_per_texel"]["transfer"] = film.transfer_ns;
    if (film.steps_per_second > 0) m["film_steps_per_second"] = film.steps_per_second;
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
    fmt::print("  wet ink with four pigments: {:.1f} ns a texel and step, {:.1f} both ways under the brush",
               m["ns_per_texel"]["film_step"].get<double>(), m["ns_per_texel"]["transfer"].get<double>());
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

}  // namespace

int run(const Bench& a) {
    Console console(a.common.quiet);
    set_thread_count(1);
    const std::uint32_t size = a.surface.atlas_size > 0 ? a.surface.atlas_size : a.quick ? 2048 : 4096;
    const footprint::Isa isa = std::min(isa_of(a.isa), footprint::best_isa());
    std::vector<Case> cases = make_cases(a, size, console);
    nlohmann::json j = measure_parts();
    for (Case& c : cases) {
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
    console.clear();
    if (a.common.json)
        print_json(j);
    else
        print_figures(j);
    return 0;
}

}  // namespace tuft::cli
