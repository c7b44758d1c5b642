#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "atlas/texels/seam_links.h"
#include "ink/film/tile/film_params.h"

/// \file
/// One tile of the wet film with a border of one texel, and its kernels. Internal to the wet film (film.h).
///
/// Field k = (row + 1) * 18 + 1 + column, row after row without gaps; kernels run over it from end to end. Faces:
/// between k and k + 1, k and k + 18, and the diagonals of the square k, k + 1, k + 18, k + 19.
namespace tuft::ink::wet {

inline constexpr int kTexels = atlas::kTileTexels;
inline constexpr int kSide = atlas::kTile;
inline constexpr int kRow = kSide + 2;
inline constexpr int kBlock = 4, kBlocks = kSide / kBlock;  ///< texels, blocks along a side
inline constexpr int kSquares = 20 * kSide;                 ///< 17 rows of them, in whole sixteens
inline constexpr int kField = 22 * kSide;                   ///< and the ends of those squares' diagonals
static_assert(kSquares > (kSide + 1) * kRow - 2 && kField >= kSquares + kRow + 1);

/// A number for each texel of a tile and of its border.
struct alignas(64) Field : std::array<float, kField> {};

/// Unit of 16-bit conductances: half the memory, and memory bounds the speed of a step. 1 is exact.
inline constexpr float kConductanceUnit = 0x1p-14f, kDiagonalUnit = 0x1p-13f;

/// Unit of the 16-bit areas of `Geometry::flow_area`.
inline constexpr float kFlowAreaUnit = 0x1p-14f;

inline constexpr double kGrainLength = 1.2e-3;  ///< metres over which the pin of a place varies

inline constexpr int field_at(int column, int row) {
    return (row + 1) * kRow + 1 + column;
}
inline constexpr int field_of(int texel) {
    return field_at(texel % kSide, texel / kSide);
}

/// Metric of a tile; constant after it is made.
struct alignas(64) Geometry {
    static void* operator new(std::size_t bytes);  ///< as planes (plane_pool.cpp)
    static void operator delete(void* geometry, std::size_t bytes);

    /// Length over distance of faces, at most 4 times the smaller area, over kConductanceUnit: of texels'
    /// right sides, rows of columns -1 to 16, 0 at 16; and of the sides below rows 0 to 16.
    std::array<std::uint16_t, kSide * kRow> gx{};
    std::array<std::uint16_t, kTexels + kSide> gy{};
    std::array<float, kTexels> inverse{};          ///< mean texel's area over the texel's; 0 outside the charts
    std::array<std::uint32_t, kSide + 2> valid{};  ///< bit column + 1: a texel of a chart
    float stiffness = 0;                           ///< greatest Σ conductances over area
    /// Of diagonals of the squares above and right of texels k of columns and rows -1 to 15, over kDiagonalUnit: > 0
    /// from that texel, < 0 (its size) from the one to its right; null: none.
    struct alignas(64) Diagonals : std::array<std::int16_t, kSquares> {
        static void* operator new(std::size_t bytes);
        static void operator delete(void* diagonals, std::size_t bytes);
    };
    std::unique_ptr<Diagonals> gd;
    bool ups = false, downs = false;  ///< whether there are any > 0, < 0
    Field grain{};                    ///< pin of the place, over the mean
    /// Of texels and those round them, over kFlowAreaUnit: area over the mean, less beside seams, where links take
    /// their part.
    std::array<std::uint16_t, kField> flow_area{};
    std::uint16_t blocks = 0;  ///< bits: blocks of 4 × 4 texels, row by row, of one cluster, away from seams

