#include "app/widgets/icons.h"

#include <imgui.h>

#include <initializer_list>
#include <vector>

namespace tuft::app {
namespace {

// Draws in a square of 24 × 24 units.
struct IconPen {
    ImDrawList* draw;
    ImVec2 at;
    float unit;
    unsigned colour;
    float width;

    ImVec2 place(float x, float y) const { return {at.x + x * unit, at.y + y * unit}; }
    void line(std::initializer_list<ImVec2> points, bool closed = false) const {
        std::vector<ImVec2> on;
        for (const ImVec2& p : points) on.push_back(place(p.x, p.y));
        draw->AddPolyline(on.data(), static_cast<int>(on.size()), colour, closed ? ImDrawFlags_Closed : 0, width);
    }
    void area(std::initializer_list<ImVec2> points) const {
        std::vector<ImVec2> on;
        for (const ImVec2& p : points) on.push_back(place(p.x, p.y));
        draw->AddConvexPolyFilled(on.data(), static_cast<int>(on.size()), colour);
    }
    void dot(float x, float y, float r) const { draw->AddCircleFilled(place(x, y), r * unit, colour, 16); }
    void ring(float x, float y, float r) const { draw->AddCircle(place(x, y), r * unit, colour, 32, width); }
    void bezier(ImVec2 a, ImVec2 b, ImVec2 c, ImVec2 d) const {
        draw->AddBezierCubic(place(a.x, a.y), place(b.x, b.y), place(c.x, c.y), place(d.x, d.y), colour, width);
    }
};

void draw_brush(const IconPen& p) {
    p.line({{20, 3}, {12.5f, 10.5f}});
    p.area({{13.5f, 8}, {16, 10.5f}, {13, 13.5f}, {10.5f, 11}});
    p.area({{10, 11.5f}, {12.5f, 14}, {10, 18.5f}, {7.5f, 18}, {6, 16}});
    p.area({{7, 15}, {10, 18.5f}, {3.5f, 21}});
}

void draw_curve(const IconPen& p) {
    p.bezier({4, 18}, {7, 0}, {15, 26}, {20, 6});
    p.dot(4, 18, 2.2f);
    p.dot(12, 12.4f, 2.2f);
    p.dot(20, 6, 2.2f);
}

// A drawing with handles at its corners.
void draw_place(const IconPen& p) {
    p.line({{5, 5}, {19, 5}, {19, 19}, {5, 19}}, true);
    for (const ImVec2& c : {ImVec2(5, 5), ImVec2(19, 5), ImVec2(19, 19), ImVec2(5, 19)})
        p.area({{c.x - 2, c.y - 2}, {c.x + 2, c.y - 2}, {c.x + 2, c.y + 2}, {c.x - 2, c.y + 2}});
    p.bezier({8, 15}, {10, 6}, {14, 18}, {16, 9});
}

// A letter in a brush's strokes, on its line.
void draw_write(const IconPen& p) {
    p.line({{6, 17}, {12, 4}, {18, 17}});
    p.line({{8.3f, 12}, {15.7f, 12}});
    p.line({{4, 21}, {20, 21}});
}

void draw_eraser(const IconPen& p) {
    p.line({{13, 4}, {20, 11}, {12, 19}, {8, 19}, {4, 15}}, true);
    p.area({{9, 8}, {16, 15}, {12, 19}, {8, 19}, {4.5f, 14.5f}});
    p.line({{12, 20}, {21, 20}});
}

// A tilted pot of paint with a drop.
void draw_fill(const IconPen& p) {
    p.line({{10, 4}, {18, 12}, {11, 19}, {3, 11}}, true);
    p.area({{4, 11}, {18, 12}, {11, 19}});
    p.line({{7, 3}, {12, 8}});
    p.area({{20, 14}, {22, 18}, {20, 20}, {18, 18}});
}

void draw_pick(const IconPen& p) {
    p.line({{4, 20}, {5, 16}, {12, 9}, {15, 12}, {8, 19}}, true);
    p.area({{13, 6}, {18, 11}, {16.5f, 12.5f}, {11.5f, 7.5f}});
    p.area({{16, 8.5f}, {20.5f, 5}, {20.5f, 3.5f}, {19, 3.5f}, {15, 7.5f}});
}

void draw_mask(const IconPen& p) {
    p.line({{4, 4}, {20, 4}, {20, 20}, {4, 20}}, true);
    p.area({{4, 4}, {20, 4}, {4, 20}});
}

void draw_palette(const IconPen& p) {
    p.ring(12, 12, 9);
    for (const ImVec2& c : {ImVec2(8, 9), ImVec2(13, 7), ImVec2(16.5f, 11)}) p.dot(c.x, c.y, 1.7f);
    p.ring(14, 16.5f, 2);
}

// A picture with hills and a sun, pinned.
void draw_references(const IconPen& p) {
    p.line({{3, 6}, {21, 6}, {21, 20}, {3, 20}}, true);
    p.area({{5, 18.5f}, {10, 12}, {14, 18.5f}});
    p.area({{12, 18.5f}, {16, 14}, {19.5f, 18.5f}});
    p.dot(16.5f, 10, 1.7f);
    p.dot(12, 4.5f, 2.2f);
}

void draw_eye(const IconPen& p, bool open) {
    p.bezier({2, 12}, {7, 19}, {17, 19}, {22, 12});
    if (open) {
        p.bezier({2, 12}, {7, 5}, {17, 5}, {22, 12});
        p.dot(12, 12, 3.2f);
        return;
    }
    for (const ImVec2& lash : {ImVec2(6, 20), ImVec2(12, 21.5f), ImVec2(18, 20)})
        p.line({{12 + 0.7f * (lash.x - 12), 16.5f}, lash});
}

void draw_lock(const IconPen& p, bool closed) {
    p.area({{5, 11}, {19, 11}, {19, 21}, {5, 21}});
    const float x = closed ? 0.0f : 7.0f;
    p.bezier({8 + x, 11}, {8 + x, 1}, {16 + x, 1}, {16 + x, closed ? 11.0f : 8.0f});
}

}  // namespace

void draw_icon(ImDrawList* draw, Icon icon, const ImVec2& at, float size, unsigned colour) {
    const IconPen p{draw, at, size / 24, colour, size / 24 * 1.7f};
    switch (icon) {
        case Icon::brush:
            return draw_brush(p);
        case Icon::line:
            p.line({{5, 19}, {19, 5}});
            p.dot(5, 19, 2.2f);
            return p.dot(19, 5, 2.2f);
        case Icon::curve:
            return draw_curve(p);
        case Icon::place:
            return draw_place(p);
        case Icon::write:
            return draw_write(p);
        case Icon::eraser:
            return draw_eraser(p);
        case Icon::fill:
            return draw_fill(p);
        case Icon::pick:
            return draw_pick(p);
        case Icon::mask:
            return draw_mask(p);
        case Icon::palette:
            return draw_palette(p);
        case Icon::references:
            return draw_references(p);
        case Icon::eye:
        case Icon::closed_eye:
            return draw_eye(p, icon == Icon::eye);
        case Icon::lock:
        case Icon::open_lock:
            return draw_lock(p, icon == Icon::lock);
    }
}

void draw_zhongwen(ImDrawList* draw, const ImVec2& at, float height, unsigned colour) {
    IconPen p{draw, at, height / 24, colour, height / 24 * 2.0f};
    p.line({{4, 7}, {20, 7}, {20, 15}, {4, 15}}, true);
    p.line({{12, 2}, {12, 22}});
    p.at.x += 1.2f * height;
    p.line({{11, 2}, {13, 5}});
    p.line({{3, 7.5f}, {21, 7.5f}});
    p.bezier({17, 7.5f}, {15, 15}, {9, 20}, {3, 22});
    p.bezier({7, 7.5f}, {9, 15}, {15, 20}, {21, 22});
}

}  // namespace tuft::app
