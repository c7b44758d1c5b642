#pragma once

#include <span>
#include <vector>

#include "atlas/texels/cluster_graph.h"
#include "brush/preset/preset.h"
#include "brush/state/tuft_state.h"
#include "mesh/query/surface_query.h"
#include "stroke/deposit/stamp_target.h"

/// \file
/// Which tiles a stroke is likely to use, and when, from the path of its ferrule alone. `Document` paints strokes side
/// by side whose tiles differ, or are used at different times.

namespace tuft::stroke {

/// A ball in the model's frame, metres.
struct Ball {
    Vec3 centre{0};
    double radius = -1;  ///< < 0: nothing
};

/// A place that a stroke uses while the parts `first` to `last` of its path are painted.
struct ReachedPlace {
    Ball ball;
    std::uint32_t first = 0, last = 0;
};

/// Returns where each part of a path ends, as numbers of poses, ascending; the last is `poses.size()`. Every part has
/// at least four poses and `least` metres of path, or there is only one.
std::vector<std::size_t> parts_of_path(std::span<const brush::Pose> poses, double least);

/// Returns balls round the places that a tuft touches along a path: at the foot f of the ferrule's axis on the surface,
/// or at the surface point nearest to the ferrule where the axis meets none,
///
///     |x − f| ≤ 1.5 d + w/2 + 4 t,    d: depth of the unbent tip below f, w: width of the tuft, t: `texel`, metres.
///
/// Ink of a pose is deposited in its part or in the next; that of the last places, over which the tuft is lifted, until
/// the stroke ends. An estimate: of 200 strokes on the car, one used tiles outside.
std::vector<ReachedPlace> reached_places(const mesh::SurfaceQuery& query, std::span<const brush::Pose> poses,
                                         std::span<const std::size_t> parts, const brush::Preset& preset, double texel);

/// Balls round the texels of each cluster of the tiles of a model, four texels wider: a tile at the border of a chart
/// may hold texels of others, far away on the surface. Constant after it is built; reading is safe in several threads.
class TileReach {
  public:
    /// Looks at no texel, which may lie in a file as yet.
    TileReach(const atlas::TexelMap& map, const atlas::ClusterGraph& graph);

    /// Returns the tiles that meet the places.
    TilePlan tiles_at(std::span<const ReachedPlace> places) const;

  private:
    std::span<const Ball> balls_of(std::size_t slot, std::size_t end) const {
        return std::span(clusters_).subspan(first_[slot], first_[end] - first_[slot]);
    }

    static constexpr std::size_t kGroup = 32;  // tiles
    std::vector<std::uint32_t> first_;         // [n_slots + 1] in `clusters_`
    std::vector<Ball> clusters_;
    std::vector<Ball> groups_;  // of kGroup slots in sequence
};

}  // namespace tuft::stroke
