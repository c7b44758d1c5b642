#include "io/export/export.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <system_error>

#include "core/error.h"
#include "core/files/path_fault.h"
#include "core/files/system_message.h"
#include "core/system/interrupt.h"
#include "core/system/parallel.h"
#include "core/text/units.h"
#include "io/export/export_formats.h"
#include "io/image/image.h"
#include "io/scene/scene_document.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

bool has_height(const ModelMaps& maps, const ExportOptions& options) {
    if (!options.normals_from_height) return false;
    for (const float h : maps.height.texels)
        if (h != 0) return true;
    return false;
}

struct MapFile {
    const char* suffix;
    bool present;
};

bool is_gltf(const std::string& extension) {
    return extension == ".glb" || extension == ".gltf";
}

std::vector<MapFile> map_files(const ModelMaps& maps, const ExportOptions& options, const std::string& extension) {
    return {{"base_colour", !maps.base_colour.texels.empty()},
            {"orm", !maps.orm.texels.empty()},
            {"normal", has_height(maps, options)},
            {"transmission", is_gltf(extension) && !maps.transmission.texels.empty()}};
}

/// Fills in the pages of the scene and their UVs, which are returned; no UVs with one page and without parts
/// that keep those of the file.
std::vector<Vec2f> split_pages(const atlas::Atlas& atlas, ExportScene& scene) {
    std::vector<Vec2f> uvs;
    const mesh::TriangleMesh& mesh = scene.mesh;
    const bool own = !mesh.corner_uvs.empty() && std::count(scene.decorated.begin(), scene.decorated.end(), 0) > 0;
    scene.udims = {atlas::udim_of(atlas, 0)};
    if (atlas.pages == 1 && !own) return uvs;
    scene.udims.clear();
    for (std::uint32_t page = 0; page < atlas.pages; ++page) scene.udims.push_back(atlas::udim_of(atlas, page));
    if (atlas.pages > 1) scene.triangle_page.resize(mesh.n_triangles());
    uvs = atlas.corner_uvs;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const bool keeps = own && !scene.decorated[mesh::part_of(mesh, t)];
        if (atlas.pages > 1) scene.triangle_page[t] = keeps ? 0 : std::min(atlas.page_of(t), atlas.pages - 1);
        for (std::size_t c = 3 * t; c < 3 * t + 3; ++c)
            if (keeps)
                uvs[c] = mesh.corner_uvs[c];
            else if (atlas.pages > 1)
                uvs[c] = Vec2f(atlas::page_uv(atlas, scene.triangle_page[t], atlas.corner_uvs[c]));
    }
    scene.corner_uvs = uvs;
    return uvs;
}

/// Where one page of a part gets the decorated material, its other pages get it, too: it stays one part.
void decorate_all_pages(const mesh::TriangleMesh& mesh, const mesh::SourceScene& source,
                        std::vector<std::uint8_t>& decorated) {
    std::vector<bool> paged(decorated.size()), in_group(mesh.group_names.size(), false);
    for (std::size_t i = 0; i < paged.size(); ++i) paged[i] = mesh::decorated_page(source.parts[i].material) > 0;
    if (mesh.triangle_groups.empty() || std::ranges::find(paged, true) == paged.end()) return;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        if (const std::uint32_t part = mesh::part_of(mesh, t); paged[part] && decorated[part])
            in_group[mesh.triangle_groups[t]] = true;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        if (const std::uint32_t part = mesh::part_of(mesh, t); paged[part] && in_group[mesh.triangle_groups[t]])
            decorated[part] = 1;
}

/// Parts that carry ink, those to which the file gave no material, and those whose pictures lie on UDIM tiles, for
/// which the document of the scene has no place.
std::vector<std::uint8_t> decorated_parts(const mesh::TriangleMesh& mesh, const mesh::SourceScene& source,
                                          const std::vector<std::uint8_t>& painted) {
    std::vector<std::uint8_t> decorated(source.parts.size(), 1);
    const auto is_tiled = [&](std::size_t i) {
        return source.parts[i].primitive < 0 && mesh.materials.size() == decorated.size() &&
               !mesh.materials[i].tiles.empty();
    };
    for (std::size_t i = 0; i < decorated.size() && i < painted.size(); ++i)
        decorated[i] = painted[i] || source.parts[i].own_material < 0 || is_tiled(i);
    decorate_all_pages(mesh, source, decorated);
    return decorated;
}

void check_parts(const mesh::TriangleMesh& mesh, const mesh::SourceScene& source) {
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        if (mesh::part_of(mesh, t) >= source.parts.size()) throw Error("a triangle is in a part that does not exist");
}

/// The median of the green channel; texels of no chart are black.
double median_roughness(const ink::AtlasMap<std::uint8_t>& orm) {
    std::array<std::size_t, 256> count{};
    std::size_t all = 0;
    for (std::size_t i = 1; i < orm.texels.size(); i += 3)
        if (orm.texels[i] > 0) ++count[orm.texels[i]], ++all;
    std::size_t below = 0, value = 0;
    while (value < 255 && 2 * (below += count[value]) < all) ++value;
    return static_cast<double>(value) / 255;
}

}  // namespace

