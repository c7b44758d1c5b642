#include "app/tools/stroke_input.h"

#include "app/tools/aim.h"
#include "app/tools/palette_input.h"
#include "brush/preset/preset.h"

namespace tuft::app {
namespace {

constexpr double kPoolDepth = 60;  // film units in the middle of a pool: 0.6 mm

}  // namespace

BeginStroke stroke_to_begin(const Session& s) {
    return {.brush = s.brush.preset,
            .ink = s.brush.ink,
            .symmetry = s.tools.symmetry,
            .persistent = s.brush.persistent,
            .as_it_is = s.brush.persistent && s.colours.palette.shown,
            .layer = s.layers.active,
            .mask = s.masks.active,
            .erases = s.brush.erases,
            .wet = s.brush.wet,
            .tip_ink = s.brush.two_inks ? s.brush.tip_ink : "",
            .tip_depth = s.brush.tip_depth};
}

BeginStroke stroke_to_stir(const Session& s) {
    return {.brush = s.brush.preset,
            .ink = s.brush.ink,
            .persistent = true,
            .as_it_is = true,
            .layer = stroke::kPaletteLayer,
            .wet = true};
}

void StrokeInput::press(const Event& e) {
    Session& s = session_;
    try {
        surface_ = s.paint_thread->shared_surface();
        start(*surface_, brush::load_preset(s.brush.preset), false);
    } catch (const Error& error) {
        show_message(s.status, error.message());
        return;
    }
    const Aim aim = aim_of(s, e);
    if (const auto hit = hand_->find_surface(aim); hit && hit->back)
        show_message(
            s.status,
            hit->inside
                ? Message("There is a hole here; the back of a surface, which shows through it, takes no ink. If all "
                          "of the model shows its back, open it again with its faces turned round.")
                : Message("The surface shows its back here and may take no ink. If all of the model does, open it "
                          "again with its faces turned round."));
    post(hand_->move(aim), e.time);
}

void StrokeInput::press_palette(const Event& e) {
    Session& s = session_;
    if (e.button != 0) return;
    const Aim at_plate = palette_aim(s.colours.palette, e);
    const Vec3 at{at_plate.ray.origin.x, at_plate.ray.origin.y, 0};
    if (s.colours.palette.tool == PaletteTool::pick) return s.paint_thread->post(PickInk{at, true});
    if (s.colours.palette.tool == PaletteTool::pour) {
        stroke::Fill pool{.film = kPoolDepth,
                          .gradient = stroke::Gradient::round,
                          .to_film = 0,
                          .from = at,
                          .to = at + Vec3{s.colours.palette.radius, 0, 0}};
        return s.paint_thread->post(FillModel{.ink = s.brush.ink, .fill = pool, .layer = stroke::kPaletteLayer});
    }
    try {
        if (!plate_) plate_ = stroke::make_palette();
        start(*plate_->query, brush::load_preset(s.brush.preset), true);
    } catch (const Error& error) {
        show_message(s.status, error.message());
        return;
    }
    s.brush.erases = false;
    post(hand_->move(at_plate), e.time);
}

void StrokeInput::start(const mesh::SurfaceQuery& surface, const brush::Preset& preset, bool on_plate) {
    Session& s = session_;
    hand_.emplace(surface, preset, s.tools.pointer, tip_lag_.find(preset));
    s.tools.pointer_down = true;
    on_plate_ = on_plate;
}

Aim StrokeInput::aim(const Event& e) const {
    return on_plate_ ? palette_aim(session_.colours.palette, e) : aim_of(session_, e);
}

void StrokeInput::move(const Event& e) {
    post(hand_->move(aim(e)), e.time);
}

// The stroke goes on under the cursor, as on a banding wheel.
void StrokeInput::follow_view(const Event& cursor) {
    if (hand_ && !on_plate_) move(cursor);
}

void StrokeInput::release(const Event& e) {
    move(e);
    lift(e.time);
}

void StrokeInput::cancel() {
    drop();
    session_.paint_thread->post(CancelStroke{});
}

void StrokeInput::lift(double now) {
    if (hand_ && session_.paint_thread) post(hand_->lift(), now);
    drop();
}

void StrokeInput::drop() {
    hand_.reset();
    session_.tools.pointer_down = false;
}

void StrokeInput::post(std::vector<StrokeStep> steps, double time) {
    Session& s = session_;
    for (StrokeStep& step : steps) {
        if (step.kind == StrokeStep::Kind::begin)
            s.paint_thread->post(on_plate_ ? stroke_to_stir(s) : stroke_to_begin(s));
        else if (step.kind == StrokeStep::Kind::end)
            s.paint_thread->post(EndStroke{});
        else {
            ++samples_;
            sent_at_.push_back(time);
            s.paint_thread->post(ExtendStroke{std::move(step.poses), time});
        }
    }
}

void StrokeInput::shown(double now) {
    for (; !sent_at_.empty() && sent_at_.front() <= session_.reported.progress.done; sent_at_.pop_front())
        delays_.push_back(now - sent_at_.front());
}

}  // namespace tuft::app
