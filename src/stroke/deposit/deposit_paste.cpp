#include <cmath>

#include "footprint/outline/shoulder.h"
#include "stroke/deposit/deposit_model.h"
#include "stroke/deposit/furrow_profile.h"
#include "stroke/deposit/stamp_exposure.h"

/// \file
/// Thick paint that stands as it is put: bundles leave furrows, paint is pushed out to the sides, and what lies there
/// is ploughed and mixed.
namespace tuft::stroke {
namespace {

constexpr double kShoulder = 1.5;     // length of the rounded edge over the film's thickness
constexpr double kMixLength = 25e-3;  // metres of travel in which hair and texel exchange their paste
// Under a gentle and, added to that, a firm press.
constexpr double kDepth[] = {0.35, 0.45};  // of the furrows
constexpr double kRim[] = {0.1, 0.5};      // pushed out at the sides
constexpr double kDig[] = {0.1, 0.35};     // of the paste that lies there

class PasteDeposit : public DepositModel {
  public:
    PasteDeposit(StampTarget& target, const DepositOptions& options)
        : exposure_(target, options.stamp), film_(target, options.wet, options.progress) {}

    void pass_time(double seconds) override {
        if (seconds > 0) film_.pass(seconds);
    }

    double deposit(Stamp stamp, TuftInHand& tuft, const DepositContact& contact) override {
        ink::Reservoir& reservoir = tuft.brush.reservoir;
        const HairContact& hair = contact.hair;
        const double patch = covered_area(stamp.footprint);
        footprint::round_edges(stamp.footprint, kShoulder * tuft.ink.film * ink::kFilmUnit);
        const ink::NodeAreas areas = exposure_.expose(stamp);
        double area = 0;
        for (const double a : areas) area += a;
        const ink::PasteParams params = paste_params(stamp, tuft, contact, area);
        const StampExposure::Exchanged exchanged = exposure_.plough(
            params, ink::mixes_within(reservoir, hair.nodes(), static_cast<double>(stamp.ink.target), patch), stamp.ds);
        ink::withdraw_contents(reservoir, exchanged.given, hair.nodes());
        ink::absorb(reservoir, exchanged.taken, hair.nodes(), hair.cells());
        double sum = 0;
        for (int node = 0; node < ink::kNodes; ++node)
            for (int p = 0; p < ink::Reservoir::kPlanes; ++p)
                sum += exchanged.given[node][p] - exchanged.taken[node][p];
        return sum;
    }

    double finish(TuftInHand& tuft, HairContact&, const SeamLinksFn& seams) override {
        exposure_.level(seams(), ink::levelling_length(tuft.ink.yield, tuft.ink.film * ink::kFilmUnit));
        film_.catch_up();
        return 0;
    }

  private:
    ink::PasteParams paste_params(const Stamp& stamp, const TuftInHand& tuft, const DepositContact& contact,
                                  double area) {
        const auto pressed = [&](const double(&of)[2]) { return of[0] + of[1] * contact.stress; };
        // Paste is pushed out beside the path, not before and behind.
        const double distance = glm::length(stamp.motion.shift);
        const double beside = distance > 0 ? std::abs(glm::dot(stamp.motion.shift, contact.hair.axis())) / distance : 1;
        const double target = static_cast<double>(stamp.ink.target);
        ink::PasteParams params{
            .target = target,
            .transfer_length = tuft.ink.transfer_length,
            .capacity = static_cast<double>(stamp.ink.capacity),
            .dig = pressed(kDig),
            .exchange = -std::expm1(-stamp.ds / kMixLength),
            .free_capacity = area > 0 ? ink::free_capacity(tuft.brush.reservoir, contact.hair.cells()) / area : 0};
        params.furrows = ink::furrow_depths(furrows_.advance(tuft, contact.hair, contact.motion.travel),
                                            {.width = stamp.grid.step.y * (ink::kAcross - 1),
                                             .film = target * ink::kFilmUnit,
                                             .yield = tuft.ink.yield,
                                             .depth = pressed(kDepth),
                                             .rim = pressed(kRim) * beside * beside});
        return params;
    }

    StampExposure exposure_;
    FilmClock film_;
    FurrowProfile furrows_;
};

}  // namespace

std::unique_ptr<DepositModel> make_paste_deposit(StampTarget& target, const DepositOptions& options) {
    return std::make_unique<PasteDeposit>(target, options);
}

}  // namespace tuft::stroke
