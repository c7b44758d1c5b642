#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "cli/commands.h"
#include "cli/film_camera.h"
#include "cli/revision.h"
#include "cli/steps.h"
#include "core/error.h"
#include "io/image/film_file.h"
#include "io/project/appearance.h"
#include "io/project/restore.h"
#include "render/picture/brush_in_picture.h"
#include "render/picture/picture_series.h"
#include "stroke/session/session.h"

/// `tuft film`: the journal painted again before a camera.
namespace tuft::cli {
namespace {

constexpr double kHolder = 5;  ///< length of the drawn holder over that of the tuft

/// Seconds of work that an entry stands for.
double work_of(const stroke::JournalEntry& entry) {
    constexpr double kShortest = 0.2, kLongest = 8, kOther = 0.5;
    if (entry.hidden || stroke::on_palette(entry)) return 0;
    if (const auto* stroke = entry.as<stroke::PaintStroke>()) {
        const std::vector<stroke::StrokeSample>& samples = stroke->trace.samples;
        const double hand = samples.empty() ? 0 : samples.back().time - samples.front().time;
        return std::clamp(hand, kShortest, kLongest);
    }
    return entry.as<stroke::Fill>() || entry.as<stroke::Dry>() ? kOther : 0;
}

/// When frames are taken: frame k of n shows the state after k/(n − 1) of all work.
struct Timeline {
    std::vector<double> work;  ///< seconds, by entry
    double total = 0;
    int frames = 2, still = 0;  ///< of the work, and of the finished work after it

    Timeline(const std::vector<stroke::JournalEntry>& entries, const Film& a) {
        for (const stroke::JournalEntry& entry : entries) work.push_back(work_of(entry));
        total = std::accumulate(work.begin(), work.end(), 0.0);
        const double seconds = a.speed > 0 ? total / a.speed : a.seconds;
        if (seconds > 36'000) throw UsageError("--speed: the film would be longer than ten hours");
        frames = std::max(2, static_cast<int>(std::lround(seconds * a.frames_per_second)));
        still = static_cast<int>(std::lround(a.still_seconds * a.frames_per_second));
    }
    double part(int frame) const { return static_cast<double>(frame) / (frames - 1); }
    double time(int frame) const { return total * part(frame); }
};

/// Camera, paint and picture of the frames; draws one after the other.
class Camera {
  public:
    /// `lit`: the finished work. All must outlive it.
    Camera(const Film& a, stroke::Document& painting, const PictureLook& lit, Console& console)
        : film_(a),
          painting_(painting),
          model_(painting.model()),
          lit_(lit),
          path_(camera_path(a.camera, a.replay.view, model_)),
          options_(picture_options(a.replay.view, model_)),
          progress_(console.progress()) {
        options_.progress = [this](std::string_view, double) { return go_on(); };
        const stroke::Appearance& appearance = painting.appearance();
        shown_.appearance = lit.appearance;
        shown_.colour = ink::compose_linear(appearance.stack(), model_.texels, appearance.substrate(),
                                            appearance.compose_options());
        if (film_.replay.view.raking)
            shown_.height = {shown_.colour.size, 1, std::vector<float>(lit.height.texels.size())};
        shown_.point_to_maps(model_);
    }

    /// Returns the frame at `part` of the film, with the brush of the stroke in work; null: without one.
    const render::Image& shoot(double part, const stroke::StrokeSession* session) {
        part_ = part;
        take_changes();
        return draw(part, session);
    }
    /// Returns the frame of the finished work.
    const render::Image& shoot_finished() {
        part_ = 1;
        const stroke::Appearance& appearance = painting_.appearance();
        ink::AtlasMap<float> whole = ink::compose_linear(appearance.stack(), model_.texels, appearance.substrate(),
                                                         appearance.compose_options());
        add_differences(whole);
        shown_.colour = std::move(whole);
        shown_.height = lit_.height;
        shown_.point_to_maps(model_);
        return draw(1, nullptr);
    }
    /// Reports; false: stop.
    bool go_on() const { return !progress_ || progress_("film", part_); }

