#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text/nesting.h"
#include "io/svg/style/svg_shapes.h"
#include "writer/glyphs/glyph_source.h"

namespace tuft::writer {
namespace {

constexpr double kBelow = 124;       // units of the square below the baseline, y = 0 of the files
constexpr double kTolerance = 0.25;  // units, of chords of an outline

using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& source, const char* what) {
    throw Error(source, Message(what));
}

std::vector<Vec2> median_of(const Json& json, const std::string& source) {
    if (!json.is_array()) fail(source, "'medians' is no list of lists of points");
    std::vector<Vec2> line;
    for (const Json& p : json) {
        if (!p.is_array() || p.size() != 2 || !p[0].is_number() || !p[1].is_number())
            fail(source, "a point of 'medians' is no pair of numbers");
        line.emplace_back(p[0].get<double>(), p[1].get<double>() + kBelow);
    }
    return line;
}

std::vector<Ring> outline_of(const Json& json, const std::string& source) {
    if (!json.is_string()) fail(source, "'strokes' is no list of SVG paths");
    std::vector<Ring> rings;
    io::svg_path(json.get_ref<const std::string&>().c_str(), source, {.tolerance = kTolerance},
                 [&](const io::SvgLine& line) {
                     if (rings.size() >= kMostStrokes) fail(source, "too many rings in an outline");
                     Ring ring;
                     for (const Vec2& p : line) ring.emplace_back(p.x, p.y + kBelow);
                     if (ring.size() > 2) rings.push_back(std::move(ring));
                 });
    return rings;
}

}  // namespace

Glyph parse_hanzi_json(std::string_view text, char32_t code, const std::string& source) {
    check_json_nesting(text, source);
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) fail(source, "no JSON object of a character");
    const auto medians = json.find("medians");
    if (medians == json.end() || !medians->is_array()) fail(source, "it has no 'medians'");
    if (medians->size() > kMostStrokes) fail(source, "too many strokes");
    Glyph glyph{.code = code};
    if (const auto named = json.find("character"); named != json.end() && named->is_string()) {
        const std::u32string name = characters_of(named->get_ref<const std::string&>());
        if (name.size() == 1) glyph.code = name[0];
    }
    for (const Json& median : *medians) glyph.strokes.push_back({.median = median_of(median, source)});
    if (const auto strokes = json.find("strokes"); strokes != json.end()) {
        if (!strokes->is_array() || strokes->size() != glyph.strokes.size())
            fail(source, "'strokes' and 'medians' differ in number");
        for (std::size_t i = 0; i < glyph.strokes.size(); ++i)
            glyph.strokes[i].outline = outline_of((*strokes)[i], source);
    }
    check_glyph(glyph, source);
    return glyph;
}

std::string hanzi_json_of(const Glyph& glyph) {
    std::string strokes, medians;
    for (const GlyphStroke& stroke : glyph.strokes) {
        std::string path, line;
        for (const Ring& ring : stroke.outline) {
            for (std::size_t i = 0; i < ring.size(); ++i)
                path += fmt::format("{} {:.2f} {:.2f} ", i == 0 ? 'M' : 'L', ring[i].x, ring[i].y - kBelow);
            path += "Z ";
        }
        if (!path.empty()) path.pop_back();
        for (const Vec2& p : stroke.median)
            line += fmt::format("{}[{:.2f},{:.2f}]", line.empty() ? "" : ",", p.x, p.y - kBelow);
        strokes += fmt::format("{}\"{}\"", strokes.empty() ? "" : ",", path);
        medians += fmt::format("{}[{}]", medians.empty() ? "" : ",", line);
    }
    return fmt::format("{{\"character\":{},\"strokes\":[{}],\"medians\":[{}]}}\n", Json(utf8_of(glyph.code)).dump(),
                       strokes, medians);
}

}  // namespace tuft::writer
