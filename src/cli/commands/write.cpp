#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/commands/paint.h"
#include "cli/steps/commands.h"
#include "cli/steps/model_path.h"
#include "cli/steps/steps.h"
#include "core/files/files.h"
#include "core/text/units.h"
#include "io/svg/svg.h"
#include "stroke/drawing/drawing.h"
#include "stroke/drawing/free_area.h"
#include "writer/copy/copied_glyph.h"
#include "writer/fit/writer.h"
#include "writer/text/text.h"

namespace tuft::cli {
namespace {

constexpr double kPartOfModel = 0.25;   // of the model's diagonal that a text takes at a named point
constexpr double kPartOfPath = 0.9;     // of a path on the model that a text takes
constexpr double kPartOfHeight = 0.25;  // of the model's height that characters round it have at most

/// Writes the drawing of a copy where it is wanted. Returns what is to be said of the copy.
std::string report_copy(const writer::CopiedPicture& copy, const Write& a) {
    if (!a.numbered.empty()) {
        const std::string svg = writer::numbered_svg(copy.ink.cells, copy.skeleton, copy.order);
        write_file(a.numbered, svg.data(), svg.size());
    }
    std::string out = fmt::format("{} strokes of {} pieces; --order \"{}\"", copy.order.size(),
                                  copy.skeleton.pieces.size(), writer::order_text(copy.order));
    if (copy.ink.other_colour > 0)
        out += fmt::format("; {:.3g} % of what is marked has another colour than the ink and was left out",
                           100 * copy.ink.other_colour);
    return out;
}

/// A text and what is to be said of it.
struct TextToWrite {
    writer::Text text;
    std::vector<std::string> notes;  ///< for the user
};

bool has_outlines(const writer::Text& text) {
    for (const auto& line : text.lines)
        for (const writer::Glyph& glyph : line)
            if (std::ranges::any_of(glyph.strokes, [](const auto& s) { return !s.outline.empty(); })) return true;
    return false;
}

TextToWrite read_text(const Write& a) {
    if (a.text.empty() && a.like.empty()) throw UsageError("there is nothing to write: --text or --like is missing");
    if (!a.like.empty() && writer::characters_of(a.text).size() > 1)
        throw UsageError("--like copies one character: --text is its name");
    if (!a.numbered.empty() && a.numbered.extension() != ".svg") throw UsageError("--numbered writes a drawing: .svg");
    writer::TextReader reader;
    TextToWrite out{
        reader.read({.text = a.text,
                     .glyphs = a.glyphs,
                     .style = a.style,
                     .like = a.like,
                     .correction = {.threshold = a.threshold, .cuts = writer::parse_cuts(a.cuts), .order = a.order},
                     .fit = a.fit}),
        {}};
    writer::Text& text = out.text;
    if (reader.copied()) out.notes.push_back(report_copy(*reader.copied(), a));
    if (text.kept_filled > 0)
        out.notes.push_back(
            fmt::format("characters that stay filled, too large, too heavy or too intricate for strokes of a brush: {}",
                        text.kept_filled));
    if (a.fit && text.style.kind != writer::HandKind::brush)
        out.notes.push_back("--fit changes nothing: the style is that of a pen, not of a pointed brush");
    else if (a.fit && text.kept_filled == 0 && !has_outlines(text))
        out.notes.push_back("--fit changes nothing: the source has centre lines of these characters, no outlines");
    if (text.blank()) throw UsageError("--text: there is nothing to write in it");
    text.layout.direction = *writer::direction_named(a.direction);
    if (a.spacing > 0) text.layout.spacing = a.spacing;
    if (a.line_spacing > 0) text.layout.line_spacing = a.line_spacing;
    return out;
}

/// Side of a character's square for a text in lines, metres.
double side_in_lines(const writer::Text& text, const stroke::Model& model, const Write& a) {
    if (a.size_mm > 0) return a.size_mm * kMillimetre;
    const Vec2 extent = writer::extent_of(text);
    if (a.place.width_mm > 0) return a.place.width_mm * kMillimetre / extent.x;
    if (a.place.at_mm.empty()) {
        const stroke::Side side = stroke::side_named(a.place.on).value_or(stroke::usual_side(model.mesh->bounds));
        if (const auto free = stroke::find_free_area(*model.query, side, extent.x / extent.y))
            return stroke::kUsualPart * std::min(free->size.x / extent.x, free->size.y / extent.y);
    }
    return kPartOfModel * model.mesh->bounds.diagonal() / std::max(extent.x, extent.y);
}

writer::TextHand hand_of(const Write& a) {
    return {.options = entry_options(a),
            .fit = a.fit || !a.like.empty(),
            .cache = DiskCache(a.surface.no_cache ? "" : cache_folder("writer"))};
}

/// Names the size of a brush that the user chose and that cannot draw strokes as wide as the text has at a pressure
/// that guides the tuft.
void note_size(const writer::Text& text, const Write& a, Console& console) {
    const std::string brush = entry_options(a).brush;
    if (brush.empty()) return;
    const double side = text.layout.side / kMillimetre;
    if (const auto fits = writer::size_for(text, brush))
        console.note(
            fmt::format("{} does not suit characters of {:.3g} mm, whose strokes are about {:.2g} mm wide: "
                        "--brush '{}' does",
                        brush, side, writer::kMedianStroke / writer::kSide * side, *fits));
}

/// Throws where no character can lie on the model, round which a surface is hardly four diagonals long.
void check_side(double side, const stroke::Model& model) {
    constexpr double kMostDiagonals = 4;
    const double diagonal = model.mesh->bounds.diagonal();
    if (side > kMostDiagonals * diagonal)
        throw UsageError(
            fmt::format("characters of {:.4g} mm find no room on a model of {:.4g} mm from corner to corner",
                        side / kMillimetre, diagonal / kMillimetre));
}

std::optional<PlacedDrawing> write_in_lines(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                                            writer::Text text, const Write& a, Console& console) {
    text.layout.side = side_in_lines(text, model, a);
    check_side(text.layout.side, model);
    note_size(text, a, console);
    writer::append_lines(strokes, text, hand_of(a), console.progress());
    // The strokes have the size that their brush was fitted at: it stays.
    Write at = a;
    at.place.width_mm = stroke::width_of(stroke::extent_of(stroke::drawing_in(strokes, false))) / kMillimetre;
    return place_strokes(strokes, model, at, console);
}

PathOnModel text_path(const stroke::Model& model, const Write& a, writer::Direction direction, Console& console) {
    if (direction == writer::Direction::rim) return rim_path(model, a);
    if (a.curve.empty()) throw UsageError("--direction curve needs a line on the model (see --curve)");
    return curve_path(model, a, a.curve, console);
}

std::optional<PlacedDrawing> write_along(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                                         writer::Text text, const Write& a, Console& console) {
    if (text.lines.size() > 1) throw UsageError("--direction rim and curve take a text of one line");
    const PathOnModel on = text_path(model, a, text.layout.direction, console);
    const double whole = writer::length_of(text);
    double side = std::min(kPartOfPath * on.path.length() / whole, kPartOfHeight * model.mesh->bounds.diagonal());
    if (a.place.width_mm > 0) side = a.place.width_mm * kMillimetre / whole;
    if (a.size_mm > 0) side = a.size_mm * kMillimetre;
    check_side(side, model);
    text.layout.side = side;
    note_size(text, a, console);
    writer::append_along(strokes, text, on.path, on.middle, hand_of(a), console.progress());
    Write placed = a;  // every character has its place
    placed.place.at_mm.clear(), placed.place.on.clear();
    placed.place.width_mm = 0;
    return place_strokes(strokes, model, placed, console);
}

}  // namespace

int run(const Write& a) {
    const TextToWrite read = read_text(a);
    const writer::Direction direction = read.text.layout.direction;
    const bool along = direction == writer::Direction::rim || direction == writer::Direction::curve;
    return paint(a, {.load =
                         [&](Console& console) {
                             for (const std::string& note : read.notes) console.note(note);
                             return std::vector<stroke::JournalEntry>{};
                         },
                     .place =
                         [&](std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model, Console& console) {
                             return along ? write_along(strokes, model, read.text, a, console)
                                          : write_in_lines(strokes, model, read.text, a, console);
                         }});
}

}  // namespace tuft::cli
