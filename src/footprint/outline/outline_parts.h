#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/system/recycled.h"
#include "footprint/outline/cuts.h"

/// \file
/// From the shadows of sections to an outline. Internal to the sources of `outline`.
namespace tuft::footprint {

/// Extreme corners of a loop.
struct LoopExtent {
    Vec2 low{0}, high{0};        ///< of least and of greatest y
    double rear = 0, front = 0;  ///< least and greatest x
};

/// Shadows of sections on the surface, one loop of corners each.
struct Loops {
    Recycled<Vec2> corners;
    Recycled<std::size_t> first{0};  ///< corner of each loop, and the end
    Recycled<LoopExtent> extent;     ///< of each loop, after `find_extents`

    /// `strip`: corners of the hair's sections; empty: ellipses.
    void add(std::span<const Cut> cuts, std::span<const Vec2> strip);
    void find_extents();
    std::size_t size() const { return first.size() - 1; }
    std::span<const Vec2> operator[](std::size_t k) const {
        return {corners.data() + first[k], first[k + 1] - first[k]};
    }
};

/// Coordinates along and across a patch.
struct PatchFrame {
    Vec2 middle{0}, forward{1, 0};

    Vec2 left() const { return {-forward.y, forward.x}; }
    void to_patch(Recycled<Vec2>& points) const {
        for (Vec2& q : points) q = {glm::dot(q - middle, forward), glm::dot(q - middle, left())};
    }
    Vec2 to_stamp(const Vec2& q) const { return middle + q.x * forward + q.y * left(); }
};

/// Upper and lower edge of a region over evenly turned abscissae between its two ends.
class Envelope {
  public:
    Envelope(double lo, double hi, int n) : x_(n), top_(n, -kFar), bottom_(n, kFar) {
        for (int j = 0; j < n; ++j)
            x_[j] = 0.5 * (lo + hi) - 0.5 * (hi - lo) * std::cos(std::numbers::pi * (j + 1) / (n + 1));
    }

    void add(Vec2 p, Vec2 q) {
        if (p.x > q.x) std::swap(p, q);
        const int n = static_cast<int>(x_.size());
        find(p.x);
        for (int j = at_; j < n && x_[j] <= q.x; ++j) {
            const double f = q.x > p.x ? (x_[j] - p.x) / (q.x - p.x) : 0;
            const double y = p.y + f * (q.y - p.y);
            top_[j] = std::max(top_[j], y);
            bottom_[j] = std::min(bottom_[j], y);
        }
    }

    /// Whether an abscissa lies in [lo, hi].
    bool meets(double lo, double hi) {
        find(lo);
        return at_ < static_cast<int>(x_.size()) && x_[at_] <= hi;
    }

    bool covered(int j) const { return top_[j] >= bottom_[j]; }
    Vec2 top(int j) const { return {x_[j], top_[j]}; }
    Vec2 bottom(int j) const { return {x_[j], bottom_[j]}; }

  private:
    static constexpr double kFar = 1e9;
    /// at_ becomes the first abscissa from x on.
    void find(double x) {
        const int n = static_cast<int>(x_.size());
        while (at_ > 0 && x_[at_ - 1] >= x) --at_;
        while (at_ < n && x_[at_] < x) ++at_;
    }
    Recycled<double> x_, top_, bottom_;
    int at_ = 0;
};

/// Two ends of an outline, patch frame.
struct Ends {
    Vec2 front{0}, rear{0};
};

/// Orders points by x.
inline bool by_x(const Vec2& a, const Vec2& b) {
    return a.x < b.x;
}

/// Returns v over its length, or `other` where it has none.
Vec2 unit_or(const Vec2& v, const Vec2& other);

/// Corners of a trail's strip; none of a disc.
std::span<const Vec2> strip_of(const Trail& trail);

/// Direction of the footprint from tail to tip: from end to end of the touching spine; for
/// one that stands, the trace of its bending plane.
Vec2 forward_direction(const Recycled<Cut>& cuts);

/// Adds the loops of one trail, each with the skin to the next; after `find_extents`.
void add_loops(const Loops& loops, std::size_t begin, std::size_t end, Envelope& envelope);

/// The outline of an envelope. With `edges` its control points are its own: the spline through them would swing beyond
/// the straight ends of strips.
Outline closed_outline(const Envelope& envelope, const PatchFrame& patch, const Ends& ends, int points, bool edges);

/// Returns the branches of a row whose strips that stand on their edge reach no further than midway to their
/// neighbours: a row that bends along its broad side is sheared, and lies more closely than it is wide. The hair of a
/// strip's lower edge would else touch where that of its neighbour, below it, does not. Sections keep their thickness.
Recycled<brush::Branch> bound_on_edge(const brush::TuftState& tuft, const Frame& frame,
                                      std::span<const NodePlanes> planes);

}  // namespace tuft::footprint
