#include "decal/stroke_font.h"

#include <array>
#include <cctype>

namespace tuft::decal {
namespace {

constexpr double kHeight = 6, kAdvance = 6, kWidth = 4;  // units of the glyphs' grid

struct Glyph {
    char character;
    const char* lines;  // pairs of column and row from the lower left, lines apart by spaces
};

constexpr std::array kGlyphs{Glyph{'0', "0006464000"},
                             Glyph{'1', "152620 0040"},
                             Glyph{'2', "064643030040"},
                             Glyph{'3', "06464000 0343"},
                             Glyph{'4', "060343 4640"},
                             Glyph{'5', "460603434000"},
                             Glyph{'6', "460600404303"},
                             Glyph{'7', "064610"},
                             Glyph{'8', "0006464000 0343"},
                             Glyph{'9', "430306464000"},
                             Glyph{'A', "0004264440 0242"},
                             Glyph{'B', "00063645443303 3342413000"},
                             Glyph{'C', "46060040"},
                             Glyph{'D', "00062644422000"},
                             Glyph{'E', "46060040 0333"},
                             Glyph{'F', "460600 0333"},
                             Glyph{'G', "460600404323"},
                             Glyph{'H', "0006 4046 0343"},
                             Glyph{'I', "1030 2026 1636"},
                             Glyph{'J', "46400002"},
                             Glyph{'K', "0006 460340"},
                             Glyph{'L', "060040"},
                             Glyph{'M', "0006234640"},
                             Glyph{'N', "00064046"},
                             Glyph{'O', "0006464000"},
                             Glyph{'P', "0006464303"},
                             Glyph{'Q', "0006464000 2240"},
                             Glyph{'R', "0006464303 2340"},
                             Glyph{'S', "460603434000"},
                             Glyph{'T', "0646 2620"},
                             Glyph{'U', "06004046"},
                             Glyph{'V', "062046"},
                             Glyph{'W', "0610233046"},
                             Glyph{'X', "0046 0640"},
                             Glyph{'Y', "0623 4623 2320"},
                             Glyph{'Z', "06460040"},
                             Glyph{'-', "0343"},
                             Glyph{'.', "2021"},
                             Glyph{',', "2110"},
                             Glyph{':', "2122 2425"},
                             Glyph{'/', "0046"},
                             Glyph{'%', "0046 0515160605 3040413130"},
                             Glyph{'+', "0343 2125"},
                             Glyph{'=', "0242 0444"},
                             Glyph{'(', "26141220"},
                             Glyph{')', "26343220"},
                             Glyph{'_', "0040"},
                             Glyph{'#', "1016 3036 0242 0444"},
                             Glyph{'*', "0343 1135 3115"},
                             Glyph{' ', ""}};

const char* lines_of(char c) {
    const auto capital = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    for (const Glyph& g : kGlyphs)
        if (g.character == capital) return g.lines;
    return "0006464000 0640";
}

}  // namespace

std::vector<std::vector<Vec2>> text_lines(std::string_view text, const Vec2& at, double size) {
    const double unit = size / kHeight;
    std::vector<std::vector<Vec2>> lines;
    Vec2 origin = at;
    for (const char c : text) {
        bool fresh = true;
        for (const char* p = lines_of(c); *p; ++p) {
            if (*p == ' ') {
                fresh = true;
                continue;
            }
            if (fresh) lines.emplace_back();
            fresh = false;
            lines.back().push_back(origin + unit * Vec2(p[0] - '0', p[1] - '0'));
            ++p;
        }
        origin.x += kAdvance * unit;
    }
    return lines;
}

double text_width(std::string_view text, double size) {
    return text.empty() ? 0 : (kAdvance * static_cast<double>(text.size() - 1) + kWidth) * size / kHeight;
}

}  // namespace tuft::decal
