#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "core/random.h"
#include "mesh/repair/repair.h"

/// Meshes that are broken as files are: what reading and repair make of them is what the
/// atlas has to take.
namespace tuft::test {

using mesh::PolygonSoup;

inline void add_polygon(PolygonSoup& soup, const std::vector<std::uint32_t>& corners) {
    if (soup.polygon_start.empty()) soup.polygon_start.push_back(0);
    soup.corners.insert(soup.corners.end(), corners.begin(), corners.end());
    soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
}

inline std::vector<std::uint32_t> polygon(const PolygonSoup& soup, std::size_t p) {
    return {soup.corners.begin() + soup.polygon_start[p], soup.corners.begin() + soup.polygon_start[p + 1]};
}

inline void turn_over(PolygonSoup& soup, std::size_t p) {
    std::reverse(soup.corners.begin() + soup.polygon_start[p], soup.corners.begin() + soup.polygon_start[p + 1]);
}

inline std::uint32_t below(Random& random, std::size_t n) {
    return static_cast<std::uint32_t>(random.uniform() * static_cast<double>(n));
}

/// nu × nv quads with points of their own: `point`(u, v), u and v in [0, 1].
inline void add_grid(PolygonSoup& soup, int nu, int nv, const std::function<Vec3(double, double)>& point) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i) soup.points.push_back(point(double(i) / nu, double(j) / nv));
    const auto at = [&](int i, int j) { return first + std::uint32_t(j * (nu + 1) + i); };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) add_polygon(soup, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
}

/// A ball of quads and, at its poles, of quads without a side.
inline void add_ball(PolygonSoup& soup, const Vec3& centre, double radius, int n) {
    add_grid(soup, 2 * n, n, [&](double u, double v) {
        const double a = 2 * std::numbers::pi * u, b = std::numbers::pi * v;
        return centre + radius * Vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b));
    });
}

/// Faces there twice, three times, the other way round, and whole sheets on top of each other.
inline PolygonSoup doubled(Random& random) {
    PolygonSoup soup;
    add_ball(soup, Vec3(0), 1, 8);
    for (int i = 0; i < 120; ++i) {
        std::vector<std::uint32_t> face = polygon(soup, below(random, soup.n_polygons()));
        if (random.uniform() < 0.5) std::reverse(face.begin(), face.end());
        add_polygon(soup, face);
    }
    const double lift = random.uniform() < 0.5 ? 0 : 1e-7;
    for (int k = 0; k < 3; ++k) add_grid(soup, 5, 5, [&](double u, double v) { return Vec3(u, v, 2 + k * lift); });
    return soup;
}

/// Leaves of a book on one edge, crossed by a second book on another.
inline PolygonSoup books(Random& random) {
    PolygonSoup soup;
    for (int book = 0; book < 3; ++book) {
        const int leaves = 3 + static_cast<int>(random.uniform() * 9);
        for (int leaf = 0; leaf < leaves; ++leaf) {
            const double a = random.uniform(0, 2 * std::numbers::pi), bend = random.uniform(0, 0.5);
            add_grid(soup, 3, 6, [&](double u, double v) {
                const double b = a + bend * u * u;
                return Vec3(u * std::cos(b), u * std::sin(b), v + 0.5 * book);
            });
        }
    }
    return soup;
}

