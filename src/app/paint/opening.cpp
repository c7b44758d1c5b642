#include "app/paint/opening.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include "core/text/units.h"
#include "io/model/read_model.h"
#include "io/project/appearance.h"
#include "io/project/restore.h"
#include "stroke/drawing/follow_model.h"
#include "stroke/drawing/follow_names.h"

namespace fs = std::filesystem;

namespace tuft::app {

namespace {

// What a person reads while the modules below report, and how far that part is of the whole: as it takes for a model
// of 100,000 triangles that is looked at and unwrapped, and for a project.
struct Stage {
    std::string_view name;
    const char* title;
    double span[3][2];  ///< by `Job::Kind`
};
constexpr Stage kStages[] = {
    {"reading", "Reading the file", {{0, 0.6}, {0, 0.04}, {0, 0.1}}},
    {"welding", "Checking the mesh", {{0.6, 0.75}, {0.04, 0.06}, {0.1, 0.1}}},
    {"matching edges", "Checking the mesh", {{0.75, 0.85}, {0.06, 0.08}, {0.1, 0.1}}},
    {"building the surface", "Checking the mesh", {{0.85, 0.95}, {0.08, 0.1}, {0.1, 0.1}}},
    {"normals", "Checking the mesh", {{0.95, 1}, {0.1, 0.11}, {0.1, 0.1}}},
    {"charts", "Cutting it into charts", {{1, 1}, {0.11, 0.3}, {0.1, 0.1}}},
    {"merge", "Cutting it into charts", {{1, 1}, {0.3, 0.5}, {0.1, 0.1}}},
    {"cut to pack", "Laying the charts out", {{1, 1}, {0.5, 0.55}, {0.1, 0.1}}},
    {"pack", "Laying the charts out", {{1, 1}, {0.55, 0.75}, {0.1, 0.1}}},
    {"check", "Laying the charts out", {{1, 1}, {0.75, 0.76}, {0.1, 0.1}}},
    {"texel map", "Placing the texels", {{1, 1}, {0.76, 0.85}, {0.1, 0.3}}},
    {"cluster graph", "Placing the texels", {{1, 1}, {0.85, 0.9}, {0.3, 0.4}}},
    {"search tree", "Placing the texels", {{1, 1}, {0.9, 0.92}, {0.4, 0.45}}},
    {"painting", "Painting the strokes", {{1, 1}, {0.92, 0.97}, {0.45, 0.95}}},
    {"picture of the ink", "Placing the texels", {{1, 1}, {0.97, 1}, {0.95, 1}}},
};

}  // namespace

struct Opening::Job {
    enum Kind { kLook, kUnwrap, kProject };
    std::thread thread;
    std::atomic<bool> stop{false}, done{false};
    std::mutex mutex;
    const char* phase = kStages[0].title;
    double fraction = 0;
    Kind kind = Job::kUnwrap;
    Result result;

