#include "atlas/charts/developable.h"

#include <gtest/gtest.h>

#include "atlas/charts/charts.h"
#include "core/system/parallel.h"
#include "shapes.h"

namespace tuft::atlas {
namespace {

/// Corners less edges plus faces: 1 for a disk.
int euler(const Patch& patch) {
    int edges = 0;
    for (std::uint32_t h = 0; h < patch.twin.size(); ++h) edges += patch.twin[h] == kNone || patch.twin[h] > h;
    return static_cast<int>(patch.n_vertices) - edges + static_cast<int>(patch.triangles.size());
}

TEST(SmallCharts, AreDisksOfFewTrianglesAndTheSameForAnyNumberOfThreads) {
    const mesh::TriangleMesh mesh = test::torus(720, 360);
    ASSERT_GE(mesh.n_triangles(), kBlockwiseThreshold);
    const std::vector<std::uint32_t> twin = twin_half_edges(mesh);
    GluingLimits limits;
    std::vector<std::uint8_t> first;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        const std::vector<std::uint8_t> seam = small_chart_seams(mesh, twin, 0.1, limits, {});
        if (first.empty()) first = seam;
        EXPECT_EQ(seam, first);
    }
    set_thread_count(0);
    std::vector<std::uint32_t> glued = twin;
    for (std::uint32_t h = 0; h < glued.size(); ++h) {
        EXPECT_EQ(first[h], first[twin[h]]);
        if (first[h]) glued[h] = kNone;
    }
    const auto charts = connected_charts(glued);
    std::size_t largest = 0, no_disks = 0;
    for (const auto& chart : charts) {
        largest = std::max(largest, chart.size());
        no_disks += euler(make_patch(mesh, glued, chart, 0.1)) != 1;
    }
    EXPECT_LE(largest, 96);
    EXPECT_EQ(no_disks, 0);
    EXPECT_LT(charts.size(), mesh.n_triangles() / 24);  // what is glued later is a small part
}

TEST(SmallCharts, OfAMeshThatIsGluedQuicklyAreItsTriangles) {
    const mesh::TriangleMesh mesh = test::torus();
    EXPECT_TRUE(small_chart_seams(mesh, twin_half_edges(mesh), 0.1, {}, {}).empty());
}

}  // namespace
}  // namespace tuft::atlas
