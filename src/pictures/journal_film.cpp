#include "pictures/journal_film.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "ink/composite/composite.h"
#include "pictures/picture_look.h"
#include "render/picture/brush_in_picture.h"
#include "stroke/session/session.h"

namespace tuft::pictures {
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

    Timeline(const std::vector<stroke::JournalEntry>& entries, const FilmOptions& a) {
        for (const stroke::JournalEntry& entry : entries) work.push_back(work_of(entry));
        total = std::accumulate(work.begin(), work.end(), 0.0);
        const double seconds = a.speed > 0 ? total / a.speed : a.seconds;
        if (seconds > 36'000) throw Error("the film would be longer than ten hours");
        frames = std::max(2, static_cast<int>(std::lround(seconds * a.frames_per_second)));
        still = static_cast<int>(std::lround(a.still_seconds * a.frames_per_second));
    }
    double part(int frame) const { return static_cast<double>(frame) / (frames - 1); }
    double time(int frame) const { return total * part(frame); }
};

/// Camera, paint and picture of the frames; draws one after the other.
class Camera {
  public:
    /// All must outlive it.
    Camera(const FilmOptions& film, stroke::Document& painting)
        : film_(film),
          painting_(painting),
          model_(painting.model()),
          options_(film.picture),
          shown_(make_look(model_, &painting, "", false)) {
        options_.progress = [this](std::string_view, double) { return go_on(); };
        compose_all();
    }

    /// Returns the frame at `part` of the film, with the brush of the stroke in work; null: without one.
    const render::Image& shoot(double part, const stroke::StrokeSession* session) {
        pass(part);
        return draw(session);
    }
    /// Does what `shoot` does, but for the picture: the frames after it are the same to the bit.
    void pass(double part) {
        part_ = part;
        take_changes();
        const render::View view = view_at(part_);
        standing_ = stands(view);
        const bool moved = !(view == options_.view);
        options_.view = view;
        choose_light(standing_ ? render::PictureSeries::Length::many : render::PictureSeries::Length::moving,
                     standing_ && moved);
    }
    /// Returns the frame of the finished work, in its own light: the picture of `tuft render`.
    const render::Image& shoot_finished() {
        part_ = 1;
        shown_ = make_look(model_, &painting_, "", film_.picture.lights == render::Lights::raking);
        options_.view = view_at(part_);
        choose_light(render::PictureSeries::Length::one, true);
        return draw_series();
    }
    /// Reports; false: stop.
    bool go_on() const { return !film_.progress || film_.progress("film", part_); }

  private:
    /// The light that a series is drawn in.
    struct Light {
        PictureLook paint;                                    ///< that throws it back
        std::vector<double> of_tile;                          ///< how far that is from what is seen, by tile
        double difference = 0;                                ///< the sum of it
        std::optional<render::PictureSeries::Length> series;  ///< that it is chosen for; or none yet
        render::View from;                                    ///< first view of that series
    };

    void compose_all() {
        const stroke::Appearance& appearance = painting_.appearance();
        shown_.colour = ink::compose_linear(appearance.stack(), model_.texels, appearance.substrate(),
                                            appearance.compose_options());
        compose_relief();
        shown_.point_to_maps(model_);
    }

    void compose_relief() {
        if (film_.picture.lights != render::Lights::raking) return;
        const stroke::Appearance& appearance = painting_.appearance();
        shown_.height = ink::compose_height(appearance.stack(), model_.texels, appearance.compose_options());
        for (float& h : shown_.height.texels) h *= 1e-6f;
    }

    /// Whether parts have other substrates since the last picture: the finish and all maps are others.
    bool take_parts() {
        if (parts_ == painting_.parts().table()) return false;
        parts_ = painting_.parts().table();
        shown_ = make_look(model_, &painting_, "", false);
        compose_all();
        light_.series.reset();
        return true;
    }

    void take_changes() {
        stroke::Appearance& appearance = painting_.appearance();
        const std::vector<std::uint32_t> slots = appearance.take_dirty();
        if (take_parts() || slots.empty()) return;
        const ink::ComposeOptions compose = appearance.compose_options();
        ink::refresh_linear(shown_.colour, slots, appearance.stack(), model_.texels, appearance.substrate(), compose);
        changed_ = ink::refreshed_tiles(slots, model_.texels, compose);
        if (!shown_.transmission.texels.empty())
            shown_.transmission =
                ink::compose_transmission8(appearance.stack(), model_.texels, appearance.substrate(), compose);
        compose_relief();
        shown_.point_to_maps(model_);
        for (const std::uint32_t tile : changed_) note_difference(tile);
    }

    /// Sums how far the paint on a tile is from that which the light is thrown back by.
    void note_difference(std::uint32_t tile) {
        if (light_.paint.colour.texels.empty()) return;
        const std::size_t size = shown_.colour.size, per_side = model_.texels.tiles_per_side;
        const std::size_t x0 = tile % per_side * atlas::kTile, y0 = tile / per_side * atlas::kTile;
        const std::size_t x1 = std::min(x0 + atlas::kTile, size), y1 = std::min(y0 + atlas::kTile, size);
        double sum = 0;
        for (std::size_t y = y0; y < y1; ++y)
            for (std::size_t i = 3 * (y * size + x0); i < 3 * (y * size + x1); ++i)
                sum += double{std::abs(shown_.colour.texels[i] - light_.paint.colour.texels[i])};
        light_.difference += sum - std::exchange(light_.of_tile[tile], sum);
    }

