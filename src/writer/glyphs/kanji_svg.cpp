#include <algorithm>
#include <cstring>
#include <pugixml.hpp>

#include "core/error.h"
#include "core/files/library_fault.h"
#include "io/svg/style/svg_shapes.h"
#include "writer/glyphs/glyph_source.h"

namespace tuft::writer {
namespace {

constexpr double kBox = 109;         // user units of a character's square in KanjiVG
constexpr double kTolerance = 0.02;  // user units
constexpr int kDeepest = 64;         // groups within each other
constexpr double kInset = 12;        // units by which the centre lines of a typeface end before the ink

/// Cuts a length off both ends of a line, at most a fifth of it each.
std::vector<Vec2> inset(const std::vector<Vec2>& line, double by) {
    double length = 0;
    for (std::size_t i = 1; i < line.size(); ++i) length += glm::distance(line[i], line[i - 1]);
    by = std::min(by, 0.2 * length);
    std::vector<Vec2> out;
    double along = 0;
    const auto add_between = [&](std::size_t i, double at, double piece) {
        if (at > along && at < along + piece) out.push_back(glm::mix(line[i - 1], line[i], (at - along) / piece));
    };
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double piece = glm::distance(line[i], line[i - 1]);
        add_between(i, by, piece);
        add_between(i, length - by, piece);
        along += piece;
        if (along > by && along < length - by) out.push_back(line[i]);
    }
    return out.size() < 2 ? line : out;
}

class Reader {
  public:
    Reader(const std::string& source, Glyph& glyph) : source_(source), glyph_(glyph) {}

    void walk(const pugi::xml_node& node, int depth) {
        if (depth > kDeepest) throw Error(source_, Message("groups are nested more than {} deep", kDeepest));
        if (std::strcmp(node.name(), "path") == 0) return stroke(node);
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element && std::strcmp(child.name(), "text") != 0) walk(child, depth + 1);
    }

  private:
    void stroke(const pugi::xml_node& node) {
        if (glyph_.strokes.size() >= kMostStrokes) throw Error(source_, Message("too many strokes"));
        std::vector<Vec2> line;
        io::svg_path(node.attribute("d").value(), source_, {.tolerance = kTolerance}, [&](const io::SvgLine& part) {
            for (const Vec2& p : part) line.emplace_back(kSide * p.x / kBox, kSide * (1 - p.y / kBox));
        });
        if (line.size() < 2) throw Error(source_, Message("a stroke's path has no line"));
        glyph_.strokes.push_back({.median = inset(line, kInset), .type = node.attribute("kvg:type").value()});
    }

    const std::string& source_;
    Glyph& glyph_;
};

}  // namespace

Glyph parse_kanji_svg(std::string_view text, char32_t code, const std::string& source) {
    pugi::xml_document document;
    if (const auto parsed = document.load_buffer(text.data(), text.size()); !parsed)
        throw Error(source, Message("no SVG: {}", library_fault(parsed.description())));
    if (!document.child("svg")) throw Error(source, Message("it has no svg element"));
    Glyph glyph{.code = code};
    glyph.of_pen = true;
    Reader(source, glyph).walk(document.child("svg"), 0);
    if (glyph.strokes.empty()) throw Error(source, Message("it has no strokes"));
    check_glyph(glyph, source);
    return glyph;
}

}  // namespace tuft::writer
