#include "writer/glyphs/glyph.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"

namespace tuft::writer {

Vec2 leaned(const Vec2& p, const Glyph& glyph, double slant) {
    const double lean = std::tan(slant);
    return glyph.sideways ? Vec2(p.x, p.y - lean * p.x) : Vec2(p.x + lean * p.y, p.y);
}

bool is_han(char32_t code) {
    static constexpr char32_t kRanges[][2] = {{0x2E80, 0x2FDF}, {0x3005, 0x3005}, {0x3021, 0x3029}, {0x3038, 0x303B},
                                              {0x3400, 0x4DBF}, {0x4E00, 0x9FFF}, {0xF900, 0xFAFF}, {0x20000, 0x3FFFF}};
    return std::any_of(std::begin(kRanges), std::end(kRanges),
                       [code](const char32_t(&range)[2]) { return code >= range[0] && code <= range[1]; });
}

std::u32string characters_of(std::string_view text) {
    if (text.size() > 4 * kMostCharacters)
        throw Error(
            Message("a text of {} bytes is too long to write (at most {} characters)", text.size(), kMostCharacters));
    std::u32string out = utf32_of(text);
    if (out.size() > kMostCharacters)
        throw Error(Message("a text of {} characters is too long to write (at most {})", out.size(), kMostCharacters));
    return out;
}

void check_glyph(const Glyph& glyph, const std::string& source) {
    const auto fail = [&](const char* what) {
        throw Error(source, Message("character {}: {}", utf8_of(glyph.code), Message(what)));
    };
    std::size_t points = 0;
    const auto check = [&](const std::vector<Vec2>& line) {
        points += line.size();
        if (points > kMostPoints) fail("too many points");
        for (const Vec2& p : line)
            if (!(std::abs(p.x) <= kFarthestUnit && std::abs(p.y) <= kFarthestUnit))
                fail("a coordinate is not a number or far outside of the character's square");
    };
    if (glyph.strokes.size() > kMostStrokes) fail("too many strokes");
    for (const GlyphStroke& s : glyph.strokes) {
        if (s.median.size() < 2) fail("a stroke's centre line has fewer than two points");
        check(s.median);
        for (const Ring& ring : s.outline) check(ring);
    }
    for (const Ring& ring : glyph.area) check(ring);
}

}  // namespace tuft::writer
