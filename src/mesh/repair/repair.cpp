#include "mesh/repair/repair.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "mesh/read/text_cursor.h"
#include "mesh/repair/half_edges.h"
#include "mesh/repair/surface_topology.h"
#include "mesh/repair/triangulate.h"
#include "mesh/repair/weld.h"

namespace tuft::mesh {
namespace {

/// Points further apart than this part of the model's diagonal stay apart.
constexpr double kWeldTolerance = 1e-6;
constexpr double kShortestEdge = 1e-8;  // of the size: a sixth of the rounding of coordinates as large as the model

void check_soup(const PolygonSoup& soup) {
    const bool sound = (soup.polygon_start.empty()
                            ? soup.corners.empty()
                            : soup.polygon_start.front() == 0 && soup.polygon_start.back() == soup.corners.size()) &&
                       std::is_sorted(soup.polygon_start.begin(), soup.polygon_start.end()) &&
                       (soup.corner_uvs.empty() || soup.corner_uvs.size() == soup.corners.size()) &&
                       (soup.corner_normals.empty() || soup.corner_normals.size() == soup.corners.size()) &&
                       (soup.point_colours.empty() || soup.point_colours.size() == soup.points.size()) &&
                       (soup.polygon_groups.empty() || soup.polygon_groups.size() == soup.n_polygons()) &&
                       (soup.polygon_parts.empty() || (soup.scene && soup.polygon_parts.size() == soup.n_polygons() &&
                                                       soup.polygon_groups.size() == soup.n_polygons())) &&
                       (soup.materials.empty() ||
                        soup.materials.size() == (soup.polygon_groups.empty() ? 1 : soup.group_names.size()));
    if (!sound) throw Error("the mesh's polygon arrays do not fit each other");
    for (const std::uint32_t part : soup.polygon_parts)
        if (part >= soup.scene->parts.size()) throw Error("a polygon is in a part that does not exist");
    for (const std::uint32_t c : soup.corners)
        if (c >= soup.points.size()) throw Error(Message("a polygon uses point {} of {}", c, soup.points.size()));
}

void check_size(const Box& bounds) {
    if (!(bounds.diagonal() >= kSmallestModel)) throw Error("the mesh is smaller than a micrometre; say its unit");
}

class Repair {
  public:
    Repair(PolygonSoup soup, const RepairOptions& options) : soup_(std::move(soup)), options_(options) {}

    Surface run();

  private:
    void take_points();
    void weld();
    void count_parts();
    void report_lost_parts(const TriangleMesh& mesh);
    void cut_polygons();
    void cut_polygon(std::size_t p, EarBudget& budget);
    void add_triangle(std::size_t p, std::size_t c0, std::size_t c1, std::size_t c2);
    void match();
    bool close_cracks();
    void make_manifold();
    bool drop_flat();
    void compact();
    void take_file_normals(std::vector<Vec3f>& normals) const;
    Surface hand_out(const SurfaceTopology& topology);

