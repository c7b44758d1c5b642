#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/message.h"
#include "mesh/read/polygon_soup.h"

/// \file
/// What the readers of FBX, DAE, 3MF and X3D have in common: the scene as the file says it, and how a soup is made of
/// it. Inside `io` only.
namespace tuft::io {

struct FileMaterial {
    std::string name;
    Vec3f colour{1};                                  ///< sRGB-encoded
    float alpha = 1, roughness = 0.5f, metallic = 0;  ///< [0, 1]
    std::string picture;                              ///< name in the file; empty: none
    std::vector<char> picture_bytes;                  ///< of a picture inside the file; empty: it lies beside the model
};

/// Faces of one object and one material.
struct FilePart {
    std::string object;
    std::uint32_t material = kNone;  ///< index in `materials`
};

/// Metres, z up.
struct FileScene {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint8_t, 4>> colours;  ///< [n_points], sRGB-encoded, or empty
    std::vector<std::uint32_t> corners;                ///< point index per polygon corner
    std::vector<std::uint32_t> counts;                 ///< [n_polygons] corners of each
    std::vector<std::uint32_t> polygon_parts;          ///< [n_polygons] index in `parts`
    std::vector<Vec2f> uvs;                            ///< [n_corners], v up, NaN where there is none; or empty
    std::vector<FilePart> parts;
    std::vector<FileMaterial> materials;
    std::vector<Message> warnings;

    void add_polygon(std::uint32_t part, std::span<const std::uint32_t> points, std::span<const Vec2f> polygon_uvs);
};

/// Groups are parts, materials get their pictures from the bytes in the scene or from files in the folder of `model`.
/// Indices must be in range. Throws `Error` where there is no face.
mesh::PolygonSoup soup_of(FileScene&& scene, const std::filesystem::path& model);

/// The scene as bytes and back, between the importer's process (import_main.cpp) and this one. `unpack_scene` checks
/// every count and index, and throws `Error` naming `file` where one is wrong.
std::vector<char> pack_scene(const FileScene& scene);
FileScene unpack_scene(std::span<const char> bytes, const std::string& file);

}  // namespace tuft::io
