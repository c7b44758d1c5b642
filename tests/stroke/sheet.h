#pragma once

#include <algorithm>
#include <string>

#include "stroke/document/document.h"

/// A sheet and strokes over it, shared by the tests of this module.
namespace tuft::stroke {

inline constexpr double kSide = 0.06;         // metres
inline constexpr std::uint32_t kSize = 1024;  // texels; the sheet covers all but a margin of 8

// A flat sheet in the plane through `centre` spanned by `frame`, with the UVs of a photograph.
inline Model sheet(const Frame& frame = {}, std::uint32_t size = kSize) {
    constexpr int n = 20;
    mesh::TriangleMesh m;
    std::vector<Vec2f> uv;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
            m.positions.push_back(Vec3f(frame.to_world({(x - 0.5) * kSide, (y - 0.5) * kSide, 0})));
            const double margin = 8.0 / size;
            uv.push_back(Vec2f(margin + x * (1 - 2 * margin), margin + y * (1 - 2 * margin)));
            m.bounds.add(Vec3(m.positions.back()));
        }
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            m.triangles.push_back({a, b, d});
            m.triangles.push_back({a, d, c});
        }
    const std::size_t t = m.triangles.size();
    m.corner_normals.assign(3 * t, Vec3f(frame.n));
    m.neighbours.assign(3 * t, kNone);
    for (std::uint32_t i = 0; i < t; ++i)
        for (int k = 0; k < 3; ++k)
            for (std::uint32_t j = 0; j < t; ++j)
                for (int l = 0; l < 3; ++l)
                    if (m.triangles[i][k] == m.triangles[j][(l + 1) % 3] &&
                        m.triangles[i][(k + 1) % 3] == m.triangles[j][l])
                        m.neighbours[3 * i + k] = j;
    atlas::Atlas a;
    a.size = size;
    a.texel_size = kSide / (size - 16);
    a.n_charts = 1;
    a.triangle_chart.assign(t, 0);
    for (const auto& triangle : m.triangles)
        for (const std::uint32_t v : triangle) a.corner_uvs.push_back(uv[v]);
    return prepare_model(std::move(m), std::move(a));
}

// The holder upright over the sheet, pressed `depth` and moved along x with an entry and a lift.
inline PaintStroke line(const std::string& brush, double depth, const Frame& frame = {}, double speed = 0.03,
                        int rate = 200) {
    const double length = brush::load_preset(brush).length;
    PaintStroke s;
    s.trace.flat = false;
    s.brush = brush;
    s.ink = "carbon";
    const double time = 0.03 / speed;
    const int n = static_cast<int>(time * rate);
    const Mat3 turn(frame.t, frame.b, frame.n);
    for (int i = 0; i <= n; ++i) {
        const double u = static_cast<double>(i) / n;
        const double press = std::min(1.0, std::min(u, 1 - u) * 6);
        StrokeSample p;
        p.time = u * time;
        p.position = frame.to_world({-0.015 + 0.03 * u, 0, length + 1e-3 - (depth + 1e-3) * press});
        p.rotation = glm::quat_cast(turn);
        s.trace.samples.push_back(p);
    }
    return s;
}

}  // namespace tuft::stroke
