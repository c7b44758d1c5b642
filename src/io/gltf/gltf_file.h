#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

/// \file
/// A glTF file in memory: JSON, buffers and pictures. Called by the reader and by the scene document. Inside `io`
/// only. Any thread.
namespace tuft::io {

/// A glTF file in memory.
struct GltfFile {
    std::string json;                                  ///< as stored in the file
    std::unique_ptr<tinygltf::Model> model;            ///< the JSON, parsed, with its buffers; never null after opening
    std::vector<std::vector<unsigned char>> pictures;  ///< by image, in their own file format; empty: missing

    GltfFile();
    ~GltfFile();
    GltfFile(GltfFile&&) noexcept;
};

/// Opens the bytes of a GLB or glTF file. Buffers and pictures are read from the file, from data URIs and from files
/// inside the model's folder. Throws `Error` in one line for a damaged file and for one that requires an unknown
/// extension.
GltfFile open_gltf(const std::vector<char>& bytes, const std::filesystem::path& path);

/// Returns a URI shortened for messages: the type and length of a data URI, else at most 80 characters.
std::string short_uri(const std::string& uri);

}  // namespace tuft::io
