#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/commands.h"
#include "cli/model_path.h"
#include "cli/paint.h"
#include "cli/steps.h"
#include "core/system/files.h"
#include "core/text/units.h"
#include "io/image/image.h"
#include "io/strokes/svg.h"
#include "stroke/drawing/drawing.h"
#include "stroke/drawing/free_area.h"
#include "stroke/journal/entries.h"
#include "stroke/placement/placement.h"
#include "writer/copy/copied_glyph.h"
#include "writer/copy/photo.h"
#include "writer/fit/writer.h"
#include "writer/glyphs/glyph_source.h"
#include "writer/layout/text_layout.h"

namespace tuft::cli {
namespace {

constexpr double kPartOfModel = 0.25;   // of the model's diagonal that a text takes at a named point
constexpr double kPartOfPath = 0.9;     // of a path on the model that a text takes
constexpr double kPartOfHeight = 0.25;  // of the model's height that characters round it have at most

/// A text with its glyphs, before it is put anywhere.
struct Text {
    writer::Style style;
    std::vector<std::vector<writer::Glyph>> lines;
    writer::LayoutOptions layout;
    std::string group;
    std::string note;  ///< for the user
};

std::string group_of(std::string text) {
    for (char& c : text)
        if (c == '/' || c == '\n' || c == '\\') c = ' ';
    return stroke::group_name(text);
}

/// The character of a picture.
writer::Glyph copy_character(const Write& a, std::string& note) {
    const std::u32string name = writer::characters_of(a.text);
    if (name.size() > 1) throw UsageError("--like copies one character: --text is its name");
    const writer::Cells ink = writer::ink_of(io::read_image8(a.like), a.like.string());
    const writer::Skeleton skeleton = writer::skeleton_of(ink);
    const writer::StrokeOrder order =
        a.order.empty() ? writer::order_by_rules(skeleton) : writer::parse_order(a.order, skeleton.pieces.size());
    if (!a.numbered.empty()) {
        if (a.numbered.extension() != ".svg") throw UsageError("--numbered writes a drawing: .svg");
        const std::string svg = writer::numbered_svg(ink, skeleton, order);
        write_file(a.numbered, svg.data(), svg.size());
    }
    note = fmt::format("{} strokes of {} pieces; --order \"{}\"", order.size(), skeleton.pieces.size(),
                       writer::order_text(order));
    return writer::copied_glyph(ink, skeleton, order, name.empty() ? U'\u25A1' : name[0]);
}

std::vector<std::vector<writer::Glyph>> read_glyphs(const Write& a) {
    std::vector<std::unique_ptr<writer::GlyphSource>> sources;
    if (!a.glyphs.empty()) sources.push_back(writer::open_glyphs(a.glyphs));
    sources.push_back(writer::open_glyphs(writer::bundled_glyphs()));
    std::vector<writer::GlyphSource*> order;
    for (const auto& source : sources) order.push_back(source.get());
    return writer::glyphs_of(writer::lines_of(a.text), order);
}

Text read_text(const Write& a) {
    if (a.text.empty() && a.like.empty()) throw UsageError("there is nothing to write: --text or --like is missing");
    Text text{.style = writer::load_style(a.style),
              .group = group_of(a.text.empty() ? a.like.stem().string() : a.text)};
    if (a.like.empty())
        text.lines = read_glyphs(a);
    else
        text.lines = {{copy_character(a, text.note)}};
    const bool inked = std::any_of(text.lines.begin(), text.lines.end(), [](const auto& line) {
        return std::any_of(line.begin(), line.end(),
                           [](const writer::Glyph& g) { return !g.strokes.empty() || !g.area.empty(); });
    });
    if (!inked) throw UsageError("--text: there is nothing to write in it");
    text.layout = {.direction = *writer::direction_named(a.direction),
                   .spacing = a.spacing > 0 ? a.spacing : text.style.spacing,
                   .line_spacing = a.line_spacing > 0 ? a.line_spacing : text.style.line_spacing};
    return text;
}

/// Width and height of the text's squares at a side of 1.
Vec2 extent_of(const Text& text) {
    writer::LayoutOptions options = text.layout;
    options.side = 1;
    Vec2 lo(1e300), hi(-1e300);
    const auto corners = writer::place_in_lines(text.lines, options);
    for (std::size_t l = 0; l < corners.size(); ++l)
        for (std::size_t i = 0; i < corners[l].size(); ++i) {
            const Vec2 c = corners[l][i];
            lo = glm::min(lo, c - Vec2(0, 1));
            hi = glm::max(hi, c + Vec2(text.lines[l][i].advance / writer::kSide, 0));
        }
    return glm::max(hi - lo, Vec2(1e-3));
}

/// Side of a character's square for a text in lines, metres.
double side_in_lines(const Text& text, const stroke::Model& model, const Write& a) {
    if (a.size_mm > 0) return a.size_mm * kMillimetre;
    const Vec2 extent = extent_of(text);
    if (a.place_width_mm > 0) return a.place_width_mm * kMillimetre / extent.x;
    if (a.place_mm.empty()) {
        const stroke::Side side = stroke::side_named(a.on).value_or(stroke::usual_side(model.mesh->bounds));
        if (const auto free = stroke::find_free_area(*model.query, side, extent.x / extent.y))
            return stroke::kUsualPart * std::min(free->size.x / extent.x, free->size.y / extent.y);
    }
    return kPartOfModel * model.mesh->bounds.diagonal() / std::max(extent.x, extent.y);
}

/// Adds the strokes of one glyph, moved by `shift` (metres, y down), with a placement where there is one.
class Entries {
  public:
    Entries(std::vector<stroke::JournalEntry>& to, const Write& a, const Text& text)
        : to_(to), options_(entry_options(a)), group_{1, text.group} {}

