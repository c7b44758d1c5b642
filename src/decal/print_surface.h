#pragma once

#include <functional>
#include <optional>
#include <span>

#include "decal/panels/panels.h"

/// \file
/// A panel together with the strip of surface beyond its seams that overlaps and bleeds are printed from, and where its
/// points lie on the model. Used by outline.h, print.h and placing guides.
namespace tuft::decal {

/// An edge beside a gap, laid flat.
struct GapRim {
    Vec2 a{0}, b{0};                   ///< metres; the gap lies on the left
    std::vector<std::uint32_t> faces;  ///< of the open side, within `kLip` of it
};

/// How far before a gap a brush already leaves less, metres.
inline constexpr double kLip = 0.001;

/// Triangles on the sheet, each with its place in a triangle of the model.
struct PrintSurface {
    std::vector<std::array<std::uint32_t, 3>> faces;  ///< the panel's own first
    std::size_t n_own = 0;                            ///< faces of the panel itself
    std::vector<Vec2> flat;                           ///< [n_vertices], metres
    std::vector<std::uint32_t> source;                ///< [n_faces] triangle of the model
    std::vector<std::array<Weights, 3>> weights;      ///< [n_faces] of the corners
    std::vector<float> strain;                        ///< [n_faces]
    std::vector<GapRim> rims = {};
    /// [n_faces] of a face in a gap the rims within reach of it, else none; or empty where there is no gap.
    std::vector<std::vector<std::uint32_t>> rims_of = {};
    double run_on = 0;  ///< metres that paint is printed beyond the rims of gaps
};

/// Returns the panel and what lies within `reach(label)` metres beyond its seams with the panels of that label. The
/// strip is unrolled over the seam, then laid out as rigid as possible with the panel held. Cost besides that: each
/// edge of the strip against the edges of the seams whose span in x comes within reach.
PrintSurface extend(const FilmMesh& film, const Panel& panel, const std::function<double(std::uint32_t label)>& reach);

/// The same with gaps (`find_gaps`, [n_triangles of the film]), into which paint runs on by `run_on` metres.
PrintSurface extend(const FilmMesh& film, const Panel& panel, const std::function<double(std::uint32_t label)>& reach,
                    std::span<const std::uint8_t> in_gap, double run_on);

/// What is printed at a point of the sheet.
struct PrintedPoint {
    std::uint32_t triangle = kNone;  ///< of the model
    Weights weights{};
    double coverage = 0;
};

/// Returns what is printed at the point `p` of face `t`, which has `weights` in its triangle of the model: what lies
/// there, or in a gap, if that is more, what is painted at the nearest point of its rim or `kLip` before that. One film
/// is laid over a gap and cut in it afterwards, so the paint of both sides goes on to the middle, as it goes on beyond
/// cut lines.
PrintedPoint printed_at(const PrintSurface& surface, const CoverageFn& coverage, std::size_t t, const Vec2& p,
                        const Weights& weights);

/// A point of the model under a point of the sheet.
struct ModelPoint {
    std::uint32_t triangle = kNone;
    Weights weights{};
};

/// Returns the point of the model under a point of the panel's plane; the panel's own triangles come first. Empty where
/// there is none. Cost: all triangles are tested.
std::optional<ModelPoint> locate(const PrintSurface& surface, const Vec2& p);

/// `locate` for many points: triangles in a grid with about as many cells, or fewer where they are needles. Finds the
/// same point.
class SurfaceLocator {
  public:
    /// `surface` must outlive it.
    explicit SurfaceLocator(const PrintSurface& surface);
    std::optional<ModelPoint> locate(const Vec2& p) const;
    /// Number of triangles that the cells list, at most 32 times as many as there are.
    std::size_t n_listed() const { return triangles_.size(); }

  private:
    std::size_t cell_of(double x, double y) const;

    const PrintSurface& surface_;
    Vec2 lo_{0};
    double cell_ = 1;  // metres
    std::size_t width_ = 1, height_ = 1;
    std::vector<std::uint32_t> start_, triangles_;  // those of cell i from start_[i] to start_[i + 1], in order
};

/// Returns the direction on the sheet of a direction of the model: the mean over a panel of its tangential part, laid
/// flat. Its length is at most 1; 0 where the panel is normal to it.
Vec2 flat_direction(const atlas::ChartMesh& chart, std::span<const Vec2> flat, const Vec3& direction);

}  // namespace tuft::decal
