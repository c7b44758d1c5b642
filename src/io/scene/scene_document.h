#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/source_scene.h"
#include "mesh/triangle_mesh.h"

/// \file
/// The document of a `mesh::SourceScene`: glTF 2.0 JSON with one buffer. It comes from a glTF file, or is built from
/// the names and materials of another format. Called by the model readers and by the export. Inside `io` only. Any
/// thread.
namespace tuft::io {

/// Returns `size` rounded up to a multiple of 4, the offset of the next element in a glTF buffer.
inline std::size_t aligned(std::size_t size) {
    return (size + 3) / 4 * 4;
}

/// Returns the MIME type by the first bytes: "image/png", "image/jpeg" …; "" for other content.
std::string mime_type_of(std::span<const unsigned char> bytes);

/// Returns the scene of a glTF file, its buffers and pictures in one buffer and without parts. `json` is the file's
/// JSON. A picture without bytes retains its URI. A file without nodes gets one node for each mesh. Throws `Error`
/// naming `name` where the JSON is no glTF.
mesh::SourceScene pack_document(std::string_view json, std::span<const std::vector<unsigned char>> buffers,
                                std::span<const std::vector<unsigned char>> pictures, const std::string& name);

/// Builds the document of a file that is not glTF.
class SceneBuilder {
  public:
    /// Adds a picture in its own file format. Returns the index of its texture.
    int add_texture(const std::string& name, std::span<const unsigned char> bytes);
    /// Adds a glTF material. Returns its index.
    int add_material(nlohmann::json material);
    /// Stores the statements of an MTL entry with a material, one array for each: {"line"} or {"line", "texture"}. The
    /// line of a picture is without the file name.
    void keep_statements(int material, nlohmann::json statements);
    /// Returns the scene with one node for each object, and below it one for each of its groups. `parts` get their
    /// nodes. `root` names the node of parts without a name. The builder is empty afterwards.
    mesh::SourceScene finish(std::vector<mesh::ScenePart> parts, const std::string& root);

  private:
    nlohmann::json document_ = nlohmann::json::object();
    std::vector<unsigned char> buffer_;
};

/// Returns a scene for a mesh without one: a part for each group, with the group's colour or picture.
mesh::SourceScene make_scene(const mesh::TriangleMesh& mesh, const std::string& root);

/// Returns a glTF material with a base colour (sRGB-encoded, 0–1) and a picture (texture index; −1: none).
nlohmann::json plain_material(const std::string& name, const Vec3f& srgb, int texture);

/// Returns the document of a scene, parsed. Throws `Error` where it is no JSON or nested too deeply.
nlohmann::json parse_document(const mesh::SourceScene& scene);

/// Key of the MTL statements in the document. Exports leave it out.
inline constexpr const char* kStatements = "tuft_mtl";

/// Key in the extras of a node: names of the parts, one for each primitive of its mesh.
inline constexpr const char* kPartNames = "tuft_parts";

}  // namespace tuft::io
