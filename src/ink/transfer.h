#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ink/deposit.h"
#include "ink/reservoir.h"

/// Ink both ways between a wet tuft and a wet surface.
namespace tuft::ink {

inline constexpr int kLanes = 8;  ///< strips along the motion into which the touching hair is divided
using LaneContents = std::array<Reservoir::Content, kLanes>;  ///< film·m² by plane, water last
using LaneAreas = std::array<double, kLanes>;                 ///< m² of surface under each strip

/// The liquid on the outside of the hair where it touches: what the surface really meets. It
/// picks up and gives again within a few millimetres, which smears, while the hair behind it
/// hardly changes.
struct Skin {
    LaneContents content{};

    double volume(int lane) const;
};

/// Before a touch: what is on the skin changes places with what is in the touching cells with a
/// time constant of 0.3 s, and each lane is filled up to a film of 40 µm over its area (less
/// where the hair is not half full). What skin and tuft hold together stays the same.
void refresh(Skin& skin, Reservoir& tuft, const Touch& touch, const LaneAreas& areas, double dt);
/// After a stroke: all of it goes back into the hair.
void withdraw(Skin& skin, Reservoir& tuft, const Touch& touch);

struct TransferParams {
    DepositParams deposit;        ///< target, transfer_length, capacity, extinction; not its mix
    float exchange = 0;           ///< part of the liquid that a touch renews: 1 − exp(−...)
    float thirst = 0;             ///< 0–1: how much of what stands above the target is drawn up
    std::array<Mix, kLanes> mix{};       ///< on the skin, per film unit of its liquid
    std::array<float, kLanes> film{};    ///< film units that it can give in this touch
    std::array<float, kLanes> room{};    ///< film units that it can take beyond what it gives
};

/// From skin and tuft, for a touch over `ds` metres and `dt` seconds pressed by `stress` (0–1):
/// exchange = 1 − exp(−(ds / 4 mm + dt / 0.5 s) (0.3 + 0.7 stress)).
TransferParams transfer_params(const Skin& skin, const Reservoir& tuft, const Touch& touch,
                               const LaneAreas& areas, const DepositParams& deposit, double ds,
                               double dt, double stress);

/// One touch on one tile. With f the coverage, w the liquid on the surface, q what the lane can
/// give, c the target and g(f) as in `deposit`:
///
///     n = min(⟨g(f) − w⟩ (1 − exp(−ds/s0)), q)      laid down until the film is as thick as it shall be
///     x = f R min(w, q − n)                         renewed: as much up as down
///     l = min(f R ⟨w − c⟩ thirst, room)             drawn up by hair that is not full
///     down = (n + x) of the skin's mixture,  up = (x + l) of the surface's
///
/// (Van Laerhoven: down R_d q_b, up R_u q_c, each within the receiver's free capacity; the rates
/// are exponentials of way and time, so that sampling does not matter.) Liquid that is lifted
/// carries the open film's pigments in their share of it, at most undiluted. Dry films stay.
/// `lanes` [256]: strip of each texel. Adds what was given less what was taken, as stored, to
/// `given`. Different slots may be done by different threads; same bits on every instruction set.
void transfer(Canvas& canvas, std::uint32_t slot,
              std::span<const float, atlas::kTileTexels> coverage,
              std::span<const std::uint8_t, atlas::kTileTexels> lanes,
              std::span<const float, atlas::kTileTexels> area, double ds,
              const TransferParams& params, LaneContents& given);

}  // namespace tuft::ink
