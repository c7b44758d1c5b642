#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// \file
/// Meshes in Draco's format, as glTF files hold them. Used by gltf_compression.cpp only. Draco is in a module of its
/// own, `tuft_draco` (draco_module.cpp), which is loaded with the first such mesh: its shared library exports another
/// tinygltf, which must not take the place of ours.
namespace tuft::io {

/// A decoded mesh; the module implements it. No function throws but for want of memory.
class DracoMesh {
  public:
    virtual ~DracoMesh() = default;
    virtual std::size_t n_points() const = 0;
    /// [3 n_triangles], below `n_points`. Returns false where the mesh is damaged.
    virtual bool indices(std::vector<std::uint32_t>& out) const = 0;
    /// Rows of the attribute with this id as numbers of a glTF component type (5120 … 5126), row by row. Returns false
    /// where there is none, or where it has another number of components.
    virtual bool rows(unsigned id, int component_type, int n_components, std::vector<unsigned char>& out) const = 0;
};

/// Decodes a stream. Throws `Error` naming `file` where it is damaged, has another bitstream than 2.2, has metadata, or
/// announces more than 32 triangles for each byte.
std::unique_ptr<DracoMesh> decode_draco(std::span<const unsigned char> bytes, const std::string& file);

/// The module's function of this name takes a stream and returns its mesh, or null where it is damaged.
inline constexpr const char* kDracoSymbol = "tuft_decode_draco";
using DracoDecoder = DracoMesh* (*)(const unsigned char* bytes, std::size_t size);

}  // namespace tuft::io
