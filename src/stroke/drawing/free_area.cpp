#include "stroke/drawing/free_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace tuft::stroke {

namespace {

constexpr std::array<std::pair<Side, std::string_view>, 7> kSides{{{Side::front, "front"},
                                                                   {Side::back, "back"},
                                                                   {Side::left, "left"},
                                                                   {Side::right, "right"},
                                                                   {Side::top, "top"},
                                                                   {Side::bottom, "bottom"},
                                                                   {Side::inside, "inside"}}};

constexpr int kMiddle = 64, kCells = 2 * kMiddle + 1;
constexpr double kBent = 0.85, kTurned = 0.34, kSteep = 2;
constexpr double kFilled = 0.5;  // cells between a ray's depth and the closed one from which on it looks into a gap
constexpr int kRoughReach = 2;   // cells to each side over which roughness is taken
constexpr double kLeastScale = 1.0 / 32, kMostAspect = 32;
constexpr double kSymmetric = 0.97;  // of the rays that hit: so many have a mirror image in a view that has a middle
constexpr double kSameNormal = 0.9;  // cosine between the normal of a ray and that of its image
constexpr double kCentred = 0.33;    // of the largest area's scale: so large an area in the middle is taken for it
constexpr int kAround = 8,
              kWalls = 6;  // horizontal rays about a point of the inside, and how many meet a wall

/// Rough by more than this (1 − length of the mean normal), and what an area of it counts.
struct Calm {
    double rough, counts;
};
constexpr Calm kCalm[] = {{0.01, 1}, {0.03, 0.75}, {0.1, 0.5}, {2, 0.35}};

// What is summed over a rectangle of rays: those that are not free; normals; those that have one.
struct Sum {
    double bad = 0, seen = 0;
    Vec3 normal{0};

    Sum operator+(const Sum& s) const { return {bad + s.bad, seen + s.seen, normal + s.normal}; }
    Sum operator-(const Sum& s) const { return {bad - s.bad, seen - s.seen, normal - s.normal}; }
};

std::size_t index(int i, int j) {
    return static_cast<std::size_t>(j) * kCells + static_cast<std::size_t>(i);
}

/// Sums of cells from the first corner on.
class Sums {
  public:
    explicit Sums(const std::vector<Sum>& cells) : sums_((kCells + 1) * (kCells + 1)) {
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i)
                at(i + 1, j + 1) = cells[index(i, j)] + at(i, j + 1) + at(i + 1, j) - at(i, j);
    }
    /// Over the cells i − hi … i + hi, j − hj … j + hj, cut at the grid's edge.
    Sum over(int i, int j, int hi, int hj) const {
        const int a = std::max(0, i - hi), b = std::min(kCells, i + hi + 1), c = std::max(0, j - hj),
                  d = std::min(kCells, j + hj + 1);
        return at(b, d) - at(a, d) - at(b, c) + at(a, c);
    }

  private:
    Sum& at(int i, int j) { return sums_[static_cast<std::size_t>(j) * (kCells + 1) + static_cast<std::size_t>(i)]; }
    const Sum& at(int i, int j) const {
        return sums_[static_cast<std::size_t>(j) * (kCells + 1) + static_cast<std::size_t>(i)];
    }

    std::vector<Sum> sums_;
};

