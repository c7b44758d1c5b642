#include "atlas/charts/developable.h"

#include <algorithm>

#include "atlas/charts/charts.h"
#include "atlas/charts/phase_progress.h"
#include "atlas/charts/tasks.h"

namespace tuft::atlas {
namespace {

constexpr std::size_t kBlock = 1 << 15;    // triangles of a block, at most: its graph fits a cache
constexpr std::uint32_t kSmallChart = 96;  // triangles of a chart glued in its block, at most

using Triangles = std::vector<std::uint32_t>;

struct Place {
    Vec3f middle;
    std::uint32_t triangle;
};

/// Halves the triangles across their longest extent until the blocks are small.
std::vector<Triangles> compact_blocks(const mesh::TriangleMesh& mesh) {
    std::vector<Place> all(mesh.n_triangles());
    for (std::uint32_t t = 0; t < all.size(); ++t)
        all[t] = {Vec3f(mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)), t};
    std::vector<std::span<Place>> open{all};
    std::vector<Triangles> blocks;
    while (!open.empty()) {
        const std::span<Place> part = open.back();
        open.pop_back();
        if (part.size() <= kBlock) {
            Triangles& block = blocks.emplace_back();
            for (const Place& p : part) block.push_back(p.triangle);
            std::sort(block.begin(), block.end());
            continue;
        }
        Box bounds;
        for (const Place& p : part) bounds.add(Vec3(p.middle));
        const Vec3 size = bounds.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t half = part.size() / 2;
        std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
                         [axis](const Place& a, const Place& b) {
                             const float pa = a.middle[axis], pb = b.middle[axis];
                             return pa != pb ? pa < pb : a.triangle < b.triangle;
                         });
        open.push_back(part.first(half));
        open.push_back(part.subspan(half));
    }
    return blocks;
}

}  // namespace

std::vector<std::uint8_t> developable_seams(const Patch& patch, std::span<const std::uint8_t> seam,
                                            const GluingLimits& limits, const ProgressFn& progress) {
    SeamGraph graph(patch, seam);
    graph.glue_developable(limits, progress);
    return graph.seams();
}

std::vector<std::uint8_t> small_chart_seams(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin,
                                            double unit, GluingLimits limits, const ProgressFn& progress) {
    if (mesh.n_triangles() < kBlockwiseThreshold) return {};
    limits.triangles = std::min(limits.triangles, kSmallChart);
    std::vector<Triangles> blocks = compact_blocks(mesh);
    PhaseProgress phase(progress, "small charts", static_cast<double>(mesh.n_triangles()));
    std::vector<std::uint8_t> seam(twin.size(), 1);
    run_tasks(blocks.size(), [&](std::size_t i) {
        const auto size = static_cast<double>(blocks[i].size());
        TaskProgress part(phase, size);
        const Patch patch = make_patch(mesh, twin, std::move(blocks[i]), unit);
        const std::vector<std::uint8_t> own = developable_seams(patch, {}, limits, {});
        for (std::size_t h = 0; h < own.size(); ++h) seam[3 * std::size_t{patch.triangles[h / 3]} + h % 3] = own[h];
        part.finish();
    });
    return seam;
}

}  // namespace tuft::atlas
