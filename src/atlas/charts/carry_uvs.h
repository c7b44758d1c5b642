#pragma once

#include <span>
#include <vector>

#include "atlas/charts/charts.h"

namespace tuft::atlas {

/// Triangles beyond which a chart that changes starts by `carry_uvs`: chains are long there, and
/// errors of other starts grow. Below, the other starts lead to 2 to 4 % fewer charts.
inline constexpr std::size_t kLargeChart = 20000;

/// Where a chart lies to begin with that took the triangles `taken` (ascending) over from `donor`:
/// its other triangles stay where they lie in `old`. Each connected part of those taken comes as
/// it lies in `donor`, moved rigidly to where it fits best along the border with the others; what
/// is still open there is shared out over it. `donor` may be `old` itself, where a part goes over
/// to the other side of a slit.
std::vector<Vec2> carry_uvs(const FlatChart& old, const FlatChart& donor, std::span<const std::uint32_t> taken,
                            const ChartMesh& chart);

/// The same for a small chart: the triangles that it shares with `old` stay, the others are
/// unfolded from those one by one, which follows a winding border better.
std::vector<Vec2> unfold_uvs(const FlatChart& old, const ChartMesh& chart);

/// Faces of a chart that are laid anew after it took the triangles `come` over (ascending): those and
/// five times as many around them. None where that is most of the chart, which is all of it.
std::vector<std::uint32_t> faces_around(const ChartMesh& chart, std::span<const std::uint32_t> come);

}  // namespace tuft::atlas
