#include "render/brush/brush_canvas.h"

#include <algorithm>
#include <cmath>

namespace tuft::render {

BrushCanvas::BrushCanvas(int w, int h, const Vec3& background) : width(w), height(h) {
    rgb.resize(static_cast<std::size_t>(w) * h * 3);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<float>(background[static_cast<int>(i % 3)]);
}

Vec3 linear_colour(int r, int g, int b) {
    const auto linear = [](int v) {
        const double s = v / 255.0;
        return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    };
    return {linear(r), linear(g), linear(b)};
}

namespace {

void blend(BrushCanvas& c, int x, int y, const Vec3& colour, double alpha) {
    if (x < 0 || y < 0 || x >= c.width || y >= c.height || alpha <= 0) return;
    float* p = &c.rgb[(static_cast<std::size_t>(y) * c.width + x) * 3];
    const double a = std::min(alpha, 1.0);
    for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(p[k] + a * (colour[k] - p[k]));
}

}  // namespace

void fill_polygon(BrushCanvas& canvas, std::span<const Vec2> points, const Vec3& colour, double alpha) {
    if (points.size() < 3) return;
    constexpr int kLines = 8;
    double lo = 1e30, hi = -1e30;
    for (const Vec2& p : points) {
        lo = std::min(lo, p.y);
        hi = std::max(hi, p.y);
    }
    const int y0 = std::max(0, static_cast<int>(std::floor(lo)));
    const int y1 = std::min(canvas.height - 1, static_cast<int>(std::floor(hi)));
    std::vector<double> cover(canvas.width), cuts;
    for (int y = y0; y <= y1; ++y) {
        std::fill(cover.begin(), cover.end(), 0.0);
        for (int line = 0; line < kLines; ++line) {
            const double v = y + (line + 0.5) / kLines;
            cuts.clear();
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vec2 &a = points[i], &b = points[(i + 1) % points.size()];
                if ((a.y <= v) != (b.y <= v)) cuts.push_back(a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x));
            }
            std::sort(cuts.begin(), cuts.end());
            for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) {
                const double from = std::clamp(cuts[i], 0.0, canvas.width * 1.0);
                const double to = std::clamp(cuts[i + 1], 0.0, canvas.width * 1.0);
                for (int x = static_cast<int>(from); x < canvas.width && x < to; ++x) {
                    cover[x] += (std::min(to, x + 1.0) - std::max(from, x * 1.0)) / kLines;
                }
            }
        }
        for (int x = 0; x < canvas.width; ++x) blend(canvas, x, y, colour, alpha * cover[x]);
    }
}

void stroke_line(BrushCanvas& canvas, std::span<const Vec2> points, std::span<const double> widths, const Vec3& colour,
                 double alpha) {
    if (points.size() < 2 || widths.empty()) return;
    // Coverage of the whole line first, so that overlapping pieces do not darken each other.
    Vec2 lo{1e30}, hi{-1e30};
    double widest = 0;
    for (const Vec2& p : points) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    for (const double w : widths) widest = std::max(widest, w);
    const int x0 = std::max(0, static_cast<int>(lo.x - widest - 1));
    const int x1 = std::min(canvas.width - 1, static_cast<int>(hi.x + widest + 1));
    const int y0 = std::max(0, static_cast<int>(lo.y - widest - 1));
    const int y1 = std::min(canvas.height - 1, static_cast<int>(hi.y + widest + 1));
    if (x1 < x0 || y1 < y0) return;
    const int w = x1 - x0 + 1;
    std::vector<float> cover(static_cast<std::size_t>(w) * (y1 - y0 + 1), 0.0f);
    const auto width_at = [&](std::size_t i) { return widths.size() == 1 ? widths[0] : widths[i]; };
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Vec2 a = points[i], d = points[i + 1] - a;
        const double length2 = glm::dot(d, d), wa = width_at(i), wb = width_at(i + 1);
        const double reach = 0.5 * std::max(wa, wb) + 1;
        const int px0 = std::max(x0, static_cast<int>(std::min(a.x, a.x + d.x) - reach));
        const int px1 = std::min(x1, static_cast<int>(std::max(a.x, a.x + d.x) + reach));
        const int py0 = std::max(y0, static_cast<int>(std::min(a.y, a.y + d.y) - reach));
        const int py1 = std::min(y1, static_cast<int>(std::max(a.y, a.y + d.y) + reach));
        for (int y = py0; y <= py1; ++y) {
            for (int x = px0; x <= px1; ++x) {
                const Vec2 p{x + 0.5, y + 0.5};
                const double t = length2 > 0 ? std::clamp(glm::dot(p - a, d) / length2, 0.0, 1.0) : 0;
                const double half = 0.5 * (wa + t * (wb - wa));
                // A line thinner than a pixel covers less of it.
                const double c = std::clamp(std::max(half, 0.5) + 0.5 - glm::length(p - a - t * d), 0.0, 1.0) *
                                 std::min(1.0, 2 * half);
                float& at = cover[static_cast<std::size_t>(y - y0) * w + (x - x0)];
                at = std::max(at, static_cast<float>(c));
            }
        }
    }
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            blend(canvas, x, y, colour, alpha * cover[static_cast<std::size_t>(y - y0) * w + (x - x0)]);
        }
    }
}

