#include "mesh/read/polygon_soup.h"

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "core/files/files.h"
#include "mesh/read/text_cursor.h"

namespace tuft::mesh {
namespace {

void append(std::vector<char>& out, const auto& value) {
    const std::size_t at = out.size();
    out.resize(at + sizeof value);
    std::memcpy(out.data() + at, &value, sizeof value);
}

/// The UV of each point, or nothing where two corners of a point disagree.
std::vector<Vec2f> uvs_of_points(const PolygonSoup& soup) {
    std::vector<Vec2f> uvs(soup.points.size(), Vec2f(0));
    std::vector<bool> known(soup.points.size(), false);
    for (std::size_t c = 0; c < soup.corners.size(); ++c) {
        const std::uint32_t p = soup.corners[c];
        if (known[p] && uvs[p] != soup.corner_uvs[c]) return {};
        known[p] = true;
        uvs[p] = soup.corner_uvs[c];
    }
    return uvs;
}

}  // namespace

void drop_colours(PolygonSoup& soup) {
    soup.materials.clear();
    soup.point_colours.clear();
}

bool is_polygon_file(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    for (const char* known : {".obj", ".ply", ".stl", ".off"})
        if (same_word(extension, known)) return true;
    return false;
}

PolygonSoup read_polygon_file(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (!is_polygon_file(path))
        throw Error(path.string(), Message("{} is not a known kind of model; use .obj, .ply, .stl, .off or .glb",
                                           in_quotes(extension)));
    const std::vector<char> bytes = read_file(path);
    if (same_word(extension, ".obj")) return read_obj(bytes, path);
    if (same_word(extension, ".ply")) return read_ply(bytes, path);
    if (same_word(extension, ".stl")) return read_stl(bytes, path);
    return read_off(bytes, path);
}

void write_ply(const std::filesystem::path& path, const PolygonSoup& soup) {
    const bool has_colour = !soup.point_colours.empty();
    const bool has_uv = !soup.corner_uvs.empty();
    const std::vector<Vec2f> uvs = has_uv ? uvs_of_points(soup) : std::vector<Vec2f>();
    std::size_t longest = 0;
    for (std::size_t p = 0; p < soup.n_polygons(); ++p)
        longest = std::max<std::size_t>(longest, soup.polygon_start[p + 1] - soup.polygon_start[p]);
    const bool short_lists = 2 * longest <= 255;

    std::string head = "ply\nformat binary_little_endian 1.0\n";
    head += "element vertex " + std::to_string(soup.points.size()) + "\n";
    head += "property float x\nproperty float y\nproperty float z\n";
    if (!uvs.empty()) head += "property float s\nproperty float t\n";
    if (has_colour)
        head +=
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar alpha\n";
    const std::string list = short_lists ? "property list uchar " : "property list uint ";
    head += "element face " + std::to_string(soup.n_polygons()) + "\n";
    head += list + "int vertex_indices\n";
    if (has_uv && uvs.empty()) head += list + "float texcoord\n";
    head += "end_header\n";

    std::vector<char> out(head.begin(), head.end());
    out.reserve(head.size() + 24 * soup.points.size() + 4 * soup.n_polygons() + 12 * soup.corners.size());
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        for (int k = 0; k < 3; ++k) append(out, static_cast<float>(soup.points[i][k]));
        if (!uvs.empty()) append(out, uvs[i]);
        if (has_colour) append(out, soup.point_colours[i]);
    }
    const auto append_count = [&](std::size_t n) {
        if (short_lists)
            append(out, static_cast<std::uint8_t>(n));
        else
            append(out, static_cast<std::uint32_t>(n));
    };
    for (std::size_t p = 0; p < soup.n_polygons(); ++p) {
        const std::size_t begin = soup.polygon_start[p], end = soup.polygon_start[p + 1];
        append_count(end - begin);
        for (std::size_t c = begin; c < end; ++c) append(out, soup.corners[c]);
        if (!has_uv || !uvs.empty()) continue;
        append_count(2 * (end - begin));
        for (std::size_t c = begin; c < end; ++c) append(out, soup.corner_uvs[c]);
    }
    write_file(path, out.data(), out.size());
}

}  // namespace tuft::mesh
