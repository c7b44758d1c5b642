#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/charts/charts.h"

/// \file
/// Equal parts of a mesh, such as wheels and bolts, are cut into charts once. Called by `unwrap`.
namespace tuft::atlas {

/// The kinds of parts of a mesh. A part is a set of triangles that are connected over `twin`. Two parts are equal when
/// their triangles correspond, neighbour to neighbour, with a stretch between 1 / 1.01 and 1.01: one is the other
/// moved, or its mirror image. Triangles below 1e-5 of a part's area, which rounding in files changes, may stretch
/// by 1.4. Equal parts that are bent differently have the same charts too, because flattening depends on lengths only.
struct EqualParts {
    std::vector<std::uint32_t> kept;  ///< triangles of the first part of each kind, ascending
    std::vector<std::uint32_t> part;  ///< [n_triangles] index of the part
    /// [3 n_triangles] half-edge of the first part of the kind over the same edge. In a mirror image it runs the other
    /// way.
    std::vector<std::uint32_t> source;
    std::vector<std::uint8_t> mirrored;  ///< [n_triangles] the part is a mirror image of the first of its kind

    /// Returns true when there are fewer kinds than parts.
    bool any() const { return 3 * kept.size() < source.size(); }
};

/// Returns the kinds of parts. `twin` [3 n_triangles] as in `CutMesh`.
EqualParts find_equal_parts(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin);

/// Returns the mesh of the kept parts: positions, triangles and neighbours only.
mesh::TriangleMesh kept_mesh(const mesh::TriangleMesh& mesh, const EqualParts& parts);

/// Returns the kept mesh without seams; its unit is that of the whole mesh.
CutMesh uncut_kept_mesh(const EqualParts& parts, std::span<const std::uint32_t> twin, double unit);

/// Returns the whole mesh with the charts of the kept mesh on every part.
CutMesh with_copies(const mesh::TriangleMesh& mesh, const EqualParts& parts, std::vector<std::uint32_t> twin,
                    const CutMesh& kept);

}  // namespace tuft::atlas