ModelMaps make_maps(const ink::Stack& stack, const atlas::TexelMap& texels, const ink::Substrate& substrate,
                    const ink::ComposeOptions& options) {
    return {.base_colour = compose_srgb8(stack, texels, substrate, options),
            .orm = compose_orm8(stack, texels, substrate, options),
            .height = compose_height(stack, texels, options),
            .transmission = compose_transmission8(stack, texels, substrate, options)};
}

ink::AtlasMap<float> normal_map_float(const ink::AtlasMap<float>& height, double texel_size) {
    ink::AtlasMap<float> out{.size = height.size, .channels = 3, .texels = {}};
    const std::size_t n = height.size;
    out.texels.resize(n * n * 3);
    const auto scale = static_cast<float>(0.5e-6 / texel_size);
    parallel_for(n, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            const float* row = &height.texels[y * n];
            const float* below = y > 0 ? row - n : row;
            const float* above = y + 1 < n ? row + n : row;
            float* to = &out.texels[y * n * 3];
            for (std::size_t x = 0; x < n; ++x, to += 3) {
                const float dx = scale * (row[x + 1 < n ? x + 1 : x] - row[x > 0 ? x - 1 : x]);
                const float dy = scale * (above[x] - below[x]);
                const float nx = std::fmin(std::fmax(-dx, -1.0f), 1.0f);
                const float ny = std::fmin(std::fmax(-dy, -1.0f), 1.0f);
                const float length = std::sqrt(nx * nx + ny * ny + 1);
                to[0] = nx / length;
                to[1] = ny / length;
                to[2] = 1 / length;
            }
        }
    });
    return out;
}

namespace {

template <class T>
ink::AtlasMap<T> encoded_normals(const ink::AtlasMap<float>& height, double texel_size) {
    const ink::AtlasMap<float> normals = normal_map_float(height, texel_size);
    ink::AtlasMap<T> out{.size = normals.size, .channels = 3, .texels = {}};
    out.texels.resize(normals.texels.size());
    constexpr float kHalf = 0.5f * static_cast<float>(std::numeric_limits<T>::max());
    parallel_for(out.texels.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            out.texels[i] = static_cast<T>(std::lround((normals.texels[i] + 1) * kHalf));
    });
    return out;
}

}  // namespace

ink::AtlasMap<std::uint8_t> normal_map(const ink::AtlasMap<float>& height, double texel_size) {
    return encoded_normals<std::uint8_t>(height, texel_size);
}

ink::AtlasMap<std::uint16_t> normal_map16(const ink::AtlasMap<float>& height, double texel_size) {
    return encoded_normals<std::uint16_t>(height, texel_size);
}

ink::AtlasMap<std::uint16_t> height16(const ink::AtlasMap<float>& height) {
    ink::AtlasMap<std::uint16_t> out{.size = height.size, .channels = 1, .texels = {}};
    out.texels.reserve(height.texels.size());
    for (const float h : height.texels)
        out.texels.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(100 * h, 0.0f, 65535.0f))));
    return out;
}

std::string channel_name(const std::string& pigment) {
    std::string name = pigment;
    std::replace(name.begin(), name.end(), '.', '-');
    if (name.size() == 1 && std::string_view("RGBAYZrgbayz").find(name[0]) != std::string_view::npos) name += '-';
    return name;
}

void write_together(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code ec;
    check_output_folder(path);
    const fs::path folder = parent / ("." + path.stem().string() + ".part" + std::to_string(::getpid()));
    const Unfinished unfinished(folder);
    struct Cleanup {
        fs::path folder;
        ~Cleanup() {
            std::error_code ignored;
            fs::remove_all(folder, ignored);
        }
    };
    fs::remove_all(folder, ec);
    if (!fs::create_directory(folder, ec))
        throw Error(path.string(), Message("cannot be written: {}", system_message(ec)));
    const Cleanup cleanup{folder};
    try {
        write(folder);
    } catch (const Error& error) {
        // What is written to the folder will lie beside it.
        const auto parts = error.message().arguments();
        if (parts.size() != 2 || fs::path(parts[0].text()).filename() != fs::path(parts[0].text()) ||
            error.message() != Message("{}: {}", parts[0], parts[1]))
            throw;
        throw Error((parent / parts[0].text()).string(), parts[1]);
    }
    // The model comes last, so that it never points to files that are not there yet.
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end(), [&](const fs::path& a, const fs::path& b) {
        return (a.filename() == path.filename()) < (b.filename() == path.filename());
    });
    for (const fs::path& file : files) {
        fs::rename(file, parent / file.filename(), ec);
        if (ec) throw Error((parent / file.filename()).string(), Message("cannot be written: {}", system_message(ec)));
    }
}