    void add(const std::vector<writer::WrittenStroke>& strokes, const Vec2& shift,
             const std::optional<stroke::Placement>& placement) {
        std::vector<stroke::RecordedStroke> recorded;
        for (const writer::WrittenStroke& s : strokes) {
            stroke::RecordedStroke r;
            static_cast<stroke::StrokeSamples&>(r) = s.trace;
            stroke::transform_samples(r, -shift, 1);
            if (placement) r.placement = *placement, r.placed = true;
            r.brush = s.brush;
            r.label = s.label;
            r.seed = ++n_;
            recorded.push_back(std::move(r));
        }
        const std::size_t first = to_.size();
        stroke::append_entries(to_, std::move(recorded), options_);
        for (std::size_t i = first; i < to_.size(); ++i) to_[i].group = group_;
    }

  private:
    std::vector<stroke::JournalEntry>& to_;
    stroke::EntryOptions options_;
    stroke::EntryGroup group_;
    std::uint64_t n_ = 0;
};

writer::Writer make_writer(const Text& text, const Write& a, double side) {
    return writer::Writer({.style = text.style,
                           .brush = a.brush,
                           .side = side,
                           .fit = a.fit || !a.like.empty(),
                           .cache = DiskCache(a.surface.no_cache ? "" : cache_folder("writer"))});
}

std::optional<PlacedDrawing> write_in_lines(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                                            Text text, const Write& a, Console& console) {
    text.layout.side = side_in_lines(text, model, a);
    writer::Writer writer = make_writer(text, a, text.layout.side);
    const auto corners = writer::place_in_lines(text.lines, text.layout);
    Entries entries(strokes, a, text);
    for (std::size_t l = 0; l < text.lines.size(); ++l) {
        const auto written = writer.write(text.lines[l], console.progress());
        for (std::size_t i = 0; i < written.size(); ++i) entries.add(written[i], corners[l][i], std::nullopt);
    }
    // The strokes have the size that their brush was fitted at: it stays.
    Write at = a;
    at.place_width_mm = stroke::width_of(stroke::extent_of(stroke::drawing_in(strokes, false))) / kMillimetre;
    return place_strokes(strokes, model, at, console);
}

PathOnModel text_path(const stroke::Model& model, const Write& a, writer::Direction direction, Console& console) {
    if (direction == writer::Direction::rim) return rim_path(model, a);
    if (a.curve.empty()) throw UsageError("--direction curve needs a line on the model (see --curve)");
    return curve_path(model, a, a.curve, console);
}

std::optional<PlacedDrawing> write_along(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model,
                                         Text text, const Write& a, Console& console) {
    if (text.lines.size() > 1) throw UsageError("--direction rim and curve take a text of one line");
    const std::vector<writer::Glyph>& glyphs = text.lines.front();
    const PathOnModel on = text_path(model, a, text.layout.direction, console);
    double whole = 0;
    for (const writer::Glyph& g : glyphs) whole += text.layout.spacing * g.advance / writer::kSide;
    double side = std::min(kPartOfPath * on.path.length() / whole, kPartOfHeight * model.mesh->bounds.diagonal());
    if (a.place_width_mm > 0) side = a.place_width_mm * kMillimetre / whole;
    if (a.size_mm > 0) side = a.size_mm * kMillimetre;
    text.layout.side = side;
    const std::vector<double> at = writer::place_along(on.path, glyphs, on.middle, text.layout);
    writer::Writer writer = make_writer(text, a, side);
    const auto written = writer.write(glyphs, console.progress());
    Entries entries(strokes, a, text);
    for (std::size_t i = 0; i < glyphs.size(); ++i) {
        const writer::PathPlace place = writer::place_on(on.path, at[i], 0.25 * side);
        const Vec2 middle(0.5 * glyphs[i].advance / writer::kSide * side, -0.5 * side);
        entries.add(written[i], -middle,
                    stroke::Placement{.origin = place.position,
                                      .right = place.right,
                                      .down = glm::cross(place.right, place.normal),
                                      .mapping = stroke::SurfaceMapping::drape});
    }
    Write placed = a;  // every character has its place
    placed.place_mm.clear(), placed.on.clear();
    placed.place_width_mm = 0;
    return place_strokes(strokes, model, placed, console);
}

}  // namespace

int run(const Write& a) {
    const Text text = read_text(a);
    const bool along =
        text.layout.direction == writer::Direction::rim || text.layout.direction == writer::Direction::curve;
    return paint(a, {.load =
                         [&](Console& console) {
                             if (!text.note.empty()) console.note(text.note);
                             return std::vector<stroke::JournalEntry>{};
                         },
                     .place =
                         [&](std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model, Console& console) {
                             return along ? write_along(strokes, model, text, a, console)
                                          : write_in_lines(strokes, model, text, a, console);
                         }});
}

}  // namespace tuft::cli
