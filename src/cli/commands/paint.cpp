#include "cli/commands/paint.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands/parts.h"
#include "cli/steps/commands.h"
#include "cli/steps/drawing.h"
#include "cli/steps/model_path.h"
#include "cli/steps/steps.h"
#include "core/files/files.h"
#include "core/text/counted.h"
#include "core/text/units.h"
#include "io/project/commit_queue.h"
#include "stroke/document/drawing_inks.h"
#include "stroke/document/fit.h"
#include "stroke/journal/tables.h"
#include "stroke/pointer/pointer_strokes.h"

namespace tuft::cli {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

nlohmann::json placed_json(const PlacedDrawing& p) {
    const Vec3 at = p.at / kMillimetre;
    nlohmann::json j{{"at_mm", {at.x, at.y, at.z}},
                     {"normal", {p.normal.x, p.normal.y, p.normal.z}},
                     {"width_mm", p.size.x / kMillimetre},
                     {"height_mm", p.size.y / kMillimetre}};
    if (!p.side.empty()) j["side"] = p.side;
    if (p.repeats > 0)
        j["repeats"] = p.repeats, j["step_mm"] = p.step / kMillimetre, j["path_mm"] = p.path / kMillimetre;
    if (p.part > 0) j["free_mm"] = {p.free.x / kMillimetre, p.free.y / kMillimetre}, j["part"] = p.part;
    return j;
}

std::string forces_csv(const std::vector<stroke::StrokeReport>& reports) {
    std::string csv =
        "stroke,time_s,x_m,y_m,z_m,qw,qx,qy,qz,force_x_N,force_y_N,force_z_N,"
        "hand_x_N,hand_y_N,hand_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,moment_Nm\n";
    for (const stroke::StrokeReport& report : reports)
        for (const stroke::ForceRecord& f : report.forces) {
            const brush::Pose& p = f.pose;
            csv += fmt::format("{},{:.6f},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", report.stroke_id, p.time,
                               p.position.x, p.position.y, p.position.z, p.rotation.w, p.rotation.x, p.rotation.y,
                               p.rotation.z);
            for (const Vec3& v : {f.force, f.device_force, f.torque})
                csv += fmt::format(",{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z);
            csv += fmt::format(",{:.6g}\n", f.moment);
        }
    return csv;
}

void write_forces(const std::vector<stroke::StrokeReport>& reports, const std::filesystem::path& file) {
    if (file.empty()) return;
    const std::string csv = forces_csv(reports);
    write_file(file, csv.data(), csv.size());
}

// What was painted: the journal from `first` on without actions, one entry per report.
std::vector<const stroke::JournalEntry*> painted_strokes(const stroke::Journal& journal, std::size_t first) {
    std::vector<const stroke::JournalEntry*> strokes;
    for (std::size_t i = first; i < journal.entries().size(); ++i)
        if (journal.entries()[i].as<stroke::PaintStroke>()) strokes.push_back(&journal.entries()[i]);
    return strokes;
}

// Warnings for strokes whose brush was full and ran out of ink.
void note_dry(const std::vector<stroke::StrokeReport>& reports, Console& console) {
    const auto dry = std::count_if(reports.begin(), reports.end(), [](const auto& r) { return r.ran_dry(); });
    if (dry == 0) return;
    const auto first = std::find_if(reports.begin(), reports.end(), [](const auto& r) { return r.ran_dry(); });
    console.note(
        fmt::format("warning: {} full brush{} run{} dry: stroke {} after {:.0f} of {:.0f} mm{} (see --dip "
                    "endless, a larger --brush; dry_from_mm of --json)",
                    dry, dry == 1 ? "" : "es", dry == 1 ? "s" : "", first->stroke_id, first->dryness.from / kMillimetre,
                    first->path / kMillimetre, dry == 1 ? "" : ", and others"));
}

std::string stroke_name(const stroke::StrokeReport& report, const stroke::JournalEntry& stroke) {
    const std::string& label = stroke.label;
    return fmt::format("stroke {}{}", report.stroke_id, label.empty() ? "" : " (" + label + ")");
}

// The strokes of whose reports there is a value, as one line: "stroke 3 (seal)", "43 strokes, from stroke 3 (seal)
// on,"; empty: none. `most` becomes the largest value of them.
template <typename Value>
std::string strokes_with(const std::vector<stroke::StrokeReport>& reports,
                         const std::vector<const stroke::JournalEntry*>& strokes, const Value& value_of, double& most) {
    std::size_t n = 0, first = 0;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        const std::optional<double> value = value_of(reports[i]);
        if (!value) continue;
        most = n == 0 ? *value : std::max(most, *value);
        if (n++ == 0) first = i;
    }
    if (n == 0) return {};
    const std::string name = stroke_name(reports[first], *strokes[first]);
    return n == 1 ? name : fmt::format("{} strokes, the first {},", n, name);
}

// Warnings for strokes that go into a closed body, in space or by their place.
void note_inside(const std::vector<stroke::StrokeReport>& reports,
                 const std::vector<const stroke::JournalEntry*>& strokes, const Box& model, Console& console) {
    const auto noted = [](double depth, double from) { return depth > from ? std::optional(depth) : std::nullopt; };
    double deepest = 0;
    if (const std::string which = strokes_with(
            reports, strokes, [&](const auto& r) { return noted(r.inside.origin, place_inside_noted(model)); },
            deepest);
        !which.empty())
        console.note(
            fmt::format("warning: the place of {} lies up to {:.2f} mm inside the model; strokes go onto its surface",
                        which, deepest / kMillimetre));
    if (const std::string which = strokes_with(
            reports, strokes, [&](const auto& r) { return noted(r.inside.deepest, kInsideNoted); }, deepest);
        !which.empty())
        console.note(
            fmt::format("warning: {} the ferrule into the model, up to {:.2f} mm deep; it is held on the surface there "
                        "(check the place, the unit and the pressure)",
                        which.ends_with(',') ? which + " take" : which + " takes", deepest / kMillimetre));
}

// Warnings for strokes that never met the model.
void note_misses(const std::vector<stroke::StrokeReport>& reports,
                 const std::vector<const stroke::JournalEntry*>& strokes, Console& console) {
    double farthest = 0;
    const std::string which = strokes_with(
        reports, strokes, [](const auto& r) { return r.touched() ? std::nullopt : std::optional(r.nearest); },
        farthest);
    if (which.empty()) return;
    console.note(fmt::format("warning: {} the model, up to {:.2f} mm away",
                             which.ends_with(',') ? which + " never touch" : which + " never touches",
                             farthest / kMillimetre));
}

}  // namespace

