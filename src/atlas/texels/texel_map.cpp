#include "atlas/texels/texel_map.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "atlas/texels/border_cells.h"
#include "core/error.h"
#include "core/system/memory.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

constexpr std::int64_t kSnap = 4096;  // sub-texel steps; 16384 texels × 4096 squared fits 64 bits
const float kClusterCos = std::cos(35.0f * 0.0174532925f);
const float kBendCos = std::cos(30.0f * 0.0174532925f);

/// A triangle in the atlas on the snapped grid, counter-clockwise.
struct SnappedTriangle {
    std::array<std::int64_t, 3> x, y;
    std::array<int, 3> corner{0, 1, 2};  ///< of the mesh triangle
    std::int64_t area2 = 0;              ///< twice the area, snapped units²
};

std::int64_t floor_div(std::int64_t a, std::int64_t b) {  // b > 0
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

std::int64_t snap(float uv, std::uint32_t size) {
    const double texels = std::clamp(static_cast<double>(uv), 0.0, 1.0) * size;
    return static_cast<std::int64_t>(std::floor(texels * kSnap + 0.5));
}

/// Area 0 for what cannot be drawn.
SnappedTriangle snapped_triangle(const Atlas& atlas, std::size_t triangle) {
    SnappedTriangle s{};
    for (int k = 0; k < 3; ++k) {
        const Vec2f uv = atlas.corner_uvs[3 * triangle + k];
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return s;
        s.x[k] = snap(uv.x, atlas.size);
        s.y[k] = snap(uv.y, atlas.size);
    }
    s.area2 = (s.x[1] - s.x[0]) * (s.y[2] - s.y[0]) - (s.y[1] - s.y[0]) * (s.x[2] - s.x[0]);
    if (s.area2 < 0) {
        std::swap(s.x[1], s.x[2]);
        std::swap(s.y[1], s.y[2]);
        std::swap(s.corner[1], s.corner[2]);
        s.area2 = -s.area2;
    }
    return s;
}

/// Twice the area of (edge k → k+1, point): positive inside.
std::int64_t edge_value(const SnappedTriangle& s, int k, std::int64_t x, std::int64_t y) {
    const int l = (k + 1) % 3;
    return (s.x[l] - s.x[k]) * (y - s.y[k]) - (s.y[l] - s.y[k]) * (x - s.x[k]);
}

/// First and last + 1 texel row whose centre may lie in the triangle.
std::pair<std::int64_t, std::int64_t> row_range(const SnappedTriangle& s) {
    const auto [lo, hi] = std::minmax({s.y[0], s.y[1], s.y[2]});
    return {floor_div(lo - kSnap / 2 + kSnap - 1, kSnap), floor_div(hi - kSnap / 2, kSnap) + 1};
}

/// Columns [begin, end) of a texel row whose centres lie in the triangle. An edge that
/// points up, or straight left, owns the centres on it.
std::pair<std::int64_t, std::int64_t> column_range(const SnappedTriangle& s, std::int64_t row, std::int64_t size) {
    const std::int64_t y = row * kSnap + kSnap / 2;
    std::int64_t begin = 0, end = size;
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3;
        const std::int64_t dx = s.x[l] - s.x[k], dy = s.y[l] - s.y[k];
        const bool owns = dy > 0 || (dy == 0 && dx < 0);
        // value(column) = at_zero − dy kSnap column must be > 0, or ≥ 0 on an edge that owns.
        const std::int64_t at_zero = dx * (y - s.y[k]) - dy * (kSnap / 2 - s.x[k]);
        const std::int64_t least = at_zero - (owns ? 0 : 1);  // integer: > 0 is ≥ 1
        if (dy > 0) {
            end = std::min(end, floor_div(least, dy * kSnap) + 1);
        } else if (dy < 0) {
            begin = std::max(begin, floor_div(-least + (-dy * kSnap) - 1, -dy * kSnap));
        } else if (least < 0) {
            return {0, 0};
        }
    }
    return {begin, end};
}

