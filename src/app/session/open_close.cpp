#include "app/session/open_close.h"

#include <map>

#include "app/session/open_files.h"
#include "app/session/settings_file.h"
#include "core/text/units.h"
#include "io/model/read_model.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

std::unique_ptr<PaintThread> start_paint_thread(SessionNote& note, PaintWork work) {
    const fs::path project = work.autosave.path();
    if (project.empty() || work.autosave.viewing())
        note.clear();  // it is in memory only, or another program's
    else
        note.write(project, work.source);
    if (!project.empty() && !is_unnamed(project)) remember_project(project);
    work.spare = note.new_project(fs::path(work.source).stem().string());
    return std::make_unique<PaintThread>(std::move(work));
}

// Saves what is in work and ends the paint thread. Returns the file that the work is in.
fs::path finish_work(Session& s) {
    fs::path project = s.reported.file.project;
    Message& failure = s.project.closing.failure;
    failure = {};
    if (const fs::path spare = s.paint_thread->finish(); !spare.empty()) {
        failure = Message("{} could not be written; the work is in {} and is offered at the next start",
                          project.string(), spare.string());
        s.project.recovery.note.write(spare, s.paint_thread->source());
        remember_project(spare);
        project = spare;
    } else if (s.paint_thread->unsaved()) {
        failure =
            Message("{} could not be written, and nothing else either: the last strokes are lost", project.string());
    }
    s.paint_thread.reset();
    return project;
}

// What the parts hold of the model that is closed.
void forget_model(Session& s) {
    const bool swipe = s.journal.snapshots.swipe;
    s.journal = {};
    s.journal.snapshots.swipe = swipe;
    for (ReferenceImage& image : s.view.references.images) release(image.texture);
    s.view.references.images.clear();
    s.view.tuft.state = {};
    s.project.revision.mismatches.clear();
    s.project.revision.previous.clear();
    s.dialogs.show_mismatches = s.panels.show_appearance = false;
    s.masks.active = s.masks.veiled = s.masks.last_next_id = 0;
    s.masks.lasso.clear();
    s.layers.last_next_id = s.layers.removed = 0;
    s.layers.active_before.clear();
    s.colours.own.clear();
    s.colours.palette.shown = false;
    s.colours.palette.picture = {};
    s.colours.palette.fresh = true;
    s.tools.curve = {};
    s.tools.lettering.curve.clear();
    s.tools.place.lines.reset();
    s.tools.place.lines_of.reset();
    s.tools.lettering.kept.clear();
}

// A model was looked at: the dialog proposes unit and texels.
void take_inspected(ProjectState& project, Inspected inspected, const PaintThread* work) {
    const mesh::MeshSummary& m = inspected.summary;
    const bool revises = !project.revision.source.empty();
    FileFrame& frame = project.options.frame;
    if (inspected.path == std::exchange(project.options.framed, inspected.path)) {  // read anew with other options
        project.inspected = std::move(inspected);
        return;
    }
    // A revised file has the unit of the one before, where that stated none or a wrong one.
    const bool keeps = revises && work && (work->frame().unit_overrides || !io::states_unit(work->source()));
    if (!keeps) frame.unit = m.unit.unit;
    frame.unit_overrides = keeps && work->frame().unit_overrides && io::overrides_unit(inspected.soup, frame.unit);
    if (inspected.unit_stated() && !frame.unit_overrides) frame.unit = "m";
    if (!revises) {
        const double factor = inspected.metres_per_unit(frame) / m.metres_per_unit;
        project.options.atlas_size = proposed_size(m.area * factor * factor);
        project.options.turned_round = false;
        frame.y_up = false;
    }
    project.inspected = std::move(inspected);
}

}  // namespace

void open_path(Session& s, const fs::path& path) {
    if (path.extension() == ".toml") return open_brush_or_ink(s, path);
    if (const std::string e = path.extension().string(); e == ".svg" || e == ".inkml") return open_writing(s, path);
    if (const std::string e = lower(path.extension().string());
        e == ".png" || e == ".jpg" || e == ".jpeg" || e == ".tif" || e == ".tiff")
        return pin_reference(s, path);
    if (has_unsaved_work(s)) return request_close(s, {CloseRequest::Then::open, path});
    s.project.start_page.pictures.pause();
    s.project.in_use.reset();
    s.project.inspected.reset();
    s.project.is_sample = false;
    s.project.revision.source.clear();
    s.dialogs.file.close();
    std::error_code ec;
    if (fs::is_regular_file(path, ec) && (path.extension() == ".tuft" || io::is_project(path))) {
        s.project.opening.load(path, s.project.recovery.note.new_project(path.stem().string()));
    } else {
        s.project.options.cad = {};
        s.project.options.framed.clear();
        s.project.opening.inspect(path);
    }
}

void open_sample(Session& s, const fs::path& path) {
    open_path(s, path);
    s.project.is_sample = true;
}

void open_in_use(Session& s, OpenAs as) {
    if (!s.project.in_use) return;
    const fs::path project = s.project.in_use->project;
    s.project.in_use.reset();
    s.project.opening.load(project, s.project.recovery.note.new_project(project.stem().string()), as);
}

void accept_inspected(Session& s) {
    if (!s.project.inspected) return;
    const fs::path project = s.project.recovery.note.new_project(s.project.inspected->path.stem().string());
    if (s.project.revision.source.empty())
        s.project.opening.prepare(std::move(*s.project.inspected), s.project.options, project);
    else
        s.project.opening.revise(std::move(*s.project.inspected), s.project.options, s.project.revision.source,
                                 project);
    s.project.inspected.reset();
}

