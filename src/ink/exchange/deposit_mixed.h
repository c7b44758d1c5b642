#pragma once

#include <span>

#include "ink/exchange/contact_nodes.h"
#include "ink/exchange/deposit.h"

/// Ink from a tuft that holds several, or that holds it thicker on one side.
namespace tuft::ink {

/// The mixtures over the nodes for a stamp over `area` m² that lays down films up to `target`:
/// those of `mixes_at`, with as much less of a pigment as it takes that the tuft can give it.
NodeMixes mixes_within(const Reservoir& tuft, const NodeContact& nodes, double target, double area);

/// As `deposit`, with a mixture that depends on the place under the tuft,
/// m_p(t) = Σ_n w_n(t) m_pn by the hats of the nodes. Each pigment tends to its own part of the film,
///
///     dw_p = max(0, m_p(t) g(f) − w_p) (1 − exp(−ds/s0)),
///
/// all of them less in proportion where W + Σ dw would exceed C. So a texel over which different
/// parts of the tuft pass takes of each pigment the most that any of them would leave, in whatever
/// steps, and a mixture that changes from stamp to stamp does not pile up. `params.mix` does not
/// count. Adds to `given`, film·m², what was stored and the water it brought.
void deposit_mixed(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> coverage,
                   const HatBasis& hats, std::span<const float, atlas::kTileTexels> area, double ds,
                   const DepositParams& params, const NodeMixes& mixes, NodeContents& given);

}  // namespace tuft::ink
