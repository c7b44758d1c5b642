#pragma once

#include <functional>
#include <vector>

#include "core/system/progress.h"
#include "decal/panels/film_mesh.h"
#include "decal/panels/lay_flat.h"

/// \file
/// Cutting of the film into panels that lie flat within the strain limit. Called by sheet.h.
namespace tuft::decal {

/// Limits of panels.
struct PanelOptions {
    double max_strain = 0.03;  ///< of the film: 0.03 water-slide decal, 0.15 wrap film
    /// Returns whether a panel, laid flat (metres), fits a page; empty: any does.
    std::function<bool(const atlas::ChartMesh& chart, const std::vector<Vec2>& flat)> fits;
    ProgressFn progress;
};

/// A panel: a disk of the film and where it lies on the sheet.
struct Panel {
    atlas::ChartMesh chart;             ///< metres; `chart.triangles` are of the film mesh
    std::vector<Vec2> flat;             ///< [n_vertices of the chart], metres
    double strain = 0;                  ///< largest of its triangles
    std::vector<std::uint8_t> is_seam;  ///< [3 n_triangles of the chart] the half-edge is cut from another panel
};

/// Cuts `film` into panels that are as large as the limits allow.
///
/// 1. A connected part is cut in two by a plane where it is no disk, strains the film by more than the limit, or fits
///    no page. Of 24 directions through its two longer axes and 7 positions in its middle third the plane with the
///    least visible cut is taken, ∫ (0.15 + coverage) ds. So cuts run between motifs where they can. Where the angles
///    at a vertex miss 2π by more than 0.3, the plane goes through the sharpest such vertex.
/// 2. Neighbours are joined again along one connected seam, the most visible one first, where the whole still lies flat
///    within the limits. In the end no two panels can be joined.
/// 3. Each is laid out at the size nearest to the true one that meets the limits (lay_flat.h).
///
/// Panels are in the order of their centres' azimuth about the middle of the film, from −y counter-clockwise, then from
/// above. Throws `Error` where a part cannot be laid flat at all. The same bits for any number of threads.
std::vector<Panel> cut_into_panels(FilmMesh& film, const CoverageFn& coverage, const PanelOptions& options);

}  // namespace tuft::decal
