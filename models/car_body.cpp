#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <tuple>

#include "cage.h"
#include "car_design.h"
#include "car_parts.h"

namespace tuft::models {

namespace {

constexpr int kColumns = 2 * kMiddle;
constexpr int kFloorColumn = 5;  ///< the wheel houses reach in to this column

/// Sides of the box the cage lies on; the flanks are numbered with y falling.
enum Side { kNose, kTail, kLeft, kRight, kRoof };

/// The opening in `n` points (s, 0, z): half a circle `beyond` the arch, and below the axle
/// straight down to the floor, leaning out a little. The first and last step are short
/// and round off the sill.
std::vector<Vec3> draw_arch(const WheelDesign& w, double beyond, double z_first, double z_last, std::size_t n) {
    const double sill = 12;  // mm
    const double radius = w.arch_radius + beyond, half = std::numbers::pi * radius / 2;
    const double first = -half - (w.z - z_first), last = half + (w.z - z_last);
    const double step = (last - first - 2 * sill) / double(n - 3);
    // Subdivision pulls a polygon inwards: its corners stand outside the circle.
    const double grown = radius * 6 / (4 + 2 * std::cos(step / radius));
    std::vector<Vec3> points;
    for (std::size_t k = 0; k < n; ++k) {
        double at = first + sill + step * (double(k) - 1);
        if (k == 0) at = first;
        if (k + 1 == n) at = last;
        const double below = std::abs(at) - half;
        if (below > 0)
            points.emplace_back(w.s + std::copysign(radius + 0.05 * below, at), 0, w.z - below);
        else
            points.emplace_back(w.s + grown * std::sin(at / radius), 0, w.z + grown * std::cos(at / radius));
    }
    return points;
}

/// Builds the cage on the box, remembers which face is where, and carves.
class Body {
  public:
    explicit Body(const CarDesign& design) : design_(design) {}
    Cage build();

  private:
    using Corners = std::vector<std::uint32_t>;

    std::uint32_t vertex(int i, int j, int r);
    Vec3 place(const Vec3& p, bool right) const { return {0.5 * design_.length() - p.x, right ? -p.y : p.y, p.z}; }
    void add_grid();
    void add_floor();
    void add_arch(const WheelDesign& wheel, bool right);
    void close_wheel_house(const WheelDesign& wheel, const std::vector<Corners>& rings, bool right);
    /// A face of the left or right half; the right one is turned around.
    void add(Corners corners, bool right) {
        if (right) std::reverse(corners.begin(), corners.end());
        cage_.add_face(std::move(corners));
    }
    bool in_arch(int i, int r) const;

    /// The faces of side `side` with first index in [a0, a1) and second in [b0, b1).
    Corners region(Side side, int a0, int a1, int b0, int b1) const;
    void add_creases();
    void add_panels();
    void both(const std::function<void(bool right)>& make) {
        make(false);
        make(true);
    }