/// Triangles by bands of 16 texel rows, in index order.
struct Bands {
    std::vector<std::size_t> start;
    std::vector<std::uint32_t> triangles;
};

Bands sort_into_bands(const mesh::TriangleMesh& mesh, const Atlas& atlas, std::uint32_t n_bands) {
    const std::size_t n = mesh.n_triangles();
    std::vector<std::array<std::uint16_t, 2>> range(n);  // first band and last + 1
    parallel_for(n, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const SnappedTriangle s = snapped_triangle(atlas, i);
            const auto [lo, hi] = row_range(s);
            range[i] = {0, 0};
            const std::int64_t last = std::min<std::int64_t>(hi, atlas.size);
            if (s.area2 == 0 || lo >= last) continue;
            range[i] = {static_cast<std::uint16_t>(lo / kTile), static_cast<std::uint16_t>((last - 1) / kTile + 1)};
        }
    });
    Bands bands;
    bands.start.assign(n_bands + 1, 0);
    for (const auto& r : range) {
        for (int b = r[0]; b < r[1]; ++b) ++bands.start[b + 1];
    }
    for (std::uint32_t b = 0; b < n_bands; ++b) bands.start[b + 1] += bands.start[b];
    bands.triangles.resize(bands.start.back());
    std::vector<std::size_t> next(bands.start.begin(), bands.start.end() - 1);
    for (std::size_t i = 0; i < n; ++i) {
        for (int b = range[i][0]; b < range[i][1]; ++b) bands.triangles[next[b]++] = static_cast<std::uint32_t>(i);
    }
    return bands;
}

/// Calls visit(row in the band, first column, last column + 1, triangle).
template <class Visit>
void draw_band(const Atlas& atlas, const Bands& bands, std::size_t band, Visit&& visit) {
    for (std::size_t i = bands.start[band]; i < bands.start[band + 1]; ++i) {
        const std::uint32_t triangle = bands.triangles[i];
        const SnappedTriangle s = snapped_triangle(atlas, triangle);
        const auto [lo, hi] = row_range(s);
        const std::int64_t band_row = static_cast<std::int64_t>(band) * kTile;
        const std::int64_t first = std::max(lo, band_row);
        const std::int64_t last = std::min({hi, band_row + kTile, std::int64_t{atlas.size}});
        for (std::int64_t row = first; row < last; ++row) {
            const auto [begin, end] = column_range(s, row, atlas.size);
            if (begin < end) visit(static_cast<int>(row - band_row), begin, end, triangle);
        }
    }
}

/// Triangle per texel of the band's 16 rows, or kNone.
void draw_ids(const Atlas& atlas, const Bands& bands, std::size_t band, std::vector<std::uint32_t>& ids) {
    ids.assign(std::size_t{kTile} * atlas.size, kNone);
    draw_band(atlas, bands, band, [&](int row, std::int64_t x0, std::int64_t x1, std::uint32_t triangle) {
        std::uint32_t* line = ids.data() + std::size_t(row) * atlas.size;
        for (std::int64_t x = x0; x < x1; ++x) line[x] = std::min(line[x], triangle);
    });
}

/// Surface at a texel's centre.
struct TexelSurface {
    Vec3 position{0}, normal{0, 0, 1};  ///< metres; unit
};

/// What all texels of a triangle share.
struct TriangleSurface {
    std::uint32_t triangle = kNone;
    SnappedTriangle snapped{};
    double scale = 0;                          ///< 1 / area2
    std::array<Vec3, 3> corners{}, normals{};  ///< metres; as in the mesh
    Vec3 face{0};                              ///< normal of the triangle, any length
    double area = 0;                           ///< m², of a texel's image
    float diagonal = 0;                        ///< metres, of it
};

