#include "writer/fit/path.h"

#include <algorithm>

namespace tuft::writer {

std::vector<double> lengths_of(const std::vector<Station>& s) {
    std::vector<double> along{0};
    for (std::size_t i = 1; i < s.size(); ++i)
        along.push_back(along.back() + glm::distance(s[i].centre, s[i - 1].centre));
    return along;
}

Vec2 direction_at(const std::vector<Station>& s, std::size_t i) {
    const std::size_t a = i - std::min<std::size_t>(i, 1), b = std::min(s.size() - 1, i + 1);
    const Vec2 d = s[b].centre - s[a].centre;
    const double size = glm::length(d);
    return size > 1e-9 ? d / size : Vec2(1, 0);
}

std::size_t nearest_station(const std::vector<Station>& s, const Vec2& p) {
    std::size_t best = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < s.size(); ++i)
        if (const Vec2 d = p - s[i].centre; glm::dot(d, d) < least) least = glm::dot(d, d), best = i;
    return best;
}

}  // namespace tuft::writer
