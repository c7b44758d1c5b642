#include "stroke/journal/entry/samples.h"

#include <cmath>
#include <string>

#include "core/error.h"
#include "core/geometry/bounds.h"

namespace tuft::stroke {
namespace {

constexpr double kLongestStroke = 1e8;     // seconds; clocks of devices that count from their start are kept
constexpr double kLongestDirection = 1e6;  // of a vector that shall be normalised; the least is its inverse
constexpr double kMostPressure = 10;       // of the working depth
constexpr double kMostTilt = 1.6;          // radians: a holder lies flat

}  // namespace

void check_samples(const StrokeSamples& stroke) {
    const auto refuse = [](const char* what) { throw Error(Message("{} is no number, or out of range", what)); };
    const auto is_direction = [](const Vec3& v) {
        return within(v, kLongestDirection) && glm::length(v) > 1 / kLongestDirection;
    };
    const Placement& p = stroke.placement;
    if (!within(p.origin)) refuse("the place of a drawing");
    if (stroke.flat && !(is_direction(p.right) && is_direction(p.down))) refuse("the direction of a drawing");
    for (const StrokeSample& s : stroke.samples) {
        if (!within(s.position)) refuse("a sample's place");
        if (!(std::abs(s.time) <= kLongestStroke)) refuse("a sample's time");
        if (!(std::abs(s.pressure) <= kMostPressure)) refuse("a sample's pressure");
        if (!within(s.tilt, kMostTilt)) refuse("a sample's tilt");
        if (!(std::abs(s.roll) <= kMostRoll)) refuse("a sample's roll");
        const double square = glm::dot(s.rotation, s.rotation);
        if (!(square > 1e-6 && square < 1e6)) refuse("a sample's rotation");
    }
    for (const StencilEdge& e : stroke.stencil)
        if (!within(e.from) || !within(e.to)) refuse("a stencil edge");
}

}  // namespace tuft::stroke
