#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ink/film/film_list.h"

/// \file
/// What still air takes up from wet places. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// Wet places of a surface, each over some millimetres.
struct VapourPatches {
    std::vector<float> x, y, z;     ///< [n] metres, middles
    std::vector<float> nx, ny, nz;  ///< [n] unit normals
    std::vector<float> area;        ///< [n] m²

    std::size_t size() const { return x.size(); }
};

/// Returns F [n], metres, ≥ 0: where air is saturated over the patches, each gives off D (c_s − c_∞) F to still air,
/// whose vapour spreads by diffusion, ∇² c = 0, and not through dry surface. Solves Σ K F = 1 with
///
///     K_ij = ((2 π r)⁴ + (16 R_i R_j)²)^(−¼) (1 − q ln(1 + 1/q)),   q = r⃗ · (n_i − n_j) / (2 r), within 0 and 1
///
/// where R is the radius of a disc of the patch's area and r⃗ = x_i − x_j. A disc alone has F = 4 R; the first factor is
/// that over a plane, with it as the mean over near patches, the second Neumann's function of a ball, on which vapour
/// has more room. By conjugate gradients. ΣF is within 4 % for discs of 1 to 40 mm, ellipses and whole balls. Cost:
/// about 15 n² products. The same bits on every machine.
std::vector<float> still_air_fluxes(const VapourPatches& patches);

/// Finds how fast texels dry in still air [HuLarson2002]: a spot of radius R gives off 4 R D (c_s − c_∞), so that by
/// area it dries as 1 / R, and what is wet near by slows it down.
///
/// The result is a factor of the rates of `FilmDrying`, smooth over some millimetres; the rates say how what a place
/// gives off is shared among its texels. Wet texels that lie within a cube of 1.5 mm or more in space and
/// face the same way are a patch. Cost: about that of a step of the film, and 1 ms at most for the patches.
class StillAir {
  public:
    static constexpr std::size_t kMostPatches = 400;
    static constexpr double kSeconds = 2;  ///< for which the factors hold, or `slower` times as long

    /// Begins with the parameters of an advance. All factors are 1 until `find`.
    void start(const FilmParams& params, const atlas::TexelMap& map);
    /// Whether rates depend on the air.
    bool is_used() const { return used_; }
    /// Finds the factors of the tiles in the list.
    void find(const TileList& tiles, std::span<const Sources> sources);
    /// Returns [256] factors of a slot over that of `slow_down`; the mean in tiles that were not in the list. Null: 1.
    const float* of(std::uint32_t slot) const;
    /// Multiplies what dries in a step by `times` and a factor that all texels have in common.
    void slow_down(Step& step, double times) const {
        step.drying.evaporation *= static_cast<float>(times * factor_);
        step.drying.rim *= static_cast<float>(times * factor_);
    }
    /// Returns how many times as long a step may be as by the rates alone: 1, 2 or 4.
    double slower() const { return greatest_ < 0.25 ? 4 : greatest_ < 0.5 ? 2 : 1; }

  private:
    struct Tile {
        Vec3f middle{0};
        float radius = 0;  ///< about `middle`
        double given = 0;  ///< film · m²/s, by the texels' factors
        float greatest = 0;
        bool wet = false;
        Plane areas{};  ///< m², of the texels that are wet; by the part of `kSeconds` for which thin ones stay so
    };

    FilmParams params_;
    bool used_ = false;
    double factor_ = 1, greatest_ = 1;  ///< the latter: of wet texels
    float cube_ = 0;                    ///< metres, of the patches
    VapourPatches patches_;
    std::vector<float> rates_, fluxes_;           ///< of the patches, film · m²/s
    std::vector<Tile> tiles_;                     ///< of the list
    std::vector<std::unique_ptr<Plane>> planes_;  ///< [n_slots] null: not found
    Plane otherwise_{};

    void look_at(const TileList& tiles, std::span<const Sources> sources, std::size_t index);
    bool gather(const TileList& tiles, float cube);
    void interpolate(const atlas::TexelMap& map, std::uint32_t slot, Tile& tile);
};

}  // namespace tuft::ink::wet
