#include "writer/glyphs/glyph.h"

#include <cmath>

#include "core/error.h"
#include "core/text/text.h"

namespace tuft::writer {

std::u32string characters_of(std::string_view text) {
    if (text.size() > 4 * kMostCharacters)
        throw Error(
            Message("a text of {} bytes is too long to write (at most {} characters)", text.size(), kMostCharacters));
    const std::string utf8 = to_utf8(text);
    std::u32string out;
    for (std::size_t i = 0; i < utf8.size();) {
        const auto lead = static_cast<unsigned char>(utf8[i]);
        const int n = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
        char32_t code = n == 1 ? lead : lead & (0xFFu >> (n + 1));
        for (int k = 1; k < n; ++k) code = (code << 6) | (static_cast<unsigned char>(utf8[i + k]) & 0x3Fu);
        out.push_back(code);
        i += static_cast<std::size_t>(n);
    }
    if (out.size() > kMostCharacters)
        throw Error(Message("a text of {} characters is too long to write (at most {})", out.size(), kMostCharacters));
    return out;
}

std::string utf8_of(char32_t c) {
    std::string out;
    const auto byte = [&](char32_t v) { out.push_back(static_cast<char>(v)); };
    if (c < 0x80) {
        byte(c);
    } else if (c < 0x800) {
        byte(0xC0 | (c >> 6)), byte(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
        byte(0xE0 | (c >> 12)), byte(0x80 | ((c >> 6) & 0x3F)), byte(0x80 | (c & 0x3F));
    } else {
        byte(0xF0 | (c >> 18)), byte(0x80 | ((c >> 12) & 0x3F)), byte(0x80 | ((c >> 6) & 0x3F)),
            byte(0x80 | (c & 0x3F));
    }
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
