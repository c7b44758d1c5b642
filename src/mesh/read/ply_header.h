#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// \file
/// Header of a PLY file [Turk1994]: its elements and the layout of their rows. Used by the PLY reader only.
namespace tuft::mesh {

/// Encoding of the rows.
enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

/// Type of a value.
enum class PlyType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Bytes of one value in a binary file.
std::size_t size_of(PlyType type);
bool is_real(PlyType type);

/// Property of a row.
struct PlyProperty {
    std::string name;  ///< in lower case
    bool is_list = false;
    PlyType count_type = PlyType::kUint8;
    PlyType type = PlyType::kFloat32;
};

/// Rows of one kind.
struct PlyElement {
    std::string name;  ///< in lower case
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    long line = 0;  ///< of its declaration

    /// Returns the smallest number of bytes of one row.
    std::size_t least_row_size(PlyFormat format) const;
    bool has_list() const;
    /// Index of the first property with one of the names, or -1.
    int find(std::initializer_list<const char*> names) const;
};

/// Header of a PLY file.
struct PlyHeader {
    PlyFormat format = PlyFormat::kAscii;
    std::vector<PlyElement> elements;
    std::vector<std::string> textures;  ///< names from "comment TextureFile"
    std::size_t body = 0;               ///< offset of the first byte after the header
    long body_line = 1;                 ///< its line
};

/// Parses the header. Throws `Error` with file and line when it is incomplete or not PLY.
PlyHeader read_ply_header(const std::vector<char>& bytes, const std::string& file);

}  // namespace tuft::mesh
