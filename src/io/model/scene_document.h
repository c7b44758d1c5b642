#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/source_scene.h"
#include "mesh/triangle_mesh.h"

/// The document of a `mesh::SourceScene`: a glTF 2.0 JSON with one buffer. Made from a glTF file,
/// or from names and materials where the file is of another format. Inside `io` only.
namespace tuft::io {

/// Offset of the next element of a buffer of `size` bytes; glTF wants multiples of 4.
inline std::size_t aligned(std::size_t size) {
    return (size + 3) / 4 * 4;
}

/// "image/png", "image/jpeg" and so on by the first bytes; "" for anything else.
std::string mime_type_of(std::span<const unsigned char> bytes);

/// Puts the buffers and the pictures of a glTF file into one buffer. `json` is its JSON; a picture
/// without bytes keeps its address. A file without nodes gets one for each mesh. The scene has no
/// parts yet. Throws `Error` naming `name` where the JSON is not that of a glTF file.
mesh::SourceScene pack_document(std::string_view json, std::span<const std::vector<unsigned char>> buffers,
                                std::span<const std::vector<unsigned char>> pictures, const std::string& name);

/// Builds the document of a file that is not glTF.
class SceneBuilder {
  public:
    /// Adds a picture in its own file format and returns the index of its texture.
    int add_texture(const std::string& name, std::span<const unsigned char> bytes);
    /// Adds a glTF material and returns its index.
    int add_material(nlohmann::json material);
    /// Statements of an MTL library, one array by material: {"line"} or {"line", "texture"}, the
    /// line of a picture without its name.
    void keep_statements(int material, nlohmann::json statements);
    /// One node for each object, and one below it for each of its groups; `parts` get their nodes.
    /// `root` names the node of parts without a name.
    mesh::SourceScene finish(std::vector<mesh::ScenePart> parts, const std::string& root);

  private:
    nlohmann::json document_ = nlohmann::json::object();
    std::vector<unsigned char> buffer_;
};

/// The scene of a mesh whose file gave it none: a part for each group, with its colour or picture.
mesh::SourceScene make_scene(const mesh::TriangleMesh& mesh, const std::string& root);

/// The glTF material of a colour and a picture (texture index, or -1).
nlohmann::json plain_material(const std::string& name, const Vec3f& srgb, int texture);

/// The document, parsed. Throws `Error` where it is no JSON or nested too deeply.
nlohmann::json parse_document(const mesh::SourceScene& scene);

/// Key of the MTL statements in the document; not part of what is exported.
inline constexpr const char* kStatements = "tuft_mtl";

}  // namespace tuft::io