namespace {

// How the model moved, which nothing else says where all strokes fit; else that the former project is safe.
Message revision_note(const Revision& revision) {
    if (revision.fit.size() > 1) return revision.fit[1];
    return Message("The strokes are painted on the revised model; the former project is as it was.");
}

// A model or project is ready: it takes the place of the open one.
void take_work(Session& s, PaintWork work) {
    Revision& revision = s.project.revision;
    const fs::path source = revision.source;
    Revision next{.previous = source, .mismatches = std::move(work.mismatches), .fit = std::move(work.fit)};
    // Unnamed work that is left for other work is offered again at the next start.
    if (s.paint_thread && !s.journal.lines.empty() && is_unnamed(s.reported.file.project))
        remember_project(s.reported.file.project);
    Message note = std::move(work.note);
    const std::optional<stroke::ModelMotion> motion = work.motion;
    close_model(s);
    if (!s.project.closing.failure.empty()) note = s.project.closing.failure;
    s.paint_thread = start_paint_thread(s.project.recovery.note, std::move(work));
    s.reported = {};
    s.view.texels = {};
    if (!find_ink(s.colours, s.brush.ink)) s.brush.ink = "carbon";
    s.view.model_changed = true;
    s.view.keep_camera = !source.empty();
    for (const io::Attachment& image : s.paint_thread->carried_references())
        s.view.references.images.push_back(from_attachment(image));
    for (const io::Attachment& copy : s.paint_thread->carried_copies())
        s.tools.lettering.kept.push_back(kept_copy(copy));
    HelpState& help = s.panels.help;
    if (help.by_itself && !help.seen && help.step < 0) start_guide(help);
    const Box& bounds = s.paint_thread->model().mesh->bounds;
    s.tools.symmetry.centre = bounds.centre();
    s.tools.lettering.side = 0;
    if (s.view.keep_camera) s.view.orbit.follow(motion, bounds);
    revision = std::move(next);
    show_message(s.status, source.empty() ? note : revision_note(revision));
    s.dialogs.show_mismatches = !revision.mismatches.empty();
}

}  // namespace

bool poll_opening(Session& s) {
    Opening::Result result = s.project.opening.poll();
    if (!result.error.empty()) show_message(s.status, result.error);
    if (result.in_use) s.project.in_use = std::move(result.in_use);
    if (result.inspected) {
        take_inspected(s.project, std::move(*result.inspected), s.paint_thread.get());
        if (s.project.is_sample) accept_inspected(s);
    }
    if (result.work) take_work(s, std::move(*result.work));
    return result.work.has_value();
}

void revise_with(Session& s, const fs::path& path) {
    if (!s.paint_thread) return;
    if (!s.reported.file.trouble.empty())
        return show_message(s.status, Message("The project must be on disk first: {}", s.reported.file.trouble));
    const OpenOptions same{.frame = s.paint_thread->frame(),
                           .atlas_size = s.paint_thread->model().atlas.size,
                           .substrate = s.project.options.substrate,
                           .own_colours = s.project.options.own_colours,
                           .turned_round = s.project.options.turned_round,
                           .follow = s.project.options.follow};
    const fs::path former = s.reported.file.project;
    open_path(s, path);
    s.project.options = same;
    s.project.revision.source = former;
}

void open_previous(Session& s) {
    if (const fs::path former = s.project.revision.previous; !former.empty()) open_path(s, former);
}

bool has_unsaved_work(const Session& s) {
    return s.paint_thread && (s.reported.file.unsaved > 0 || s.reported.file.behind);
}

void request_close(Session& s, CloseRequest request) {
    if (!has_unsaved_work(s)) return close_now(s, request);
    s.dialogs.file.close();
    s.project.closing.request = std::move(request);
    s.paint_thread->post(RetrySaving{});
}

void close_now(Session& s, const CloseRequest& request) {
    const CloseRequest now = request;
    s.project.closing.request.reset();
    if (now.then == CloseRequest::Then::quit) s.project.closing.quit = true;
    if (now.then == CloseRequest::Then::open || now.then == CloseRequest::Then::close) {
        close_model(s);
        s.project.start_page.recent = recent_projects();
        s.project.recovery.lost = find_lost_work();
    }
    if (now.then == CloseRequest::Then::open) open_path(s, now.file);
}

void close_model(Session& s) {
    if (!s.paint_thread) return;
    remember_brush(s.brush, s.paint_thread.get());
    finish_storing_copies(s);
    s.colours.choice.in_hand.reset();
    s.layers.list.pictures.clear();
    s.parts.chosen.clear();
    const bool drew = leave_arm(s.arm, s.paint_thread.get());
    const bool empty = !drew && s.journal.lines.empty() && s.paint_thread->idle(), viewing = s.reported.file.viewing;
    const fs::path project = finish_work(s);
    forget_model(s);
    if (empty && !viewing && is_unnamed(project)) {
        std::error_code ec;
        fs::remove(project, ec);
    }
    if (empty || viewing || !is_unnamed(project)) s.project.recovery.note.clear();
    if (!s.project.closing.failure.empty()) show_message(s.status, s.project.closing.failure);
}

void save_as(Session& s, const fs::path& path) {
    if (s.paint_thread) s.paint_thread->post(SaveProject{path});
}

std::string project_name(const PaintThread* work, const fs::path& project) {
    if (!work) return "";
    return project.empty() || is_unnamed(project) ? fs::path(work->source()).stem().string() : project.stem().string();
}

}  // namespace tuft::app
