#include "app/document.h"

#include <algorithm>
#include <cstdlib>

#include "core/files.h"
#include "core/units.h"
#include "io/export.h"
#include "io/read_model.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

// Where work is kept until it gets a name: $XDG_STATE_HOME/tuft, else ~/.local/state/tuft.
fs::path recovery_folder() {
    fs::path base;
    if (const char* state = std::getenv("XDG_STATE_HOME")) base = state;
    else if (const char* home = std::getenv("HOME")) base = fs::path(home) / ".local" / "state";
    else base = fs::temp_directory_path();
    fs::create_directories(base / "tuft");
    return base / "tuft";
}

}  // namespace

struct Document::Job {
    std::thread thread;
    std::atomic<bool> stop{false}, done{false};
    std::mutex mutex;
    std::string phase = "reading";
    double fraction = 0;
    std::string error;
    bool cancelled = false;
    std::unique_ptr<stroke::Model> model;
    std::unique_ptr<stroke::Painting> painting;
    std::optional<io::Project> project;
    fs::path project_path;
    std::string source, unit;

    void work(const fs::path& path, const Options& options);
};

void Document::Job::work(const fs::path& path, const Options& options) {
    const ProgressFn progress = [this](std::string_view name, double part) {
        const std::lock_guard lock(mutex);
        phase = name;
        fraction = part;
        return !stop.load();
    };
    try {
        if (path.extension() == ".tuft" || io::is_project(path)) {
            project = io::Project::open(path);
            io::ProjectModel stored = project->model();
            source = stored.source;
            unit = stored.unit;
            const ink::Substrate substrate = ink::parse_substrate(stored.substrate, path.string());
            model = std::make_unique<stroke::Model>(
                stroke::prepare_model(std::move(stored.mesh), std::move(stored.atlas), progress));
            painting = std::make_unique<stroke::Painting>(*model);
            painting->use_substrate(substrate);
            for (const auto& [name, toml] : project->brushes())
                painting->use_brush(brush::parse_preset(toml, path.string()));
            for (const auto& [name, toml] : project->inks())
                painting->use_ink(ink::parse_ink(toml, path.string()));
            painting->replay(project->strokes(), progress);
            project_path = path;
        } else {
            stroke::ModelOptions prepare;
            prepare.repair.metres_per_unit =
                io::metres_per_unit_of(path).value_or(metres_per(options.unit).value_or(kMillimetre));
            prepare.unwrap.size = options.atlas_size;
            prepare.progress = progress;
            source = path.string();
            unit = options.unit;
            model = std::make_unique<stroke::Model>(stroke::prepare_model(io::read_model(path), prepare));
            painting = std::make_unique<stroke::Painting>(
                *model, stroke::PaintingOptions{.substrate = options.substrate});
        }
    } catch (const Cancelled&) {
        cancelled = true;
    } catch (const std::exception& e) {
        error = e.what();
    }
    done = true;
}

Document::Document() = default;
Document::~Document() { cancel_opening(); }

void Document::open(const fs::path& path, const Options& options) {
    cancel_opening();
    job_ = std::make_unique<Job>();
    Job* job = job_.get();
    job->thread = std::thread([job, path, options] { job->work(path, options); });
}

void Document::cancel_opening() {
    if (!job_) return;
    job_->stop = true;
    job_->thread.join();
    job_.reset();
}

std::pair<std::string, double> Document::opening_progress() const {
    if (!job_) return {};
    const std::lock_guard lock(job_->mutex);
    return {job_->phase, job_->fraction};
}

bool Document::poll() {
    if (!job_ || !job_->done) return false;
    job_->thread.join();
    const std::unique_ptr<Job> job = std::move(job_);
    if (job->cancelled) return false;
    if (!job->error.empty()) {
        message = job->error;
        return false;
    }
    painting_ = std::move(job->painting);
    model_ = std::move(job->model);
    project_ = std::move(job->project);
    project_path_ = job->project_path;
    source_ = job->source;
    unit_ = job->unit;
    message = "opened " + (project_ ? project_path_.string() : source_);
    if (!project_) start_project(recovery_folder() / (fs::path(source_).stem().string() + ".tuft"));
    return true;
}

void Document::start_project(const fs::path& path) {
    try {
        project_ = io::Project::create(path, {.source = source_,
                                              .unit = unit_,
                                              .mesh = *model_->mesh,
                                              .atlas = model_->atlas,
                                              .substrate = ink::substrate_toml(painting_->substrate())});
        project_path_ = path;
        for (const stroke::Stroke& stroke : painting_->journal().strokes()) keep(stroke);
    } catch (const Error& e) {
        project_.reset();
        message = std::string("work is not being kept: ") + e.what();
    }
}

void Document::keep(const stroke::Stroke& stroke) {
    if (!project_) return;
    try {
        project_->put_brush({stroke.trace.brush, brush::preset_toml(painting_->brush(stroke.trace.brush))});
        project_->put_ink({stroke.trace.ink, ink::ink_toml(painting_->ink(stroke.trace.ink))});
        project_->append(stroke);
    } catch (const Error& e) {
        message = std::string("the last stroke could not be kept: ") + e.what();
    }
}

void Document::begin(const std::string& brush, const std::string& ink) {
    stroke::Stroke stroke;
    stroke.trace.flat = false;
    stroke.trace.brush = brush;
    stroke.trace.ink = ink;
    painting_->begin(std::move(stroke));
}

void Document::extend(std::span<const brush::Pose> poses) { painting_->extend(poses); }

void Document::end() {
    if (!painting_->in_stroke()) return;
    painting_->end();
    keep(painting_->journal().strokes().back());
}

void Document::undo() {
    if (!painting_ || painting_->journal().empty()) return;
    const std::uint64_t id = painting_->journal().strokes().back().id;
    painting_->undo();
    if (project_) project_->remove(id);
}

void Document::redo() {
    if (painting_ && painting_->redo()) keep(painting_->journal().strokes().back());
}

void Document::save_as(const fs::path& path) {
    if (!painting_) return;
    start_project(path);
    if (project_ && project_path_ == path) message = "saved " + path.string();
}

void Document::export_model(const fs::path& path) {
    if (!painting_) return;
    try {
        io::export_model(path, *model_->mesh, model_->atlas,
                         io::make_maps(painting_->canvas(), model_->texels, painting_->substrate(), painting_->compose_options()),
                         {.unit = unit_});
        message = "exported " + path.string();
    } catch (const Error& e) {
        message = e.what();
    }
}

}  // namespace tuft::app
