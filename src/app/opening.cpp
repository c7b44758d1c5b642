#include "app/opening.h"

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include "core/units.h"
#include "io/looks.h"
#include "io/read_model.h"
#include "io/restore.h"

namespace fs = std::filesystem;

namespace tuft::app {

struct Opening::Job {
    std::thread thread;
    std::atomic<bool> stop{false}, done{false};
    std::mutex mutex;
    std::string phase = "reading";
    double fraction = 0;
    Result result;

    ProgressFn progress() {
        return [this](std::string_view name, double part) {
            const std::lock_guard lock(mutex);
            phase = name;
            fraction = part;
            return !stop.load();
        };
    }
};

namespace {

Inspected inspect_file(const fs::path& path, const ProgressFn& progress) {
    Inspected out;
    out.path = path;
    report(progress, "reading", 0);
    out.soup = io::read_model(path);
    Box bounds;
    for (const Vec3& p : out.soup.points) bounds.add(p);
    const auto fixed = io::metres_per_unit_of(path);
    out.unit_fixed = fixed.has_value();
    const mesh::UnitGuess guess = mesh::guess_unit(bounds);
    mesh::RepairOptions repair;
    repair.metres_per_unit = fixed.value_or(guess.metres_per_unit);
    repair.progress = progress;
    const mesh::Surface surface = mesh::build_surface(out.soup, repair);
    out.summary = mesh::summarise(surface, repair.metres_per_unit);
    out.summary.unit = guess;
    out.defects = mesh::describe_defects(surface.report);
    return out;
}

// Strokes of a former project, its presets and ground, on the new model.
void carry_strokes(const fs::path& former, Painter::Work& work, const ProgressFn& progress) {
    const io::Project project = io::Project::open(former);
    work.painting->use_substrate(ink::parse_substrate(project.model().substrate, former.string()));
    io::use_presets(project, *work.painting);
    work.keeper.take_presets(project);
    for (const stroke::StrokeReport& report : work.painting->replay(project.strokes(), progress))
        if (!report.touched()) work.misfits.push_back(report);
}

Painter::Work prepare_model(Inspected in, const OpenOptions& options, const fs::path& former, const fs::path& project, const ProgressFn& progress) {
    Painter::Work work;
    stroke::ModelOptions prepare;
    const auto fixed = io::metres_per_unit_of(in.path);
    prepare.repair.metres_per_unit = fixed.value_or(metres_per(options.frame.unit).value_or(kMillimetre));
    prepare.repair.y_up = options.frame.y_up && !fixed;
    prepare.unwrap.size = options.atlas_size;
    prepare.progress = progress;
    work.source = in.path.string();
    work.frame = options.frame;
    work.model = std::make_unique<stroke::Model>(stroke::prepare_model(std::move(in.soup), prepare));
    work.painting = std::make_unique<stroke::Painting>(*work.model, stroke::PaintingOptions{.substrate = options.substrate});
    if (!former.empty()) carry_strokes(former, work, progress);
    work.texture = std::make_unique<Texture>(*work.painting, progress);
    work.pixels = work.texture->pixels();
    const std::string fault = work.keeper.start(project, work.source, work.frame, *work.painting);
    if (!fault.empty()) throw Error("the work could not be kept: " + fault);
    return work;
}

Painter::Work load_project(const fs::path& path, const fs::path& session, const ProgressFn& progress) {
    Painter::Work work;
    report(progress, "reading", 0);
    io::Project project = io::Project::open(path);
    io::ProjectModel stored = project.model();
    work.source = stored.source;
    work.frame = stored.frame;
    const ink::Substrate substrate = ink::parse_substrate(stored.substrate, path.string());
    work.model = std::make_unique<stroke::Model>(
        stroke::prepare_model(std::move(stored.mesh), std::move(stored.atlas), progress));
    work.painting = std::make_unique<stroke::Painting>(*work.model);
    work.painting->use_substrate(substrate);
    io::use_presets(project, *work.painting);
    io::restore_strokes(project, *work.painting, progress);
    io::show_looks(project, *work.painting);
    work.texture = std::make_unique<Texture>(*work.painting, progress);
    work.pixels = work.texture->pixels();
    work.keeper.adopt(std::move(project));
    // A file that cannot be written is gone on with in a copy.
    const bool writable = ::access(path.c_str(), W_OK) == 0 && ::access(fs::absolute(path).parent_path().c_str(), W_OK) == 0;
    if (!writable) {
        const std::string fault = work.keeper.start(session, work.source, work.frame, *work.painting);
        if (!fault.empty()) throw Error("the work could not be kept: " + fault);
    }
    return work;
}

}  // namespace

Opening::Opening() = default;
Opening::~Opening() { cancel(); }

void Opening::cancel() {
    if (!job_) return;
    job_->stop = true;
    job_->thread.join();
    job_.reset();
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
        } catch (const std::bad_alloc&) {
            job->result.error = "there is not enough memory for this model";
        } catch (const std::exception& error) {
            job->result.error = error.what();
        }
        job->done = true;
    });
}

void Opening::inspect(const fs::path& path) {
    start([path](Job& job) { job.result.inspected = inspect_file(path, job.progress()); });
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

void Opening::load(const fs::path& project, const fs::path& session) {
    start([project, session](Job& job) { job.result.work = load_project(project, session, job.progress()); });
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
    if (!job_ || !job_->done) return {};
    job_->thread.join();
    Result result = std::move(job_->result);
    result.done = true;
    job_.reset();
    return result;
}

double expected_texel(double area, std::uint32_t size) { return std::sqrt(area / 0.75) / std::max(1u, size); }

}  // namespace tuft::app
