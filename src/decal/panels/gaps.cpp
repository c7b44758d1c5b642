#include "decal/panels/gaps.h"

#include <queue>

#include "atlas/seams/half_edges.h"
#include "core/system/parallel.h"
#include "mesh/query/surface_query.h"

namespace tuft::decal {
namespace {

constexpr double kTouch = 0.95;   // of the radius: a ball on a faceted surface comes a little nearer to it
constexpr double kFacing = -0.3;  // cosine between the normals of walls that face each other, at most
constexpr double kOff = 1e-6;     // metres from a triangle to where its ray begins

enum class Reach : std::uint8_t { open, narrow, wall };

Vec3 middle_of(const mesh::TriangleMesh& mesh, std::uint32_t t) {
    return (mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)) / 3.0;
}

Vec3 normal_of(const mesh::TriangleMesh& mesh, std::uint32_t t) {
    const Vec3 a = mesh.position(t, 0);
    const Vec3 n = glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a);
    const double length = glm::length(n);
    return length > 0 ? n / length : Vec3(0);
}

/// `facing`: gets the triangle of the film on the other wall, where the nearest surface there is film.
Reach reach_of(const mesh::SurfaceQuery& query, const mesh::SurfaceQuery& on_film, std::uint32_t t,
               std::uint32_t& facing) {
    const mesh::TriangleMesh& mesh = on_film.mesh();
    const Vec3 middle = middle_of(mesh, t), normal = normal_of(mesh, t);
    if (normal == Vec3(0)) return Reach::narrow;  // neither wall nor open
    constexpr double kRadius = 0.5 * kBridgedGap;
    if (!query.closest_point(middle + kRadius * normal, kTouch * kRadius)) return Reach::open;
    const auto hit = query.ray(middle + kOff * normal, normal, 0, kBridgedGap);
    if (!hit || glm::dot(normal_of(query.mesh(), hit->triangle), normal) >= kFacing) return Reach::narrow;
    facing = on_film.trace(Vec3f(middle + kOff * normal), Vec3f(normal), 0, static_cast<float>(hit->distance + kOff))
                 .triangle;
    return facing == kNone ? Reach::narrow : Reach::wall;
}

/// Numbers the parts of the film within which triangles of one panel are connected other than over open ones.
std::vector<std::uint32_t> narrow_parts(const FilmMesh& film, const std::vector<Reach>& reach,
                                        const std::vector<std::uint32_t>& twin) {
    std::vector<std::uint32_t> part(reach.size(), kNone), ahead;
    for (std::uint32_t first = 0; first < reach.size(); ++first) {
        if (part[first] != kNone || reach[first] == Reach::open) continue;
        part[first] = first;
        ahead.push_back(first);
        while (!ahead.empty()) {
            const std::uint32_t t = ahead.back();
            ahead.pop_back();
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                if (twin[h] == kNone) continue;
                const std::uint32_t next = twin[h] / 3;
                if (part[next] != kNone || reach[next] == Reach::open || film.label[next] != film.label[t]) continue;
                part[next] = first;
                ahead.push_back(next);
            }
        }
    }
    return part;
}

}  // namespace

std::vector<std::uint8_t> find_gaps(const mesh::TriangleMesh& model, const FilmMesh& film) {
    const auto n = static_cast<std::uint32_t>(film.mesh.n_triangles());
    const mesh::SurfaceQuery query(model), on_film(film.mesh);
    std::vector<Reach> reach(n);
    std::vector<std::uint32_t> facing(n, kNone);
    parallel_for(n, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t)
            reach[t] = reach_of(query, on_film, static_cast<std::uint32_t>(t), facing[t]);
    });
    const std::vector<std::uint32_t> twin = atlas::twin_half_edges(film.mesh), part = narrow_parts(film, reach, twin);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (std::uint32_t t = 0; t < n; ++t)
        if (reach[t] == Reach::wall && part[facing[t]] == part[t]) queue.emplace(0, t);
    std::vector<std::uint8_t> in_gap(n, 0);
    while (!queue.empty()) {
        const auto [distance, t] = queue.top();
        queue.pop();
        if (in_gap[t]) continue;
        in_gap[t] = 1;
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
            if (twin[h] == kNone) continue;
            const std::uint32_t next = twin[h] / 3;
            if (in_gap[next] || reach[next] == Reach::open) continue;
            const double far = distance + glm::length(middle_of(film.mesh, next) - middle_of(film.mesh, t));
            if (far <= 0.5 * kBridgedGap) queue.emplace(far, next);
        }
    }
    return in_gap;
}

}  // namespace tuft::decal
