#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// \file
/// Scene graph of a model's file: objects, groups and materials. Readers fill it; the mesh and the project carry it
/// unread; exports write it again (io/scene/scene_document.h).
namespace tuft::mesh {

/// Faces of one object, one group and one material of the file.
struct ScenePart {
    std::string object, group, material;  ///< names in the file; empty: none
    std::int32_t node = -1;               ///< index in the document's nodes
    std::int32_t primitive = -1;          ///< of the node's mesh; -1: the document has no triangles
    std::int32_t own_material = -1;       ///< index in the document's materials; -1: none
    /// From the node's frame to the document's (metres, y up), by columns.
    std::array<double, 16> transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

    bool operator==(const ScenePart&) const = default;
};

/// Objects, groups and materials of a model's file.
struct SourceScene {
    std::vector<ScenePart> parts;
    std::string document;               ///< JSON of a glTF 2.0 file with one buffer and no outside files
    std::vector<unsigned char> buffer;  ///< the bytes of that buffer
};

}  // namespace tuft::mesh
