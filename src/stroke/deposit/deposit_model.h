#pragma once

#include <functional>
#include <memory>

#include "core/system/progress.h"
#include "ink/exchange/erase.h"
#include "stroke/contact/hair_contact.h"
#include "stroke/deposit/film_clock.h"
#include "stroke/deposit/stamp_target.h"

/// \file
/// How ink gets from the tuft onto texels. One model is chosen per stroke: still ink, ink that differs over the tuft,
/// wet ink, paste, eraser. A new one is a class here with a source and a test of its own.
namespace tuft::stroke {

/// What a model sees of the contact at one stamp.
struct DepositContact {
    HairContact& hair;
    const MotionTracker& motion;
    double stress = 0;        ///< k in [0, 1], see `TuftInHand::stress`
    double normal_force = 0;  ///< N on the surface
    ink::Drain drain;         ///< of what hangs on the tuft
};

using SeamLinksFn = std::function<const atlas::SeamLinks&()>;

class DepositModel {
  public:
    virtual ~DepositModel() = default;

    /// Time between two poses, touching or not; `seconds` may be 0.
    virtual void pass_time(double /*seconds*/) {}
    /// Before a stamp is made: the tuft shall hold what it really holds.
    virtual void settle(TuftInHand& /*tuft*/, bool /*by_hair*/) {}
    /// Film·m² that the reservoir still holds but has given already.
    virtual double pending() const { return 0; }
    /// Stamps that share what is left in the tuft.
    virtual std::size_t stamps_per_batch() const { return 1; }
    /// Deposits a stamp whose ink parameters are set. Returns the ink given less what was taken, film·m², as far as it
    /// is known already; `finish` returns the rest.
    virtual double deposit(Stamp stamp, TuftInHand& tuft, const DepositContact& contact) = 0;
    /// The tuft is lifted for good. `seams` is only asked for where the surface itself is worked on.
    virtual double finish(TuftInHand& tuft, HairContact& hair, const SeamLinksFn& seams) = 0;
    /// What was erased.
    virtual ink::Amounts removed() const { return {}; }
};

struct DepositOptions {
    footprint::StampOptions stamp;
    WetFilmInUse wet;     ///< with a film, what is wet flows meanwhile
    ProgressFn progress;  ///< asked between tiles and steps of the film
};

std::unique_ptr<DepositModel> make_still_deposit(StampTarget& target, const DepositOptions& options);
std::unique_ptr<DepositModel> make_eraser(StampTarget& target, const DepositOptions& options);
std::unique_ptr<DepositModel> make_mixed_deposit(StampTarget& target, const DepositOptions& options);
std::unique_ptr<DepositModel> make_paste_deposit(StampTarget& target, const DepositOptions& options);
/// `mixed`: the tuft held several inks when the stroke began.
std::unique_ptr<DepositModel> make_wet_deposit(StampTarget& target, const DepositOptions& options, bool mixed);

}  // namespace tuft::stroke
