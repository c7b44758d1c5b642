#include "io/export.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "io/export_formats.h"
#include "io/image.h"

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

std::vector<MapFile> map_files(const ModelMaps& maps, const ExportOptions& options) {
    return {{"base_colour", !maps.base_colour.texels.empty()},
            {"orm", !maps.orm.texels.empty()},
            {"normal", has_height(maps, options)}};
}

}  // namespace

ModelMaps make_maps(const ink::Stack& stack, const atlas::TexelMap& texels,
                    const ink::Substrate& substrate, const ink::ComposeOptions& options) {
    return {.base_colour = compose_srgb8(stack, texels, substrate, options),
            .orm = compose_orm8(stack, texels, substrate, options),
            .height = compose_height(stack, texels, options)};
}

ink::AtlasMap<std::uint8_t> normal_map(const ink::AtlasMap<float>& height, double texel_size) {
    ink::AtlasMap<std::uint8_t> out{.size = height.size, .channels = 3, .texels = {}};
    const std::size_t n = height.size;
    out.texels.resize(n * n * 3);
    const auto scale = static_cast<float>(0.5e-6 / texel_size);
    const auto byte = [](float v) {
        return static_cast<std::uint8_t>(std::lround((v + 1) * 127.5f));
    };
    parallel_for(n, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            const float* row = &height.texels[y * n];
            const float* below = y > 0 ? row - n : row;
            const float* above = y + 1 < n ? row + n : row;
            std::uint8_t* to = &out.texels[y * n * 3];
            for (std::size_t x = 0; x < n; ++x, to += 3) {
                const float dx = scale * (row[x + 1 < n ? x + 1 : x] - row[x > 0 ? x - 1 : x]);
                const float dy = scale * (above[x] - below[x]);
                const float nx = std::fmin(std::fmax(-dx, -1.0f), 1.0f);
                const float ny = std::fmin(std::fmax(-dy, -1.0f), 1.0f);
                const float length = std::sqrt(nx * nx + ny * ny + 1);
                to[0] = byte(nx / length);
                to[1] = byte(ny / length);
                to[2] = byte(1 / length);
            }
        }
    });
    return out;
}

void write_together(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code ec;
    if (!fs::is_directory(parent, ec))
        throw Error(path.string(), "the output folder '" + parent.string() + "' does not exist");
    const fs::path folder =
        parent / ("." + path.stem().string() + ".part" + std::to_string(::getpid()));
    struct Cleanup {
        fs::path folder;
        ~Cleanup() {
            std::error_code ignored;
            fs::remove_all(folder, ignored);
        }
    };
    fs::remove_all(folder, ec);
    if (!fs::create_directory(folder, ec))
        throw Error(path.string(), "cannot be written: " + ec.message());
    const Cleanup cleanup{folder};
    write(folder);
    // The model comes last, so that it never points to files that are not there yet.
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end(), [&](const fs::path& a, const fs::path& b) {
        return (a.filename() == path.filename()) < (b.filename() == path.filename());
    });
    for (const fs::path& file : files) {
        fs::rename(file, parent / file.filename(), ec);
        if (ec)
            throw Error((parent / file.filename()).string(), "cannot be written: " + ec.message());
    }
}

std::vector<fs::path> exported_files(const fs::path& path, const ModelMaps& maps,
                                     const ExportOptions& options) {
    std::vector<fs::path> files{path};
    const std::string extension = path.extension().string();
    if (extension == ".glb") return files;
    const auto beside = [&](const std::string& tail) {
        return path.parent_path() / (safe_stem(path) + tail);
    };
    files.push_back(beside(extension == ".obj" ? ".mtl" : ".bin"));
    for (const MapFile& map : map_files(maps, options))
        if (map.present) files.push_back(beside("_" + std::string(map.suffix) + ".png"));
    return files;
}

void export_model(const fs::path& path, const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas,
                  const ModelMaps& maps, const ExportOptions& options) {
    const std::string extension = path.extension().string();
    if (extension != ".glb" && extension != ".gltf" && extension != ".obj")
        throw Error(path.string(),
                    "models are written as .glb, .gltf or .obj, not as '" + extension + "'");
    const auto metres = metres_per(options.unit);
    if (!metres)
        throw Error("unknown unit '" + options.unit + "'; there are um, mm, cm, m, in and ft");
    const ExportScene scene{.mesh = mesh,
                            .wedges = split_wedges(mesh, atlas.corner_uvs),
                            .corner_uvs = atlas.corner_uvs,
                            .name = safe_stem(path),
                            .z_up = options.z_up,
                            .metres_per_unit = *metres};
    std::vector<EncodedMap> encoded;
    report(options.progress, "export", 0);
    const ImageOptions colour{.srgb = true, .channel_names = {}},
        data{.srgb = false, .channel_names = {}};
    for (const MapFile& map : map_files(maps, options)) {
        if (!map.present) continue;
        const std::string kind = map.suffix;
        EncodedMap e{.kind = kind, .file = scene.name + "_" + kind + ".png", .png = {}};
        if (kind == "base_colour") e.png = png_bytes(view_of(maps.base_colour), colour);
        if (kind == "orm") e.png = png_bytes(view_of(maps.orm), data);
        if (kind == "normal")
            e.png = png_bytes(view_of(normal_map(maps.height, atlas.texel_size)), data);
        encoded.push_back(std::move(e));
        report(options.progress, "export", 0.25 * static_cast<double>(encoded.size()));
    }
    write_together(path, [&](const fs::path& folder) {
        if (extension == ".obj")
            write_obj(folder / path.filename(), scene, encoded);
        else
            write_gltf(folder / path.filename(), scene, encoded);
    });
    report(options.progress, "export", 1);
}

}  // namespace tuft::io
