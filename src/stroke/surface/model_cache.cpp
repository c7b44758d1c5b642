#include "stroke/surface/model_cache.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atlas/unwrap/fault.h"
#include "core/system/build_facts.h"
#include "mesh/fault.h"
#include "stroke/surface/preparation_code.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kMostNested = 8;  // messages inside a message

void require(bool good) {
    if (!good) CacheReader::fail();
}

void add_code(CacheKey& key) {
    key.add_text(kPreparationCode);
    const BuildFacts& facts = build_facts();
    key.add_text(facts.compiler);
    key.add_text(facts.build_type);
    for (const auto& [name, version] : facts.libraries) key.add_text(name), key.add_text(version);
}

template <class T>
void add(CacheKey& key, const std::vector<T>& values) {
    key.add_array(std::span<const T>(values));
}

// Counts of a report, in the order in which they are stored.
std::vector<std::uint64_t> counts_of(const mesh::RepairReport& r) {
    return {r.file.points,
            r.file.polygons,
            r.file.polygons_triangulated,
            r.file.loose_triangles,
            r.vertices_welded,
            r.crack_vertices_welded,
            r.unused_vertices_dropped,
            r.degenerate_faces_dropped,
            r.degenerate_faces_repaired,
            r.duplicate_faces_dropped,
            r.non_manifold.edges_split,
            r.non_manifold.vertices_split,
            r.faces_flipped,
            r.parts_turned,
            r.components,
            r.holes,
            r.border_edges,
            r.closed};
}

mesh::RepairReport report_of(const std::vector<std::uint64_t>& n) {
    require(n.size() == 18);
    return {.file = {.points = n[0], .polygons = n[1], .polygons_triangulated = n[2], .loose_triangles = n[3] != 0},
            .vertices_welded = n[4],
            .crack_vertices_welded = n[5],
            .unused_vertices_dropped = n[6],
            .degenerate_faces_dropped = n[7],
            .degenerate_faces_repaired = n[8],
            .duplicate_faces_dropped = n[9],
            .non_manifold = {.edges_split = n[10], .vertices_split = n[11]},
            .faces_flipped = n[12],
            .parts_turned = n[13],
            .components = n[14],
            .holes = n[15],
            .border_edges = n[16],
            .closed = n[17] != 0,
            .warnings = {}};
}

void put_message(CacheWriter& entry, const Message& message) {
    entry.put_text(message.words());
    entry.put(std::vector<std::uint64_t>{message.translated(), message.arguments().size()});
    for (const Message& argument : message.arguments()) put_message(entry, argument);
}

Message get_message(CacheReader& entry, std::size_t depth = 0) {
    require(depth < kMostNested);
    std::string words = entry.get_text();
    const std::vector<std::uint64_t> facts = entry.get<std::uint64_t>();
    require(facts.size() == 2 && facts[1] <= 64);
    std::vector<Message> arguments;
    arguments.reserve(facts[1]);
    for (std::uint64_t i = 0; i < facts[1]; ++i) arguments.push_back(get_message(entry, depth + 1));
    return {std::move(words), facts[0] != 0, std::move(arguments)};
}

void put_atlas(CacheWriter& entry, const atlas::Atlas& a, const atlas::AtlasReport& r) {
    entry.put(std::vector<std::uint32_t>{a.size, a.pages, a.gutter, a.n_charts, a.from_file});
    entry.put(a.udims);
    entry.put(a.corner_uvs);
    entry.put(a.triangle_chart);
    entry.put(std::vector<double>{a.texel_size, r.l2_stretch, r.linf_stretch, r.angle_distortion, r.area_distortion,
                                  r.utilisation, r.seam_length});
    entry.put(std::vector<std::uint64_t>{r.charts, r.flips, r.overlapping_texels, r.zero_area_triangles,
                                         static_cast<std::uint64_t>(r.smallest_gap)});
}

void get_atlas(CacheReader& entry, atlas::Atlas& a, atlas::AtlasReport& r) {
    const auto sizes = entry.get<std::uint32_t>();
    require(sizes.size() == 5);
    a.size = sizes[0], a.pages = sizes[1], a.gutter = sizes[2], a.n_charts = sizes[3], a.from_file = sizes[4] != 0;
    a.udims = entry.get<std::uint32_t>();
    a.corner_uvs = entry.get<Vec2f>();
    a.triangle_chart = entry.get<std::uint32_t>();
    const auto measures = entry.get<double>();
    const auto counts = entry.get<std::uint64_t>();
    require(measures.size() == 7 && counts.size() == 5 && counts[4] <= 64);
    a.texel_size = measures[0];
    r.l2_stretch = measures[1], r.linf_stretch = measures[2];
    r.angle_distortion = measures[3], r.area_distortion = measures[4];
    r.utilisation = measures[5], r.seam_length = measures[6];
    r.charts = counts[0], r.flips = counts[1], r.overlapping_texels = counts[2], r.zero_area_triangles = counts[3];
    r.smallest_gap = static_cast<int>(counts[4]);
}

