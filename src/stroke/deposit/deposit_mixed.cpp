#include "stroke/deposit/deposit_model.h"
#include "stroke/deposit/pool_on_relief.h"
#include "stroke/deposit/stamp_exposure.h"

/// \file
/// Still ink that differs over the tuft: every node of the contact patch deposits what its hair holds.
namespace tuft::stroke {
namespace {

class MixedDeposit : public DepositModel {
  public:
    MixedDeposit(StampTarget& target, const DepositOptions& options)
        : target_(target), exposure_(target, options.stamp) {}

    double deposit(Stamp stamp, TuftInHand& tuft, const DepositContact& contact) override {
        ink::Reservoir& reservoir = tuft.brush.reservoir;
        exposure_.expose(stamp);
        const ink::NodeMixes mixes = ink::mixes_within(
            reservoir, contact.hair.nodes(), static_cast<double>(stamp.ink.target), covered_area(stamp.footprint));
        const ink::NodeContents given = exposure_.deposit(stamp.ink, mixes, stamp.ds);
        ink::withdraw_contents(reservoir, given, contact.hair.nodes());
        double sum = 0;
        for (const ink::Reservoir::Content& node : given)
            for (const double v : node) sum += v;
        return sum;
    }
    double finish(TuftInHand& tuft, HairContact&, const SeamLinksFn& seams) override {
        pool_on_relief(target_, tuft.ink, seams);
        return 0;
    }

  private:
    StampTarget& target_;
    StampExposure exposure_;
};

}  // namespace

std::unique_ptr<DepositModel> make_mixed_deposit(StampTarget& target, const DepositOptions& options) {
    return std::make_unique<MixedDeposit>(target, options);
}

}  // namespace tuft::stroke
