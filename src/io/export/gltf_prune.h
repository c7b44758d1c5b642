#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <vector>

/// \file
/// Removal of unused elements from a glTF document. Called by the glTF export. Inside `io` only. Any thread.
namespace tuft::io {

/// Indices of the elements that something in the document refers to.
struct References {
    std::set<std::size_t> accessors, views, materials, textures, images;
};
/// Returns the references of a document.
References references_in(const nlohmann::json& document);

/// Removes the elements that were referenced in `before` and no longer are, and renumbers all indices. A document with
/// unknown extensions is left unchanged, because they may hold references.
void prune(nlohmann::json& document, const References& before);

/// Removes the animations of a node's morph targets.
void drop_morphs(nlohmann::json& document, std::size_t node);

/// Returns a new buffer with the bytes of all buffer views in their order, and points the views to it. Their old
/// offsets count through `source` and, from the next multiple of 4 on, through `added`. The whole buffer is copied
/// unchanged where views overlap by much, lie outside or have extensions.
std::vector<unsigned char> take_views(nlohmann::json& document, const std::vector<unsigned char>& source,
                                      const std::vector<unsigned char>& added);

}  // namespace tuft::io