    static constexpr int right_of(int column, int row) { return field_at(column, row) - kRow; }
    static constexpr int corner_of(int column, int row) { return field_at(column, row); }
};
/// Surface that the liquid flows over.
struct FlowMedium {
    double unevenness = 0;  ///< rms of the logarithm of the mobility, see `EaseOfFlow`
    double fibrous = 0;     ///< 0–1: part of its square that fibres have, clouds the rest
    FreeTexelsFn free;      ///< fraction of a texel that the stencils leave free; empty: all
};
/// Returns the fraction of the flow that passes between two texels of the given free fractions; 0 over a stencil
/// edge.
double passing(std::uint8_t free_a, std::uint8_t free_b);
Geometry make_geometry(const atlas::TexelMap& map, const atlas::SeamLinks& seams, std::uint32_t slot,
                       const FlowMedium& medium);

/// A tile's faces in two parts.
struct SplitGeometry {
    Geometry inside, outside;
    static void* operator new(std::size_t bytes) { return Geometry::operator new(bytes); }
    static void operator delete(void* split, std::size_t bytes) { Geometry::operator delete(split, bytes); }
};
/// Splits the faces of a tile: `inside` has those between two texels of a zone of tiles, `outside` all others, and of
/// the former only the flag that slopes may be taken over them. `in_zone`: of the tile and the eight round it, row by
/// row.
std::unique_ptr<SplitGeometry> split(const Geometry& g, const std::array<bool, 9>& in_zone);

/// Limits of the flow in one step, so that no amount gets negative.
struct FlowLimits {
    float flow = 0;          ///< of flow × thickness
    float most = 0;          ///< of flow × thickness × conductance over the module at the face; 0: `flow` holds
    float most_of_link = 0;  ///< the same for links
};

/// What dries in one step.
struct StepDrying {
    float evaporation = 0;  ///< film units
    float rim = 0;          ///< film units more, per film unit of slope
    float rim_depth = 0;    ///< film units: rims are thinner than this
};

/// FilmParams for one step, in texels: rates times the step's length.
struct Step {
    float flow = 0;       ///< D dt / A per film unit
    float levelling = 0;  ///< L dt / A per film unit above `retained`
    FlowLimits limit;
    float threshold = 0, pin = 0;
    float mixing = 0;  ///< D_p dt / A
    float grip = 0;
    float pores = 0;
    float passing = 1;  ///< part of the liquid in the pores in which pigments mix
    StepDrying drying;
    float retained = 0;
    float relief = 0;       ///< L dt / A, on relief
    float ridge = 0;        ///< film units that stay on relief
    bool searches = false;  ///< for ripples
};

/// The faces that a step goes over: all; or those among tiles beside seams, and all others.
enum class Part : std::uint8_t { whole, inside, outside };

/// One step over some faces. `number` seeds its rounding.
struct FaceStep {
    Part faces = Part::whole;
    const Step& rates;
    std::uint64_t number = 0;
};

/// Through faces, the carriers of pigments: flux = a p(one end) + b p(other end).
struct alignas(64) Faces {
    Field a, b;
};

/// The fields of a tile in work: as few as can be, so that they stay in the first cache.
struct alignas(64) Work {
    Field w{}, s{}, total{};  ///< liquid
    Field z{};                ///< relief, film units; counts where `on_relief`
    bool on_relief = false;
    Field rate{};                                        ///< 1 / total, where that is thin 1 / grip, 0 where it is dry
    Field above{}, free{};                               ///< liquid above threshold, above `retained`
    Field carrying{};                                    ///< liquid in which pigments move, M
    Field p{};                                           ///< one pigment
    Faces x, y, up, down;                                ///< up: of diagonals k to k + 19, down: k + 1 to k + 18
    Field through{};                                     ///< scratch: what goes through faces of one kind
    alignas(64) std::array<float, kTexels> dw, ds{};     ///< film units · mean area that come through faces and seams
    alignas(64) std::array<float, kTexels> rim_slope{};  ///< of liquid no higher than `rim_depth`, a texel
    bool sloping = false;                                ///< `rim_slope` is not 0
    alignas(64) std::array<float, kTexels> dp{};         ///< what seams bring of one pigment; 0 between steps
};

/// A plane with a border of one texel from the tiles around, row by row: [256] each, none null.
void gather_field(Field& field, const std::array<const float*, 9>& planes);
/// Computes what follows from w and s, the fluxes through the faces, and dw and ds from them. Returns whether some
/// texel has less liquid than `rim_depth`.
bool fluxes(Work& work, const Geometry& g, const Step& step);
/// Sets the slope [256] of the liquid over rims, of what of `total` is no higher than `depth`, per texel.
void rim_slopes(float* slope, const Field& total, const Geometry& g, float depth);

/// Liquid on the tiles to the left, to the right, below and above [256], null: none; and in which of this and
/// their blocks it may flow from block to block.
struct TileNeighbours {
    std::array<const float*, 4> liquid{};
    std::array<std::uint16_t, 4> blocks{};
    std::uint16_t here = 0;
};
/// Where `most` holds flows back inside wide wet places: the rest of what flows on the surface, between blocks of 4 × 4
/// texels, which is stable for steps 16 times as long. Adds to dw and to what carries pigments.
void film_block_flow(Work& work, const Geometry& g, const TileNeighbours& beside, const Step& step);

/// What a texel's liquid became.
struct Outcome {
    float most_w = 0, most_s = 0;
    bool closing = false;    ///< some texel had liquid and has none
    double evaporated = 0;   ///< film · mean area
    std::uint8_t sides = 0;  ///< wet texels in the first, last row, first, last column: bits 0–3
};
/// Numbers from −½ to ½, over 2^23, for the 256 texels, another sequence for each seed. Sums are rounded
/// after adding so many units of their last place: small changes are kept on average, where
/// rounding to the nearest would favour, at each power of two, the side below it.
const float* dither(std::uint64_t seed);

/// Results of `local_step` for one tile. The memory must outlive the call.
struct LocalFilms {
    float* w;                                    ///< [256] film units on the surface
    float* s;                                    ///< [256] film units in the pores
    std::array<std::uint8_t, kTexels>& closing;  ///< [256] 1 where a wet texel became dry
    const float* drying = nullptr;               ///< [256] factor of what dries; null: 1
};

/// Adds dw and ds to the films of `work`, then evaporates. `seed` is that of the dither.
Outcome local_step(const LocalFilms& films, const Work& work, const Geometry& g, const Step& step, std::uint64_t seed);
/// The largest of [256], at least 0.
float greatest(const float* plane);
/// p [256] = work.p + what the faces bring, and dp if `seams`, over the area; never below 0.
void pigment_step(float* p, const Work& work, const Geometry& g, bool seams, std::uint64_t seed);

/// Sixteen pairs of texels that face each other over a seam, and what goes from the first to the second by the same
/// expressions: turned round, the same with another sign to the bit.
struct alignas(64) SeamLanes {
    using Lane = std::array<float, kSide>;
    Lane weight{};
    Lane apart{};      ///< their distance, texels. What comes from upstream smears as over a whole texel
    Lane flow_area{};  ///< as `Geometry`'s, for one of a texel's links
    std::array<Lane, 2> w{}, s{}, grain{}, z{};  ///< liquid, pin of the place, relief
    Lane through;                                ///< of what is on the surface
    Lane a, b;                                   ///< pigment: a p1 + b p2
};
void seam_fluxes(std::span<SeamLanes> lanes, const Step& step);

}  // namespace tuft::ink::wet
