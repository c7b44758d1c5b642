#include "writer/fit/ink_score.h"

#include <cmath>

namespace tuft::writer {
namespace {

constexpr double kRim = 4;       // units of depth at which a wrong cell counts once
constexpr double kSharpest = 4;  // of kKnuckle: a pinhole's edge is sharper, and no worse to look at

bool is_under_another(const FitTarget& target, const Vec2& p) {
    const Cells& c = target.wanted;
    const Vec2 cell = glm::floor((p - c.lo) / c.cell);
    const auto i = static_cast<int>(cell.x), j = static_cast<int>(cell.y);
    if (i < 0 || j < 0 || i >= c.width || j >= c.height) return false;
    return target.weight(std::size_t(j) * c.width + static_cast<std::size_t>(i)) < 1;
}

}  // namespace

std::vector<float> coverage_by(const stroke::PlaneInk& ink, const Cells& cells) {
    const auto i = std::llround(cells.lo.x / cells.cell), j = std::llround(cells.lo.y / cells.cell);
    std::vector<float> coverage(cells.inside.size());
    for (int y = 0; y < cells.height; ++y)
        ink.copy_row(i, j + y, std::span(coverage).subspan(std::size_t(y) * cells.width, std::size_t(cells.width)));
    return coverage;
}

InkSums sums_of(const FitTarget& target, std::span<const float> depths, std::span<const float> coverage) {
    InkSums sums;
    for (std::size_t at = 0; at < coverage.size(); ++at) {
        const bool wanted = target.wanted.inside[at] != 0, there = coverage[at] > kTaken;
        if (wanted == there) {
            sums.both += there, sums.either += there;
            continue;
        }
        const double weight = target.weight(at);
        sums.either += weight;
        sums.deep += weight * static_cast<double>(depths[at]) / kRim;
    }
    return sums;
}

InkScore score_of(const InkSums& s) {
    return {s.either > 0 ? s.both / s.either : 0, s.both > 0 ? s.both / (s.both + s.deep) : 0};
}

InkScore score_of(const FitTarget& target, std::span<const float> depths, std::span<const float> coverage) {
    return score_of(sums_of(target, depths, coverage));
}

std::vector<EdgeTurn> wanted_edge_turns(const Cells& wanted) {
    return edge_turns(wanted, coverage_of(wanted), 0.5 * kKnuckle);
}

std::vector<EdgeTurn> seen_knuckles(const FitTarget& target, std::span<const EdgeTurn> turns,
                                    std::span<const float> coverage) {
    std::vector<EdgeTurn> knuckles = knuckles_of(target.wanted, coverage, turns);
    std::erase_if(knuckles, [&](const EdgeTurn& turn) { return is_under_another(target, turn.at); });
    return knuckles;
}

double sharpness_of(std::span<const EdgeTurn> knuckles) {
    double sum = 0;
    for (const EdgeTurn& turn : knuckles) sum += std::min(std::abs(turn.curvature) / kKnuckle, kSharpest);
    return sum;
}

double sharpness_of(const FitTarget& target, std::span<const EdgeTurn> turns, std::span<const float> coverage) {
    return sharpness_of(seen_knuckles(target, turns, coverage));
}

}  // namespace tuft::writer
