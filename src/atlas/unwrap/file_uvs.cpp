#include "atlas/unwrap/file_uvs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "atlas/pack/coverage.h"
#include "atlas/pack/raster.h"
#include "atlas/pack/snap.h"
#include "atlas/seams/chart_mesh.h"
#include "atlas/seams/half_edges.h"

namespace tuft::atlas {
namespace {

using Charts = std::vector<std::vector<std::uint32_t>>;

constexpr double kBeyond = 1e-6;  // what writers with six digits round past an edge, over |uv|
constexpr std::uint32_t kMostPages = 100;
constexpr double kColumns = 10, kRows = 100;  // of UDIM pages, 1001 to 2000

/// A page of the UDIM convention.
struct Tile {
    std::uint32_t column = 0, row = 0;
    std::uint32_t number() const { return 1001 + column + 10 * row; }
};

double signed_area(const Atlas& atlas, std::size_t t) {
    const Vec2 a = Vec2(atlas.corner_uvs[3 * t + 1]) - Vec2(atlas.corner_uvs[3 * t]);
    const Vec2 b = Vec2(atlas.corner_uvs[3 * t + 2]) - Vec2(atlas.corner_uvs[3 * t]);
    return 0.5 * (a.x * b.y - a.y * b.x);
}

template <class Visit>
void for_corners(const std::vector<std::uint32_t>& chart, Visit&& visit) {
    for (const std::uint32_t t : chart)
        for (std::size_t c = 3 * std::size_t{t}; c < 3 * std::size_t{t} + 3; ++c) visit(c);
}

struct Bounds {
    Vec2 lo{1e30}, hi{-1e30};
};

Bounds bounds_of(const Atlas& atlas, const std::vector<std::uint32_t>& chart) {
    Bounds b;
    for_corners(chart, [&](std::size_t c) {
        b.lo = glm::min(b.lo, Vec2(atlas.corner_uvs[c]));
        b.hi = glm::max(b.hi, Vec2(atlas.corner_uvs[c]));
    });
    return b;
}

/// Turns over charts that lie mirrored: a page of nothing else as a whole, which leaves its charts as
/// they lie to each other, others each in its place.
void turn_mirrored(Atlas& atlas, const Charts& charts) {
    const double k = atlas.pages_per_side();
    std::vector<std::uint8_t> mirrored(charts.size());
    std::vector<Bounds> bounds(charts.size());
    std::map<double, bool> all;  // by page: no chart of it is not
    const auto column = [&](std::size_t c) { return std::floor(0.5 * k * (bounds[c].lo.x + bounds[c].hi.x)); };
    const auto page = [&](std::size_t c) {
        return column(c) + k * std::floor(0.5 * k * (bounds[c].lo.y + bounds[c].hi.y));
    };
    for (std::size_t c = 0; c < charts.size(); ++c) {
        double area = 0;
        for (const std::uint32_t t : charts[c]) area += signed_area(atlas, t);
        mirrored[c] = area < 0;
        bounds[c] = bounds_of(atlas, charts[c]);
        bool& whole = all.try_emplace(page(c), true).first->second;
        whole = whole && mirrored[c];
    }
    for (std::size_t c = 0; c < charts.size(); ++c) {
        if (!mirrored[c]) continue;
        const bool whole = all.at(page(c));
        const auto lo = static_cast<float>(whole ? column(c) / k : bounds[c].lo.x);
        const auto hi = static_cast<float>(whole ? (column(c) + 1) / k : bounds[c].hi.x);
        for_corners(charts[c], [&](std::size_t i) {
            atlas.corner_uvs[i].x = std::clamp(lo + hi - atlas.corner_uvs[i].x, lo, hi);
        });
    }
}

/// Triangles that lie where another lies, corner upon corner.
std::size_t triangles_on_others(std::span<const Vec2f> uvs) {
    std::vector<std::array<float, 6>> places(uvs.size() / 3);
    for (std::size_t t = 0; t < places.size(); ++t) {
        std::array<std::array<float, 2>, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) corners[i] = {uvs[3 * t + i].x, uvs[3 * t + i].y};
        std::sort(corners.begin(), corners.end());
        for (std::size_t i = 0; i < 3; ++i) std::copy(corners[i].begin(), corners[i].end(), &places[t][2 * i]);
    }
    std::sort(places.begin(), places.end());
    std::size_t n = 0;
    for (std::size_t t = 0; t < places.size(); ++t)
        n += (t > 0 && places[t] == places[t - 1]) || (t + 1 < places.size() && places[t] == places[t + 1]);
    return n;
}

/// Why UVs of which some lie upon others cannot be kept; `read`: as they were before mirrored
/// charts were turned over.
Message why_they_overlap(const Atlas& atlas, std::vector<Vec2f> read, std::size_t texels) {
    if (const std::size_t n = triangles_on_others(read); n > 0)
        return Message(
            "{} triangles lie where others do, as halves of a symmetric model that share their part of the texture", n);
    std::size_t turned = 0;
    for (std::size_t c = 0; c < read.size(); c += 3) {
        const Vec2 a(read[c + 1] - read[c]), b(read[c + 2] - read[c]);
        if (a.x * b.y - a.y * b.x >= 0) continue;
        std::swap(read[c + 1], read[c + 2]);
        ++turned;
    }
    if (turned > 0 && cover(read, {}, atlas.size).twice == 0)
        return "charts lie mirrored between others, which they would overlap turned over";
    return Message("they overlap in {} texels", texels);
}

/// Finds the charts that the UVs make and numbers them in the atlas.
Charts find_charts(const mesh::TriangleMesh& mesh, Atlas& atlas) {
    std::vector<std::uint32_t> glued = twin_half_edges(mesh);
    const std::vector<std::uint8_t> seam = uv_seams(glued, atlas.corner_uvs);
    for (std::size_t h = 0; h < glued.size(); ++h)
        if (seam[h]) glued[h] = kNone;
    Charts charts = connected_charts(glued);
    atlas.triangle_chart.resize(mesh.n_triangles());
    atlas.n_charts = static_cast<std::uint32_t>(charts.size());
    for (std::uint32_t c = 0; c < charts.size(); ++c)
        for (const std::uint32_t t : charts[c]) atlas.triangle_chart[t] = c;
    return charts;
}

/// The page that holds a whole chart; nothing where the chart crosses pages or lies on none.
std::optional<Tile> tile_of(const Bounds& b) {
    const Vec2 tile = glm::floor(0.5 * (b.lo + b.hi));
    const Vec2 beyond = kBeyond * glm::max(Vec2(1), glm::abs(b.hi));
    if (!(tile.x >= 0 && tile.x < kColumns && tile.y >= 0 && tile.y < kRows)) return std::nullopt;
    if (b.lo.x < tile.x - beyond.x || b.lo.y < tile.y - beyond.y) return std::nullopt;
    if (b.hi.x > tile.x + 1 + beyond.x || b.hi.y > tile.y + 1 + beyond.y) return std::nullopt;
    return Tile{static_cast<std::uint32_t>(tile.x), static_cast<std::uint32_t>(tile.y)};
}

/// Moves the pages together into the square of an atlas, in the order of their numbers.
Message place_on_pages(Atlas& atlas, const Charts& charts) {
    std::vector<Tile> tiles;
    std::vector<std::uint32_t> numbers;
    for (const auto& chart : charts) {
        const Bounds b = bounds_of(atlas, chart);
        const std::optional<Tile> tile = tile_of(b);
        if (!tile) {
            const bool on_pages =
                std::min(b.lo.x, b.lo.y) >= -kBeyond && b.hi.x <= kColumns + kBeyond && b.hi.y <= kRows + kBeyond;
            return on_pages ? "a chart lies on more than one page"
                            : "some lie outside [0, 1] and the UDIM pages 1001 to 2000";
        }
        tiles.push_back(*tile);
        numbers.push_back(tile->number());
    }
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    if (numbers.size() > kMostPages)
        return Message("they lie on {} UDIM pages, more than the {} allowed", numbers.size(), kMostPages);
    atlas.pages = static_cast<std::uint32_t>(numbers.size());
    const std::uint32_t k = atlas.pages_per_side();
    for (std::uint32_t p = 0; p < atlas.pages; ++p)
        if (numbers[p] != udim_of(atlas, p)) {
            atlas.udims = numbers;
            break;
        }
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const auto page = static_cast<std::uint32_t>(
            std::lower_bound(numbers.begin(), numbers.end(), tiles[i].number()) - numbers.begin());
        const Vec2 from(tiles[i].column, tiles[i].row), to(page % k, page / k);
        for_corners(charts[i], [&](std::size_t c) {
            const Vec2 uv = glm::clamp(Vec2(atlas.corner_uvs[c]) - from, 0.0, 1.0);
            atlas.corner_uvs[c] = Vec2f((uv + to) / double(k));
        });
    }
    return {};
}

