#include <algorithm>
#include <cmath>
#include <numbers>

#include "writer/gesture/side_table.h"

namespace tuft::writer {
namespace {

constexpr double kFarNeighbour = 120;  // units
constexpr std::size_t kPerStroke = 28, kPerSegment = 6;

double deviation(double angle, double from) {
    return std::remainder(angle - from, 2 * std::numbers::pi);
}

double angle_of(const Vec2& d) {
    return std::atan2(d.y, d.x);
}

/// Room to the nearest other line at a point, over all of them and by the side of the direction.
struct SideRoom {
    double all = kFarNeighbour, left = kFarNeighbour, right = kFarNeighbour;
};
SideRoom room_at(const Glyph& glyph, std::size_t stroke, const Vec2& p, const Vec2& direction) {
    SideRoom room;
    for (std::size_t k = 0; k < glyph.strokes.size(); ++k) {
        if (k == stroke) continue;
        const auto [nearest, d] = nearest_on_line(glyph.strokes[k].median, p);
        room.all = std::min(room.all, d);
        const Vec2 off = nearest - p;
        double& side = direction.x * off.y - direction.y * off.x > 0 ? room.left : room.right;
        side = std::min(side, d);
    }
    return room;
}

}  // namespace

std::size_t count_features(std::size_t n_segments) {
    return kPerStroke + kPerSegment * n_segments;
}

std::vector<double> stroke_features(const StrokeLine& line, const Glyph& glyph, std::size_t stroke) {
    const double length = line.length(), n = static_cast<double>(glyph.strokes.size());
    const Vec2 middle = line.at(0.5 * length) / kSide - 0.5;
    const double head = room_at(glyph, stroke, line.points.front(), {1, 0}).all,
                 tail = room_at(glyph, stroke, line.points.back(), {1, 0}).all;
    double total = 0;
    for (const GlyphStroke& s : glyph.strokes)
        for (std::size_t i = 1; i < s.median.size(); ++i) total += glm::distance(s.median[i], s.median[i - 1]);
    std::vector<double> f{1,
                          std::log(std::max(n, 1.0) / 10),
                          std::log(std::max(total, 100.0) / 3000),
                          middle.x,
                          middle.y,
                          n > 1 ? static_cast<double>(stroke) / (n - 1) - 0.5 : 0,
                          head / kFarNeighbour,
                          tail / kFarNeighbour};
    for (const double part : {0.02, 0.25, 0.5, 0.75, 0.98}) {
        const SideRoom r = room_at(glyph, stroke, line.at(part * length), line.direction(part * length));
        f.push_back(r.left / kFarNeighbour);
        f.push_back(r.right / kFarNeighbour);
    }
    const auto toward = [&](double from, double to) { return angle_of(line.at(to) - line.at(from)); };
    for (const double reach : {12.0, 24.0, 48.0}) {
        f.push_back(deviation(toward(0, std::min(reach, length)), line.segments.front().direction));
        f.push_back(deviation(toward(length - std::min(reach, length), length), line.segments.back().direction));
    }
    f.push_back(std::pow(head / kFarNeighbour, 2));
    f.push_back(std::pow(tail / kFarNeighbour, 2));
    // The path on beyond the ends: what a stroke runs into.
    for (const bool at_tail : {false, true}) {
        const Vec2 p = at_tail ? line.points.back() : line.points.front();
        const Vec2 d = at_tail ? line.direction(length, 16) : -line.direction(0, 16);
        f.push_back(room_at(glyph, stroke, p + 30.0 * d, d).all / kFarNeighbour);
    }
    for (const LineSegment& s : line.segments) {
        const double log_length = std::log(std::max(s.length, 10.0) / 300);
        f.push_back(log_length);
        f.push_back(log_length * log_length);
        f.push_back(deviation(s.direction, code_direction(s.code)));
        f.push_back(10 * s.bow);
        const double begin = line.along[s.first];
        for (const double part : {0.25, 0.75})
            f.push_back(deviation(angle_of(line.at(begin + part * s.length) - line.points[s.first]), s.direction));
    }
    return f;
}

}  // namespace tuft::writer