bool starts_of(const std::vector<std::uint32_t>& starts, std::size_t lists, std::size_t elements) {
    return starts.size() == lists + 1 && starts.front() == 0 && starts.back() == elements &&
           std::ranges::is_sorted(starts);
}

bool is_length(float metres) {
    return metres >= 0 && std::isfinite(metres);
}

bool is_finite(const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Whether cluster `i` is one of its tile, of a chart, and of finite numbers.
bool is_cluster(const atlas::TexelCluster& c, std::size_t i, const atlas::TexelMap& map, const atlas::Atlas& atlas) {
    if (c.slot >= map.tile_of_slot.size() || i != std::size_t{map.cluster_start[c.slot]} + c.index ||
        i >= map.cluster_start[c.slot + 1])
        return false;
    return c.chart < atlas.n_charts && c.first_row <= c.last_row && c.last_row < atlas::kTile && is_length(c.radius) &&
           std::isfinite(c.cone_cos) && is_finite(c.centre) && is_finite(c.normal) && is_finite(c.tangent) &&
           is_finite(c.outward);
}

/// Whether all texels of a tile are of its `n` clusters.
bool is_tile(const atlas::TexelTile& tile, std::uint32_t n) {
    return std::ranges::all_of(tile.area, is_length) &&
           std::ranges::all_of(tile.cluster, [n](std::uint8_t c) { return c < n || c == atlas::kNoCluster; });
}

}  // namespace

CacheKey model_key(const mesh::PolygonSoup& soup, const ModelOptions& options) {
    CacheKey key("model 2");
    add_code(key);
    add(key, soup.points);
    add(key, soup.corners);
    add(key, soup.polygon_start);
    add(key, soup.corner_uvs);
    add(key, soup.corner_normals);
    add(key, soup.point_colours);
    add(key, soup.polygon_groups);
    add(key, soup.polygon_parts);
    key.add(soup.group_names.size());
    for (const std::string& name : soup.group_names) key.add_text(name);
    key.add(soup.materials.size());
    key.add(soup.scene ? soup.scene->parts.size() : 0);
    if (soup.scene)
        for (const mesh::ScenePart& part : soup.scene->parts)
            key.add_text(part.object), key.add_text(part.group), key.add_text(part.material);

    const mesh::RepairOptions& repair = options.repair;
    key.add(repair.metres_per_unit), key.add(repair.y_up), key.add(repair.crease_angle), key.add(repair.sides);
    const atlas::UnwrapOptions& unwrap = options.unwrap;
    key.add(unwrap.size), key.add(unwrap.texel_size), key.add(unwrap.pages), key.add(unwrap.gutter);
    key.add(unwrap.uvs), key.add(unwrap.seams.groups), key.add(unwrap.seams.sharp_angle);
    key.add(unwrap.max_size), key.add(unwrap.cutting);
    return key;
}

void put_model(CacheWriter& entry, const Model& model, std::size_t n_reader_warnings) {
    const mesh::TriangleMesh& m = *model.mesh;
    entry.put(m.positions);
    entry.put(m.triangles);
    entry.put(m.corner_normals);
    entry.put(m.neighbours);
    entry.put(m.corner_uvs);
    entry.put(m.vertex_colours);
    entry.put(m.triangle_groups);
    entry.put(m.triangle_parts);
    entry.put(counts_of(model.repairs));
    const std::vector<Message>& warnings = model.repairs.warnings;
    entry.put(std::vector<std::uint64_t>{warnings.size() - n_reader_warnings});
    for (std::size_t i = n_reader_warnings; i < warnings.size(); ++i) put_message(entry, warnings[i]);
    put_atlas(entry, model.atlas, model.atlas_report);
}

StoredModel get_model(CacheReader& entry, const mesh::PolygonSoup& soup) {
    StoredModel model;
    mesh::TriangleMesh& m = model.mesh;
    m.positions = entry.get<Vec3f>();
    m.triangles = entry.get<std::array<std::uint32_t, 3>>();
    m.corner_normals = entry.get<Vec3f>();
    m.neighbours = entry.get<std::uint32_t>();
    m.corner_uvs = entry.get<Vec2f>();
    m.vertex_colours = entry.get<std::array<std::uint8_t, 4>>();
    m.triangle_groups = entry.get<std::uint32_t>();
    m.triangle_parts = entry.get<std::uint32_t>();
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    if (!m.triangle_groups.empty()) m.group_names = soup.group_names;
    m.scene = soup.scene;
    require(mesh::fault_of(m).empty() && (m.triangle_parts.empty() || m.scene));
    model.repairs = report_of(entry.get<std::uint64_t>());
    const auto n_warnings = entry.get_one<std::uint64_t>();
    require(n_warnings <= 1'000'000);
    for (std::uint64_t i = 0; i < n_warnings; ++i) model.repairs.warnings.push_back(get_message(entry));
    get_atlas(entry, model.atlas, model.atlas_report);
    require(model.atlas.triangle_chart.size() == m.n_triangles() && atlas::fault_of(model.atlas).empty());
    return model;
}

