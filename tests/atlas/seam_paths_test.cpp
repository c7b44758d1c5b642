#include "atlas/seams/seam_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atlas/charts/charts.h"
#include "atlas/charts/merge.h"
#include "atlas/charts/move_seams.h"
#include "core/system/parallel.h"
#include "shapes.h"
#include "test_mesh.h"

namespace tuft::atlas {
namespace {

/// A square sheet of side 1 in three charts: a strip along the top, and below it two that a
/// slanting seam parts.
struct ThreeCharts {
    mesh::TriangleMesh mesh = test::grid_mesh(40, 40, false, false, [](double u, double v) { return Vec3(u, v, 0); });
    std::vector<std::uint32_t> twin = twin_half_edges(mesh);
    Patch patch;
    std::vector<std::uint8_t> seam;

    ThreeCharts() {
        std::vector<std::uint32_t> all(mesh.n_triangles());
        std::iota(all.begin(), all.end(), 0u);
        patch = make_patch(mesh, twin, all, 1);
        seam.resize(twin.size());
        for (std::uint32_t h = 0; h < seam.size(); ++h)
            seam[h] = twin[h] == kNone || chart(h / 3) != chart(twin[h] / 3);
    }
    int chart(std::uint32_t t) const {
        const Vec3 middle = (mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)) / 3.0;
        if (middle.y > 0.8) return 2;
        return middle.x > 0.3 + 0.5 * middle.y;
    }
    /// The chain between the two lower charts.
    std::vector<std::uint32_t> slanting(const SeamPaths& paths) const {
        for (std::uint32_t h = 0; h < twin.size(); ++h) {
            if (!paths.starts_chain(h)) continue;
            const std::vector<std::uint32_t> chain = paths.chain_from(h);
            const auto y = [&](std::uint32_t g) { return mesh.position(g / 3, g % 3).y; };
            if (y(chain.front()) == 0) return chain;
        }
        return {};
    }
    double length(const std::vector<std::uint32_t>& halves) const {
        double sum = 0;
        for (const std::uint32_t h : halves) sum += patch.length[h];
        return sum;
    }
    void expect_three_disks(const SeamPaths& paths) const {
        std::vector<std::uint32_t> glued = twin;
        for (std::uint32_t h = 0; h < glued.size(); ++h)
            if (paths.seams()[h]) glued[h] = kNone;
        const auto parts = connected_charts(glued);
        EXPECT_EQ(parts.size(), 3u);
        for (const auto& part : parts) {
            EXPECT_TRUE(make_chart(mesh, glued, part, 1).disk);
            for (const std::uint32_t t : part) EXPECT_EQ(paths.charts()[t], paths.charts()[part[0]]);
        }
    }
};

// The shortest path from the strip to the opposite border is straight down: 0.8. With its ends
// where they are it has to go 0.4 aside: sqrt(0.8) at least, and along the edges of a grid with
// one diagonal up to 0.4 + 0.8 (or, along diagonals, 0.4 sqrt 2 + 0.4).
TEST(SeamPaths, CornersMoveToWhereSeamsAreShortest) {
    const ThreeCharts sheet;
    for (const Corners corners : {Corners::stay, Corners::move}) {
        SeamPaths paths(sheet.patch, sheet.seam);
        PathSearch search = paths.make_search();
        for (int round = 0; round < 20; ++round) {
            const SeamMove move = paths.shorten(sheet.slanting(paths), 0.25f, corners, search);
            if (move.path.empty()) break;
            EXPECT_NEAR(move.saved, sheet.length(move.chain) - sheet.length(move.path), 1e-5);
            paths.move(move);
            sheet.expect_three_disks(paths);
        }
        const double length = sheet.length(sheet.slanting(paths));
        if (corners == Corners::move) {
            EXPECT_NEAR(length, 0.8, 1e-5);
        } else {
            EXPECT_GE(length, std::sqrt(0.8));
            EXPECT_LE(length, 1.2 + 1e-5);
        }
    }
}

TEST(SeamPaths, MovesCanBeTakenBack) {
    const ThreeCharts sheet;
    SeamPaths paths(sheet.patch, sheet.seam);
    PathSearch search = paths.make_search();
    const std::vector<std::uint32_t> charts = paths.charts();
    SeamMove move = paths.shorten(sheet.slanting(paths), 0.25f, Corners::move, search);
    ASSERT_FALSE(move.path.empty());
    std::vector<std::uint32_t> swept[2];
    paths.move(move, swept);
    std::size_t changed = 0;
    for (std::size_t t = 0; t < charts.size(); ++t) changed += charts[t] != paths.charts()[t];
    EXPECT_GT(changed, 0u);
    EXPECT_EQ(swept[0].size() + swept[1].size(), changed);
    std::swap(move.chain, move.path);
    paths.move(move);
    EXPECT_EQ(paths.seams(), sheet.seam);
    EXPECT_EQ(paths.charts(), charts);
}

double seam_length(const mesh::TriangleMesh& m, const CutMesh& cut) {
    double sum = 0;
    for (std::uint32_t h = 0; h < cut.twin.size(); ++h)
        if (cut.twin[h] != kNone && cut.glued[h] == kNone)
            sum += 0.5 * glm::distance(m.position(h / 3, h % 3), m.position(h / 3, (h + 1) % 3));
    return sum;
}

double stretch(const CutMesh& cut) {
    double sum = 0, area = 0;
    for (const FlatChart& c : cut.charts) {
        const double l2 = check_flat(c.mesh, c.uv).l2;
        sum += l2 * l2 * c.mesh.area;
        area += c.mesh.area;
    }
    return std::sqrt(sum / area);
}

// Whatever is moved, charts stay disks that cover the mesh and lie flat within the limits.
TEST(MoveSeams, ShortensThemWithinTheLimits) {
    for (const mesh::TriangleMesh& m : {test::sphere(), test::torus()}) {
        ChartOptions options;
        CutMesh first = cut_into_charts(m, options, {});
        merge_charts(m, first, options, {}, {});
        std::vector<std::uint32_t> glued;
        for (const int threads : {1, 4}) {
            CutMesh cut = first;
            set_thread_count(threads);
            EXPECT_TRUE(move_seams(m, cut, options, {}));
            EXPECT_LT(seam_length(m, cut), 0.95 * seam_length(m, first));
            EXPECT_LE(stretch(cut), std::max(options.l2_all, stretch(first)) + 1e-9);
            std::vector<int> covered(m.n_triangles(), 0);
            for (const FlatChart& c : cut.charts) {
                EXPECT_TRUE(make_chart(m, cut.glued, c.mesh.triangles, cut.unit).disk);
                const FlatCheck check = check_flat(c.mesh, c.uv);
                EXPECT_TRUE(check.sound());
                EXPECT_LE(check.l2, options.l2);
                for (const std::uint32_t t : c.mesh.triangles) ++covered[t];
            }
            EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), static_cast<std::ptrdiff_t>(m.n_triangles()));
            if (glued.empty()) glued = cut.glued;
            EXPECT_EQ(glued, cut.glued);
        }
        set_thread_count(0);
    }
}

}  // namespace
}  // namespace tuft::atlas