  private:
    void take_changes() {
        stroke::Appearance& appearance = painting_.appearance();
        const std::vector<std::uint32_t> slots = appearance.take_dirty();
        if (slots.empty()) return;
        const ink::ComposeOptions compose = appearance.compose_options();
        ink::refresh_linear(shown_.colour, slots, appearance.stack(), model_.texels, appearance.substrate(), compose);
        const std::vector<std::uint32_t> tiles = ink::refreshed_tiles(slots, model_.texels, compose);
        changed_.insert(changed_.end(), tiles.begin(), tiles.end());
        if (!film_.replay.view.raking) return;
        shown_.height = ink::compose_height(appearance.stack(), model_.texels, compose);
        for (float& h : shown_.height.texels) h *= 1e-6f;
        shown_.point_to_maps(model_);
    }

    void add_differences(const ink::AtlasMap<float>& whole) {
        const std::size_t size = whole.size, row = 3 * size, per_side = model_.texels.tiles_per_side;
        for (std::size_t y = 0; y < size; ++y)
            for (std::size_t tile = 0; tile < per_side; ++tile) {
                const std::size_t first = y * row + tile * 3 * atlas::kTile,
                                  n = std::min<std::size_t>(3 * atlas::kTile, (y + 1) * row - first);
                if (std::memcmp(&whole.texels[first], &shown_.colour.texels[first], n * sizeof(float)) != 0)
                    changed_.push_back(static_cast<std::uint32_t>(y / atlas::kTile * per_side + tile));
            }
    }

    const render::Image& draw(double part, const stroke::StrokeSession* session) {
        const mesh::TriangleMesh& mesh = *model_.mesh;
        const render::View view = render::view_at(path_, part, options_.width, options_.height, mesh.positions);
        if (!series_ || !(view == options_.view)) {
            options_.view = view;
            const bool moves = path_.size() > 1;
            series_ = std::make_unique<render::PictureSeries>(mesh, *model_.query, lit_.appearance, options_,
                                                              moves && !stands_after(part, view)
                                                                  ? render::PictureSeries::Length::one
                                                                  : render::PictureSeries::Length::many);
        }
        std::sort(changed_.begin(), changed_.end());
        changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
        const render::Image& picture = series_->draw(shown_.appearance, changed_);
        changed_.clear();
        if (!session || film_.no_brush) return picture;
        frame_ = picture;
        const brush::Tuft& tuft = session->brush();
        render::draw_brush_in_picture(frame_, series_->camera(), *model_.query, tuft, session->tuft(),
                                      kHolder * tuft.preset.length);
        return frame_;
    }

    /// Whether the camera still has this view a little later.
    bool stands_after(double part, const render::View& view) const {
        constexpr double kLater = 1e-3;
        return render::view_at(path_, std::min(1.0, part + kLater), options_.width, options_.height,
                               model_.mesh->positions) == view;
    }

