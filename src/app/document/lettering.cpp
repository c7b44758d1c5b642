#include "app/document/lettering.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/files/modified_time.h"
#include "core/text/units.h"
#include "stroke/drawing/drawing.h"

namespace tuft::app {
namespace {

// A preview follows the cursor: of longer texts less is shown.
constexpr std::size_t kMostStrokesShown = 750, kMostCharactersShown = 60;
constexpr double kUsualPart = 0.1;  // of the model's diagonal
constexpr double kShownStep = 0.1;  // of a character's side: the longest straight part of its preview
constexpr int kMostAcross = 1024;   // pixels of a copied picture in its panel

/// Rounded to a thousandth, as `place_words` states it.
double rounded(double value) {
    return std::round(value * 1000) / 1000;
}

/// The curve up to where it leaves the surface, and its point nearest to `at`.
LetteringPath path_of(const mesh::SurfaceQuery& query, const std::vector<CurvePoint>& points, const Vec3& at) {
    LetteringPath on{.path = path_of_curve(query, points)};
    double nearest = 1e300, along = 0;
    for (std::size_t i = 0; i < on.path.points.size(); ++i) {
        if (i > 0) along += glm::distance(on.path.points[i - 1], on.path.points[i]);
        if (const double away = glm::distance(on.path.points[i], at); away < nearest) nearest = away, on.middle = along;
    }
    return on;
}

/// The middle of the text on an open path, where all of it has room.
double kept_within(const LetteringPath& on, double length) {
    const double room = on.path.length();
    return length < room ? std::clamp(on.middle, 0.5 * length, room - 0.5 * length) : 0.5 * room;
}

/// The line with points at most `step` apart: on the model it bends, and each part of it is hidden by itself.
std::vector<Vec2> divided(const std::vector<Vec2>& line, double step) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (i > 0) {
            const int n = static_cast<int>(std::ceil(glm::distance(line[i - 1], line[i]) / step));
            for (int k = 1; k < n; ++k) out.push_back(glm::mix(line[i - 1], line[i], static_cast<double>(k) / n));
        }
        out.push_back(line[i]);
    }
    return out;
}

void divide(std::vector<std::vector<Vec2>>& lines, double side) {
    for (std::vector<Vec2>& line : lines) line = divided(line, kShownStep * side);
}

Box box_of(const std::vector<std::vector<Vec2>>& lines) {
    Box box;
    for (const std::vector<Vec2>& line : lines)
        for (const Vec2& p : line) box.add(Vec3(p, 0));
    return box;
}

std::vector<stroke::JournalEntry> entries_in_lines(const writer::Text& text, const stroke::Placement& placement,
                                                   const writer::TextHand& hand, const stroke::BrushFit& fit,
                                                   stroke::WidthTables& widths, const ProgressFn& progress) {
    std::vector<stroke::JournalEntry> entries;
    writer::append_lines(entries, text, hand, progress);
    const std::vector<stroke::StrokeSamples*> drawing = stroke::drawing_in(entries, false);
    for (stroke::StrokeSamples* trace : drawing) trace->placement.mapping = placement.mapping;
    const Box box = stroke::extent_of(drawing);
    stroke::place_drawing(drawing, {placement, Vec2(box.centre()), 1, false});
    stroke::choose_brushes(entries, {drawing, 1, std::max(box.size().x, box.size().y)}, fit, widths);
    return entries;
}

std::size_t strokes_in(const writer::Text& text) {
    std::size_t n = 0;
    for (const auto& line : text.lines)
        for (const writer::Glyph& glyph : line) n += glyph.strokes.size() + glyph.area.size();
    return n;
}

std::vector<PreviewPoint> line_through(const std::vector<stroke::Placement>& places) {
    std::vector<PreviewPoint> line;
    for (const stroke::Placement& p : places)
        line.push_back({.position = p.origin, .normal = glm::cross(p.down, p.right)});
    return line;
}

}  // namespace

double usual_side(const Box& model) {
    const double side = kUsualPart * model.diagonal(), step = std::pow(10, std::floor(std::log10(side)) - 1);
    return std::round(side / step) * step;
}

void copy_picture(Lettering& l, const std::filesystem::path& picture) {
    l.wanted.like = picture;
    l.wanted.correction = {};
    l.copy.shown.reset();
    l.copy.earlier.clear();
    l.copy.let_go();
    l.reread = true;
    set_text(l, "");  // the text of before is no name of one character
}

void lay_out(Lettering& l) {
    if (!l.text) return;
    const writer::Style& style = l.text->style;
    l.text->layout = {.direction = l.direction,
                      .side = kMillimetre * rounded(l.side / kMillimetre),
                      .spacing = l.spacing.characters > 0 ? rounded(l.spacing.characters) : style.spacing,
                      .line_spacing = l.spacing.lines > 0 ? rounded(l.spacing.lines) : style.line_spacing};
}

LetteringReader::Read LetteringReader::read(const writer::TextRequest& request) {
    Read out;
    try {
        if (request.text.empty() && request.like.empty()) return out;
        // Before it is read: what is written meanwhile is shown after the next read.
        const auto time = modified_time(request.like);
        writer::Text text = reader_.read(request, [this](std::string_view, double) { return !stop_; });
        if (!text.blank()) out.text = std::move(text);
        out.copy = reader_.copied();
        if (out.copy && (request.like != shown_ || time != shown_time_))
            out.picture = small_picture(reader_.picture(), kMostAcross);
        shown_ = out.copy ? request.like : "", shown_time_ = time;
    } catch (const Cancelled&) {
        out.stopped = true;
    } catch (const std::exception& error) {
        out.fault = message_of(error);
    }
    return out;
}

