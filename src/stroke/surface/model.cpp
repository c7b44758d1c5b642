#include "stroke/surface/model.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>

#include "core/system/memory.h"
#include "stroke/surface/model_cache.h"

namespace tuft::stroke {
namespace {

// Bytes per texel of a full tile: area and cluster number, one pigment plane and the copy kept
// for undo, and a share of the cluster graph; position and normal in floats or in 16 bits.
constexpr double kBytesPerTexel = 5.0 + 4.0 + 4.0 + 1.0;
constexpr double kFloatShape = 24.0, kPackedShape = 10.0;
// Charts cover no more than this part of an atlas; the tiles they touch a little more.
constexpr double kOccupied = 0.9;

void check_memory(std::uint32_t size, atlas::TexelStore texels, std::size_t limit) {
    if (limit == 0) limit = available_memory();
    const std::size_t needed = atlas_memory(size, texels);
    if (needed > limit)
        throw Error(
            Message("an atlas of {} x {} texels needs {} MiB, but only {} MiB are free; choose a smaller --atlas-size "
                    "or a larger --texel-size",
                    size, size, needed >> 20, limit >> 20));
}

// Takes texel map and cluster graph from the cache where they are packed, else makes them. Smaller maps are made in
// less time than a person notices.
void make_texels(Model& model, const ModelOptions& options) {
    const ProgressFn& progress = options.progress;
    const bool cached = !options.cache.folder().empty() && atlas::is_packed(options.texels, model.atlas.size);
    const DiskCache cache = texels_cache(options.cache);
    std::optional<CacheKey> key;
    if (cached) {
        report(progress, "texel map", 0);
        key = texels_key(*model.mesh, model.atlas);
        StoredTexels stored;
        if (cache.read(*key, [&](CacheReader& entry) { stored = get_texels(entry, model.atlas); })) {
            model.texels = std::move(stored.map);
            model.clusters = std::move(stored.clusters);
            report(progress, "texel map", 1);
            return;
        }
    }
    model.texels = atlas::build_texel_map(*model.mesh, model.atlas, progress, options.texels);
    release_free_memory();
    model.clusters = atlas::build_cluster_graph(*model.mesh, model.atlas, model.texels, progress);
    const std::size_t bytes = model.texels.n_slots() * (sizeof(atlas::TexelTile) + sizeof(atlas::PackedShape));
    if (!key || bytes > cache.limit() / 2) return;
    report(progress, "storing", 0);
    cache.write(*key, [&](CacheWriter& entry) { put_texels(entry, model); });
    cache.trim();
    report(progress, "storing", 1);
}

void finish(Model& model, const ModelOptions& options) {
    const ProgressFn& progress = options.progress;
    release_free_memory();
    keep_free_memory_below(std::size_t{1} << 20);  // few large blocks from here on
    report(progress, "search tree", 0);
    model.query = std::make_unique<mesh::SurfaceQuery>(*model.mesh);
    report(progress, "search tree", 1);
    make_texels(model, options);
    model.base_colour = ink::base_colour_of(*model.mesh, model.atlas, model.texels);
    release_free_memory();
}

/// Side of a square of as many texels as the used pages have.
std::uint32_t side_of_pages(std::uint32_t page_size, std::uint32_t pages) {
    return static_cast<std::uint32_t>(std::ceil(page_size * std::sqrt(double(pages))));
}

void give_atlas(Model& model, const atlas::UnwrapOptions& unwrap, const ModelOptions& options) {
    if (unwrap.size > 0) check_memory(unwrap.size, options.texels, options.memory_limit);
    if (unwrap.size == 0 && unwrap.texel_size > 0) {
        // Before the charts are made: their area alone asks for this many texels.
        const double side = std::sqrt(mesh::surface_area(*model.mesh)) / unwrap.texel_size;
        check_memory(static_cast<std::uint32_t>(std::min(side, 4e9)), options.texels, options.memory_limit);
    }
    atlas::Unwrapped unwrapped = atlas::unwrap(*model.mesh, unwrap);
    model.atlas = std::move(unwrapped.atlas);
    model.atlas_report = std::move(unwrapped.report);
    check_memory(side_of_pages(model.atlas.page_size(), model.atlas.pages), options.texels, options.memory_limit);
    finish(model, options);
}

// Takes mesh and atlas from the cache, and what is not stored from the soup. False when they are not there.
bool restore_model(Model& model, mesh::PolygonSoup& soup, const CacheKey& key, const ModelOptions& options) {
    StoredModel stored;
    if (!options.cache.read(key, [&](CacheReader& entry) { stored = get_model(entry, soup); })) return false;
    stored.mesh.materials = std::move(soup.materials);
    stored.repairs.warnings.insert(stored.repairs.warnings.begin(), soup.warnings.begin(), soup.warnings.end());
    soup = {};
    model.mesh = std::make_unique<mesh::TriangleMesh>(std::move(stored.mesh));
    model.repairs = std::move(stored.repairs);
    model.atlas = std::move(stored.atlas);
    model.atlas_report = std::move(stored.atlas_report);
    check_memory(side_of_pages(model.atlas.page_size(), model.atlas.pages), options.texels, options.memory_limit);
    finish(model, options);
    return true;
}

}  // namespace

DiskCache shared_model_cache() {
    return DiskCache(cache_folder("models"));
}

std::size_t atlas_memory(std::uint32_t size, atlas::TexelStore texels) {
    const double shape = atlas::is_packed(texels, size) ? kPackedShape : kFloatShape;
    constexpr double kMost = 1e18;  // what no machine has, and std::size_t still holds
    return static_cast<std::size_t>(
        std::min(kMost, static_cast<double>(size) * size * kOccupied * (kBytesPerTexel + shape)));
}

std::size_t available_memory() {
    std::size_t available = std::size_t{1} << 40;
    std::ifstream info("/proc/meminfo");
    for (std::string key; info >> key;) {
        std::size_t kib = 0;
        std::string unit;
        if (key == "MemAvailable:" && info >> kib) {
            available = kib << 10;
            break;
        }
        std::getline(info, unit);
    }
    std::ifstream limit_file("/sys/fs/cgroup/memory.max"), used_file("/sys/fs/cgroup/memory.current");
    std::size_t limit = 0, used = 0;
    if (limit_file >> limit && used_file >> used) available = std::min(available, limit > used ? limit - used : 0);
    return available;
}

Model prepare_model(mesh::PolygonSoup soup, const ModelOptions& options) {
    atlas::UnwrapOptions unwrap = options.unwrap;
    if (unwrap.size > 0) check_memory(unwrap.size, options.texels, options.memory_limit);
    mesh::RepairOptions repair = options.repair;
    repair.progress = unwrap.progress = options.progress;

    std::optional<CacheKey> key;
    if (!options.cache.folder().empty()) key = model_key(soup, options);
    Model model;
    if (key && restore_model(model, soup, *key, options)) return model;

    const std::size_t n_reader_warnings = soup.warnings.size();
    mesh::Surface surface = mesh::build_surface(std::move(soup), repair);
    model.mesh = std::make_unique<mesh::TriangleMesh>(std::move(surface.mesh));
    model.repairs = std::move(surface.report);
    release_free_memory();
    give_atlas(model, unwrap, options);
    if (key) {
        report(options.progress, "storing", 0);
        options.cache.write(*key, [&](CacheWriter& entry) { put_model(entry, model, n_reader_warnings); });
        options.cache.trim();
        report(options.progress, "storing", 1);
    }
    return model;
}

Model rescale_model(Model model, const ModelOptions& options) {
    atlas::UnwrapOptions unwrap = options.unwrap;
    unwrap.progress = options.progress;
    give_atlas(model, unwrap, options);
    return model;
}

Model prepare_model(mesh::TriangleMesh mesh, atlas::Atlas atlas, const ModelOptions& options) {
    Model model;
    model.mesh = std::make_unique<mesh::TriangleMesh>(std::move(mesh));
    model.atlas = std::move(atlas);
    check_memory(side_of_pages(model.atlas.page_size(), model.atlas.pages), options.texels, options.memory_limit);
    finish(model, options);
    return model;
}

Model prepare_model(mesh::TriangleMesh mesh, atlas::Atlas atlas, const ProgressFn& progress) {
    return prepare_model(std::move(mesh), std::move(atlas), ModelOptions{.progress = progress});
}

}  // namespace tuft::stroke
