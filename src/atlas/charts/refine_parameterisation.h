#pragma once

#include "atlas/charts/charts.h"

/// \file
/// Final parameterisation of the charts. Called by `unwrap`.
namespace tuft::atlas {

/// Minimises the stretch of finished charts from their current UVs until it no longer falls; trial flattenings stop
/// early. Charts with an unsound result are unchanged.
void refine_parameterisation(CutMesh& cut, const ChartOptions& options, const ProgressFn& progress);

}  // namespace tuft::atlas
