#include "writer/text/text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/files/modified_time.h"
#include "core/hash.h"
#include "core/system/parallel.h"
#include "stroke/drawing/drawing.h"
#include "writer/copy/copied_glyph.h"
#include "writer/fit/writer.h"

namespace tuft::writer {
namespace {

constexpr double kTangentReach = 0.25;   // parts of the side over which the direction of a path is taken
constexpr std::size_t kMostKept = 2000;  // characters of a font as strokes, of texts before

bool is_drawn(const Glyph& glyph, const Style& style) {
    return glyph.single_line || style.kind != HandKind::brush;
}

/// The middle of a character's square, metres, y down, from its lower left corner.
Vec2 middle_of(const Glyph& glyph, double side) {
    return {0.5 * glyph.advance / kSide * side, -0.5 * glyph.down / kSide * side};
}

/// Adds the strokes of one glyph, moved by `shift` (metres, y down), with a placement where there is one.
class Entries {
  public:
    Entries(std::vector<stroke::JournalEntry>& to, const Text& text, const TextHand& hand)
        : to_(to), options_(hand.options), group_{1, text.group} {}

    void add(const std::vector<WrittenStroke>& strokes, const Vec2& shift,
             const std::optional<stroke::Placement>& placement) {
        std::vector<stroke::RecordedStroke> recorded;
        for (const WrittenStroke& s : strokes) {
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

Writer writer_for(const Text& text, const TextHand& hand) {
    return Writer({.style = text.style,
                   .brush = hand.options.brush,
                   .side = text.layout.side,
                   .fit = hand.fit,
                   .cache = hand.cache});
}

/// Progress of one line of several.
ProgressFn part_of(const ProgressFn& progress, std::size_t line, std::size_t lines) {
    if (!progress) return {};
    return [&progress, line, lines](std::string_view phase, double fraction) {
        return progress(phase, (static_cast<double>(line) + fraction) / static_cast<double>(lines));
    };
}

/// Adds the lines of a glyph, moved by `shift` (metres, y down).
void add_outlined(std::vector<std::vector<Vec2>>& lines, const Glyph& glyph, const Text& text, const Vec2& shift) {
    const double unit = text.layout.side / kSide, slant = is_drawn(glyph, text.style) ? text.style.slant : 0;
    const auto add = [&](const std::vector<Vec2>& points, bool closed) {
        if (points.empty()) return;
        std::vector<Vec2>& line = lines.emplace_back();
        for (const Vec2& p : points) {
            const Vec2 q = leaned(p, glyph, slant);
            line.push_back(shift + unit * Vec2(q.x, -q.y));
        }
        if (closed) line.push_back(line.front());
    };
    for (const Ring& ring : glyph.area) add(ring, true);
    if (!glyph.area.empty()) return;
    for (const GlyphStroke& stroke : glyph.strokes) add(stroke.median, false);
}

using Lines = std::vector<std::vector<Glyph>>;

/// The lines as they are set: those of the text or, in columns, its glyphs as they stand there, which `columns` holds.
const Lines& set_lines(const Text& text, Lines& columns) {
    if (text.layout.direction != Direction::vertical) return text.lines;
    columns = text.lines;
    for (std::vector<Glyph>& column : columns)
        for (Glyph& glyph : column) glyph = in_column(std::move(glyph));
    return columns;
}

const std::vector<Glyph>& only_line(const Text& text) {
    if (text.lines.size() != 1) throw Error(Message("round a rim and along a curve a text has one line"));
    return text.lines.front();
}

std::uint64_t hash_of(const std::vector<Ring>& area) {
    std::uint64_t hash = area.size();
    for (const Ring& ring : area) hash = hash_span(std::span<const Vec2>(ring), hash);
    return hash;
}

template <class F>
void for_areas(Text& text, F&& f) {
    for (std::vector<Glyph>& line : text.lines)
        for (Glyph& glyph : line)
            if (!glyph.area.empty()) f(glyph);
}

}  // namespace

bool Text::blank() const {
    return std::none_of(lines.begin(), lines.end(), [](const auto& line) {
        return std::any_of(line.begin(), line.end(),
                           [](const Glyph& g) { return !g.strokes.empty() || !g.area.empty(); });
    });
}

Glyph TextReader::copy(const TextRequest& request) {
    const std::u32string name = characters_of(request.text);
    if (name.size() > 1) throw Error(Message("a picture is copied as one character, and the text is its name"));
    const auto changed = modified_time(request.like);
    if (request.like != picture_path_ || changed != picture_time_) {
        picture_path_.clear();
        picture_ = io::read_image8(request.like);
        picture_path_ = request.like, picture_time_ = changed;
    }
    copied_ = take_apart(picture_, request.like.string(), request.correction);
    return copied_glyph(copied_->ink.cells, copied_->skeleton, copied_->order, name.empty() ? U'\u25A1' : name[0]);
}

/// Makes strokes of the areas of fonts, of equal ones once.
void TextReader::make_strokes(Text& text, const ProgressFn& progress) {
    std::map<std::uint64_t, const Glyph*> own;
    for_areas(text, [&](const Glyph& glyph) { own.emplace(hash_of(glyph.area), &glyph); });
    if (made_.size() > kMostKept) std::erase_if(made_, [&](const auto& made) { return !own.contains(made.first); });
    std::erase_if(own, [&](const auto& character) { return made_.contains(character.first); });
    const std::vector<std::pair<std::uint64_t, const Glyph*>> fresh(own.begin(), own.end());
    // In batches, so that progress is reported, a stop is heard, and what was made till then is kept.
    const std::size_t batch = 2 * static_cast<std::size_t>(std::max(1, thread_count()));
    for (std::size_t begin = 0; begin < fresh.size(); begin += batch) {
        report(progress, "writing", static_cast<double>(begin) / static_cast<double>(fresh.size()));
        const std::size_t n = std::min(batch, fresh.size() - begin);
        std::vector<Glyph> written(n);
        parallel_for(n, 1, [&](std::size_t lo, std::size_t hi) {
            for (std::size_t i = lo; i < hi; ++i) written[i] = strokes_of_area(*fresh[begin + i].second);
        });
        for (std::size_t i = 0; i < n; ++i) made_[fresh[begin + i].first] = std::move(written[i].strokes);
    }
    for_areas(text, [&](Glyph& glyph) {
        const std::vector<GlyphStroke>& strokes = made_.at(hash_of(glyph.area));
        if (strokes.empty()) {
            ++text.kept_filled;
            return;
        }
        glyph.strokes = strokes;
        glyph.area.clear();
    });
}

Text TextReader::read(const TextRequest& request, const ProgressFn& progress) {
    Text text{.style = load_style(request.style),
              .lines = {},
              .layout = {},
              .group = group_of(request.text),
              .kept_filled = 0};
    text.layout.spacing = text.style.spacing;
    text.layout.line_spacing = text.style.line_spacing;
    copied_.reset();
    if (!request.like.empty()) {
        text.lines = {{copy(request)}};
        if (request.text.empty()) text.group = group_of(request.like.stem().string());
        return text;
    }
    if (request.glyphs != path_) {
        own_.reset();
        path_.clear();
        made_.clear();
        if (!request.glyphs.empty()) own_ = open_glyphs(request.glyphs);
        path_ = request.glyphs;
    }
    if (!bundled_) bundled_ = open_glyphs(bundled_glyphs());
    std::vector<GlyphSource*> order;
    if (own_) order.push_back(own_.get());
    order.push_back(bundled_.get());
    std::vector<std::u32string> lines = lines_of(request.text);
    while (lines.size() > 1 && lines.back().empty()) lines.pop_back();
    text.lines = glyphs_of(lines, order);
    if (request.fit && text.style.kind == HandKind::brush) make_strokes(text, progress);
    for (std::vector<Glyph>& line : text.lines) space_scripts(line);
    return text;
}

std::string group_of(std::string_view text) {
    std::string name;
    for (const std::u32string& line : lines_of(text)) {
        if (!name.empty()) name += ' ';
        for (const char32_t c : line) name += c == '/' || c == '\\' ? " " : utf8_of(c);
    }
    return stroke::group_name(name);
}

Vec2 extent_of(const Text& text) {
    LayoutOptions options = text.layout;
    options.side = 1;
    Vec2 lo(1e300), hi(-1e300);
    Lines columns;
    const Lines& lines = set_lines(text, columns);
    const auto corners = place_in_lines(lines, options);
    for (std::size_t l = 0; l < corners.size(); ++l)
        for (std::size_t i = 0; i < corners[l].size(); ++i) {
            const Vec2 c = corners[l][i];
            lo = glm::min(lo, c - Vec2(0, lines[l][i].down / kSide));
            hi = glm::max(hi, c + Vec2(lines[l][i].advance / kSide, 0));
        }
    return glm::max(hi - lo, Vec2(1e-3));
}

double length_of(const Text& text) {
    double whole = 0;
    for (const Glyph& g : only_line(text)) whole += (text.layout.spacing * g.advance + g.after) / kSide;
    return whole;
}

std::optional<std::string> size_for(const Text& text, const std::string& brush) {
    const bool brushed = std::any_of(text.lines.begin(), text.lines.end(), [&](const std::vector<Glyph>& line) {
        return std::any_of(line.begin(), line.end(), [&](const Glyph& glyph) {
            return !glyph.strokes.empty() && glyph.area.empty() && !is_drawn(glyph, text.style);
        });
    });
    return brushed ? size_that_fits(brush, text.layout.side) : std::nullopt;
}

void append_lines(std::vector<stroke::JournalEntry>& entries, const Text& text, const TextHand& hand,
                  const ProgressFn& progress) {
    Writer writer = writer_for(text, hand);
    Lines columns;
    const Lines& lines = set_lines(text, columns);
    const auto corners = place_in_lines(lines, text.layout);
    Entries to(entries, text, hand);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const auto written = writer.write(lines[l], part_of(progress, l, lines.size()));
        for (std::size_t i = 0; i < written.size(); ++i) to.add(written[i], corners[l][i], std::nullopt);
    }
}

void append_along(std::vector<stroke::JournalEntry>& entries, const Text& text, const ModelPath& path, double middle,
                  const TextHand& hand, const ProgressFn& progress) {
    const std::vector<Glyph>& glyphs = only_line(text);
    const std::vector<stroke::Placement> places = places_along(text, path, middle);
    const auto written = writer_for(text, hand).write(glyphs, progress);
    Entries to(entries, text, hand);
    for (std::size_t i = 0; i < glyphs.size(); ++i)
        to.add(written[i], -middle_of(glyphs[i], text.layout.side), places[i]);
}

std::vector<stroke::Placement> places_along(const Text& text, const ModelPath& path, double middle) {
    const std::vector<Glyph>& glyphs = only_line(text);
    std::vector<stroke::Placement> out;
    for (const double at : place_along(path, glyphs, middle, text.layout)) {
        const PathPlace place = place_on(path, at, kTangentReach * text.layout.side);
        out.push_back({.origin = place.position,
                       .right = place.right,
                       .down = glm::cross(place.right, place.normal),
                       .mapping = stroke::SurfaceMapping::drape});
    }
    return out;
}

std::vector<std::vector<Vec2>> outlined_lines(const Text& text) {
    std::vector<std::vector<Vec2>> lines;
    Lines columns;
    const Lines& set = set_lines(text, columns);
    const auto corners = place_in_lines(set, text.layout);
    for (std::size_t l = 0; l < set.size(); ++l)
        for (std::size_t i = 0; i < set[l].size(); ++i) add_outlined(lines, set[l][i], text, corners[l][i]);
    return lines;
}

std::vector<std::vector<Vec2>> middle_lines(const Text& text) {
    std::vector<std::vector<Vec2>> lines;
    Lines columns;
    const Lines& set = set_lines(text, columns);
    const auto corners = place_in_lines(set, text.layout);
    for (std::size_t l = 0; l < set.size(); ++l) {
        std::vector<Vec2>& line = lines.emplace_back();
        for (std::size_t i = 0; i < set[l].size(); ++i)
            line.push_back(corners[l][i] + middle_of(set[l][i], text.layout.side));
    }
    return lines;
}

std::vector<std::vector<std::vector<Vec2>>> outlined_characters(const Text& text) {
    std::vector<std::vector<std::vector<Vec2>>> out;
    for (const Glyph& glyph : only_line(text))
        add_outlined(out.emplace_back(), glyph, text, -middle_of(glyph, text.layout.side));
    return out;
}

}  // namespace tuft::writer
