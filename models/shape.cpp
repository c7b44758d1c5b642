#include "shape.h"

#include <numeric>
#include <set>
#include <utility>

namespace tuft::models {

std::string solid_defect(const Shape& shape) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::vector<std::uint32_t> parent(shape.points.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const auto& t : shape.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (!edges.insert({t[k], t[(k + 1) % 3]}).second) return "an edge has too many faces";
            parent[root(t[k])] = root(t[(k + 1) % 3]);
        }
    }
    for (const auto& [a, b] : edges)
        if (!edges.contains({b, a})) return "an edge has one face only";
    std::vector<double> volume(shape.points.size(), 0);
    for (const auto& t : shape.triangles)
        volume[root(t[0])] += glm::dot(shape.points[t[0]], glm::cross(shape.points[t[1]], shape.points[t[2]])) / 6;
    for (std::uint32_t v = 0; v < parent.size(); ++v)
        if (parent[v] == v && !(volume[v] > 0)) return "a component is inside out or a loose point";
    return "";
}

void rest_on_ground(Shape& shape) {
    Box box;
    for (const Vec3& p : shape.points) box.add(p);
    const Vec3 base{box.centre().x, box.centre().y, box.lo.z};
    for (Vec3& p : shape.points) p -= base;
}

}  // namespace tuft::models