void prepare_strokes(std::vector<stroke::JournalEntry>& strokes, stroke::Document& painting, const Paint& a,
                     Console& console) {
    strokes = stroke::onto_named_layers(std::move(strokes), painting.layers().table(), a.stroke.layer);
    stroke::keep_to_named_masks(strokes, painting.masks().table(), a.stroke.mask);
    keep_clear_of_edges(strokes, painting.masks().table(), a);
    // Files are numbered from 1: each is a group of its own in this journal.
    const std::uint64_t first_group = painting.journal().next_group_id();
    for (stroke::JournalEntry& s : strokes)
        if (s.group.id != 0) s.group.id += first_group - 1;
    stroke::mix_drawing_inks(strokes, painting);
    find_presets(painting, strokes);
    note_inks(strokes, painting, console);
}

void check_sizes(const std::vector<stroke::JournalEntry>& strokes, stroke::Document& painting,
                 const stroke::Model& model, const Paint& a) {
    const auto length_of = [&](const std::string& brush) { return painting.materials().brush(brush).length; };
    if (const Message fault = stroke::size_fault(strokes, length_of, *model.query); !fault.empty())
        throw Error(a.model.string(), Message("{} (see --unit, --place-width, --brush)", fault));
    for (const stroke::JournalEntry& s : strokes) painting.check_size(s);
}

