#pragma once

#include <functional>
#include <span>

#include "ink/film/film.h"

/// \file
/// Beads of liquid that run down a steep surface. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// Simulates the beads. A bead is a spherical cap of radius R and contact angle θ = `bead_angle`, volume π θ R³ /
/// 4. Contact lines hold it while its weight along the slope is below σ 2R (cos θ_r − cos θ_a) ≈ σ R θ²
/// [Furmidge1962], that is for
///
///     R < R_c = 2 l √(θ / (π sin α)),   l² = σ / ρ g
///
/// times the roughness of the place (`grain`). Moving contact lines hold less ([Gao2018]: on every surface
/// they tried). Here the factor is 0.65, a choice: a running bead stops at R < R_k = √0.65
/// R_c. Its speed is bead_speed ((R / R_k)² − 1), at most 1.5 bead_speed ([LeGrand2005]: linear in
/// the weight beyond the critical one).
///
/// A running bead takes up liquid above `retained` on its path, with its pigments, and draws in liquid above `retained`
/// within 2 R. It leaves a trail of half-width √(R R_k), with a rounded profile, where it passed over less. It
/// stops when the trail has used it up. It then lies at half its angle, extended up its trail, and dries as a soft
/// bulb that fades into the trail. A film starts a bead where 1.3 times what the surface holds lies above `retained`
/// within 2 R.
///
/// No state is stored between steps: the texels tell where beads are and which of them run, namely those as high as
/// caps with liquid behind them. Liquid on dry surface is held by its whole contact line. Discs are measured in
/// space along connected texels, over seams too, so neither shape nor path depends on the texels' directions.
class Drips {
  public:
    using BeforeFn = WetFilm::BeforeFn;

    /// All arguments must outlive the object. Beads stop at texels that are not `free`.
    Drips(const atlas::TexelMap& map, const atlas::SeamLinks& seams, const WetFilm::FreeFn& free);

    /// Returns the film units on a steep wall below which nothing can run: a mean over a bead's disc.
    static double least(const FilmParams& params);

    /// Texels where liquid may be too heavy, in the order in which they are processed.
    struct Seed {
        atlas::TexelRef place;
        double grain = 1;  ///< of the place, over the mean
    };
    /// Advances the beads at the seeds by `seconds`. Returns the written slots, ascending.
    std::vector<std::uint32_t> run(Canvas& canvas, std::span<const Seed> seeds, const FilmParams& params,
                                   double seconds, const BeforeFn& before);

  private:
    struct Near {
        atlas::TexelRef ref;
        Vec3 at;
        double area = 0, distance = 0;
    };
    struct Bead;
    class Run;

    void collect_disc(const atlas::TexelRef& start, const Vec3& centre, double radius);
    bool is_separate(const atlas::TexelRef& a, const atlas::TexelRef& b) const;
    atlas::TexelRef beside(const atlas::TexelRef& ref, int column, int row) const;

    const atlas::TexelMap& map_;
    const atlas::SeamLinks& seams_;
    const WetFilm::FreeFn& free_;
    std::vector<std::uint32_t> seen_of_slot_;  ///< [n_slots] scratch
    std::vector<std::array<std::uint64_t, atlas::kTileTexels / 64>> seen_;
    std::vector<std::uint32_t> seen_slots_;
    std::vector<Near> disc_;    ///< of the last `collect_disc`
    std::vector<double> part_;  ///< of a bead for each of those
};

}  // namespace tuft::ink::wet