CacheKey texels_key(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas) {
    CacheKey key("texels 1");
    add_code(key);
    add(key, mesh.positions);
    add(key, mesh.triangles);
    add(key, mesh.corner_normals);
    add(key, mesh.neighbours);
    key.add(atlas.size), key.add(atlas.pages), key.add(atlas.gutter), key.add(atlas.n_charts);
    key.add(atlas.texel_size);
    add(key, atlas.udims);
    add(key, atlas.corner_uvs);
    add(key, atlas.triangle_chart);
    return key;
}

DiskCache texels_cache(const DiskCache& models) {
    if (models.folder().empty()) return {};
    return DiskCache(models.folder() / "texels", std::uintmax_t{4} << 30);
}

void put_texels(CacheWriter& entry, const Model& model) {
    const atlas::TexelMap& map = model.texels;
    entry.put(std::vector<std::uint32_t>{map.size, map.tiles_per_side});
    entry.put(std::vector<double>{map.texel_size});
    entry.put(map.slot_of_tile);
    entry.put(map.tile_of_slot);
    entry.put(map.boxes);
    entry.put(map.reach);
    entry.put(map.cluster_start);
    entry.put(map.cluster_chart);
    entry.put(model.clusters.clusters);
    entry.put(model.clusters.edge_start);
    entry.put(model.clusters.edges);
    entry.put_to_map(map.tiles);
    entry.put_to_map(map.packed);
}

StoredTexels get_texels(CacheReader& entry, const atlas::Atlas& atlas) {
    StoredTexels stored;
    auto& [map, graph] = stored;
    const auto sizes = entry.get<std::uint32_t>();
    require(sizes.size() == 2 && sizes[0] == atlas.size && sizes[1] == (sizes[0] + atlas::kTile - 1) / atlas::kTile);
    map.size = sizes[0], map.tiles_per_side = sizes[1];
    map.texel_size = entry.get_one<double>();
    map.slot_of_tile = entry.get<std::uint32_t>();
    map.tile_of_slot = entry.get<std::uint32_t>();
    map.boxes = entry.get<atlas::PackedBox>();
    map.reach = entry.get<float>();
    map.cluster_start = entry.get<std::uint32_t>();
    map.cluster_chart = entry.get<std::uint32_t>();
    graph.clusters = entry.get<atlas::TexelCluster>();
    graph.edge_start = entry.get<std::uint32_t>();
    graph.edges = entry.get<atlas::ClusterEdge>();
    graph.cluster_start = map.cluster_start;

    const std::size_t n = map.tile_of_slot.size(), n_tiles = map.slot_of_tile.size(),
                      n_clusters = map.cluster_chart.size();
    require(n_tiles == std::size_t{map.tiles_per_side} * map.tiles_per_side && map.reach.size() == n &&
            map.boxes.size() == n_clusters && graph.n_clusters() == n_clusters);
    require(std::ranges::all_of(map.slot_of_tile, [n](std::uint32_t slot) { return slot < n || slot == kNone; }));
    require(std::ranges::all_of(map.tile_of_slot, [=](std::uint32_t tile) { return tile < n_tiles; }));
    require(starts_of(map.cluster_start, n, n_clusters) && starts_of(graph.edge_start, n_clusters, graph.edges.size()));
    require(map.texel_size > 0 && std::isfinite(map.texel_size) && std::ranges::all_of(map.reach, is_length));
    require(
        std::ranges::all_of(map.boxes, [](const atlas::PackedBox& b) { return is_finite(b.lo) && is_length(b.step); }));
    require(std::ranges::all_of(map.cluster_chart, [&](std::uint32_t chart) { return chart < atlas.n_charts; }));
    for (std::size_t i = 0; i < n_clusters; ++i) require(is_cluster(graph.clusters[i], i, map, atlas));
    require(std::ranges::all_of(graph.edges, [=](const atlas::ClusterEdge& e) {
        return e.to < n_clusters && std::isfinite(e.hop_u) && std::isfinite(e.hop_v) && std::isfinite(e.c) &&
               std::isfinite(e.s);
    }));
    map.tiles = entry.map<atlas::TexelTile>([&](std::span<const atlas::TexelTile> tiles, std::size_t first) {
        require(first + tiles.size() <= n);
        for (std::size_t k = 0; k < tiles.size(); ++k)
            if (!is_tile(tiles[k], map.cluster_start[first + k + 1] - map.cluster_start[first + k])) return false;
        return true;
    });
    map.packed = entry.map<atlas::PackedShape>([](auto, auto) { return true; });  // any number is a place in its box
    require(map.tiles.size() == n && map.packed.size() == n);
    return stored;
}

}  // namespace tuft::stroke
