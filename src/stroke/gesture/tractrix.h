#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// A point dragged on a string along a polyline, solved exactly, and path length that ignores tremor. Called where a
/// hand's samples are followed over path length; the result does not depend on how many samples the path has.
namespace tuft::stroke {

/// Returns the position of the free end of a string after its other end moved straight from `from` to `to` (metres, any
/// frame). The free end rests while the string is slack and follows a tractrix while it is taut: with φ the angle
/// between string and motion, and x the motion of the taut string,
///
///     tan(φ/2) = tan(φ0/2) e^(−x / length)
///
/// (Huygens 1692). |to − end| ≤ `length` afterwards. V: Vec2 or Vec3.
template <class V>
V drag_string(const V& end, const V& from, const V& to, double length) {
    const V motion = to - from, string = from - end;
    const double travel = glm::length(motion), reach = glm::length(to - end);
    if (reach <= length) return end;
    if (!(length > 0)) return to;
    if (!(travel > 0)) return to - (length / reach) * (to - end);
    const V ahead = motion / travel;
    // Where the string becomes taut: the hand leaves the circle round the end.
    const double along = glm::dot(string, ahead);
    const double left = along * along - glm::dot(string, string) + length * length;
    const double taut = std::clamp(std::sqrt(std::max(0.0, left)) - along, 0.0, travel);
    const V at = (string + taut * ahead) / length;
    const double cosine = std::clamp(glm::dot(at, ahead), -1.0, 1.0);
    const V across = at - cosine * ahead;
    const double sine = glm::length(across);
    if (sine < 1e-12) return to - length * ahead;
    const double half = sine / (1 + cosine) * std::exp(-(travel - taut) / length);  // tan(φ/2)
    const double scale = 1 / (1 + half * half);
    return to - length * scale * ((1 - half * half) * ahead + (2 * half / sine) * across);
}

/// Returns the path length from the first sample to each, metres: of the path of a point dragged behind the samples on
/// a string of length `slack`. Tremor within `slack` adds nothing. 0: the length of the polyline. [samples]
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
