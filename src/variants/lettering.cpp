#include "variants/lettering.h"

#include <algorithm>
#include <vector>

#include "decal/stroke_font.h"

namespace tuft::variants {
namespace {

constexpr double kNarrowest = 0.6, kThickness = 0.13;  // of the width, of the size

}  // namespace

std::string_view first_line(std::string_view text, const LetteringOptions& options) {
    std::size_t end = text.size();
    while (kNarrowest * decal::text_width(text.substr(0, end), options.size) > options.width) {
        const std::size_t space = text.substr(0, end).rfind(' ');
        if (space == std::string_view::npos || space == 0) break;
        end = space;
    }
    return text.substr(0, end);
}

void letter(render::BrushCanvas& canvas, std::string_view text, const Vec2& at, const LetteringOptions& options) {
    while (text.size() > 1 && kNarrowest * decal::text_width(text, options.size) > options.width) text.remove_suffix(1);
    const double narrow = std::min(1.0, options.width / std::max(1.0, decal::text_width(text, options.size)));
    const double thickness[] = {std::max(1.0, kThickness * options.size)};
    for (const std::vector<Vec2>& line : decal::text_lines(text, Vec2(0), options.size)) {
        std::vector<Vec2> points;
        points.reserve(line.size());
        for (const Vec2& p : line) points.push_back(at + Vec2(narrow * p.x, -p.y));
        render::stroke_line(canvas, points, thickness, options.colour);
    }
}

}  // namespace tuft::variants
