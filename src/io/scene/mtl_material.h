#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Conversion between entries of MTL libraries and glTF materials. Called by the OBJ reader's scene and the OBJ export.
/// Inside `io` only. Any thread.
namespace tuft::io {

/// One statement of an entry: its key and the rest of its line.
using MtlStatement = std::pair<std::string, std::string>;

/// Returns the file name after the options of a line such as `map_Kd -s 2 2 2 wood.png`.
std::string picture_name(std::string line);

/// Returns the texture index of the picture with that name; −1 where it is missing or no picture.
using TextureOf = std::function<int(const std::string& name)>;

/// A material of MTL in the terms of glTF.
struct MtlAsGltf {
    nlohmann::json material;    ///< of glTF
    nlohmann::json statements;  ///< as `SceneBuilder::keep_statements` takes them
};

/// Returns the glTF material of an MTL entry:
///
/// | glTF | MTL |
/// |---|---|
/// | base colour | `map_Kd`, untinted, else `Kd` (taken as sRGB) |
/// | alpha | `d` or `Tr` |
/// | roughness | `Pr`, else 1 − √(Ns / 1000) |
/// | metallic | `Pm`, else `Ka` with `illum 3` |
/// | emission | `Ke`, `map_Ke` |
/// | normal texture | `norm`, or a `bump` with colours |
///
/// Roughness and metallic by `Ns` and `Ka` follow Blender.
MtlAsGltf gltf_of_mtl(const std::string& name, const std::vector<MtlStatement>& entry, const TextureOf& texture_of);

/// Returns the lines `Ns` and `Pr` of a roughness, 0–1. A reader that finds neither takes a mirror.
std::string mtl_roughness(double roughness);

/// Returns the file name of a texture's picture; "" where there is none.
using FileOfTexture = std::function<std::string(std::size_t texture)>;

/// Returns an entry of an MTL library with its line ends. It is written from the statements, or from the glTF material
/// where there are none.
std::string mtl_entry(const std::string& name, const nlohmann::json& material, const nlohmann::json& statements,
                      const FileOfTexture& file_of_texture);

}  // namespace tuft::io
