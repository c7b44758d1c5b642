#pragma once

#include <array>
#include <span>
#include <vector>

#include "stroke/journal/entry/flat_area.h"
#include "stroke/surface/even_lines.h"
#include "stroke/surface/model.h"

/// \file
/// Texels of a model in the flat coordinates of a drawing: the inverse of `map_to_surface`. Called by
/// painting/apply_area.h, which keeps one for all areas of a drawing.
namespace tuft::stroke {

/// A drawing's place.
struct FlatFrame {
    Placement placement;
    Vec2 low{0}, high{0};  ///< its bounds, metres
    AreaEdges edges = AreaEdges::facing;

    bool operator==(const FlatFrame&) const = default;
};

/// Flat coordinates of the texels that a drawing reaches.
///
/// The rectangle from `low` to `high` is mapped onto the surface (`map_to_surface`) at the nodes of a grid, at most 2
/// mm and at most 1/32 of it apart, at most 400 by 400 nodes. A texel takes the coordinates of the nearest point of the
/// grid, linear in each triangle. It is reached when that point lies within a grid step, on the same side of the
/// surface, and not past the surface's border. With `SurfaceMapping::drape` that grid lies on the smoothed surface, and
/// a texel takes the coordinates over which it lies along the grid's normal: a shut line bends no line that passes it.
/// With `SurfaceMapping::project` the coordinates are those of the texel's projection, and what is hidden is not
/// reached.
///
/// With `AreaEdges::cut` the nodes are connected from the one nearest to the placement's origin. Neighbours p, q with
/// normals n, m are connected where min(|(q − p)·n|, |(q − p)·m|) ≤ |q − p| / 2: a step is no neighbour, a fold is.
/// Nodes up to `kWidestGap` apart are connected over a gap where both products are below 0.15 |q − p| and n·m > 0.9.
/// Texels farther than a quarter of a grid step from the surface through connected nodes are not reached. With
/// `AreaEdges::run_over` texels that stand at right angles to the grid are reached, too.
///
/// The same bits for any number of threads. Cost: about 2 µs per texel.
class FlatTexels {
  public:
    struct Tile {
        std::uint32_t slot = 0;
        Vec2f low{0}, high{0};                     ///< bounds of `at`, metres
        std::array<Vec2f, atlas::kTileTexels> at;  ///< metres; NaN: not reached
    };

    /// `surface`: of the visible parts of the model.
    FlatTexels(const Model& model, const mesh::SurfaceQuery& surface, const FlatFrame& frame);

    /// Tiles with at least one texel that is reached, by ascending slot.
    std::span<const Tile> tiles() const { return tiles_; }
    const FlatFrame& frame() const { return frame_; }
    /// The grid of a draped drawing; without nodes for other mappings.
    const SurfaceLattice& lattice() const { return lattice_; }

  private:
    void project(const Model& model, const mesh::SurfaceQuery& surface);
    void unfold(const Model& model, const mesh::SurfaceQuery& surface);

    FlatFrame frame_;
    SurfaceLattice lattice_;
    std::vector<Tile> tiles_;
};

}  // namespace tuft::stroke
