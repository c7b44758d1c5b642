#include "footprint/outline/rough_edge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/solid_noise.h"
#include "footprint/outline/section_outline.h"

namespace tuft::footprint {
namespace {

constexpr double kRun = 3e-3, kFineRun = 0.8e-3;  // metres along the path over which hair at the edge comes and goes
constexpr double kEndRun = 2e-3;                  // over which a hair's own end changes
constexpr double kFlank = 0.4, kFineFlank = 0.3;  // A: of the spacing
constexpr double kEnd = 0.7;                      // B: of the spacing
constexpr double kOfFlank = 0.05;                 // (n·t)² up to which an edge is all flank
constexpr double kCoarse = 0.1e-3;                // metres: D of coarser hair
constexpr double kGrain = 0.35, kFilm = 10e-6;    // of the length of the grain; metres of ink that drown it
constexpr double kHeld = 0.3;                     // part of hair's edge that ink on a smooth substrate keeps
constexpr double kUnseen = 0.2;       // texels: w D from which the edge's rms is 0.04 at flanks, 0.08 at ends
constexpr double kLeastGrain = 4e-6;  // metres: G below which the grain is left out
// Cells, half a texel each, over the detail's size between which it vanishes.
constexpr double kHairFull = 0.25, kHairGone = 0.75, kGrainFull = 0.5, kGrainGone = 1.25;
constexpr double kNarrow = 16;    // spacings: width of a mark from which its edge is fully rough
constexpr double kRunPoints = 4;  // points of the outline over the shorter run, along the path
constexpr int kMostPoints = 48;   // of one span of the spline

/// Noise in [−1, 1] with cells of one unit, blended by 3f² − 2f³. Points that follow each other often share a cell.
class PlaneNoise {
  public:
    explicit PlaneNoise(std::uint64_t seed) : seed_(seed) {}

    double at(double x, double y) {
        const double cx = std::floor(x), cy = std::floor(y), gx = fade(x - cx), gy = fade(y - cy);
        if (!(cx == x_ && cy == y_)) find_corners(cx, cy);
        const double a = corners_[0] + gx * (corners_[1] - corners_[0]),
                     b = corners_[2] + gx * (corners_[3] - corners_[2]);
        return a + gy * (b - a);
    }

  private:
    void find_corners(double x, double y) {
        x_ = x;
        y_ = y;
        const auto i = static_cast<std::int64_t>(x), j = static_cast<std::int64_t>(y);
        for (int k = 0; k < 4; ++k) corners_[k] = solid_noise_corner(i + (k & 1), j + (k >> 1), 0, seed_);
    }

    std::uint64_t seed_;
    double x_ = std::numeric_limits<double>::quiet_NaN(), y_ = 0;  // cell of the corners
    std::array<double, 4> corners_{};
};

/// 1 where `cell` is `full` of `size` or less, 0 from `gone` on.
double visible_part(double cell, double size, double full, double gone) {
    return smooth_step((gone - cell / size) / (gone - full));
}

/// δ of one stamp.
class Displacement {
  public:
    Displacement(const PicturePlane& plane, const RoughEdge& edge)
        : plane_(plane),
          edge_(edge),
          hair_(std::min(edge.hair.spacing, kCoarse) *
                visible_part(plane.cell, edge.hair.spacing, kHairFull, kHairGone)),
          coarse_(edge.hair.seed),
          fine_(edge.hair.seed + 1),
          end_(edge.hair.seed + 2) {
        const EdgeGrain& g = edge.grain;
        hair_ *= kHeld + (1 - kHeld) * g.relief / (g.relief + kFilm);
        if (hair_ < kUnseen * 2 * plane.cell) hair_ = 0;
        if (!(g.relief > 0)) return;
        const double whole = kGrain * g.length * g.relief / (g.relief + kFilm);
        grain_ = whole > kLeastGrain ? whole * visible_part(plane.cell, g.length, kGrainFull, kGrainGone) : 0;
    }

    bool none() const { return !(hair_ > 0) && !(grain_ > 0); }

