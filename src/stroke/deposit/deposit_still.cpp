#include <algorithm>

#include "stroke/deposit/deposit_model.h"
#include "stroke/deposit/pool_on_relief.h"
#include "stroke/deposit/stamp_batch.h"

/// \file
/// Ink of one kind that stays where it is put, in batches of stamps; and the eraser, which takes ink off likewise.
namespace tuft::stroke {
namespace {

/// What a batch has given leaves the reservoir: at once from closed hair; from hair that is half dry, which shows
/// every hundredth of its ink, evenly over the stamps of the next batch.
class StillDeposit : public DepositModel {
  public:
    StillDeposit(StampTarget& target, const DepositOptions& options)
        : target_(target), batch_(target, options.stamp), progress_(options.progress) {}

    void settle(TuftInHand& tuft, bool by_hair) override {
        if (by_hair) withdraw(tuft, per_stamp_);
    }
    double pending() const override { return pending_; }
    std::size_t stamps_per_batch() const override { return StampBatch::kStamps; }

    double deposit(Stamp stamp, TuftInHand& tuft, const DepositContact& contact) override {
        return batch_.add(std::move(stamp)) ? flush(tuft, contact.hair) : 0;
    }

    double finish(TuftInHand& tuft, HairContact& hair, const SeamLinksFn& seams) override {
        const double given = flush_all(tuft, hair);
        pool_on_relief(target_, tuft.ink, seams);
        return given;
    }

  protected:
    double flush_all(TuftInHand& tuft, HairContact& hair) {
        const double given = flush(tuft, hair);
        withdraw(tuft, pending_);
        return given;
    }

    StampTarget& target_;
    StampBatch batch_;

  private:
    double flush(TuftInHand& tuft, HairContact& hair) {
        const double given = batch_.flush(progress_);
        withdraw(tuft, pending_);
        pending_ = given;
        per_stamp_ = given / static_cast<double>(StampBatch::kStamps);
        pending_cells_ = hair.take_cells_since();
        if (!hair.by_hair()) withdraw(tuft, pending_);
        return given;
    }

    void withdraw(TuftInHand& tuft, double amount) {
        amount = std::min(amount, pending_);
        if (!(amount > 0)) return;
        ink::take(tuft.brush.reservoir, amount, pending_cells_);
        pending_ -= amount;
    }

    ProgressFn progress_;
    double pending_ = 0,
           per_stamp_ = 0;  // film·m² of the last batch that the reservoir still holds; that each stamp takes
    ink::ContactCells pending_cells_;  // that it came from
};

class Eraser : public StillDeposit {
  public:
    using StillDeposit::StillDeposit;

    double deposit(Stamp stamp, TuftInHand& tuft, const DepositContact& contact) override {
        stamp.erases = 2 + 2 * contact.stress;  // sooner than ink is given: tips rub off what tips left
        return StillDeposit::deposit(std::move(stamp), tuft, contact);
    }
    double finish(TuftInHand& tuft, HairContact& hair, const SeamLinksFn& seams) override {
        const double given = flush_all(tuft, hair);
        if (target_.canvas().wet()) batch_.blot(seams());
        return given;
    }
    ink::Amounts removed() const override { return batch_.erased(); }
};

}  // namespace

std::unique_ptr<DepositModel> make_still_deposit(StampTarget& target, const DepositOptions& options) {
    return std::make_unique<StillDeposit>(target, options);
}

std::unique_ptr<DepositModel> make_eraser(StampTarget& target, const DepositOptions& options) {
    return std::make_unique<Eraser>(target, options);
}

}  // namespace tuft::stroke
