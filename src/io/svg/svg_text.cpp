#include "io/svg/svg_text.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <pugixml.hpp>

#include "core/error.h"
#include "core/system/interrupt.h"
#include "core/text/text.h"
#include "io/strokes/inkml_marks.h"
#include "io/svg/style/svg_font.h"
#include "io/svg/style/svg_page.h"

namespace tuft::io {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kMostCharacters = 100'000;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// Position attributes of one element: value k is for its k-th character (SVG 1.1, 10.5).
struct Positions {
    std::vector<double> x, y, dx, dy, rotate;
    std::size_t next = 0;
};

/// Path of a `textPath`.
struct TextPath {
    SvgLine line;
    std::vector<double> length;  ///< along the line up to each point
    double offset = 0;           ///< of the first character
};

/// Characters that a `textLength` makes so long.
struct Fitting {
    std::size_t begin = 0, end = 0;  ///< characters
    double length = 0;               ///< user units
    bool glyphs = false;             ///< stretches the glyphs, too
};

struct Character {
    char32_t code = 0;
    std::size_t style = 0;
    std::size_t path = kNone;
    std::optional<double> x, y, rotate;  ///< rotate: degrees
    double dx = 0, dy = 0;

    bool placed() const { return x || y; }
    bool moved() const { return placed() || rotate || dx != 0 || dy != 0; }
};

struct PlacedGlyph {
    std::size_t character = 0;
    std::vector<std::vector<Vec2>> rings;  ///< em
    Vec2 pen{0};                           ///< user units: x along the line
    Vec2 offset{0};                        ///< user units, of the outline from the pen
    double advance = 0;                    ///< user units
    double stretch = 1;                    ///< along the line
    double angle = 0;                      ///< radians, clockwise as y goes down
    FontMetrics metrics;
    bool lost = false;  ///< beyond the end of its path
};

bool is_blank(char32_t c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

class TextSetter {
  public:
    explicit TextSetter(const SvgTextContext& context) : with_(context) {}

    std::vector<SvgTextShape> set(const pugi::xml_node& text, const SvgStyle& style) {
        collect(text, style, kNone, 0);
        while (!characters_.empty() && characters_.back().code == ' ' && !font_of(characters_.back()).keeps_space)
            characters_.pop_back();
        for (std::size_t begin = 0; begin < characters_.size();) begin = set_chunk(begin);
        return emit();
    }

  private:
    const SvgFont& font_of(const Character& c) const {
        static const SvgFont initial;
        return styles_[c.style].font ? *styles_[c.style].font : initial;
    }

    std::vector<double> numbers(const pugi::xml_node& node, const char* name, double whole, double em) const {
        std::vector<double> values;
        SvgReader in(node.attribute(name).value(), with_.source);
        while (in.number_next() && values.size() < kMostCharacters) {
            const double value = in.number();
            if (in.peek() == '%') {
                in.take();
                values.push_back(value / 100 * whole);
            } else {
                const std::string unit = in.word();
                values.push_back(unit.empty()   ? value
                                 : unit == "em" ? value * em
                                 : unit == "ex" ? value * em / 2
                                                : value * svg_length("1" + unit, with_.source) / kSvgPixel);
            }
        }
        return values;
    }

    // Characters of an element, blanks collapsed, with their styles and positions.
    void collect(const pugi::xml_node& node, const SvgStyle& style, std::size_t path, int depth) {
        if (depth > kDeepest) throw Error(with_.source, "groups are nested too deeply");
        const std::size_t own = styles_.size(), first = characters_.size();
        styles_.push_back(style);
        const double em = style.font ? style.font->size : SvgFont{}.size;
        positions_.push_back({numbers(node, "x", with_.page.x, em), numbers(node, "y", with_.page.y, em),
                              numbers(node, "dx", with_.page.x, em), numbers(node, "dy", with_.page.y, em),
                              numbers(node, "rotate", 1, em)});
        for (const pugi::xml_node& child : node.children()) {
            if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
                append(child.value(), own, path);
            } else if (child.type() == pugi::node_element) {
                const std::string_view name = local_name(child);
                if (name != "tspan" && name != "textPath" && name != "a" && name != "altGlyph") continue;
                const std::optional<SvgStyle> inner = with_.style_of(child, style);
                if (!inner) continue;
                const std::size_t along = name == "textPath" ? add_path(child) : path;
                if (name != "textPath" || along != kNone) collect(child, *inner, along, depth + 1);
            }
        }
        positions_.pop_back();
        const std::vector<double> length = numbers(node, "textLength", with_.page.x, em);
        if (!length.empty() && length[0] > 0 && characters_.size() > first)
            fittings_.push_back({first, characters_.size(), length[0],
                                 std::string_view(node.attribute("lengthAdjust").value()) == "spacingAndGlyphs"});
    }

    void append(const char* text, std::size_t style, std::size_t path) {
        const SvgFont& font = font_of({.style = style});
        for (char32_t code : utf32_of(text)) {
            if (is_blank(code)) code = ' ';
            if (code == ' ' && !font.keeps_space && (characters_.empty() || characters_.back().code == ' ')) continue;
            if (code < ' ' || code == 0xFEFF) continue;
            if (characters_.size() >= kMostCharacters) throw Error(with_.source, "a text has too many characters");
            Character c{.code = code, .style = style, .path = path};
            for (Positions& p : positions_) {  // from the outside to the inside
                const std::size_t k = p.next++;
                if (k < p.x.size()) c.x = p.x[k];
                if (k < p.y.size()) c.y = p.y[k];
                if (k < p.dx.size()) c.dx = p.dx[k];
                if (k < p.dy.size()) c.dy = p.dy[k];
                if (!p.rotate.empty()) c.rotate = p.rotate[std::min(k, p.rotate.size() - 1)];
            }
            characters_.push_back(c);
        }
    }

    std::size_t add_path(const pugi::xml_node& node) {
        TextPath path;
        for (const SvgLine& line : with_.path_of(node)) path.line.insert(path.line.end(), line.begin(), line.end());
        if (path.line.size() < 2) {
            with_.losses.add(SvgLoss::missing_use);
            return kNone;
        }
        path.length.push_back(0);
        for (std::size_t i = 1; i < path.line.size(); ++i)
            path.length.push_back(path.length.back() + glm::distance(path.line[i], path.line[i - 1]));
        if (const std::vector<double> offset = numbers(node, "startOffset", path.length.back(), 1); !offset.empty())
            path.offset = offset[0];
        paths_.push_back(std::move(path));
        return paths_.size() - 1;
    }

    // A chunk begins at a character with an absolute position or on another path, and is aligned as a whole.
    std::size_t set_chunk(std::size_t begin) {
        const Character& first = characters_[begin];
        if (first.path != last_path_) pen_ = {first.path == kNone ? pen_.x : paths_[first.path].offset, 0.0};
        last_path_ = first.path;
        const std::size_t from = glyphs_.size();
        std::size_t at = begin;
        do {
            check_interrupt();
            at = set_run(at);
        } while (at < characters_.size() && !characters_[at].placed() && characters_[at].path == first.path);
        for (const Fitting& fitting : fittings_)
            if (fitting.begin >= begin && fitting.end <= at) fit(from, fitting);
        align(from, font_of(first));
        if (first.path != kNone)
            for (std::size_t g = from; g < glyphs_.size(); ++g) bend(glyphs_[g], paths_[first.path]);
        return at;
    }

    // Characters of one style, from `begin` to the next that is moved.
    std::size_t set_run(std::size_t begin) {
        const Character& first = characters_[begin];
        const SvgFont& font = font_of(first);
        if (first.x) pen_.x = *first.x + (first.path == kNone ? 0 : paths_[first.path].offset);
        if (first.y && first.path == kNone) pen_.y = *first.y;
        pen_ += Vec2(first.dx, first.dy);
        std::size_t end = begin + 1;
        while (end < characters_.size() && characters_[end].style == first.style &&
               characters_[end].path == first.path && !characters_[end].moved() && !font.vertical)
            ++end;
        for (std::size_t at = begin; at < end;) {
            Font* const face = with_.fonts.find(font.face, characters_[at].code, with_.losses);
            std::size_t stop = at + 1;
            while (stop < end && with_.fonts.find(font.face, characters_[stop].code, with_.losses) == face) ++stop;
            if (face)
                shape(*face, at, stop);
            else
                for (std::size_t i = at; i < stop; ++i) with_.losses.add(SvgLoss::text);
            at = stop;
        }
        return end;
    }

    void shape(Font& face, std::size_t begin, std::size_t end) {
        const Character& first = characters_[begin];
        const SvgFont& font = font_of(first);
        std::u32string codes;
        for (std::size_t i = begin; i < end; ++i) codes.push_back(characters_[i].code);
        const double scale = with_.growth * font.size;
        const Shaping how{.ligatures = font.letter_spacing == 0,
                          .tolerance = scale > 0 ? std::clamp(with_.tolerance / scale, 1e-5, 1e-2) : 1e-2};
        for (ShapedGlyph& shaped : face.shape(codes, how)) {
            const Character& c = characters_[begin + shaped.character];
            PlacedGlyph glyph{
                .character = begin + shaped.character,
                .rings = std::move(shaped.rings),
                .pen = pen_,
                .offset = font.size * Vec2(shaped.offset.x, -shaped.offset.y),
                .advance = font.size * shaped.advance + font.letter_spacing + (c.code == ' ' ? font.word_spacing : 0),
                .angle = c.rotate.value_or(0) * std::numbers::pi / 180,
                .metrics = face.metrics()};
            if (font.vertical) {  // upright, on a centre line, an em apart
                glyph.offset += Vec2(-0.5 * font.size * shaped.advance, 0.5 * font.size * middle_of(glyph.metrics));
                glyph.pen.y += 0.5 * font.size;
                glyph.advance = 0;
                pen_.y += font.size + font.letter_spacing;
            } else {
                glyph.offset.y += raised(font, glyph.metrics);
                pen_.x += glyph.advance;
            }
            glyphs_.push_back(std::move(glyph));
        }
    }

    static double middle_of(const FontMetrics& m) { return m.ascent + m.descent; }

    // Downwards, user units: what brings the asked baseline onto the line.
    static double raised(const SvgFont& font, const FontMetrics& m) {
        double above = 0;  // em: height of the asked baseline above the alphabetic one
        switch (font.baseline) {
            case SvgBaseline::alphabetic:
                break;
            case SvgBaseline::middle:
                above = 0.5 * m.x_height;
                break;
            case SvgBaseline::central:
                above = 0.5 * (m.ascent + m.descent);
                break;
            case SvgBaseline::hanging:
                above = 0.8 * m.ascent;
                break;
            case SvgBaseline::text_top:
                above = m.ascent;
                break;
            case SvgBaseline::text_bottom:
                above = m.descent;
                break;
            case SvgBaseline::mathematical:
                above = 0.5 * m.ascent;
                break;
        }
        return font.size * above - font.raise;
    }

    // textLength: more room between the glyphs, or wider glyphs (SVG 2, 11.5). Those after them move on.
    void fit(std::size_t from, const Fitting& fitting) {
        std::size_t n = 0;
        double natural = 0, start = 0;
        for (std::size_t g = from; g < glyphs_.size(); ++g) {
            const PlacedGlyph& glyph = glyphs_[g];
            if (glyph.character < fitting.begin || glyph.character >= fitting.end) continue;
            if (n++ == 0) start = glyph.pen.x;
            natural += glyph.advance;
        }
        if (n == 0 || !(natural > 0)) return;
        const double more = fitting.length - natural, each = n > 1 ? more / static_cast<double>(n - 1) : 0,
                     stretch = fitting.length / natural;
        std::size_t k = 0;
        for (std::size_t g = from; g < glyphs_.size(); ++g) {
            PlacedGlyph& glyph = glyphs_[g];
            if (glyph.character >= fitting.end) {
                glyph.pen.x += more;
            } else if (glyph.character >= fitting.begin) {
                if (fitting.glyphs) {
                    glyph.pen.x = start + stretch * (glyph.pen.x - start);
                    glyph.stretch *= stretch;
                    glyph.advance *= stretch;
                    glyph.offset.x *= stretch;
                } else {
                    glyph.pen.x += each * static_cast<double>(k);
                    if (++k < n) glyph.advance += each;  // what is drawn under it reaches the next
                }
            }
        }
        pen_.x += more;
    }

    void align(std::size_t from, const SvgFont& font) {
        if (font.anchor == SvgAnchor::start || from == glyphs_.size()) return;
        const PlacedGlyph &first = glyphs_[from], &last = glyphs_.back();
        const Vec2 length = font.vertical ? Vec2(0, pen_.y - first.pen.y + 0.5 * font.size)
                                          : Vec2(last.pen.x + last.advance - first.pen.x, 0);
        const Vec2 back = length * (font.anchor == SvgAnchor::middle ? 0.5 : 1.0);
        for (std::size_t g = from; g < glyphs_.size(); ++g) glyphs_[g].pen -= back;
        pen_ -= back;
    }

    // Onto the path: the middle of the glyph lies on it, along its direction there (SVG 1.1, 10.13.3).
    static void bend(PlacedGlyph& glyph, const TextPath& path) {
        const double middle = glyph.pen.x + 0.5 * glyph.advance;
        if (!(middle >= 0 && middle <= path.length.back())) {
            glyph.lost = true;
            return;
        }
        const auto next = std::upper_bound(path.length.begin() + 1, path.length.end() - 1, middle);
        const auto i = static_cast<std::size_t>(next - path.length.begin());
        const Vec2 along = path.line[i] - path.line[i - 1];
        const double length = path.length[i] - path.length[i - 1];
        const Vec2 t = length > 0 ? along / length : Vec2(1, 0), n(-t.y, t.x);
        glyph.angle += std::atan2(t.y, t.x);
        glyph.pen = path.line[i - 1] + (middle - path.length[i - 1]) * t - 0.5 * glyph.advance * t + glyph.pen.y * n;
    }

    void add_outline(const PlacedGlyph& glyph, const SvgFont& font, std::vector<SvgLine>& lines) const {
        const double c = std::cos(glyph.angle), s = std::sin(glyph.angle);
        const auto placed = [&](const Vec2& p) {
            const Vec2 q = glyph.offset + p;
            return glyph.pen + Vec2(c * q.x - s * q.y, s * q.x + c * q.y);
        };
        const auto add = [&](const std::vector<Vec2>& ring) {
            if (ring.size() < 3) return;
            SvgLine line;
            for (const Vec2& p : ring) line.push_back(placed(font.size * Vec2(glyph.stretch * p.x, -p.y)));
            line.push_back(line.front());
            lines.push_back(std::move(line));
        };
        for (const std::vector<Vec2>& ring : glyph.rings) add(ring);
        const double half = 0.5 * glyph.metrics.line_thickness,
                     end = font.size > 0 ? glyph.advance / font.size / glyph.stretch : 0;
        const auto rule = [&](double height) {
            add({{0, height - half}, {end, height - half}, {end, height + half}, {0, height + half}});
        };
        if (font.vertical) return;
        if (font.underline) rule(glyph.metrics.underline);
        if (font.overline) rule(glyph.metrics.ascent);
        if (font.strikeout) rule(glyph.metrics.strikeout);
    }

    std::vector<SvgTextShape> emit() {
        std::vector<SvgTextShape> shapes;
        std::vector<std::size_t> shape_of(styles_.size(), kNone);
        for (const PlacedGlyph& glyph : glyphs_) {
            if (glyph.lost) {
                with_.losses.add(SvgLoss::text_end);
                continue;
            }
            const Character& c = characters_[glyph.character];
            if (!styles_[c.style].visible) continue;
            if (shape_of[c.style] == kNone) {
                shape_of[c.style] = shapes.size();
                shapes.push_back({styles_[c.style], {}});
                shapes.back().style.rule = FillRule::nonzero;
            }
            add_outline(glyph, font_of(c), shapes[shape_of[c.style]].lines);
        }
        std::erase_if(shapes, [](const SvgTextShape& s) { return s.lines.empty(); });
        return shapes;
    }

    const SvgTextContext& with_;
    std::vector<SvgStyle> styles_;
    std::vector<Positions> positions_;  ///< of the elements round the present one
    std::vector<TextPath> paths_;
    std::vector<Fitting> fittings_;  ///< inner ones first
    std::vector<Character> characters_;
    std::vector<PlacedGlyph> glyphs_;
    Vec2 pen_{0};
    std::size_t last_path_ = kNone;
};

}  // namespace