    const CarDesign& design_;
    Cage cage_;
    std::map<std::tuple<int, int, int>, std::uint32_t> vertices_;
    std::map<std::tuple<int, int, int>, std::uint32_t> faces_;  ///< by side and two indices
};

std::uint32_t Body::vertex(int i, int j, int r) {
    const auto [it, is_new] = vertices_.try_emplace({i, j, r}, 0);
    if (is_new) {
        const bool right = j > kMiddle;
        it->second = cage_.add_point(place(design_.point(i, right ? kColumns - j : j, r), right));
    }
    return it->second;
}

bool Body::in_arch(int i, int r) const {
    for (const WheelDesign& w : design_.wheels)
        if (i >= w.first_station && i < w.last_station && r < w.top_row) return true;
    return false;
}

void Body::add_grid() {
    const auto put = [&](Side side, int a, int b, Corners c) { faces_[{side, a, b}] = cage_.add_face(std::move(c)); };
    for (int r = 0; r < kTop; ++r) {
        for (int j = 0; j < kColumns; ++j) {
            put(kNose, j, r, {vertex(0, j + 1, r), vertex(0, j, r), vertex(0, j, r + 1), vertex(0, j + 1, r + 1)});
            const int n = kStations;
            put(kTail, j, r, {vertex(n, j, r), vertex(n, j + 1, r), vertex(n, j + 1, r + 1), vertex(n, j, r + 1)});
        }
        for (int i = 0; i < kStations; ++i) {
            if (in_arch(i, r)) continue;
            put(kLeft, i, r, {vertex(i, 0, r), vertex(i + 1, 0, r), vertex(i + 1, 0, r + 1), vertex(i, 0, r + 1)});
            const int m = kColumns;
            put(kRight, i, r, {vertex(i + 1, m, r), vertex(i, m, r), vertex(i, m, r + 1), vertex(i + 1, m, r + 1)});
        }
    }
    for (int i = 0; i < kStations; ++i)
        for (int j = 0; j < kColumns; ++j)
            put(kRoof, i, j,
                {vertex(i + 1, j + 1, kTop), vertex(i, j + 1, kTop), vertex(i, j, kTop), vertex(i + 1, j, kTop)});
}

/// The floor is flat: one strip in the middle and one beside it on each side.
void Body::add_floor() {
    const int q = kFloorColumn, m = kColumns;
    for (int i = 1; i < kStations; ++i) {
        Vec3 p = design_.point(i, 0, 0);
        p.y = 560;
        vertices_[{i, q, 0}] = cage_.add_point(place(p, false));
        vertices_[{i, m - q, 0}] = cage_.add_point(place(p, true));
    }
    for (int i = 0; i < kStations; ++i) {
        const auto strip = [&](int j0, int j1) {
            Corners c;
            const auto across = [&](int at, int from, int to) {
                const bool full = at == 0 || at == kStations;
                const int step = full ? (to > from ? 1 : -1) : to - from;
                for (int j = from; j != to + step; j += step) c.push_back(vertex(at, j, 0));
            };
            across(i, j0, j1);
            across(i + 1, j1, j0);
            cage_.add_face(std::move(c));
        };
        strip(q, m - q);
        if (in_arch(i, 0)) continue;
        strip(0, q);
        strip(m - q, m);
    }
}

void Body::add_arch(const WheelDesign& w, bool right) {
    struct Loop {
        double from_border;  ///< 0 on the panel's border, 1 on the arch
        double beyond;       ///< radius beyond the arch, mm
        double out;          ///< beyond the flank, mm
        double inner_y;      ///< where > 0: half width itself, mm
        double sharp;
    };
    constexpr Loop kLoops[] = {
        {0.5, 26, 0, 0, 0},  {1, 27, 0, 0, 1.5}, {1, 22, 5, 0, 1.5}, {1, 0, 7, 0, 2},
        {1, 0, -14, 0, 1.5}, {1, 12, 0, 760, 0}, {1, 12, 0, 565, 1},
    };
    const int side = right ? kColumns : 0;
    Corners ring;
    for (int r = 0; r < w.top_row; ++r) ring.push_back(vertex(w.first_station, side, r));
    for (int i = w.first_station; i <= w.last_station; ++i) ring.push_back(vertex(i, side, w.top_row));
    for (int r = w.top_row - 1; r >= 0; --r) ring.push_back(vertex(w.last_station, side, r));
    const std::size_t n = ring.size();
    std::vector<Vec3> border;  // in the design's frame
    for (const std::uint32_t v : ring) {
        const Vec3 p = cage_.points[v];
        border.push_back({0.5 * design_.length() - p.x, std::abs(p.y), p.z});
    }
    std::vector<Corners> rings{ring};
    for (const Loop& loop : kLoops) {
        const std::vector<Vec3> arch = draw_arch(w, loop.beyond, border.front().z, border.back().z, n);
        Corners next;
        for (std::size_t k = 0; k < n; ++k) {
            Vec3 p = glm::mix(border[k], arch[k], loop.from_border);
            p.y = loop.inner_y > 0 ? loop.inner_y : design_.flank_y(p.x, p.z) + loop.out;
            next.push_back(cage_.add_point(place(p, right)));
        }
        const Corners& last = rings.back();
        for (std::size_t k = 0; k + 1 < n; ++k) {
            add({last[k], next[k], next[k + 1], last[k + 1]}, right);
            if (loop.sharp > 0) cage_.crease(next[k], next[k + 1], loop.sharp);
        }
        rings.push_back(next);
    }
    close_wheel_house(w, rings, right);
}

/// The inner wall, a grid spanned by the last ring, and the floor around the opening.
void Body::close_wheel_house(const WheelDesign& w, const std::vector<Corners>& rings, bool right) {
    const Corners& inner = rings.back();
    const std::size_t n = inner.size();
    const int nu = w.last_station - w.first_station, nv = w.top_row;
    std::map<std::pair<int, int>, std::uint32_t> wall;
    for (int c = 0; c <= nu; ++c) {
        for (int r = 0; r <= nv; ++r) {
            const std::uint32_t front = inner[std::size_t(r)], back = inner[n - 1 - std::size_t(r)];
            if (c == 0)
                wall[{c, r}] = front;
            else if (c == nu)
                wall[{c, r}] = back;
            else if (r == nv)
                wall[{c, r}] = inner[std::size_t(nv + c)];
            else
                wall[{c, r}] = cage_.add_point(glm::mix(cage_.points[front], cage_.points[back], double(c) / nu));
        }
    }
    for (int c = 0; c < nu; ++c)
        for (int r = 0; r < nv; ++r)
            add({wall[{c, r}], wall[{c + 1, r}], wall[{c + 1, r + 1}], wall[{c, r + 1}]}, right);
    const int q = right ? kColumns - kFloorColumn : kFloorColumn;
    Corners before{vertex(w.first_station, q, 0)}, after{vertex(w.last_station, q, 0)};
    for (const Corners& r : rings) {
        before.push_back(r.front());
        after.push_back(r.back());
    }
    add(std::move(before), !right);
    add(std::move(after), right);
    for (int c = 0; c < nu; ++c)
        add({wall[{c + 1, 0}], wall[{c, 0}], vertex(w.first_station + c, q, 0), vertex(w.first_station + c + 1, q, 0)},
            right);
}

Body::Corners Body::region(Side side, int a0, int a1, int b0, int b1) const {
    Corners faces;
    for (int a = a0; a < a1; ++a)
        for (int b = b0; b < b1; ++b) faces.push_back(faces_.at({side, a, b}));
    return faces;
}

void Body::add_creases() {
    const auto along_ring = [&](int r, double sharp) {
        for (const int side : {0, kColumns})
            for (int i = 0; i < kStations; ++i) {
                const auto a = vertices_.find({i, side, r}), b = vertices_.find({i + 1, side, r});
                if (a != vertices_.end() && b != vertices_.end()) cage_.crease(a->second, b->second, sharp);
            }
    };
    along_ring(6, 1.7);  // character line
    along_ring(2, 1.2);  // sill
    along_ring(3, 0.8);
    for (const int i : {0, kStations})
        for (int j = 0; j < kColumns; ++j) {
            cage_.crease(vertex(i, j, 1), vertex(i, j + 1, 1), 1.5);
            if (i == 0) continue;
            cage_.crease(vertex(i, j, kTop), vertex(i, j + 1, kTop), 2);  // spoiler lip
            cage_.crease(vertex(i, j, 4), vertex(i, j + 1, 4), 1.5);      // bumper shelf
        }
    for (const int j : {7, kColumns - 7})  // the bonnet's power dome
        for (int i = 2; i < 11; ++i) cage_.crease(vertex(i, j, kTop), vertex(i + 1, j, kTop), 1.5);
}

void Body::add_panels() {
    const auto join = [](Corners a, const Corners& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    const int m = kColumns;
    const CarveBorder cut{.sharp = 2}, frame{.sharp = 2, .corner_sharp = 1.5};
    const CarveLoop shut_line[] = {{5, 10, 2}, {10, 0, 2}};
    const CarveLoop glass[] = {{4, 16, 2}, {20, 14, 1}};
    const CarveLoop intake[] = {{8, 40, 1.5}};
    // Bonnet and boot lid.
    carve(cage_, region(kRoof, 1, 11, 5, m - 5), cut, shut_line);
    carve(cage_, join(region(kRoof, 29, kStations, 6, m - 6), region(kTail, 6, m - 6, 5, kTop)), cut, shut_line);
    // Windscreen and rear window.
    carve(cage_, region(kRoof, 12, 16, 6, m - 6), frame, glass);
    carve(cage_, region(kRoof, 22, 28, 6, m - 6), frame, glass);
    both([&](bool right) {
        const Side flank = right ? kRight : kLeft;
        const auto roof = [&](int i0, int i1, int j0, int j1) {
            return right ? region(kRoof, i0, i1, m - j1, m - j0) : region(kRoof, i0, i1, j0, j1);
        };
        const auto end = [&](Side side, int j0, int j1, int r0, int r1) {
            return right ? region(side, m - j1, m - j0, r0, r1) : region(side, j0, j1, r0, r1);
        };
        carve(cage_, roof(13, 19, 2, 4), frame, glass);
        carve(cage_, roof(20, 25, 2, 4), frame, glass);
        carve(cage_, join(region(flank, 11, 20, 2, kTop), roof(11, 20, 0, 1)), cut, shut_line);
        const CarveLoop lamp[] = {{3, 24, 2}};
        const CarveLoop bulb[] = {{5, -9, 1.5}}, light_bar[] = {{11, -10, 1.5}};
        const CarveBorder base{.sharp = 1.5, .corner_sharp = 1};
        carve(cage_, join(end(kNose, 0, 5, 6, 7), region(flank, 0, 2, 6, 7)), frame, lamp);
        for (int j = 1; j < 5; ++j) carve(cage_, end(kNose, j, j + 1, 6, 7), base, bulb);
        carve(cage_, join(end(kNose, 0, 1, 6, 7), region(flank, 0, 2, 6, 7)), base, bulb);
        const Corners tail_lamp = join(end(kTail, 0, 5, 6, 7), region(flank, 31, kStations, 6, 7));
        carve(cage_, tail_lamp, frame, lamp);
        carve(cage_, tail_lamp, base, light_bar);
    });
    const CarveLoop grille[] = {{10, 8, 2}, {14, 45, 1.5}};
    carve(cage_, region(kNose, 6, m - 6, 3, 5), frame, grille);
    carve(cage_, region(kNose, 2, m - 2, 1, 2), frame, intake);
    const CarveLoop plate[] = {{8, 14, 2}};
    carve(cage_, region(kTail, 7, m - 7, 3, 4), frame, plate);
    carve(cage_, region(kTail, 3, m - 3, 1, 2), frame, intake);
}

Cage Body::build() {
    add_grid();
    add_floor();
    for (const WheelDesign& w : design_.wheels) both([&](bool right) { add_arch(w, right); });
    add_creases();
    add_panels();
    return std::move(cage_);
}

}  // namespace

Shape make_car_body(const CarDesign& design) {
    const Cage cage = Body(design).build();
    return triangulate(subdivide(cage, 2));
}

}  // namespace tuft::models
