#pragma once

#include <vector>

/// \file
/// Stiffness and yield profiles of the variable stiffness beam along ξ = x/L, root 0 to tip 1, and its closed-form
/// solutions. Units: length L and root stiffness B0 are 1; forces are in B0/L², moments in B0/L. Used by the rod
/// solver and by the tests of it.
namespace tuft::brush {

/// B(ξ) = e^{αξ} (1+βξ)³, from the modulus E0 e^{αξ} and the height h0 (1+βξ). M_e(ξ) = e · e^{γξ} (1+βξ)², from
/// the yield stress σ0 e^{γξ}.
struct Profile {
    double alpha = -1;
    double beta = -0.8;  ///< > -1
    double yield = 0;    ///< e = M_e0 L / B0; 0: purely elastic
    double gamma = -1;
    double floor = 0;  ///< added to B/B0: the hairs that reach the tip; M_e scales in proportion
};

double bending_stiffness(const Profile& p, double xi);  ///< B/B0
double yield_moment(const Profile& p, double xi);       ///< M_e L/B0; infinite when p.yield is 0

/// Returns the compliance ∫ ds/B from xi0 to xi1, by 8-point Gauss quadrature.
double compliance(const Profile& p, double xi0, double xi1);

/// Returns the lengths of n segments in arithmetic progression, root to tip, with sum 1. The tip segment is
/// `tip_ratio` / n, 0 < tip_ratio <= 1. Brush presets use 0.25 + 0.75 hardness.
std::vector<double> spine_segments(int n, double tip_ratio);

/// Linear deflection at one place of an end-loaded cantilever.
struct SmallDeflection {
    double w = 0;       ///< deflection, in P L³/B0
    double slope = 0;   ///< dw/dx, in P L²/B0
    double moment = 0;  ///< in P L
};

/// Returns the deflection of a cantilever with transverse tip load P by linear theory, B w'' = P (L − x), without
/// `floor`. Closed form by exponential integrals; Gauss quadrature where the closed form cancels (|β| < 0.05).
/// Valid for |w| < 0.1 L: beyond it overshoots, see rod.h. Source: [Huang2018],
/// integrated anew.
SmallDeflection small_deflection(const Profile& p, double xi);

/// Returns the smallest tip load that starts to yield, min over ξ of M_e(ξ)/(1−ξ), in B0/L².
double elastic_limit_load(const Profile& p);

/// Moment of an ideally plastic rectangular section along a path of curvature k = κ/κ_e: 0 → k1 → k2.
struct SectionMoment {
    double moment = 0;    ///< M/M_e at the end of the path
    double residual = 0;  ///< curvature left after elastic unloading from there
};
SectionMoment section_moment(double k1);
/// Masing's rule [Masing1926] for the reversal at k1.
SectionMoment section_moment(double k1, double k2);

/// Nodes and weights of n-point Gauss–Legendre quadrature on (0, 1).
struct Quadrature {
    std::vector<double> x, w;
};
Quadrature gauss_legendre(int n);

}  // namespace tuft::brush
