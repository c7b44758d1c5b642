#include "mesh/query/surface_query.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "mesh/ray_tree.h"

namespace tuft::mesh {
namespace {

/// Indices of the mesh's triangles by those of the tree; empty: the same.
using TriangleIds = std::vector<std::uint32_t>;

std::uint32_t id_of(const TriangleIds& ids, std::uint32_t primitive) {
    return ids.empty() ? primitive : ids[primitive];
}

struct Closest {
    const TriangleMesh* mesh = nullptr;
    const TriangleIds* ids = nullptr;
    Vec3 p{0};
    double slack = 0;  // metres: what rounding p to float can hide from the box tests
    double limit2 = 0;
    std::uint32_t triangle = kNone;
    double b1 = 0, b2 = 0, distance2 = 0;
};

/// Barycentric weights of the point of triangle (a, a + ab, a + ac) closest to `p`,
/// by the Voronoi regions of its corners and edges (Ericson, Real-Time Collision
/// Detection, 2005, section 5.1.5).
Vec2 closest_weights(const Vec3& a, const Vec3& ab, const Vec3& ac, const Vec3& p) {
    const Vec3 ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return {0, 0};
    const Vec3 bp = ap - ab;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
    const Vec3 cp = ap - ac;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {1 - w, w};
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return {0, 0};
    return {vb / sum, vc / sum};
}

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
    Closest& best = *static_cast<Closest*>(args->userPtr);
    const std::uint32_t t = id_of(*best.ids, args->primID);
    const Vec3 a = best.mesh->position(t, 0);
    const Vec3 ab = best.mesh->position(t, 1) - a;
    const Vec3 ac = best.mesh->position(t, 2) - a;
    const Vec2 b = closest_weights(a, ab, ac, best.p);
    const Vec3 d = a + b.x * ab + b.y * ac - best.p;
    const double distance2 = glm::dot(d, d);
    if (!(distance2 <= best.limit2)) return false;
    // Equal distances (shared edges and corners) go to the lower index, whatever the visit order.
    if (best.triangle != kNone && (distance2 > best.distance2 || (distance2 == best.distance2 && t > best.triangle)))
        return false;
    best.triangle = t;
    best.b1 = b.x;
    best.b2 = b.y;
    best.distance2 = distance2;
    const double radius = std::sqrt(distance2) * (1 + 1e-6) + best.slack;
    const float shrunk = static_cast<float>(radius);
    if (shrunk >= args->query->radius) return false;
    args->query->radius = shrunk;
    return true;
}

struct Nearest {
    const TriangleMesh* mesh = nullptr;
    const TriangleIds* ids = nullptr;
    Vec3 p{0};
    double slack = 0, limit = 0;
    std::size_t k = 0;
    std::vector<NearVertex> found;  // sorted; `normal` sums up twice the vector areas
};

/// A vertex at distance d belongs to triangles at distance d or less, so that walking the
/// triangles within the k-th best distance meets every triangle of every vertex kept.
bool visit_vertices(RTCPointQueryFunctionArguments* args) {
    Nearest& best = *static_cast<Nearest*>(args->userPtr);
    const std::uint32_t t = id_of(*best.ids, args->primID);
    const Vec3 a = best.mesh->position(t, 0);
    const Vec3 area = glm::cross(best.mesh->position(t, 1) - a, best.mesh->position(t, 2) - a);
    for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t v = best.mesh->triangles[t][corner];
        const auto known =
            std::find_if(best.found.begin(), best.found.end(), [&](const NearVertex& n) { return n.index == v; });
        if (known != best.found.end()) {
            known->normal += area;
            continue;
        }
        const Vec3 position = best.mesh->position(t, corner);
        const NearVertex candidate{v, glm::length(position - best.p), position, area};
        if (candidate.distance > best.limit) continue;
        const auto nearer = [](const NearVertex& x, const NearVertex& y) {
            return x.distance < y.distance || (x.distance == y.distance && x.index < y.index);
        };
        best.found.insert(std::upper_bound(best.found.begin(), best.found.end(), candidate, nearer), candidate);
        if (best.found.size() > best.k) best.found.pop_back();
    }
    if (best.found.size() < best.k) return false;
    const float shrunk = static_cast<float>(best.found.back().distance * (1 + 1e-6) + best.slack);
    if (shrunk >= args->query->radius) return false;
    args->query->radius = shrunk;
    return true;
}

/// Metres that rounding to single precision can hide from the box tests round p.
double rounding_slack(const TriangleMesh& mesh, const Vec3& p) {
    return 4e-7 * (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) + mesh.bounds.diagonal());
}

RTCPointQuery make_query(const Vec3& p, double radius) {
    RTCPointQuery query{};
    query.x = static_cast<float>(p.x);
    query.y = static_cast<float>(p.y);
    query.z = static_cast<float>(p.z);
    query.radius = static_cast<float>(radius);
    return query;
}

