#pragma once

#include <string>

#include "atlas/atlas.h"
#include "core/message.h"

/// \file
/// UVs of a model's file as an atlas. Called by `unwrap`.
namespace tuft::atlas {

/// UVs of a file as an atlas.
struct FileUvs {
    Atlas atlas;
    Message fault;  ///< why they cannot serve as an atlas; empty when they can
};

/// Returns the UVs of the file as an atlas, or the fault that prevents it. Sound UVs are finite and lie in [0, 1]
/// (with `UvPolicy::keep`: on pages 1001 to 2000 of the UDIM convention, each chart on one, at most 100 pages).
/// They give every triangle area, do not overlap, and leave a texel between charts of a page (two for
/// `UvPolicy::automatic`). Mirrored charts are reflected in their own box. Pages have `options.size` texels, or as
/// many as `options.texel_size` needs. On several pages UVs move by rounding, at most 1/16 texel where a sliver
/// would lose its area.
FileUvs read_file_uvs(const mesh::TriangleMesh& mesh, const UnwrapOptions& options);

}  // namespace tuft::atlas
