#pragma once

#include "core/files/disk_cache.h"
#include "stroke/surface/model.h"

/// \file
/// Repaired meshes and their atlases, and packed texel maps with their cluster graphs, stored between runs.
/// `prepare_model` reads and writes them.
namespace tuft::stroke {

/// Returns the key of a soup that is prepared with these options. It also covers the sources of the modules that
/// prepare a model, their compiler and libraries, so that another build never reads what this one stored.
CacheKey model_key(const mesh::PolygonSoup& soup, const ModelOptions& options);

/// What a cache stores of a model. The rest of it comes from the soup: names, scene and materials.
struct StoredModel {
    mesh::TriangleMesh mesh;
    mesh::RepairReport repairs;
    atlas::Atlas atlas;
    atlas::AtlasReport atlas_report;
};

/// Writes the arrays of a model. `n_reader_warnings` of its warnings come from the reader and are left out.
void put_model(CacheWriter& entry, const Model& model, std::size_t n_reader_warnings);

/// Reads what `put_model` wrote, and takes names and scene from the soup. Throws `Error` for an entry that is damaged:
/// mesh and atlas are checked as a project's (`fault_of`).
StoredModel get_model(CacheReader& entry, const mesh::PolygonSoup& soup);

/// Returns the key of the packed texel map and the cluster graph of a model's mesh and atlas; what it covers besides is
/// as in `model_key`.
CacheKey texels_key(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas);

/// Writes texel map and cluster graph of a model whose map is packed.
void put_texels(CacheWriter& entry, const Model& model);

/// A texel map and its graph.
struct StoredTexels {
    atlas::TexelMap map;
    atlas::ClusterGraph clusters;
};

/// Reads what `put_texels` wrote of a model with this atlas; tiles stay in the file. Throws `Error` for an entry that
/// is damaged: hashes, sizes, indices and numbers are checked.
StoredTexels get_texels(CacheReader& entry, const atlas::Atlas& atlas);

/// Returns where texel maps are stored beside `models`: they are large and quickly made, and would drive models out.
DiskCache texels_cache(const DiskCache& models);

}  // namespace tuft::stroke
