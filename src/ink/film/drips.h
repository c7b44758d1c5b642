#pragma once

#include <functional>
#include <span>

#include "ink/film/film.h"

/// Beads of liquid that run down a steep surface; inside `ink` only.
namespace tuft::ink::wet {

/// Liquid that a surface cannot hold gathers in a bead and runs down as a whole. A bead is a cap
/// of radius R and contact angle θ = `bead_angle`, volume π θ R³ / 4. Contact lines hold it where
/// its weight along the slope is less than σ 2R (cos θ_r − cos θ_a) ≈ σ R θ² (Furmidge 1962), that is for
///
///     R < R_c = 2 l √(θ / (π sin α)),   l² = σ / ρ g
///
/// times the roughness of the place (`grain`). Contact lines that move hold less (Gao et al. 2018, Nature Physics 14,
/// 191: on every surface they tried), here 0.65 of that, a choice, so that a bead once it runs is held where R < R_k =
/// √0.65 R_c. It moves with bead_speed ((R / R_k)² − 1) (Le Grand, Daerr, Limat 2005: linear in the weight beyond the
/// critical one), 1.5 bead_speed at most, takes up what lies thicker than `hold` on its way, with its pigments, draws
/// in what is above `hold` within 2 R, and leaves a trail of half width √(R R_k), rounded across, where it passed over
/// less. It stops when the trail has used it up, and lies then at half its angle, drawn out up its trail, so that it
/// dries as a soft bulb that fades into its trail. A film that is no bead yet starts one where 1.3 times what the
/// surface holds lies above `hold` within 2 R. Nothing is kept between steps: what lies on the texels says where beads
/// are, and which of them run: those that are as high as caps and hang on liquid behind. What stands on dry surface is
/// held by the line all round it.
///
/// Discs are measured in space along the texels that hang together, over seams too, so that
/// neither shape nor path depends on the texels' directions.
class Drips {
  public:
    using BeforeFn = WetFilm::BeforeFn;

    /// All must outlive it. Beads stop at what is not `free`.
    Drips(const atlas::TexelMap& map, const atlas::SeamLinks& seams, const WetFilm::FreeFn& free);

    /// Film units on a steep wall below which nothing can run: a mean over a bead's disc.
    static double least(const FilmParams& params);

    /// Texels where liquid may be too heavy, in the order in which they are looked at.
    struct Seed {
        atlas::TexelRef place;
        double grain = 1;  ///< of the place, over the mean
    };
    /// Lets beads at the seeds run for `seconds`. Returns the slots that were written, ascending.
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

    void gather(const atlas::TexelRef& start, const Vec3& centre, double radius);
    bool apart(const atlas::TexelRef& a, const atlas::TexelRef& b) const;
    atlas::TexelRef beside(const atlas::TexelRef& ref, int column, int row) const;

    const atlas::TexelMap& map_;
    const atlas::SeamLinks& seams_;
    const WetFilm::FreeFn& free_;
    std::vector<std::uint32_t> seen_of_slot_;  ///< [n_slots] scratch
    std::vector<std::array<std::uint64_t, atlas::kTileTexels / 64>> seen_;
    std::vector<std::uint32_t> seen_slots_;
    std::vector<Near> disc_;    ///< of the last `gather`
    std::vector<double> part_;  ///< of a bead for each of those
};

}  // namespace tuft::ink::wet
