#include "writer/gesture/heads.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/text/units.h"
#include "writer/gesture/stroke_line.h"

namespace tuft::writer {
namespace {

constexpr double kCue = 60;                                // units: a shorter first segment is the cue of a head
constexpr double kLeast = 120;                             // units of a segment that has such a head
constexpr double kNear = 50, kNearPart = 0.8;              // units to another line, and the part that it leaves
constexpr double kOn = 24;                                 // units: a head on another line
constexpr double kEnough = 0.8;                            // of the distance aside
constexpr double kAxisFrom = 70, kAxisTo = 140;            // units from the first point, of the axis
constexpr double kAxisFromPart = 0.4, kAxisToPart = 0.75;  // of the length, at most
constexpr double kBend = 0.62, kJoined = 1.9;              // of `Head::before`: a quadratic curve without a corner
constexpr int kHeadPoints = 8;
constexpr double kSteep = 52 * kDegree;  // of a 提, from which on it begins below its axis

/// Where a head begins, units: to the left of the axis in the direction of writing, and before it joins the axis.
struct Head {
    double left = 0, before = 0;
};

std::optional<Head> head_of(const LineSegment& s) {
    if (s.code == 'S') return Head{-std::min(20 + 0.038 * s.length, 43.0), 35};
    if (s.code == 'P') return Head{-std::min(28 + 0.04 * s.length, 48.0), 30};
    if (s.code == 'T') return s.direction < kSteep ? Head{31, 40} : Head{-40, 49};
    return std::nullopt;
}

std::optional<std::vector<Vec2>> with_head(const Glyph& glyph, std::size_t stroke) {
    const StrokeLine line = make_stroke_line(glyph.strokes[stroke].median);
    const bool has_cue = line.segments.size() > 1 && line.segments[0].length < kCue;
    const LineSegment& main = line.segments[has_cue ? 1 : 0];
    const std::optional<Head> usual = head_of(main);
    if (!usual || main.length < kLeast) return std::nullopt;
    double nearest = 1e300;
    for (std::size_t k = 0; k < glyph.strokes.size(); ++k)
        if (k != stroke)
            nearest = std::min(nearest, nearest_on_line(glyph.strokes[k].median, line.points.front()).distance);
    if (nearest < kOn) return std::nullopt;
    const double length = line.along[main.last];
    const Vec2 from = line.at(std::min(kAxisFrom, kAxisFromPart * length)),
               axis = glm::normalize(line.at(std::min(kAxisTo, kAxisToPart * length)) - from), left(-axis.y, axis.x);
    const double aside = usual->left * (nearest < kNear ? kNearPart : 1);
    if (glm::dot(line.points.front() - from, left) / aside > kEnough) return std::nullopt;
    double first = 0;
    for (std::size_t i = 0; i <= main.last; ++i)  // a later segment may run back beside this one
        first = std::min(first, glm::dot(line.points[i] - from, axis));
    const Vec2 start = from + first * axis + aside * left, bend = from + (first + kBend * usual->before) * axis,
               end = from + (first + kJoined * usual->before) * axis;
    std::vector<Vec2> out;
    for (int k = 0; k <= kHeadPoints; ++k) {
        const double t = static_cast<double>(k) / kHeadPoints, u = 1 - t;
        out.push_back(u * u * start + 2 * u * t * bend + t * t * end);
    }
    std::size_t next = 1;
    while (next <= main.last &&
           (line.along[next] < 0.5 * kAxisFrom || glm::dot(line.points[next] - out.back(), axis) < StrokeLine::kApart))
        ++next;
    if (next > main.last) return std::nullopt;  // too tight a bow for a head
    out.insert(out.end(), line.points.begin() + static_cast<std::ptrdiff_t>(next), line.points.end());
    return out;
}

}  // namespace

Glyph with_heads(Glyph glyph) {
    const bool stated =
        std::any_of(glyph.strokes.begin(), glyph.strokes.end(), [](auto& s) { return !s.outline.empty(); });
    if (stated || glyph.single_line || !is_han(glyph.code)) return glyph;
    const Glyph before = glyph;
    for (std::size_t k = 0; k < glyph.strokes.size(); ++k)
        if (auto median = with_head(before, k)) glyph.strokes[k].median = std::move(*median);
    return glyph;
}

}  // namespace tuft::writer
