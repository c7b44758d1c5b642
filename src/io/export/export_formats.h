#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/message.h"
#include "mesh/triangle_mesh.h"

/// What the writers of the single formats share; inside `io` only.
namespace tuft::io {

/// Vertices with one UV and one normal each: file formats that index all attributes
/// together need them. In the order of first use by the triangles.
struct Wedges {
    std::vector<std::uint32_t> vertex;        ///< [n_wedges] of the mesh
    std::vector<std::uint32_t> corner;        ///< [n_wedges] a corner that has its UV and normal
    std::vector<std::uint32_t> corner_wedge;  ///< [3 n_triangles]
};

/// Corners of a vertex with equal UV and normal, to the bit, share a wedge, where their triangles
/// lie on one page (`triangle_page` [n_triangles], or empty: all do).
Wedges split_wedges(const mesh::TriangleMesh& mesh, std::span<const Vec2f> corner_uvs,
                    std::span<const std::uint32_t> triangle_page = {});

struct EncodedMap {
    std::string kind;  ///< base_colour, orm, normal
    std::string file;  ///< name in the folder
    std::uint32_t page = 0;
    std::vector<unsigned char> png;
};

struct ExportScene {
    const mesh::TriangleMesh& mesh;
    const mesh::SourceScene& source;
    std::vector<std::uint8_t> decorated;  ///< [n_parts of source] gets the decorated material
    Wedges wedges;
    /// Of decorated parts those of the triangle's own page, of others those of the file.
    std::span<const Vec2f> corner_uvs;
    std::string name;
    bool y_up = false;  ///< of OBJ coordinates
    double metres_per_unit = 1e-3;
    std::vector<std::uint32_t> udims{1001};    ///< of each page
    std::vector<std::uint32_t> triangle_page;  ///< [n_triangles], or empty: all on page 0

    std::uint32_t page_of(std::size_t triangle) const { return triangle_page.empty() ? 0 : triangle_page[triangle]; }
    /// Name of the decorated material on a page of glTF.
    std::string material_name(std::uint32_t page) const {
        return udims.size() > 1 ? "decorated." + std::to_string(udims[page]) : "decorated";
    }
};

/// The triangles of each part, in their order.
std::vector<std::vector<std::uint32_t>> triangles_of_parts(const ExportScene& scene);

/// What a user should know of the parts, one line each.
std::vector<Message> notes_on_parts(const ExportScene& scene);

/// GLB, or glTF with its files, by the extension; `path` lies in a staging folder.
void write_gltf(const std::filesystem::path& path, const ExportScene& scene, std::span<const EncodedMap> maps);
/// OBJ, MTL and pictures.
void write_obj(const std::filesystem::path& path, const ExportScene& scene, std::span<const EncodedMap> maps);

/// The stem of `path` with bytes that a URI or a line of an MTL file cannot hold replaced
/// by '_': the files that a model refers to are named after it.
std::string safe_stem(const std::filesystem::path& path);

/// A whole file in the staging folder.
void write_staged(const std::filesystem::path& path, const void* data, std::size_t size);

}  // namespace tuft::io