    /// Distances of points that resolve δ, along the hand's path and across it: a texel, but along the path of a hair
    /// δ changes over millimetres.
    Vec2 steps() const {
        const double texel = 2 * plane_.cell;
        return {grain_ > 0 ? texel : std::max(texel, kFineRun / kRunPoints), texel};
    }

    double at(const Vec2& p, const Vec2& normal) {
        double out = 0;
        if (hair_ > 0) {
            const EdgeHair& h = edge_.hair;
            const Vec2 d = p - h.foot;
            const double x = (h.direction.x * d.y - h.direction.y * d.x) / h.spacing;
            const double s = h.travel + glm::dot(h.direction, d), along = glm::dot(normal, h.direction);
            out += hair_ * (kFlank * coarse_.at(x, s / kRun) + kFineFlank * fine_.at(x, s / kFineRun));
            if (const double end = along * along - kOfFlank; end > 0)
                out += hair_ * kEnd * end / (1 - kOfFlank) * end_.at(x, s / kEndRun);
        }
        if (grain_ > 0) {
            const Vec3 q = plane_.frame.to_world(Vec3(p, 0)) / (2 * edge_.grain.length);
            out += grain_ / std::sqrt(kSolidNoiseSquare) * solid_noise(2.0 * q, kSeed);
        }
        return out;
    }

  private:
    static constexpr std::uint64_t kSeed = 19;
    const PicturePlane& plane_;
    const RoughEdge& edge_;
    double hair_ = 0, grain_ = 0;  // metres
    PlaneNoise coarse_, fine_, end_;
};

/// Points of the outline, no more than `steps` metres apart along `direction` and across it.
Polygon points_of(const Outline& outline, const Vec2& direction, const Vec2& steps) {
    const std::size_t n = outline.control.size();
    Polygon points;
    for (std::size_t k = 0; k < n && n >= 3; ++k) {
        const CurveSpan span(outline, k);
        const Vec2 d = span.c2 - span.c1;
        const double along = std::abs(glm::dot(direction, d)) / steps.x,
                     across = std::abs(direction.x * d.y - direction.y * d.x) / steps.y;
        const int count = static_cast<int>(std::clamp(std::ceil(std::hypot(along, across)), 1.0, double(kMostPoints)));
        for (int i = 0; i < count; ++i) points.push_back(span.at(double(i) / count));
    }
    return points;
}

/// Mean width of a closed curve, metres.
double mean_width(const Polygon& curve) {
    double area = 0, length = 0;
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const Vec2 &p = curve[k], &q = curve[k + 1 < curve.size() ? k + 1 : 0];
        area += 0.5 * (p.x * q.y - p.y * q.x);
        length += glm::length(q - p);
    }
    return length > 0 ? 2 * std::abs(area) / length : 0;
}

void roughen(Polygon& curve, Displacement& displacement, double scale) {
    if (curve.empty()) return;
    const Vec2 first = curve.front();
    Vec2 before = curve.back();
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const Vec2 smooth = curve[k], run = (k + 1 < curve.size() ? curve[k + 1] : first) - before;
        before = smooth;
        const double length = glm::length(run);
        if (!(length > 1e-12)) continue;
        const Vec2 outward = Vec2{run.y, -run.x} / length;
        curve[k] += scale * displacement.at(smooth, outward) * outward;
    }
}

}  // namespace

Footprint rasterise(std::span<const Outline> outlines, const PicturePlane& plane, const RoughEdge& edge) {
    Displacement displacement(plane, edge);
    if (displacement.none()) return rasterise(outlines, plane.frame, plane.triangle, plane.cell);
    const Vec2 steps = displacement.steps();
    Recycled<Polygon> curves;
    curves.reserve(outlines.size());
    for (const Outline& outline : outlines) {
        Polygon curve = points_of(outline, edge.hair.direction, steps);
        roughen(curve, displacement, std::min(1.0, mean_width(curve) / (kNarrow * edge.hair.spacing)));
        curves.push_back(std::move(curve));
    }
    return rasterise_polygons(curves, plane.frame, plane.triangle, plane.cell);
}

}  // namespace tuft::footprint
