#include "render/brush/shape_drawing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "footprint/outline/section_outline.h"

namespace tuft::render {

using namespace brush;

namespace {

/// Something to draw, by how near it is.
struct Piece {
    double near = 0;
    std::uint32_t index = 0;
};

void sort_by_distance(std::vector<Piece>& pieces) {
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.near < b.near; });
}

Vec3 light_of(const BrushView& view) {
    return glm::normalize(0.75 * view.up - 0.45 * view.right + 0.5 * view.toward());
}

/// Draws pores of one triangle. `tilt`: cosine between its normal and the direction to the viewer.
void draw_pores(BrushCanvas& canvas, const TuftShape& shape, std::span<const std::uint32_t> pores,
                const BrushView& view, double tilt) {
    constexpr int kSides = 8;
    const CarriedShape& carried = *shape.carried;
    for (const std::uint32_t i : pores) {
        const SkinPore& pore = carried.pores[i];
        const auto& t = carried.triangles[pore.triangle];
        const Vec3 at = (1 - pore.weights.x - pore.weights.y) * shape.position[t[0]] +
                        pore.weights.x * shape.position[t[1]] + pore.weights.y * shape.position[t[2]];
        Vec2 round[kSides];
        for (int k = 0; k < kSides; ++k) {
            const double w = 2 * std::numbers::pi * k / kSides;
            round[k] = view(at) + view.scale * pore.radius * Vec2{std::cos(w), tilt * std::sin(w)};
        }
        fill_polygon(canvas, round, linear_colour(96, 66, 34), 0.8);
    }
}

void draw_mesh(BrushCanvas& canvas, const TuftShape& shape, const BrushView& view) {
    const CarriedShape& carried = *shape.carried;
    const Vec3 viewer = view.toward(), light = light_of(view);
    const bool foam = carried.height > 0;
    const Vec3 dark = foam ? linear_colour(120, 84, 40) : linear_colour(48, 32, 22),
               bright = foam ? linear_colour(232, 200, 132) : linear_colour(206, 168, 120);
    std::vector<Piece> pieces;
    std::vector<std::size_t> first(carried.triangles.size() + 1, 0);
    std::vector<std::uint32_t> order(carried.pores.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return carried.pores[a].triangle < carried.pores[b].triangle; });
    for (const SkinPore& pore : carried.pores) ++first[pore.triangle + 1];
    for (std::size_t k = 0; k + 1 < first.size(); ++k) first[k + 1] += first[k];
    for (std::uint32_t i = 0; i < carried.triangles.size(); ++i) {
        const auto& t = carried.triangles[i];
        const Vec3 &p = shape.position[t[0]], &q = shape.position[t[1]], &r = shape.position[t[2]];
        if (glm::dot(glm::cross(q - p, r - p), viewer) > 0) pieces.push_back({glm::dot(p + q + r, viewer), i});
    }
    sort_by_distance(pieces);
    for (const Piece& piece : pieces) {
        const auto& t = carried.triangles[piece.index];
        const Vec3 &p = shape.position[t[0]], &q = shape.position[t[1]], &r = shape.position[t[2]];
        const Vec3 n = glm::normalize(glm::cross(q - p, r - p));
        Vec2 corners[] = {view(p), view(q), view(r)};
        // A little larger: no paper between two.
        const Vec2 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for (Vec2& c : corners) {
            const double size = glm::length(c - middle);
            if (size > 0) c += 0.6 / size * (c - middle);
        }
        fill_polygon(canvas, corners, glm::mix(dark, bright, std::clamp(0.45 + 0.5 * glm::dot(n, light), 0.0, 1.0)));
        const std::size_t begin = first[piece.index], end = first[piece.index + 1];
        draw_pores(canvas, shape, std::span(order).subspan(begin, end - begin), view,
                   std::max(0.2, glm::dot(n, viewer)));
    }
}

void draw_lines(BrushCanvas& canvas, const TuftShape& shape, const BrushView& view) {
    const CarriedShape& carried = *shape.carried;
    std::vector<Piece> pieces;
    pieces.reserve(carried.lines.size());
    for (std::uint32_t i = 0; i < carried.lines.size(); ++i)
        pieces.push_back({glm::dot(shape.position[carried.lines[i][carried.lines[i].size() / 2]], view.toward()), i});
    sort_by_distance(pieces);
    std::vector<Vec2> line;
    const double width = 1.4;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        line.clear();
        for (const std::uint32_t v : carried.lines[pieces[k].index]) line.push_back(view(shape.position[v]));
        const double tone = 0.25 + 0.6 * static_cast<double>(k) / static_cast<double>(pieces.size());
        stroke_line(canvas, line, {&width, 1}, glm::mix(linear_colour(48, 32, 22), linear_colour(206, 168, 120), tone),
                    0.85);
    }
}

}  // namespace

void draw_shape(BrushCanvas& canvas, const TuftShape& shape, const BrushView& view) {
    if (shape.carried->lines.empty())
        draw_mesh(canvas, shape, view);
    else
        draw_lines(canvas, shape, view);
}

void draw_shape_patch(BrushCanvas& canvas, const Tuft& tuft, const TuftShape& shape, const BrushView& view, double y) {
    const CarriedShape& carried = *tuft.carried;
    const Frame sheet;
    const Recycled<footprint::Polygon> polygons = footprint::shape_polygons(tuft, shape, sheet);
    // A cell a pixel.
    footprint::Footprint f = footprint::rasterise_polygons(polygons, sheet, 0, 1 / view.scale);
    if (f.empty()) return;
    if (is_foam(tuft.preset)) footprint::open_pores(carried, shape, {}, f);
    const Vec3 ink = linear_colour(24, 22, 24);
    for (int j = 0; j < f.height; ++j)
        for (int i = 0; i < f.width; ++i) {
            const double cover = f.coverage[static_cast<std::size_t>(j) * f.width + i] / 255.0;
            if (!(cover > 0)) continue;
            const Vec2 at = f.lo + f.cell * Vec2(i, j);
            // Whole pixels: pieces of two cells in one would not add up.
            const Vec2 from = glm::floor(
                Vec2{view.foot.x + view.scale * (at.x - view.origin.x), y + view.scale * (at.y - view.origin.y)} + 0.5);
            const Vec2 cell[] = {from, from + Vec2{1, 0}, from + Vec2{1, 1}, from + Vec2{0, 1}};
            fill_polygon(canvas, cell, ink, cover);
        }
}

}  // namespace tuft::render
