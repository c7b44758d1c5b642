#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/plane_vectors.h"
#include "writer/fit/writer.h"

namespace tuft::writer {
namespace {

constexpr double kPull = 0.4;         // of the gap: how far a link follows the directions of its strokes
constexpr double kPressed = 2.2;      // of `link_half`: where a link leaves a stroke and where it enters one
constexpr double kLongest = 0.5;      // of `link_half`: the middle of the longest link
constexpr double kThinnest = 0.55;    // of a link's length: the tip is lifted sooner than it is set down
constexpr double kTurnedBack = 0.35;  // of the reach, lost by a link that turns round once
constexpr double kTightest = 20;      // units a radian: a tighter turn of a link becomes a ball
constexpr double kFlowing = 0.5 * std::numbers::pi;  // a turn up to this needs no room
constexpr double kCrossing = 0.25;                   // of a link's stations, over ink: more is not drawn
constexpr double kJoint = 60;                    // units of a stroke beside its link that do not count as ink crossed
constexpr double kWithin = 0.8;                  // of the half width of ink
constexpr double kCue = 40;                      // units of a head that a link takes the place of, at most
constexpr double kAhead = 48;                    // units into a stroke of its direction
constexpr double kAside = std::numbers::pi / 4;  // of a head from that direction
constexpr std::size_t kEndStations = 3;          // of a direction

Vec2 unit_from(const Vec2& d) {
    const double size = glm::length(d);
    return size > 1e-9 ? d / size : Vec2(0);
}

/// Rounds corners: a Gaussian over the path, ends fixed.
void round_corners(std::vector<Station>& s, double over) {
    const double sigma = over / kStationsApart;
    const int reach = static_cast<int>(std::ceil(2.5 * sigma)), n = static_cast<int>(s.size());
    const std::vector<Station> p = s;
    for (int i = 1; i + 1 < n; ++i) {
        const int room = std::min({reach, i, n - 1 - i});  // as far on both sides, so that ends stay
        Vec2 sum(0);
        double all = 0;
        for (int k = i - room; k <= i + room; ++k) {
            const double z = (k - i) / sigma, w = std::exp(-0.5 * z * z);
            sum += w * p[static_cast<std::size_t>(k)].centre, all += w;
        }
        s[static_cast<std::size_t>(i)].centre = sum / all;
    }
}

Vec2 out_of(const std::vector<Station>& s) {
    return unit_from(s.back().centre - s[s.size() - 1 - std::min(s.size() - 1, kEndStations)].centre);
}

Vec2 into(const std::vector<Station>& s) {
    return unit_from(s[std::min(s.size() - 1, kEndStations)].centre - s.front().centre);
}

/// A stroke without the part of its head that lies across its way: a tuft that comes along a link is not set down anew.
std::vector<Station> trim_head(const std::vector<Station>& s) {
    double along = 0;
    std::size_t ahead = 0;
    while (ahead + 1 < s.size() && along < kAhead)
        along += glm::distance(s[ahead + 1].centre, s[ahead].centre), ++ahead;
    if (ahead + kEndStations >= s.size()) return s;
    const Vec2 way = s[ahead + kEndStations].centre - s[ahead].centre;
    std::size_t first = 0;
    for (double off = 0; first + 1 < ahead && off < kCue; ++first) {
        if (std::abs(angle_between(s[first + 2].centre - s[first].centre, way)) < kAside) break;
        off += glm::distance(s[first + 1].centre, s[first].centre);
    }
    return {s.begin() + static_cast<std::ptrdiff_t>(first), s.end()};
}

/// Stations of a Hermite curve from the end of one stroke to the begin of the next. The half width falls from both ends
/// to where the tip is highest, by the square of the distance from there; lower in a longer link.
std::vector<Station> link_between(const std::vector<Station>& a, const std::vector<Station>& b, const Style& style) {
    const Vec2 from = a.back().centre, to = b.front().centre;
    const double gap = glm::distance(from, to), pull = kPull * gap;
    const Vec2 out = out_of(a), in = into(b);
    const double thin = style.link_half * std::lerp(1.0, kLongest, std::min(gap / style.link, 1.0)),
                 pressed = kPressed * style.link_half;
    std::vector<Station> link;
    const int n = std::max(2, static_cast<int>(gap / kStationsApart));
    for (int i = 1; i < n; ++i) {
        const double t = static_cast<double>(i) / n, u = 1 - t;
        const double off = t < kThinnest ? 1 - t / kThinnest : (t - kThinnest) / (1 - kThinnest);
        link.push_back(
            {u * u * u * from + 3 * u * u * t * (from + pull * out) + 3 * u * t * t * (to - pull * in) + t * t * t * to,
             std::lerp(thin, pressed, off * off)});
    }
    return link;
}

/// Whether a place lies in the ink of a stroke, but for its parts within `but_head` and `but_tail` units of its ends.
bool is_in_ink(const Vec2& p, const std::vector<Station>& s, double but_head, double but_tail) {
    return std::any_of(s.begin(), s.end(), [&](const Station& station) {
        return glm::distance(station.centre, p) < kWithin * station.half &&
               !(glm::distance(station.centre, s.front().centre) < but_head) &&
               !(glm::distance(station.centre, s.back().centre) < but_tail);
    });
}

/// Whether a hand goes from stroke `next` − 1 to `next` with the brush down: nearby, without turning round, and not
/// over ink.
bool is_drawn(const std::vector<Station>& link, const std::vector<std::vector<Station>>& strokes, std::size_t next,
              const std::vector<Station>& entry, const Style& style) {
    const std::vector<Station>& before = strokes[next - 1];
    const Vec2 chord = entry.front().centre - before.back().centre;
    const double gap = glm::length(chord);
    const double turn =
        gap > 1e-9 ? std::abs(angle_between(out_of(before), chord)) + std::abs(angle_between(chord, into(entry)))
                   : std::abs(angle_between(out_of(before), into(entry)));
    const double tight = turn > kFlowing ? kTightest * turn : 0;
    if (gap < tight || gap > style.link * (1 - kTurnedBack * turn / (2 * std::numbers::pi))) return false;
    const auto crossing = std::count_if(link.begin(), link.end(), [&](const Station& station) {
        for (std::size_t k = 0; k < strokes.size(); ++k)
            if (is_in_ink(station.centre, strokes[k], k == next ? kJoint : 0, k + 1 == next ? kJoint : 0)) return true;
        return false;
    });
    return static_cast<double>(crossing) <= kCrossing * static_cast<double>(link.size());
}

}  // namespace

std::vector<std::vector<Station>> linked(std::vector<std::vector<Station>> strokes, const Style& style) {
    for (std::vector<Station>& s : strokes) {
        for (Station& station : s) station.half *= style.weight;
        if (style.rounding > 0) round_corners(s, style.rounding);
    }
    if (!(style.link > 0)) return strokes;
    const double pressed = kPressed * style.link_half;
    std::vector<std::vector<Station>> out;
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        if (k > 0) {
            std::vector<Station> entry = trim_head(strokes[k]);
            const std::vector<Station> link = link_between(strokes[k - 1], entry, style);
            if (is_drawn(link, strokes, k, entry, style)) {
                std::vector<Station>& line = out.back();
                // No neck between a stroke and its link.
                for (std::size_t i = 0; i < kEndStations; ++i) {
                    if (i < line.size())
                        line[line.size() - 1 - i].half = std::max(line[line.size() - 1 - i].half, pressed);
                    if (i < entry.size()) entry[i].half = std::max(entry[i].half, pressed);
                }
                line.insert(line.end(), link.begin(), link.end());
                line.insert(line.end(), entry.begin(), entry.end());
                continue;
            }
        }
        out.push_back(strokes[k]);
    }
    return out;
}

}  // namespace tuft::writer
