#include <cmath>
#include <numeric>

#include "stroke/deposit/deposit_model.h"
#include "stroke/deposit/furrow_profile.h"
#include "stroke/deposit/stamp_batch.h"
#include "stroke/deposit/stamp_exposure.h"

/// \file
/// Wet ink: the liquid on the touching hair is exchanged with what is wet on the surface, what the hair does not hold
/// runs down, and the film flows meanwhile.
namespace tuft::stroke {
namespace {

/// Of how much longer a contact foam takes up as much as hair: its pores fill through millimetres in a hundredth of a
/// second (h² = γ r t/2η with r 0.3 mm), hair needs half a second.
constexpr double kFoamSoaks = 20;
constexpr double kFoamRoom =
    0.02;  // of its capacity at rest: with so much room or more it draws in all that it reaches

/// Metres of the patch that pass over a place as it moves.
double length_along_motion(const Stamp& stamp) {
    const Vec2 size = stamp.grid.step * Vec2{ink::kAlong - 1, ink::kAcross - 1};
    const double distance = glm::length(stamp.motion.shift);
    const double along = distance > 0 ? std::abs(glm::dot(stamp.motion.shift, stamp.grid.axis)) / distance : 1;
    return along * size.x + std::sqrt(1 - std::min(along * along, 1.0)) * size.y;
}

class WetDeposit : public DepositModel {
  public:
    WetDeposit(StampTarget& target, const DepositOptions& options, bool mixed)
        : exposure_(target, options.stamp), film_(target, options.wet, options.progress), mixed_(mixed) {}

    void pass_time(double seconds) override {
        if (!(seconds > 0)) return;
        since_stamp_ += seconds;
        last_step_ = seconds;
        film_.pass(seconds);
    }

    std::size_t stamps_per_batch() const override { return mixed_ ? 1 : StampBatch::kStamps; }

    double deposit(Stamp stamp, TuftInHand& tuft, const DepositContact& contact) override {
        ink::Reservoir& reservoir = tuft.brush.reservoir;
        const ink::ContactCells& cells = contact.hair.cells();
        const Recycled<ink::BundleFirmness> bundles = furrows_.advance(tuft, contact.hair, contact.motion.travel);
        const ink::NodeAreas areas = exposure_.expose(stamp);
        const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
        const bool foam = brush::is_foam(tuft.preset());
        const double runs = foam ? ink::excess(reservoir) : ink::drained_volume(reservoir, contact.drain, last_step_);
        const double pour = area > 0 ? runs / area : 0;
        ink::ContactStep step{.ds = stamp.ds, .dt = since_stamp_, .stress = contact.stress, .pour = pour};
        if (foam) step.dt *= kFoamSoaks, step.stress = 1;
        ink::refresh(liquid_, reservoir, cells, contact.hair.nodes(), areas, step);
        ink::TransferParams params = ink::transfer_params(liquid_, reservoir, cells, areas, stamp.ink, step);
        if (foam) params.uptake = static_cast<float>(std::clamp(room_in(reservoir) / kFoamRoom, 0.0, 1.0));
        params.rub = ink::rub_of(bundles);
        params.pour = static_cast<float>(pour);
        since_stamp_ = 0;
        const double loose =
            area > 0 ? ink::loosened({.pressure = contact.normal_force / area, .length = length_along_motion(stamp)})
                     : 0;
        const ink::NodeContents given = exposure_.exchange(params, stamp.ds, loose);
        double sum = 0;
        for (int node = 0; node < ink::kNodes; ++node)
            for (int p = 0; p < ink::Reservoir::kPlanes; ++p) {
                liquid_.content[node][p] -= given[node][p];
                sum += given[node][p];
            }
        return sum;
    }

    double finish(TuftInHand& tuft, HairContact& hair, const SeamLinksFn&) override {
        film_.catch_up();
        ink::withdraw(liquid_, tuft.brush.reservoir, hair.cells(), hair.nodes());
        return 0;
    }

  private:
    /// Part of the capacity at rest that neither the hair's ink nor that on its outside fills.
    double room_in(const ink::Reservoir& reservoir) const {
        double held = reservoir.remaining();
        for (int node = 0; node < ink::kNodes; ++node) held += liquid_.volume(node);
        return (reservoir.capacity - held) / std::max(reservoir.rest_capacity, 1e-12);
    }

    StampExposure exposure_;
    FilmClock film_;
    bool mixed_;
    FurrowProfile furrows_;
    ink::SurfaceLiquid liquid_;  // on the hair where it touches
    double since_stamp_ = 0;     // seconds since the last stamp
    double last_step_ = 0;       // seconds since the last pose, touching or not
};

}  // namespace

std::unique_ptr<DepositModel> make_wet_deposit(StampTarget& target, const DepositOptions& options, bool mixed) {
    return std::make_unique<WetDeposit>(target, options, mixed);
}

}  // namespace tuft::stroke
