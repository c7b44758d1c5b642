#include "writer/fit/ink_score.h"

namespace tuft::writer {
namespace {

constexpr double kRim = 4;  // units of depth at which a wrong cell counts once

}  // namespace

std::vector<float> coverage_by(const stroke::PlaneInk& ink, const Cells& cells, double unit) {
    std::vector<float> coverage;
    coverage.reserve(cells.inside.size());
    for (int j = 0; j < cells.height; ++j)
        for (int i = 0; i < cells.width; ++i) coverage.push_back(static_cast<float>(ink.at(cells.centre(i, j) * unit)));
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
