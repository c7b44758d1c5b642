#include "atlas/charts/charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "atlas/charts/developable.h"
#include "atlas/charts/phase_progress.h"
#include "atlas/charts/tasks.h"
#include "atlas/flatten/hull.h"
#include "atlas/seams/requested_seams.h"
#include "atlas/seams/straighten.h"

namespace tuft::atlas {
namespace {

using Triangles = std::vector<std::uint32_t>;

/// Triangles still to be flattened, and how often they were cut before.
struct Piece {
    Triangles triangles;
    int depth = 0;
};

double stretch_of(const FlatChart& chart) {
    return chart.l2 * chart.l2 * chart.mesh.area * chart.copies;
}

double difference(std::span<const FlatChart* const> before, std::span<const FlatChart* const> now) {
    double more = 0;
    for (const FlatChart* c : before) more -= stretch_of(*c);
    for (const FlatChart* c : now) more += stretch_of(*c);
    return more;
}

bool good(const FlatCheck& check, const ChartOptions& options, int depth) {
    constexpr int kPatience = 3;  // cuts that are made for the sake of single triangles
    return check.sound() && check.l2 <= options.l2 && check.stretch_999 <= options.largest &&
           (check.linf <= options.worst || depth >= kPatience);
}

void cut_edge(CutMesh& cut, std::uint32_t h) {
    if (cut.glued[h] == kNone) return;
    cut.glued[cut.glued[h]] = kNone;
    cut.glued[h] = kNone;
}

/// Seams of a patch carried over to the mesh.
void cut_along(CutMesh& cut, const Patch& patch, std::span<const std::uint8_t> seam) {
    for (std::uint32_t h = 0; h < seam.size(); ++h)
        if (seam[h]) cut_edge(cut, 3 * patch.triangles[h / 3] + h % 3);
}

/// Connected parts of `triangles` under the seams of `cut`.
std::vector<Triangles> parts_of(const CutMesh& cut, const Triangles& triangles) {
    std::vector<std::uint32_t> local(3 * triangles.size());
    for (std::uint32_t h = 0; h < local.size(); ++h)
        local[h] = local_half(triangles, cut.glued[3 * triangles[h / 3] + h % 3]);
    std::vector<Triangles> parts = connected_charts(local);
    for (Triangles& part : parts)
        for (std::uint32_t& t : part) t = triangles[t];
    return parts;
}

/// Cuts a piece that would not lie flat: by developability with limits that tighten with
/// every cut, then by size, at last into single triangles.
std::vector<Piece> cut_piece(const mesh::TriangleMesh& mesh, CutMesh& cut, const Piece& piece) {
    constexpr int kSingles = 14;
    const Patch patch = make_patch(mesh, cut.glued, piece.triangles, cut.unit);
    std::vector<Triangles> parts;
    int depth = piece.depth;
    for (; parts.size() < 2 && depth <= kSingles; ++depth) {
        if (depth == kSingles) {
            cut_along(cut, patch, std::vector<std::uint8_t>(patch.twin.size(), 1));
            parts = parts_of(cut, piece.triangles);
            continue;
        }
        NormalMoments all;
        for (std::uint32_t t = 0; t < patch.triangles.size(); ++t)
            all.add(NormalMoments::of(patch.area[t], patch.normal[t]));
        GluingLimits limits;
        limits.crease = 4;
        limits.error = 0.4 * all.error() / std::max(all.area, 1e-300);
        if (depth % 2 == 1 || limits.error < 1e-7) {
            limits.error = 1;
            limits.mean_normal = 0;
            limits.area = 0.6 * all.area;
        }
        const std::vector<std::uint8_t> seam = developable_seams(patch, {}, limits, {});
        std::vector<std::uint32_t> local(patch.twin);
        for (std::uint32_t h = 0; h < seam.size(); ++h)
            if (seam[h]) local[h] = kNone;
        if (connected_charts(local).size() < 2) continue;
        cut_along(cut, patch, seam);
        parts = parts_of(cut, piece.triangles);
    }
    std::vector<Piece> pieces;
    pieces.reserve(parts.size());
    for (Triangles& part : parts) pieces.push_back({std::move(part), depth});
    return pieces;
}

/// Lays the piece flat; false when that stretches it too much.
bool flatten_piece(const mesh::TriangleMesh& mesh, CutMesh& cut, const Piece& piece, const ChartOptions& options,
                   TaskProgress phase, FlatChart& flat) {
    flat.mesh = make_chart(mesh, cut.glued, piece.triangles, cut.unit, cut.place);
    ArapOptions arap = trial_arap(options);
    const double step = static_cast<double>(piece.triangles.size()) / arap.iterations;
    arap.on_step = [&] { phase.advance(step); };
    flat.uv = flatten(flat.mesh, arap);
    if (flat.uv.empty()) return false;
    const FlatCheck check = check_flat(flat.mesh, flat.uv, options.gap);
    flat.worst = check.linf;
    flat.l2 = check.l2;
    if (!cut.copies.empty()) flat.copies = cut.copies[piece.triangles[0]];
    if (flat.mesh.faces.size() > 1 && !good(check, options, piece.depth)) return false;
    phase.finish();
    return true;
}

/// Flattens all pieces, cutting those that do not lie flat, and adds them to the charts.
void flatten_pieces(const mesh::TriangleMesh& mesh, CutMesh& cut, std::vector<Piece> pieces,
                    const ChartOptions& options, const ProgressFn& progress) {
    double all = 0;
    for (const Piece& p : pieces) all += static_cast<double>(p.triangles.size());
    // Pieces that are cut are laid flat again: as much more as is usual.
    PhaseProgress phase(progress, "flatten", 1.3 * all);
    while (!pieces.empty()) {
        std::stable_sort(pieces.begin(), pieces.end(),
                         [](const Piece& a, const Piece& b) { return a.triangles.size() > b.triangles.size(); });
        std::vector<FlatChart> flat(pieces.size());
        std::vector<std::vector<Piece>> parts(pieces.size());
        const auto size = [&](std::size_t i) { return static_cast<double>(pieces[i].triangles.size()); };
        run_tasks_within(pieces.size(), flattened_at_once(mesh.n_triangles()), size, [&](std::size_t i) {
            const TaskProgress part(phase, static_cast<double>(pieces[i].triangles.size()));
            if (flatten_piece(mesh, cut, pieces[i], options, part, flat[i])) return;
            flat[i] = {};
            parts[i] = cut_piece(mesh, cut, pieces[i]);  // changes seams inside the piece only
        });
        std::vector<Piece> again;
        for (std::size_t i = 0; i < flat.size(); ++i) {
            if (!flat[i].uv.empty()) cut.charts.push_back(std::move(flat[i]));
            for (Piece& p : parts[i]) again.push_back(std::move(p));
        }
        pieces = std::move(again);
    }
}

/// Slices charts that are too long for a page across their length.
std::vector<Piece> cut_long_charts(CutMesh& cut, const ChartOptions& options) {
    std::vector<Piece> pieces;
    std::vector<FlatChart> kept;
    for (FlatChart& chart : cut.charts) {
        const Rectangle box = smallest_rectangle(chart_hull(chart));
        if (box.length <= options.longest || chart.mesh.faces.size() == 1) {
            kept.push_back(std::move(chart));
            continue;
        }
        const double slices = std::ceil(box.length / options.longest);
        double lo = std::numeric_limits<double>::infinity();
        for (const Vec2& p : chart.uv) lo = std::min(lo, box.c * p.x + box.s * p.y);
        const auto slice = [&](std::uint32_t f) {
            Vec2 middle(0);
            for (const std::uint32_t v : chart.mesh.faces[f]) middle += chart.uv[v] / 3.0;
            return std::floor((box.c * middle.x + box.s * middle.y - lo) / box.length * slices);
        };
        for (std::uint32_t h = 0; h < chart.mesh.twin.size(); ++h) {
            const std::uint32_t g = chart.mesh.twin[h];
            if (g != kNone && slice(h / 3) != slice(g / 3)) cut_edge(cut, 3 * chart.mesh.triangles[h / 3] + h % 3);
        }
        for (Triangles& part : parts_of(cut, chart.mesh.triangles)) pieces.push_back({std::move(part), 0});
    }
    cut.charts = std::move(kept);
    return pieces;
}

}  // namespace

StretchBudget::StretchBudget(const CutMesh& cut, double l2) {
    for (const FlatChart& c : cut.charts) {
        used_ += stretch_of(c);
        all_ += l2 * l2 * c.mesh.area * c.copies;
        area_ += c.mesh.area * c.copies;
    }
}

bool StretchBudget::allows(std::span<const FlatChart* const> before, std::span<const FlatChart* const> now) const {
    const double more = difference(before, now);
    return more <= 0 || used_ + more <= all_;
}

void StretchBudget::spend(std::span<const FlatChart* const> before, std::span<const FlatChart* const> now) {
    used_ += difference(before, now);
}

Patch whole_patch(const mesh::TriangleMesh& mesh, const CutMesh& cut) {
    std::vector<std::uint32_t> all(mesh.n_triangles());
    std::iota(all.begin(), all.end(), 0u);
    return make_patch(mesh, cut.twin, std::move(all), cut.unit);
}

std::vector<std::uint8_t> seam_flags(const CutMesh& cut) {
    std::vector<std::uint8_t> seam(cut.glued.size());
    for (std::size_t h = 0; h < seam.size(); ++h) seam[h] = cut.glued[h] == kNone;
    return seam;
}

void number_charts(CutMesh& cut) {
    for (FlatChart& chart : cut.charts)
        if (chart.version == 0) chart.version = ++cut.versions;
}

std::vector<Vec2> chart_hull(const FlatChart& chart) {
    std::vector<Vec2> border;
    border.reserve(chart.mesh.loop.size());
    for (const std::uint32_t v : chart.mesh.loop) border.push_back(chart.uv[v]);
    return convex_hull(std::move(border));
}

ArapOptions trial_arap(const ChartOptions& options) {
    ArapOptions arap;
    arap.iterations = 16;
    arap.tolerance = 1e-2;
    // For small strains L2 − 1 lies between half the energy and all of it.
    arap.abandon_energy = 4 * (options.l2 - 1);
    return arap;
}

double chart_unit(const mesh::TriangleMesh& mesh) {
    return std::max(std::sqrt(mesh::surface_area(mesh)), 1e-30);
}

CutMesh cut_into_charts(const mesh::TriangleMesh& mesh, const ChartOptions& options, const ProgressFn& progress) {
    CutMesh uncut;
    uncut.twin = twin_half_edges(mesh);
    cut_requested_seams(mesh, options.seams, uncut.twin);
    uncut.unit = chart_unit(mesh);
    return cut_into_charts(mesh, std::move(uncut), options, progress);
}

CutMesh cut_into_charts(const mesh::TriangleMesh& mesh, CutMesh uncut, const ChartOptions& options,
                        const ProgressFn& progress) {
    CutMesh cut = std::move(uncut);
    cut.glued = cut.twin;
    cut.place.resize(mesh.n_triangles());
    {
        const Patch patch = whole_patch(mesh, cut);
        GluingLimits limits;
        limits.triangles = options.triangles / 2;  // so that all threads have some to lay flat
        const std::vector<std::uint8_t> small = small_chart_seams(mesh, cut.twin, cut.unit, limits, progress);
        std::vector<std::uint8_t> seam = developable_seams(patch, small, limits, progress);
        straighten_seams(patch, seam);
        cut_along(cut, patch, seam);
    }
    std::vector<Piece> pieces;
    for (Triangles& t : connected_charts(cut.glued)) pieces.push_back({std::move(t), 0});
    flatten_pieces(mesh, cut, std::move(pieces), options, progress);
    flatten_pieces(mesh, cut, cut_long_charts(cut, options), options, progress);
    return cut;
}

void cut_again(const mesh::TriangleMesh& mesh, CutMesh& cut, std::span<const std::uint32_t> charts,
               const ChartOptions& options, const ProgressFn& progress) {
    std::vector<Piece> pieces;
    std::vector<FlatChart> kept;
    for (std::uint32_t c = 0; c < cut.charts.size(); ++c) {
        if (!std::binary_search(charts.begin(), charts.end(), c)) {
            kept.push_back(std::move(cut.charts[c]));
            continue;
        }
        for (Piece& p : cut_piece(mesh, cut, {std::move(cut.charts[c].mesh.triangles), 1}))
            pieces.push_back(std::move(p));
    }
    cut.charts = std::move(kept);
    flatten_pieces(mesh, cut, std::move(pieces), options, progress);
}

void cut_out(const mesh::TriangleMesh& mesh, CutMesh& cut, std::span<const std::uint32_t> triangles,
             const ChartOptions& options, const ProgressFn& progress) {
    for (const std::uint32_t t : triangles)
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) cut_edge(cut, h);
    std::vector<Piece> pieces;
    std::vector<FlatChart> kept;
    for (FlatChart& chart : cut.charts) {
        const Triangles& own = chart.mesh.triangles;
        const bool hit = std::any_of(triangles.begin(), triangles.end(),
                                     [&](std::uint32_t t) { return std::binary_search(own.begin(), own.end(), t); });
        if (!hit) {
            kept.push_back(std::move(chart));
            continue;
        }
        for (Triangles& part : parts_of(cut, own)) pieces.push_back({std::move(part), 0});
    }
    cut.charts = std::move(kept);
    flatten_pieces(mesh, cut, std::move(pieces), options, progress);
}

}  // namespace tuft::atlas
