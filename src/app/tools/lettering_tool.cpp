#include "app/tools/lettering_tool.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/session/open_files.h"
#include "app/tools/aim.h"
#include "core/text/units.h"

namespace tuft::app {
namespace {

constexpr double kLeastSide = 1e-3, kMostSide = 2;  // metres

}  // namespace

LetteringPlace LetteringTool::place_at(const PlacingSpot& spot) const {
    const Session& s = session_;
    return place_lettering(s.tools.lettering, s.paint_thread->surface(), spot.at, spot.normal, camera_of(s).right,
                           spot.eye);
}

void LetteringTool::drop_preview() {
    session_.tools.place.preview.clear();
    shown_.reset();
}

// Who takes another brush from the rack wants to write with it.
void LetteringTool::follow_brush() {
    Session& s = session_;
    if (!preset_.empty() && preset_ != s.brush.preset) s.tools.lettering.style_brush = false;
    preset_ = s.brush.preset;
}

void LetteringTool::watch(const Event* cursor) {
    Session& s = session_;
    Lettering& l = s.tools.lettering;
    if (s.tools.active != Tool::text) {
        preset_.clear();
        shown_.reset();
        return;
    }
    if (!(l.side > 0)) {
        l.side = usual_side(s.paint_thread->model().mesh->bounds);
        preset_.clear();  // of another project: this one's brush is no choice from the rack
    }
    follow_brush();
    lay_out(l);
    if (std::exchange(s.tools.place.is_typed, false) && !l.empty())
        if (const auto typed = typed_spot(s)) place(*typed);
    const bool shows = !l.empty() && !s.tools.letters.busy(l) && !s.reported.file.viewing;
    const auto spot = shows ? spot_at(s, cursor) : std::nullopt;
    s.tools.place.guides.clear();
    s.tools.place.fault = {};
    if (!spot) return drop_preview();
    if (l.direction == writer::Direction::horizontal || l.direction == writer::Direction::vertical)
        s.tools.place.guides = spot->guides;
    try {
        preview(*spot);
    } catch (const Error& error) {
        drop_preview();
        s.tools.place.fault = error.message();
    }
}

void LetteringTool::preview(const PlacingSpot& spot) {
    Session& s = session_;
    const Lettering& l = s.tools.lettering;
    show_place(s.tools, spot.at);
    PreviewKey now{.at = spot.at,
                   .normal = spot.normal,
                   .eye = spot.eye,
                   .camera = camera_of(s),
                   .section = section_plane(s.view, s.paint_thread->model().mesh->bounds),
                   .layout = l.text->layout,
                   .turn = l.turn,
                   .revision = l.revision,
                   .curve = l.curve.size()};
    if (shown_ == now) return;
    s.tools.place.preview = preview_lines(s.paint_thread->surface(), l, place_at(spot));
    find_seen(s.tools.place.preview, s);
    shown_ = now;
}

void LetteringTool::wheel(const Event& e) {
    Lettering& l = session_.tools.lettering;
    if (e.modifiers & kShift)
        l.turn = std::remainder(l.turn + 3 * kDegree * e.steps, 360 * kDegree);
    else
        l.side = std::clamp(l.side * std::pow(1.05, e.steps), kLeastSide, kMostSide);
}

void LetteringTool::place(const Event* cursor) {
    if (session_.tools.lettering.empty()) return;
    if (const auto at = spot_at(session_, cursor)) place(*at);
}

void LetteringTool::place(const PlacingSpot& spot) {
    Session& s = session_;
    const Lettering& l = s.tools.lettering;
    // Else what is written would be another text than the one in the field.
    if (s.tools.letters.busy(l)) return show_message(s.status, "The characters of the text are still being read");
    try {
        PaintText command{.text = *l.text,
                          .place = place_at(spot),
                          .brush = l.style_brush ? "" : s.brush.preset,
                          .ink = s.brush.ink,
                          .fit = l.fitted(),
                          .group = group_settings(s, l.text->group)};
        if (const auto* on = std::get_if<LetteringPath>(&command.place))
            writer::places_along(command.text, on->path, on->middle);  // a text that is too long is refused here
        show_message(s.status, Message("Written: {}", place_words(l, command.place, s.brush.preset)));
        s.paint_thread->post(std::move(command));
        if (!l.wanted.like.empty()) keep_copy(s);
    } catch (const Error& error) {
        show_message(s.status, error.message());
    }
}

}  // namespace tuft::app
