#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/message.h"
#include "mesh/part_groups.h"

/// \file
/// Scene and helpers of the writers of glTF and OBJ. Inside `io` only. Any thread.
namespace tuft::io {

/// Vertices with one UV and one normal each, for formats that index all attributes together. In the order of first use
/// by the triangles.
struct Wedges {
    std::vector<std::uint32_t> vertex;        ///< [n_wedges] of the mesh
    std::vector<std::uint32_t> corner;        ///< [n_wedges] first corner with its UV and normal
    std::vector<std::uint32_t> corner_wedge;  ///< [3 n_triangles]
};

/// Splits the vertices of a mesh into wedges. Corners of a vertex share a wedge when their UVs and normals are equal
/// bit by bit and their triangles are on one page. `triangle_page`: [n_triangles], or empty: one page.
Wedges split_wedges(const mesh::TriangleMesh& mesh, std::span<const Vec2f> corner_uvs,
                    std::span<const std::uint32_t> triangle_page = {});

/// A map of the decoration as a PNG file.
struct EncodedMap {
    std::string kind;  ///< base_colour, orm, normal, transmission
    std::string file;  ///< name in the folder
    std::uint32_t page = 0;
    std::vector<unsigned char> png;
};

/// What a writer gets. The references must outlive it.
struct ExportScene {
    const mesh::TriangleMesh& mesh;
    const mesh::SourceScene& source;
    std::vector<std::uint8_t> decorated;       ///< [n_parts of source] gets the decorated material
    std::vector<std::uint8_t> transmits = {};  ///< [n_parts of source] its decorated material is glass; empty: none
    bool has_transmission = false;             ///< the format has a map of it
    Wedges wedges;
    /// Decorated parts have the UVs of the triangle's page, other parts those of the file.
    std::span<const Vec2f> corner_uvs;
    std::string name;
    bool y_up = false;  ///< of OBJ coordinates
    double metres_per_unit = 1e-3;
    double roughness = 0.3;                    ///< of the decorated material, in a format that has one number for it
    std::vector<std::uint32_t> udims{1001};    ///< of each page
    std::vector<std::uint32_t> triangle_page;  ///< [n_triangles], or empty: all on page 0

    std::uint32_t page_of(std::size_t triangle) const { return triangle_page.empty() ? 0 : triangle_page[triangle]; }
    /// Name of the decorated material on a page of glTF.
    std::string material_name(std::uint32_t page) const {
        return udims.size() > 1 ? std::string(mesh::kDecoratedMaterial) + "." + std::to_string(udims[page])
                                : mesh::kDecoratedMaterial;
    }
};

/// Returns the triangles of each part, ascending.
std::vector<std::vector<std::uint32_t>> triangles_of_parts(const ExportScene& scene);

/// Returns notes on the parts for the user, one line each.
std::vector<Message> notes_on_parts(const ExportScene& scene);

/// Writes GLB, or glTF with its files, by the extension. `path` lies in a staging folder. Throws `Error`.
void write_gltf(const std::filesystem::path& path, const ExportScene& scene, std::span<const EncodedMap> maps);
/// Writes OBJ, MTL and pictures into the folder of `path`, a staging folder. Throws `Error`.
void write_obj(const std::filesystem::path& path, const ExportScene& scene, std::span<const EncodedMap> maps);

/// Writes 3MF with the base colour as textures, in millimetres: one object, of type model where the mesh bounds a
/// solid, else surface. All triangles have the UVs of the atlas. Throws `Error`.
void write_3mf(const std::filesystem::path& path, const ExportScene& scene, std::span<const EncodedMap> maps);

/// Returns the stem of `path` with '_' for bytes that a URI or a line of an MTL file cannot hold. The files that a
/// model refers to are named after it.
std::string safe_stem(const std::filesystem::path& path);

/// Writes a whole file in the staging folder. Throws `Error`.
void write_staged(const std::filesystem::path& path, const void* data, std::size_t size);

}  // namespace tuft::io
