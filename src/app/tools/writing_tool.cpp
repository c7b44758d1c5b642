#include "app/tools/writing_tool.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/tools/aim.h"
#include "core/error.h"
#include "core/text/units.h"

namespace tuft::app {

stroke::Placement WritingTool::placement_at(const PlacingSpot& spot) const {
    const Session& s = session_;
    return place_writing(s.tools.writing, s.paint_thread->surface(), spot.at, spot.normal, camera_of(s).right,
                         spot.eye);
}

WritingBand WritingTool::band_at(const PlacingSpot& spot) const {
    Session& s = session_;
    DrawingPlace& place = s.tools.place;
    if (const auto surface = s.paint_thread->shared_surface(); !place.lines || place.lines_of != surface) {
        place.lines = std::make_unique<writer::FeatureLines>(*surface);
        place.lines_of = surface;  // after the former lines are gone
    }
    return lay_band(s.tools.writing,
                    {.query = *place.lines_of,
                     .lines = *place.lines,
                     .curve = s.tools.lettering.curve,
                     .texel = s.paint_thread->model().texels.texel_size},
                    spot.at);
}

WritingTool::PreviewKey WritingTool::key_at(const PlacingSpot& spot) const {
    const Writing& w = session_.tools.writing;
    const bool once = w.along == BandLine::none;
    return {.placement = once ? placement_at(spot) : stroke::Placement{},
            .at = once ? Vec3(0) : rounded_place(spot.at),
            .scale = w.scale,
            .along = w.along,
            .repeats = w.repeats,
            .curve = session_.tools.lettering.curve,
            .file = w.file,
            .box = {w.form().box.lo, w.form().box.hi},
            .surface = session_.paint_thread->shared_surface(),
            .mirrored = w.mirrored,
            .own_ink = w.own_ink,
            .mapping = w.mapping};
}

void WritingTool::drop_preview() {
    DrawingPlace& place = session_.tools.place;
    place.preview.clear();
    place.guides.clear();
    place.fault = {};
    place.copies = 0;
    shown_.reset();
}

void WritingTool::watch(const Event* cursor) {
    Session& s = session_;
    if (s.tools.active != Tool::writing) {
        shown_.reset();
        return;
    }
    if (std::exchange(s.tools.place.is_typed, false) && !s.tools.writing.empty())
        if (const auto typed = typed_spot(s)) place(*typed);
    const auto spot = s.tools.writing.empty() ? std::nullopt : spot_at(s, cursor);
    if (!spot) return drop_preview();
    preview(*spot);
}

void WritingTool::preview(const PlacingSpot& spot) {
    Session& s = session_;
    DrawingPlace& place = s.tools.place;
    const PreviewKey now = key_at(spot);
    const Seen seen{camera_of(s), section_plane(s.view, s.paint_thread->model().mesh->bounds)};
    const bool once = now.along == BandLine::none, same = shown_ == now;
    show_place(s.tools, once ? now.placement.origin : now.at);
    if (once) place.guides = spot.guides;
    if (same && seen == seen_) return;
    if (!same) {
        drop_preview();
        if (once) {
            place.guides = spot.guides;
            place.preview = preview_lines(s.paint_thread->surface(), s.tools.writing, now.placement);
        } else {
            show_band(spot);
        }
    }
    find_seen(place.preview, s);
    shown_ = now;
    seen_ = seen;
}

void WritingTool::show_band(const PlacingSpot& spot) {
    Session& s = session_;
    DrawingPlace& place = s.tools.place;
    try {
        WritingBand band = band_at(spot);
        place.preview = preview_lines(s.paint_thread->surface(), s.tools.writing, band);
        place.copies = band.band.repeats;
        place.copy_width = band.band.width;
        // Which edge was found; a level line goes through the cursor, and a curve was set by hand.
        if (s.tools.writing.along != BandLine::edge) return;
        if (band.path.closed) band.path.points.push_back(band.path.points.front());
        place.guides = {std::move(band.path.points)};
    } catch (const Error& error) {
        place.fault = error.message();
    }
}

void WritingTool::wheel(const Event& e) {
    Writing& w = session_.tools.writing;
    if (e.modifiers & kShift)
        w.turn = std::remainder(w.turn + 3 * kDegree * e.steps, 360 * kDegree);
    else
        w.scale = std::clamp(w.scale * std::pow(1.05, e.steps), 1e-3, 1e3);
}

void WritingTool::place(const Event* cursor) {
    if (session_.tools.writing.empty()) return;
    if (const auto at = spot_at(session_, cursor)) place(*at);
}

void WritingTool::place(const PlacingSpot& spot) {
    Session& s = session_;
    const Writing& w = s.tools.writing;
    // Pressures that are made up stay as they are while the slider is where it is at first.
    const WritingHand hand{s.brush.preset, s.brush.ink, s.tools.pointer.pressure / PointerSettings{}.pressure};
    PaintDrawing command{.drawing = {}, .group = group_settings(s, stroke::group_name(w.file))};
    std::string words;
    try {
        if (w.along == BandLine::none) {
            const stroke::Placement at = placement_at(spot);
            command.drawing = placed_writing(w, at, hand);
            words = place_words(w, at);
        } else {
            const WritingBand band = band_at(spot);
            command.drawing = placed_writing(w, band, hand);
            words = place_words(w, band);
        }
    } catch (const Error& error) {
        return show_message(s.status, error.message());
    }
    show_message(s.status, Message("Placed: {}", words));
    s.paint_thread->post(std::move(command));
}

}  // namespace tuft::app