/// Cones tip to tip in one vertex, and sheets that touch in corners like a chessboard.
inline PolygonSoup bow_ties(Random& random) {
    PolygonSoup soup;
    soup.points.emplace_back(0, 0, 0);
    for (int cone = 0; cone < 5; ++cone) {
        const int n = 3 + static_cast<int>(random.uniform() * 12);
        const double open = random.uniform(0.05, 2);
        const Vec3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Vec3 x = glm::normalize(glm::cross(axis, Vec3(0.3, 0.5, 0.8))), y = glm::cross(axis, x);
        const auto base = static_cast<std::uint32_t>(soup.points.size());
        for (int i = 0; i < n; ++i) {
            const double a = 2 * std::numbers::pi * i / n;
            soup.points.push_back(axis + open * (std::cos(a) * x + std::sin(a) * y));
        }
        for (int i = 0; i < n; ++i) add_polygon(soup, {0, base + std::uint32_t(i), base + std::uint32_t((i + 1) % n)});
    }
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i)
            if ((i + j) % 2 == 0)
                add_grid(soup, 1, 1, [&](double u, double v) { return Vec3(2 + i + u, j + v, 0.1 * i * j); });
    return soup;
}

/// Balls inside each other with their faces turned at random.
inline PolygonSoup inside_out(Random& random) {
    PolygonSoup soup;
    for (int k = 0; k < 4; ++k) add_ball(soup, Vec3(0.1 * k, 0, 0), 1 - 0.2 * k, 6);
    for (std::size_t p = 0; p < soup.n_polygons(); ++p)
        if (random.uniform() < 0.4) turn_over(soup, p);
    return soup;
}

/// Quads collapsed to segments and points, collinear triangles, points a rounding apart.
inline PolygonSoup collapsed(Random& random) {
    PolygonSoup soup;
    add_grid(soup, 16, 16, [&](double u, double v) { return Vec3(u, v, 0.2 * std::sin(5 * u)); });
    for (int i = 0; i < 60; ++i) {
        const std::vector<std::uint32_t> face = polygon(soup, below(random, soup.n_polygons()));
        const std::size_t k = below(random, face.size()), l = (k + 1) % face.size();
        const Vec3 p = soup.points[face[k]];
        soup.points[face[l]] = random.uniform() < 0.5 ? p : p + 1e-7 * Vec3(random.uniform(), random.uniform(), 0);
        add_polygon(soup, {face[k], face[k], face[l]});
    }
    for (std::uint32_t i = 0; i + 2 < 17; ++i) add_polygon(soup, {i, i + 2, i + 1});
    return soup;
}

/// Patches whose sides have different numbers of points: T-junctions and hairline cracks.
inline PolygonSoup t_junctions(Random& random) {
    PolygonSoup soup;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const int n = 1 << static_cast<int>(random.uniform() * 4);
            const double crack = random.uniform() < 0.5 ? 0 : 1e-6;
            add_grid(soup, n, n, [&](double u, double v) {
                const double x = i + u, y = j + v;
                return Vec3(x + crack, y, 0.3 * std::sin(x) * std::cos(y));
            });
        }
    return soup;
}

/// A strip with an odd or even number of half turns, its ends glued by points that coincide.
inline PolygonSoup moebius(Random& random) {
    PolygonSoup soup;
    const int half_turns = 1 + static_cast<int>(random.uniform() * 5);
    const double width = random.uniform(0.05, 0.8);
    add_grid(soup, 60, 6, [&](double u, double v) {
        const double a = 2 * std::numbers::pi * (u == 1 ? 0 : u);
        // Where the strip closes after odd half turns, its sides change places.
        const double w = width * ((u == 1 && half_turns % 2 ? 1 - v : v) - 0.5);
        const double r = 1 + w * std::cos(0.5 * half_turns * a);
        return Vec3(r * std::cos(a), r * std::sin(a), w * std::sin(0.5 * half_turns * a));
    });
    return soup;
}

/// The figure-eight Klein bottle: closed, not orientable, through itself.
inline PolygonSoup klein_bottle(Random& random) {
    PolygonSoup soup;
    const double r = random.uniform(1.5, 4);
    add_grid(soup, 32, 16, [&](double u, double v) {
        const double a = 2 * std::numbers::pi * (u == 1 ? 0 : u);
        const double b = 2 * std::numbers::pi * (u == 1 ? std::fmod(1 - v, 1.0) : std::fmod(v, 1.0));
        const double x = r + std::cos(a / 2) * std::sin(b) - std::sin(a / 2) * std::sin(2 * b);
        return Vec3(x * std::cos(a), x * std::sin(a),
                    std::sin(a / 2) * std::sin(b) + std::cos(a / 2) * std::sin(2 * b));
    });
    return soup;
}

