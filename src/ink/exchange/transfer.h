#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ink/exchange/contact_nodes.h"
#include "ink/exchange/deposit.h"

/// Ink both ways between a wet tuft and a wet surface.
namespace tuft::ink {

/// The liquid on the outside of the hair where it touches: what the surface really meets, by nodes
/// of the contact patch. It picks up and gives again within a few millimetres, which smears, while
/// the hair behind it hardly changes. Between the nodes it is interpolated: what lies over an area
/// at node n is Σ_n w_n content_n / area_n.
struct SurfaceLiquid {
    NodeContents content{};

    double volume(int node) const;
};

/// Before a touch: what is on the liquid changes places with what is in the cells behind it with a
/// time constant of 0.3 s, and each node is filled up to a film of 40 µm over its area; less by
/// min(1, 2 s)² where the hair's saturation s is below a half, since what there is then hides between
/// the hairs. What leaves the surface at one node fills those in line with it that lack some, and only
/// then goes into the hair; hair that is not half full gives no more than it holds there, until `flow`
/// brings more. What liquid and tuft hold together stays the same.
/// `pour`: film units more, that run off a dripping tuft in this touch.
void refresh(SurfaceLiquid& liquid, Reservoir& tuft, const ContactCells& touch, const NodeContact& nodes,
             const NodeAreas& areas, double dt, double pour = 0);
/// After a stroke: all of it goes back into the hair.
void withdraw(SurfaceLiquid& liquid, Reservoir& tuft, const ContactCells& touch, const NodeContact& nodes);

struct TransferParams {
    DepositParams deposit;                 ///< target, transfer_length, capacity, extinction; not its mix
    std::array<float, kNodes> exchange{};  ///< part of the liquid that a touch renews at each node: 1 − exp(−...)
    std::array<float, kFirmnessSamples>
        rub{};         ///< how firmly the bundles rub across the patch, over the mean: `rub_of`
    float uptake = 0;  ///< 0–1: how much of what stands above the target is drawn up
    float room = 0;    ///< film units that the hair can take beyond what it gives
    float pour = 0;    ///< film units that run off the tuft, however thick the film is already
    /// Film units that the liquid can give in this touch at each node, by plane, water last.
    std::array<std::array<float, kNodes>, Reservoir::kPlanes> film{};
};

/// How firmly the rows of nodes along the patch lie on the surface, over the firmest: hair presses by how much of it
/// is above, which is as wide as the patch is there.
std::array<double, kAlong> firmness(const NodeAreas& areas);

/// From liquid and tuft, for a touch over `ds` metres and `dt` seconds pressed by `stress` (0–1):
/// exchange = 1 − exp(−(ds / 4 mm + dt / 0.5 s) (0.3 + 0.7 stress) p), where p is how firmly a node lies on:
/// as wide as the patch is there over its widest place. The tip only grazes what the belly has left, however long it
/// trails: else the middle of a stroke, where it passes, would be rubbed clean along a line.
TransferParams transfer_params(const SurfaceLiquid& liquid, const Reservoir& tuft, const ContactCells& touch,
                               const NodeAreas& areas, const DepositParams& deposit, double ds, double dt,
                               double stress);

/// One touch on one tile. With f the coverage, w the liquid on the surface, q what the liquid over
/// the texel can give, c the target and g(f) as in `deposit`:
///
///     n = min(⟨g(f) − w⟩ (1 − exp(−ds/s0)) + f pour, q)   laid down until the film is as thick as it
///                                                   shall be, and what drips
///     x = f R min(w, q − n)                         renewed: as much up as down, R by the nodes and the rub
///     l = min(f R ⟨w − c⟩ uptake, room)             drawn up by hair that is not full
///     down = (n + x) of the liquid's mixture there,  up = (x + l) of the surface's
///
/// (Van Laerhoven: down R_d q_b, up R_u q_c, each within the receiver's free capacity; the rates
/// are exponentials of way and time, so that sampling does not matter.) Liquid that is lifted
/// carries the open film's pigments in their share of it, at most undiluted. Dry films stay.
/// Adds to `given`, film·m², what each node gave less what it took: in the sum over the nodes it is
/// what was stored, plane by plane, and no node gives more than it has. Different slots may be done
/// by different threads; same bits on every instruction set.
void transfer(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> coverage,
              const TexelPlaces& places, const HatBasis& hats, std::span<const float, atlas::kTileTexels> area,
              double ds, const TransferParams& params, NodeContents& given);

}  // namespace tuft::ink