    PolygonSoup soup_;
    RepairOptions options_;
    RepairReport report_;
    RawMesh mesh_;                                           ///< its groups are parts where the soup has parts
    std::vector<std::uint32_t> part_faces_, group_of_part_;  ///< by part, or by group
    double size_ = 0;                                        ///< diagonal of the bounds, metres
    PairingReport pairs_;                                    ///< the last pairing
    std::vector<std::uint32_t> ring_;                        ///< scratch: corners of one polygon
    std::vector<Vec3> ring_points_;
    std::vector<std::array<std::uint32_t, 3>> cuts_;
};

/// Scales to metres in float, the precision everything after works with.
void Repair::take_points() {
    report_.file.points = soup_.points.size();
    report_.file.polygons = soup_.n_polygons();
    report_.warnings = std::move(soup_.warnings);
    report_.file.loose_triangles = soup_.points.size() == soup_.corners.size() && soup_.n_polygons() > 1;
    Box bounds;
    double largest = 0;
    mesh_.positions.reserve(soup_.points.size());
    for (const Vec3& p : soup_.points) {
        const Vec3 q = (options_.y_up ? Vec3(p.x, -p.z, p.y) : p) * options_.metres_per_unit;
        const double reach = std::abs(q.x) + std::abs(q.y) + std::abs(q.z);
        if (!within(q))
            throw Error(
                "the mesh has points that lie more than 10 km from the origin; say its unit, or "
                "move it there");
        mesh_.positions.emplace_back(q);
        bounds.add(q);
        largest = std::max(largest, reach);
    }
    if (!soup_.points.empty()) check_size(bounds);
    size_ = bounds.diagonal();
    soup_.points = {};
    mesh_.colours = std::move(soup_.point_colours);
    // Float coordinates keep 1e-5 of the size out to this distance from the origin.
    if (largest > 150 * bounds.diagonal())
        report_.warnings.push_back(
            "the model lies far from the origin compared with its size; move it there to keep "
            "its detail");
}

void Repair::count_parts() {
    const bool parts = !soup_.polygon_parts.empty();
    const std::vector<std::uint32_t>& part = parts ? soup_.polygon_parts : soup_.polygon_groups;
    for (std::size_t p = 0; p < part.size(); ++p) {
        if (part[p] >= part_faces_.size()) part_faces_.resize(part[p] + 1);
        ++part_faces_[part[p]];
    }
    if (!parts) return;
    group_of_part_.resize(part_faces_.size());
    for (std::size_t p = 0; p < part.size(); ++p) group_of_part_[part[p]] = soup_.polygon_groups[p];
}

/// Names the parts of the file of which no face is left.
void Repair::report_lost_parts(const TriangleMesh& mesh) {
    std::vector<bool> is_left(part_faces_.size(), false);
    if (!part_faces_.empty())
        for (std::size_t t = 0; t < mesh.n_triangles(); ++t) is_left[part_of(mesh, t)] = true;
    constexpr std::size_t kMostNames = 5;
    std::string names;
    std::size_t n = 0, n_faces = 0;
    for (std::size_t i = 0; i < part_faces_.size(); ++i) {
        if (is_left[i] || part_faces_[i] == 0) continue;
        n_faces += part_faces_[i];
        if (++n > kMostNames) continue;
        const bool in_scene = mesh.scene && i < mesh.scene->parts.size();
        std::string name = in_scene ? mesh.scene->parts[i].object : "";
        if (name.empty() && !mesh.triangle_groups.empty())
            name = mesh.group_names[group_of_part_.empty() ? i : group_of_part_[i]];
        names += (n > 1 ? ", " : "") + in_quotes(name);
    }
    if (n == 0) return;
    if (n > kMostNames) names += ", ...";
    report_.warnings.push_back(Message(n == 1 ? "{} part of the file has no face left ({}): all of its {} faces are "
                                                "without an area or lie on faces of other parts"
                                              : "{} parts of the file have no face left ({}): all of their {} faces "
                                                "are without an area or lie on faces of other parts",
                                       n, names, n_faces));
}

void Repair::weld() {
    std::vector<bool> used(mesh_.positions.size(), false);
    for (const std::uint32_t c : soup_.corners) used[c] = true;
    std::vector<std::uint32_t> target = weld_exact(mesh_.positions);
    if (!report_.file.loose_triangles)  // whose cracks are closed later
        weld_short_edges(mesh_.positions, soup_.corners, soup_.polygon_start, kShortestEdge * size_, target);
    for (std::size_t i = 0; i < target.size(); ++i) {
        if (!used[i]) ++report_.unused_vertices_dropped;
        if (used[i] && target[i] != i) ++report_.vertices_welded;
    }
    if (report_.vertices_welded)
        for (std::uint32_t& c : soup_.corners) c = target[c];
}

void Repair::add_triangle(std::size_t p, std::size_t c0, std::size_t c1, std::size_t c2) {
    const std::array<std::uint32_t, 3> v{soup_.corners[c0], soup_.corners[c1], soup_.corners[c2]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
        ++report_.degenerate_faces_dropped;
        return;
    }
    mesh_.triangles.push_back(v);
    if (!soup_.polygon_parts.empty())
        mesh_.groups.push_back(soup_.polygon_parts[p]);
    else if (!soup_.polygon_groups.empty())
        mesh_.groups.push_back(soup_.polygon_groups[p]);
    if (!soup_.corner_uvs.empty())
        for (const std::size_t c : {c0, c1, c2}) mesh_.uvs.push_back(soup_.corner_uvs[c]);
    if (soup_.corner_normals.empty()) return;
    for (const std::size_t c : {c0, c1, c2}) {
        const Vec3f& n = soup_.corner_normals[c];
        mesh_.normals.push_back(options_.y_up ? Vec3f(n.x, -n.z, n.y) : n);
    }
}

void Repair::cut_polygon(std::size_t p, EarBudget& budget) {
    const std::uint32_t begin = soup_.polygon_start[p], end = soup_.polygon_start[p + 1];
    ring_.clear();
    for (std::uint32_t c = begin; c < end; ++c)
        if (ring_.empty() || soup_.corners[ring_.back()] != soup_.corners[c]) ring_.push_back(c);
    while (ring_.size() > 1 && soup_.corners[ring_.front()] == soup_.corners[ring_.back()]) ring_.pop_back();
    if (ring_.size() < 3) {
        ++report_.degenerate_faces_dropped;
        return;
    }
    ++report_.file.polygons_triangulated;
    ring_points_.clear();
    for (const std::uint32_t c : ring_) ring_points_.push_back(Vec3(mesh_.positions[soup_.corners[c]]));
    cuts_.clear();
    triangulate(ring_points_, budget, cuts_);
    for (const auto& [a, b, c] : cuts_) add_triangle(p, ring_[a], ring_[b], ring_[c]);
}

void Repair::cut_polygons() {
    EarBudget budget;
    budget.tests += 100 * soup_.corners.size();
    mesh_.triangles.reserve(soup_.corners.size() - 2 * soup_.n_polygons());
    for (std::size_t p = 0; p < soup_.n_polygons(); ++p) {
        const std::size_t begin = soup_.polygon_start[p], end = soup_.polygon_start[p + 1];
        if (end - begin == 3)
            add_triangle(p, begin, begin + 1, begin + 2);
        else if (end - begin > 3)
            cut_polygon(p, budget);
        else
            ++report_.degenerate_faces_dropped;
    }
    if (budget.ran_out) report_.warnings.push_back("a polygon is too intricate to be cut well; it became a fan");
    soup_.corners = {};
    soup_.polygon_start = {};
    soup_.corner_uvs = {};
    soup_.corner_normals = {};
    soup_.polygon_groups = {};
    soup_.polygon_parts = {};
}

void Repair::match() {
    mesh_.at_split_edge.clear();
    pairs_ = pair_half_edges(mesh_);
    report_.duplicate_faces_dropped += pairs_.duplicates_dropped;
}

/// Triangles that came without shared points may miss each other by a rounding: points on the
/// border that lie within the tolerance of each other become one. Inner points never move.
bool Repair::close_cracks() {
    std::vector<bool> on_border(mesh_.positions.size(), false);
    std::vector<float> lengths;
    Box bounds;
    for (std::uint32_t h = 0; h < mesh_.opposite.size(); ++h) {
        const Vec3f &a = mesh_.positions[mesh_.start(h)], &b = mesh_.positions[mesh_.end(h)];
        bounds.add(Vec3(a));
        if (mesh_.opposite[h] != kNone) continue;
        on_border[mesh_.start(h)] = on_border[mesh_.end(h)] = true;
        lengths.push_back(glm::distance(a, b));
    }
    if (lengths.empty()) return false;
    std::vector<std::uint32_t> border, target(mesh_.positions.size());
    for (std::uint32_t v = 0; v < target.size(); ++v) {
        target[v] = v;
        if (on_border[v]) border.push_back(v);
    }
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    // A stray point far away must not make the tolerance larger than the details.
    const double tolerance = std::min(kWeldTolerance * bounds.diagonal(), 0.01 * double{*middle});
    weld_near(mesh_.positions, border, tolerance, target);
    std::size_t welded = 0;
    for (std::size_t v = 0; v < target.size(); ++v)
        if (target[v] != v) ++welded;
    if (welded == 0) return false;
    report_.crack_vertices_welded = welded;
    std::vector<bool> keep(mesh_.triangles.size(), true);
    for (std::size_t t = 0; t < keep.size(); ++t) {
        auto& v = mesh_.triangles[t];
        for (std::uint32_t& corner : v) corner = target[corner];
        keep[t] = v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
        if (!keep[t]) ++report_.degenerate_faces_dropped;
    }
    keep_triangles(mesh_, keep);
    return true;
}

/// From paired triangles to a manifold whose numbering says so.
void Repair::make_manifold() {
    const OrientationReport sides = orient(mesh_, options_.sides);
    options_.sides = OpenSides::file;  // chosen once
    report_.faces_flipped += sides.faces_flipped;
    report_.parts_turned += sides.parts_turned;
    if (sides.edges_cut)
        report_.warnings.push_back(
            Message("a part has only one side (like a Möbius strip); it was cut open along {} edges", sides.edges_cut));
    report_.non_manifold.vertices_split += split_vertices(mesh_);
    if (pairs_.needs_settling || sides.edges_cut) settle(mesh_);
}

/// Drops what no flip could give an area.
bool Repair::drop_flat() {
    std::vector<bool> keep(mesh_.triangles.size(), true);
    std::size_t dropped = 0;
    for (std::size_t t = 0; t < keep.size(); ++t) {
        keep[t] = !is_flat(mesh_, t);
        if (!keep[t]) ++dropped;
    }
    if (!dropped) return false;
    report_.degenerate_faces_dropped += dropped;
    keep_triangles(mesh_, keep);
    return true;
}

/// Drops vertices that no triangle uses; the others keep their order.
void Repair::compact() {
    std::vector<std::uint32_t> new_index(mesh_.positions.size(), kNone);
    for (const auto& t : mesh_.triangles)
        for (const std::uint32_t v : t) new_index[v] = 0;
    std::uint32_t n = 0;
    for (std::size_t v = 0; v < new_index.size(); ++v) {
        if (new_index[v] == kNone) continue;
        mesh_.positions[n] = mesh_.positions[v];
        if (!mesh_.colours.empty()) mesh_.colours[n] = mesh_.colours[v];
        new_index[v] = n++;
    }
    mesh_.positions.resize(n);
    if (!mesh_.colours.empty()) mesh_.colours.resize(n);
    for (auto& t : mesh_.triangles)
        for (std::uint32_t& v : t) v = new_index[v];
}

/// Where the file's surface says them, and not against the triangle.
void Repair::take_file_normals(std::vector<Vec3f>& normals) const {
    constexpr double kCosMost = 0.5;
    for (std::size_t c = 0; c < mesh_.normals.size(); ++c) {
        const std::array<Vec3, 3> p = points_of(mesh_, c / 3);
        const Vec3 own = glm::cross(p[1] - p[0], p[2] - p[0]), file(mesh_.normals[c]);
        const double length = glm::length(file);
        if (length > 0.5 && glm::dot(own, file) >= kCosMost * length * glm::length(own))
            normals[c] = Vec3f(file / length);
    }
}

Surface Repair::hand_out(const SurfaceTopology& topology) {
    Surface surface;
    TriangleMesh& out = surface.mesh;
    tuft::report(options_.progress, "normals", 0);
    out.corner_normals = topology.corner_normals(options_.crease_angle);
    take_file_normals(out.corner_normals);
    out.neighbours = topology.neighbours();
    report_.components = topology.n_components();
    report_.border_edges = topology.n_border_edges();
    report_.holes = topology.n_border_loops();
    report_.closed = report_.border_edges == 0;
    for (const Vec3f& p : mesh_.positions) out.bounds.add(Vec3(p));
    check_size(out.bounds);
    out.positions = std::move(mesh_.positions);
    out.triangles = std::move(mesh_.triangles);
    out.corner_uvs = std::move(mesh_.uvs);
    out.vertex_colours = std::move(mesh_.colours);
    out.triangle_groups = std::move(mesh_.groups);
    out.scene = std::move(soup_.scene);
    if (!group_of_part_.empty()) {
        out.triangle_parts = out.triangle_groups;
        for (std::uint32_t& group : out.triangle_groups) group = group_of_part_[group];
    }
    if (!out.triangle_groups.empty()) out.group_names = std::move(soup_.group_names);
    out.materials = std::move(soup_.materials);
    report_lost_parts(out);
    surface.report = std::move(report_);
    return surface;
}

Surface Repair::run() {
    tuft::report(options_.progress, "welding", 0);
    take_points();
    weld();
    count_parts();
    cut_polygons();
    tuft::report(options_.progress, "matching edges", 0);
    match();
    if (report_.file.loose_triangles && close_cracks()) match();
    report_.non_manifold.edges_split = pairs_.edges_split;
    for (;;) {
        make_manifold();
        compact();
        if (mesh_.triangles.empty()) throw Error("the mesh has no triangle with an area");
        tuft::report(options_.progress, "building the surface", 0);
        SurfaceTopology topology(mesh_);
        report_.degenerate_faces_repaired += topology.turn_flat_triangles(mesh_);
        if (!drop_flat()) return hand_out(topology);
        match();
    }
}

}  // namespace

OpenSides open_sides_of(const std::string& name) {
    if (name == "outward") return OpenSides::outward;
    if (name == "file") return OpenSides::file;
    if (name == "turned") return OpenSides::turned;
    throw Error(Message("'{}' is no side of a surface: outward, file or turned", name));
}

Surface build_surface(PolygonSoup soup, const RepairOptions& options) {
    if (!(options.metres_per_unit > 0 && options.metres_per_unit <= 1e6))
        throw Error("metres per unit must be above 0 and at most a million");
    check_soup(soup);
    return Repair(std::move(soup), options).run();
}

}  // namespace tuft::mesh
