#pragma once

#include <string>

#include "atlas/atlas.h"

/// The UVs a model came with, judged.
namespace tuft::atlas {

struct FileUvs {
    Atlas atlas;
    std::string fault;  ///< why they cannot serve as an atlas; empty when they can
};

/// Sound UVs are finite, lie in [0, 1], leave every triangle room, do not overlap and
/// keep charts a texel apart (two for `UvPolicy::automatic`). Mirrored charts are turned
/// over in their own box. The size is `options.size`, or what `options.texel_size` needs.
FileUvs read_file_uvs(const mesh::TriangleMesh& mesh, const UnwrapOptions& options);

}  // namespace tuft::atlas
