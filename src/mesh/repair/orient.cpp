#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "mesh/repair/exposure.h"
#include "mesh/repair/half_edges.h"

namespace tuft::mesh {
namespace {

/// A piece of surface held together by edges.
struct Component {
    std::vector<std::uint32_t> faces;  ///< in the order they were reached
    std::size_t n_turned = 0;          ///< against the first face
    bool closed = true;
    double volume = 0;  ///< signed, in the file's own winding of the first face, m³
    Box bounds;
};

/// Whether the triangles of h and its opposite run along the edge in opposite directions.
bool agrees(const RawMesh& mesh, std::uint32_t h) {
    return mesh.start(h) != mesh.start(mesh.opposite[h]);
}

double six_volumes(const RawMesh& mesh, std::uint32_t t, const Vec3& origin) {
    const auto p = [&](int k) { return Vec3(mesh.positions[mesh.triangles[t][k]]) - origin; };
    return glm::dot(p(0), glm::cross(p(1), p(2)));
}

Component grow(const RawMesh& mesh, std::uint32_t seed, std::vector<bool>& reached, std::vector<bool>& turned) {
    Component c;
    reached[seed] = true;
    c.faces.push_back(seed);
    const Vec3 origin(mesh.positions[mesh.triangles[seed][0]]);
    for (std::size_t i = 0; i < c.faces.size(); ++i) {
        const std::uint32_t t = c.faces[i];
        if (turned[t]) ++c.n_turned;
        c.volume += (turned[t] ? -1 : 1) * six_volumes(mesh, t, origin);
        for (int k = 0; k < 3; ++k) c.bounds.add(Vec3(mesh.positions[mesh.triangles[t][k]]));
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
            if (mesh.opposite[h] == kNone) {
                c.closed = false;
                continue;
            }
            const std::uint32_t other = mesh.opposite[h] / 3;
            if (reached[other]) continue;
            reached[other] = true;
            turned[other] = turned[t] == agrees(mesh, h);
            c.faces.push_back(other);
        }
    }
    return c;
}

/// Opens every edge at which no choice of sides can agree.
std::size_t cut_disagreeing(RawMesh& mesh, const std::vector<bool>& turned, std::vector<bool>& face_cut) {
    std::size_t cut = 0;
    for (std::uint32_t h = 0; h < mesh.opposite.size(); ++h) {
        const std::uint32_t o = mesh.opposite[h];
        if (o == kNone || o < h || agrees(mesh, h) == (turned[h / 3] == turned[o / 3])) continue;
        mesh.opposite[h] = mesh.opposite[o] = kNone;
        mark_opened(mesh, h);
        face_cut[h / 3] = face_cut[o / 3] = true;
        ++cut;
    }
    return cut;
}

bool crosses(const RawMesh& mesh, std::uint32_t t, const Vec3& from, const Vec3& direction) {
    const Vec3 a(mesh.positions[mesh.triangles[t][0]]);
    const Vec3 e1 = Vec3(mesh.positions[mesh.triangles[t][1]]) - a;
    const Vec3 e2 = Vec3(mesh.positions[mesh.triangles[t][2]]) - a;
    const Vec3 q = glm::cross(direction, e2);
    const double det = glm::dot(e1, q);
    if (det == 0) return false;
    const Vec3 s = from - a;
    const double u = glm::dot(s, q) / det;
    const Vec3 r = glm::cross(s, e1);
    const double v = glm::dot(direction, r) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && glm::dot(e2, r) / det > 0;
}

bool contains(const Box& box, const Vec3& p) {
    return glm::all(glm::greaterThanEqual(p, box.lo)) && glm::all(glm::lessThanEqual(p, box.hi));
}

/// Whether the component lies inside an odd number of the other closed ones, by the parity of a
/// ray's crossings. `budget` bounds the triangles looked at; when it is used up the answer is no.
bool is_cavity(const RawMesh& mesh, const std::vector<Component>& components, std::size_t self, std::size_t& budget) {
    // A direction that no modelled edge or plane is likely to share.
    const Vec3 direction = glm::normalize(Vec3(0.5377, 0.8339, -0.3188));
    Vec3 from(0);
    for (int k = 0; k < 3; ++k) from += Vec3(mesh.positions[mesh.triangles[components[self].faces[0]][k]]) / 3.0;
    bool inside = false;
    for (std::size_t i = 0; i < components.size(); ++i) {
        const Component& other = components[i];
        if (budget == 0) return false;
        --budget;
        if (i == self || !other.closed || !contains(other.bounds, from)) continue;
        if (budget < other.faces.size()) return budget = 0, false;
        budget -= other.faces.size();
        for (const std::uint32_t t : other.faces)
            if (crosses(mesh, t, from, direction)) inside = !inside;
    }
    return inside;
}

double area_of(const RawMesh& mesh, const Component& c) {
    double area = 0;
    for (const std::uint32_t t : c.faces) {
        const std::array<Vec3, 3> p = points_of(mesh, t);
        area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    }
    return area;
}

/// Whether a component with these exposures is inside out; nothing where they do not say.
std::optional<bool> is_inside_out(const Exposure& seen) {
    constexpr double kFarMore = 2.5, kLeast = 0.05;
    if (std::max(seen.front, seen.back) < kLeast) return std::nullopt;
    if (seen.back >= kFarMore * seen.front) return true;
    if (seen.front >= kFarMore * seen.back) return false;
    return std::nullopt;
}

/// Which open components are inside out, given the faces that are turned to agree with their majority.
std::vector<bool> find_inside_out(const RawMesh& mesh, const std::vector<Component>& components,
                                  const std::vector<bool>& turned) {
    constexpr std::size_t kMostRays = 1'000'000;
    constexpr double kNearlyAll = 0.9;
    std::vector<bool> inside_out(components.size(), false);
    const auto n_open = static_cast<std::size_t>(
        std::count_if(components.begin(), components.end(), [](const Component& c) { return !c.closed; }));
    if (n_open == 0) return inside_out;
    const ExposureProbe probe(mesh);
    const int rays = static_cast<int>(std::clamp<std::size_t>(kMostRays / n_open, 32, 1024));
    std::vector<std::size_t> unknown;
    double known_area = 0, turned_area = 0;
    for (std::size_t i = 0; i < components.size(); ++i) {
        if (components[i].closed) continue;
        const std::optional<bool> known = is_inside_out(probe.of(components[i].faces, turned, rays));
        if (!known) {
            unknown.push_back(i);
            continue;
        }
        const double area = area_of(mesh, components[i]);
        known_area += area;
        if (*known) turned_area += area;
        inside_out[i] = *known;
    }
    if (known_area > 0 && turned_area >= kNearlyAll * known_area)
        for (const std::size_t i : unknown) inside_out[i] = true;
    return inside_out;
}

/// Which components are to be turned as a whole, given the sides relative to their first face.
std::vector<bool> choose_sides(const RawMesh& mesh, const std::vector<Component>& components) {
    std::vector<bool> flip(components.size());
    std::size_t budget = 200'000'000;
    for (std::size_t i = 0; i < components.size(); ++i) {
        const Component& c = components[i];
        const bool majority_turned = 2 * c.n_turned > c.faces.size();
        flip[i] = majority_turned;
        if (!c.closed || c.volume == 0) continue;
        const bool outward = (c.volume > 0) != majority_turned;
        const bool consistent = c.n_turned == 0 || c.n_turned == c.faces.size();
        if (outward) continue;
        flip[i] = !(consistent && is_cavity(mesh, components, i, budget)) != majority_turned;
    }
    return flip;
}

void turn(RawMesh& mesh, const std::vector<bool>& turned) {
    // Exchanging corners 1 and 2 exchanges half-edges 0 and 2.
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!turned[t]) continue;
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        std::swap(mesh.opposite[3 * t], mesh.opposite[3 * t + 2]);
        if (!mesh.uvs.empty()) std::swap(mesh.uvs[3 * t + 1], mesh.uvs[3 * t + 2]);
        if (mesh.normals.empty()) continue;
        std::swap(mesh.normals[3 * t + 1], mesh.normals[3 * t + 2]);
        for (std::size_t c = 3 * std::size_t{t}; c < 3 * std::size_t{t} + 3; ++c) mesh.normals[c] = -mesh.normals[c];
    }
    for (std::uint32_t& o : mesh.opposite)
        if (o != kNone && turned[o / 3]) o = 3 * (o / 3) + 2 - o % 3;
}

}  // namespace