PixelView page_view(const PixelView& whole, const atlas::Atlas& atlas, std::uint32_t page) {
    const std::uint32_t k = atlas.pages_per_side();
    const auto side = static_cast<int>(atlas.page_size());
    const int column = static_cast<int>(page % k), row = static_cast<int>(k - 1 - page / k);
    const std::ptrdiff_t texel = std::abs(whole.row_bytes) / whole.width;
    PixelView view = whole;
    view.width = view.height = side;
    view.first = static_cast<const char*>(whole.first) + std::ptrdiff_t{row} * side * whole.row_bytes +
                 std::ptrdiff_t{column} * side * texel;
    return view;
}

fs::path page_path(const fs::path& path, const atlas::Atlas& atlas, std::uint32_t page) {
    if (atlas.pages == 1) return path;
    return path.parent_path() /
           (path.stem().string() + "." + std::to_string(atlas::udim_of(atlas, page)) + path.extension().string());
}

std::vector<fs::path> exported_files(const fs::path& path, const ModelMaps& maps, const ExportOptions& options,
                                     const atlas::Atlas& atlas) {
    std::vector<fs::path> files{path};
    const std::string extension = path.extension().string();
    if (extension == ".glb" || extension == ".3mf") return files;
    const auto beside = [&](const std::string& tail) { return path.parent_path() / (safe_stem(path) + tail); };
    files.push_back(beside(extension == ".obj" ? ".mtl" : ".bin"));
    for (const MapFile& map : map_files(maps, options, extension))
        for (std::uint32_t page = 0; map.present && page < atlas.pages; ++page)
            files.push_back(page_path(beside("_" + std::string(map.suffix) + ".png"), atlas, page));
    return files;
}

std::vector<Message> export_model(const fs::path& path, const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas,
                                  const ModelMaps& maps, const ExportOptions& options) {
    const std::string extension = path.extension().string();
    if (extension != ".glb" && extension != ".gltf" && extension != ".obj" && extension != ".3mf")
        throw Error(path.string(), Message("models are written as .glb, .gltf, .obj or .3mf, not as '{}'", extension));
    const auto metres = metres_per(options.frame.unit);
    if (!metres) throw Error(Message("unknown unit '{}'; there are um, mm, cm, m, in and ft", options.frame.unit));
    mesh::SourceScene of_groups;
    if (!mesh.scene || mesh.scene->document.empty()) of_groups = make_scene(mesh, safe_stem(path));
    const mesh::SourceScene& source = of_groups.document.empty() ? *mesh.scene : of_groups;
    check_parts(mesh, source);
    ExportScene scene{
        .mesh = mesh,
        .source = source,
        // The base colour map holds the file's own colours, too.
        .decorated = decorated_parts(mesh, source, extension == ".3mf" ? std::vector<std::uint8_t>{} : options.painted),
        .transmits = options.transmits,
        .has_transmission = is_gltf(extension),
        .wedges = {},
        .corner_uvs = atlas.corner_uvs,
        .name = safe_stem(path),
        .y_up = options.frame.y_up,
        .metres_per_unit = *metres};
    if (!maps.orm.texels.empty()) scene.roughness = median_roughness(maps.orm);
    const std::vector<Vec2f> page_uvs = split_pages(atlas, scene);
    scene.wedges = split_wedges(mesh, scene.corner_uvs, scene.triangle_page);
    std::vector<EncodedMap> encoded;
    report(options.progress, "export", 0);
    const ImageOptions colour{.srgb = true, .channel_names = {}}, data{.srgb = false, .channel_names = {}};
    for (const MapFile& map : map_files(maps, options, extension)) {
        if (!map.present) continue;
        const std::string kind = map.suffix;
        ink::AtlasMap<std::uint8_t> made;
        if (kind == "normal") made = normal_map(maps.height, atlas.texel_size);
        const ink::AtlasMap<std::uint8_t>& whole = kind == "base_colour" ? maps.base_colour
                                                   : kind == "orm"       ? maps.orm
                                                   : kind == "normal"    ? made
                                                                         : maps.transmission;
        for (std::uint32_t page = 0; page < atlas.pages; ++page) {
            const fs::path file = page_path(scene.name + "_" + kind + ".png", atlas, page);
            encoded.push_back(
                {.kind = kind,
                 .file = file.string(),
                 .page = page,
                 .png = png_bytes(page_view(view_of(whole), atlas, page), kind == "base_colour" ? colour : data)});
            report(options.progress, "export", 0.25 * static_cast<double>(encoded.size()) / atlas.pages);
        }
    }
    write_together(path, [&](const fs::path& folder) {
        if (extension == ".obj")
            write_obj(folder / path.filename(), scene, encoded);
        else if (extension == ".3mf")
            write_3mf(folder / path.filename(), scene, encoded);
        else
            write_gltf(folder / path.filename(), scene, encoded);
    });
    report(options.progress, "export", 1);
    return notes_on_parts(scene);
}

}  // namespace tuft::io
