#pragma once

#include <vector>

#include "writer/gesture/sides.h"

/// \file
/// Fair lines: a hand neither zigzags nor pumps within a stroke. Called by the fit.
namespace tuft::writer {

/// Returns the values x with x₀ and the last as they are that make Σ (x − v)² + stiffness · Σ (x₋₁ − 2 x + x₊₁)² least.
/// A wave of L values loses half its height where stiffness · (2π / L)⁴ = 1. Exact (pentadiagonal), O(values).
std::vector<double> faired(const std::vector<double>& values, double stiffness);

/// Makes centres and half widths fair, each with its stiffness.
void make_fair(std::vector<Station>& stations, double way, double half);

}  // namespace tuft::writer
