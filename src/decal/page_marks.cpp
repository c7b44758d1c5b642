#include "decal/page_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "decal/stroke_font.h"

namespace tuft::decal {
namespace {

constexpr double kMm = 1e-3;
constexpr double kNumberSize = 5 * kMm;
constexpr double kTextSize = 2.2 * kMm;
constexpr double kMarkAt = 5 * kMm;       // of a registration mark, from both edges
constexpr double kLeastScale = 15 * kMm;  // of the colours of strain
constexpr std::size_t kLongestTitle = 28;

void add_lines(Page& page, const std::vector<std::vector<Vec2>>& lines, Role role) {
    for (const std::vector<Vec2>& line : lines) page.lines.push_back({line, false, role});
}

void add_text(Page& page, const std::string& text, const Vec2& at, double size, Role role = Role::label) {
    add_lines(page, text_lines(text, at, size), role);
}

void add_arrow(Page& page, const Vec2& middle, const Vec2& along, double length) {
    const Vec2 tip = middle + 0.5 * length * along, tail = middle - 0.5 * length * along;
    const Vec2 across{-along.y, along.x};
    const Vec2 neck = tip - 0.35 * length * along;
    page.lines.push_back({{tail, tip}, false, Role::label});
    page.lines.push_back({{neck + 0.2 * length * across, tip, neck - 0.2 * length * across}, false, Role::label});
}

void add_registration_mark(Page& page, const Vec2& at) {
    constexpr int kSides = 48;
    Line circle{{}, true, Role::mark};
    for (int i = 0; i < kSides; ++i) {
        const double a = 2 * std::numbers::pi * i / kSides;
        circle.points.push_back(at + 2 * kMm * Vec2(std::cos(a), std::sin(a)));
    }
    page.lines.push_back(std::move(circle));
    page.lines.push_back({{at - Vec2(3.5 * kMm, 0), at + Vec2(3.5 * kMm, 0)}, false, Role::mark});
    page.lines.push_back({{at - Vec2(0, 3.5 * kMm), at + Vec2(0, 3.5 * kMm)}, false, Role::mark});
}

/// Draws a bar with a tick each 10 mm; returns its right end.
double add_scale_bar(Page& page, const Vec2& at) {
    const double room = page.size.x - 2 * kPageMargin;
    const int tens = room > 240 * kMm ? 10 : room > 120 * kMm ? 5 : 2;
    const double length = 10 * kMm * tens;
    page.lines.push_back({{at, at + Vec2(length, 0)}, false, Role::mark});
    for (int i = 0; i <= tens; ++i) {
        const double height = i == 0 || i == tens ? 3 * kMm : 1.5 * kMm;
        const Vec2 foot = at + Vec2(10 * kMm * i, 0);
        page.lines.push_back({{foot, foot + Vec2(0, height)}, false, Role::mark});
    }
    add_text(page, "0", at + Vec2(0, 4 * kMm), kTextSize);
    const std::string end = fmt::format("{} MM", 10 * tens);
    add_text(page, end, at + Vec2(length - text_width(end, kTextSize), 4 * kMm), kTextSize);
    return at.x + length;
}

/// Draws the colours of a strain map from 0 to the limit, at most `room` wide; returns their right end.
double add_strain_scale(Page& page, const Vec2& at, double room, double limit) {
    constexpr double kPixel = 0.2 * kMm, kWidest = 40 * kMm, kHeight = 4 * kMm;
    PrintImage scale;
    scale.width = static_cast<int>(std::min(kWidest, room) / kPixel + 0.5);
    scale.height = static_cast<int>(kHeight / kPixel + 0.5);
    scale.origin = at;
    scale.pixel = kPixel;
    scale.alpha.assign(static_cast<std::size_t>(scale.width) * static_cast<std::size_t>(scale.height), 255);
    for (int y = 0; y < scale.height; ++y)
        for (int x = 0; x < scale.width; ++x)
            for (const std::uint8_t c : strain_colour(limit * (x + 0.5) / scale.width, limit)) scale.rgb.push_back(c);
    const double width = scale.width * kPixel, height = scale.height * kPixel;
    page.prints.push_back(std::move(scale));
    page.lines.push_back(
        {{at, at + Vec2(width, 0), at + Vec2(width, height), at + Vec2(0, height)}, true, Role::label});
    add_text(page, "0", at + Vec2(0, height + 1 * kMm), kTextSize);
    const std::string end = fmt::format("{:.1f} %", 100 * limit);
    add_text(page, end, at + Vec2(width - text_width(end, kTextSize), height + 1 * kMm), kTextSize);
    return at.x + width;
}

/// The first of `texts` that is no longer than `room`, else "".
std::string first_that_fits(const std::vector<std::string>& texts, double room) {
    for (const std::string& text : texts)
        if (text_width(text, kTextSize) <= room) return text;
    return "";
}

}  // namespace

Vec2 free_area(const Vec2& page) {
    const double height = page.y > 0 ? page.y - 2 * kPageMargin - kFootHeight : 0;
    return {page.x - 2 * kPageMargin, height};
}

Vec2 free_origin() {
    return {kPageMargin, kPageMargin + kFootHeight};
}

double roll_length(double used) {
    return std::ceil((used + kPageMargin) / kMm) * kMm;
}

double label_width(int number) {
    return text_width(std::to_string(number), kNumberSize) + 10 * kMm;
}

void add_label(Page& page, int number, const Vec2& at, const Vec2& up) {
    const std::string text = std::to_string(number);
    add_text(page, text, at + Vec2(1 * kMm, 2 * kMm), kNumberSize);
    add_arrow(page, at + Vec2(1 * kMm + text_width(text, kNumberSize) + 4.5 * kMm, 4.5 * kMm), up, 7 * kMm);
}

void add_marks(Page& page, const FootText& text) {
    const Vec2 far = page.size - Vec2(kMarkAt);
    for (const Vec2& at : {Vec2(kMarkAt), Vec2(far.x, kMarkAt), Vec2(kMarkAt, far.y), far})
        add_registration_mark(page, at);
    const Vec2 foot{kPageMargin, kPageMargin};
    const double grain = page.size.x - kPageMargin - 12 * kMm;
    add_text(page, "GRAIN", {grain - 4 * kMm, foot.y}, kTextSize);
    add_arrow(page, {page.size.x - kPageMargin - 3 * kMm, foot.y + 8 * kMm}, {0, 1}, 8 * kMm);
    const double right = grain - 6 * kMm;
    Vec2 first{add_scale_bar(page, foot) + 6 * kMm, foot.y + 5 * kMm}, second{first.x, foot.y};
    const std::string pages = fmt::format("PAGE {}/{}", text.page, text.pages);
    const std::string strain = fmt::format("{:.1f} OF {:.1f} %", 100 * text.strain, 100 * text.limit);
    std::vector<std::string> seconds{pages + "  TRUE SIZE 1:1  STRAIN " + strain, pages + "  STRAIN " + strain};
    std::string title = text.title.substr(0, kLongestTitle), after;
    if (page.strain_map) {
        seconds.insert(seconds.end(), {pages + "  MAX " + strain, "MAX " + strain});
        if (right - first.x > kLeastScale)
            first.x = second.x = add_strain_scale(page, second, right - first.x, text.limit) + 6 * kMm;
        // Above the bars on a page that is narrow.
        if (right - first.x < text_width(seconds[2], kTextSize)) {
            first = {foot.x, foot.y + 11.6 * kMm};
            second = {foot.x, foot.y + 8.2 * kMm};
        }
        after = title.empty() ? "STRAIN MAP" : "  STRAIN MAP";
    }
    while (!title.empty() && text_width(title + after, kTextSize) > right - first.x) title.pop_back();
    if (title.empty() && page.strain_map) after = "STRAIN MAP";
    seconds.push_back(pages);
    add_text(page, title + after, first, kTextSize);
    add_text(page, first_that_fits(seconds, right - second.x), second, kTextSize);
}

}  // namespace tuft::decal