    ProgressFn progress() {
        return [this](std::string_view name, double part) {
            const std::lock_guard lock(mutex);
            for (const Stage& stage : kStages)
                if (stage.name == name) {
                    const auto& [from, to] = stage.span[kind];
                    phase = stage.title;
                    // A step that is done again does not take the bar back.
                    fraction = std::max(fraction, from + (to - from) * std::clamp(part, 0.0, 1.0));
                }
            return !stop.load();
        };
    }
};

double Inspected::metres_per_unit(const FileFrame& frame) const {
    return io::metres_per_unit(soup, unit_stated() && !frame.unit_overrides ? "" : frame.unit).value_or(kMillimetre);
}

namespace {

Inspected inspect_file(const fs::path& path, const io::CadReading& cad, const ProgressFn& progress) {
    Inspected out;
    out.path = path;
    report(progress, "reading", 0);
    out.soup = io::read_model(path, cad);
    Box bounds;
    for (const Vec3& p : out.soup.points) bounds.add(p);
    const mesh::UnitGuess guess = mesh::guess_unit(bounds);
    mesh::RepairOptions repair;
    repair.metres_per_unit = io::metres_per_unit(out.soup).value_or(guess.metres_per_unit);
    repair.progress = progress;
    const mesh::Surface surface = mesh::build_surface(out.soup, repair);
    out.summary = mesh::summarise(surface, repair.metres_per_unit);
    out.summary.unit = guess;
    out.defects = mesh::describe_defects(surface.report);
    return out;
}

// Strokes of a former project, its presets and substrate, on the new model.
void copy_strokes(const fs::path& former, bool follow, PaintWork& work, const ProgressFn& progress) {
    const io::Project project = io::Project::open(former, {.access = io::Access::read, .progress = progress});
    work.document->use(ink::parse_substrate(project.model().substrate, former.string()));
    io::use_presets(project, *work.document);
    work.autosave.take_presets(project);
    work.autosave.take_attachments(project);
    mesh::TriangleMesh mesh = project.model().mesh;
    const stroke::NamedEntries named = stroke::follow_names(project.strokes(), mesh, *work.model->mesh);
    const std::vector<stroke::JournalEntry>& strokes = named.entries;
    const auto length_of = [&](const std::string& brush) { return work.document->materials().brush(brush).length; };
    const mesh::SurfaceQuery before(mesh);
    const Message fault = stroke::size_fault(strokes, length_of, before, *work.model->query);
    if (!fault.empty()) throw Error(fault);
    const stroke::ModelChange change = stroke::find_change(before, *work.model->query);
    const std::vector<stroke::JournalEntry> followed = follow ? stroke::follow_model(strokes, change, before) : strokes;
    const std::vector<stroke::StrokeReport> reports = work.document->replay(followed, progress);
    const std::vector<stroke::StrokeFit> fits =
        stroke::compare_fit(strokes, followed, length_of, {before, *work.model->query, change});
    work.mismatches = stroke::find_mismatches(reports, fits);
    work.motion = change.whole;
    work.fit = {Message("{}.", stroke::describe(stroke::total_of(fits, work.mismatches)))};
    work.fit.insert(work.fit.end(), named.notes.begin(), named.notes.end());
    if (const Message doubt = stroke::size_doubt(before, *work.model->query); !doubt.empty()) work.fit.push_back(doubt);
    if (change.whole) work.fit.push_back(Message("The revised model is the former one {}.", describe(*change.whole)));
    for (const stroke::PartMotion& part : change.parts)
        work.fit.push_back(Message("The part '{}' is {}.", part.name, describe(part.motion)));
}

// In a file from now on, or in memory until there can be one.
void keep(PaintWork& work, const fs::path& file) {
    const Message fault = work.autosave.start(file, work.source, work.frame, *work.document);
    if (!fault.empty())
        work.autosave.start_later(file, work.source, work.frame, fault, !work.document->journal().empty());
}

PaintWork prepare_model(Inspected in, const OpenOptions& options, const fs::path& former, const fs::path& project,
                        const ProgressFn& progress) {
    PaintWork work;
    stroke::ModelOptions prepare;
    prepare.repair.metres_per_unit = in.metres_per_unit(options.frame);
    prepare.repair.y_up = options.frame.y_up && !in.soup.turned_up;
    prepare.unwrap.size = options.atlas_size;
    prepare.cache = stroke::shared_model_cache();
    prepare.progress = progress;
    work.source = in.path.string();
    work.frame = options.frame;
    if (!options.own_colours) mesh::drop_colours(in.soup);
    if (options.turned_round)
        prepare.repair.sides = in.summary.report.parts_turned > 0 ? mesh::OpenSides::file : mesh::OpenSides::turned;
    work.model = std::make_unique<stroke::Model>(stroke::prepare_model(std::move(in.soup), prepare));
    work.document =
        std::make_unique<stroke::Document>(*work.model, stroke::DocumentOptions{.substrate = options.substrate});
    if (!former.empty()) copy_strokes(former, options.follow, work, progress);
    work.texture = std::make_unique<Texture>(*work.document, progress);
    work.pixels = work.texture->pixels();
    keep(work, project);
    return work;
}

// To be written if that is wanted and possible; else to be read, and `why` says why.
io::Project open_project(const fs::path& path, OpenAs as, const ProgressFn& progress, Message& why) {
    if (as == OpenAs::work) {
        try {
            return io::Project::open(path, {.access = io::Access::write, .progress = progress});
        } catch (const io::ProjectInUse&) {
            throw;
        } catch (const Error& error) {
            why = error.message();
        }
    }
    return io::Project::open(path, {.access = io::Access::read, .progress = progress});
}

PaintWork load_project(const fs::path& path, const fs::path& session, OpenAs as, const ProgressFn& progress) {
    PaintWork work;
    report(progress, "reading", 0);
    Message why;
    io::Project project = open_project(path, as, progress, why);
    io::ProjectModel stored = project.model();
    work.source = stored.source;
    work.frame = stored.frame;
    const ink::Substrate substrate = ink::parse_substrate(stored.substrate, path.string());
    work.model = std::make_unique<stroke::Model>(
        stroke::prepare_model(std::move(stored.mesh), std::move(stored.atlas),
                              stroke::ModelOptions{.cache = stroke::shared_model_cache(), .progress = progress}));
    work.document = std::make_unique<stroke::Document>(*work.model);
    work.document->use(substrate);
    io::use_presets(project, *work.document);
    io::restore_strokes(project, *work.document, progress);
    io::apply_recolouring(project, *work.document);
    work.texture = std::make_unique<Texture>(*work.document, progress);
    work.pixels = work.texture->pixels();
    project.listen({});
    std::vector<stroke::EntryMark> marks = stroke::marks_of(work.document->journal().entries());
    if (as == OpenAs::view) {
        work.autosave.view(std::move(project), std::move(marks));
    } else if (as == OpenAs::work && why.empty()) {
        work.autosave.adopt(std::move(project), std::move(marks));
    } else {
        work.autosave.take_presets(project);
        work.autosave.take_attachments(project);
        keep(work, session);
        work.note = why.empty() ? Message("This is a copy; it has no name yet.")
                                : Message("This is a copy that has no name yet: {}", why);
    }
    return work;
}

}  // namespace

Opening::Opening() = default;
Opening::~Opening() {
    cancel();
    for (const auto& job : leaving_) job->thread.join();
}

// Steps such as reading a large file end only when they are done; nobody waits for that.
void Opening::cancel() {
    if (!job_) return;
    job_->stop = true;
    leaving_.push_back(std::move(job_));
}

template <class Step>
void Opening::start(Step step) {
    cancel();
    job_ = std::make_unique<Job>();
    Job* job = job_.get();
    job->thread = std::thread([job, step = std::move(step)]() mutable {
        try {
            step(*job);
        } catch (const Cancelled&) {
            job->result = {};
        } catch (const io::ProjectInUse& in_use) {
            job->result.in_use = InUse{.project = {}, .holder = in_use.holder()};
        } catch (const std::bad_alloc&) {
            job->result.error = "there is not enough memory for this model";
        } catch (const std::exception& error) {
            job->result.error = message_of(error);
        }
        job->done = true;
    });
}

void Opening::inspect(const fs::path& path, const io::CadReading& cad) {
    start([path, cad](Job& job) {
        job.kind = Job::kLook;
        job.result.inspected = inspect_file(path, cad, job.progress());
    });
}

void Opening::prepare(Inspected inspected, const OpenOptions& options, const fs::path& project) {
    start([inspected = std::move(inspected), options, project](Job& job) mutable {
        job.result.work = prepare_model(std::move(inspected), options, {}, project, job.progress());
    });
}

void Opening::revise(Inspected inspected, const OpenOptions& options, const fs::path& former, const fs::path& project) {
    start([inspected = std::move(inspected), options, former, project](Job& job) mutable {
        job.result.work = prepare_model(std::move(inspected), options, former, project, job.progress());
    });
}

void Opening::load(const fs::path& project, const fs::path& session, OpenAs as) {
    loaded_ = project;
    start([project, session, as](Job& job) {
        job.kind = Job::kProject;
        job.result.work = load_project(project, session, as, job.progress());
    });
}

std::string Opening::phase() const {
    if (!job_) return {};
    const std::lock_guard lock(job_->mutex);
    return job_->phase;
}

double Opening::fraction() const {
    if (!job_) return 0;
    const std::lock_guard lock(job_->mutex);
    return job_->fraction;
}

Opening::Result Opening::poll() {
    std::erase_if(leaving_, [](const std::unique_ptr<Job>& job) {
        const bool done = job->done;
        if (done) job->thread.join();
        return done;
    });
    if (!job_ || !job_->done) return {};
    job_->thread.join();
    Result result = std::move(job_->result);
    if (result.in_use) result.in_use->project = loaded_;
    result.done = true;
    job_.reset();
    return result;
}

double expected_texel(double area, std::uint32_t size) {
    return std::sqrt(area / 0.75) / std::max(1u, size);
}

std::uint32_t proposed_size(double area) {
    constexpr double kFine = 0.4 * kMillimetre;
    return expected_texel(area, 2048) > kFine && 2 * stroke::atlas_memory(4096) < stroke::available_memory() ? 4096
                                                                                                             : 2048;
}

}  // namespace tuft::app
