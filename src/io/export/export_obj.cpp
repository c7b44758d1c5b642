#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "io/export/export_formats.h"
#include "io/scene/json_number.h"
#include "io/scene/mtl_material.h"
#include "io/scene/scene_document.h"

namespace tuft::io {
namespace {

void append_number(std::string& out, double value, int digits) {
    char buffer[40];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
    out.append(buffer, end.ptr);
}

void append_row(std::string& out, const char* key, std::span<const double> values, int digits) {
    out += key;
    for (const double v : values) {
        out += ' ';
        append_number(out, v, digits);
    }
    out += '\n';
}

/// A name as the rest of a line: readers of OBJ take it up to the line's end, blanks and all.
std::string line_name(std::string name) {
    for (char& c : name)
        if (static_cast<unsigned char>(c) < ' ' || c == '#' || c == '\\') c = '_';
    const std::size_t begin = name.find_first_not_of(' ');
    if (begin == name.npos) return {};
    return name.substr(begin, name.find_last_not_of(' ') - begin + 1);
}

/// Names that a file can tell apart: a second one gets a number.
class UniqueNames {
  public:
    std::string get(const std::string& name) {
        std::string unlike = name;
        for (int n = 2; !taken_.insert(unlike).second; ++n) unlike = name + "_" + std::to_string(n);
        return unlike;
    }

  private:
    std::set<std::string> taken_;
};

/// Buffered writing of a text that may be larger than memory should hold twice.
class TextFile {
  public:
    explicit TextFile(const std::filesystem::path& path)
        : path_(path), file_(path, std::ios::binary | std::ios::trunc) {}
    std::string& text() {
        if (text_.size() > (1u << 20)) flush();
        return text_;
    }
    void close() {
        flush();
        file_.close();
        if (!file_) throw Error(path_.filename().string(), "could not be written to its end (disk full?)");
    }

  private:
    void flush() {
        file_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
        text_.clear();
    }
    std::filesystem::path path_;
    std::ofstream file_;
    std::string text_;
};

}  // namespace

Wedges split_wedges(const mesh::TriangleMesh& mesh, std::span<const Vec2f> corner_uvs,
                    std::span<const std::uint32_t> triangle_page) {
    Wedges out;
    out.corner_wedge.resize(3 * mesh.n_triangles());
    // Wedges of one vertex form a list; most vertices have one or two.
    std::vector<std::uint32_t> first(mesh.n_vertices(), kNone), next;
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
        return corner_uvs[a] == corner_uvs[b] && mesh.corner_normals[a] == mesh.corner_normals[b] &&
               (triangle_page.empty() || triangle_page[a / 3] == triangle_page[b / 3]);
    };
    for (std::uint32_t corner = 0; corner < out.corner_wedge.size(); ++corner) {
        const std::uint32_t vertex = mesh.triangles[corner / 3][corner % 3];
        std::uint32_t wedge = first[vertex];
        while (wedge != kNone && !same(out.corner[wedge], corner)) wedge = next[wedge];
        if (wedge == kNone) {
            wedge = static_cast<std::uint32_t>(out.vertex.size());
            out.vertex.push_back(vertex);
            out.corner.push_back(corner);
            next.push_back(first[vertex]);
            first[vertex] = wedge;
        }
        out.corner_wedge[corner] = wedge;
    }
    return out;
}

std::string safe_stem(const std::filesystem::path& path) {
    std::string name = path.stem().string();
    for (char& c : name) {
        const auto u = static_cast<unsigned char>(c);
        if (u < 0x80 && !std::isalnum(u) && c != '-' && c != '_' && c != '.') c = '_';
    }
    return name.empty() ? "model" : name;
}

void write_staged(const std::filesystem::path& path, const void* data, std::size_t size) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    file.close();
    if (!file) throw Error(path.filename().string(), "could not be written to its end (disk full?)");
}

