#include "mesh/repair/surface_topology.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <span>

#include "core/system/parallel.h"

namespace tuft::mesh {
namespace {

/// Positions and connectivity only: corner data stays in plain arrays beside it.
struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3f;
    VertexAttributes(0);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
    EdgeAttributes(0);
    FaceAttributes(0);
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

constexpr double kFloatStep = 1.2e-7;  // relative spacing of float numbers

/// Flat as far as float coordinates can tell: a flip may make it sound.
bool is_flat_to_rounding(const RawMesh& mesh, std::size_t t) {
    const std::array<Vec3, 3> p = points_of(mesh, t);
    double largest = 0;
    for (const Vec3& q : p) largest = std::max({largest, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    const Shape s = shape_of(p);
    return s.height <= std::max(kFlat * s.longest, kFloatStep * largest);
}

/// One triangle's corner at a vertex, on the way round it.
struct Spoke {
    std::size_t corner = 0;
    Vec3 normal{0};             ///< of the triangle
    double angle = 0;           ///< at the vertex, radians
    bool after_crease = false;  ///< a crease or the border lies before it
};

/// Gives the corners of each run of spokes between creases the run's mean normal.
void average_runs(std::span<Spoke> spokes, std::vector<Vec3f>& normals) {
    const auto first = std::find_if(spokes.begin(), spokes.end(), [](const Spoke& s) { return s.after_crease; });
    if (first != spokes.end()) std::rotate(spokes.begin(), first, spokes.end());
    for (std::size_t begin = 0, end = 0; begin < spokes.size(); begin = end) {
        Vec3 sum(0);
        do {
            sum += spokes[end].angle * spokes[end].normal;
            ++end;
        } while (end < spokes.size() && !spokes[end].after_crease);
        const double length = glm::length(sum);
        for (std::size_t i = begin; i < end; ++i)
            normals[spokes[i].corner] = Vec3f(length > 1e-6 ? sum / length : spokes[i].normal);
    }
}

VertexHandle vertex(std::uint32_t v) {
    return VertexHandle(static_cast<int>(v));
}
FaceHandle face(std::size_t t) {
    return FaceHandle(static_cast<int>(t));
}
std::uint32_t index(const auto& handle) {
    return static_cast<std::uint32_t>(handle.idx());
}

}  // namespace

struct SurfaceTopology::State {
    HalfEdgeMesh mesh;

    /// Half-edge from corner k to corner k + 1: a face's own half-edge starts at corner 0.
    HalfedgeHandle half_edge(std::size_t t, int k) const {
        const HalfedgeHandle first = mesh.halfedge_handle(face(t));
        return k == 0 ? first : k == 1 ? mesh.next_halfedge_handle(first) : mesh.prev_halfedge_handle(first);
    }
    /// Corner of its triangle at which h starts.
    std::size_t corner(HalfedgeHandle h) const {
        const FaceHandle f = mesh.face_handle(h);
        const HalfedgeHandle first = mesh.halfedge_handle(f);
        const std::size_t k = h == first ? 0 : mesh.next_halfedge_handle(first) == h ? 1 : 2;
        return 3 * static_cast<std::size_t>(f.idx()) + k;
    }
    /// The next half-edge that starts at the same vertex, counter-clockwise.
    HalfedgeHandle turn_left(HalfedgeHandle h) const {
        return mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(h));
    }

    void link_faces(const RawMesh& raw);
    void link_borders();
    Vec3 point(HalfedgeHandle h) const;
    bool is_hub(HalfedgeHandle h) const;
    void fan(std::size_t v, double cos_crease, const std::vector<Vec3f>& face_normals,
             std::vector<Spoke>& spokes) const;
    bool flip_flat(std::size_t t, RawMesh& raw);
};

// The links are set directly: the pairing is known to be manifold, while add_face would search
// for it again, and refuse some orders of faces on the way to a sound whole.
void SurfaceTopology::State::link_faces(const RawMesh& raw) {
    const std::size_t n = raw.triangles.size();
    std::size_t n_edges = 0;
    for (std::uint32_t h = 0; h < 3 * n; ++h)
        if (raw.opposite[h] == kNone || raw.opposite[h] > h) ++n_edges;
    mesh.reserve(raw.positions.size(), n_edges, n);
    for (const Vec3f& p : raw.positions) mesh.add_vertex({p.x, p.y, p.z});
    std::vector<HalfedgeHandle> handle(3 * n);
    for (std::uint32_t h = 0; h < 3 * n; ++h) {
        const std::uint32_t o = raw.opposite[h];
        handle[h] = o == kNone || o > h ? mesh.new_edge(vertex(raw.start(h)), vertex(raw.end(h)))
                                        : mesh.opposite_halfedge_handle(handle[o]);
    }
    for (std::uint32_t t = 0; t < n; ++t) {
        const FaceHandle f = mesh.new_face();
        mesh.set_halfedge_handle(f, handle[3 * t]);
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
            mesh.set_face_handle(handle[h], f);
            mesh.set_next_halfedge_handle(handle[h], handle[next_half(h)]);
            mesh.set_halfedge_handle(vertex(raw.start(h)), handle[h]);
        }
    }
}

void SurfaceTopology::State::link_borders() {
    // A vertex has one fan, so at most one border half-edge leaves it; OpenMesh wants a border
    // vertex to know that one.
    for (const auto h : mesh.halfedges())
        if (mesh.is_boundary(h)) mesh.set_halfedge_handle(mesh.from_vertex_handle(h), h);
    for (const auto h : mesh.halfedges())
        if (mesh.is_boundary(h)) mesh.set_next_halfedge_handle(h, mesh.halfedge_handle(mesh.to_vertex_handle(h)));
}

SurfaceTopology::SurfaceTopology(const RawMesh& mesh) : state_(std::make_unique<State>()) {
    state_->link_faces(mesh);
    state_->link_borders();
}

SurfaceTopology::~SurfaceTopology() = default;

/// Whether so many edges meet at the start of h that a search through them is too costly.
bool SurfaceTopology::State::is_hub(HalfedgeHandle h) const {
    constexpr int kMaxValence = 1000;
    HalfedgeHandle at = h;
    for (int k = 0; k < kMaxValence; ++k) {
        at = mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(at));
        if (at == h) return false;
    }
    return true;
}

