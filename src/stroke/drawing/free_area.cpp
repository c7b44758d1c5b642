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
constexpr double kAlike = 0.5;  // cells between the depths of a ray and its image in a view that has a middle
constexpr int kReach = 2;       // of the longer cells to each side over which the surface is smoothed
constexpr int kMostReach = 8;   // of the shorter cells
constexpr double kNoise = 2;    // times the usual relief are noise: of 25 cells its estimate is off by 30 %
constexpr double kGap = 0.5;    // cells of a gap's depth that count as roughness
constexpr double kSlack = 8;    // times the noise make no step: 4 of its differences' standard deviations, seen at 45°
constexpr double kAbove = 0.05;  // cells above the surface from which walls are looked for
constexpr double kLeastScale = 1.0 / 32, kMostAspect = 32;
constexpr double kSymmetric = 0.9;   // so much is mirrored in a view that has a middle
constexpr double kLopsided = 0.75;   // so little in one that has none
constexpr double kUncertain = 4;     // times the noise: 2.8 standard deviations of the difference of two depths
constexpr double kSameNormal = 0.9;  // cosine between the normal of a ray and that of its image
constexpr double kCentred = 0.33;    // of the most worth: an area in the middle that is worth so much is taken
constexpr int kAround = 8,
              kWalls = 6;  // horizontal rays about a point of the inside, and how many meet a wall

constexpr double kRough = 0.08;   // an area whose roughness is this on the mean counts half
constexpr double kFeature = 0.1;  // from this roughness on a cell is part of something that stands out
constexpr double kAvoided = 2;    // and adds so much to the roughness of its area
constexpr double kAsGood = 0.97;  // of the most worth: places are equal

// What is summed over a rectangle of rays: those that are not free; those that have a normal; normals; roughness.
struct Sum {
    double bad = 0, seen = 0;
    Vec3 normal{0};
    double rough = 0;

