#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "mesh/half_edge.h"
#include "mesh/repair/repair.h"

/// \file
/// From loose triangles to a manifold: pairs half-edges (mesh/half_edge.h), orients triangles and splits vertices. Used
/// by `build_surface` only.
namespace tuft::mesh {

/// A mesh under repair; `build_surface` makes a `TriangleMesh` of it.
struct RawMesh {
    std::vector<Vec3f> positions;  ///< metres
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec2f> uvs;                            ///< [3 n_triangles] or empty
    std::vector<Vec3f> normals;                        ///< [3 n_triangles] of the file's surface, NaN: none; or empty
    std::vector<std::uint32_t> groups;                 ///< [n_triangles] or empty
    std::vector<std::array<std::uint8_t, 4>> colours;  ///< [n_vertices] or empty
    std::vector<std::uint32_t> opposite;               ///< [3 n_triangles] half-edge over the edge, or kNone
    std::vector<bool> at_split_edge;                   ///< [n_vertices] the vertex lies on a split edge, or empty

    std::uint32_t start(std::uint32_t h) const { return triangles[h / 3][h % 3]; }
    std::uint32_t end(std::uint32_t h) const { return triangles[h / 3][(h + 1) % 3 ? h % 3 + 1 : 0]; }
};

/// Height of a triangle over its longest side, metres. That side runs from corner `longest_side` to the next.
struct Shape {
    double height = 0, longest = 0;
    int longest_side = 0;
};
Shape shape_of(const std::array<Vec3, 3>& p);
std::array<Vec3, 3> points_of(const RawMesh& mesh, std::size_t triangle);

/// A triangle is flat when its height is below this fraction of its longest side: its normal is undefined.
inline constexpr double kFlat = 1e-9;
bool is_flat(const RawMesh& mesh, std::size_t triangle);

/// Retains the triangles with keep[t] set, in order, and their attributes.
void keep_triangles(RawMesh& mesh, const std::vector<bool>& keep);

/// Marks in `at_split_edge` the vertices of half-edge h: its edge was split.
void mark_opened(RawMesh& mesh, std::uint32_t h);

/// What pairing changed.
struct PairingReport {
    std::size_t duplicates_dropped = 0;
    std::size_t edges_split = 0;  ///< shared by three or more triangles of positive area
    bool needs_settling = false;  ///< some edge lost a triangle, of positive area or not
};

/// Drops every triangle with the same three vertices as an earlier one, whatever its orientation, then fills
/// `opposite`. Where more than two triangles meet at an edge, the pair of flattest dihedral angle is joined first.
/// Where most of the file's edges agree in direction, only triangles that agree are joined. Unpaired half-edges
/// become border.
PairingReport pair_half_edges(RawMesh& mesh);

/// What orientation changed.
struct OrientationReport {
    std::size_t faces_flipped = 0;  ///< of closed components, and against the majority of open ones
    std::size_t parts_turned = 0;   ///< open components that were inside out
    std::size_t edges_cut = 0;      ///< of one-sided components (Möbius), which cannot be oriented
};

/// Flips triangles until neighbours agree. In each component the majority retains its orientation. A closed component
/// gets outward normals (positive signed volume). Exception: a cavity retains its orientation if the file has it inside
/// another closed component and oriented consistently inward.
///
/// With `OpenSides::outward` an open component is flipped where its back sees at least 2.5 times as much of the open as
/// its front (exposure.h), and at least 5 %. So the outside of a shell becomes its front, however many doors and
/// windows it has. Sheets, and cups as shallow as a hemisphere, stay as the file has them, because their inside may be
/// meant. Where nine tenths of the area with a known side were flipped, the rest is flipped as well.
OrientationReport orient(RawMesh& mesh, OpenSides sides);

/// Gives every fan of triangles round a vertex a vertex of its own. Returns the number of vertices with more than
/// one fan, not counting those on split edges. Precondition: oriented.
std::size_t split_vertices(RawMesh& mesh);

/// Makes `opposite` and the vertex numbers consistent after splitting and cutting: no two vertices are joined by
/// more than one edge of two triangles. Precondition: oriented.
void settle(RawMesh& mesh);

}  // namespace tuft::mesh
