#pragma once

#include <functional>
#include <memory>

#include "core/system/progress.h"
#include "ink/exchange/erase.h"
#include "stroke/contact/hair_contact.h"
#include "stroke/deposit/film_clock.h"
#include "stroke/deposit/stamp_target.h"

/// \file
/// How ink gets from the tuft onto texels. `StrokeSession` chooses one model per stroke: still ink, ink that varies
/// over the tuft, wet ink, paste, eraser. A new one is a class with a source and a test of its own, and a function
/// here.
namespace tuft::stroke {

/// The contact at one stamp.
struct DepositContact {
    HairContact& hair;
    const MotionTracker& motion;
    double stress = 0;        ///< k, `TuftInHand::stress`
    double normal_force = 0;  ///< on the surface, newtons
    ink::Drain drain;         ///< of ink that hangs on the tuft
};

/// Returns the links over the seams of the model; they may be made by the call.
using SeamLinksFn = std::function<const atlas::SeamLinks&()>;

/// A method of depositing ink, with the state of one stroke. Calls come from one thread: per pose `pass_time`; per
/// touching pose then `settle` and `deposit`; once `finish`.
class DepositModel {
  public:
    virtual ~DepositModel() = default;

    /// Lets time pass between two poses, touching or not; `seconds` ≥ 0.
    virtual void pass_time(double /*seconds*/) {}
    /// Withdraws pending ink from the tuft before the next stamp is made, where the model defers it.
    virtual void settle(TuftInHand& /*tuft*/, bool /*by_hair*/) {}
    /// Returns the pending ink, film·m²: given already, but still in the reservoir.
    virtual double pending() const { return 0; }
    /// Number of stamps that share what is left in the tuft.
    virtual std::size_t stamps_per_batch() const { return 1; }
    /// Deposits a stamp whose motion and ink are set. Returns the ink given minus the ink taken up, film·m², as far as
    /// known; `finish` returns the rest.
    virtual double deposit(Stamp stamp, TuftInHand& tuft, const DepositContact& contact) = 0;
    /// Ends the stroke; returns the rest of the ink given, film·m². `seams` is called at most once, by models that work
    /// on texels across seams.
    virtual double finish(TuftInHand& tuft, HairContact& hair, const SeamLinksFn& seams) = 0;
    /// Returns the ink erased, film·m².
    virtual ink::Amounts removed() const { return {}; }
};

/// Options of a deposit model.
struct DepositOptions {
    footprint::StampOptions stamp;
    WetFilmInUse wet;     ///< film that flows meanwhile
    ProgressFn progress;  ///< called between tiles and steps of the film; false stops by `Cancelled`
};

/// Return a model that deposits onto `target`, which must outlive it.
std::unique_ptr<DepositModel> make_still_deposit(StampTarget& target, const DepositOptions& options);
std::unique_ptr<DepositModel> make_eraser(StampTarget& target, const DepositOptions& options);
std::unique_ptr<DepositModel> make_mixed_deposit(StampTarget& target, const DepositOptions& options);
std::unique_ptr<DepositModel> make_paste_deposit(StampTarget& target, const DepositOptions& options);
/// `mixed`: the tuft holds several inks when the stroke begins.
std::unique_ptr<DepositModel> make_wet_deposit(StampTarget& target, const DepositOptions& options, bool mixed);

}  // namespace tuft::stroke
