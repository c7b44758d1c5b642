#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "atlas/atlas.h"
#include "atlas/charts/charts.h"
#include "atlas/charts/cut_to_pack.h"
#include "atlas/charts/equal_parts.h"
#include "atlas/charts/merge.h"
#include "atlas/charts/move_seams.h"
#include "atlas/charts/refine_parameterisation.h"
#include "atlas/pack/coverage.h"
#include "atlas/pack/pack.h"
#include "atlas/pack/snap.h"
#include "atlas/seams/requested_seams.h"
#include "atlas/unwrap/file_uvs.h"
#include "core/system/memory.h"

namespace tuft::atlas {
namespace {

constexpr int kMostRepairs = 24;
constexpr int kImprovements = 2;  // rounds of moving seams and merging charts anew

// Part of the stretch allowed that is left: with less, which charts grow hangs on roundings.
constexpr double kWorthMerging = 0.4;

class Stopwatch {
  public:
    void lap(AtlasReport& report, const std::string& phase) {
        const auto now = std::chrono::steady_clock::now();
        report.seconds.emplace_back(phase, std::chrono::duration<double>(now - last_).count());
        last_ = now;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

double mean_texel_size(const mesh::TriangleMesh& mesh, const Atlas& atlas) {
    double area_uv = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec2 a = Vec2(atlas.corner_uvs[3 * t + 1]) - Vec2(atlas.corner_uvs[3 * t]);
        const Vec2 b = Vec2(atlas.corner_uvs[3 * t + 2]) - Vec2(atlas.corner_uvs[3 * t]);
        area_uv += 0.5 * std::abs(a.x * b.y - a.y * b.x);
    }
    return std::sqrt(mesh::surface_area(mesh) / area_uv) / atlas.size;
}

[[noreturn]] void refuse_texel_size(const UnwrapOptions& options, double size) {
    char millimetres[32];
    std::snprintf(millimetres, sizeof millimetres, "%.3g", options.texel_size * 1e3);
    throw Error(Message("a texel of {} mm needs an atlas of {} texels, more than the {} allowed; use larger texels",
                        std::string(millimetres), static_cast<long long>(size), options.max_size));
}

[[noreturn]] void refuse_size(const UnwrapOptions& options, const CutMesh& cut, double size) {
    throw Error(Message("an atlas of {} texels cannot hold {} charts with gutters of {}; it needs at least {}",
                        options.size, cut.charts.size(), options.gutter, static_cast<long long>(size)));
}

/// Whether the layout is as large as the user allows; charts too large for a page are not
/// complained about, they can be cut.
void check_packing(const CutMesh& cut, const UnwrapOptions& options, const Packing& packing) {
    if (options.pages == 1) {
        if (!packing.fits) refuse_size(options, cut, packing.size);
        if (packing.size > options.max_size) refuse_texel_size(options, packing.size);
        return;
    }
    if (!packing.too_large.empty()) return;
    if (packing.fits) {
        Atlas atlas;
        atlas.pages = packing.pages;
        if (packing.size * std::size_t{atlas.pages_per_side()} <= options.max_size) return;
        throw Error(Message("{} pages of {} texels are more than fit a square of {} texels; use larger texels",
                            packing.pages, packing.size, options.max_size));
    }
    if (options.texel_size > 0)
        throw Error(Message("a texel of {} mm needs more than {} pages of {} texels; allow more or use larger texels",
                            options.texel_size * 1e3, options.pages, options.size));
    refuse_size(options, cut, 2.0 * options.size);
}

PackOptions pack_options(const CutMesh& cut, const UnwrapOptions& options) {
    PackOptions pack;
    pack.gutter = options.gutter;
    pack.progress = options.progress;
    pack.pages = options.pages;
    pack.size = options.size;
    if (options.size == 0 || (options.pages > 1 && options.texel_size > 0))
        pack.texels_per_unit = cut.unit / options.texel_size;
    return pack;
}

Packing pack_charts(const CutMesh& cut, const UnwrapOptions& options, bool quick) {
    PackOptions how = pack_options(cut, options);
    how.search = quick ? Search::quick : Search::patient;
    Packing packing = pack(chart_borders(cut), how);
    check_packing(cut, options, packing);
    return packing;
}

/// Rounds the placed charts into the atlas; the triangles that found no room.
std::vector<std::uint32_t> place_charts(const CutMesh& cut, const Packing& packing, Atlas& atlas) {
    std::vector<std::uint32_t> zero_area;
    atlas.pages = packing.pages;
    const std::uint32_t per_side = atlas.pages_per_side();
    atlas.size = packing.size * per_side;
    atlas.n_charts = static_cast<std::uint32_t>(cut.charts.size());
    for (std::uint32_t c = 0; c < atlas.n_charts; ++c) {
        const FlatChart& chart = cut.charts[c];
        const Placement& p = packing.placements[c];
        const std::uint32_t page = packing.page.empty() ? 0 : packing.page[c];
        const Vec2 offset = p.offset + double(packing.size) * Vec2(page % per_side, page / per_side);
        std::vector<Vec2> uv(chart.uv.size());
        for (std::size_t v = 0; v < uv.size(); ++v) {
            const Vec2& q = chart.uv[v];
            uv[v] = (offset + p.scale * Vec2(p.c * q.x - p.s * q.y, p.s * q.x + p.c * q.y)) / double(atlas.size);
        }
        for (const std::uint32_t t : snap_to_floats(chart.mesh.faces, uv, atlas.size))
            zero_area.push_back(chart.mesh.triangles[t]);
        for (std::size_t t = 0; t < chart.mesh.faces.size(); ++t) {
            const std::uint32_t triangle = chart.mesh.triangles[t];
            atlas.triangle_chart[triangle] = c;
            for (int k = 0; k < 3; ++k)
                atlas.corner_uvs[3 * std::size_t{triangle} + k] = Vec2f(uv[chart.mesh.faces[t][k]]);
        }
    }
    return zero_area;
}

/// Limits of charts for this atlas.
struct Limits {
    ChartOptions chart;
    MergeOptions merge;
};

Limits chart_limits(const mesh::TriangleMesh& mesh, const UnwrapOptions& options) {
    Limits limits;
    limits.chart.seams = options.seams;
    // Texels along the square root of the surface's area: charts cover about two thirds.
    const double covered = 0.8 * options.size * std::sqrt(options.pages);
    const bool by_texel = options.texel_size > 0 && (options.size == 0 || options.pages > 1);
    const double texels = by_texel ? std::sqrt(mesh::surface_area(mesh)) / options.texel_size : covered;
    // Parts of one chart keep a gutter from each other like two charts do.
    limits.chart.gap = options.gutter / texels;
    if (options.pages > 1) {  // charts have to fit a page, and some beside each other
        const double page = (double(options.size) - 2 * options.gutter) / texels;
        limits.chart.longest = std::min(limits.chart.longest, 0.9 * page);
        limits.chart.grown = std::min(limits.chart.grown, 0.4 * page * page);
        limits.merge.longest = std::min(limits.merge.longest, 0.8 * page);
        limits.merge.largest_chart = std::min(limits.merge.largest_chart, 0.4 * page * page);
        limits.merge.largest_at_last = std::min(limits.merge.largest_at_last, 0.4 * page * page);
    }
    return limits;
}

/// Charts and their places.
struct Layout {
    CutMesh cut;
    Atlas atlas;
    double use = 0;  ///< covered part of the pages
};

/// Finds every chart its place. Slivers that vanish in rounding become charts of their own; charts that
/// overlap after all are cut. Both end, at single triangles at the latest. A quick layout is enough to
/// find them; the best one is made at the end and checked again.
void make_layout(const mesh::TriangleMesh& mesh, const UnwrapOptions& options, const ChartOptions& chart_options,
                 Layout& layout, Stopwatch& watch, AtlasReport& out) {
    CutMesh& cut = layout.cut;
    Atlas& atlas = layout.atlas;
    atlas.gutter = options.gutter;
    atlas.corner_uvs.resize(3 * mesh.n_triangles());
    atlas.triangle_chart.resize(mesh.n_triangles());
    bool quick = true;
    std::optional<Packing> made;
    for (int round = 0; round < kMostRepairs; ++round) {
        const Packing packing = made ? std::move(*made) : pack_charts(cut, options, quick);
        made.reset();
        watch.lap(out, "pack");
        if (!packing.too_large.empty()) {
            cut_again(mesh, cut, packing.too_large, chart_options, options.progress);
            watch.lap(out, "repair");
            continue;
        }
        std::vector<std::uint32_t> zero_area = place_charts(cut, packing, atlas);
        const Coverage coverage = cover(atlas.corner_uvs, atlas.triangle_chart, atlas.size);
        layout.use = double(coverage.covered) / (double(packing.size) * packing.size * packing.pages);
        report(options.progress, "check", 1);
        watch.lap(out, "check");
        if (zero_area.empty() && coverage.twice == 0) {
            if (!quick) break;
            quick = false;
            const bool filled = options.size > 0 && (options.pages == 1 || options.texel_size == 0);
            if (options.cutting != Cutting::never && filled) {
                const bool tight = options.cutting == Cutting::tight;
                made =
                    cut_to_pack(mesh, cut, chart_options.gap, pack_options(cut, options), tight ? kTightUse : kGoodUse)
                        .packing;
                watch.lap(out, "pack");
            }
            continue;
        }
        if (!zero_area.empty()) {
            std::sort(zero_area.begin(), zero_area.end());
            cut_out(mesh, cut, zero_area, chart_options, options.progress);
        } else {
            cut_again(mesh, cut, coverage.charts_twice, chart_options, options.progress);
        }
        watch.lap(out, "repair");
    }
    if (atlas.size == 0) refuse_size(options, cut, 2.0 * options.size);
}

/// The mesh that is cut into charts: all of it, or the first of each kind of its equal parts.
class ChartedMesh {
  public:
    ChartedMesh(const mesh::TriangleMesh& mesh, const RequestedSeams& seams)
        : whole_(mesh), twin_(twin_half_edges(mesh)) {
        cut_requested_seams(mesh, seams, twin_);
        parts_ = find_equal_parts(mesh, twin_);
        if (parts_.any())
            kept_ = kept_mesh(mesh, parts_);
        else
            parts_ = {};
    }