    Sum operator+(const Sum& s) const { return {bad + s.bad, seen + s.seen, normal + s.normal, rough + s.rough}; }
    Sum operator-(const Sum& s) const { return {bad - s.bad, seen - s.seen, normal - s.normal, rough - s.rough}; }
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
        const double reach = kReach * std::max(cell_.x, cell_.y);
        for (int k = 0; k < 2; ++k)
            reach_[k] = static_cast<int>(std::min(double(kMostReach), reach / std::max(cell_[k], 1e-30) + 0.5));
        cast();
        judge();
        symmetry_ = mirrored_part();
    }

    /// Of the rays that hit, or whose image does, those whose surface is mirrored.
    double symmetry() const { return symmetry_; }
    bool flat() const { return !(cell_.x > 0 && cell_.y > 0); }
    const Vec2& cell() const { return cell_; }
    const Vec3& look() const { return look_; }
    std::optional<mesh::SurfacePoint> hit(int i, int j) const { return query_.ray(start(i, j), look_); }
    Sums sums() const { return Sums(cells_); }

  private:
    /// The plane that the surface about a cell lies along.
    struct Plane {
        Vec3 normal{0};     // unit, towards the viewer; 0 where too few cells say it
        double depth = 0;   // of the plane at the cell, metres
        double relief = 0;  // mean square distance from it, in squares of the longer side of a cell
    };

    Vec3 start(int i, int j) const { return before_ + double(i - kMiddle) * right_ + double(j - kMiddle) * up_; }

    bool has_walls(const Vec3& from) const {
        int walls = 0;
        for (int k = 0; k < kAround; ++k) {
            const double a = 2 * std::numbers::pi * (k + 0.5) / kAround;
            walls += query_.ray(from, {std::cos(a), std::sin(a), 0}).has_value();
        }
        return walls >= kWalls;
    }

    bool is_mirrored(int i, int j) const {
        const Vec3 right = glm::normalize(right_);
        const double slack = kAlike * std::max(cell_.x, cell_.y) + kUncertain * noise_;
        const std::size_t here = index(i, j);
        for (int y = std::max(0, j - 1); y <= std::min(kCells - 1, j + 1); ++y)
            for (int x = std::max(0, i - 1); x <= std::min(kCells - 1, i + 1); ++x) {
                const std::size_t there = index(kCells - 1 - x, y);
                const Vec3& n = cells_[there].normal;
                const Vec3 image = n - 2 * glm::dot(n, right) * right;
                if (std::abs(depth_[here] - depth_[there]) <= slack &&
                    (cells_[here].seen == 0 || glm::dot(image, cells_[here].normal) >= kSameNormal))
                    return true;
            }
        return false;
    }

    double mirrored_part() const {
        std::size_t seen = 0, mirrored = 0;
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const int image = kCells - 1 - i;
                const bool hits = std::isfinite(depth_[index(i, j)]);
                if (!hits && !std::isfinite(depth_[index(image, j)])) continue;
                ++seen;
                mirrored += is_mirrored(hits ? i : image, j);
            }
        return seen == 0 ? 0 : static_cast<double>(mirrored) / static_cast<double>(seen);
    }

    /// Whether the surface is one between two neighbouring cells.
    bool joined(std::size_t a, std::size_t b, double cell) const {
        return std::isfinite(depth_[a]) && std::isfinite(depth_[b]) &&
               std::abs(depth_[a] - depth_[b]) <= kSteep * cell + slack_;
    }

    /// The cells within reach that the surface joins to one, itself first.
    std::vector<std::pair<int, int>> around(int i, int j) const {
        std::vector<std::pair<int, int>> members{{i, j}};
        std::array<bool, (2 * kMostReach + 1) * (2 * kMostReach + 1)> taken{};
        taken[taken.size() / 2] = true;
        for (std::size_t m = 0; m < members.size(); ++m) {
            const auto [x, y] = members[m];
            for (const auto& [u, v] : {std::pair{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
                if (u < 0 || v < 0 || u >= kCells || v >= kCells || std::abs(u - i) > reach_[0] ||
                    std::abs(v - j) > reach_[1])
                    continue;
                bool& known =
                    taken[static_cast<std::size_t>((v - j + kMostReach) * (2 * kMostReach + 1) + u - i + kMostReach)];
                if (known || !joined(index(x, y), index(u, v), v == y ? cell_.x : cell_.y)) continue;
                known = true;
                members.emplace_back(u, v);
            }
        }
        return members;
    }

    /// The plane through the cells around one, by least squares over their closed depths.
    Plane plane_at(int i, int j) const {
        const auto members = around(i, j);
        const double n = static_cast<double>(members.size());
        Vec3 mean{0};
        const auto point = [&](const std::pair<int, int>& m) {
            return Vec3((m.first - i) * cell_.x, (m.second - j) * cell_.y, depth_[index(m.first, m.second)]);
        };
        for (const auto& m : members) mean += point(m) / n;
        double xx = 0, xy = 0, yy = 0, xd = 0, yd = 0;
        for (const auto& m : members) {
            const Vec3 d = point(m) - mean;
            xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y, xd += d.x * d.z, yd += d.y * d.z;
        }
        const double det = xx * yy - xy * xy;
        if (!(det > 1e-6 * cell_.x * cell_.x * cell_.y * cell_.y)) return {};
        const double p = (xd * yy - yd * xy) / det, q = (yd * xx - xd * xy) / det;
        double square = 0;
        for (const auto& m : members) {
            const Vec3 d = point(m) - mean;
            const double off = mean.z + p * d.x + q * d.y - unclosed_[index(m.first, m.second)];
            square += off * off / (n * (1 + p * p + q * q));
        }
        const double cell = std::max(cell_.x, cell_.y);
        return {glm::normalize(p * glm::normalize(right_) + q * glm::normalize(up_) - look_),
                mean.z - p * mean.x - q * mean.y, square / (cell * cell)};
    }

    /// Depths of the rays. What is one or two rays wide, such as a shut line, is closed: a drawing is draped over it.
    void cast() {
        std::vector<double> depth(kCells * kCells, std::numeric_limits<double>::infinity());
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i)
                if (const auto at = hit(i, j); at && glm::dot(at->face_normal, look_) < 0)
                    depth[index(i, j)] = at->distance;
        depth_ = among_neighbours(among_neighbours(depth, false), true);
        unclosed_ = depth;
        for (std::size_t k = 0; k < depth.size(); ++k)
            unclosed_[k] = std::min(depth[k], depth_[k] + kGap * std::max(cell_.x, cell_.y));
    }

    /// Planes of all cells.
    std::vector<Plane> planes() const {
        std::vector<Plane> all(kCells * kCells);
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i)
                if (std::isfinite(depth_[index(i, j)])) all[index(i, j)] = plane_at(i, j);
        return all;
    }

    /// The relief that is usual: its lower quartile, in squares of the longer side of a cell.
    static double usual_relief(const std::vector<Plane>& all) {
        std::vector<double> relief;
        for (const Plane& plane : all)
            if (plane.normal != Vec3(0)) relief.push_back(plane.relief);
        if (relief.empty()) return 0;
        const auto quartile = relief.begin() + static_cast<std::ptrdiff_t>(relief.size() / 4);
        std::nth_element(relief.begin(), quartile, relief.end());
        return *quartile;
    }

    /// Smooths the depths, so that noise makes no steps. Returns the relief of each cell above the noise.
    std::vector<double> smooth() {
        noise_ = std::sqrt(usual_relief(planes())) * std::max(cell_.x, cell_.y);
        slack_ = kSlack * noise_;
        const std::vector<Plane> all = planes();
        slack_ = 0;
        const double usual = usual_relief(all);
        std::vector<double> above(all.size(), 0);
        for (std::size_t k = 0; k < all.size(); ++k) {
            if (all[k].normal == Vec3(0)) continue;
            above[k] = std::max(0.0, all[k].relief - kNoise * usual);
            depth_[k] = all[k].depth;
        }
        return above;
    }

    /// Which cells are free, and how rough the surface is there.
    void judge() {
        const std::vector<double> relief = smooth();
        const std::vector<Plane> all = planes();
        cells_.assign(kCells * kCells, Sum{});
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const std::size_t k = index(i, j);
                const Vec3& normal = all[k].normal;
                if (normal == Vec3(0)) {
                    cells_[k].bad = 1;
                    continue;
                }
                const bool steep = -glm::dot(normal, look_) < kTurned;
                const bool step = (i > 0 && !joined(k, k - 1, cell_.x)) || (j > 0 && !joined(k, k - kCells, cell_.y));
                cells_[k] = {steep || step ? 1.0 : 0.0, 1, normal};
            }
        if (inside_) need_walls();
        const Sums sums(cells_);
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i) {
                const Sum near = sums.over(i, j, reach_[0], reach_[1]);
                const std::size_t k = index(i, j);
                if (!(near.seen > 0)) continue;
                const double rough = 1 - glm::length(near.normal) / near.seen + relief[k];
                cells_[k].rough = rough + (rough > kFeature ? kAvoided : 0);
            }
    }

    /// Of the inside only what has walls around it is free; walls are higher than the noise.
    void need_walls() {
        const double above = kAbove * cell_.x + 3 * noise_;
        for (int j = 0; j < kCells; ++j)
            for (int i = 0; i < kCells; ++i)
                if (Sum& cell = cells_[index(i, j)]; cell.bad < 0.5)
                    cell.bad = !has_walls(start(i, j) + depth_[index(i, j)] * look_ + above * cell.normal);
    }

    const mesh::SurfaceQuery& query_;
    Vec3 look_, right_, up_, before_;
    Vec2 cell_;
    bool inside_;
    double symmetry_ = 0;
    std::array<int, 2> reach_{};    // over which the surface is smoothed: cells to each side, and up and down
    double noise_ = 0, slack_ = 0;  // usual distance from the plane, and what it adds to a step: metres
    std::vector<double> depth_;     // of the rays, metres; infinite where none hits
    std::vector<double> unclosed_;  // with gaps, at most kGap deep
    std::vector<Sum> cells_;
};

