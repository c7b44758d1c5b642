#include "stroke/painting/wet_hand.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tuft::stroke {
namespace {

constexpr double kTick = 0.05;  // seconds: a film moves by less than a texel meanwhile

/// Metres of the patch that go over a place as it moves.
double length_along_way(const Stamp& stamp) {
    const Vec2 size = stamp.grid.step * Vec2{ink::kAlong - 1, ink::kAcross - 1};
    const double way = glm::length(stamp.motion.shift);
    const double along =
        way > 0 ? std::abs(glm::dot(stamp.motion.shift, stamp.grid.axis)) / way : 1;
    return along * size.x + std::sqrt(1 - std::min(along * along, 1.0)) * size.y;
}

}  // namespace

void WetHand::advance(Stamper& stamper, const ProgressFn& progress) {
    film_->advance(*canvas_, pending_, params_, [&](std::uint32_t slot) { stamper.keep(slot); }, progress);
    pending_ = 0;
}

void WetHand::pass(Stamper& stamper, double seconds, const ProgressFn& progress) {
    if (!(seconds > 0)) return;
    pending_ += seconds;
    since_ += seconds;
    step_ = seconds;
    if (pending_ >= kTick) advance(stamper, progress);
}

double WetHand::lay(Stamper& stamper, const Stamp& stamp, ink::Reservoir& tuft,
                    const ink::Touch& touch, const ink::NodeTouch& nodes,
                    std::span<const ink::Tine> tines, const Press& press, const ink::Drain& drain) {
    const ink::NodeAreas areas = stamper.expose(stamp);
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    const double pour = area > 0 ? ink::shed(tuft, drain, step_) / area : 0;
    ink::refresh(skin_, tuft, touch, nodes, areas, since_, pour);
    ink::TransferParams params =
        ink::transfer_params(skin_, tuft, touch, areas, stamp.ink, stamp.ds, since_, press.stress);
    params.rub = ink::rub_of(tines);
    params.pour = static_cast<float>(pour);
    since_ = 0;
    const ink::NodeContents given = stamper.exchange(
        params, stamp.ds,
        area > 0
            ? ink::loosened({.pressure = press.force / area, .length = length_along_way(stamp)})
            : 0);
    double sum = 0;
    for (int node = 0; node < ink::kNodes; ++node)
        for (int p = 0; p < ink::Reservoir::kPlanes; ++p) {
            skin_.content[node][p] -= given[node][p];
            sum += given[node][p];
        }
    return sum;
}

void WetHand::end(Stamper& stamper, ink::Reservoir& tuft, const ink::Touch& touch, const ink::NodeTouch& nodes,
                  const ProgressFn& progress) {
    advance(stamper, progress);
    ink::withdraw(skin_, tuft, touch, nodes);
}

}  // namespace tuft::stroke
