#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "compositions.h"
#include "core/text/units.h"
#include "hand.h"

// A peony in underglaze blue on the vase's belly: outlines by a liner, then washes that fill them.
namespace tuft::samples {

namespace {

using Points = std::vector<Vec2>;

constexpr double kPi = std::numbers::pi;
constexpr double kLine = 0.55;    ///< mm, an outline where it is full
constexpr double kSpacing = 0.5;  ///< mm between the points of a curve
constexpr const char* kWash = "samples/inks/cobalt-wash.toml";
constexpr const char* kLiner = "liner-3";
constexpr const char* kWashBrush = "wash-12*0.35";

double length_of(const Points& points) {
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) length += glm::length(points[i] - points[i - 1]);
    return length;
}

/// Points at equal distances along a polyline.
Points resampled(const Points& points, double spacing) {
    Points out{points.front()};
    const int n = std::max(2, static_cast<int>(std::ceil(length_of(points) / spacing)));
    const double step = length_of(points) / n;
    double along = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double piece = glm::length(points[i] - points[i - 1]);
        while (static_cast<int>(out.size()) < n && along + piece >= step * static_cast<double>(out.size()))
            out.push_back(glm::mix(points[i - 1], points[i],
                                   (step * static_cast<double>(out.size()) - along) / std::max(piece, 1e-12)));
        along += piece;
    }
    out.push_back(points.back());
    return out;
}

/// Catmull–Rom curve through `keys`.
Points curve(const Points& keys) {
    const int n = static_cast<int>(keys.size());
    const auto key = [&](int i) { return keys[static_cast<std::size_t>(std::clamp(i, 0, n - 1))]; };
    Points dense;
    for (int i = 0; i < n - 1; ++i)
        for (int k = 0; k < 24; ++k) {
            const double t = k / 24.0;
            const Vec2 a = key(i - 1), b = key(i), c = key(i + 1), d = key(i + 2);
            dense.push_back(0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                                   t * t * t * (3.0 * b - a - 3.0 * c + d)));
        }
    dense.push_back(key(n - 1));
    return resampled(dense, kSpacing);
}

double distance(const Vec2& p, const Points& line) {
    double least = 1e9;
    for (const Vec2& q : line) least = std::min(least, glm::length(p - q));
    return least;
}

/// What lies `inset` inside a closed curve.
Points inside(const Points& outline, double inset) {
    double area = 0;
    for (std::size_t i = 1; i < outline.size(); ++i)
        area += outline[i - 1].x * outline[i].y - outline[i - 1].y * outline[i].x;
    Points kept;
    const std::size_t n = outline.size() - 1;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 along = glm::normalize(outline[(i + 1) % n] - outline[(i + n - 1) % n]);
        const Vec2 p = outline[i] + (area > 0 ? inset : -inset) * Vec2{-along.y, along.x};
        if (distance(p, outline) > 0.96 * inset) kept.push_back(p);
    }
    kept.push_back(kept.front());
    return resampled(kept, 2 * kSpacing);
}

/// What is filled by a wash: a curve from the foot round to the foot.
struct Area {
    Points outline;
    double width = 0;  ///< mm, of the brush's line
};

struct Peony : Series {
    /// A line of the liner that swells from nothing and runs out.
    void line(const char* name, const Points& points, double width) {
        Stroke stroke{name, {}};
        const double length = length_of(points);
        double along = 0;
        for (std::size_t i = 0; i < points.size(); i += 2) {
            const double from_end = std::min(along, length - along);
            stroke.keys.push_back(
                {points[i].x, points[i].y, width * std::min(1.0, from_end / std::max(2.5, 5 * width))});
            if (i + 2 < points.size())
                along += glm::length(points[i + 1] - points[i]) + glm::length(points[i + 2] - points[i + 1]);
        }
        stroke.keys.push_back({points.back().x, points.back().y, 0});
        add(stroke, kLiner, "cobalt", 0.04);
    }
    /// Once round inside the outline, then in a spiral to the middle: no row ends at the rim, where it would leave a
    /// scallop.
    void wash(const Area& area, std::vector<stroke::Preparation> before) {
        const double width = area.width;
        Points outline = area.outline;
        outline.push_back(outline.front());
        const Points rim = inside(resampled(outline, kSpacing), 0.5 * width + 0.1);
        Vec2 middle{0};
        double reach = 0;
        for (std::size_t i = 1; i < rim.size(); ++i) middle += rim[i] / static_cast<double>(rim.size() - 1);
        for (const Vec2& p : rim) reach = std::max(reach, glm::length(p - middle));
        const double shrink = 0.6 * width / reach;  // from one turn to the next
        Stroke stroke{"wash", {}};
        const std::size_t n = rim.size() - 1;
        for (std::size_t i = 0;; ++i) {
            const double turns = static_cast<double>(i) / static_cast<double>(n);
            const double size = 1 - shrink * std::max(0.0, turns - 1.1);
            if (size * reach < 0.7 * width) break;
            const Vec2 p = middle + size * (rim[i % n] - middle);
            stroke.keys.push_back({p.x, p.y, width * std::min(1.0, static_cast<double>(i) / 3)});
        }
        // Across what the tight turns leave in the middle.
        const double across = std::min(0.5 * width, 0.12 * reach);
        for (const Vec2& q : {Vec2(-1, 0), Vec2(1, 0.2), Vec2(0.2, -1), Vec2(-0.2, 1), Vec2(0, 0)})
            stroke.keys.push_back({middle.x + across * q.x, middle.y + across * q.y, q == Vec2(0) ? 0 : 1.2 * width});
        add(stroke, kWashBrush, kWash, 0.05, std::move(before));
    }
    /// Washes on what is dry.
    void coat(const std::vector<Area>& areas) {
        std::vector<stroke::Preparation> before{stroke::Dry{}};
        for (const Area& area : areas) wash(area, std::exchange(before, {}));
    }
};

