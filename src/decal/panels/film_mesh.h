#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"

/// \file
/// The part of a model that film shall cover, as a mesh of its own that planes may cut. Made by `select_film`; cut into
/// panels by panels.h.
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

/// Returns the triangles of `model` with more than half coverage anywhere, and those that the surface reaches from them
/// within `margin` metres (shortest path over edges, so at most that far on the surface) without turning by more than
/// 35°. `texel` is the distance of the samples, metres. Each connected part gets a label.
FilmMesh select_film(const mesh::TriangleMesh& model, const CoverageFn& coverage, double margin, double texel);

/// Whether more than half coverage lies anywhere in a triangle of the film, sampled every `texel` metres.
bool is_painted(const FilmMesh& film, std::uint32_t triangle, const CoverageFn& coverage, double texel);

/// Cuts the triangles of one label along a plane; both sides, connected part by connected part, get new labels, and the
/// old label is used for the first of them. Triangles of other labels that share a cut edge are divided too, so edges
/// always meet in full. Crossings within 5 % of an edge's end move onto that end. Returns the labels of the parts; one
/// where the plane misses them.
std::vector<std::uint32_t> cut(FilmMesh& film, std::uint32_t label, const Plane& plane);

/// Returns the point of the model with these weights, metres.
Vec3 point_at(const mesh::TriangleMesh& model, std::uint32_t triangle, const Weights& weights);

}  // namespace tuft::decal