namespace {

/// Returns the project that the strokes go into: the one that was opened, a new one, or none.
std::optional<io::Project> output_project(const Paint& a, bool in_place, OpenProject* before, const FileFrame& frame,
                                          stroke::Document& painting,
                                          const std::vector<stroke::JournalEntry>& strokes) {
    std::optional<io::Project> project;
    if (in_place) {
        project = std::move(before->file);
        put_presets(*project, painting, strokes);
    } else if (!a.output.project.empty()) {
        std::vector<stroke::JournalEntry> all = painting.journal().entries();
        all.insert(all.end(), strokes.begin(), strokes.end());
        project = start_project(a.output.project, before ? before->source : a.model.string(), frame, painting, all);
        project->append(painting.journal().entries());
    }
    return project;
}

/// What painting gave, besides texels.
struct Painted {
    std::vector<stroke::StrokeReport> reports;      ///< of strokes
    std::vector<const stroke::JournalEntry*> done;  ///< the strokes themselves
    std::size_t areas = 0, areas_met = 0;
    double ink = 0;  ///< film units · m²
    std::size_t stamps = 0;
    double prepared = 0, first_stamp = 0, seconds = 0;  ///< s; the first two since the start
};

/// Paints the strokes, and commits each to `project` where there is one.
Painted paint_strokes(const std::vector<stroke::JournalEntry>& strokes, stroke::Document& painting,
                      std::optional<io::Project>& project, const Paint& a, Console& console, Clock::time_point start) {
    Painted out;
    const std::size_t n_before = painting.journal().entries().size();
    const auto painting_start = Clock::now();
    double area_ink = 0;
    const ProgressFn progress = console.progress();
    std::optional<io::CommitQueue> commits;
    if (project) commits.emplace(*project);
    const auto commit_all = [&] {
        if (!commits) return;
        commits->finish();
        commits.reset();
        project->listen(progress);
    };
    try {
        painting.paint(
            strokes,
            [&](const stroke::JournalEntry& entry, stroke::StrokeReport report) {
                if (const stroke::Fill* fill = entry.as<stroke::Fill>(); fill && fill->area)
                    ++out.areas, out.areas_met += report.met ? 1 : 0, area_ink += report.ink_given;
                if (entry.as<stroke::PaintStroke>()) out.reports.push_back(std::move(report));
                if (commits) commits->add(entry);
            },
            [&](std::string_view phase, double fraction) {
                if (out.first_stamp == 0) out.first_stamp = seconds_since(start);
                return progress(phase, fraction);
            });
        commit_all();
    } catch (const Cancelled&) {
        commit_all();
        if (project)
            console.note(fmt::format("{} holds the {} that {} finished", a.output.project.string(),
                                     counted(project->n_strokes(), "stroke"),
                                     project->n_strokes() == 1 ? "was" : "were"));
        throw;
    }
    if (project && !strokes.empty())
        project->save_canvases(stroke::all_canvases(painting), painting.journal().entries().back().id);
    out.seconds = seconds_since(painting_start);
    out.ink = area_ink;
    for (const auto& r : out.reports) out.stamps += r.stamps, out.ink += r.ink_given;
    out.done = painted_strokes(painting.journal(), n_before);
    console.clear();
    return out;
}

void note_missed_areas(const Painted& painted, const Paint& a, Console& console) {
    const std::size_t missed = painted.areas - painted.areas_met;
    if (missed == 0) return;
    const bool cut = edges_of(a) == stroke::AreaEdges::cut;
    console.note(fmt::format("warning: {} {} no texel of the model{}", counted(missed, "area"),
                             missed == 1 ? "covers" : "cover",
                             cut ? fmt::format(" that is connected with the middle of the drawing, where --edges {} "
                                               "begins (see --place, --edges facing)",
                                               a.place.edges)
                                 : ""));
}

bool is_masked_or_erases(const stroke::JournalEntry& entry) {
    if (const auto* s = entry.as<stroke::PaintStroke>()) return s->mask != 0 || s->erases();
    const auto* fill = entry.as<stroke::Fill>();
    return fill && fill->mask != 0;
}

// A note for a drawing all of which lies on locked parts. Masks take ink away, too: with them nothing is said.
void note_locked(const Painted& painted, const std::vector<stroke::JournalEntry>& strokes,
                 const stroke::PartTable& parts, Console& console) {
    const bool touched = painted.areas_met > 0 || std::ranges::any_of(painted.reports, &stroke::StrokeReport::touched);
    if (painted.ink > 0 || !touched || std::ranges::any_of(strokes, is_masked_or_erases)) return;
    std::vector<std::string> names;
    for (const stroke::Part& part : parts.parts)
        if (part.locked && !part.hidden) names.push_back(part.name);
    if (names.empty()) return;
    console.note(fmt::format("warning: all that the drawing meets is locked, so it leaves no ink (locked: {})",
                             fmt::join(names, ", ")));
}

void print_painted(const Painted& painted, const stroke::Model& model, const Paint& a) {
    const auto& [reports, done, areas, areas_met, ink, stamps, prepared, first_stamp, seconds] = painted;
    const std::string painted_areas = areas == 0 ? "" : counted(areas, "area");
    const std::string painted_strokes =
        reports.empty() && areas > 0 ? ""
                                     : fmt::format("{}{}", areas > 0 ? " and " : "", counted(reports.size(), "stroke"));
    const std::string stamped = reports.empty() && areas > 0 ? "" : counted(stamps, "stamp") + ", ";
    fmt::print("painted {}{} ({}{:.1f} mm3 of ink) in {:.2f} s; atlas {} x {}, {}, texel {:.3f} mm\n", painted_areas,
               painted_strokes, stamped, ink * ink::kFilmUnit * 1e9, seconds, model.atlas.size, model.atlas.size,
               counted(model.atlas.n_charts, "chart"), model.atlas.texel_size / kMillimetre);
    for (const auto& path : {a.output.project, a.output.exported, a.output.preview, a.output.forces})
        if (!path.empty()) fmt::print("wrote {}\n", path.string());
    std::fflush(stdout);
}

nlohmann::json painted_json(const Painted& painted, const stroke::Model& model) {
    nlohmann::json j;
    j["triangles"] = model.mesh->n_triangles();
    j["mesh"] = to_json(model.repairs);
    j["atlas"] = to_json(model.atlas, model.atlas_report);
    j["strokes"] = nlohmann::json::array();
    for (std::size_t i = 0; i < painted.reports.size(); ++i)
        j["strokes"].push_back(to_json(painted.reports[i], *painted.done[i]));
    j["areas"] = painted.areas;
    j["stamps"] = painted.stamps;
    j["ink_mm3"] = painted.ink * ink::kFilmUnit * 1e9;
    j["seconds"] = {
        {"to_first_stamp", painted.first_stamp}, {"preparing", painted.prepared}, {"painting", painted.seconds}};
    j["peak_mb"] = peak_megabytes();
    return j;
}

nlohmann::json result_json(const Painted& painted, const std::vector<stroke::JournalEntry>& strokes,
                           const stroke::Document& painting, const std::optional<PlacedDrawing>& placed) {
    nlohmann::json j = painted_json(painted, painting.model());
    if (placed) j["placed"] = placed_json(*placed);
    j["inks"] = inks_json(strokes, painting);
    j["canvas_hash"] = fmt::format("{:016x}", painting.layers().hash());
    return j;
}

Outputs checked_outputs(const Paint& a) {
    Outputs outputs{a.output.project, a.output.exported, a.output.preview, a.view, {}};
    check_outputs(outputs);
    check_output(a.output.forces);
    return outputs;
}

bool writes_into_its_project(const Paint& a) {
    std::error_code no_matter;
    return a.output.project.empty() || std::filesystem::equivalent(a.output.project, a.model, no_matter);
}

// What went otherwise than the person may think.
void note_painted(const Painted& painted, const std::vector<stroke::JournalEntry>& strokes,
                  const stroke::Document& painting, const stroke::Model& model, Console& console) {
    note_misses(painted.reports, painted.done, console);
    note_dry(painted.reports, console);
    note_locked(painted, strokes, painting.parts().table(), console);
    note_inside(painted.reports, painted.done, model.mesh->bounds, console);
}

}  // namespace

