#include <cmath>
#include <pugixml.hpp>

#include "core/error.h"
#include "core/files/library_fault.h"
#include "io/svg/style/svg_shapes.h"
#include "writer/glyphs/glyph_source.h"

namespace tuft::writer {
namespace {

constexpr int kDeepest = 64;
constexpr double kTolerance = 5e-4;  // of the em
constexpr std::size_t kMostGlyphs = 70'000, kMostPairs = 200'000;
constexpr double kDescent = 0.22;  // of the em below the baseline, where the font states none

pugi::xml_node find_font(const pugi::xml_node& node, int depth) {
    if (depth > kDeepest) return {};
    for (const pugi::xml_node& child : node.children()) {
        if (std::string_view(child.name()) == "font") return child;
        if (const pugi::xml_node found = find_font(child, depth + 1)) return found;
    }
    return {};
}

double number(const pugi::xml_node& node, const char* key, double otherwise, const std::string& source) {
    const pugi::xml_attribute attribute = node.attribute(key);
    if (!attribute) return otherwise;
    const std::string text = attribute.value();
    return io::SvgReader(text, source).number();
}

/// The entries of a list such as "A,B,C"; a comma itself is no entry.
std::vector<std::u32string> characters_between_commas(std::string_view text) {
    std::vector<std::u32string> out;
    for (std::size_t at = 0; at <= text.size();) {
        const std::string_view item = text.substr(at, text.find(',', at) - at);
        out.push_back(characters_of(item));
        at += item.size() + 1;
    }
    return out;
}

}  // namespace

LineFontGlyphs parse_line_font(std::string_view text, const std::string& source) {
    pugi::xml_document document;
    if (const auto parsed = document.load_buffer(text.data(), text.size()); !parsed)
        throw Error(source, Message("no SVG font: {}", library_fault(parsed.description())));
    const pugi::xml_node font = find_font(document, 0);
    if (!font) throw Error(source, Message("it has no font element"));
    const pugi::xml_node face = font.child("font-face");
    const double em = number(face, "units-per-em", 1000, source);
    if (!(em >= 1 && em <= 1e6)) throw Error(source, Message("units-per-em is no number from 1 to 1000000"));
    const double scale = kSide / em, descent = std::abs(number(face, "descent", -kDescent * em, source));
    const double advance = number(font, "horiz-adv-x", 0.6 * em, source);
    LineFontGlyphs out;
    std::vector<Glyph>& glyphs = out.glyphs;
    for (const pugi::xml_node& node : font.children("glyph")) {
        const std::u32string name = characters_of(node.attribute("unicode").value());
        if (name.size() != 1) continue;
        if (glyphs.size() >= kMostGlyphs) throw Error(source, Message("too many glyphs"));
        Glyph glyph{
            .code = name[0], .advance = scale * number(node, "horiz-adv-x", advance, source), .single_line = true};
        io::svg_path(node.attribute("d").value(), source, {.tolerance = kTolerance * em}, [&](const io::SvgLine& line) {
            if (line.size() < 2) return;
            GlyphStroke stroke;
            for (const Vec2& p : line) stroke.median.emplace_back(scale * p.x, scale * (p.y + descent));
            glyph.strokes.push_back(std::move(stroke));
        });
        check_glyph(glyph, source);
        glyphs.push_back(std::move(glyph));
    }
    if (glyphs.empty()) throw Error(source, Message("the font has no glyphs"));
    for (const pugi::xml_node& node : font.children("hkern")) {
        const double k = scale * number(node, "k", 0, source);
        if (!(std::abs(k) <= kSide)) throw Error(source, Message("'k' of hkern is wider than the em"));
        for (const std::u32string& first : characters_between_commas(node.attribute("u1").value()))
            for (const std::u32string& second : characters_between_commas(node.attribute("u2").value()))
                if (first.size() == 1 && second.size() == 1 && out.kerning.size() < kMostPairs)
                    out.kerning.emplace(std::pair(first[0], second[0]), k);
    }
    return out;
}

}  // namespace tuft::writer
