#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "core/message.h"
#include "mesh/material.h"
#include "mesh/source_scene.h"

/// \file
/// Content of a model file before repair: polygons with any number of corners over shared points. Readers make it;
/// `build_surface` (repair.h) repairs it.
namespace tuft::mesh {

/// Content of a mesh file: polygons over shared points.
struct PolygonSoup {
    std::vector<Vec3> points;                  ///< in the file's unit, or in metres where it states its unit
    std::vector<std::uint32_t> corners;        ///< point index per polygon corner, all polygons in a row
    std::vector<std::uint32_t> polygon_start;  ///< [n_polygons + 1] offsets into `corners`
    std::vector<Vec2f> corner_uvs;             ///< parallel to `corners`, v up, or empty
    /// Parallel to `corners`, or empty: unit normals of the surface that the file defines, in its axes, to the side
    /// from which the corners run counter-clockwise; NaN where it defines none.
    std::vector<Vec3f> corner_normals;
    std::vector<std::array<std::uint8_t, 4>> point_colours;  ///< [n_points] or empty
    std::vector<std::uint32_t> polygon_groups;               ///< [n_polygons] or empty
    std::vector<std::string> group_names;
    std::vector<Material> materials;  ///< one per group, or one for all faces without groups, or empty
    /// Materials of other files, which `io::read_model` reads. `material_libraries` are OBJ's libraries.
    /// `material_names` has one name per material (as above): an entry of a library, or a picture where there is no
    /// library.
    std::vector<std::string> material_libraries, material_names;
    /// Objects and materials of the file, or null. Its parts are the groups, unless `polygon_parts` [n_polygons]
    /// gives the part of each face. All faces of a part belong to one group.
    std::shared_ptr<SourceScene> scene;
    std::vector<std::uint32_t> polygon_parts;
    std::vector<Message> warnings;  ///< one line each: what the reader dropped, and the line numbers
    double stated_unit = 0;  ///< metres in the unit that the file states, by which it was read; 0: it states none
    bool turned_up = false;  ///< its format defines axes, by which the points were turned z up

    std::size_t n_polygons() const { return polygon_start.empty() ? 0 : polygon_start.size() - 1; }
};

/// Removes all colours and materials.
void drop_colours(PolygonSoup& soup);

/// Readers for one format each; `path` appears in messages only. They throw `tuft::Error` with file and line. They
/// check every count against the bytes present before they allocate, and every index against the number of points.
/// They drop rows with NaN or infinity and the polygons that use them, and report the lines in `warnings`.
PolygonSoup read_obj(const std::vector<char>& bytes, const std::filesystem::path& path);
PolygonSoup read_ply(const std::vector<char>& bytes, const std::filesystem::path& path);
PolygonSoup read_stl(const std::vector<char>& bytes, const std::filesystem::path& path);
PolygonSoup read_off(const std::vector<char>& bytes, const std::filesystem::path& path);

/// Returns true when `read_polygon_file` reads the extension of `path`, in upper or lower case.
bool is_polygon_file(const std::filesystem::path& path);

/// Reads an .obj, .ply, .stl or .off file by its extension.
PolygonSoup read_polygon_file(const std::filesystem::path& path);

/// Writes a soup as binary little-endian PLY: float positions, colours and UVs. UVs are per vertex where all
/// corners of a point agree, otherwise per face (the `texcoord` list). The write is atomic.
void write_ply(const std::filesystem::path& path, const PolygonSoup& soup);

}  // namespace tuft::mesh
