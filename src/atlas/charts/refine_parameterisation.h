#pragma once

#include "atlas/charts/charts.h"

namespace tuft::atlas {

/// Lays finished charts flat from where they lie until they stretch no less; charts had been
/// tried in haste. Those that do not come out sound stay as they are.
void refine_parameterisation(CutMesh& cut, const ChartOptions& options, const ProgressFn& progress);

}  // namespace tuft::atlas