namespace {

struct Stroke {
    std::vector<Vec2> points;
};

/// Small letters: two digits to a point, x and y + 2, a space between strokes.
std::vector<Stroke> letter(char c) {
    static constexpr const char* kLetters[26] = {"361605031232 3632",
                                                 "0802 0516263533221203",
                                                 "3526160503122233",
                                                 "3832 3526160503122233",
                                                 "043435261605031232",
                                                 "38281712 0636",
                                                 "36312000 3526160503122233",
                                                 "0802 0516263532",
                                                 "1612 1818",
                                                 "262110 2828",
                                                 "0802 3604 1532",
                                                 "181322",
                                                 "0602 0516263532",
                                                 "0602 0516263532",
                                                 "160503122233352616",
                                                 "0600 0516263533221203",
                                                 "3630 3526160503122233",
                                                 "0602 051626",
                                                 "3616051424332202",
                                                 "18132232 0636",
                                                 "0603122233 3632",
                                                 "062246",
                                                 "0612263246",
                                                 "0632 3602",
                                                 "0622 4610",
                                                 "06360232"};
    std::vector<Stroke> out;
    if (c == ',') return {{{{1.8, 0.3}, {1.2, -1.2}}}};
    if (c < 'a' || c > 'z') return out;
    out.emplace_back();
    for (const char* at = kLetters[c - 'a']; *at != 0;) {
        if (*at == ' ') {
            out.emplace_back();
            ++at;
            continue;
        }
        out.back().points.push_back({at[0] - '0', at[1] - '0' - 2});
        at += 2;
    }
    return out;
}

/// Strokes of a character on a grid 4 wide and 6 high, from the lower left corner.
std::vector<Stroke> strokes_of(char c) {
    using P = std::vector<Vec2>;
    switch (c) {
        case '0':
            return {{P{{0, 1.5}, {0, 4.5}, {1, 6}, {3, 6}, {4, 4.5}, {4, 1.5}, {3, 0}, {1, 0}, {0, 1.5}}}};
        case '1':
            return {{P{{0.8, 4.8}, {2.2, 6}, {2.2, 0}}}};
        case '2':
            return {{P{{0, 4.6}, {0.8, 6}, {3, 6}, {4, 4.6}, {3.4, 3}, {0, 0}, {4, 0}}}};
        case '3':
            return {{P{{0, 6}, {4, 6}, {1.8, 3.6}, {3.2, 3.4}, {4, 1.8}, {3, 0}, {1, 0}, {0, 1}}}};
        case '4':
            return {{P{{3, 0}, {3, 6}, {0, 1.8}, {4, 1.8}}}};
        case '5':
            return {{P{{3.8, 6}, {0.5, 6}, {0.2, 3.4}, {2.4, 3.8}, {4, 2.6}, {3.6, 0.7}, {2, 0}, {0, 0.8}}}};
        case '6':
            return {
                {P{{3.6, 5.4}, {2.2, 6}, {0.6, 4.8}, {0, 2}, {1, 0}, {3, 0}, {4, 1.6}, {3, 3.3}, {1, 3.3}, {0, 2}}}};
        case '7':
            return {{P{{0, 6}, {4, 6}, {1.4, 0}}}};
        case '8':
            return {{P{{1, 3.2},
                       {0.2, 4.6},
                       {1, 6},
                       {3, 6},
                       {3.8, 4.6},
                       {3, 3.2},
                       {1, 3.2},
                       {0, 1.6},
                       {1, 0},
                       {3, 0},
                       {4, 1.6},
                       {3, 3.2}}}};
        case '9':
            return {
                {P{{0.4, 0.6}, {1.8, 0}, {3.4, 1.2}, {4, 4}, {3, 6}, {1, 6}, {0, 4.4}, {1, 2.7}, {3, 2.7}, {4, 4}}}};
        case '.':
            return {{P{{1.8, 0}, {2.0, 0}}}};
        case '-':
            return {{P{{0.6, 3}, {3.4, 3}}}};
        case 'm':
            return {
                {P{{0, 0}, {0, 4}}}, {P{{0, 3}, {0.9, 4}, {2, 3.4}, {2, 0}}}, {P{{2, 3}, {2.9, 4}, {4, 3.4}, {4, 0}}}};
        case 'N':
            return {{P{{0, 0}, {0, 6}, {4, 0}, {4, 6}}}};
        default:
            return letter(c);
    }
}

/// Of the size.
double advance(char c) {
    if (c == ' ' || c == '.' || c == ',') return 3.5 / 6;
    double right = 4;
    if (c >= 'a' && c <= 'z' && c != 'm') {
        right = 0;
        for (const Stroke& s : letter(c))
            for (const Vec2& p : s.points) right = std::max(right, p.x);
    }
    return (right + 1.8) / 6;
}

}  // namespace

void write_text(BrushCanvas& canvas, std::string_view text, const Vec2& at, double size, const Vec3& colour) {
    const double unit = size / 6, line = std::max(1.2, 0.11 * size);
    double x = at.x;
    for (const char c : text) {
        for (Stroke s : strokes_of(c)) {
            for (Vec2& p : s.points) p = {x + p.x * unit, at.y - p.y * unit};
            stroke_line(canvas, s.points, {&line, 1}, colour);
        }
        x += advance(c) * size;
    }
}

double text_width(std::string_view text, double size) {
    double x = 0;
    for (const char c : text) x += advance(c) * size;
    return x;
}

std::vector<std::uint8_t> to_srgb(const BrushCanvas& canvas) {
    std::vector<std::uint8_t> out(canvas.rgb.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double v = std::clamp(static_cast<double>(canvas.rgb[i]), 0.0, 1.0);
        const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
        out[i] = static_cast<std::uint8_t>(std::lround(255 * s));
    }
    return out;
}

}  // namespace tuft::render