/// The least, or with `most` the greatest, of each cell and its eight neighbours.
std::vector<double> among_neighbours(const std::vector<double>& values, bool most) {
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

/// A model seen by a grid of rays.
class View {
  public:
    View(const mesh::SurfaceQuery& query, Side side)
        : query_(query), look_(look_at_side(side)), inside_(side == Side::inside) {
        const Box& box = query.mesh().bounds;
        const Vec3 right = glm::normalize(
            glm::cross(look_, std::abs(look_.z) < 0.95 ? Vec3{0, 0, 1} : Vec3{0, look_.z > 0 ? -1.0 : 1.0, 0}));
        const Vec3 up = glm::cross(right, look_);
        cell_ = {glm::dot(box.size(), glm::abs(right)) / kCells, glm::dot(box.size(), glm::abs(up)) / kCells};
        right_ = cell_.x * right, up_ = cell_.y * up;
        before_ = box.centre() - box.diagonal() * look_;
        cast();
    }

    /// Whether its left half mirrors its right one.
    bool symmetric() const { return symmetric_; }
    bool flat() const { return !(cell_.x > 0 && cell_.y > 0); }
    const Vec2& cell() const { return cell_; }
    const Vec3& look() const { return look_; }
    std::optional<mesh::SurfacePoint> hit(int i, int j) const {
        return query_.ray(before_ + double(i - kMiddle) * right_ + double(j - kMiddle) * up_, look_);
    }
    /// Cells that are rougher than this are not free.
    Sums calm(double rough) const {
        std::vector<Sum> cells = cells_;
        for (std::size_t k = 0; k < cells.size(); ++k) cells[k].bad += rough_[k] > rough;
        return Sums(cells);
    }

  private:
    bool has_walls(const mesh::SurfacePoint& p) const {
        const Vec3 from = p.position + 0.05 * cell_.x * p.face_normal;
        int walls = 0;
        for (int k = 0; k < kAround; ++k) {
            const double a = 2 * std::numbers::pi * (k + 0.5) / kAround;
            walls += query_.ray(from, {std::cos(a), std::sin(a), 0}).has_value();
        }
        return walls >= kWalls;
    }

    bool is_symmetric(const std::vector<double>& depth, double slack) const {
        const Vec3 right = glm::normalize(right_);
        std::size_t seen = 0, mirrored = 0;
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const std::size_t here = index(i, j), there = index(kCells - 1 - i, j);
                if (!std::isfinite(depth[here])) continue;
                ++seen;
                const Vec3& n = cells_[there].normal;
                const Vec3 image = n - 2 * glm::dot(n, right) * right;
                mirrored += std::abs(depth[here] - depth[there]) <= slack &&
                            (cells_[here].seen == 0 || glm::dot(image, cells_[here].normal) >= kSameNormal);
            }
        return static_cast<double>(mirrored) >= kSymmetric * static_cast<double>(seen);
    }

    void cast() {
        constexpr double kFar = std::numeric_limits<double>::infinity();
        std::vector<double> depth(kCells * kCells, kFar);
        cells_.assign(kCells * kCells, Sum{});
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const auto at = hit(i, j);
                if (!at || glm::dot(at->face_normal, look_) >= 0) continue;
                depth[index(i, j)] = at->distance;
                cells_[index(i, j)] = {
                    -glm::dot(at->face_normal, look_) < kTurned || (inside_ && !has_walls(*at)) ? 1.0 : 0.0, 1,
                    at->face_normal};
            }
        // What is one or two rays wide, such as a shut line, is closed: a drawing is draped over
        // it.
        const std::vector<double> closed = among_neighbours(among_neighbours(depth, false), true);
        const double gap = kFilled * std::max(cell_.x, cell_.y);
        for (std::size_t k = 0; k < closed.size(); ++k)
            if (std::isfinite(closed[k]) && !(depth[k] - closed[k] <= gap)) cells_[k] = {};
        symmetric_ = is_symmetric(closed, gap);
        const auto steps = [&](std::size_t k, std::size_t before, double cell) {
            return std::abs(closed[k] - closed[before]) > kSteep * cell;
        };
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const std::size_t k = index(i, j);
                if (!std::isfinite(closed[k]) || (i > 0 && steps(k, k - 1, cell_.x)) ||
                    (j > 0 && steps(k, k - kCells, cell_.y)))
                    cells_[k].bad = 1;
            }
        const Sums sums(cells_);
        rough_.assign(cells_.size(), 0);
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const Sum near = sums.over(i, j, kRoughReach, kRoughReach);
                rough_[index(i, j)] = near.seen > 0 ? 1 - glm::length(near.normal) / near.seen : 0;
            }
    }

    const mesh::SurfaceQuery& query_;
    Vec3 look_, right_, up_, before_;
    Vec2 cell_;
    bool inside_, symmetric_ = false;
    std::vector<Sum> cells_;
    std::vector<double> rough_;
};

struct Rectangle {
    int i = 0, j = 0, hi = 0, hj = 0;
    double scale = 0;  // of the largest that the view holds
    Vec3 normal{0};
};

/// Rectangles of one shape, by their scale.
struct Shape {
    Vec2 full;  // metres, at scale 1

    Shape(const Vec2& cell, double aspect) {
        const Vec2 whole = static_cast<double>(kCells) * cell;
        const double width = std::min(whole.x, std::clamp(aspect, 1 / kMostAspect, kMostAspect) * whole.y);
        full = {width, width / std::clamp(aspect, 1 / kMostAspect, kMostAspect)};
    }
    Rectangle at(int i, int j, double scale, const Vec2& cell) const {
        const Vec2 half = 0.5 * (scale * full / cell - 1.0);
        return {i,     j, std::max(0, static_cast<int>(half.x + 1e-6)), std::max(0, static_cast<int>(half.y + 1e-6)),
                scale, {}};
    }
};

bool fits(const Sums& sums, Rectangle& r, const Vec3& look) {
    if (r.i < r.hi || r.j < r.hj || r.i + r.hi >= kCells || r.j + r.hj >= kCells) return false;
    const Sum sum = sums.over(r.i, r.j, r.hi, r.hj);
    if (sum.bad > 0.5 || sum.seen < 0.5) return false;
    r.normal = sum.normal / sum.seen;
    return glm::length(r.normal) >= kBent && -glm::dot(r.normal, look) >= kTurned;
}

