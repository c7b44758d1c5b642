#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/text/counted.h"
#include "core/text/units.h"
#include "io/motion/motion_files.h"
#include "io/project/restore.h"
#include "stroke/gesture/hand.h"
#include "stroke/journal/recorded_journal.h"

/// `tuft trajectory`: the strokes of a project as motions of a robot or plotter.
namespace tuft::cli {
namespace {

io::MotionFrame frame_of(const std::vector<double>& v) {
    const double a = kDegree * v[3], b = kDegree * v[4], c = kDegree * v[5];
    const Quat z = glm::angleAxis(c, Vec3(0, 0, 1)), y = glm::angleAxis(b, Vec3(0, 1, 0)),
               x = glm::angleAxis(a, Vec3(1, 0, 0));
    return {kMillimetre * Vec3(v[0], v[1], v[2]), glm::normalize(z * y * x)};
}

/// The force at a time of the stroke, linear between samples.
Vec3 force_at(const std::vector<stroke::ForceRecord>& forces, double time) {
    if (forces.empty()) return Vec3(0);
    const auto after = std::lower_bound(forces.begin(), forces.end(), time,
                                        [](const stroke::ForceRecord& f, double t) { return f.pose.time < t; });
    if (after == forces.begin()) return after->force;
    if (after == forces.end()) return forces.back().force;
    const stroke::ForceRecord &a = *(after - 1), &b = *after;
    const double span = b.pose.time - a.pose.time;
    return span > 0 ? a.force + (time - a.pose.time) / span * (b.force - a.force) : b.force;
}

/// The poses of a stroke as the document leads the brush.
std::vector<brush::Pose> poses_of(const stroke::PaintStroke& s, const stroke::Document& painting) {
    if (!s.trace.flat) {
        std::vector<brush::Pose> poses = stroke::spatial_poses(s.trace);
        stroke::GestureFilter state;
        for (brush::Pose& pose : poses) pose = stroke::steady(state, pose, s.settings);
        return poses;
    }
    const mesh::SurfaceQuery& query = *painting.model().query;
    return stroke::hand_path(query, stroke::steady(s.trace, s.settings),
                             painting.materials().holder(s.brush, query.mesh(), s.settings.compensate_tip_lag))
        .poses;
}

/// Strokes on the model, with what each is painted with.
struct Painted {
    std::vector<motion::StrokePath> paths;
    std::vector<stroke::RecordedStroke> strokes;
    std::size_t within_stencils = 0;
    std::size_t left_out = 0;  ///< entries that no robot performs: fills, layers, masks, the palette
};

Painted paint_strokes(const std::vector<stroke::JournalEntry>& entries, stroke::Document& painting, Console& console) {
    std::map<std::uint64_t, stroke::StrokeReport> reports;
    for (stroke::StrokeReport& report : painting.replay(entries, console.progress()))
        reports[report.stroke_id] = std::move(report);
    Painted painted;
    std::vector<stroke::Preparation> before;
    for (const stroke::JournalEntry& entry : painting.journal().entries()) {
        if (entry.hidden) continue;
        const auto* s = entry.as<stroke::PaintStroke>();
        const stroke::RecordedJournal recorded = stroke::record({&entry, 1});
        if (!s || stroke::on_palette(entry)) {
            if (const auto* action = entry.as<stroke::BrushAction>())
                before.emplace_back(*action);
            else if (const auto* dry = entry.as<stroke::Dry>())
                before.emplace_back(*dry);
            else
                ++painted.left_out;
            continue;
        }
        stroke::RecordedStroke own = recorded.strokes.empty() ? stroke::RecordedStroke{} : recorded.strokes.back();
        if (const stroke::Layer* layer = painting.layers().table().find(s->layer)) own.names.layer = layer->name;
        if (const stroke::Mask* mask = painting.masks().table().find(s->mask)) own.names.mask = mask->name;
        own.before = std::exchange(before, {});
        own.samples.clear();
        if (own.settings) own.settings->smooth = own.settings->stabilise = 0;  // the poses are steadied
        painted.within_stencils += !s->trace.stencil.empty();
        const brush::Preset& preset = painting.materials().brush(s->brush);
        motion::StrokePath path{.id = entry.id,
                                .label = entry.label,
                                .points = {},
                                .tuft_length = preset.length,
                                .tuft_radius = std::max(preset.radius, 0.5 * preset.width)};
        for (const brush::Pose& pose : poses_of(*s, painting))
            path.points.push_back({pose, force_at(reports[entry.id].forces, pose.time)});
        painted.paths.push_back(std::move(path));
        painted.strokes.push_back(std::move(own));
    }
    return painted;
}

/// Stands the holders upright for a plotter, and says so.
void make_upright(std::vector<motion::StrokePath>& strokes, Console& console) {
    constexpr double kSaid = 1 * kDegree;
    std::size_t leaning = 0;
    double most = 0;
    for (motion::StrokePath& stroke : strokes) {
        const double lean = motion::make_upright(stroke);
        if (lean < kSaid || lean > motion::kMostStraightened) continue;
        ++leaning;
        most = std::max(most, lean);
    }
    if (leaning > 0)
        console.note(
            fmt::format("warning: G-code holds the brush upright: leans of up to {} degrees in {} are left out",
                        std::lround(most / kDegree), counted(leaning, "stroke")));
}

}  // namespace

int run(const TrajectoryWork& a) {
    check_extension(a.output, {".json", ".csv", ".urscript", ".script", ".mod", ".src", ".gcode", ".nc"});
    check_output(a.output);
    Console console(a.common.quiet);
    const auto project = open_project(a.project, io::Access::read, console);
    stroke::Document painting(project->model, {.record_forces = true});
    painting.use(project->substrate);
    io::use_presets(project->file, painting);
    const std::vector<stroke::JournalEntry> entries = project->file.strokes();
    find_presets(painting, entries);
    Painted painted = paint_strokes(entries, painting, console);
    if (painted.paths.empty()) {
        const bool filled = std::any_of(entries.begin(), entries.end(), [](const stroke::JournalEntry& entry) {
            return entry.as<stroke::Fill>() != nullptr;
        });
        throw Error(a.project.string(), filled
                                            ? "there are no strokes to make a trajectory of, only filled areas; paint "
                                              "a drawing with --areas brush to have it in strokes"
                                            : "there are no strokes to make a trajectory of");
    }
    if (painted.left_out > 0)
        console.note(fmt::format("warning: {} that no robot performs are left out (fills, layers, masks, the palette)",
                                 counted(painted.left_out, "change")));
    if (painted.within_stencils > 0)
        console.note(
            fmt::format("warning: {} of {} are painted within stencils, which a trajectory does not hold: without "
                        "masking tape their ink goes over the edges of filled shapes",
                        painted.within_stencils, counted(painted.strokes.size(), "stroke")));
    if (io::is_gcode(a.output)) make_upright(painted.paths, console);
    io::MotionProgram program;
    program.limits = {a.max_speed_mm / 1000, a.max_acceleration_mm / 1000, kDegree * a.max_turn_deg};
    program.trajectory = motion::plan(*project->model.query, painted.paths,
                                      {.limits = program.limits,
                                       .holder = {0.5e-3 * a.holder_mm[0], 1e-3 * a.holder_mm[1]},
                                       .clearance = 1e-3 * a.clearance_mm});
    program.strokes = std::move(painted.strokes);
    program.base = frame_of(a.base);
    program.tool = frame_of(a.tool);
    program.title = io::program_title(a.output);
    io::write_trajectory(a.output, program);
    console.clear();
    std::size_t points = 0;
    double force = 0;
    for (const motion::Move& move : program.trajectory.moves) {
        points += move.points.size();
        for (const motion::Waypoint& p : move.points) force = std::max(force, glm::length(p.force));
    }
    if (a.common.json)
        print_json(nlohmann::json{{"project", a.project.string()},
                                  {"wrote", a.output.string()},
                                  {"strokes", program.strokes.size()},
                                  {"moves", program.trajectory.moves.size()},
                                  {"points", points},
                                  {"seconds", program.trajectory.seconds()},
                                  {"largest_force_n", force}});
    else
        fmt::print("{}, {} points, {:.1f} s, at most {:.3f} N\nwrote {}\n", counted(program.strokes.size(), "stroke"),
                   points, program.trajectory.seconds(), force, a.output.string());
    return 0;
}

}  // namespace tuft::cli
