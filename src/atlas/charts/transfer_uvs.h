#pragma once

#include <span>
#include <vector>

#include "atlas/charts/charts.h"

/// \file
/// Initial UVs of a chart that has changed. Called by merging and by seam moves.
namespace tuft::atlas {

/// Number of triangles above which a changed chart starts from `transfer_uvs`: in large charts the errors of other
/// starts grow along the long seams. Below it, the other starts lead to 2 to 4 % fewer charts.
inline constexpr std::size_t kLargeChart = 20000;

/// Returns initial UVs of a chart that took the triangles `taken` (ascending) from `donor`. Its other triangles
/// retain their UVs in `old`. Each connected part of `taken` retains its shape in `donor` and is moved rigidly to
/// the best fit along the border; the remaining gap is distributed over the part. `donor` may be `old`, where a
/// part moves to the other side of a slit.
std::vector<Vec2> transfer_uvs(const FlatChart& old, const FlatChart& donor, std::span<const std::uint32_t> taken,
                               const ChartMesh& chart);

/// The same for a small chart: triangles shared with `old` retain their UVs. The others are unfolded from those one
/// by one, which follows a winding border better.
std::vector<Vec2> unfold_uvs(const FlatChart& old, const ChartMesh& chart);

/// Returns the faces of a chart that are parameterised again after it took the triangles `come` (ascending): those
/// and five times as many round them. Empty, which means all, when that is most of the chart.
std::vector<std::uint32_t> faces_around(const ChartMesh& chart, std::span<const std::uint32_t> come);

/// Returns the number of these faces, or of all: of a chart of `n_faces` that took `n_come` triangles.
std::size_t count_faces_around(std::size_t n_faces, std::size_t n_come);

}  // namespace tuft::atlas