namespace {

using nlohmann::json;

const json kNothing;

/// document[key][index], or null.
const json& item_of(const json& document, const char* key, std::size_t index) {
    const auto found = document.find(key);
    return found != document.end() && found->is_array() && index < found->size() ? (*found)[index] : kNothing;
}

/// Writes the pictures of the file's own materials beside the model, each when it is first asked
/// for.
class OwnPictures {
  public:
    OwnPictures(const ExportScene& scene, const json& document, std::filesystem::path folder)
        : scene_(scene), document_(document), folder_(std::move(folder)) {}

    /// Name of the file of a texture's picture, or "".
    std::string file_of(std::size_t texture) {
        const json& source = item_of(document_, "textures", texture);
        const std::size_t image =
            source.is_object() ? whole_number(source, "source", std::size_t{1} << 40) : std::size_t{1} << 40;
        const auto [it, is_new] = files_.try_emplace(image);
        if (is_new) it->second = write(item_of(document_, "images", image));
        return it->second;
    }

  private:
    std::string write(const json& image) {
        if (!image.is_object() || !image.contains("bufferView")) return {};
        const json& view = item_of(document_, "bufferViews", whole_number<std::size_t>(image["bufferView"]));
        if (!view.is_object()) return {};
        const std::size_t at = whole_number(view, "byteOffset", std::size_t{0}),
                          size = whole_number<std::size_t>(view.at("byteLength"));
        const std::vector<unsigned char>& buffer = scene_.source.buffer;
        if (at > buffer.size() || size > buffer.size() - at) return {};
        const std::string type = mime_type_of(std::span(buffer).subspan(at, size));
        const char* extension = type == "image/png"    ? ".png"
                                : type == "image/jpeg" ? ".jpg"
                                : type == "image/tiff" ? ".tif"
                                                       : "";
        if (*extension == 0) return {};
        const std::string stem =
            safe_stem(std::filesystem::path(image.value("name", "picture")).stem().string() + ".x");
        const std::string file = names_.get(scene_.name + "_" + stem) + extension;
        write_staged(folder_ / file, &buffer[at], size);
        return file;
    }

