#include "stroke/painting/paint_stroke.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contact/node_contact.h"
#include "stroke/gesture/hand.h"
#include "stroke/gesture/resample.h"
#include "stroke/painting/perform_entry.h"
#include "stroke/placement/drape.h"

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

// An eraser lets no ink flow.
WetFilmInUse wet_film_for(PaintedModel& painted, const PaintStroke& stroke, const PaintTarget& target) {
    if (stroke.settings.film != FilmModel::wet || stroke.erases()) return {};
    if (target.on_palette) return {painted.palette.plate().film.get(), painted.palette.plate().params};
    return {&painted.film_within(stroke.mask), ink::film_params(target.substrate, stroke.settings.down)};
}

}  // namespace

void check_size(const PaintedModel& painted, const JournalEntry& entry) {
    const PaintStroke* stroke = entry.as<PaintStroke>();
    if (!stroke || on_palette(entry)) return;
    const brush::Preset& preset = painted.materials.brush(stroke->brush);
    const double texel = painted.model.texels.texel_size;
    check_width(preset, texel);
    if (!stroke->trace.flat) return;
    // On the surface the hand's path is longer or shorter than what was drawn; twice as short it is nowhere.
    constexpr double kShorter = 2;
    const ink::Ink ink = stroke->erases() || stroke->ink.empty() ? ink::Ink{} : painted.materials.ink(stroke->ink);
    std::vector<brush::Pose> drawn;
    for (const StrokeSample& s : steady(stroke->trace, stroke->settings).samples)
        drawn.push_back({.position = {s.position.x, s.position.y, 0}, .time = s.time});
    check_path_length(drawn, {.step = kShorter * pose_spacing(*stroke, preset, ink, texel), .lever = preset.length});
}

BrushStart brush_start(PaintedModel& painted, const PaintStroke& stroke) {
    const StrokeSettings& settings = stroke.settings;
    return {.preset = painted.preset_of(stroke.brush, settings.spine),
            .name = stroke.brush,
            .ink = stroke.ink,
            .mix = stroke.erases() ? ink::Mix{} : painted.mix_of(stroke.ink),
            .seed = stroke.seed,
            .dip = settings.dip};
}

BrushInHand take_up(const PaintedModel& painted, const PaintStroke& stroke, const BrushStart& start) {
    return stroke.erases() ? clean_brush(start.preset) : painted.brushes.take_up_for_stroke(start);
}

SessionInput session_input(PaintedModel& painted, PaintStroke stroke, const TilePlan* plan) {
    const PaintTarget target = painted.target(stroke.layer, stroke.mask);
    check_width(painted.materials.brush(stroke.brush), target.model.texels.texel_size);
    WetFilmInUse wet = wet_film_for(painted, stroke, target);
    const SeamLinksFn seams = [&painted, plan, on_palette = target.on_palette]() -> const atlas::SeamLinks& {
        if (plan) throw OutsideTiles();
        return on_palette ? painted.palette.plate().seams : painted.film.seams();
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
            .scratch = *painted.scratch.plans,
            .seams = seams,
            .record_forces = painted.record_forces};
}

std::unique_ptr<StrokeSession> make_session(PaintedModel& painted, PaintStroke stroke) {
    settle(painted, stroke);
    const BrushStart start = brush_start(painted, stroke);
    SessionInput input = session_input(painted, std::move(stroke), nullptr);
    input.brush = take_up(painted, input.stroke, start);
    if (!input.stroke.erases()) input.ink = painted.materials.ink(input.brush.dipped);
    return std::make_unique<StrokeSession>(std::move(input));
}

StrokeReport put_down(PaintedModel& painted, std::uint64_t id, const PaintStroke& stroke, SessionResult result,
                      std::size_t n_pigments) {
    UndoRecord undo{.entry = id};
    undo.tiles.push_back({stroke.layer, std::move(result.before)});
    if (!stroke.erases()) undo.brush = painted.brushes.put_down(stroke.brush, std::move(result.brush));
    painted.history.add(std::move(undo), n_pigments);
    result.report.stroke_id = id;
    return std::move(result.report);
}

HolderOptions holder_of(PaintedModel& painted, const PaintStroke& stroke) {
    HolderOptions holder =
        painted.materials.holder(stroke.brush, *painted.model.mesh, stroke.settings.compensate_tip_lag);
    if (!painted.scratch.drapes || &painted.scratch.drapes->surface() != &painted.surface())
        painted.scratch.drapes = std::make_shared<Drapes>(painted.parts.surface());
    holder.drapes = painted.scratch.drapes;
    return holder;
}

HandPath path_of(PaintedModel& painted, const PaintStroke& stroke) {
    if (stroke.trace.samples.empty()) throw Error("a stroke without samples cannot be painted");
    if (!stroke.trace.flat) return {{}, spatial_poses(stroke.trace), 0};
    const StrokeSamples steadied = steady(stroke.trace, stroke.settings);
    if (stroke.layer != kPaletteLayer) return hand_path(painted.surface(), steadied, holder_of(painted, stroke));
    const mesh::SurfaceQuery& plate = *painted.palette.model().query;
    return hand_path(plate, steadied,
                     painted.materials.holder(stroke.brush, plate.mesh(), stroke.settings.compensate_tip_lag));
}

std::unique_ptr<PathAhead> plan_path_ahead(PaintedModel& painted, const JournalEntry& entry) {
    const PaintStroke* stroke = entry.as<PaintStroke>();
    if (entry.hidden || !stroke || !stroke->trace.flat || stroke->trace.samples.empty() || on_palette(entry))
        return nullptr;
    try {
        return std::make_unique<PathAhead>(*stroke, holder_of(painted, *stroke), painted.surface());
    } catch (const Error&) {
        return nullptr;  // it is reported when its turn comes
    }
}

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

}  // namespace tuft::stroke
