#include "stroke/hand/room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tuft::stroke {

namespace {

constexpr int kMiddle = 64, kCells = 2 * kMiddle + 1;
constexpr double kBent = 0.85, kTurned = 0.35, kSteep = 2;

// What is summed over a rectangle of rays: those that miss or see a step, and the normals.
using Sum = Vec4;

/// Rays upright to a plane before the model, and their sums from the first corner on.
class View {
  public:
    View(const mesh::SurfaceQuery& query, const Vec3& look) : query_(query), look_(look) {
        const Box& box = query.mesh().bounds;
        right_ = glm::normalize(glm::cross(look, std::abs(look.z) < 0.95 ? Vec3{0, 0, 1} : Vec3{0, 1, 0}));
        up_ = glm::cross(right_, look);
        cell_ = {glm::dot(box.size(), glm::abs(right_)) / kCells, glm::dot(box.size(), glm::abs(up_)) / kCells};
        before_ = box.centre() - box.diagonal() * look;
        cast();
    }

    const Vec2& cell() const { return cell_; }
    Vec3 origin(int i, int j) const { return before_ + (i - kMiddle) * cell_.x * right_ + (j - kMiddle) * cell_.y * up_; }
    /// Over the cells i − hi … i + hi, j − hj … j + hj.
    Sum sum(int i, int j, int hi, int hj) const {
        return at(i + hi + 1, j + hj + 1) - at(i - hi, j + hj + 1) - at(i + hi + 1, j - hj) + at(i - hi, j - hj);
    }

  private:
    const Sum& at(int i, int j) const { return sums_[static_cast<std::size_t>(j) * (kCells + 1) + static_cast<std::size_t>(i)]; }

    static std::size_t index(int i, int j) { return static_cast<std::size_t>(j) * kCells + static_cast<std::size_t>(i); }

    /// The least, or with `most` the greatest, of each cell and its eight neighbours.
    static std::vector<double> among_neighbours(const std::vector<double>& values, bool most) {
        std::vector<double> out(values.size());
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                double v = values[index(i, j)];
                for (int y = std::max(0, j - 1); y <= std::min(kCells - 1, j + 1); ++y)
                    for (int x = std::max(0, i - 1); x <= std::min(kCells - 1, i + 1); ++x)
                        v = most ? std::max(v, values[index(x, y)]) : std::min(v, values[index(x, y)]);
                out[index(i, j)] = v;
            }
        return out;
    }

    void cast() {
        std::vector<double> depth(kCells * kCells, std::numeric_limits<double>::infinity());
        std::vector<Sum> seen(kCells * kCells, Sum{0});
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i)
                if (const auto hit = query_.ray(origin(i, j), look_); hit && glm::dot(hit->face_normal, look_) < 0) {
                    depth[index(i, j)] = hit->distance;
                    seen[index(i, j)] = Sum{0, hit->face_normal};
                }
        // What is one or two rays wide, such as a shut line, is closed: a drawing is draped over it.
        depth = among_neighbours(among_neighbours(depth, false), true);
        const auto steps = [&](std::size_t k, std::size_t before, double cell) { return std::abs(depth[k] - depth[before]) > kSteep * cell; };
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const std::size_t k = index(i, j);
                seen[k][0] = !std::isfinite(depth[k]) || (i > 0 && steps(k, k - 1, cell_.x)) || (j > 0 && steps(k, k - kCells, cell_.y));
            }
        sums_.assign((kCells + 1) * (kCells + 1), Sum{0});
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i)
                sums_[static_cast<std::size_t>(j + 1) * (kCells + 1) + static_cast<std::size_t>(i + 1)] =
                    seen[index(i, j)] + at(i, j + 1) + at(i + 1, j) - at(i, j);
    }

    const mesh::SurfaceQuery& query_;
    Vec3 look_, right_, up_, before_;
    Vec2 cell_;
    std::vector<Sum> sums_;
};

}  // namespace

std::optional<Room> find_room(const mesh::SurfaceQuery& query, const Vec3& look, const Vec2& size) {
    const View view(query, look);
    if (!(view.cell().x > 0 && view.cell().y > 0)) return {};
    for (double scale = 1; scale > 1.0 / 17; scale *= std::exp2(-0.25)) {
        const int hi = static_cast<int>(std::lround(std::min(0.5 * scale * size.x / view.cell().x, 2.0 * kCells)));
        const int hj = static_cast<int>(std::lround(std::min(0.5 * scale * size.y / view.cell().y, 2.0 * kCells)));
        const double count = (2.0 * hi + 1) * (2.0 * hj + 1);
        double best = std::numeric_limits<double>::infinity();
        std::optional<Room> room;
        for (int j = hj; j < kCells - hj; ++j)
            for (int i = hi; i < kCells - hi; ++i) {
                const Sum sum = view.sum(i, j, hi, hj);
                const double away = glm::length(Vec2(i - kMiddle, j - kMiddle) * view.cell());
                if (sum[0] > 0.5 || away >= best) continue;
                const Vec3 normal = Vec3(sum[1], sum[2], sum[3]) / count;
                if (glm::length(normal) < kBent || -glm::dot(normal, look) < kTurned) continue;
                const auto at = query.ray(view.origin(i, j), look);
                if (!at) continue;
                best = away;
                room = Room{*at, glm::normalize(normal), scale};
            }
        if (room) return room;
    }
    return {};
}

}  // namespace tuft::stroke
