#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ink/exchange/contact_nodes.h"
#include "ink/exchange/deposit.h"

/// Ink that stands as it was put: thick paint, and the furrows that the hair leaves in it.
namespace tuft::ink {

/// A bundle of hair as it ploughs through paste or rubs in liquid.
struct BundleFirmness {
    double at = 0;      ///< over the width, 0–1
    double weight = 1;  ///< how firmly it lies on the surface, over the firmest
};

struct FurrowOptions {
    double width = 8e-3;  ///< metres across the patch
    double film = 3e-4;   ///< metres of wet paste in the mean
    double yield = 400;   ///< Pa
    double depth = 0.6;   ///< 0–1: part of the paste that a firm bundle pushes aside
    double rim = 0.5;     ///< of the mean, what is pushed out to both sides stands there so much higher
};

/// The furrows of the bundles, and what is pushed out at both sides, as far as the paste can hold
/// them. Surface tension σ levels a wave of amplitude a and wavenumber k on a film h with the shear
/// stress σ k³ a h at its foot (Orchard 1962); a paste that yields at τ stops at
///
///     a ≤ τ / (σ k³ h),   σ = 30 mN/m,
///
/// in each mode of the cosine series over the width. Without yield stress the film is even. The
/// mean is 1 whatever the options say: nothing is made or lost by furrows. About 30 µs.
FurrowDepths furrow_depths(std::span<const BundleFirmness> bundles, const FurrowOptions& options);

/// How firmly the bundles rub across the patch, over the mean: 1 + 0.6 (n − 1), n what lies there of them over its
/// mean.
FurrowDepths rub_of(std::span<const BundleFirmness> bundles);

/// Film units of a paste that stay on a wall: τ / ρ g.
double standing_film(double yield);

/// Metres over which surface tension rounds what the hair leaves: 1 / k of the wave that a paste of
/// `film` metres holds only to a fiftieth of its height, k³ = 50 τ / (σ h²).
double levelling_length(double yield, double film);

struct PasteParams {
    double target = 40;             ///< c: film units in the mean of a full contact
    double transfer_length = 8e-5;  ///< s0, metres
    double capacity = 1000;         ///< film units that stay on a texel
    double dig = 0.3;               ///< 0–1: part of the paste found there that the hair ploughs away
    double exchange = 0;            ///< 0–1: part of the paste that this touch renews
    double room = 0;                ///< film units that the hair can take
    FurrowDepths furrows{};
};

/// One touch of one tile. With f the coverage, rounded towards the patch's edge, φ the furrows at the
/// texel's place across the patch, B the paste that lay there when the stroke began and W that now,
///
///     n = ⟨B + f c φ − W⟩ r,   l = min(f ⟨W − (1 − dig) B − c φ⟩ r, room),   r = 1 − exp(−ds / s0)
///     x = f R W                renewed: as much up as down
///     down = (n + x) of the tuft's mixture there,  up = (x + l) of the texel's
///
/// so the last hair that passes leaves its furrows, as far as it has room for what it ploughs out.
/// Film units of pigment; `mixes` with water, which leaves with the pigments and is gone. Only the
/// open film takes part. Adds film·m² to what each node `given` and what it has `taken`: their
/// difference is what was stored, plane by plane. Different slots may be done by different threads;
/// same bits on every instruction set.
void lay_paste(Canvas& canvas, std::uint32_t slot, std::span<const float, atlas::kTileTexels> coverage,
               const TexelPlaces& places, const HatBasis& hats, std::span<const float, atlas::kTileTexels> area,
               double ds, const PasteParams& params, const NodeMixes& mixes, const Plane& before, NodeContents& given,
               NodeContents& taken);

/// Pigment in the open film of a tile, film units: `before` of the above.
Plane open_pigment(const Canvas& canvas, std::uint32_t slot);

/// A tuft that goes over paste with thinner ink.
struct Rub {
    double pressure = 0;  ///< Pa, of the tuft on its patch in the mean
    double length = 0;    ///< metres of the patch that go over a place
    double yield = 400;   ///< Pa, of the paste; of heavy body colour where it is not known
};

/// Film units of paste that come loose under it. Hair lies on what yields at τ with so much of
/// itself that the weight rests on the pressure (2 + π) τ at which a flat punch sinks in (Prandtl
/// 1920), and of what it slides over a part K comes off (Archard 1953):
///
///     h = K p L / ((2 + π) τ),   K = 1e-3
///
/// (brass on steel 6e-4, mild steel on itself 7e-3: Archard and Hirst 1956; for hair on paint a
/// choice between them). A soft brush of 1.4 kPa so takes 5 to 11 µm along, however thick the paste
/// is.
double loosened(const Rub& rub);

/// What of a tile is paste: micrometres that its open film will stand dry, where that is more than
/// kPlain and no liquid has come to it; elsewhere 0.
Plane paste_height(const Canvas& canvas, std::uint32_t slot);

/// Liquid comes to the texels with `flooded` [256] > 0: of what was paste there (`height`, as
/// `paste_height` gave it before) it stirs no more than `loose` film units, which stay in the open
/// film; what stands below becomes the texel's next dry film, in the same composition, so that its
/// look and each pigment stay as they are. Whether there was any. Different slots may be done by
/// different threads.
bool bed_paste(Canvas& canvas, std::uint32_t slot, const Plane& height,
               std::span<const float, atlas::kTileTexels> flooded, double loose);

}  // namespace tuft::ink
