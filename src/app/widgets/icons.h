#pragma once

struct ImDrawList;
struct ImVec2;

/// \file
/// Icons of tools, drawn as lines so that they are sharp at every scale. Window thread.
namespace tuft::app {

enum class Icon {
    brush,
    line,
    curve,
    place,
    write,
    eraser,
    fill,
    pick,
    mask,
    palette,
    references,
    eye,
    closed_eye,
    lock,
    open_lock
};

/// Draws an icon into a square of `size` pixels with its upper left corner at `at`.
void draw_icon(ImDrawList* draw, Icon icon, const ImVec2& at, float size, unsigned colour);

/// Draws the characters 中文 as lines, `height` pixels high and 2.2 times as wide, for systems without a Chinese font.
void draw_zhongwen(ImDrawList* draw, const ImVec2& at, float height, unsigned colour);

}  // namespace tuft::app
