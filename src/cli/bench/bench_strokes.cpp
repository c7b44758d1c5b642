#include "cli/bench/bench_strokes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brush/tuft/tuft.h"
#include "core/system/clock.h"
#include "core/system/cpu_time.h"
#include "core/text/units.h"
#include "footprint/stamp/plan_scratch.h"
#include "ink/exchange/deposit.h"

namespace tuft::cli {
namespace {

using std::numbers::pi;

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
std::vector<Step> path_over(const stroke::Model& model, int n, double turn = 0, double height = 0) {
    const Box& box = model.mesh->bounds;
    const Vec3 ahead{-std::sin(0.3 + turn), std::cos(0.3 + turn), 0};
    const Vec3 out{std::cos(height) * ahead.y, -std::cos(height) * ahead.x, std::sin(height)};
    const auto hit = model.query->ray(box.centre() + box.diagonal() * out, -glm::normalize(out));
    auto at = hit ? hit : model.query->closest_point(box.centre() + box.diagonal() * out);
    const double texel = model.atlas.texel_size;
    std::vector<Step> path{{make_frame(at->position, at->normal, ahead), at->triangle}};
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

/// Wall time of the two phases, from the progress that they report.
ProgressFn timed(const ProgressFn& progress, MeasuredModel& m) {
    return [&m, progress](std::string_view phase, double fraction) {
        double* const seconds = phase == "texel map"       ? &m.map_seconds
                                : phase == "cluster graph" ? &m.graph_seconds
                                                           : nullptr;
        if (seconds && fraction == 0) *seconds = -wall_seconds();
        if (seconds && fraction == 1) *seconds += wall_seconds();
        return !progress || progress(phase, fraction);
    };
}

}  // namespace

double wall_seconds() {
    return clock_seconds();
}

double quantile_of(std::vector<double> values, double q) {
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

MeasuredModel prepare_measured(std::string name, mesh::PolygonSoup soup, stroke::ModelOptions options) {
    MeasuredModel m{.name = std::move(name)};
    options.repair.metres_per_unit = metres_per_unit(soup);
    options.progress = timed(options.progress, m);
    const double start = wall_seconds();
    m.model = stroke::prepare_model(std::move(soup), options);
    m.all_seconds = wall_seconds() - start;
    for (const auto& [phase, seconds] : m.model.atlas_report.seconds) m.atlas_seconds += seconds;
    m.repair_seconds = std::max(0.0, m.all_seconds - m.atlas_seconds - m.map_seconds - m.graph_seconds);
    return m;
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
        const double start = thread_cpu_seconds();
        for (const footprint::Footprint& f : path) {
            jobs = footprint::plan_stamp(surface, f, {}, options, {scratch, std::move(jobs)});
            piecewise = footprint::choose_mode(jobs, piecewise, options);
            const ink::DepositLaw law = ink::deposit_law(params, model.atlas.texel_size);
            for (const footprint::TileJob& job : jobs.tiles) {
                const atlas::TexelTile& tile = model.texels.tiles[job.slot];
                if (footprint::evaluate_tile(model.texels, jobs, job, unpacked, exposure))
                    ink::deposit(canvas, {job.slot, exposure, tile.area}, params, law);
            }
        }
        runs.push_back((thread_cpu_seconds() - start) / stamps * 1e6);
    }
    return quantile_of(runs, 0.5);
}

double footprint_texels(int texels) {
    return pi / 4 * texels * texels;
}

brush::Preset dragged_brush(const stroke::Model& model, const Drag& drag) {
    brush::Preset preset = brush::load_preset(drag.brush);
    const double scale = drag.texels * model.atlas.texel_size / brush::tuft_width(preset);
    preset.name = "bench";
    preset.length *= scale;
    preset.radius *= scale;
    preset.width *= scale;
    preset.stiffness *= std::pow(scale, 4);
    preset.capacity = 1e-4;
    return preset;
}

stroke::PaintStroke dragged(const stroke::Model& model, const Drag& drag) {
    const double length = dragged_brush(model, drag).length;
    stroke::PaintStroke s;
    s.trace.flat = false;
    s.brush = "bench";
    s.ink = "carbon";
    const int last = drag.samples - 1, reach = drag.texels / 2;
    const std::vector<Step> path = path_over(model, drag.samples, drag.turn, drag.height);
    for (int i = 0; i <= last; ++i) {
        // The hand keeps to the mean of the normals over the width of the line.
        Vec3 n{0};
        for (int k = std::max(0, i - reach); k <= std::min(last, i + reach); ++k) n += path[k].frame.n;
        n = glm::length(n) > 0 ? glm::normalize(n) : path[i].frame.n;
        const double press = std::min(1.0, i / 60.0) * 0.25 * length;
        stroke::StrokeSample p;
        p.time = i * 1e-3;
        p.position = path[i].frame.origin + (length - press) * n;
        const Frame f = make_frame(Vec3{0}, n, glm::cross(n, path[i].frame.t));
        p.rotation = glm::quat_cast(Mat3(f.t, f.b, f.n));
        s.trace.samples.push_back(p);
    }
    return s;
}

// With `wiped` of its ink gone the tuft no longer closes: every one of its bristles is drawn and
// inked by itself.
double stamps_per_second(const stroke::Model& model, int texels, double wiped, const char* brush, int repeats) {
    stroke::Document painting(model);
    const Drag drag{.texels = texels, .brush = brush};
    painting.use(dragged_brush(model, drag));
    stroke::PaintStroke s = dragged(model, drag);
    const stroke::BrushAction wipe{.what = stroke::Wipe{.amount = wiped}, .brush = s.brush, .ink = s.ink};
    if (wiped > 0) s.settings.dip = stroke::DipMode::persistent;
    std::vector<double> runs;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        if (wiped > 0) painting.paint(wipe);
        const double start = thread_cpu_seconds();
        const stroke::StrokeReport report = painting.paint(s);
        runs.push_back(static_cast<double>(report.stamps) / (thread_cpu_seconds() - start));
    }
    return quantile_of(runs, 0.5);
}

// From the sample at which the tuft first touches to ink on the texels, in a painting that has
// just been opened: milliseconds of wall time for all that is computed between.
double first_ink_milliseconds(const stroke::Model& model, int texels) {
    std::vector<double> runs;
    for (int repeat = 0; repeat < 5; ++repeat) {
        stroke::Document painting(model);
        painting.use(dragged_brush(model, {.texels = texels}));
        stroke::PaintStroke s = dragged(model, {.texels = texels});
        const std::vector<brush::Pose> poses = stroke::spatial_poses(s.trace);
        s.trace.samples.clear();
        const double start = wall_seconds();
        painting.begin(s);
        for (std::size_t i = 0; i < poses.size() && painting.appearance().take_dirty().empty(); ++i)
            painting.extend(std::span(&poses[i], 1));
        runs.push_back((wall_seconds() - start) * 1e3);
    }
    return quantile_of(runs, 0.5);
}

double hand_seconds(const stroke::Model& model, const Drag& drag) {
    constexpr std::size_t kAtOnce = 17;  // of a thousand a second
    stroke::Document painting(model);
    painting.use(dragged_brush(model, drag));
    stroke::PaintStroke begun = dragged(model, drag);
    const std::vector<brush::Pose> poses = stroke::spatial_poses(begun.trace);
    begun.trace.samples.clear();
    painting.begin(begun);
    std::vector<double> times;
    for (std::size_t i = 0; i < poses.size(); i += kAtOnce) {
        const double start = wall_seconds();
        painting.extend(std::span(poses).subspan(i, std::min(kAtOnce, poses.size() - i)));
        times.push_back(wall_seconds() - start);
    }
    painting.end();
    return quantile_of(times, 0.5);
}

}  // namespace tuft::cli
