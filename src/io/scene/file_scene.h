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
/// Scene of one file, as the readers of FBX, DAE, 3MF, X3D, VRML, STEP and IGES fill it, and its conversion into a
/// polygon soup. Inside `io` only. Any thread.
namespace tuft::io {

/// A material of the file.
struct FileMaterial {
    std::string name;
    Vec3f colour{1};                                  ///< sRGB-encoded
    float alpha = 1, roughness = 0.5f, metallic = 0;  ///< [0, 1]
    std::string picture;                              ///< name in the file; empty: none
    std::vector<char> picture_bytes;                  ///< of an embedded picture; empty: it lies beside the model
};

/// Faces of one object that have one material.
struct FilePart {
    std::string object;
    std::uint32_t material = kNone;  ///< index in `materials`
};

/// Points in metres, z up.
struct FileScene {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint8_t, 4>> colours;  ///< [n_points], sRGB-encoded, or empty
    std::vector<std::uint32_t> corners;                ///< point index per polygon corner
    std::vector<std::uint32_t> counts;                 ///< [n_polygons] corners of each
    std::vector<std::uint32_t> polygon_parts;          ///< [n_polygons] index in `parts`
    std::vector<Vec2f> uvs;                            ///< [n_corners], v up, NaN where there is none; or empty
    std::vector<Vec3f> normals;  ///< [n_corners], unit, outward, NaN where there is none; or empty
    std::vector<FilePart> parts;
    std::vector<FileMaterial> materials;
    std::vector<Message> warnings;
    double stated_unit = 1;  ///< metres in the unit that the file states; 0: it states none, and points are in it

    void add_polygon(std::uint32_t part, std::span<const std::uint32_t> points, std::span<const Vec2f> polygon_uvs);
};

/// Returns the soup of a scene. Parts become groups. Materials get their pictures from the scene's bytes or from files
/// in the folder of `model`. Indices must be in range. Throws `Error` where there is no face.
mesh::PolygonSoup soup_of(FileScene&& scene, const std::filesystem::path& model);

/// Serialises a scene, and reads it back: an importer's process (import_process.h) sends it to this one. `unpack_scene`
/// checks all counts and indices. It throws `Error` naming `file` where one is wrong.
std::vector<char> pack_scene(const FileScene& scene);
FileScene unpack_scene(std::span<const char> bytes, const std::string& file);

}  // namespace tuft::io
