#pragma once

#include <array>
#include <atomic>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/smoothed_surface.h"
#include "stroke/placement/surface_mapping.h"

/// \file
/// A placement on the smoothed surface. Called by drape.cpp and, so that the strokes of one drawing walk its lines
/// once, by `Document`.
namespace tuft::stroke {

/// The straightest lines from a placement's origin over the smoothed surface, walked as far as they are asked for. Safe
/// in several threads; what was asked for before does not change an answer.
class Drape {
  public:
    /// Throws `Error` for a surface without a nearest point. `query` must outlive it.
    Drape(const mesh::SurfaceQuery& query, const Placement& place);

    double origin_gap() const { return gap_; }  ///< metres between the placement's origin and the surface
    double radius() const { return radius_; }   ///< metres, of patches
    std::size_t bytes() const { return n_patches_ * sizeof(SurfacePatch); }  ///< of its lines so far

    /// Returns place, normal and axes of a flat point on the smoothed surface; `on_surface` as it is there.
    SurfaceSample at(const Vec2& flat);

  private:
    static constexpr int kRays = 180;  // headings in which lines are walked; between them linear

    struct Line {
        std::mutex mutex;
        std::vector<SurfacePatch> patches;  // `stride_` apart
    };

    /// Returns two patches in sequence on a line.
    std::array<SurfacePatch, 2> patches_of(int ray, std::size_t ring);

    const mesh::SurfaceQuery& query_;
    double radius_, stride_, gap_ = 0, hand_ = 1;
    SurfacePatch origin_;
    Axes axes_;
    std::array<Line, kRays> lines_;
    std::atomic<std::size_t> n_patches_ = 0;
};

/// The drapes of the placements that were asked for last on one surface, none of them large. Safe in several threads.
class Drapes {
  public:
    static constexpr std::size_t kLarge = std::size_t{16} << 20;  // bytes; that of a drawing of a metre: 3 MB

    explicit Drapes(std::shared_ptr<const mesh::SurfaceQuery> surface, std::size_t large = kLarge)
        : surface_(std::move(surface)), large_(large) {}

    const mesh::SurfaceQuery& surface() const { return *surface_; }
    std::shared_ptr<Drape> of(const Placement& place);
    /// Forgets drapes that have grown larger than is kept.
    void drop_large();

  private:
    static constexpr std::size_t kMost = 4;

    struct Kept {
        Placement place;
        std::shared_ptr<Drape> drape;
    };
    std::shared_ptr<const mesh::SurfaceQuery> surface_;
    std::size_t large_;  // bytes
    std::mutex mutex_;
    std::list<Kept> kept_;  // last used first
};

}  // namespace tuft::stroke