TriangleSurface surface_of_triangle(const mesh::TriangleMesh& mesh, const Atlas& atlas, std::uint32_t triangle) {
    TriangleSurface t{.triangle = triangle, .snapped = snapped_triangle(atlas, triangle)};
    const SnappedTriangle& s = t.snapped;
    t.scale = 1.0 / static_cast<double>(s.area2);
    Vec3 du{0}, dv{0};
    for (int k = 0; k < 3; ++k) {  // corner k faces edge k+1 → k+2
        const int l = (k + 1) % 3, o = (k + 2) % 3;
        const Vec3 corner = t.corners[k] = mesh.position(triangle, s.corner[k]);
        t.normals[k] = Vec3(mesh.corner_normals[3 * std::size_t{triangle} + s.corner[k]]);
        du += static_cast<double>(s.y[l] - s.y[o]) * t.scale * kSnap * corner;
        dv += static_cast<double>(s.x[o] - s.x[l]) * t.scale * kSnap * corner;
    }
    t.face = glm::cross(mesh.position(triangle, 1) - mesh.position(triangle, 0),
                        mesh.position(triangle, 2) - mesh.position(triangle, 0));
    t.area = glm::length(glm::cross(du, dv));
    t.diagonal = static_cast<float>(std::sqrt(glm::dot(du, du) + glm::dot(dv, dv)));
    return t;
}

/// Surfaces of the triangles met last: the texels of a tile share few.
class TriangleSurfaces {
  public:
    TriangleSurfaces(const mesh::TriangleMesh& mesh, const Atlas& atlas) : mesh_(mesh), atlas_(atlas) {}

    const TriangleSurface& at(std::uint32_t triangle) {
        TriangleSurface& t = met_[triangle % met_.size()];
        if (t.triangle != triangle) t = surface_of_triangle(mesh_, atlas_, triangle);
        return t;
    }

  private:
    const mesh::TriangleMesh& mesh_;
    const Atlas& atlas_;
    std::array<TriangleSurface, 32> met_;
};

TexelSurface surface_of_texel(const TriangleSurface& t, std::int64_t column, std::int64_t row) {
    const std::int64_t x = column * kSnap + kSnap / 2, y = row * kSnap + kSnap / 2;
    Vec3 p{0}, n{0};
    for (int k = 0; k < 3; ++k) {
        const double w = static_cast<double>(edge_value(t.snapped, (k + 1) % 3, x, y)) * t.scale;
        p += w * t.corners[k];
        n += w * t.normals[k];
    }
    double length = glm::length(n);
    if (!(length > 1e-6)) {
        length = glm::length(t.face);
        n = length > 0 ? t.face : Vec3{0, 0, 1};
        if (!(length > 0)) length = 1;
    }
    return {p, {n.x / length, n.y / length, n.z / length}};
}

void store_texel(const TexelSurface& surface, int texel, TexelShape& shape) {
    shape.px[texel] = static_cast<float>(surface.position.x);
    shape.py[texel] = static_cast<float>(surface.position.y);
    shape.pz[texel] = static_cast<float>(surface.position.z);
    shape.nx[texel] = static_cast<float>(surface.normal.x);
    shape.ny[texel] = static_cast<float>(surface.normal.y);
    shape.nz[texel] = static_cast<float>(surface.normal.z);
}

bool are_connected(const TexelShape& shape, int a, int b, float reach) {
    const float dx = shape.px[a] - shape.px[b], dy = shape.py[a] - shape.py[b], dz = shape.pz[a] - shape.pz[b];
    return dx * dx + dy * dy + dz * dz <= reach * reach;
}

/// Texels of a tile, and limits of its clusters.
struct TileTexels {
    const TexelShape& shape;
    const std::array<std::uint32_t, kTileTexels>& chart;  ///< kNone: no surface
    float reach = 0;                                      ///< metres between connected neighbours, at most
    float min_cos = -2;                                   ///< least cosine of a texel's normal to that of the seed
    int side = kTile;                                     ///< texels, power of 2: clusters keep to squares of the tile
};