OrientationReport orient(RawMesh& mesh, OpenSides sides) {
    OrientationReport report;
    const std::size_t n = mesh.triangles.size();
    std::vector<bool> reached(n, false), turned(n, false), face_cut(n, false);
    std::vector<Component> components;
    for (std::uint32_t t = 0; t < n; ++t)
        if (!reached[t]) components.push_back(grow(mesh, t, reached, turned));
    report.edges_cut = cut_disagreeing(mesh, turned, face_cut);
    if (report.edges_cut)
        for (Component& c : components)
            for (const std::uint32_t t : c.faces)
                if (face_cut[t]) c.closed = false;
    const std::vector<bool> flip = choose_sides(mesh, components);
    for (std::size_t i = 0; i < components.size(); ++i)
        for (const std::uint32_t t : components[i].faces) {
            turned[t] = turned[t] != flip[i];
            if (turned[t]) ++report.faces_flipped;
        }
    bool any = report.faces_flipped > 0;
    if (sides != OpenSides::file) {
        std::vector<bool> inside_out(components.size(), true);
        if (sides == OpenSides::outward) inside_out = find_inside_out(mesh, components, turned);
        for (std::size_t i = 0; i < components.size(); ++i) {
            if (components[i].closed || !inside_out[i]) continue;
            any = true;
            if (sides == OpenSides::outward) ++report.parts_turned;
            for (const std::uint32_t t : components[i].faces) turned[t] = !turned[t];
        }
    }
    if (any) turn(mesh, turned);
    return report;
}

}  // namespace tuft::mesh