bool SurfaceTopology::State::flip_flat(std::size_t t, RawMesh& raw) {
    const Shape before = shape_of(points_of(raw, t));
    const HalfedgeHandle h = half_edge(t, before.longest_side);
    const auto edge = mesh.edge_handle(h);
    const HalfedgeHandle over = mesh.opposite_halfedge_handle(h);
    if (mesh.is_boundary(over) || is_hub(mesh.prev_halfedge_handle(h)) || is_hub(mesh.prev_halfedge_handle(over)) ||
        !mesh.is_flip_ok(edge))
        return false;
    // a, c: the long side; b: the corner that lies on it; d: the far corner of the neighbour.
    const std::size_t ca = corner(h), cb = corner(mesh.prev_halfedge_handle(h));
    const std::size_t cc = corner(over), cd = corner(mesh.prev_halfedge_handle(over));
    const std::size_t ca_over = corner(mesh.next_halfedge_handle(over));
    const auto vertex_at = [&](std::size_t c) { return raw.triangles[c / 3][c % 3]; };
    const std::array<std::uint32_t, 4> v{vertex_at(ca), vertex_at(cb), vertex_at(cc), vertex_at(cd)};
    std::array<Vec3, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = Vec3(raw.positions[v[k]]);
    const Shape s1 = shape_of({p[0], p[3], p[1]}), s2 = shape_of({p[3], p[2], p[1]});
    const Vec3 n_over = glm::cross(p[0] - p[2], p[3] - p[2]);
    const Vec3 n1 = glm::cross(p[3] - p[0], p[1] - p[0]), n2 = glm::cross(p[2] - p[3], p[1] - p[3]);
    const bool better = std::min(s1.height, s2.height) > 2 * before.height;
    if (!better || glm::dot(n1, n_over) <= 0 || glm::dot(n2, n_over) <= 0) return false;

    const std::size_t other = cc / 3;
    std::array<Vec2f, 4> uv{};
    if (!raw.uvs.empty()) {
        const Vec3 side = p[2] - p[0];
        const auto along = static_cast<float>(glm::dot(p[1] - p[0], side) / glm::dot(side, side));
        uv = {raw.uvs[ca_over], glm::mix(raw.uvs[ca_over], raw.uvs[cc], along), raw.uvs[cc], raw.uvs[cd]};
    }
    std::array<Vec3f, 4> normal{};
    if (!raw.normals.empty()) normal = {raw.normals[ca_over], raw.normals[cb], raw.normals[cc], raw.normals[cd]};
    if (!raw.groups.empty()) raw.groups[t] = raw.groups[other];
    mesh.flip(edge);
    for (const std::size_t f : {t, other})
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t at = index(mesh.from_vertex_handle(half_edge(f, k)));
            raw.triangles[f][static_cast<std::size_t>(k)] = at;
            const auto which = static_cast<std::size_t>(std::find(v.begin(), v.end(), at) - v.begin());
            const std::size_t c = 3 * f + static_cast<std::size_t>(k);
            if (!raw.uvs.empty()) raw.uvs[c] = uv[which];
            if (!raw.normals.empty()) raw.normals[c] = normal[which];
        }
    return true;
}

std::size_t SurfaceTopology::turn_flat_triangles(RawMesh& raw) {
    constexpr int kRounds = 8;  // chains of flat triangles peel from their ends
    std::vector<std::size_t> flat;
    for (std::size_t t = 0; t < raw.triangles.size(); ++t)
        if (is_flat_to_rounding(raw, t)) flat.push_back(t);
    std::size_t turned = 0;
    for (int round = 0; round < kRounds && !flat.empty(); ++round) {
        std::vector<std::size_t> again;
        std::size_t done = 0;
        for (const std::size_t t : flat)
            if (state_->flip_flat(t, raw))
                ++done;
            else
                again.push_back(t);
        turned += done;
        if (done == 0) break;
        flat = std::move(again);
    }
    if (turned) raw.opposite.clear();
    return turned;
}

