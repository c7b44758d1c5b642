#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/types.h"

/// From loose triangles to a manifold: which triangle lies over each edge, which way round each
/// one is, and which corners share a vertex. Half-edge 3 t + k runs from corner k of triangle t
/// to corner k + 1. Internal to `mesh`.
namespace tuft::mesh {

/// Triangles on their way to a `TriangleMesh`.
struct RawMesh {
    std::vector<Vec3f> positions;  ///< metres
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec2f> uvs;                            ///< [3 n_triangles] or empty
    std::vector<std::uint32_t> groups;                 ///< [n_triangles] or empty
    std::vector<std::array<std::uint8_t, 4>> colours;  ///< [n_vertices] or empty
    std::vector<std::uint32_t> opposite;               ///< [3 n_triangles] half-edge over the edge, or kNone
    std::vector<bool> at_split_edge;                   ///< [n_vertices] lies on an edge that was opened, or empty

    std::uint32_t start(std::uint32_t h) const { return triangles[h / 3][h % 3]; }
    std::uint32_t end(std::uint32_t h) const { return triangles[h / 3][(h + 1) % 3 ? h % 3 + 1 : 0]; }
};

/// The half-edge after and before h in its triangle.
constexpr std::uint32_t next_in_face(std::uint32_t h) {
    return h % 3 == 2 ? h - 2 : h + 1;
}
constexpr std::uint32_t previous_in_face(std::uint32_t h) {
    return h % 3 == 0 ? h + 2 : h - 1;
}

/// Height of a triangle over its longest side, metres; that side runs from corner
/// `longest_side` to the next.
struct Shape {
    double height = 0, longest = 0;
    int longest_side = 0;
};
Shape shape_of(const std::array<Vec3, 3>& p);
std::array<Vec3, 3> points_of(const RawMesh& mesh, std::size_t triangle);

/// A height below this part of the longest side is no area that could carry a normal.
inline constexpr double kFlat = 1e-9;
bool is_flat(const RawMesh& mesh, std::size_t triangle);

/// Keeps the triangles where keep[t] is set, in order, with all that belongs to them.
void keep_triangles(RawMesh& mesh, const std::vector<bool>& keep);

/// Notes in `at_split_edge` that the edge of half-edge h was opened.
void mark_opened(RawMesh& mesh, std::uint32_t h);

struct PairingReport {
    std::size_t duplicates_dropped = 0;
    std::size_t edges_split = 0;  ///< shared by three or more triangles with an area
    bool needs_settling = false;  ///< some edge lost a triangle, with or without an area
};

/// Drops every triangle that has the same three vertices as an earlier one, whichever way round,
/// then fills `opposite`. Where more than two triangles meet at an edge, those go together that
/// continue each other best: flattest dihedral first, and, where most of the file's edges agree
/// in direction, only triangles that agree. What is left over becomes border.
PairingReport pair_half_edges(RawMesh& mesh);

struct OrientationReport {
    std::size_t faces_flipped = 0;
    std::size_t edges_cut = 0;  ///< of one-sided pieces (Möbius), which no orientation fits
};

/// Turns triangles until neighbours agree. In each component the majority keeps its side;
/// a closed component has its normals outward (positive signed volume), but a cavity that the
/// file shows inside another closed component, and consistently inward, keeps its side.
OrientationReport orient(RawMesh& mesh);

/// Gives every fan of triangles around a vertex a vertex of its own. Returns how many
/// vertices, beyond those on opened edges, had more than one fan. Needs orientation.
std::size_t split_vertices(RawMesh& mesh);

/// After splitting and cutting: makes `opposite` and the vertex numbers say the same, so that
/// no two vertices are joined by more than one edge of two triangles. Needs orientation.
void settle(RawMesh& mesh);

}  // namespace tuft::mesh
