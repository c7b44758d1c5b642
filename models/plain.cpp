#include <cmath>
#include <numbers>

#include "shape.h"
#include "turned.h"

namespace tuft::models {

namespace {

/// A grid of n × n squares spanned by `u` and `v` from `corner`, facing u × v.
void add_grid(Shape& shape, Vec3 corner, Vec3 u, Vec3 v, int nu, int nv) {
    const auto first = static_cast<std::uint32_t>(shape.points.size());
    const auto stride = static_cast<std::uint32_t>(nu + 1);
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i) shape.points.push_back(corner + u * (double(i) / nu) + v * (double(j) / nv));
    for (int j = 0; j < nv; ++j) {
        for (int i = 0; i < nu; ++i) {
            const std::uint32_t a = first + static_cast<std::uint32_t>(j) * stride + static_cast<std::uint32_t>(i);
            const std::uint32_t b = a + 1, c = b + stride, d = a + stride;
            if ((i + j) % 2 == 0) {
                shape.triangles.push_back({a, b, c});
                shape.triangles.push_back({a, c, d});
            } else {
                shape.triangles.push_back({a, b, d});
                shape.triangles.push_back({b, c, d});
            }
        }
    }
}

}  // namespace

Shape make_sheet() {
    Shape shape;
    add_grid(shape, {-100, -100, 0}, {200, 0, 0}, {0, 200, 0}, 50, 50);
    return shape;
}

Shape make_thin_plate() {
    const double half = 60, thickness = 1;
    const int n = 40;
    Shape shape;
    add_grid(shape, {-half, -half, thickness}, {2 * half, 0, 0}, {0, 2 * half, 0}, n, n);
    add_grid(shape, {-half, half, 0}, {2 * half, 0, 0}, {0, -2 * half, 0}, n, n);
    // The rim joins the two faces: vertex (i, j) of the top, row by row, then of the bottom.
    const auto top = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    const auto bottom = [&](int i, int j) { return top(i, n - j) + (n + 1) * (n + 1); };
    const auto wall = [&](int i0, int j0, int i1, int j1) {
        shape.triangles.push_back({bottom(i0, j0), bottom(i1, j1), top(i1, j1)});
        shape.triangles.push_back({bottom(i0, j0), top(i1, j1), top(i0, j0)});
    };
    for (int k = 0; k < n; ++k) {
        wall(k, 0, k + 1, 0);
        wall(n, k, n, k + 1);
        wall(n - k, n, n - k - 1, n);
        wall(0, n - k, 0, n - k - 1);
    }
    return shape;
}

Shape make_sphere() {
    const double radius = 50;
    Outline o;
    const int n = 64;
    for (int i = 0; i <= n; ++i) {
        const double a = std::numbers::pi * i / n;
        const double r = i == 0 || i == n ? 0 : radius * std::sin(a);
        o.emplace_back(r, radius - radius * std::cos(a));
    }
    return turn(o, 128);
}

Shape make_cylinder() {
    const double radius = 40, height = 120;
    Outline o{{0, 0}};
    add_line(o, {radius, 0}, 10);
    add_line(o, {radius, height}, 40);
    add_line(o, {0, height}, 10);
    return turn(o, 96);
}

Shape make_torus() {
    const double ring = 60, tube = 25;
    Outline o;
    const int n = 56;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        o.emplace_back(ring + tube * std::cos(a), tube + tube * std::sin(a));
    }
    return turn_ring(o, 120);
}

}  // namespace tuft::models
