#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// The head of a PLY file (Turk 1994): which elements follow, and of what their rows are made.
/// Internal to `mesh`.
namespace tuft::mesh {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

enum class PlyType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Bytes of one value in a binary file.
std::size_t size_of(PlyType type);
bool is_real(PlyType type);

struct PlyProperty {
    std::string name;  ///< in lower case
    bool is_list = false;
    PlyType count_type = PlyType::kUint8;
    PlyType type = PlyType::kFloat32;
};

struct PlyElement {
    std::string name;  ///< in lower case
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    long line = 0;  ///< where the head declares it

    /// Fewest bytes one row can take.
    std::size_t least_row_size(PlyFormat format) const;
    bool has_list() const;
    /// Index of the first property with one of the names, or -1.
    int find(std::initializer_list<const char*> names) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::kAscii;
    std::vector<PlyElement> elements;
    std::vector<std::string> textures;  ///< names from "comment TextureFile"
    std::size_t body = 0;               ///< offset of the first byte after the head
    long body_line = 1;                 ///< its line
};

/// Throws `Error` with file and line for a head that is not whole or not PLY.
PlyHeader read_ply_header(const std::vector<char>& bytes, const std::string& file);

}  // namespace tuft::mesh