/// Gives slivers that rounding took the module of some back.
void snap_charts(const mesh::TriangleMesh& mesh, Atlas& atlas, const Charts& charts) {
    std::vector<std::uint32_t> glued = twin_half_edges(mesh);
    const std::vector<std::uint8_t> seam = uv_seams(glued, atlas.corner_uvs);
    for (std::size_t h = 0; h < glued.size(); ++h)
        if (seam[h]) glued[h] = kNone;
    for (const auto& chart : charts) {
        if (std::all_of(chart.begin(), chart.end(), [&](std::uint32_t t) { return signed_area(atlas, t) > 0; }))
            continue;
        const ChartMesh m = make_chart(mesh, glued, chart, 1);
        std::vector<Vec2> uv(m.n_vertices());
        const auto corner = [&](std::size_t f, std::size_t k) -> Vec2f& {
            return atlas.corner_uvs[3 * std::size_t{chart[f]} + k];
        };
        for (std::size_t f = 0; f < m.faces.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) uv[m.faces[f][k]] = Vec2(corner(f, k));
        snap_to_floats(m.faces, uv, atlas.size);
        for (std::size_t f = 0; f < m.faces.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) corner(f, k) = Vec2f(uv[m.faces[f][k]]);
    }
}

/// Sets the texels of a page and their size; returns what is wrong with that.
Message give_size(const mesh::TriangleMesh& mesh, const UnwrapOptions& options, Atlas& atlas) {
    double area_uv = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) area_uv += std::abs(signed_area(atlas, t));
    const std::uint32_t k = atlas.pages_per_side();
    if (!(area_uv > 0)) return "no triangle has room in them";
    const double side = std::sqrt(mesh::surface_area(mesh) / area_uv) / k;  // metres along a page
    double size = options.size;
    if (options.size == 0) size = std::max(1.0, std::ceil(side / options.texel_size));
    if (size * k > options.max_size) {
        const std::string all = std::to_string(static_cast<long long>(std::min(size, 1e15)));
        if (options.size > 0)
            return Message("{} pages of {} texels are together more than fit a square of {} texels; use smaller pages",
                           atlas.pages, all, options.max_size);
        return Message("a texel of {} mm needs an atlas of {} texels with them, more than the {} allowed",
                       options.texel_size * 1e3, all, options.max_size);
    }
    atlas.size = static_cast<std::uint32_t>(size) * k;
    atlas.texel_size = side / size;
    return {};
}

}  // namespace