    const mesh::TriangleMesh& mesh() const { return parts_.any() ? kept_ : whole_; }

    /// To be called once.
    CutMesh uncut() {
        const double unit = chart_unit(whole_);
        if (parts_.any()) return uncut_kept_mesh(parts_, twin_, unit);
        CutMesh cut;
        cut.unit = unit;
        cut.twin = std::move(twin_);
        return cut;
    }

    /// The charts of the whole, best flattened, from those of `mesh`.
    CutMesh finished(CutMesh cut, const ChartOptions& options, const ProgressFn& progress) const {
        refine_parameterisation(cut, options, progress);
        return parts_.any() ? with_copies(whole_, parts_, twin_, cut) : cut;
    }

  private:
    const mesh::TriangleMesh& whole_;
    std::vector<std::uint32_t> twin_;  // of the whole, while there are equal parts
    EqualParts parts_;
    mesh::TriangleMesh kept_;
};

Unwrapped make_atlas(const mesh::TriangleMesh& mesh, const UnwrapOptions& options) {
    Unwrapped out;
    Stopwatch watch;
    Limits limits = chart_limits(mesh, options);
    const ChartOptions& chart_options = limits.chart;
    MergeOptions& merge_options = limits.merge;
    ChartedMesh charted(mesh, options.seams);
    Layout layout;
    CutMesh& cut = layout.cut;
    cut = cut_into_charts(charted.mesh(), charted.uncut(), chart_options, options.progress);
    release_free_memory();
    watch.lap(out.report, "charts");
    const auto merge = [&] { merge_charts(charted.mesh(), cut, chart_options, merge_options, options.progress); };
    merge();
    release_free_memory();
    watch.lap(out.report, "merge");
    const bool blockwise = charted.mesh().n_triangles() >= kBlockwiseThreshold;
    for (int round = 0; round < (blockwise ? 1 : kImprovements); ++round) {
        const bool moved = move_seams(charted.mesh(), cut, chart_options, options.progress);
        release_free_memory();
        watch.lap(out.report, "move");
        if (!moved) break;
        merge();
        watch.lap(out.report, "merge");
    }
    // A few large charts have shorter seams, but may leave more of the page bare.
    std::optional<Layout> smaller;
    const bool can_grow = merge_options.largest_chart < merge_options.largest_at_last;
    if (!blockwise && can_grow && StretchBudget(cut, chart_options.l2_all).left() > kWorthMerging) {
        smaller = layout;
        merge_options.largest_chart = merge_options.largest_at_last;
        merge();
        if (cut.charts.size() == smaller->cut.charts.size()) smaller.reset();
        watch.lap(out.report, "merge");
    }
    const auto finish = [&](Layout& of) {
        of.cut = charted.finished(std::move(of.cut), chart_options, options.progress);
        watch.lap(out.report, "polish");
        make_layout(mesh, options, chart_options, of, watch, out.report);
    };
    finish(layout);
    if (smaller && layout.use < kGoodUse) {
        finish(*smaller);
        if (smaller->use > layout.use) layout = std::move(*smaller);
    }
    out.atlas = std::move(layout.atlas);
    out.atlas.texel_size = mean_texel_size(mesh, out.atlas);
    return out;
}

void check_options(const mesh::TriangleMesh& mesh, const UnwrapOptions& options) {
    if (mesh.n_triangles() == 0) throw Error("the mesh has no triangles to unwrap");
    if (options.size > options.max_size)
        throw Error(Message("an atlas of {} texels is larger than the {} allowed", options.size, options.max_size));
    if (options.pages == 0 || options.pages > 100)
        throw Error(Message("an atlas has 1 to 100 pages, not {}", options.pages));
    if (options.pages > 1) {
        if (!(options.texel_size >= 0) || !std::isfinite(options.texel_size))
            throw Error("the texel size must be above 0");
        return;
    }
    if (options.size > 0) return;
    if (!(options.texel_size > 0) || !std::isfinite(options.texel_size)) throw Error("the texel size must be above 0");
    const double least = std::sqrt(mesh::surface_area(mesh)) / options.texel_size;
    if (least > options.max_size) refuse_texel_size(options, std::min(least / 0.8, 1e15));
}

}  // namespace

std::uint32_t Atlas::pages_per_side() const {
    std::uint32_t k = 1;
    while (k * k < pages) ++k;
    return k;
}

std::uint32_t Atlas::page_of(std::size_t triangle) const {
    const std::uint32_t k = pages_per_side();
    const Vec2 middle =
        (Vec2(corner_uvs[3 * triangle]) + Vec2(corner_uvs[3 * triangle + 1]) + Vec2(corner_uvs[3 * triangle + 2])) /
        3.0;
    const auto index = [k](double x) { return static_cast<std::uint32_t>(std::clamp(x * k, 0.0, k - 0.5)); };
    return index(middle.y) * k + index(middle.x);
}

Vec2 page_uv(const Atlas& atlas, std::uint32_t page, const Vec2f& uv) {
    const std::uint32_t k = atlas.pages_per_side();
    return glm::clamp(Vec2(uv) * double(k) - Vec2(page % k, page / k), 0.0, 1.0);
}

std::uint32_t udim_of(const Atlas& atlas, std::uint32_t page) {
    if (!atlas.udims.empty()) return atlas.udims[page];
    const std::uint32_t k = atlas.pages_per_side();
    return 1001 + page % k + 10 * (page / k);
}

Unwrapped unwrap(const mesh::TriangleMesh& mesh, const UnwrapOptions& given) {
    UnwrapOptions options = given;
    if (options.size == 0 && options.pages > 1) options.size = 4096;
    if (options.size == 0 && options.texel_size == 0) options.size = 2048;
    check_options(mesh, options);
    keep_free_memory_below(std::size_t{8} << 20);
    if (options.uvs == UvPolicy::keep ||
        (options.uvs == UvPolicy::automatic && !options.seams.any() && options.pages == 1)) {
        UnwrapOptions file = options;  // says itself how many pages it has
        if (options.pages > 1 && options.texel_size > 0) file.size = 0;
        const FileUvs found = read_file_uvs(mesh, file);
        if (found.fault.empty()) return {found.atlas, measure(mesh, found.atlas)};
        if (options.uvs == UvPolicy::keep)
            throw Error(
                Message("the model's UVs cannot be kept: {}; leave out --keep-uv to make new ones", found.fault));
    }
    Unwrapped out = make_atlas(mesh, options);
    auto seconds = std::move(out.report.seconds);
    out.report = measure(mesh, out.atlas);
    out.report.seconds.insert(out.report.seconds.begin(), seconds.begin(), seconds.end());
    return out;
}

}  // namespace tuft::atlas
