#include "cage.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tuft::models {

namespace {

constexpr double kCornerTurn = 35 * 0.017453292519943295;  ///< radians

Vec3 area_vector(const Cage& cage, const std::vector<std::uint32_t>& face) {
    Vec3 sum{0};
    const Vec3 o = cage.points[face[0]];
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
        sum += glm::cross(cage.points[face[k]] - o, cage.points[face[k + 1]] - o);
    return sum;
}

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

/// Edges of the region with no neighbour in the region: from → to, region on the left.
std::map<std::uint32_t, std::uint32_t> border_of(const Cage& cage, std::span<const std::uint32_t> faces) {
    std::set<DirectedEdge> edges;
    for (const std::uint32_t f : faces) {
        const auto& c = cage.faces[f];
        for (std::size_t k = 0; k < c.size(); ++k) edges.insert({c[k], c[(k + 1) % c.size()]});
    }
    std::map<std::uint32_t, std::uint32_t> next;
    for (const DirectedEdge& e : edges)
        if (!edges.contains({e.second, e.first})) next[e.first] = e.second;
    return next;
}

}  // namespace

std::uint32_t Cage::add_point(const Vec3& p) {
    points.push_back(p);
    return static_cast<std::uint32_t>(points.size() - 1);
}

std::uint32_t Cage::add_face(std::vector<std::uint32_t> corners) {
    faces.push_back(std::move(corners));
    return static_cast<std::uint32_t>(faces.size() - 1);
}

void Cage::crease(std::uint32_t a, std::uint32_t b, double sharp) {
    sharpness[{std::min(a, b), std::max(a, b)}] = sharp;
}

void carve(Cage& cage, std::span<const std::uint32_t> faces, const CarveBorder& style,
           std::span<const CarveLoop> loops) {
    std::map<std::uint32_t, std::uint32_t> next = border_of(cage, faces);
    std::map<std::uint32_t, Vec3> normal;  // of every vertex of the region
    for (const std::uint32_t f : faces)
        for (const std::uint32_t v : cage.faces[f])
            normal.try_emplace(v, Vec3{0}).first->second += area_vector(cage, cage.faces[f]);
    for (auto& [v, n] : normal) n = glm::normalize(n);

    struct Border {
        Vec3 point, normal, inward;
        bool corner;
    };
    std::map<std::uint32_t, Border> border;  // by the vertex that is the border now
    std::map<std::uint32_t, std::uint32_t> previous;
    for (const auto& [a, b] : next) previous[b] = a;
    for (const auto& [v, after] : next) {
        const Vec3 p = cage.points[v], n = normal[v];
        const Vec3 in0 = glm::normalize(glm::cross(n, p - cage.points[previous[v]]));
        const Vec3 in1 = glm::normalize(glm::cross(n, cage.points[after] - p));
        border[v] = {p, n, (in0 + in1) / std::max(0.5, 1 + glm::dot(in0, in1)),
                     glm::dot(in0, in1) < std::cos(kCornerTurn)};
    }
    for (const auto& [a, b] : next)
        if (style.sharp > 0) cage.crease(a, b, style.sharp);

    // Creases inside the region that end on its border: by the border vertex.
    std::map<std::uint32_t, std::pair<std::uint32_t, double>> arriving;
    for (const std::uint32_t f : faces) {
        const auto& c = cage.faces[f];
        for (std::size_t k = 0; k < c.size(); ++k) {
            std::uint32_t v = c[k], w = c[(k + 1) % c.size()];
            if (border.contains(w)) std::swap(v, w);
            if (!border.contains(v) || border.contains(w)) continue;
            const auto it = cage.sharpness.find(std::minmax(v, w));
            if (it != cage.sharpness.end()) arriving[v] = {w, it->second};
        }
    }

    for (const CarveLoop& loop : loops) {
        std::map<std::uint32_t, std::uint32_t> copy;
        for (const auto& [v, b] : border)
            copy[v] = cage.add_point(b.point + loop.inset * b.inward - loop.depth * b.normal);
        for (const std::uint32_t f : faces)
            for (std::uint32_t& v : cage.faces[f])
                if (const auto it = copy.find(v); it != copy.end()) v = it->second;
        std::map<std::uint32_t, std::uint32_t> moved_next;
        std::map<std::uint32_t, Border> moved_border;
        std::map<std::uint32_t, std::pair<std::uint32_t, double>> moved_arriving;
        for (const auto& [v, end] : arriving) {
            cage.crease(v, copy[v], end.second);
            cage.crease(copy[v], end.first, end.second);
            moved_arriving[copy[v]] = end;
        }
        arriving = std::move(moved_arriving);
        for (const auto& [a, b] : next) {
            cage.add_face({a, b, copy[b], copy[a]});
            if (border[a].corner && style.corner_sharp > 0) cage.crease(a, copy[a], style.corner_sharp);
            if (loop.sharp > 0) cage.crease(copy[a], copy[b], loop.sharp);
            moved_next[copy[a]] = copy[b];
            moved_border[copy[a]] = border[a];
        }
        next = std::move(moved_next);
        border = std::move(moved_border);
    }
    if (loops.empty() || loops.back().depth == 0) return;
    for (const auto& [v, n] : normal)
        if (!previous.contains(v)) cage.points[v] -= loops.back().depth * n;
}

Cage make_block(std::array<int, 3> n, const std::function<Vec3(const Vec3& unit)>& place) {
    Cage cage;
    std::map<std::array<int, 3>, std::uint32_t> index;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [it, is_new] = index.try_emplace(at, 0);
        if (is_new)
            it->second =
                cage.add_point(place({2.0 * at[0] / n[0] - 1, 2.0 * at[1] / n[1] - 1, 2.0 * at[2] / n[2] - 1}));
        return it->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const int side : {0, n[axis]}) {
            for (int a = 0; a < n[u]; ++a) {
                for (int b = 0; b < n[v]; ++b) {
                    std::vector<std::uint32_t> corners;
                    for (const auto& [da, db] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                        std::array<int, 3> at{};
                        at[axis] = side;
                        at[u] = a + da;
                        at[v] = b + db;
                        corners.push_back(vertex(at));
                    }
                    if (side == 0) std::reverse(corners.begin(), corners.end());
                    cage.add_face(std::move(corners));
                }
            }
        }
    }
    return cage;
}

Shape triangulate(const Cage& cage) {
    Shape shape;
    shape.points = cage.points;
    for (const auto& c : cage.faces) {
        const auto& p = cage.points;
        if (c.size() == 4) {
            const double ac = glm::length(p[c[2]] - p[c[0]]), bd = glm::length(p[c[3]] - p[c[1]]);
            if (ac <= bd * (1 + 1e-6)) {
                shape.triangles.push_back({c[0], c[1], c[2]});
                shape.triangles.push_back({c[0], c[2], c[3]});
            } else {
                shape.triangles.push_back({c[0], c[1], c[3]});
                shape.triangles.push_back({c[1], c[2], c[3]});
            }
            continue;
        }
        for (std::size_t k = 1; k + 1 < c.size(); ++k) shape.triangles.push_back({c[0], c[k], c[k + 1]});
    }
    return shape;
}

void append(Shape& shape, const Shape& part) {
    const auto first = static_cast<std::uint32_t>(shape.points.size());
    shape.points.insert(shape.points.end(), part.points.begin(), part.points.end());
    for (const auto& t : part.triangles) shape.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

Shape mirrored(const Shape& shape) {
    Shape result = shape;
    for (Vec3& p : result.points) p.y = -p.y;
    for (auto& t : result.triangles) std::swap(t[1], t[2]);
    return result;
}

}  // namespace tuft::models