    /// Whether the light is that of paint too far from what is seen: a whole wash changes it, strokes do not.
    bool paint_is_far() const {
        constexpr double kMost = 0.02;  // mean reflectance, of the tiles of charts
        const double channels = 3.0 * atlas::kTileTexels * static_cast<double>(model_.texels.n_slots());
        return surface_ != painting_.parts().surface() || light_.difference > kMost * channels;
    }

    /// Chooses the light of a series of one camera, or of one that moves: that of the paint that is seen, where the
    /// series is another (`anew`), or has none yet, or the paint is too far from its light.
    void choose_light(render::PictureSeries::Length length, bool anew) {
        if (!anew && light_.series == length && !paint_is_far()) return;
        series_.reset();
        light_.series = length;
        light_.from = options_.view;
        light_.paint = shown_;
        light_.paint.point_to_maps(model_);
        light_.of_tile.assign(model_.texels.slot_of_tile.size(), 0);
        light_.difference = 0;
        surface_ = painting_.parts().surface();
    }

    render::View view_at(double part) const {
        return render::view_at(film_.path, part, options_.width, options_.height, model_.mesh->positions);
    }

    /// Whether the camera has this view a little later, or had it a little before.
    bool stands(const render::View& view) const {
        return view_at(std::min(1.0, part_ + kMoment)) == view || (part_ > kMoment && view_at(part_ - kMoment) == view);
    }

    const render::Image& draw(const stroke::StrokeSession* session) {
        const render::Image& picture = draw_series();
        if (!session || !film_.brush) return picture;
        frame_ = picture;
        const brush::Tuft& tuft = session->brush();
        render::draw_brush_in_picture(frame_, series_->camera(), *surface_, tuft, session->tuft(),
                                      kHolder * tuft.preset.length);
        return frame_;
    }

    /// Options of the series. Frames that are seen for a moment, from a camera that never stands there, have less light
    /// samples and rays.
    render::PictureOptions series_options() const {
        render::PictureOptions options = options_;
        options.view = light_.from;
        if (light_.series != render::PictureSeries::Length::moving) return options;
        options.edge_samples = 4;
        options.light_samples = 16;
        options.light_step = std::clamp(options.height / kLightRows, 1, kMostLightStep);
        return options;
    }

    /// Draws what is seen, in the chosen light.
    const render::Image& draw_series() {
        const bool first = !series_;
        if (first)
            series_ = std::make_unique<render::GlassSeries>(*model_.mesh, *surface_, light_.paint.appearance,
                                                            glass_of(light_.paint, painting_), series_options(),
                                                            *light_.series);
        std::vector<std::uint32_t> changed = std::exchange(changed_, {});
        if (light_.series == render::PictureSeries::Length::moving) {
            changed.clear();
            if (!first || !(light_.from == options_.view)) series_->look_from(options_.view);
        }
        return series_->draw(shown_.appearance, shown_.transmission.texels, changed);
    }

    static constexpr double kMoment = 1e-3;  // of the film
    static constexpr int kLightRows = 360;   // at which light is sampled in a frame, about
    static constexpr int kMostLightStep = 8;

    const FilmOptions& film_;
    stroke::Document& painting_;
    const stroke::Model& model_;
    render::PictureOptions options_;
    double part_ = 0;
    PictureLook shown_;                                  ///< paint that is seen
    std::vector<std::uint32_t> changed_;                 ///< tiles, since the last picture
    std::shared_ptr<const mesh::SurfaceQuery> surface_;  ///< of the visible parts, which the series draw
    bool standing_ = false;
    Light light_;
    std::unique_ptr<render::GlassSeries> series_;  ///< null until its first picture
    stroke::PartTable parts_;                      ///< of the last picture
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
        for (; next < last && timeline.time(next) <= until; ++next) {
            if (sink.has_next()) {
                camera.pass(timeline.part(next));
                sink.pass();
            } else {
                sink.add(view_of(camera.shoot(timeline.part(next), session)));
            }
        }
    };
    // What comes before all work, such as the substrates of parts, is in the first frame.
    const auto first = static_cast<std::size_t>(
        std::find_if(timeline.work.begin(), timeline.work.end(), [](double work) { return work > 0; }) -
        timeline.work.begin());
    std::vector<stroke::JournalEntry> unseen;  // entries without a frame of their own, side by side
    std::move(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(first), std::back_inserter(unseen));
    painting.replay(std::exchange(unseen, {}), go_on);
    take(0, nullptr);
    double passed = 0;
    for (std::size_t i = first; i < entries.size(); ++i) {
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
    int still = 0;
    for (; still <= timeline.still && sink.has_next(); ++still) sink.pass();
    if (still > timeline.still) return;
    const render::Image& finished = camera.shoot_finished();
    for (; still <= timeline.still; ++still) sink.add(view_of(finished));
}

}  // namespace

FilmLength measure_film(const std::vector<stroke::JournalEntry>& entries, const FilmOptions& options) {
    const auto paints = [](const stroke::JournalEntry& entry) {
        return !entry.hidden && !stroke::on_palette(entry) &&
               (entry.as<stroke::PaintStroke>() || entry.as<stroke::Fill>());
    };
    if (std::none_of(entries.begin(), entries.end(), paints))
        throw Error("nothing is painted: there is nothing to film");
    const Timeline timeline(entries, options);
    return {timeline.frames + timeline.still, timeline.total};
}

void film_journal(stroke::Document& painting, std::vector<stroke::JournalEntry> entries, const FilmOptions& options,
                  io::FilmSink& sink) {
    const Timeline timeline(entries, options);
    Camera camera(options, painting);
    shoot(std::move(entries), timeline, painting, camera, sink);
}

}  // namespace tuft::pictures