FileUvs read_file_uvs(const mesh::TriangleMesh& mesh, const UnwrapOptions& options) {
    FileUvs found;
    Atlas& atlas = found.atlas;
    const std::size_t n = mesh.n_triangles();
    const auto fault = [&](Message what) {
        found.fault = std::move(what);
        found.atlas = {};
        return found;
    };
    if (mesh.corner_uvs.size() != 3 * n) return fault("there are none");
    atlas.corner_uvs = mesh.corner_uvs;
    Vec2f lo(0), hi(1);
    for (const Vec2f& uv : atlas.corner_uvs) {
        if (!is_finite(uv)) return fault("some are not finite");
        lo = glm::min(lo, uv);
        hi = glm::max(hi, uv);
    }
    const bool on_one = std::min(lo.x, lo.y) >= -kBeyond && std::max(hi.x, hi.y) <= 1 + kBeyond;
    if (!on_one && options.uvs != UvPolicy::keep) return fault("some lie outside [0, 1]");
    if (on_one)
        for (Vec2f& uv : atlas.corner_uvs) uv = glm::clamp(uv, Vec2f(0), Vec2f(1));

    const Charts charts = find_charts(mesh, atlas);
    if (!on_one)
        if (Message what = place_on_pages(atlas, charts); !what.empty()) return fault(std::move(what));
    atlas.gutter = options.gutter;
    atlas.from_file = true;
    if (Message what = give_size(mesh, options, atlas); !what.empty()) return fault(std::move(what));
    const std::vector<Vec2f> read = atlas.corner_uvs;
    turn_mirrored(atlas, charts);
    if (atlas.pages > 1) snap_charts(mesh, atlas, charts);
    std::size_t zero_area = 0, flipped = 0;
    for (std::size_t t = 0; t < n; ++t) {
        const double area = signed_area(atlas, t);
        zero_area += area == 0;
        flipped += area < 0;
    }
    if (zero_area > 0) return fault(Message("{} triangles have no room in them", zero_area));
    if (flipped > 0 && triangles_on_others(read) > 0) return fault(why_they_overlap(atlas, read, 0));
    if (flipped > 0) return fault(Message("{} triangles are flipped", flipped));

    const Coverage coverage = cover(atlas.corner_uvs, {}, atlas.size);
    if (coverage.twice > 0) return fault(why_they_overlap(atlas, read, coverage.twice));
    const std::vector<std::uint8_t> seam = uv_seams(twin_half_edges(mesh), atlas.corner_uvs);
    const int gap = smallest_gap(seam, atlas);
    const int least = std::min<int>(options.uvs == UvPolicy::keep ? 1 : 2, int(options.gutter));
    if (gap < least)
        return fault(Message("charts are less than {} texels apart at a size of {}", least, atlas.page_size()));
    return found;
}

UvCheck check_file_uvs(const mesh::TriangleMesh& mesh, std::uint32_t size) {
    UvCheck check;
    UnwrapOptions options;
    options.size = size;
    options.uvs = UvPolicy::keep;
    check.fault = read_file_uvs(mesh, options).fault;
    Atlas& atlas = check.atlas;
    atlas.corner_uvs = mesh.corner_uvs;
    const Charts charts = find_charts(mesh, atlas);
    if (std::all_of(atlas.corner_uvs.begin(), atlas.corner_uvs.end(), is_finite)) {
        Atlas paged = atlas;
        if (place_on_pages(paged, charts).empty()) atlas = std::move(paged);
    }
    atlas.size = size * atlas.pages_per_side();
    atlas.gutter = options.gutter;
    atlas.from_file = true;
    double area_uv = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) area_uv += std::abs(signed_area(atlas, t));
    if (area_uv > 0 && std::isfinite(area_uv))
        atlas.texel_size = std::sqrt(mesh::surface_area(mesh) / area_uv) / atlas.size;
    return check;
}

}  // namespace tuft::atlas