/// Grows the cluster `cluster` from `seed` over unassigned texels of the same chart in the same square.
void grow_cluster(const TileTexels& texels, int seed, std::uint8_t cluster, TexelTile& tile) {
    const auto& [shape, chart, reach, min_cos, side] = texels;
    std::array<std::uint8_t, kTileTexels> open;
    int n_open = 0;
    const float nx = shape.nx[seed], ny = shape.ny[seed], nz = shape.nz[seed];
    tile.cluster[seed] = cluster;
    open[n_open++] = static_cast<std::uint8_t>(seed);
    while (n_open > 0) {
        const int a = open[--n_open];
        const int ax = a % kTile, ay = a / kTile;
        for (int by = std::max(ay - 1, 0); by <= std::min(ay + 1, kTile - 1); ++by) {
            for (int bx = std::max(ax - 1, 0); bx <= std::min(ax + 1, kTile - 1); ++bx) {
                const int b = by * kTile + bx;
                if (tile.cluster[b] != kNoCluster || chart[b] != chart[seed]) continue;
                if (((bx ^ seed % kTile) | (by ^ seed / kTile)) & ~(side - 1)) continue;
                const float c = shape.nx[b] * nx + shape.ny[b] * ny + shape.nz[b] * nz;
                if (c < min_cos || !are_connected(shape, a, b, reach)) continue;
                tile.cluster[b] = cluster;
                open[n_open++] = static_cast<std::uint8_t>(b);
            }
        }
    }
}

/// Returns true where normals stray so far from their mean that what lies beyond the tile unrolls otherwise from one
/// of its ends than from the other: folds, and walls that run round a corner. A quarter of such a tile is
/// still near enough to a plane or a cylinder; raw scans stray less (of the armadillo's tiles at 4096² one
/// in fifty does).
bool bends(const TexelShape& shape, const std::array<std::uint32_t, kTileTexels>& chart) {
    const auto normal = [&](int t) { return Vec3f{shape.nx[t], shape.ny[t], shape.nz[t]}; };
    Vec3f sum{0};
    for (int t = 0; t < kTileTexels; ++t)
        if (chart[t] != kNone) sum += normal(t);
    const float least = kBendCos * glm::length(sum);
    for (int t = 0; t < kTileTexels; ++t)
        if (chart[t] != kNone && glm::dot(sum, normal(t)) < least) return true;
    return false;
}

/// Splits the tile's texels (those with a chart) into clusters; returns the chart of each.
/// A tile so rough that it would need more than 254 is split by charts and gaps alone;
/// texels beyond that (one-texel charts side by side) are given up.
std::vector<std::uint32_t> split_into_clusters(const TexelShape& shape, TexelTile& tile,
                                               const std::array<std::uint32_t, kTileTexels>& chart, float reach) {
    const int side = bends(shape, chart) ? kTile / 2 : kTile;
    for (const float min_cos : {kClusterCos, -2.0f}) {
        std::vector<std::uint32_t> charts;
        tile.cluster.fill(kNoCluster);
        bool all = true;
        for (int t = 0; t < kTileTexels; ++t) {
            if (chart[t] == kNone || tile.cluster[t] != kNoCluster) continue;
            all = charts.size() < kNoCluster;
            if (!all) break;
            grow_cluster({shape, chart, reach, min_cos, side}, t, static_cast<std::uint8_t>(charts.size()), tile);
            charts.push_back(chart[t]);
        }
        if (all || min_cos < -1) return charts;
    }
    return {};
}

/// A tile in its band of triangle numbers.
struct TileInBand {
    std::uint32_t column = 0;         ///< tiles
    std::size_t band = 0;             ///< row, tiles
    const std::uint32_t* triangle{};  ///< [kTile atlas.size] by texel of the band, or kNone
};

/// Clusters of a filled tile.
struct TileClusters {
    std::vector<std::uint32_t> chart;  ///< by cluster
    float reach = 0;                   ///< metres, of connected neighbours
};

