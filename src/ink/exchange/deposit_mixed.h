#pragma once

#include "ink/exchange/contact_nodes.h"
#include "ink/exchange/deposit.h"
#include "ink/exchange/stamped_tile.h"

/// \file
/// Deposit from a tuft whose ink varies over the contact patch. Called by `stroke` instead of `deposit`.
namespace tuft::ink {

/// Returns the mixtures over the nodes for a stamp over `area` m² with films up to `target`: those of `mixes_at`,
/// each pigment reduced to what the tuft can give.
NodeMixes mixes_within(const Reservoir& tuft, const NodeContact& nodes, double target, double area);

/// As `deposit`, with a mixture that varies over the patch, m_p(t) = Σ_n w_n(t) m_pn by the hats of the nodes. Each
/// pigment converges to its own fraction of the film,
///
///     dw_p = max(0, m_p(t) g(f) − w_p) (1 − exp(−ds/s0)),
///
/// all reduced in proportion where W + Σ dw would exceed C. A texel under several parts of the tuft takes the
/// largest amount of each pigment that any of them would leave, for any step size, and a mixture that changes from
/// stamp to stamp does not accumulate. `params.mix` is ignored. Adds the stored ink and its water to `given`,
/// film·m².
void deposit_mixed(Canvas& canvas, const StampedTile& tile, const HatBasis& hats, const DepositParams& params,
                   const NodeMixes& mixes, NodeContents& given);

}  // namespace tuft::ink
