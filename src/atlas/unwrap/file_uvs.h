#pragma once

#include <string>

#include "atlas/atlas.h"

/// The UVs a model came with, judged.
namespace tuft::atlas {

struct FileUvs {
    Atlas atlas;
    std::string fault;  ///< why they cannot serve as an atlas; empty when they can
};

/// Sound UVs are finite, lie in [0, 1] (with `UvPolicy::keep`: on pages 1001 to 2000 of the
/// UDIM convention, each chart on one, 100 pages at most), leave every triangle room, do not
/// overlap and keep charts of a page a texel apart (two for `UvPolicy::automatic`). Mirrored
/// charts are turned over in their own box. Pages have `options.size` texels, or as many as
/// `options.texel_size` needs. On several pages UVs move by roundings, at most 1/16 texel where
/// a sliver would lose its room in them.
FileUvs read_file_uvs(const mesh::TriangleMesh& mesh, const UnwrapOptions& options);

}  // namespace tuft::atlas