void LetteringReader::take(Lettering& l, Read read) {
    if (read.stopped) return;
    l.text = std::move(read.text);
    l.fault = std::move(read.fault);
    ++l.revision;
    // What was edited meanwhile is newer.
    if (l.wanted == asked_ && !l.reread) l.copy.take(std::move(read.copy), asked_.correction);
    if (!read.picture.rgb.empty()) l.copy.picture = std::move(read.picture), l.copy.fresh = true;
}

void LetteringReader::update(Lettering& l) {
    if (reading_.valid()) {
        if (!(l.wanted == asked_)) stop_ = true;
        if (reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return lay_out(l);
        take(l, reading_.get());
    }
    lay_out(l);
    if (l.wanted == asked_ && !l.reread && !stop_) return;
    asked_ = l.wanted, l.reread = false, stop_ = false;
    reading_ = std::async(std::launch::async, [this, request = asked_] { return read(request); });
}

bool LetteringPath::operator==(const LetteringPath& other) const {
    return path.points == other.path.points && middle == other.middle && at == other.at;
}

LetteringPlace place_lettering(const Lettering& l, const mesh::SurfaceQuery& query, const Vec3& at, const Vec3& normal,
                               const Vec3& right, const Vec3& eye) {
    const Vec3 place = rounded_place(at);
    if (l.direction == writer::Direction::rim) {
        const auto on = query.closest_point(place);
        if (!on) throw Error(Message("the model has no surface"));
        return LetteringPath{writer::level_section(query, on->position), 0, place};
    }
    if (l.direction == writer::Direction::curve) {
        LetteringPath on = path_of(query, l.curve, at);
        on.middle = kept_within(on, l.text->layout.side * writer::length_of(*l.text));
        return on;
    }
    return place_flat(query, at, normal, right, eye, {l.turn, stroke::SurfaceMapping::drape});
}

std::vector<std::vector<PreviewPoint>> preview_lines(const mesh::SurfaceQuery& query, const Lettering& l,
                                                     const LetteringPlace& place, std::size_t most) {
    const writer::Text& text = *l.text;
    if (const auto* placement = std::get_if<stroke::Placement>(&place)) {
        const bool whole = strokes_in(text) < kMostStrokesShown;
        std::vector<std::vector<Vec2>> lines = whole ? writer::outlined_lines(text) : writer::middle_lines(text);
        const Vec2 centre(box_of(lines).centre());
        if (whole) divide(lines, text.layout.side);
        for (std::vector<Vec2>& line : lines)
            for (Vec2& p : line) p -= centre;
        return preview_lines(query, lines, *placement, most);
    }
    const LetteringPath& on = std::get<LetteringPath>(place);
    const std::vector<stroke::Placement> places = writer::places_along(text, on.path, on.middle);
    if (places.size() > kMostCharactersShown) return {line_through(places)};
    std::vector<std::vector<std::vector<Vec2>>> characters = writer::outlined_characters(text);
    std::vector<std::vector<PreviewPoint>> all;
    for (std::size_t i = 0; i < characters.size(); ++i) {
        if (characters[i].empty()) continue;
        divide(characters[i], text.layout.side);
        auto lines = preview_lines(query, characters[i], places[i], std::max<std::size_t>(8, most / characters.size()));
        std::move(lines.begin(), lines.end(), std::back_inserter(all));
    }
    return all;
}

std::string place_words(const Lettering& l, const LetteringPlace& place, const std::string& brush) {
    const writer::TextRequest& wanted = l.wanted;
    std::string words = wanted.like.empty() ? "--text " + quoted(wanted.text) : copy_words(wanted);
    words += fmt::format(" --style {} --size {:.3f} --direction {}", wanted.style, l.side / kMillimetre,
                         writer::name_of(l.direction));
    if (!wanted.glyphs.empty()) words += " --glyphs " + quoted(wanted.glyphs.string());
    if (l.spacing.characters > 0) words += fmt::format(" --spacing {:.3f}", l.spacing.characters);
    if (l.spacing.lines > 0) words += fmt::format(" --line-spacing {:.3f}", l.spacing.lines);
    if (!l.style_brush) words += " --brush " + quoted(brush);
    if (wanted.fit) words += " --fit";
    if (const auto* placement = std::get_if<stroke::Placement>(&place)) return words + " " + place_words(*placement);
    if (l.direction != writer::Direction::rim) return words;
    const Vec3 at = std::get<LetteringPath>(place).at / kMillimetre;
    return words + fmt::format(" --place {:.3f},{:.3f},{:.3f}", at.x, at.y, at.z);
}

std::vector<stroke::JournalEntry> lettering_entries(const writer::Text& text, const LetteringPlace& place,
                                                    const writer::TextHand& hand, stroke::BrushFit fit,
                                                    stroke::WidthTables& widths, const ProgressFn& progress) {
    fit.grow = fit.fit = hand.options.brush.empty();
    std::vector<stroke::JournalEntry> entries;
    if (const auto* placement = std::get_if<stroke::Placement>(&place)) {
        entries = entries_in_lines(text, *placement, hand, fit, widths, progress);
    } else {
        const LetteringPath& on = std::get<LetteringPath>(place);
        writer::append_along(entries, text, on.path, on.middle, hand, progress);
        stroke::choose_brushes(entries, {}, fit, widths);
    }
    stroke::redip_long_lines(entries, fit, widths);
    stroke::press_to_widths(entries, widths);
    return entries;
}

}  // namespace tuft::app
