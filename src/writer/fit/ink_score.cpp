#include "writer/fit/ink_score.h"

#include <cmath>

namespace tuft::writer {
namespace {

constexpr double kRim = 4;  // units of depth at which a wrong cell counts once

}  // namespace

std::vector<float> coverage_by(const stroke::PlaneInk& ink, const Cells& cells) {
    const auto i = std::llround(cells.lo.x / cells.cell), j = std::llround(cells.lo.y / cells.cell);
    std::vector<float> coverage(cells.inside.size());
    for (int y = 0; y < cells.height; ++y)
        ink.copy_row(i, j + y, std::span(coverage).subspan(std::size_t(y) * cells.width, std::size_t(cells.width)));
    return coverage;
}

InkScore score_of(const FitTarget& target, std::span<const float> depths, std::span<const float> coverage) {
    double both = 0, either = 0, deep = 0;
    for (std::size_t at = 0; at < coverage.size(); ++at) {
        const bool wanted = target.wanted.inside[at] != 0, there = coverage[at] > kTaken;
        if (wanted == there) {
            both += there, either += there;
            continue;
        }
        const double weight = target.weight(at);
        either += weight;
        deep += weight * static_cast<double>(depths[at]) / kRim;
    }
    return {either > 0 ? both / either : 0, both > 0 ? both / (both + deep) : 0};
}

}  // namespace tuft::writer
