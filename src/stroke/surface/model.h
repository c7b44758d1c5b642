#pragma once

#include <memory>

#include "atlas/atlas.h"
#include "atlas/texels/cluster_graph.h"
#include "atlas/texels/texel_map.h"
#include "core/files/disk_cache.h"
#include "footprint/stamp/stamp.h"
#include "ink/colour/base_colour.h"
#include "mesh/query/surface_query.h"
#include "mesh/repair/repair.h"

/// \file
/// A model prepared for painting. Made once from a file or a project; documents, pictures and exports read it.

namespace tuft::stroke {

/// Clean mesh, atlas, queries and texel map. Constant after it is built; reading is safe in several threads.
struct Model {
    std::unique_ptr<mesh::TriangleMesh> mesh;  ///< on the heap: `query` holds its address
    mesh::RepairReport repairs;
    atlas::Atlas atlas;
    atlas::AtlasReport atlas_report;
    std::unique_ptr<mesh::SurfaceQuery> query;
    atlas::TexelMap texels;
    atlas::ClusterGraph clusters;
    ink::BaseColour base_colour;  ///< colours of the mesh's file, or empty

    footprint::Surface surface() const { return {*mesh, atlas, texels, clusters}; }
};

/// Options of `prepare_model`.
struct ModelOptions {
    mesh::RepairOptions repair;   ///< its `progress` is replaced by the one below
    atlas::UnwrapOptions unwrap;  ///< likewise
    atlas::TexelStore texels = atlas::TexelStore::automatic;
    std::size_t memory_limit = 0;  ///< bytes; 0: `available_memory`
    DiskCache cache;               ///< of repaired meshes, their atlases and texel maps (model_cache.h)
    ProgressFn progress;
};

/// Repairs a mesh, unwraps it and builds queries and texel map. Throws `Error` for a mesh without surface, and before
/// it allocates where the atlas needs more memory than the limit, with the size that it needs. A model in the cache has
/// the same bits as one prepared anew.
Model prepare_model(mesh::PolygonSoup soup, const ModelOptions& options = {});

/// The same from an existing mesh and atlas, such as a project's. Of the options only `texels`,
/// `memory_limit`, `cache` and `progress` are read.
Model prepare_model(mesh::TriangleMesh mesh, atlas::Atlas atlas, const ModelOptions& options);
Model prepare_model(mesh::TriangleMesh mesh, atlas::Atlas atlas, const ProgressFn& progress = {});

/// Returns the same mesh with a new atlas, of another size or with new charts.
Model rescale_model(Model model, const ModelOptions& options);

/// Returns the cache of the user's prepared models: `tuft/models` in $XDG_CACHE_HOME or ~/.cache, 2 GiB and
/// 4 GiB of texel maps.
DiskCache shared_model_cache();

/// Returns an upper bound for the memory of painting on an atlas of size × size texels, bytes.
std::size_t atlas_memory(std::uint32_t size, atlas::TexelStore texels = atlas::TexelStore::automatic);

/// Returns the memory that this process may still allocate, bytes: free memory of the machine or of its control group.
std::size_t available_memory();

}  // namespace tuft::stroke