/// Steiner's Roman surface: a projective plane with lines of self-intersection.
inline PolygonSoup roman_surface(Random& random) {
    PolygonSoup soup;
    const double skew = random.uniform(0.2, 3);
    add_grid(soup, 24, 24, [&](double u, double v) {
        const double a = std::numbers::pi * u, b = std::numbers::pi * (v - 0.5);
        return Vec3(std::sin(2 * a) * std::cos(b) * std::cos(b), skew * std::sin(a) * std::sin(2 * b),
                    std::cos(a) * std::sin(2 * b));
    });
    return soup;
}

/// Several hundred components from 1e-4 to 1: tetrahedra, single triangles, pairs.
inline PolygonSoup crumbs(Random& random) {
    PolygonSoup soup;
    for (int i = 0; i < 120; ++i) {
        const double size = std::pow(10.0, random.uniform(-4, 0));
        const Vec3 at = 3.0 * Vec3(random.uniform(), random.uniform(), random.uniform());
        const auto b = static_cast<std::uint32_t>(soup.points.size());
        for (int k = 0; k < 4; ++k)
            soup.points.push_back(at + size * Vec3(random.uniform(), random.uniform(), random.uniform()));
        const std::uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        const std::size_t n = 1 + below(random, 4);
        for (std::size_t f = 0; f < n; ++f) add_polygon(soup, {b + faces[f][0], b + faces[f][1], b + faces[f][2]});
    }
    return soup;
}

/// A bent sheet so small or so large that squares of its lengths leave the range of floats;
/// the smallest are denormal floats in metres.
inline PolygonSoup out_of_scale(Random& random, double size) {
    PolygonSoup soup;
    const double bend = random.uniform(0, 1);
    add_grid(soup, 12, 12, [&](double u, double v) { return size * Vec3(u, v, bend * u * v); });
    return soup;
}

/// All triangles over a handful of points: every edge has many.
inline PolygonSoup everything(Random& random) {
    PolygonSoup soup;
    const std::uint32_t n = 6 + below(random, 5);
    for (std::uint32_t i = 0; i < n; ++i)
        soup.points.emplace_back(random.uniform(), random.uniform(), random.uniform());
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = i + 1; j < n; ++j)
            for (std::uint32_t k = j + 1; k < n; ++k) add_polygon(soup, {i, j, k});
    return soup;
}

/// A ball with a point torn a million radii away, and another onto its far side.
inline PolygonSoup thorns(Random& random) {
    PolygonSoup soup;
    add_ball(soup, Vec3(0), 1, 10);
    soup.points[below(random, soup.points.size())] *= 1e6;
    soup.points[below(random, soup.points.size())] *= -1;
    soup.points[below(random, soup.points.size())] *= 1e3;
    return soup;
}

/// A ball of which every third face is missing: rings, bridges, islands.
inline PolygonSoup cheese(Random& random) {
    PolygonSoup whole, soup;
    add_ball(whole, Vec3(0), 1, 14);
    soup.points = whole.points;
    for (std::size_t p = 0; p < whole.n_polygons(); ++p)
        if (random.uniform() < 0.67) add_polygon(soup, polygon(whole, p));
    return soup;
}