int run(const Paint& a) {
    return paint(a, {.load = [&](Console& console) { return load_strokes(a, console); },
                     .place = [&](std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                                  Console& console) -> std::optional<PlacedDrawing> {
                         if (!a.copies.along.empty()) return place_along(strokes, model, a, console);
                         return place_strokes(strokes, model, a, console);
                     }});
}

std::vector<stroke::JournalEntry> draw_with_pointer(const std::vector<stroke::JournalEntry>& strokes,
                                                    stroke::Document& painting, const mesh::SurfaceQuery& surface,
                                                    double pixel, Console& console) {
    std::vector<stroke::JournalEntry> out;
    std::size_t number = 0;
    for (const stroke::JournalEntry& entry : strokes) {
        const auto* flat = entry.as<stroke::PaintStroke>();
        number += flat != nullptr;
        if (!flat || !flat->trace.flat || !flat->trace.stencil.empty() || flat->layer == stroke::kPaletteLayer) {
            out.push_back(entry);
            continue;
        }
        const stroke::StrokeSettings& settings = flat->settings;
        const bool pen = flat->trace.pressed && settings.pressure == stroke::PressureFrom::none;
        const stroke::HolderOptions holder = painting.materials().holder(flat->brush, surface.mesh(), true);
        stroke::PointerInput pointer(surface, painting.materials().brush(flat->brush),
                                     stroke::pointer_settings(settings), {holder.tip_lag, holder.tip_lag_change});
        const std::vector<stroke::Aim> aims = stroke::aims_of(flat->trace, surface.mesh().bounds, pixel, pen);
        std::vector<stroke::StrokeSamples> drawn_traces = stroke::draw_with_pointer(std::move(pointer), aims);
        if (drawn_traces.empty())
            console.note(fmt::format("warning: stroke {}{} never aims at the front of the model and is left out",
                                     number, entry.label.empty() ? "" : " (" + entry.label + ")"));
        for (stroke::StrokeSamples& trace : drawn_traces) {
            stroke::PaintStroke drawn = *flat;
            drawn.trace = std::move(trace);
            // The poses have them already.
            drawn.settings.pressure = stroke::PressureFrom::none;
            drawn.settings.smooth = drawn.settings.stabilise = drawn.settings.roll = 0;
            drawn.settings.roll_follow = false;
            stroke::JournalEntry& next = out.emplace_back(entry);
            next.content = std::move(drawn);
            next.group = {};  // drawn by hand, each is a stroke of its own
        }
    }
    return out;
}