/// Fills one tile from the triangle of each of its texels.
TileClusters fill_tile(TriangleSurfaces& triangles, const Atlas& atlas, const TileInBand& place, TexelShape& shape,
                       TexelTile& tile) {
    const std::int64_t x0 = std::int64_t{place.column} * kTile;
    const auto y0 = static_cast<std::int64_t>(place.band) * kTile;
    std::array<std::uint32_t, kTileTexels> chart;
    double diagonals = 0;
    int n = 0;
    for (int t = 0; t < kTileTexels; ++t) {
        chart[t] = kNone;
        const std::int64_t x = x0 + t % kTile, y = y0 + t / kTile;
        if (x >= atlas.size) continue;
        const std::uint32_t id = place.triangle[static_cast<std::size_t>(t / kTile) * atlas.size + x];
        if (id == kNone) continue;
        chart[t] = atlas.triangle_chart[id];
        const TriangleSurface& triangle = triangles.at(id);
        store_texel(surface_of_texel(triangle, x, y), t, shape);
        tile.area[t] = static_cast<float>(triangle.area);
        diagonals += triangle.diagonal;
        ++n;
    }
    // Mean diagonal of a texel, with room for stretch that varies inside the tile.
    const float reach = n > 0 ? static_cast<float>(3 * diagonals / n) : 0;
    return {split_into_clusters(shape, tile, chart, reach), reach};
}

double mean_texel_size(const TexelMap& map) {
    double area = 0;
    std::size_t n = 0;
    for (const TexelTile& tile : map.tiles) {
        for (int t = 0; t < kTileTexels; ++t) {
            area += tile.area[t];
            n += tile.cluster[t] != kNoCluster;
        }
    }
    return n > 0 ? std::sqrt(area / static_cast<double>(n)) : 0;
}

void check_sizes(const mesh::TriangleMesh& mesh, const Atlas& atlas) {
    const std::size_t n = mesh.n_triangles();
    if (atlas.size == 0 || atlas.size > 16384)
        throw Error(Message("atlas size {} is not between 1 and 16384", atlas.size));
    if (atlas.corner_uvs.size() != 3 * n || atlas.triangle_chart.size() != n || mesh.corner_normals.size() != 3 * n)
        throw Error("the atlas was made for another mesh");
}

/// Gives each tile that a triangle covers a slot.
void number_slots(const Atlas& atlas, const Bands& bands, TexelMap& map) {
    const std::uint32_t side = map.tiles_per_side;
    std::vector<std::uint8_t> occupied(std::size_t{side} * side, 0);
    parallel_for(side, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t band = begin; band < end; ++band) {
            draw_band(atlas, bands, band, [&](int, std::int64_t x0, std::int64_t x1, std::uint32_t) {
                for (std::int64_t tx = x0 / kTile; tx <= (x1 - 1) / kTile; ++tx) occupied[band * side + tx] = 1;
            });
        }
    });
    map.slot_of_tile.assign(occupied.size(), kNone);
    for (std::size_t i = 0; i < occupied.size(); ++i) {
        if (!occupied[i]) continue;
        map.slot_of_tile[i] = static_cast<std::uint32_t>(map.tile_of_slot.size());
        map.tile_of_slot.push_back(static_cast<std::uint32_t>(i));
    }
}

/// Clusters of the tiles, by slot.
struct FilledTiles {
    std::vector<std::vector<std::uint32_t>> charts;  // of each cluster
    std::vector<std::vector<PackedBox>> boxes;       // of each cluster of a packed tile
};

/// Arrays of a map while they are filled.
struct Tiles {
    std::vector<TexelTile> tiles;
    std::vector<PackedShape> packed;
};

FilledTiles fill_tiles(const mesh::TriangleMesh& mesh, const Atlas& atlas, const Bands& bands, TexelMap& map,
                       Tiles& to) {
    const std::uint32_t side = map.tiles_per_side;
    const bool packed = !to.packed.empty();
    FilledTiles filled;
    filled.charts.resize(to.tiles.size());
    filled.boxes.resize(to.packed.size());
    parallel_for(side, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> ids;
        TexelShape buffer{};
        TriangleSurfaces triangles(mesh, atlas);
        for (std::size_t band = begin; band < end; ++band) {
            draw_ids(atlas, bands, band, ids);
            for (std::uint32_t tx = 0; tx < side; ++tx) {
                const std::uint32_t slot = map.slot_of_tile[band * side + tx];
                if (slot == kNone) continue;
                TexelShape& shape = packed ? buffer : map.shapes[slot];
                TileClusters clusters = fill_tile(triangles, atlas, {tx, band, ids.data()}, shape, to.tiles[slot]);
                filled.charts[slot] = std::move(clusters.chart);
                map.reach[slot] = clusters.reach;
                if (!packed) continue;
                filled.boxes[slot].resize(filled.charts[slot].size());
                to.packed[slot] = pack_shape(shape, to.tiles[slot], filled.boxes[slot]);
            }
        }
    });
    return filled;
}

}  // namespace

