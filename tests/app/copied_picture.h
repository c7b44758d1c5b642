#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "io/image/image.h"

/// \file
/// A picture of 十 as bars with round ends, for tests of copied characters.
namespace tuft::app {

/// Writes the picture: 400 pixels, a horizontal bar and a vertical one, 24 pixels thick.
inline void write_cross(const std::string& path) {
    constexpr int side = 400;
    constexpr double half = 12;
    std::vector<std::uint8_t> grey;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const Vec2 p(x + 0.5, y + 0.5), on_h(std::clamp(p.x, 50.0, 350.0), 200),
                on_v(200, std::clamp(p.y, 50.0, 350.0));
            const double ink = half - std::min(glm::distance(p, on_h), glm::distance(p, on_v));
            grey.push_back(static_cast<std::uint8_t>(230 - 200 * std::clamp(ink + 0.5, 0.0, 1.0)));
        }
    io::write_image(path, io::view_of(side, side, 1, grey.data()));
}

}  // namespace tuft::app