    const ExportScene& scene_;
    const json& document_;
    std::filesystem::path folder_;
    std::map<std::size_t, std::string> files_;
    UniqueNames names_;
};

/// The library with the decorated material, where a part has it, and those of the other parts;
/// returns the name of each part's material.
std::vector<std::string> write_library(const std::filesystem::path& path, const ExportScene& scene,
                                       std::span<const EncodedMap> maps) {
    std::string mtl;
    std::vector<std::string> name_of_part(scene.decorated.size(), "decorated");
    UniqueNames names;
    names.get("decorated");
    // Without maps only the UVs are new: materials keep their names, without the pictures that lay
    // by the old ones.
    const auto is_decorated = [&](std::size_t i) {
        return scene.decorated[i] && !(maps.empty() && scene.source.parts[i].own_material >= 0);
    };
    bool used = false;
    for (std::size_t i = 0; i < scene.decorated.size(); ++i) used = used || is_decorated(i);
    if (used)
        mtl = "newmtl decorated\nKa 0 0 0\nKd 1 1 1\nKs 0.04 0.04 0.04\n" + mtl_roughness(scene.roughness) +
              "Pm 0\nillum 2\n";
    for (const EncodedMap& map : maps) {
        write_staged(path.parent_path() / map.file, map.png.data(), map.png.size());
        if (map.page > 0 || !used) continue;
        const std::string file = scene.udims.size() == 1 ? map.file : scene.name + "_" + map.kind + ".<UDIM>.png";
        if (map.kind == "base_colour") mtl += "map_Kd " + file + "\n";
        if (map.kind == "normal")
            mtl += "norm " + file + "\nmap_Bump -bm 1 " + file + "\n";  // Blender reads the second
    }
    try {
        const json document = parse_document(scene.source);
        OwnPictures pictures(scene, document, path.parent_path());
        std::map<std::int32_t, std::string> written;
        for (std::size_t i = 0; i < scene.decorated.size(); ++i) {
            const mesh::ScenePart& part = scene.source.parts[i];
            if (is_decorated(i)) continue;
            const auto index = static_cast<std::size_t>(part.own_material);
            const auto [it, is_new] = written.try_emplace(part.own_material);
            if (is_new) {
                const std::string name = line_name(part.material);
                it->second = names.get(name.empty() ? "material" : name);
                mtl +=
                    mtl_entry(it->second, item_of(document, "materials", index), item_of(document, kStatements, index),
                              [&](std::size_t texture) { return scene.decorated[i] ? "" : pictures.file_of(texture); });
            }
            name_of_part[i] = it->second;
        }
    } catch (const json::exception&) {
        throw Error("the scene of the model cannot be written: its document is damaged");
    }
    write_staged(path.parent_path() / (safe_stem(path) + ".mtl"), mtl.data(), mtl.size());
    return name_of_part;
}

/// The faces, part by part.
void write_faces(TextFile& file, const ExportScene& scene, const std::vector<std::string>& materials) {
    const std::vector<std::vector<std::uint32_t>> of_part = triangles_of_parts(scene);
    const bool own_uvs = !scene.mesh.corner_uvs.empty();
    UniqueNames objects;
    std::map<std::pair<std::int32_t, std::string>, std::string> object_names;  // two nodes may have one name
    std::string object, group, material;
    for (std::size_t i = 0; i < of_part.size(); ++i) {
        if (of_part[i].empty()) continue;
        const mesh::ScenePart& part = scene.source.parts[i];
        std::string& text = file.text();
        const std::int32_t node = part.primitive >= 0 ? part.node : -1;
        const auto [it, is_new] = object_names.try_emplace({node, part.object});
        if (is_new) it->second = objects.get(part.object.empty() ? scene.name : line_name(part.object));
        if (it->second != object) text += "o " + (object = it->second) + "\n";
        // That of a glTF file is what its part is called, not a group.
        const std::string in_group = part.group.empty() || part.primitive >= 0 ? "" : line_name(part.group);
        if (in_group != group) text += "g " + (group = in_group) + "\n";
        if (materials[i] != material) text += "usemtl " + (material = materials[i]) + "\n";
        const bool with_uvs = scene.decorated[i] || own_uvs;
        for (const std::uint32_t t : of_part[i]) {
            std::string& out = file.text();
            out += 'f';
            for (int k = 0; k < 3; ++k) {
                const std::string wedge =
                    std::to_string(scene.wedges.corner_wedge[3 * std::size_t{t} + static_cast<std::size_t>(k)] + 1);
                out += ' ' + std::to_string(scene.mesh.triangles[t][static_cast<std::size_t>(k)] + 1) + '/' +
                       (with_uvs ? wedge : "") + '/' + wedge;
            }
            out += '\n';
        }
    }
}

}  // namespace

void write_obj(const std::filesystem::path& path, const ExportScene& scene, std::span<const EncodedMap> maps) {
    const mesh::TriangleMesh& mesh = scene.mesh;
    const Wedges& wedges = scene.wedges;
    const std::vector<std::string> materials = write_library(path, scene, maps);
    TextFile file(path);
    file.text() += "mtllib " + safe_stem(path) + ".mtl\n";
    const auto axes = [&](const Vec3& v) { return scene.y_up ? Vec3(v.x, v.z, -v.y) : v; };
    // Nine digits bring every float back, also through the change of unit.
    for (const Vec3f& p : mesh.positions) {
        const Vec3 q = axes(Vec3(p)) / scene.metres_per_unit;
        append_row(file.text(), "v", std::array{q.x, q.y, q.z}, 9);
    }
    for (const std::uint32_t corner : wedges.corner) {
        const bool decorated = scene.decorated[mesh::part_of(mesh, corner / 3)] != 0;
        const std::uint32_t tile = decorated ? scene.udims[scene.page_of(corner / 3)] - 1001 : 0;
        const Vec2 uv = Vec2(scene.corner_uvs[corner]) + Vec2(tile % 10, tile / 10);
        append_row(file.text(), "vt", std::array{uv.x, uv.y}, 9);
    }
    for (const std::uint32_t corner : wedges.corner) {
        const Vec3 n = axes(Vec3(mesh.corner_normals[corner]));
        append_row(file.text(), "vn", std::array{n.x, n.y, n.z}, 7);
    }
    write_faces(file, scene, materials);
    file.close();
}

}  // namespace tuft::io
