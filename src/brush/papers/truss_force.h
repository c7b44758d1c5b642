#pragma once

/// \file
/// Force to the hand by the law of the truss model, apart from the springs: the paper decouples both. Called by
/// truss_model.cpp.
///
/// Source: [Baxter2001], 4.2 and 4.3. [p] is printed there, [X] is ours. d_p is the depth of
/// the undeformed point, l_p the length of the head along the surface normal, θ the angle between normal and head.
namespace tuft::brush::truss {

/// Force on the hand by depth.
struct ForceLaw {
    double bristles = 0.5;  ///< k1, N, when the handle first hits the surface
    double handle = 20;     ///< k2, N, further force per head length beyond
};

/// Returns 0 up to d_p = 0, k1 d_p/l_p up to l_p, k1 + k2 (d_p − l_p)/l_p beyond (3) [p], newtons.
double linear_force(double depth, double length_along, const ForceLaw& law);

/// γ = cos² 2θ for |θ| < π/4, else 0 (4) [p].
double compressive_share(double tilt);

/// Returns the force with the compression of hair that meets the surface end-on, 4.3: a piecewise cubic Hermite curve
/// of four segments through tuples of depth, force and slope [p]; the second force falls by γ [p]. The numbers are [X]:
///
///     d/l_p           0        0.08           0.35   1     1.15
///     f/k1            0        0.08 + 0.35 γ  0.35   1     1 + 0.15 k2/k1
///     slope l_p/k1    1 + 5 γ  0              0.8    1.2   k2/k1
///
/// and beyond, the last slope. It agrees with (3) at 0, l_p and beyond 1.15 l_p.
double head_force(double depth, double length_along, double tilt, const ForceLaw& law);

}  // namespace tuft::brush::truss
