#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

/// Materials of MTL libraries as those of glTF, and back. Inside `io` only.
namespace tuft::io {

/// One statement of an entry: its key and the rest of its line.
using MtlStatement = std::pair<std::string, std::string>;

/// The file name behind the options of a line such as `map_Kd -s 2 2 2 wood.png`.
std::string picture_name(std::string line);

/// Texture index of the picture of that name, or -1 where it is not there or no picture.
using TextureOf = std::function<int(const std::string& name)>;

struct MtlAsGltf {
    nlohmann::json material;    ///< of glTF
    nlohmann::json statements;  ///< as `SceneBuilder::keep_statements` takes them
};

/// `Kd` (taken as sRGB) and `map_Kd` become the base colour, `d` and `Tr` its alpha, `Pr` or else
/// `Ns` the roughness by r = 1 - sqrt(Ns / 1000), `Pm` or else, with `illum 3`, `Ka` the metallic
/// part (both as Blender has it), `Ke` and `map_Ke` emission, `norm` and a `bump` in colours the
/// normal texture. A picture is not tinted by `Kd`.
MtlAsGltf gltf_of_mtl(const std::string& name, const std::vector<MtlStatement>& entry, const TextureOf& texture_of);

/// File name of the picture of a texture, or "" where there is none.
using FileOfTexture = std::function<std::string(std::size_t texture)>;

/// An entry of an MTL library, with its line ends: the statements where there are any, else the
/// other way round from the glTF material.
std::string mtl_entry(const std::string& name, const nlohmann::json& material, const nlohmann::json& statements,
                      const FileOfTexture& file_of_texture);

}  // namespace tuft::io
