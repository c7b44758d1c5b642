#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// \file
/// Meshes in Draco's format, as glTF files hold them. Used by gltf_compression.cpp only; Draco's types stay here.
namespace draco {
class Mesh;
}

namespace tuft::io {

/// A decoded mesh.
class DracoMesh {
  public:
    /// Throws `Error` naming `file` where the bytes are damaged, or announce more than 32 triangles for each byte.
    DracoMesh(std::span<const unsigned char> bytes, const std::string& file);
    ~DracoMesh();
    DracoMesh(const DracoMesh&) = delete;
    DracoMesh& operator=(const DracoMesh&) = delete;

    std::size_t n_points() const;
    std::vector<std::uint32_t> indices() const;  ///< [3 n_triangles], below `n_points`
    /// Returns the rows of the attribute with this id as numbers of a glTF component type (5120 … 5126), row by row.
    /// Throws `Error` where there is none, or where it has another number of components.
    std::vector<unsigned char> rows(unsigned id, int component_type, int n_components) const;

  private:
    std::string file_;
    std::unique_ptr<draco::Mesh> mesh_;
};

}  // namespace tuft::io
