#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/geometry/types.h"
#include "ink/film/tile/film_tile.h"

/// \file
/// Unevenness of the ground that liquid flows through. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// Bundles of fibres in a sheet: bent lines of 1 to 2 mm, 0.15 mm wide. Where they lie and which way they run is a
/// function of the place in space alone, so neither the layout of the atlas nor its seams matter; near a surface they
/// are taken as they look along its normal. Not to be shared between threads: it keeps the fibres near the last places.
class Fibres {
  public:
    /// `texel_size`, metres: fibres are as wide as a texel shows them, and fainter by as much.
    explicit Fibres(double texel_size);

    /// Returns a noise of mean 0 and rms 1 (of fine texels; less, where texels are wide), at least −1.5.
    double at(const Vec3& position, const Vec3& normal);

  private:
    struct Fibre {
        Vec3 middle, direction;
        double half, bend;
    };
    using Cell = std::array<std::int64_t, 3>;
    /// The fibres that reach into a cell of the lattice.
    struct Near {
        bool known = false;
        Cell cell{};
        std::vector<Fibre> fibres;
    };
    double width_, strength_;
    std::array<Near, 8> near_;  ///< of the last cells, by their parities

    const std::vector<Fibre>& near(const Vec3& position);
};

/// Relative ease with which liquid flows at places of a surface: exp(unevenness n), n noise of mean 0 and rms 1, −2 to
/// 1.2. n is of clouds, over 0.6 to 2.4 mm, and of fibres, which have the part `fibrous` of its square. On a plane the
/// effective large-scale mobility is the geometric mean, 1 [Dykhne1971].
class EaseOfFlow {
  public:
    EaseOfFlow(const FlowMedium& medium, double texel_size);

    /// Returns its root, which each end of a face contributes.
    double root_at(const Vec3& position, const Vec3& normal);

  private:
    double unevenness_, of_clouds_, of_fibres_;
    Fibres fibres_;
};

/// Smooth noise of the place, −1 to 1, over `length`, metres.
double place_noise(const Vec3& position, double length);

}  // namespace tuft::ink::wet
