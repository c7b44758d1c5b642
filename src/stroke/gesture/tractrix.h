#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// A point dragged on a string, solved exactly along the straight pieces of a path, and the length
/// of path that it counts. Used wherever the hand's samples are followed over path length, so that
/// the result does not depend on how many samples the path has.
namespace tuft::stroke {

/// Where the free end of a string lies after its other end went straight from `from` to `to`
/// (metres, any frame). The end stays while the string is slack, and follows a tractrix while it is
/// taut: with φ the angle between the string and the motion, and x the way of the taut string,
///
///     tan(φ/2) = tan(φ0/2) e^(−x / length)
///
/// (Huygens 1692). |to − end| ≤ `length` afterwards. V: Vec2 or Vec3.
template <class V>
V drag_string(const V& end, const V& from, const V& to, double length) {
    const V motion = to - from, string = from - end;
    const double way = glm::length(motion), reach = glm::length(to - end);
    if (reach <= length) return end;
    if (!(length > 0)) return to;
    if (!(way > 0)) return to - (length / reach) * (to - end);
    const V ahead = motion / way;
    // Where the string becomes taut: the hand leaves the circle round the end.
    const double along = glm::dot(string, ahead);
    const double left = along * along - glm::dot(string, string) + length * length;
    const double taut = std::clamp(std::sqrt(std::max(0.0, left)) - along, 0.0, way);
    const V at = (string + taut * ahead) / length;
    const double cosine = std::clamp(glm::dot(at, ahead), -1.0, 1.0);
    const V across = at - cosine * ahead;
    const double sine = glm::length(across);
    if (sine < 1e-12) return to - length * ahead;
    const double half = sine / (1 + cosine) * std::exp(-(way - taut) / length);  // tan(φ/2)
    const double scale = 1 / (1 + half * half);
    return to - length * scale * ((1 - half * half) * ahead + (2 * half / sine) * across);
}

/// Metres of path from the first sample to each, of samples with a `position`: the way of a point
/// dragged behind them on a string of length `slack`. A hand that trembles within `slack` does not
/// advance. 0: the lengths of the straight lines between the samples.
template <class Sample>
std::vector<double> travelled(std::span<const Sample> samples, double slack = 0) {
    std::vector<double> along(samples.size(), 0);
    if (samples.empty()) return along;
    auto end = samples[0].position;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const auto next = drag_string(end, samples[i - 1].position, samples[i].position, slack);
        along[i] = along[i - 1] + glm::length(next - end);
        end = next;
    }
    return along;
}

}  // namespace tuft::stroke
