#pragma once

#include <memory>

#include "atlas/atlas.h"
#include "atlas/texels/cluster_graph.h"
#include "atlas/texels/texel_map.h"
#include "footprint/stamp/stamp.h"
#include "ink/colour/base_colour.h"
#include "mesh/query/surface_query.h"
#include "mesh/repair/repair.h"

namespace tuft::stroke {

/// A model ready to be painted on: clean mesh, atlas, queries, texel map. Built once;
/// everything that paints only reads it.
struct Model {
    std::unique_ptr<mesh::TriangleMesh> mesh;  ///< on the heap: `query` keeps its address
    mesh::RepairReport repairs;
    atlas::Atlas atlas;
    atlas::AtlasReport atlas_report;
    std::unique_ptr<mesh::SurfaceQuery> query;
    atlas::TexelMap texels;
    atlas::ClusterGraph clusters;
    ink::BaseColour ground;  ///< the mesh's own colours, or empty

    footprint::Surface surface() const { return {*mesh, atlas, texels, clusters}; }
};

struct ModelOptions {
    mesh::RepairOptions repair;   ///< its `progress` is set from the one below
    atlas::UnwrapOptions unwrap;  ///< likewise
    atlas::TexelStore texels = atlas::TexelStore::automatic;
    std::size_t memory_limit = 0;  ///< bytes; 0: what the machine has free
    ProgressFn progress;
};

/// Repairs the mesh, unwraps it and builds what painting needs. Throws `Error` when
/// nothing can be painted on, or when the atlas would need more memory than the limit,
/// before taking any, with the size it would need.
Model prepare_model(mesh::PolygonSoup soup, const ModelOptions& options = {});

/// The same from a mesh and an atlas that exist already, such as a project's.
Model prepare_model(mesh::TriangleMesh mesh, atlas::Atlas atlas, const ProgressFn& progress = {},
                    atlas::TexelStore texels = atlas::TexelStore::automatic);

/// The same mesh with a new atlas, of another size or with new charts.
Model rescale_model(Model model, const ModelOptions& options);

/// Bytes that painting on an atlas of size × size texels takes at most.
std::size_t atlas_memory(std::uint32_t size, atlas::TexelStore texels = atlas::TexelStore::automatic);

/// Bytes this process may still take: free memory of the machine or of its control group.
std::size_t available_memory();

}  // namespace tuft::stroke
