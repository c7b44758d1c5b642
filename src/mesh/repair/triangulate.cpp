#include "mesh/repair/triangulate.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/plane_vectors.h"

namespace tuft::mesh {
namespace {

/// Sum of cross products of consecutive corners (Newell): twice the vector area.
Vec3 newell(std::span<const Vec3> corners) {
    Vec3 n(0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        n += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return n;
}

/// Smaller height over the longest side of the two halves, negative where one is turned over.
double quad_cut_quality(std::span<const Vec3> p, const Vec3& normal, int first) {
    double worst = 1;
    for (int half = 0; half < 2; ++half) {
        const Vec3 &a = p[(first + 2 * half) % 4], &b = p[(first + 2 * half + 1) % 4],
                   &c = p[(first + 2 * half + 2) % 4];
        const Vec3 area = glm::cross(b - a, c - a);
        const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
        worst = std::min(worst, longest > 0 ? glm::dot(area, normal) / longest : 0.0);
    }
    return worst;
}

void cut_quad(std::span<const Vec3> p, std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const Vec3 area = newell(p);
    const double length = glm::length(area);
    const Vec3 normal = length > 0 ? area / length : Vec3(0);
    // Sliver halves are as bad as turned ones: a corner on a straight side must not be cut off.
    constexpr double kSound = 1e-3;
    const double q02 = quad_cut_quality(p, normal, 0), q13 = quad_cut_quality(p, normal, 1);
    bool along_02 = q02 >= q13;
    if (q02 > kSound && q13 > kSound) along_02 = glm::distance(p[0], p[2]) <= glm::distance(p[1], p[3]);
    if (along_02) {
        triangles.push_back({0, 1, 2});
        triangles.push_back({0, 2, 3});
    } else {
        triangles.push_back({0, 1, 3});
        triangles.push_back({1, 2, 3});
    }
}

class EarClipper {
  public:
    EarClipper(std::span<const Vec3> corners, EarBudget& budget)
        : budget_(budget), n_(static_cast<std::uint32_t>(corners.size())) {
        project(corners);
        next_.resize(n_);
        previous_.resize(n_);
        for (std::uint32_t i = 0; i < n_; ++i) {
            next_[i] = i + 1 == n_ ? 0 : i + 1;
            previous_[i] = i == 0 ? n_ - 1 : i - 1;
        }
        for (std::uint32_t i = 0; i < n_; ++i)
            if (!is_convex(i)) reflex_.push_back(i);
    }

    void run(std::vector<std::array<std::uint32_t, 3>>& triangles) {
        std::uint32_t at = 0;
        for (std::uint32_t left = n_; left > 3; --left) {
            const std::uint32_t ear = find_ear(at, left);
            triangles.push_back({previous_[ear], ear, next_[ear]});
            next_[previous_[ear]] = next_[ear];
            previous_[next_[ear]] = previous_[ear];
            at = next_[ear];
            forget_unbent(previous_[ear], next_[ear], ear);
        }
        triangles.push_back({previous_[at], at, next_[at]});
    }

  private:
    void project(std::span<const Vec3> corners) {
        const Vec3 area = newell(corners);
        const double length = glm::length(area);
        const Frame frame = make_frame(corners[0], length > 0 ? area / length : Vec3(0, 0, 1));
        points_.reserve(n_);
        for (const Vec3& c : corners) {
            const Vec3 local = frame.to_local(c);
            points_.emplace_back(local.x, local.y);
        }
    }

    double bend(std::uint32_t i) const {
        return cross(points_[i] - points_[previous_[i]], points_[next_[i]] - points_[previous_[i]]);
    }
    bool is_convex(std::uint32_t i) const { return bend(i) > 0; }

    /// No other corner lies in the triangle; corners at one of its three places do not count.
    bool is_ear(std::uint32_t i) {
        if (!is_convex(i)) return false;
        const std::uint32_t before = previous_[i], after = next_[i];
        const Vec2 a = points_[before], b = points_[i], c = points_[after];
        for (const std::uint32_t r : reflex_) {
            if (budget_.tests == 0) break;
            --budget_.tests;
            const Vec2 p = points_[r];
            if (r == before || r == i || r == after || p == a || p == b || p == c) continue;
            if (cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0) return false;
        }
        return true;
    }

    std::uint32_t find_ear(std::uint32_t at, std::uint32_t left) {
        // Small polygons take the shortest cut, for well-shaped triangles; in long ones the
        // first ear will do.
        const bool choose = left <= 64;
        std::uint32_t best = kNone, flattest = at, i = at;
        double best_length = 0, least_bend = 1e300;
        for (std::uint32_t k = 0; k < left; ++k, i = next_[i]) {
            if (budget_.tests == 0) {
                budget_.ran_out = true;
                return at;
            }
            --budget_.tests;
            if (std::abs(bend(i)) < least_bend) {
                least_bend = std::abs(bend(i));
                flattest = i;
            }
            if (!is_ear(i)) continue;
            const double length = glm::distance(points_[previous_[i]], points_[next_[i]]);
            if (best == kNone || length < best_length) {
                best = i;
                best_length = length;
            }
            if (!choose) break;
        }
        return best != kNone ? best : flattest;
    }

    /// Cutting an ear only widens the two corners beside it: they may stop being reflex.
    void forget_unbent(std::uint32_t before, std::uint32_t after, std::uint32_t ear) {
        budget_.tests -= std::min<std::uint64_t>(budget_.tests, reflex_.size());
        if (budget_.tests == 0) return;
        std::erase_if(reflex_,
                      [&](std::uint32_t r) { return r == ear || ((r == before || r == after) && is_convex(r)); });
    }

    EarBudget& budget_;
    std::uint32_t n_;
    std::vector<Vec2> points_;
    std::vector<std::uint32_t> next_, previous_, reflex_;
};

}  // namespace

void triangulate(std::span<const Vec3> corners, EarBudget& budget,
                 std::vector<std::array<std::uint32_t, 3>>& triangles) {
    if (corners.size() == 3) triangles.push_back({0, 1, 2});
    if (corners.size() == 4) return cut_quad(corners, triangles);
    if (corners.size() > 4) EarClipper(corners, budget).run(triangles);
}

}  // namespace tuft::mesh
