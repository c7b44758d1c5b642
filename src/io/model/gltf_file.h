#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

/// A glTF file as bytes: its container, its buffers and its pictures. Inside `io` only.
namespace tuft::io {

struct GltfFile {
    std::string json;                                  ///< as it is in the file
    std::unique_ptr<tinygltf::Model> model;            ///< the same, parsed, with its buffers
    std::vector<std::vector<unsigned char>> pictures;  ///< by image, in their own file format; empty: not there

    GltfFile();
    ~GltfFile();
    GltfFile(GltfFile&&) noexcept;
};

/// Opens the bytes of a GLB or glTF file. Buffers and pictures may lie in the file, in data URIs,
/// or in files inside the model's folder. Throws `Error` in one line for a damaged file and for one
/// that requires an extension that tuft does not read.
GltfFile open_gltf(const std::vector<char>& bytes, const std::filesystem::path& path);

/// An address for messages: of a data URI its type and length only, of others at most 80
/// characters.
std::string short_uri(const std::string& uri);

}  // namespace tuft::io