/// Polygons of many corners that are neither convex nor flat, some crossing themselves.
inline PolygonSoup wild_polygons(Random& random) {
    PolygonSoup soup;
    for (int i = 0; i < 10; ++i) {
        const int n = 4 + static_cast<int>(random.uniform() * 60);
        const double lift = random.uniform(0, 0.3), tangle = random.uniform() < 0.3 ? 2.0 : 0.0;
        std::vector<std::uint32_t> corners;
        for (int k = 0; k < n; ++k) {
            const double a = 2 * std::numbers::pi * k / n + tangle * random.uniform(), r = random.uniform(0.2, 1);
            corners.push_back(static_cast<std::uint32_t>(soup.points.size()));
            soup.points.emplace_back(3 * i + r * std::cos(a), r * std::sin(a), lift * random.uniform());
        }
        add_polygon(soup, corners);
    }
    return soup;
}

/// A thin tube knotted through itself, its radius falling to nothing and rising again.
inline PolygonSoup knot(Random& random) {
    PolygonSoup soup;
    const double wave = std::floor(random.uniform(1, 6));
    add_grid(soup, 90, 8, [&](double u, double v) {
        const double a = 2 * std::numbers::pi * u, b = 2 * std::numbers::pi * v;
        const double r = 0.9 * std::abs(std::sin(wave * a)) + 1e-6;
        const Vec3 c(std::sin(a) + 2 * std::sin(2 * a), std::cos(a) - 2 * std::cos(2 * a), -std::sin(3 * a));
        return c + r * Vec3(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
    });
    return soup;
}

/// A ball after some two hundred random injuries: corners joined to far points, fins, folds,
/// caps on edges, faces turned over.
inline PolygonSoup vandalised(Random& random) {
    PolygonSoup soup;
    add_ball(soup, Vec3(0), 1, 8);
    for (int i = 0; i < 200; ++i) {
        const std::size_t p = below(random, soup.n_polygons());
        const std::vector<std::uint32_t> face = polygon(soup, p);
        const std::uint32_t far = below(random, soup.points.size());
        switch (below(random, 6)) {
            case 0:
                soup.corners[below(random, soup.corners.size())] = far;
                break;
            case 1:
                soup.corners[soup.polygon_start[p]] = face[1];
                break;
            case 2:
                turn_over(soup, p);
                break;
            case 3:
                add_polygon(soup, {face[0], face[1], far});
                break;
            case 4:
                soup.points[far] = soup.points[face[0]];
                break;
            default:
                soup.points.push_back(0.5 * (soup.points[face[0]] + soup.points[face[1]]));
                add_polygon(soup, {face[0], static_cast<std::uint32_t>(soup.points.size() - 1), face[1]});
        }
    }
    return soup;
}

struct WreckedMesh {
    std::string name;
    PolygonSoup soup;
};

/// Seventy-two files, the same every time: eighteen kinds of damage, four of each.
inline std::vector<WreckedMesh> wrecked_meshes() {
    constexpr double kSizes[4] = {1e-3, 0.1, 1e3, 3e6};  // millimetres: the smallest and the largest there may be
    std::vector<WreckedMesh> files;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Random random(100 + seed);
        const auto add = [&](const std::string& name, PolygonSoup soup) {
            files.push_back({name + " " + std::to_string(seed), std::move(soup)});
        };
        add("doubled", doubled(random));
        add("books", books(random));
        add("bow-ties", bow_ties(random));
        add("inside out", inside_out(random));
        add("collapsed", collapsed(random));
        add("T-junctions", t_junctions(random));
        add("Moebius strip", moebius(random));
        add("Klein bottle", klein_bottle(random));
        add("Roman surface", roman_surface(random));
        add("crumbs", crumbs(random));
        add("out of scale", out_of_scale(random, kSizes[seed - 1]));
        add("everything", everything(random));
        add("thorns", thorns(random));
        add("cheese", cheese(random));
        add("wild polygons", wild_polygons(random));
        add("knot", knot(random));
        add("vandalised", vandalised(random));
        PolygonSoup all = vandalised(random);  // damage on damage
        for (int k = 0; k < 80; ++k) all.points[below(random, all.points.size())] = all.points[0];
        add("ruin", std::move(all));
    }
    return files;
}

}  // namespace tuft::test