struct Rectangle {
    int i = 0, j = 0, hi = 0, hj = 0;
    double scale = 0;  // of the largest that the view holds
    double worth = 0;  // the scale, less where it is rough
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
        return {i, j, std::max(0, static_cast<int>(half.x + 1e-6)), std::max(0, static_cast<int>(half.y + 1e-6)), scale,
                0, {}};
    }
};

bool fits(const Sums& sums, Rectangle& r, const Vec3& look) {
    if (r.i < r.hi || r.j < r.hj || r.i + r.hi >= kCells || r.j + r.hj >= kCells) return false;
    const Sum sum = sums.over(r.i, r.j, r.hi, r.hj);
    if (sum.bad > 0.5 || sum.seen < 0.5) return false;
    r.normal = sum.normal / sum.seen;
    r.worth = r.scale / (1 + sum.rough / sum.seen / kRough);
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

/// Part of the most worth at which an area in the middle is taken. It has no step, so that noise decides little.
double centred_from(double symmetry) {
    const double lopsided = std::clamp((kSymmetric - symmetry) / (kSymmetric - kLopsided), 0.0, 1.0);
    return kCentred + lopsided * (1 - kCentred);
}

/// The rectangle that is worth most, with its centre in the columns `from` to `to`.
std::optional<Rectangle> best_rectangle(const View& view, const Sums& sums, const Shape& shape, int from, int to) {
    std::optional<Rectangle> best;
    for (double scale = 1; scale > kLeastScale && !(best && scale < best->worth); scale *= std::exp2(-0.25)) {
        std::vector<Rectangle> found;
        double most = 0;
        for (int j = 0; j < kCells; ++j)
            for (int i = from; i <= to; ++i)
                if (Rectangle r = shape.at(i, j, scale, view.cell()); fits(sums, r, view.look())) {
                    most = std::max(most, r.worth);
                    found.push_back(r);
                }
        if (!(most > (best ? best->worth : 0))) continue;
        std::erase_if(found, [&](const Rectangle& r) { return r.worth < kAsGood * most; });
        best = found[middle_one(found)];
        for (double larger = scale * 1.01; larger < scale * std::exp2(0.25); larger *= 1.01) {
            Rectangle r = shape.at(best->i, best->j, larger, view.cell());
            if (!fits(sums, r, view.look()) || r.worth < best->worth) break;
            best = r;
        }
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
    const Sums sums = view.sums();
    std::optional<Rectangle> best = best_rectangle(view, sums, shape, 0, kCells - 1);
    if (best && view.symmetry() > kLopsided)
        if (const auto middle = best_rectangle(view, sums, shape, kMiddle, kMiddle);
            middle && middle->worth >= centred_from(view.symmetry()) * best->worth)
            best = middle;
    if (!best) return {};
    // A ray into a shut line may meet nothing.
    std::optional<mesh::SurfacePoint> at;
    for (int k = 0; k <= 2 * kReach && !at; ++k) {
        const int off = k % 2 ? (k + 1) / 2 : -k / 2;
        at = view.hit(best->i + off, best->j);
    }
    if (!at) return {};
    return FreeArea{*at, glm::normalize(best->normal), Vec2(2 * best->hi + 1, 2 * best->hj + 1) * view.cell()};
}

}  // namespace tuft::stroke
