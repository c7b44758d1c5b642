#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "mesh/triangle_mesh.h"

/// \file
/// The part of a model that film shall cover, as a mesh of its own that planes may cut. Made by select_film.h; cut
/// into panels by panels.h.
namespace tuft::decal {

/// Weights of the three corners of a triangle; they add up to one.
using Weights = std::array<double, 3>;

/// Returns what lies at a point of a triangle of the model: coverage by paint, 0–1. Any thread.
using CoverageFn = std::function<double(std::uint32_t triangle, const Weights& weights)>;

/// Triangles of the model, or parts of them.
struct FilmMesh {
    mesh::TriangleMesh mesh;                      ///< positions, triangles and neighbours only; metres, model frame
    std::vector<std::uint32_t> source;            ///< [n_triangles] triangle of the model
    std::vector<std::array<Weights, 3>> weights;  ///< [n_triangles] of each corner, in the triangle of the model
    std::vector<std::uint32_t> label;             ///< [n_triangles] connected part
    std::uint32_t n_labels = 0;
};

/// The plane n · x = offset, n unit, metres.
struct Plane {
    Vec3 normal{1, 0, 0};
    double offset = 0;
};

/// Finds `mesh.neighbours`.
void find_neighbours(FilmMesh& film);

/// Gives each connected part of the triangles labelled `label` a label of its own, the first one `label`. Returns them.
std::vector<std::uint32_t> label_parts(FilmMesh& film, std::uint32_t label);

/// Vertices on edges, by `edge_key`.
using EdgePoints = std::unordered_map<std::uint64_t, std::uint32_t>;

inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

/// Divides the triangles whose edges have points, which `mesh.positions` holds already, so that edges meet in full. The
/// first part takes a triangle's place, the others are appended.
void divide(FilmMesh& film, const EdgePoints& points);

/// Parts of an edge: crossings nearer to its lower, or its upper, end move onto that.
struct Snap {
    double below = 0, above = 0;
};

/// Divides the triangles of one label where the linear function with `height` at the vertices is 0. Returns for each
/// triangle 1 where it has that label and lies above.
std::vector<std::uint8_t> divide_at_level(FilmMesh& film, std::uint32_t label, std::vector<double> height,
                                          const Snap& snap);

/// Cuts the triangles of one label along a plane; both sides, connected part by connected part, get new labels, and the
/// old label is used for the first of them. Triangles of other labels that share a cut edge are divided too, so edges
/// always meet in full. Crossings within 5 % of an edge's end move onto that end. Returns the labels of the parts; one
/// where the plane misses them.
std::vector<std::uint32_t> cut(FilmMesh& film, std::uint32_t label, const Plane& plane);

/// Returns the point of the model with these weights, metres.
Vec3 point_at(const mesh::TriangleMesh& model, std::uint32_t triangle, const Weights& weights);

}  // namespace tuft::decal
