#include <algorithm>
#include <cmath>

#include "writer/fit/writer.h"

namespace tuft::writer {
namespace {

constexpr double kPull = 0.4;  // of the gap: how far a link follows the directions of its strokes

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

/// Stations of a Hermite curve from the end of one stroke to the begin of the next.
std::vector<Station> link_between(const std::vector<Station>& a, const std::vector<Station>& b, double half) {
    const Vec2 from = a.back().centre, to = b.front().centre;
    const double gap = glm::distance(from, to), pull = kPull * gap;
    const Vec2 out = unit_from(from - a[a.size() - std::min<std::size_t>(a.size(), 4)].centre),
               in = unit_from(b[std::min<std::size_t>(b.size() - 1, 3)].centre - to);
    std::vector<Station> link;
    const int n = std::max(2, static_cast<int>(gap / kStationsApart));
    for (int i = 1; i < n; ++i) {
        const double t = static_cast<double>(i) / n, u = 1 - t;
        link.push_back(
            {u * u * u * from + 3 * u * u * t * (from + pull * out) + 3 * u * t * t * (to - pull * in) + t * t * t * to,
             half});
    }
    return link;
}

}  // namespace

std::vector<std::vector<Station>> linked(std::vector<std::vector<Station>> strokes, const Style& style) {
    for (std::vector<Station>& s : strokes) {
        for (Station& station : s) station.half *= style.weight;
        if (style.rounding > 0) round_corners(s, style.rounding);
    }
    if (!(style.link > 0)) return strokes;
    std::vector<std::vector<Station>> out;
    for (std::vector<Station>& s : strokes) {
        const bool near = !out.empty() && glm::distance(out.back().back().centre, s.front().centre) <= style.link;
        if (!near) {
            out.push_back(std::move(s));
            continue;
        }
        std::vector<Station>& line = out.back();
        const std::vector<Station> link = link_between(line, s, style.link_half);
        line.back().half = std::max(line.back().half, style.link_half);
        s.front().half = std::max(s.front().half, style.link_half);
        line.insert(line.end(), link.begin(), link.end());
        line.insert(line.end(), s.begin(), s.end());
    }
    return out;
}

}  // namespace tuft::writer
