#include "io/model/read_model.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/files/extension.h"
#include "core/files/files.h"
#include "core/text/units.h"
#include "io/gltf/read_gltf.h"
#include "io/model/read_3mf.h"
#include "io/model/read_vrml.h"
#include "io/model/read_x3d.h"
#include "io/scene/materials.h"

namespace tuft::io {
namespace {

constexpr std::size_t kHead = 96;  // bytes that show the format

enum class Format { obj, ply, stl, off, glb, gltf, fbx, dae, threemf, x3d, vrml, step, iges };

std::optional<Format> by_extension(const std::filesystem::path& path) {
    constexpr std::array<std::pair<std::string_view, Format>, 17> known{{{".obj", Format::obj},
                                                                         {".ply", Format::ply},
                                                                         {".stl", Format::stl},
                                                                         {".off", Format::off},
                                                                         {".glb", Format::glb},
                                                                         {".gltf", Format::gltf},
                                                                         {".fbx", Format::fbx},
                                                                         {".dae", Format::dae},
                                                                         {".3mf", Format::threemf},
                                                                         {".x3d", Format::x3d},
                                                                         {".x3dv", Format::vrml},
                                                                         {".wrl", Format::vrml},
                                                                         {".vrml", Format::vrml},
                                                                         {".step", Format::step},
                                                                         {".stp", Format::step},
                                                                         {".iges", Format::iges},
                                                                         {".igs", Format::iges}}};
    const std::string extension = lower_extension(path);
    for (const auto& [name, format] : known)
        if (extension == name) return format;
    return std::nullopt;
}

/// A first line of IGES [IGES53 2.2.4.1]: 80 columns, in column 73 the section, then the number of the line.
bool is_iges_line(std::string_view bytes) {
    constexpr std::size_t kSection = 72, kColumns = 80;
    if (bytes.size() <= kColumns || (bytes[kColumns] != '\n' && bytes[kColumns] != '\r')) return false;
    const std::string_view number = bytes.substr(kSection + 1, kColumns - kSection - 1);
    return bytes[kSection] == 'S' && number.back() == '1' && number.find_first_not_of(" 01") == number.npos &&
           bytes.substr(0, kSection).find_first_of("\r\n") == number.npos;
}

/// Formats that say what they are in their first bytes.
std::optional<Format> by_content(std::string_view bytes) {
    if (bytes.starts_with("\xef\xbb\xbf#")) bytes.remove_prefix(3);  // the mark of UTF-8
    if (bytes.starts_with("glTF")) return Format::glb;
    if (bytes.starts_with("Kaydara FBX")) return Format::fbx;
    if (bytes.starts_with("#VRML V") || bytes.starts_with("#X3D V")) return Format::vrml;
    if (bytes.starts_with("ISO-10303-21;")) return Format::step;
    if (is_iges_line(bytes)) return Format::iges;
    if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return Format::ply;
    for (const std::string_view magic : {"OFF", "COFF", "NOFF", "STOFF", "CNOFF", "STNOFF", "STCNOFF"})
        if (bytes.starts_with(magic) && bytes.size() > magic.size() &&
            (std::isspace(static_cast<unsigned char>(bytes[magic.size()])) ||
             std::isdigit(static_cast<unsigned char>(bytes[magic.size()]))))
            return Format::off;
    return std::nullopt;
}

/// A chord tolerance is in metres of the model, the reader's in those that the file states, which is known then.
mesh::PolygonSoup read_cad_in(CadFormat format, const std::vector<char>& bytes, const std::filesystem::path& path,
                              const CadReading& how) {
    if (how.chord <= 0 || how.unit.empty()) return read_cad(format, bytes, path, how);
    CadReading scaled = how;
    scaled.chord = 0;  // the tolerance may be none at all in the other unit
    scaled.chord = how.chord / *metres_per_unit(read_cad(format, bytes, path, scaled), how.unit);
    return read_cad(format, bytes, path, scaled);
}

mesh::PolygonSoup read_polygons(Format format, const std::vector<char>& bytes, const std::filesystem::path& path,
                                const CadReading& cad) {
    switch (format) {
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
        case Format::fbx:
            return read_fbx(bytes, path);
        case Format::dae:
            return read_dae(bytes, path);
        case Format::threemf:
            return read_3mf(bytes, path);
        case Format::x3d:
            return read_x3d(bytes, path);
        case Format::vrml:
            return read_vrml(bytes, path);
        case Format::step:
            return read_cad_in(CadFormat::step, bytes, path, cad);
        case Format::iges:
            return read_cad_in(CadFormat::iges, bytes, path, cad);
    }
    return {};
}

}  // namespace

bool is_model_file(const std::filesystem::path& path) {
    return by_extension(path).has_value();
}

bool is_cad_file(const std::filesystem::path& path) {
    const std::optional<Format> format = by_extension(path);
    return format == Format::step || format == Format::iges;
}

bool states_unit(const std::filesystem::path& path) {
    const std::optional<Format> format = by_extension(path);
    if (!format) return false;
    const std::string extension = lower_extension(path);
    return *format > Format::off && extension != ".wrl" && extension != ".vrml";
}

mesh::PolygonSoup read_model(const std::filesystem::path& path, const CadReading& cad) {
    const std::vector<char> bytes = read_file(path);
    std::optional<Format> format = by_content({bytes.data(), std::min(bytes.size(), kHead)});
    if (!format) format = by_extension(path);
    if (!format)
        throw Error(path.string(), Message("is no model format tuft knows; it reads {}", std::string(kModelFormats)));
    if (bytes.size() >= 2 &&
        (std::memcmp(bytes.data(), "\xff\xfe", 2) == 0 || std::memcmp(bytes.data(), "\xfe\xff", 2) == 0))
        throw Error(path.string(), "is text in UTF-16; save it as UTF-8 or ASCII");
    mesh::PolygonSoup soup = read_polygons(*format, bytes, path, cad);
    read_materials(soup, path);
    return soup;
}

bool overrides_unit(const mesh::PolygonSoup& soup, const std::string& unit) {
    constexpr double kSame = 1e-6;  // FBX stores floats
    const std::optional<double> said = metres_per(unit);
    return said && soup.stated_unit > 0 && std::abs(*said / soup.stated_unit - 1) > kSame;
}

std::optional<double> metres_per_unit(const mesh::PolygonSoup& soup, const std::string& unit) {
    const std::optional<double> said = metres_per(unit);
    if (soup.stated_unit > 0) return overrides_unit(soup, unit) ? *said / soup.stated_unit : 1.0;  // points in metres
    return said;
}

}  // namespace tuft::io
