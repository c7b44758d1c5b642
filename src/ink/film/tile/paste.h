#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ink/exchange/contact_nodes.h"
#include "ink/exchange/deposit.h"
#include "ink/exchange/stamped_tile.h"

/// \file
/// Thick paint that keeps its shape, and the furrows that hair leaves in it. Called by `stroke` for inks with a
/// yield stress.
namespace tuft::ink {

/// Pressure of a bundle in paste or liquid.
struct BundleFirmness {
    double at = 0;      ///< over the width, 0–1
    double weight = 1;  ///< pressure on the surface, relative to the largest
};

/// Shape of the furrows under a tuft.
struct FurrowOptions {
    double width = 8e-3;  ///< metres across the patch
    double film = 3e-4;   ///< metres of wet paste in the mean
    double yield = 400;   ///< Pa
    double depth = 0.6;   ///< 0–1: fraction of the paste that a firm bundle displaces
    double rim = 0.5;     ///< relative height of the ridges of displaced paste at both sides
};

/// Returns the furrow profile of the bundles, with the ridges at both sides, limited by the paste's yield stress.
/// Surface tension σ levels a wave of amplitude a and wavenumber k on a film h with the shear stress σ k³ a h at
/// its base [Orchard1962]. A paste that yields at τ stops at
///
///     a ≤ τ / (σ k³ h),   σ = 30 mN/m,
///
/// in each mode of the cosine series over the width. Without yield stress the film is even. The mean is 1 for all
/// options: furrows conserve the paste. Cost: about 30 µs.
FurrowDepths furrow_depths(std::span<const BundleFirmness> bundles, const FurrowOptions& options);

/// Returns the rubbing across the patch, relative to its mean: 1 + 0.6 (n − 1), with n the bundles' pressure there
/// relative to its mean.
FurrowDepths rub_of(std::span<const BundleFirmness> bundles);

/// Returns the film units of a paste that stay on a wall: τ / ρ g.
double standing_film(double yield);

/// Returns the length, metres, over which surface tension rounds the furrows: 1 / k of the wave of which a paste of
/// `film` metres holds only a fiftieth of the height, k³ = 50 τ / (σ h²).
double levelling_length(double yield, double film);

/// Parameters of one contact of paste.
struct PasteParams {
    double target = 40;             ///< c: film units in the mean of a full contact
    double transfer_length = 8e-5;  ///< s0, metres
    double capacity = 1000;         ///< film units that stay on a texel
    double dig = 0.3;               ///< 0–1: fraction of the paste there that the hair removes
    double exchange = 0;            ///< 0–1: fraction of the paste that this contact renews
    double free_capacity = 0;       ///< film units that the hair can take
    FurrowDepths furrows{};
};

/// Where `deposit_paste` adds the exchanged paste, film·m² by node. The references must outlive the call.
struct PasteExchange {
    NodeContents& given;  ///< by the tuft
    NodeContents& taken;  ///< by the tuft
};

/// Deposits paste by one contact on one tile. With f the coverage, rounded towards the patch's edge, φ the furrow
/// profile at the texel, B the paste at the start of the stroke and W the paste now,
///
///     n = ⟨B + f c φ − W⟩ r,   l = min(f ⟨W − (1 − dig) B − c φ⟩ r, free_capacity),   r = 1 − exp(−ds / s0)
///     x = f R W                renewed, equal up and down
///     down = (n + x) of the tuft's mixture there,  up = (x + l) of the texel's
///
/// The last hair that passes leaves its furrows, as far as its free capacity takes the removed paste. Amounts are film
/// units of pigment. `mixes` includes water, which leaves with the pigments and is lost. Only the open film takes
/// part. The difference of `exchange.given` and `exchange.taken` is what was stored, plane by plane.
/// Different threads may process different slots; same bits on every instruction set.
void deposit_paste(Canvas& canvas, const ContactTile& tile, const PasteParams& params, const NodeMixes& mixes,
                   const Plane& before, const PasteExchange& exchange);

/// Pigment in the open film of a tile, film units: `before` of the above.
Plane open_pigment(const Canvas& canvas, std::uint32_t slot);

/// Rubbing of a tuft with thinner ink over paste.
struct Rub {
    double pressure = 0;  ///< Pa, of the tuft on its patch in the mean
    double length = 0;    ///< metres of the patch that go over a place
    double yield = 400;   ///< Pa, of the paste; of heavy body colour where it is not known
};

/// Returns the film units of paste loosened by rubbing. Contact is plastic: its area carries the load at the
/// pressure (2 + π) τ at which a flat punch sinks in [Prandtl1920]. Of the sliding contact the fraction K wears
/// off [Archard1953]:
///
///     h = K p L / ((2 + π) τ),   K = 1e-3
///
/// (brass on steel 6e-4, mild steel on itself 7e-3: [Archard1956]; for hair on paint a choice between
/// them). A soft brush of 1.4 kPa removes 5 to 11 µm, for any thickness of paste.
double loosened(const Rub& rub);

/// Returns the paste of a tile, micrometres of the dry open film, where this exceeds kPlain and no liquid is
/// present; elsewhere 0.
Plane paste_height(const Canvas& canvas, std::uint32_t slot);

/// Beds the paste (`height`, from `paste_height` before the liquid came) of texels with `flooded` [256] > 0. At
/// most `loose` film units are stirred and remain in the open film. The paste below becomes the texel's next dry
/// film with the same composition, so appearance and amounts do not change. Returns true when there was any.
/// Different threads may process different slots.
bool bed_paste(Canvas& canvas, std::uint32_t slot, const Plane& height,
               std::span<const float, atlas::kTileTexels> flooded, double loose);

}  // namespace tuft::ink
