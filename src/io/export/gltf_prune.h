#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <vector>

/// What of a glTF document is in use, and how the rest is left out. Inside `io` only.
namespace tuft::io {

/// Indices of accessors, buffer views, materials, textures and images that something in the
/// document refers to.
struct References {
    std::set<std::size_t> accessors, views, materials, textures, images;
};
References references_in(const nlohmann::json& document);

/// Leaves out what was in use `before` and is no more, and turns all indices. A document with
/// extensions in which tuft does not know the references keeps everything.
void prune(nlohmann::json& document, const References& before);

/// Leaves out the animations of a node's morph targets.
void drop_morphs(nlohmann::json& document, std::size_t node);

/// The bytes of the buffer views in their order, out of `source` and, from the next multiple of 4
/// on, `added`; the views point to them afterwards. Views that overlap much, or lie outside, keep
/// the whole buffer as it is.
std::vector<unsigned char> take_views(nlohmann::json& document, const std::vector<unsigned char>& source,
                                      const std::vector<unsigned char>& added);

}  // namespace tuft::io