    const Film& film_;
    stroke::Document& painting_;
    const stroke::Model& model_;
    const PictureLook& lit_;
    render::CameraPath path_;
    render::PictureOptions options_;
    ProgressFn progress_;
    double part_ = 0;
    PictureLook shown_;
    std::vector<std::uint32_t> changed_;  ///< tiles, since the last picture
    std::unique_ptr<render::PictureSeries> series_;
    render::Image frame_;
};

io::PixelView view_of(const render::Image& image) {
    return io::view_of(image.width, image.height, 3, image.rgb.data());
}

/// Paints the journal and gives its frames to `sink`.
void shoot(std::vector<stroke::JournalEntry> entries, const Timeline& timeline, stroke::Document& painting,
           Camera& camera, io::FilmSink& sink) {
    const ProgressFn go_on = [&camera](std::string_view, double) { return camera.go_on(); };
    const int last = timeline.frames - 1;
    int next = 0;
    const auto take = [&](double until, const stroke::StrokeSession* session) {
        for (; next < last && timeline.time(next) <= until; ++next)
            sink.add(view_of(camera.shoot(timeline.part(next), session)));
    };
    take(0, nullptr);
    double passed = 0;
    std::vector<stroke::JournalEntry> unseen;  // entries without a frame of their own, side by side
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const double begin = std::exchange(passed, passed + timeline.work[i]), work = timeline.work[i];
        if (next >= last || timeline.time(next) > passed) {
            unseen.push_back(std::move(entries[i]));
            continue;
        }
        painting.replay(std::exchange(unseen, {}), go_on);
        if (entries[i].as<stroke::PaintStroke>())
            painting.watch_poses([&, begin, work](const stroke::StrokeSession& session, double part) {
                if (part < 1) take(begin + part * work, &session);
            });
        std::vector<stroke::JournalEntry> one;
        one.push_back(std::move(entries[i]));
        painting.replay(std::move(one), go_on);
        painting.watch_poses({});
        take(passed, nullptr);
    }
    painting.replay(std::move(unseen), go_on);
    const render::Image& finished = camera.shoot_finished();
    for (int k = 0; k <= timeline.still; ++k) sink.add(view_of(finished));
}

/// Throws where nothing of the painting is seen.
void check_painted(const Film& a, const stroke::Document& finished) {
    if (finished.appearance().stack().layers.empty() || finished.layers().pigments().empty())
        throw Error(a.replay.project.string(), "nothing is painted: there is nothing to film");
}

/// Whether the project's stored texels are what is filmed.
bool films_stored_work(const Replay& a) {
    return a.model.empty() && a.brush.empty() && a.ink.empty() && a.surface.atlas_size == 0 &&
           a.surface.texel_size_mm == 0 && !a.surface.new_uv && a.surface.seams == "free";
}

PictureLook look_of_finished(const Film& a, OpenProject& project, const stroke::Model& model, Console& console) {
    stroke::Document finished(model);
    if (films_stored_work(a.replay)) {
        restore(project, finished, console);
    } else {
        finished.use(project.substrate);
        io::use_presets(project.file, finished);
        finished.replay(replay_strokes(a.replay, project, finished).followed, console.progress());
    }
    io::apply_recolouring(project.file, finished);
    check_painted(a, finished);
    return make_look(model, &finished, "", a.replay.view.raking);
}

void print_result(const Film& a, const Timeline& timeline) {
    const int frames = timeline.frames + timeline.still;
    if (a.common.json)
        print_json(nlohmann::json{{"project", a.replay.project.string()},
                                  {"wrote", a.output.string()},
                                  {"frames", frames},
                                  {"seconds", frames / a.frames_per_second},
                                  {"work_seconds", timeline.total}});
    else
        fmt::print("filmed {:.0f} s of work in {} frames, {:.1f} s\nwrote {}\n", timeline.total, frames,
                   frames / a.frames_per_second, a.output.string());
}

}  // namespace

int run(const Film& a) {
    if (!a.output.extension().empty() && !io::is_film_file(a.output))
        throw UsageError(a.output.string() + ": a film is .mp4, .gif or a folder, whose name has no extension");
    io::check_film(a.output);
    if (io::is_film_file(a.output)) check_output(a.output);
    Console console(a.common.quiet);
    const auto project = open_project(a.replay.project, io::Access::read, console);
    const stroke::Model model = replay_model(a.replay, *project, console);
    PictureLook lit = look_of_finished(a, *project, model, console);
    lit.point_to_maps(model);
    stroke::Document painting(model);
    painting.use(project->substrate);
    io::use_presets(project->file, painting);
    io::apply_recolouring(project->file, painting);
    std::vector<stroke::JournalEntry> entries = replay_strokes(a.replay, *project, painting).followed;
    const Timeline timeline(entries, a);
    Camera camera(a, painting, lit, console);
    io::write_film(
        a.output,
        {.width = a.replay.view.width, .height = a.replay.view.height, .frames_per_second = a.frames_per_second},
        [&](io::FilmSink& sink) { shoot(std::move(entries), timeline, painting, camera, sink); });
    console.clear();
    print_result(a, timeline);
    return 0;
}

}  // namespace tuft::cli