/// Of places that fit, the one next to the middle of the largest group of neighbours.
std::size_t middle_one(const std::vector<Rectangle>& found) {
    std::vector<int> at(kCells * kCells, -1), group(found.size(), -1);
    for (std::size_t k = 0; k < found.size(); ++k) at[index(found[k].i, found[k].j)] = static_cast<int>(k);
    std::size_t best = 0, most = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
        if (group[k] >= 0) continue;
        std::vector<std::size_t> members{k};
        group[k] = static_cast<int>(k);
        Vec2 sum{0};
        for (std::size_t m = 0; m < members.size(); ++m) {
            const Rectangle& r = found[members[m]];
            sum += Vec2(r.i, r.j);
            for (int y = std::max(0, r.j - 1); y <= std::min(kCells - 1, r.j + 1); ++y)
                for (int x = std::max(0, r.i - 1); x <= std::min(kCells - 1, r.i + 1); ++x)
                    if (const int next = at[index(x, y)]; next >= 0 && group[static_cast<std::size_t>(next)] < 0) {
                        group[static_cast<std::size_t>(next)] = static_cast<int>(k);
                        members.push_back(static_cast<std::size_t>(next));
                    }
        }
        if (members.size() <= most) continue;
        most = members.size();
        const Vec2 middle = sum / static_cast<double>(members.size());
        best = *std::min_element(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
            return glm::distance(Vec2(found[a].i, found[a].j), middle) <
                   glm::distance(Vec2(found[b].i, found[b].j), middle);
        });
    }
    return best;
}

/// The largest rectangle on these cells with its centre in the columns `from` to `to`.
std::optional<Rectangle> largest(const View& view, const Sums& sums, const Shape& shape, int from, int to) {
    for (double scale = 1; scale > kLeastScale; scale *= std::exp2(-0.25)) {
        std::vector<Rectangle> found;
        for (int j = 0; j < kCells; ++j)
            for (int i = from; i <= to; ++i)
                if (Rectangle r = shape.at(i, j, scale, view.cell()); fits(sums, r, view.look())) found.push_back(r);
        if (found.empty()) continue;
        Rectangle best = found[middle_one(found)];
        for (double larger = scale * 1.01; larger < scale * std::exp2(0.25); larger *= 1.01) {
            Rectangle r = shape.at(best.i, best.j, larger, view.cell());
            if (!fits(sums, r, view.look())) break;
            best = r;
        }
        return best;
    }
    return {};
}

struct RatedRectangle {
    std::optional<Rectangle> rectangle;
    double worth = 0;  // its scale, less where it is rough
};

/// The rectangle that is worth most, with its centre in the columns `from` to `to`.
RatedRectangle best_rectangle(const View& view, const Shape& shape, int from, int to) {
    RatedRectangle best;
    for (const Calm& calm : kCalm) {
        const std::optional<Rectangle> r = largest(view, view.calm(calm.rough), shape, from, to);
        if (r && calm.counts * r->scale > best.worth * (1 + 1e-9)) best = {r, calm.counts * r->scale};
    }
    return best;
}

}  // namespace

std::string_view side_name(Side side) {
    return std::find_if(kSides.begin(), kSides.end(), [=](const auto& s) { return s.first == side; })->second;
}

std::optional<Side> side_named(std::string_view name) {
    for (const auto& [side, known] : kSides)
        if (known == name) return side;
    return std::nullopt;
}

Vec3 look_at_side(Side side) {
    switch (side) {
        case Side::front:
            return {0, 1, 0};
        case Side::back:
            return {0, -1, 0};
        case Side::left:
            return {1, 0, 0};
        case Side::right:
            return {-1, 0, 0};
        case Side::bottom:
            return {0, 0, 1};
        case Side::top:
        case Side::inside:
            break;
    }
    return {0, 0, -1};
}

Side usual_side(const Box& box) {
    return box.size().z < 0.25 * std::min(box.size().x, box.size().y) ? Side::top : Side::front;
}

std::optional<FreeArea> find_free_area(const mesh::SurfaceQuery& query, Side side, double aspect) {
    const View view(query, side);
    if (view.flat()) return {};
    const Shape shape(view.cell(), aspect);
    auto [best, worth] = best_rectangle(view, shape, 0, kCells - 1);
    if (best && view.symmetric())
        if (const RatedRectangle middle = best_rectangle(view, shape, kMiddle, kMiddle);
            middle.worth >= kCentred * worth)
            best = middle.rectangle;
    if (!best) return {};
    // A ray into a shut line may meet nothing.
    std::optional<mesh::SurfacePoint> at;
    for (int k = 0; k <= 2 * kRoughReach && !at; ++k) {
        const int off = k % 2 ? (k + 1) / 2 : -k / 2;
        at = view.hit(best->i + off, best->j);
    }
    if (!at) return {};
    return FreeArea{*at, glm::normalize(best->normal), Vec2(2 * best->hi + 1, 2 * best->hj + 1) * view.cell()};
}

}  // namespace tuft::stroke
