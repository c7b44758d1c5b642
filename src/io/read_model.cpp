#include "io/read_model.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/files.h"
#include "io/read_gltf.h"

namespace tuft::io {
namespace {

enum class Format { obj, ply, stl, off, glb, gltf };

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

std::optional<Format> by_extension(const std::filesystem::path& path) {
    constexpr std::array<std::pair<std::string_view, Format>, 6> known{{{".obj", Format::obj},
                                                                        {".ply", Format::ply},
                                                                        {".stl", Format::stl},
                                                                        {".off", Format::off},
                                                                        {".glb", Format::glb},
                                                                        {".gltf", Format::gltf}}};
    const std::string extension = lower_extension(path);
    for (const auto& [name, format] : known)
        if (extension == name) return format;
    return std::nullopt;
}

/// Formats that say what they are in their first bytes.
std::optional<Format> by_content(std::string_view bytes) {
    if (bytes.starts_with("glTF")) return Format::glb;
    if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return Format::ply;
    for (const std::string_view magic :
         {"OFF", "COFF", "NOFF", "STOFF", "CNOFF", "STNOFF", "STCNOFF"})
        if (bytes.starts_with(magic) && bytes.size() > magic.size() &&
            std::isspace(static_cast<unsigned char>(bytes[magic.size()])))
            return Format::off;
    return std::nullopt;
}

}  // namespace

mesh::PolygonSoup read_model(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path);
    std::optional<Format> format =
        by_content({bytes.data(), std::min<std::size_t>(bytes.size(), 16)});
    if (!format) format = by_extension(path);
    if (!format)
        throw Error(path.string(),
                    "is no model format tuft knows; it reads OBJ, PLY, STL, OFF, GLB and glTF");
    switch (*format) {
        case Format::obj:
            return mesh::read_obj(bytes, path);
        case Format::ply:
            return mesh::read_ply(bytes, path);
        case Format::stl:
            return mesh::read_stl(bytes, path);
        case Format::off:
            return mesh::read_off(bytes, path);
        case Format::glb:
        case Format::gltf:
            return read_gltf(bytes, path);
    }
    return {};
}

std::optional<double> metres_per_unit_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".glb" || extension == ".gltf") return 1.0;
    return std::nullopt;
}

}  // namespace tuft::io
