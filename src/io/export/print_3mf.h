#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "atlas/atlas.h"
#include "core/system/progress.h"
#include "ink/composite/composite.h"
#include "ink/composite/filament.h"
#include "mesh/triangle_mesh.h"

/// \file
/// 3MF for colour printing: a textured model, or one whose triangles are painted in given filaments. Called by
/// `export_model` and by `tuft export`. Any thread. Source: 3MF core specification 1.3, materials extension 1.2.1.
namespace tuft::io {

/// A mesh whose triangles have filaments.
struct PaintedTriangles {
    std::vector<Vec3> positions;                          ///< metres
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< in `positions`
    std::vector<std::uint32_t> filament;                  ///< [n_triangles]
    double mean_delta_e = 0;                              ///< CIEDE2000 over the surface
};

/// Options of a model painted in filaments.
struct PaintOptions {
    std::vector<ink::Filament> filaments;  ///< 1 to `kMostFilaments`; the first is the core of the print
    double wall = 0.45e-3;                 ///< metres of the painted wall
    double detail = 0.5e-3;                ///< metres: longer edges are halved where the triangles beside differ
    ProgressFn progress;
};

/// Chooses the filament of every triangle by `ink::choose_filament`. `colour` is the base colour of the atlas, linear
/// sRGB, gutters filled; each triangle is sampled at least once a texel, at 1 to 400 points.
///
/// Triangles with more than one colour are halved, edge by edge at the middle of every edge longer than `detail` on
/// both sides alike, until all their edges are shorter or 16 million triangles are reached: no crack appears, and the
/// surface stays where it is. The same bits for any number of threads. Throws `Error` for no filament.
PaintedTriangles paint_triangles(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas,
                                 const ink::AtlasMap<float>& colour, const PaintOptions& options);

/// Writes painted triangles: base materials with the filaments' names and colours, and for PrusaSlicer and its kin the
/// same as painting (mmu_segmentation, paint_color). Millimetres. `closed`: the mesh bounds a solid.
void write_painted_3mf(const std::filesystem::path& path, const PaintedTriangles& painted,
                       std::span<const ink::Filament> filaments, bool closed);

}  // namespace tuft::io
