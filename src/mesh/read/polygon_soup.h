#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "mesh/material.h"
#include "mesh/source_scene.h"

/// What a model file says, before anything is repaired: polygons with any number
/// of corners over shared points. Readers make it, `build_surface` cleans it.
namespace tuft::mesh {

struct PolygonSoup {
    std::vector<Vec3> points;                                ///< in the file's unit
    std::vector<std::uint32_t> corners;                      ///< point index per polygon corner, all polygons in a row
    std::vector<std::uint32_t> polygon_start;                ///< [n_polygons + 1] offsets into `corners`
    std::vector<Vec2f> corner_uvs;                           ///< parallel to `corners`, v up, or empty
    std::vector<std::array<std::uint8_t, 4>> point_colours;  ///< [n_points] or empty
    std::vector<std::uint32_t> polygon_groups;               ///< [n_polygons] or empty
    std::vector<std::string> group_names;
    std::vector<Material> materials;  ///< one per group, or one for all faces without groups, or empty
    /// Materials that lie in other files, which `io::read_model` reads: OBJ's libraries; one name per
    /// material (as above), of an entry there, or of a picture where there is no library.
    std::vector<std::string> material_libraries, material_names;
    /// What the file says of its objects and their materials, or null. Its parts are the groups, unless
    /// `polygon_parts` [n_polygons] says of each face in which part it is; all faces of a part are in one group.
    std::shared_ptr<SourceScene> scene;
    std::vector<std::uint32_t> polygon_parts;
    std::vector<std::string> warnings;  ///< one line each: what the reader dropped, with line numbers

    std::size_t n_polygons() const { return polygon_start.empty() ? 0 : polygon_start.size() - 1; }
};

/// Leaves aside what the file says of colours.
void drop_colours(PolygonSoup& soup);

/// Readers for one format each; `path` is only used in messages. They throw
/// `tuft::Error` with file and line, check every count against the bytes that are
/// there before taking memory, and every index against the number of points.
/// Rows with NaN or infinity are dropped together with the polygons that use
/// them and reported by line in `warnings`.
PolygonSoup read_obj(const std::vector<char>& bytes, const std::filesystem::path& path);
PolygonSoup read_ply(const std::vector<char>& bytes, const std::filesystem::path& path);
PolygonSoup read_stl(const std::vector<char>& bytes, const std::filesystem::path& path);
PolygonSoup read_off(const std::vector<char>& bytes, const std::filesystem::path& path);

/// Whether `read_polygon_file` knows the extension of `path` (in any case).
bool is_polygon_file(const std::filesystem::path& path);

/// Reads an .obj, .ply, .stl or .off file by its extension.
PolygonSoup read_polygon_file(const std::filesystem::path& path);

/// Binary little-endian PLY of a soup: positions as float, colours, and UVs per vertex where all
/// corners of a point agree, else per face (the `texcoord` list). Written atomically.
void write_ply(const std::filesystem::path& path, const PolygonSoup& soup);

}  // namespace tuft::mesh
