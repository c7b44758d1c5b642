#pragma once

#include <array>
#include <span>
#include <vector>

#include "brush/papers/truss_dynamics.h"

/// \file
/// Skin of the truss model: a triangle mesh whose vertices are affine in the particles, refined by the Butterfly rule.
/// Called by truss_model.cpp.
///
/// Source: [Baxter2001], 3.4 [p]: control points anchored relative to the particles, triangular
/// base mesh, interpolating Butterfly subdivision. The weights of the rule are not printed; they are those of
/// [Dyn1990] [R]: a new vertex on edge ab with opposite vertices c, d and wings e1 … e4 is
///
///     ½ (a + b) + ⅛ (c + d) − 1/16 (e1 + e2 + e3 + e4),
///
/// on a boundary 9/16 (a + b) − 1/16 (e1 + e2). Where a wing is missing it is the parallelogram's fourth vertex [X].
/// All weights sum to 1, and the rule is linear, so every vertex of every level is affine in the particles with
/// constant weights.
namespace tuft::brush::truss {

/// Vertices as weights on the particles, and triangles, counter-clockwise from outside.
struct ButterflyMesh {
    int particles = 0;
    std::vector<double> weight;                 ///< [vertices × particles] by rows; each row sums to 1
    std::vector<std::array<int, 3>> triangles;  ///< vertex indices

    int vertices() const { return particles > 0 ? static_cast<int>(weight.size()) / particles : 0; }
    std::span<const double> row(int vertex) const {
        return std::span(weight).subspan(static_cast<std::size_t>(vertex) * particles, particles);
    }
};

/// A ring of the resting head at fraction u of its length from the root.
struct RingShape {
    double u = 0;
    double half_width = 0, half_thickness = 0;  ///< metres
};

inline constexpr int kRingPoints = 8;  ///< of the control mesh [X]

/// Returns the control mesh: `rings` of kRingPoints vertices each, root first. That of a round is closed by one vertex
/// at u = 1; the others are open at the toe, which is their last ring. A vertex at (x, y, u) is (1 − u) times its place
/// in the base plane and u times that at the points, interpolated in x between the trusses and extrapolated beyond; so
/// at rest it lies at (x, y, −u L(x)).
ButterflyMesh make_control_skin(const Truss& truss, std::span<const RingShape> rings);

/// Returns the skin with each triangle divided into four. Old vertices keep their index and place.
ButterflyMesh subdivide(const ButterflyMesh& skin);

/// Returns the place of a row of weights, metres.
Vec3 place(std::span<const double> weights, std::span<const Vec3> particles);

/// Cross-section of a skin as functions of the particles X.
struct SkinSection {
    double u = 0;                ///< height of its centre at rest over that of the last section, from the root
    std::vector<double> mean;    ///< [particles] weights of the centre
    std::vector<double> spread;  ///< [particles × particles] weights C of the variance along d, Σ C_ij (X_i·d)(X_j·d)

    Vec3 centre(std::span<const Vec3> particles) const { return place(mean, particles); }
    /// Returns √(2 variance) along d, |d| times metres: the semi-axis of an ellipse with evenly spaced points.
    double semi_axis(std::span<const Vec3> particles, const Vec3& d) const;
};

/// Returns a section for each ring of the control mesh refined `refinements` times, root first. The last of a round
/// is the closing vertex alone.
std::vector<SkinSection> skin_sections(const Truss& truss, std::span<const RingShape> rings, int refinements);

/// Returns the section at u between the sections beside it: linear in u.
SkinSection section_at(std::span<const SkinSection> sections, double u);

}  // namespace tuft::brush::truss