TexelMap build_texel_map(const mesh::TriangleMesh& mesh, const Atlas& atlas, const ProgressFn& progress,
                         TexelStore store) {
    check_sizes(mesh, atlas);
    report(progress, "texel map", 0);
    TexelMap map;
    map.size = atlas.size;
    map.tiles_per_side = (atlas.size + kTile - 1) / kTile;
    map.texel_size = atlas.texel_size;
    const std::uint32_t side = map.tiles_per_side;
    Bands bands = sort_into_bands(mesh, atlas, side);

    number_slots(atlas, bands, map);
    report(progress, "texel map", 0.2);

    const std::size_t n_slots = map.tile_of_slot.size();
    const bool packed = is_packed(store, atlas.size);
    const auto arrays = std::make_shared<Tiles>();
    resize_in_large_pages(arrays->tiles, n_slots);
    resize_in_large_pages(map.shapes, packed ? 0 : n_slots);
    resize_in_large_pages(arrays->packed, packed ? n_slots : 0);
    map.reach.assign(n_slots, 0);
    FilledTiles filled = fill_tiles(mesh, atlas, bands, map, *arrays);
    map.tiles = {arrays, std::span<const TexelTile>(arrays->tiles)};
    map.packed = {arrays, std::span<const PackedShape>(arrays->packed)};
    if (!(map.texel_size > 0)) map.texel_size = mean_texel_size(map);
    map.cluster_start.assign(1, 0);
    for (const auto& c : filled.charts) {
        map.cluster_chart.insert(map.cluster_chart.end(), c.begin(), c.end());
        map.cluster_start.push_back(static_cast<std::uint32_t>(map.cluster_chart.size()));
    }
    for (const auto& b : filled.boxes) map.boxes.insert(map.boxes.end(), b.begin(), b.end());
    bands = {};
    filled = {};
    release_free_memory();
    for (const BorderCell& c : build_border_cells(mesh, atlas, map, true).cells)
        arrays->tiles[c.texel.slot].area[c.texel.texel] = static_cast<float>(c.area);
    report(progress, "texel map", 1);
    return map;
}

void visit_texels(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, const TexelVisit& visit) {
    check_sizes(mesh, atlas);
    const std::uint32_t side = map.tiles_per_side;
    const Bands bands = sort_into_bands(mesh, atlas, side);
    parallel_for(side, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> ids;
        for (std::size_t band = begin; band < end; ++band) {
            draw_ids(atlas, bands, band, ids);
            for (std::size_t i = 0; i < ids.size(); ++i) {
                if (ids[i] == kNone) continue;
                const auto x = static_cast<std::int64_t>(i % atlas.size);
                const auto y = static_cast<std::int64_t>(band * kTile + i / atlas.size);
                const TexelRef at = texel_ref(map, x, y);
                if (!at.valid()) continue;
                const SnappedTriangle s = snapped_triangle(atlas, ids[i]);
                Vec3 weights(0);
                for (int k = 0; k < 3; ++k)  // corner k faces edge k+1 -> k+2
                    weights[s.corner[k]] =
                        static_cast<double>(edge_value(s, (k + 1) % 3, x * kSnap + kSnap / 2, y * kSnap + kSnap / 2)) /
                        static_cast<double>(s.area2);
                visit(at.slot, at.texel, ids[i], weights);
            }
        }
    });
}

}  // namespace tuft::atlas