RTCRay make_ray(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tnear = t_min;
    ray.tfar = t_max;
    ray.mask = ~0u;
    return ray;
}

/// Embree asserts that rays stay below 1.8e18.
constexpr float kEmbreeLimit = 1e18f;

bool is_ray(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max) {
    return within(Vec3(origin), kEmbreeLimit) && within(Vec3(direction), kEmbreeLimit) && t_min <= t_max;
}

}  // namespace

namespace {

std::vector<std::array<std::uint32_t, 3>> some_triangles(const TriangleMesh& mesh, const TriangleIds& ids) {
    std::vector<std::array<std::uint32_t, 3>> some;
    some.reserve(ids.size());
    for (const std::uint32_t t : ids) some.push_back(mesh.triangles[t]);
    return some;
}

}  // namespace

struct SurfaceQuery::State {
    const TriangleMesh* mesh = nullptr;
    TriangleIds ids;
    std::vector<std::array<std::uint32_t, 3>> some;  ///< of `ids`; the tree reads them where they are
    RayTree tree;

    explicit State(const TriangleMesh& m) : mesh(&m), tree(m.positions, m.triangles) {}
    State(const TriangleMesh& m, TriangleIds of)
        : mesh(&m), ids(std::move(of)), some(some_triangles(m, ids)), tree(m.positions, some) {}
};

SurfaceQuery::SurfaceQuery(const TriangleMesh& mesh) : state_(std::make_unique<State>(mesh)) {}
SurfaceQuery::SurfaceQuery(const TriangleMesh& mesh, std::vector<std::uint32_t> triangles)
    : state_(std::make_unique<State>(mesh, std::move(triangles))) {}

SurfaceQuery::~SurfaceQuery() = default;
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;

std::optional<SurfacePoint> SurfaceQuery::closest_point(const Vec3& p, double max_distance) const {
    if (!within(p, kEmbreeLimit) || !(max_distance >= 0)) return std::nullopt;
    Closest best;
    best.mesh = state_->mesh;
    best.ids = &state_->ids;
    best.p = p;
    best.slack = rounding_slack(*state_->mesh, p);
    best.limit2 = max_distance * max_distance;

    RTCPointQuery query = make_query(p, max_distance * (1 + 1e-6) + best.slack);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(state_->tree.scene(), &query, &context, visit_triangle, &best);
    if (best.triangle == kNone) return std::nullopt;
    SurfacePoint s = surface_point(*state_->mesh, best.triangle, best.b1, best.b2);
    s.distance = std::sqrt(best.distance2);
    return s;
}

std::vector<NearVertex> SurfaceQuery::nearest_vertices(const Vec3& p, int k, double max_distance) const {
    if (!within(p, kEmbreeLimit) || k <= 0 || !(max_distance >= 0)) return {};
    Nearest best;
    best.mesh = state_->mesh;
    best.ids = &state_->ids;
    best.p = p;
    best.slack = rounding_slack(*state_->mesh, p);
    best.limit = max_distance;
    best.k = static_cast<std::size_t>(k);
    RTCPointQuery query = make_query(p, max_distance * (1 + 1e-6) + best.slack);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(state_->tree.scene(), &query, &context, visit_vertices, &best);
    for (NearVertex& v : best.found) {
        const double size = glm::length(v.normal);
        v.normal = size > 0 ? v.normal / size : Vec3{0, 0, 1};
    }
    return std::move(best.found);
}

std::optional<SurfacePoint> SurfaceQuery::ray(const Vec3& origin, const Vec3& direction, double t_min,
                                              double t_max) const {
    const RayHit hit = trace(Vec3f(origin), Vec3f(direction), static_cast<float>(t_min), static_cast<float>(t_max));
    if (hit.triangle == kNone) return std::nullopt;
    SurfacePoint s = surface_point(*state_->mesh, hit.triangle, hit.b1, hit.b2);
    s.distance = glm::dot(s.position - origin, direction);
    return s;
}

bool SurfaceQuery::occluded(const Vec3& origin, const Vec3& direction, double t_min, double t_max) const {
    return blocked(Vec3f(origin), Vec3f(direction), static_cast<float>(t_min), static_cast<float>(t_max));
}

RayHit SurfaceQuery::trace(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max) const {
    if (!is_ray(origin, direction, t_min, t_max)) return {};
    RTCRayHit rayhit{};
    rayhit.ray = make_ray(origin, direction, t_min, t_max);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(state_->tree.scene(), &context, &rayhit);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {id_of(state_->ids, rayhit.hit.primID), rayhit.hit.u, rayhit.hit.v, rayhit.ray.tfar};
}

bool SurfaceQuery::blocked(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max) const {
    if (!is_ray(origin, direction, t_min, t_max)) return false;
    RTCRay ray = make_ray(origin, direction, t_min, t_max);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(state_->tree.scene(), &context, &ray);
    return ray.tfar < 0;
}

const TriangleMesh& SurfaceQuery::mesh() const {
    return *state_->mesh;
}

}  // namespace tuft::mesh