Font* SvgFonts::open(const InstalledFont& installed) {
    if (installed.file.empty()) return nullptr;
    const auto key = std::pair(installed.file.string(), installed.face);
    auto at = open_.find(key);
    if (at == open_.end()) {
        std::unique_ptr<Font> font;
        try {
            font = std::make_unique<Font>(installed.file, installed.face);
        } catch (const Error&) {  // a damaged font is like none
        }
        at = open_.emplace(key, std::move(font)).first;
    }
    return at->second.get();
}

Font* SvgFonts::find(const FontRequest& request, char32_t code, SvgLosses& losses) {
    auto at = installed_.find(request);
    if (at == installed_.end()) {
        at = installed_.emplace(request, find_font(request)).first;
        if (!at->second.requested && !at->second.file.empty())
            losses.add_font(request.families.empty() ? "" : request.families.front(), at->second.family);
    }
    Font* const font = open(at->second);
    if (font && (font->has(code) || is_blank(code))) return font;
    auto other = substitutes_.find({request, code});
    if (other == substitutes_.end())
        other = substitutes_.emplace(std::pair(request, code), find_font(request, code)).first;
    Font* const substitute = open(other->second);
    return substitute && substitute->has(code) ? substitute : nullptr;
}

std::vector<SvgTextShape> set_svg_text(const pugi::xml_node& text, const SvgStyle& style,
                                       const SvgTextContext& context) {
    return TextSetter(context).set(text, style);
}

}  // namespace tuft::io
