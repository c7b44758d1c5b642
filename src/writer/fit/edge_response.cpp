#include "writer/fit/edge_response.h"

#include <algorithm>
#include <cmath>

#include "writer/gesture/knuckles.h"

namespace tuft::writer {

std::vector<float> edge_distances(const Cells& frame, std::span<const float> coverage) {
    const int w = frame.width, h = frame.height;
    const std::vector<float> soft = softened_coverage(frame, coverage);
    const auto at = [&](int i, int j) { return std::size_t(j) * w + static_cast<std::size_t>(i); };
    struct Point {
        float x = 1e6f, y = 1e6f;  // cells from a centre to the nearest point of the edge that is known
        float squared() const { return x * x + y * y; }
    };
    std::vector<Point> nearest(soft.size());
    for (int j = 1; j + 1 < h; ++j)
        for (int i = 1; i + 1 < w; ++i) {
            const float own = soft[at(i, j)] - 0.5f;
            const float x = soft[at(i + 1, j)], back = soft[at(i - 1, j)], y = soft[at(i, j + 1)],
                        down = soft[at(i, j - 1)];
            const bool in = own > 0;
            if ((x > 0.5f) == in && (back > 0.5f) == in && (y > 0.5f) == in && (down > 0.5f) == in) continue;
            const float gx = 0.5f * (x - back), gy = 0.5f * (y - down);
            const float squared = std::max(gx * gx + gy * gy, 1e-6f);
            const float away = std::clamp(-own / squared, -2 / std::sqrt(squared), 2 / std::sqrt(squared));
            nearest[at(i, j)] = {away * gx, away * gy};
        }
    const auto take = [&](int i, int j, int di, int dj) {
        if (i + di < 0 || i + di >= w || j + dj < 0 || j + dj >= h) return;
        Point p = nearest[at(i + di, j + dj)];
        p.x += static_cast<float>(di), p.y += static_cast<float>(dj);
        Point& own = nearest[at(i, j)];
        if (p.squared() < own.squared()) own = p;
    };
    for (int j = 0; j < h; ++j) {
        for (int i = 0; i < w; ++i) take(i, j, -1, 0), take(i, j, -1, -1), take(i, j, 0, -1), take(i, j, 1, -1);
        for (int i = w - 1; i >= 0; --i) take(i, j, 1, 0);
    }
    for (int j = h - 1; j >= 0; --j) {
        for (int i = w - 1; i >= 0; --i) take(i, j, 1, 0), take(i, j, 1, 1), take(i, j, 0, 1), take(i, j, -1, 1);
        for (int i = 0; i < w; ++i) take(i, j, -1, 0);
    }
    std::vector<float> out(soft.size());
    const auto cell = static_cast<float>(frame.cell);
    for (std::size_t k = 0; k < out.size(); ++k) {
        const float far = std::min(cell * std::sqrt(nearest[k].squared()), kMostDistance);
        out[k] = soft[k] > 0.5f ? far : -far;
    }
    return out;
}

}  // namespace tuft::writer
