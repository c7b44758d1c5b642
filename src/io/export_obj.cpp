#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>

#include "core/error.h"
#include "io/export_formats.h"

namespace tuft::io {
namespace {

void append_number(std::string& out, double value, int digits) {
    char buffer[40];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
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

std::string one_word(std::string name) {
    for (char& c : name)
        if (static_cast<unsigned char>(c) <= ' ') c = '_';
    return name.empty() ? "model" : name;
}

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
        if (!file_)
            throw Error(path_.filename().string(), "could not be written to its end (disk full?)");
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

Wedges split_wedges(const mesh::TriangleMesh& mesh, std::span<const Vec2f> corner_uvs) {
    Wedges out;
    out.corner_wedge.resize(3 * mesh.n_triangles());
    // Wedges of one vertex form a list; most vertices have one or two.
    std::vector<std::uint32_t> first(mesh.n_vertices(), kNone), next;
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
        return corner_uvs[a] == corner_uvs[b] && mesh.corner_normals[a] == mesh.corner_normals[b];
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
    if (!file)
        throw Error(path.filename().string(), "could not be written to its end (disk full?)");
}

void write_obj(const std::filesystem::path& path, const ExportScene& scene,
               std::span<const EncodedMap> maps) {
    const mesh::TriangleMesh& mesh = scene.mesh;
    const Wedges& wedges = scene.wedges;
    std::string mtl = "newmtl decorated\nKa 0 0 0\nKd 1 1 1\nKs 0.04 0.04 0.04\nillum 2\n";
    for (const EncodedMap& map : maps) {
        write_staged(path.parent_path() / map.file, map.png.data(), map.png.size());
        if (map.page > 0) continue;
        const std::string file =
            scene.udims.size() == 1 ? map.file : scene.name + "_" + map.kind + ".<UDIM>.png";
        if (map.kind == "base_colour") mtl += "map_Kd " + file + "\n";
        if (map.kind == "normal") mtl += "norm " + file + "\n";
    }
    const std::string mtl_name = safe_stem(path) + ".mtl";
    write_staged(path.parent_path() / mtl_name, mtl.data(), mtl.size());

    TextFile file(path);
    file.text() += "mtllib " + mtl_name + "\no " + one_word(scene.name) + "\n";
    const auto axes = [&](const Vec3& v) { return scene.y_up ? Vec3(v.x, v.z, -v.y) : v; };
    // Nine digits bring every float back, also through the change of unit.
    for (const Vec3f& p : mesh.positions) {
        const Vec3 q = axes(Vec3(p)) / scene.metres_per_unit;
        append_row(file.text(), "v", std::array{q.x, q.y, q.z}, 9);
    }
    for (const std::uint32_t corner : wedges.corner) {
        const std::uint32_t tile = scene.udims[scene.page_of(corner / 3)] - 1001;
        const Vec2 uv = Vec2(scene.corner_uvs[corner]) + Vec2(tile % 10, tile / 10);
        append_row(file.text(), "vt", std::array{uv.x, uv.y}, 9);
    }
    for (const std::uint32_t corner : wedges.corner) {
        const Vec3 n = axes(Vec3(mesh.corner_normals[corner]));
        append_row(file.text(), "vn", std::array{n.x, n.y, n.z}, 7);
    }
    file.text() += "usemtl decorated\n";
    std::uint32_t group = kNone;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        std::string& out = file.text();
        if (!mesh.triangle_groups.empty() && mesh.triangle_groups[t] != group) {
            group = mesh.triangle_groups[t];
            out += "g " + one_word(group < mesh.group_names.size() ? mesh.group_names[group] : "") +
                   "\n";
        }
        out += 'f';
        for (int k = 0; k < 3; ++k) {
            const std::string wedge = std::to_string(wedges.corner_wedge[3 * t + k] + 1);
            out += ' ' + std::to_string(mesh.triangles[t][k] + 1) + '/' + wedge + '/' + wedge;
        }
        out += '\n';
    }
    file.close();
}

}  // namespace tuft::io