/// Outline of a petal, from its foot round to its foot, with two lobes.
Points petal(const Vec2& heart, double turn, double foot, double length, double width) {
    const Vec2 u{std::cos(turn), std::sin(turn)}, v{-u.y, u.x};
    Points keys;
    const double half[][2] = {{0, 0.16}, {0.3, 0.33}, {0.62, 0.5}, {0.88, 0.42}, {1, 0.22}, {0.9, 0}};
    for (const auto& k : half) keys.push_back(heart + (foot + k[0] * (length - foot)) * u - k[1] * width * v);
    for (int i = 4; i >= 0; --i)
        keys.push_back(heart + (foot + half[i][0] * (length - foot)) * u + half[i][1] * width * v);
    return curve(keys);
}

/// A leaf: both sides from foot to point, and veins.
struct Leaf {
    double width = 0;  ///< mm
    Points near, far;
    std::vector<Points> veins;

    Points outline() const {
        Points out = near;
        out.insert(out.end(), far.rbegin() + 1, far.rend());
        return out;
    }
};
Leaf leaf(const Vec2& foot, double turn, double length, double width, double bend) {
    const Vec2 u{std::cos(turn), std::sin(turn)}, v{-u.y, u.x};
    const auto at = [&](double f, double side) {
        return foot + f * length * u + (bend * length * f * f + side * width) * v;
    };
    Leaf out{.width = width};
    out.near = curve({at(0, 0), at(0.15, -0.28), at(0.42, -0.5), at(0.75, -0.28), at(1, 0)});
    out.far = curve({at(0, 0), at(0.15, 0.28), at(0.42, 0.5), at(0.75, 0.28), at(1, 0)});
    out.veins.push_back(curve({at(0, 0), at(0.3, 0), at(0.6, 0), at(0.9, 0)}));
    for (const double f : {0.22, 0.42, 0.62})
        for (const double side : {-1.0, 1.0})
            out.veins.push_back(
                curve({at(f, 0), at(f + 0.1, 0.17 * side), at(f + 0.17, 0.7 * side * (0.5 - 0.55 * (f - 0.22)))}));
    return out;
}

}  // namespace

std::vector<stroke::RecordedStroke> blue_and_white() {
    Peony p{{{{0, -66.7 * kMillimetre, 118 * kMillimetre}, {1, 0, 0}, {0, 0, -1}, stroke::SurfaceMapping::wrap}}};
    const Vec2 heart{0, -14};
    const double foot = 5.2;
    std::vector<Points> petals, shades;
    for (int k = 0; k < 5; ++k) {
        const double turn = -kPi / 2 + 2 * kPi * k / 5;
        petals.push_back(petal(heart, turn, foot, 25, 21));
        shades.push_back(petal(heart, turn, foot + 0.6, 14, 12));
    }
    const Vec2 bud{26, 6};
    petals.push_back(petal(bud, -1.15, 0.6, 13, 10));
    std::vector<Leaf> leaves;
    const double placed[][5] = {{-1, 43, 2.75, 27, -0.14}, {0.6, 37, 0.62, 24, 0.1}, {-1.2, 30, -2.75, 20, -0.1}};
    for (const auto& l : placed) leaves.push_back(leaf({l[0], l[1]}, l[2], l[3], 0.42 * l[3], l[4]));

    for (const Points& outline : petals) p.line("outline", outline, kLine);
    for (int k = 0; k < 10; ++k) {  // stamens: a hair and its anther
        const double a = 2 * kPi * (k + 0.5) / 10, r = k % 2 ? 4.4 : 3.4;
        const Vec2 u{std::cos(a), std::sin(a)}, end = heart + r * u;
        p.line("stamen", curve({heart + 1.0 * u, heart + 0.6 * r * u, end}), 0.35 * kLine);
        const Vec2 in = end - 0.3 * u, out = end + 0.35 * u;
        p.add({"anther", {{in.x, in.y, 0}, {end.x, end.y, 0.95, 0.5}, {out.x, out.y, 0}}}, "wolf-small*0.6", "cobalt",
              0.02);
    }
    p.line("stem", curve({{-0.2, 9}, {1, 20}, {0.6, 30}, {-1, 42}, {-5, 54}}), 1.3);
    p.line("stem", curve({{0.9, 28}, {9, 21}, {19, 15}, {25.6, 6.6}}), 0.9);
    for (const Leaf& l : leaves) {
        p.line("outline", l.near, kLine);
        p.line("outline", l.far, kLine);
        for (const Points& vein : l.veins) p.line("vein", vein, 0.6 * kLine);
    }
    // Two coats: the feet of the petals and the leaves are deeper.
    std::vector<Area> once, twice;
    for (const Points& outline : petals) once.push_back({outline, 2.8});
    for (const Points& outline : shades) twice.push_back({outline, 2.2});
    for (const Leaf& l : leaves)
        for (auto* coat : {&once, &twice}) coat->push_back({l.outline(), std::min(2.2, 0.22 * l.width)});
    p.coat(once);
    p.coat(twice);
    return std::move(p.out);
}

}  // namespace tuft::samples
