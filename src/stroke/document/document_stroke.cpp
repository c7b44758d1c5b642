#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contact/node_contact.h"
#include "core/system/parallel.h"
#include "stroke/document/document.h"
#include "stroke/document/paint_path.h"
#include "stroke/document/path_ahead.h"
#include "stroke/gesture/hand.h"
#include "stroke/gesture/resample.h"
#include "stroke/journal/tables.h"
#include "stroke/placement/drape.h"
#include "stroke/session/session.h"

/// Strokes: the brush is taken up, led over the model by a session, and put down.
namespace tuft::stroke {
namespace {

/// Each stamp of a tuft this wide takes a tenth of a second, and a stroke thousands of them.
void check_width(const brush::Preset& preset, double texel) {
    constexpr double kWidest = 2048;  // texels
    const double width = brush::tuft_width(preset);
    if (width > kWidest * texel)
        throw Error(Message(
            "the brush is {} mm wide, {} texels of this model, more than {}: use a larger texel size or a "
            "smaller brush",
            fmt::format("{:.3g}", 1e3 * width), fmt::format("{:.0f}", width / texel), fmt::format("{:.0f}", kWidest)));
}

}  // namespace

void begin_path(StrokeSession& session, const HandPath& path, const ProgressFn& progress) {
    session.set_progress(progress);
    session.begin_with_set_down(path.set_down);
    session.check_length(path.poses);
}

void paint_poses(StrokeSession& session, std::span<const brush::Pose> poses, std::size_t from, std::size_t to) {
    const auto all = static_cast<double>(poses.size());
    for (std::size_t i = from; i < to; ++i) session.advance(poses.subspan(i, 1), static_cast<double>(i + 1) / all);
}

void note_origin(StrokeReport& report, const PaintStroke& stroke, const mesh::SurfaceQuery& surface) {
    if (stroke.trace.flat) report.inside.origin = contact::depth_inside(surface, stroke.trace.placement.origin);
}

void Document::check_size(const JournalEntry& entry) {
    const PaintStroke* stroke = entry.as<PaintStroke>();
    if (!stroke || on_palette(entry)) return;
    const brush::Preset& preset = materials_.brush(stroke->brush);
    const double texel = model_.texels.texel_size;
    check_width(preset, texel);
    if (!stroke->trace.flat) return;
    // On the surface the hand's path is longer or shorter than what was drawn; twice as short it is nowhere.
    constexpr double kShorter = 2;
    const ink::Ink ink = stroke->erases() || stroke->ink.empty() ? ink::Ink{} : materials_.ink(stroke->ink);
    std::vector<brush::Pose> drawn;
    for (const StrokeSample& s : steady(stroke->trace, stroke->settings).samples)
        drawn.push_back({.position = {s.position.x, s.position.y, 0}, .time = s.time});
    check_path_length(drawn, {.step = kShorter * pose_spacing(*stroke, preset, ink, texel), .lever = preset.length});
}

void Document::begin(JournalEntry entry) {
    check_layer(entry);
    cancel();
    in_work_.session = make_session(std::get<PaintStroke>(entry.content));
    if (thread_count() > 1) in_work_.session->forecast_hand();
    in_work_.entry = std::move(entry);
}

void Document::extend(std::span<const brush::Pose> poses, const std::function<void()>& painted) {
    in_work_.session->extend(poses, painted);
}

StrokeReport Document::end() {
    in_work_.entry.content = in_work_.session->stroke();
    StrokeReport report = finish_session(journal_.next_id());
    journal_.append(std::move(in_work_.entry));
    return report;
}

void Document::cancel() {
    if (!in_work_.session) return;
    std::vector<LayerTiles> before;
    before.push_back({in_work_.session->stroke().layer, in_work_.session->take_snapshots()});
    restore(before);
    in_work_.session.reset();
    forget_pigments();
}

BrushStart Document::brush_start(const PaintStroke& stroke) {
    const StrokeSettings& settings = stroke.settings;
    return {.preset = preset_of(stroke.brush, settings.spine),
            .name = stroke.brush,
            .ink = stroke.ink,
            .mix = stroke.erases() ? ink::Mix{} : mix_of(stroke.ink),
            .seed = stroke.seed,
            .dip = settings.dip};
}

// Safe beside others while no brush is put down.
BrushInHand Document::take_up(const PaintStroke& stroke, const BrushStart& start) const {
    return stroke.erases() ? clean_brush(start.preset) : brushes_.take_up_for_stroke(start);
}

// An eraser lets no ink flow.
WetFilmInUse Document::wet_film_for(const PaintStroke& stroke, const PaintTarget& target) {
    if (stroke.settings.film != FilmModel::wet || stroke.erases()) return {};
    if (target.on_palette) return {palette_.plate().film.get(), palette_.plate().params};
    return {&film_within(stroke.mask), ink::film_params(target.substrate, stroke.settings.down)};
}

std::unique_ptr<StrokeSession> Document::make_session(PaintStroke stroke) {
    settle(stroke);
    const BrushStart start = brush_start(stroke);
    SessionInput input = session_input(std::move(stroke), nullptr);
    input.brush = take_up(input.stroke, start);
    if (!input.stroke.erases()) input.ink = materials_.ink(input.brush.dipped);
    return std::make_unique<StrokeSession>(std::move(input));
}

// All but the brush and its ink. `plan`: tiles that the stroke may use; null: all, and with them the links over the
// seams.
SessionInput Document::session_input(PaintStroke stroke, const TilePlan* plan) {
    const PaintTarget target = this->target(stroke.layer, stroke.mask);
    check_width(materials_.brush(stroke.brush), target.model.texels.texel_size);
    WetFilmInUse wet = wet_film_for(stroke, target);
    const SeamLinksFn seams = [this, plan, on_palette = target.on_palette]() -> const atlas::SeamLinks& {
        if (plan) throw OutsideTiles();
        return on_palette ? palette_.plate().seams : film_.seams();
    };
    return {.stroke = std::move(stroke),
            .brush = {},
            .ink = {},
            .model = target.model,
            .surface = target.surface,
            .substrate = target.substrate,
            .canvas = target.canvas,
            .mask = target.mask,
            .substrates = target.substrates,
            .plan = plan,
            .wet = std::move(wet),
            .scratch = *scratch_.plans,
            .seams = seams,
            .record_forces = options_.record_forces};
}

// Ends the stroke in work without a word to the journal.
StrokeReport Document::finish_session(std::uint64_t id) {
    StrokeReport report =
        put_down(id, in_work_.session->stroke(), in_work_.session->finish(), layers_.pigments().size());
    in_work_.session.reset();
    return report;
}

// Puts the brush of a finished stroke down. `n_pigments`: that the document has met with it.
StrokeReport Document::put_down(std::uint64_t id, const PaintStroke& stroke, SessionResult result,
                                std::size_t n_pigments) {
    UndoRecord undo{.entry = id};
    undo.tiles.push_back({stroke.layer, std::move(result.before)});
    if (!stroke.erases()) undo.brush = brushes_.put_down(stroke.brush, std::move(result.brush));
    history_.add(std::move(undo), n_pigments);
    result.report.stroke_id = id;
    return std::move(result.report);
}

HandPath Document::path_of(const PaintStroke& stroke) {
    if (stroke.trace.samples.empty()) throw Error("a stroke without samples cannot be painted");
    if (!stroke.trace.flat) return {{}, spatial_poses(stroke.trace), 0};
    const StrokeSamples steadied = steady(stroke.trace, stroke.settings);
    if (stroke.layer != kPaletteLayer) return hand_path(surface(), steadied, holder_of(stroke));
    const mesh::SurfaceQuery& plate = *palette_.model().query;
    return hand_path(plate, steadied,
                     materials_.holder(stroke.brush, plate.mesh(), stroke.settings.compensate_tip_lag));
}

// How the holder of a stroke of the model is led.
HolderOptions Document::holder_of(const PaintStroke& stroke) {
    HolderOptions holder = materials_.holder(stroke.brush, *model_.mesh, stroke.settings.compensate_tip_lag);
    if (!scratch_.drapes || &scratch_.drapes->surface() != &surface())
        scratch_.drapes = std::make_shared<Drapes>(parts_.surface());
    holder.drapes = scratch_.drapes;
    return holder;
}

// The path of a stroke of the model that is likely to be painted by itself, in work; null where it has none.
std::unique_ptr<PathAhead> Document::plan_path_ahead(const JournalEntry& entry) {
    const PaintStroke* stroke = entry.as<PaintStroke>();
    if (entry.hidden || !stroke || !stroke->trace.flat || stroke->trace.samples.empty() || on_palette(entry))
        return nullptr;
    try {
        return std::make_unique<PathAhead>(*stroke, holder_of(*stroke), surface());
    } catch (const Error&) {
        return nullptr;  // it is reported when its turn comes
    }
}

StrokeReport Document::draw(std::uint64_t id, const PaintStroke& stroke, const HandPath& path,
                            const ProgressFn& progress) {
    cancel();
    in_work_.session = make_session(stroke);
    try {
        begin_path(*in_work_.session, path, progress);
        if (thread_count() > 1 && !watcher_) {
            if (std::unique_ptr<StrokeForecast> forecast = in_work_.session->forecast(path.poses)) {
                forecast->compute_ahead();
                in_work_.session->use(std::move(forecast));
            }
        }
        const std::size_t n = path.poses.size();
        if (!watcher_) paint_poses(*in_work_.session, path.poses, 0, n);
        for (std::size_t i = 0; watcher_ && i < n; ++i) {
            paint_poses(*in_work_.session, path.poses, i, i + 1);
            watcher_(*in_work_.session, static_cast<double>(i + 1) / static_cast<double>(n));
        }
        StrokeReport report = finish_session(id);
        note_origin(report, stroke, target(stroke.layer, 0).surface);
        return report;
    } catch (...) {
        cancel();
        throw;
    }
}

}  // namespace tuft::stroke