int paint(const Paint& a, const StrokeSource& source) {
    Outputs outputs = checked_outputs(a);
    Console console(a.common.quiet);
    const auto start = Clock::now();

    const bool goes_on = is_project_file(a.model), in_place = goes_on && writes_into_its_project(a);
    const auto reserved = in_place ? std::nullopt : reserve(a.output.project, console);
    const auto before = goes_on ? open_project(a.model, in_place ? io::Access::write : io::Access::read, console,
                                               model_cache(a.surface))
                                : nullptr;
    std::vector<stroke::JournalEntry> strokes = source.load(console);
    Surface surface = a.surface;
    if (const double texel = a.drawing.auto_texel ? texel_for_detail(strokes, a) : 0; texel > 0)
        surface.texel_size_mm = texel / kMillimetre;
    Loaded loaded = before ? Loaded{std::move(before->model), before->frame} : load_model(a.model, surface, console);
    stroke::Model model = std::move(loaded.model);
    outputs.frame = loaded.frame;
    const std::vector<stroke::JournalEntry> done =
        before ? before->file.strokes() : std::vector<stroke::JournalEntry>();
    stroke::PartTable parts = stroke::parts_after(done);
    const std::vector<stroke::PartEdit> edits = part_edits(a.parts, parts, *model.mesh);
    for (const stroke::PartEdit& edit : edits) stroke::apply(parts, edit);
    std::optional<VisibleParts> visible(std::in_place, model, parts);
    const std::optional<PlacedDrawing> placed = source.place(strokes, model, console);
    if (!a.view.directed) look_at_strokes(outputs.view, strokes, model);
    note_detail(strokes, model.atlas.texel_size, console);
    add_copies(strokes, model, a);
    visible.reset();
    strokes.insert(strokes.begin(), edits.begin(), edits.end());

    stroke::Document painting(model, {.substrate = a.surface.substrate,
                                      .record_forces = !a.output.forces.empty(),
                                      .tip_lags = tip_lag_cache(a.surface)});
    if (before) {
        restore(*before, painting, console);
        apply_recolouring(before->file, painting, {}, console);
    }
    const double prepared = seconds_since(start);
    prepare_strokes(strokes, painting, a, console);
    if (a.hand.as_pointer) {
        const VisibleParts shown(model, parts);
        strokes = draw_with_pointer(strokes, painting, *model.query, a.hand.pixel_mm * kMillimetre, console);
    }
    check_sizes(strokes, painting, model, a);
    if (const Message doubt = stroke::size_doubt(strokes, *model.query); !doubt.empty())
        console.note("warning: " + doubt.text() + " (see --unit, --place-width)");
    std::optional<io::Project> project = output_project(a, in_place, before.get(), outputs.frame, painting, strokes);
    Painted painted = paint_strokes(strokes, painting, project, a, console, start);
    painted.prepared = prepared;
    note_painted(painted, strokes, painting, model, console);
    note_missed_areas(painted, a, console);
    show_layers(painting, a.view.layers);
    write_outputs(outputs, painting, console);
    write_forces(painted.reports, a.output.forces);
    console.clear();
    if (!a.common.json) return print_painted(painted, model, a), 0;
    nlohmann::json j = result_json(painted, strokes, painting, placed);
    j["model"] = a.model.string();
    j["seconds"]["total"] = seconds_since(start);
    print_json(j);
    return 0;
}

}  // namespace tuft::cli
