#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "mesh/material.h"
#include "mesh/source_scene.h"

/// \file
/// The mesh that all other modules use: plain arrays, metres, model frame, faces counter-clockwise from outside.
/// `mesh::build_surface` (repair.h) makes it, so it is clean: manifold, consistently oriented within a component,
/// no degenerate or duplicate triangles, every index in range, every number finite.
namespace tuft::mesh {

/// A surface of triangles.
struct TriangleMesh {
    std::vector<Vec3f> positions;                         ///< [n_vertices], metres
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< [n_triangles] vertex indices
    std::vector<Vec3f> corner_normals;                    ///< [3 n_triangles], unit; split at creases above 40°
    /// [3 n_triangles] triangle over the edge from corner k to corner k+1, kNone on a border.
    std::vector<std::uint32_t> neighbours;
    std::vector<Vec2f> corner_uvs;                            ///< [3 n_triangles] as in the file (v up), or empty
    std::vector<std::array<std::uint8_t, 4>> vertex_colours;  ///< [n_vertices] RGBA, or empty
    std::vector<std::uint32_t> triangle_groups;               ///< [n_triangles] index into group_names, or empty
    std::vector<std::string> group_names;
    std::vector<Material> materials;            ///< [n_groups], or one for all without groups, or empty
    std::shared_ptr<const SourceScene> scene;   ///< objects and materials of the file, or null
    std::vector<std::uint32_t> triangle_parts;  ///< [n_triangles] index into scene->parts; empty: the groups
    Box bounds;

    std::size_t n_vertices() const { return positions.size(); }
    std::size_t n_triangles() const { return triangles.size(); }
    Vec3 position(std::size_t triangle, int corner) const { return Vec3(positions[triangles[triangle][corner]]); }
};

/// Returns the index of a triangle's part: object, group and material of the file together.
inline std::uint32_t part_of(const TriangleMesh& mesh, std::size_t triangle) {
    if (!mesh.triangle_parts.empty()) return mesh.triangle_parts[triangle];
    return mesh.triangle_groups.empty() ? 0 : mesh.triangle_groups[triangle];
}

/// Returns true when the file has face or vertex colours.
inline bool has_colours(const TriangleMesh& mesh) {
    return !mesh.materials.empty() || !mesh.vertex_colours.empty();
}

/// A point on the mesh: a triangle and the barycentric weights of its corners 1 and 2.
struct SurfacePoint {
    std::uint32_t triangle = kNone;
    double b1 = 0, b2 = 0;
    Vec3 position{0};           ///< metres
    Vec3 normal{0, 0, 1};       ///< unit, corner normals interpolated
    Vec3 face_normal{0, 0, 1};  ///< unit, of the flat triangle
    double distance = 0;        ///< metres: from the query point, or along the ray
};

/// Returns the point of `triangle` with the given weights; `distance` is 0.
SurfacePoint surface_point(const TriangleMesh& mesh, std::uint32_t triangle, double b1, double b2);

/// Returns the unit normal of the flat triangle.
Vec3 face_normal(const TriangleMesh& mesh, std::size_t triangle);

/// Returns the sum of triangle areas, m².
double surface_area(const TriangleMesh& mesh);

}  // namespace tuft::mesh