std::size_t SurfaceTopology::n_components() const {
    const HalfEdgeMesh& mesh = state_->mesh;
    std::vector<bool> reached(mesh.n_faces(), false);
    std::vector<FaceHandle> stack;
    std::size_t components = 0;
    for (const auto seed : mesh.faces()) {
        if (reached[index(seed)]) continue;
        ++components;
        reached[index(seed)] = true;
        stack.push_back(seed);
        while (!stack.empty()) {
            const FaceHandle f = stack.back();
            stack.pop_back();
            HalfedgeHandle h = mesh.halfedge_handle(f);
            for (int k = 0; k < 3; ++k, h = mesh.next_halfedge_handle(h)) {
                const FaceHandle over = mesh.opposite_face_handle(h);
                if (!over.is_valid() || reached[index(over)]) continue;
                reached[index(over)] = true;
                stack.push_back(over);
            }
        }
    }
    return components;
}

std::size_t SurfaceTopology::n_border_edges() const {
    std::size_t n = 0;
    for (const auto h : state_->mesh.halfedges())
        if (state_->mesh.is_boundary(h)) ++n;
    return n;
}

std::size_t SurfaceTopology::n_border_loops() const {
    const HalfEdgeMesh& mesh = state_->mesh;
    std::vector<bool> seen(mesh.n_halfedges(), false);
    std::size_t loops = 0;
    for (const auto first : mesh.halfedges()) {
        if (seen[index(first)] || !mesh.is_boundary(first)) continue;
        ++loops;
        for (HalfedgeHandle h = first; !seen[index(h)]; h = mesh.next_halfedge_handle(h)) seen[index(h)] = true;
    }
    return loops;
}

std::vector<std::uint32_t> SurfaceTopology::neighbours() const {
    const HalfEdgeMesh& mesh = state_->mesh;
    std::vector<std::uint32_t> out(3 * mesh.n_faces(), kNone);
    for (std::size_t t = 0; t < mesh.n_faces(); ++t)
        for (int k = 0; k < 3; ++k) {
            const FaceHandle over = mesh.opposite_face_handle(state_->half_edge(t, k));
            if (over.is_valid()) out[3 * t + static_cast<std::size_t>(k)] = index(over);
        }
    return out;
}

Vec3 SurfaceTopology::State::point(HalfedgeHandle h) const {
    const auto& p = mesh.point(mesh.from_vertex_handle(h));
    return {p[0], p[1], p[2]};
}

/// The triangles around vertex v, counter-clockwise; `spokes` is filled anew.
void SurfaceTopology::State::fan(std::size_t v, double cos_crease, const std::vector<Vec3f>& face_normals,
                                 std::vector<Spoke>& spokes) const {
    spokes.clear();
    const HalfedgeHandle own = mesh.halfedge_handle(vertex(static_cast<std::uint32_t>(v)));
    // A border vertex's own half-edge is the border, which the fan begins right after.
    const bool open = mesh.is_boundary(own);
    const HalfedgeHandle start = open ? turn_left(own) : own;
    HalfedgeHandle h = start;
    do {
        const Vec3 a = glm::normalize(point(mesh.next_halfedge_handle(h)) - point(h));
        const Vec3 b = glm::normalize(point(mesh.prev_halfedge_handle(h)) - point(h));
        Spoke s;
        s.corner = corner(h);
        s.normal = Vec3(face_normals[s.corner / 3]);
        s.angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        s.after_crease = !spokes.empty() && glm::dot(spokes.back().normal, s.normal) < cos_crease;
        spokes.push_back(s);
        h = turn_left(h);
    } while (h != start && !mesh.is_boundary(h));
    spokes[0].after_crease = open || glm::dot(spokes.back().normal, spokes[0].normal) < cos_crease;
}

std::vector<Vec3f> SurfaceTopology::corner_normals(double crease_angle) const {
    const State& state = *state_;
    const double cos_crease = std::cos(crease_angle);
    constexpr std::size_t kGrain = 4096;
    std::vector<Vec3f> face_normals(state.mesh.n_faces());
    parallel_for(face_normals.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const HalfedgeHandle h = state.half_edge(t, 0);
            const Vec3 a = state.point(h), b = state.point(state.half_edge(t, 1));
            const Vec3 c = state.point(state.half_edge(t, 2));
            face_normals[t] = Vec3f(glm::normalize(glm::cross(b - a, c - a)));
        }
    });
    std::vector<Vec3f> normals(3 * face_normals.size());
    parallel_for(state.mesh.n_vertices(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<Spoke> spokes;
        for (std::size_t v = begin; v < end; ++v) {
            state.fan(v, cos_crease, face_normals, spokes);
            average_runs(spokes, normals);
        }
    });
    return normals;
}

}  // namespace tuft::mesh
