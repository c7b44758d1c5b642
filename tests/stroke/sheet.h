#pragma once

#include <algorithm>
#include <string>

#include "stroke/document/document.h"
#include "stroke/surface/flat_sheet.h"

/// A sheet and strokes over it, shared by the tests of this module.
namespace tuft::stroke {

inline constexpr double kSide = 0.06;         // metres
inline constexpr std::uint32_t kSize = 1024;  // texels; the sheet covers all but a margin of 8

// A flat sheet in the plane through `centre` spanned by `frame`, with the UVs of a photograph.
inline Model sheet(const Frame& frame = {}, std::uint32_t size = kSize) {
    const double texel = kSide / (size - 16);
    return make_flat_sheet({.frame = frame,
                            .low = Vec2(-0.5 * kSide),
                            .high = Vec2(0.5 * kSide),
                            .columns = 20,
                            .rows = 20,
                            .texels = size,
                            .texel = texel,
                            .corner = Vec2(-0.5 * kSide - 8 * texel)});
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
