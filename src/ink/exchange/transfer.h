#pragma once

#include <array>

#include "ink/exchange/contact_nodes.h"
#include "ink/exchange/deposit.h"
#include "ink/exchange/stamped_tile.h"

/// \file
/// Two-way ink exchange between a wet tuft and a wet surface. Called by `stroke` for every tile of every stamp.
namespace tuft::ink {

/// Liquid on the outside of the touching hair, by nodes of the contact patch. It exchanges with the surface within
/// a few millimetres, which smears, while the hair behind it hardly changes. Interpolated between the nodes: the
/// film over an area at node n is Σ_n w_n content_n / area_n.
struct SurfaceLiquid {
    NodeContents content{};  ///< film·m², by node and plane

    /// Returns the liquid at a node, film·m².
    double volume(int node) const;
};

/// Updates the surface liquid before a contact. Liquid and the cells behind it exchange with a time constant of 0.3
/// s. Each node is filled to a film of 40 µm over its area, reduced by min(1, 2 s)² where the hair's saturation s
/// is below a half, since the ink is then between the hairs. What leaves the surface at one node fills the nodes in
/// line with it first, then the hair. Hair below half saturation gives no more than it holds there, until `flow`
/// brings more. The total of liquid and tuft is conserved. `step.pour` is added.
void refresh(SurfaceLiquid& liquid, Reservoir& tuft, const ContactCells& contact, const NodeContact& nodes,
             const NodeAreas& areas, const ContactStep& step);
/// Returns all surface liquid to the hair, at the end of a stroke.
void withdraw(SurfaceLiquid& liquid, Reservoir& tuft, const ContactCells& contact, const NodeContact& nodes);

/// Parameters of one contact; `transfer_params` fills them.
struct TransferParams {
    DepositParams deposit;                 ///< target, transfer_length, capacity, extinction; not its mix
    std::array<float, kNodes> exchange{};  ///< fraction of the liquid that a contact renews at each node: 1 − exp(−...)
    /// Rubbing of the bundles across the patch, relative to the mean: `rub_of`.
    std::array<float, kFirmnessSamples> rub{};
    float uptake = 0;         ///< 0–1: uptake coefficient of liquid above the target
    float free_capacity = 0;  ///< film units of free capacity in the hair beyond what it gives
    float pour = 0;           ///< film units that run off the tuft, whatever the film's thickness
    /// Film units that the liquid can give in this contact at each node, by plane, water last.
    std::array<std::array<float, kNodes>, Reservoir::kPlanes> film{};
};

/// Returns the pressure of the rows of nodes along the patch, relative to the largest: proportional to the hair
/// above, which is as wide as the patch there.
std::array<double, kAlong> firmness(const NodeAreas& areas);

/// Returns the parameters of a contact: exchange = 1 − exp(−(ds / 4 mm + dt / 0.5 s) (0.3 + 0.7 stress) p). p is the
/// relative pressure of a node: the patch's width there over its largest width. The tip therefore only grazes what the
/// belly has left, however long it trails. Otherwise the middle of a stroke, where the tip passes, would be rubbed
/// clean along a line.
TransferParams transfer_params(const SurfaceLiquid& liquid, const Reservoir& tuft, const ContactCells& contact,
                               const NodeAreas& areas, const DepositParams& deposit, const ContactStep& step);

/// Exchanges the liquid of one contact on one tile. With f the coverage, w the liquid on the surface, q the liquid
/// available over the texel, c the target and g(f) as in `deposit`:
///
///     n = min(⟨g(f) − w⟩ (1 − exp(−ds/s0)) + f pour, q)   deposited up to the target film, and dripping
///     x = f R min(w, q − n)                         renewed, equal up and down; R by nodes and rub
///     l = min(f R ⟨w − c⟩ uptake, free_capacity)             absorbed by hair with free capacity
///     down = (n + x) of the liquid's mixture there,  up = (x + l) of the surface's
///
/// (Van Laerhoven: down R_d q_b, up R_u q_c, each within the receiver's free capacity; the rates are exponentials
/// of path and time, so sampling does not matter.) Lifted liquid carries the open film's pigments in proportion, at
/// most undiluted. Dry films do not change. Adds to `given`, film·m², what each node gave less what it took. Summed
/// over the nodes this is what was stored, plane by plane; no node gives more than it has. Different threads may
/// process different slots; same bits on every instruction set.
void transfer(Canvas& canvas, const ContactTile& tile, const TransferParams& params, NodeContents& given);

}  // namespace tuft::ink
