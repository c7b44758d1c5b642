#include "stroke/surface/model_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include "paths.h"
#include "stroke/surface/model.h"

namespace tuft::stroke {
namespace {

namespace fs = std::filesystem;

class ModelCache : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft-models-" + std::to_string(::getpid()) + "-" +
                                                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    // A dented ball in two groups with one degenerate face, one duplicate and an empty part: it has defects to report.
    static mesh::PolygonSoup ball() {
        mesh::PolygonSoup soup;
        constexpr int rows = 24, columns = 40;
        for (int i = 0; i <= rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const double a = M_PI * (i + 0.01) / (rows + 0.02), b = 2 * M_PI * j / columns;
                const double r = 40 + 2 * std::sin(3 * b) * std::sin(a);
                soup.points.emplace_back(r * std::sin(a) * std::cos(b), r * std::sin(a) * std::sin(b), r * std::cos(a));
            }
        const auto add = [&](std::initializer_list<int> face, std::uint32_t group) {
            soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            for (const int v : face) soup.corners.push_back(static_cast<std::uint32_t>(v));
            soup.polygon_groups.push_back(group);
        };
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const int a = i * columns + j, b = i * columns + (j + 1) % columns;
                add({a, a + columns, b + columns, b}, i < rows / 2 ? 0 : 1);
            }
        add({3, 3, 4}, 2);
        add({100, 140, 141, 101}, 0);
        soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        soup.group_names = {"upper", "lower", "nothing"};
        soup.warnings = {Message("line {} is odd", 3)};
        return soup;
    }

    Model prepare(std::set<std::string>* phases = nullptr) const {
        ModelOptions options;
        options.unwrap.size = 256;
        options.cache = DiskCache(folder_);
        if (phases)
            options.progress = [phases](std::string_view phase, double) { return phases->emplace(phase), true; };
        return prepare_model(ball(), options);
    }

    static std::vector<std::string> warnings_of(const Model& model) { return texts(model.repairs.warnings); }

    static void expect_same_bits(const Model& a, const Model& b) {
        const auto same = [](const auto& x, const auto& y) {
            return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
        };
        EXPECT_TRUE(same(a.mesh->positions, b.mesh->positions));
        EXPECT_TRUE(same(a.mesh->triangles, b.mesh->triangles));
        EXPECT_TRUE(same(a.mesh->corner_normals, b.mesh->corner_normals));
        EXPECT_TRUE(same(a.mesh->neighbours, b.mesh->neighbours));
        EXPECT_TRUE(same(a.mesh->triangle_groups, b.mesh->triangle_groups));
        EXPECT_EQ(a.mesh->group_names, b.mesh->group_names);
        EXPECT_EQ(a.mesh->bounds.lo, b.mesh->bounds.lo);
        EXPECT_EQ(a.mesh->bounds.hi, b.mesh->bounds.hi);
        EXPECT_TRUE(same(a.atlas.corner_uvs, b.atlas.corner_uvs));
        EXPECT_TRUE(same(a.atlas.triangle_chart, b.atlas.triangle_chart));
        EXPECT_EQ(a.atlas.texel_size, b.atlas.texel_size);
        EXPECT_EQ(a.atlas.n_charts, b.atlas.n_charts);
        EXPECT_TRUE(same(a.texels.tile_of_slot, b.texels.tile_of_slot));
        EXPECT_EQ(a.clusters.n_clusters(), b.clusters.n_clusters());
        EXPECT_EQ(warnings_of(a), warnings_of(b));
        EXPECT_EQ(a.repairs.degenerate_faces_dropped, b.repairs.degenerate_faces_dropped);
        EXPECT_EQ(a.repairs.duplicate_faces_dropped, b.repairs.duplicate_faces_dropped);
        EXPECT_EQ(a.repairs.components, b.repairs.components);
        EXPECT_EQ(a.repairs.closed, b.repairs.closed);
        EXPECT_EQ(a.atlas_report.charts, b.atlas_report.charts);
        EXPECT_EQ(a.atlas_report.utilisation, b.atlas_report.utilisation);
        EXPECT_EQ(a.atlas_report.smallest_gap, b.atlas_report.smallest_gap);
    }

    fs::path entry() const { return fs::directory_iterator(folder_)->path(); }

    fs::path folder_;
};

TEST_F(ModelCache, AStoredModelHasTheSameBitsAndIsNotUnwrappedAgain) {
    std::set<std::string> first, second;
    const Model made = prepare(&first), read = prepare(&second);
    EXPECT_TRUE(first.contains("charts"));
    EXPECT_FALSE(second.contains("charts"));
    EXPECT_FALSE(second.contains("welding"));
    EXPECT_GE(made.repairs.degenerate_faces_dropped, 1u);
    EXPECT_GE(warnings_of(made).size(), 2u);  // the reader's, and that of the part without a face
    expect_same_bits(made, read);
}

TEST_F(ModelCache, APackedTexelMapIsStoredAndIsTheSameToTheBit) {
    const auto same = [](const auto& x, const auto& y) {
        return x.size() == y.size() && !x.empty() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
    };
    mesh::TriangleMesh mesh;
    atlas::Atlas atlas;
    {
        const Model model = prepare();
        mesh = *model.mesh, atlas = model.atlas;
    }
    fs::remove_all(folder_);
    const auto texels = [&](std::set<std::string>& phases) {
        ModelOptions options{.texels = atlas::TexelStore::packed, .cache = DiskCache(folder_)};
        options.progress = [&](std::string_view phase, double) { return phases.emplace(phase), true; };
        return prepare_model(mesh, atlas, options);
    };
    std::set<std::string> first, second, third;
    const Model made = texels(first), read = texels(second);
    EXPECT_TRUE(first.contains("cluster graph"));
    EXPECT_FALSE(second.contains("cluster graph"));
    for (const auto& [a, b] : {std::pair(&made.texels, &read.texels)}) {
        EXPECT_TRUE(same(a->tiles, b->tiles));
        EXPECT_TRUE(same(a->packed, b->packed));
        EXPECT_TRUE(same(a->boxes, b->boxes));
        EXPECT_TRUE(same(a->slot_of_tile, b->slot_of_tile));
        EXPECT_TRUE(same(a->tile_of_slot, b->tile_of_slot));
        EXPECT_TRUE(same(a->reach, b->reach));
        EXPECT_TRUE(same(a->cluster_start, b->cluster_start));
        EXPECT_TRUE(same(a->cluster_chart, b->cluster_chart));
        EXPECT_EQ(a->texel_size, b->texel_size);
        EXPECT_EQ(a->size, b->size);
        EXPECT_EQ(a->tiles_per_side, b->tiles_per_side);
    }
    EXPECT_TRUE(same(made.clusters.clusters, read.clusters.clusters));
    EXPECT_TRUE(same(made.clusters.cluster_start, read.clusters.cluster_start));
    EXPECT_TRUE(same(made.clusters.edge_start, read.clusters.edge_start));
    EXPECT_TRUE(same(made.clusters.edges, read.clusters.edges));
    mesh.corner_normals[7].x += 1e-3f;
    texels(third);
    EXPECT_TRUE(third.contains("cluster graph"));
}

TEST_F(ModelCache, ATexelMapThatPointsOutsideItsArraysIsMadeAgain) {
    const Model made = prepare();
    const ModelOptions options{.texels = atlas::TexelStore::packed, .cache = DiskCache(folder_)};
    const auto with = [&](const auto& change) {
        Model bad = prepare_model(*made.mesh, made.atlas, ModelOptions{.texels = atlas::TexelStore::packed});
        change(bad);
        const CacheKey key = texels_key(*made.mesh, made.atlas);
        ASSERT_TRUE(options.cache.write(key, [&](CacheWriter& entry) { put_texels(entry, bad); }));
        EXPECT_FALSE(options.cache.read(key, [&](CacheReader& entry) { get_texels(entry, made.atlas); }));
    };
    with([](Model& m) { m.texels.slot_of_tile[0] = 1'000'000; });
    with([](Model& m) { m.texels.tile_of_slot[0] = 1'000'000; });
    with([](Model& m) { m.texels.boxes.pop_back(); });
    with([](Model& m) { m.texels.packed = {}; });
    with([](Model& m) { m.texels.cluster_start[1] = 1'000'000; });
    with([](Model& m) { m.clusters.edge_start.back() += 1; });
    with([](Model& m) { m.clusters.edges[3].to = 1'000'000; });
    with([](Model& m) { m.clusters.clusters[3].slot = 1'000'000; });
    with([](Model& m) { m.clusters.clusters[3].index += 1; });
    with([](Model& m) { m.clusters.clusters[3].last_row = 16; });
    with([](Model& m) { m.clusters.clusters[3].centre.y = NAN; });
    with([](Model& m) { m.texels.size = 8192; });
    with([](Model& m) { m.texels.cluster_chart[3] = m.atlas.n_charts; });
    with([](Model& m) { m.texels.boxes[3].step = INFINITY; });
    with([](Model& m) {
        const auto tiles =
            std::make_shared<std::vector<atlas::TexelTile>>(m.texels.tiles.begin(), m.texels.tiles.end());
        tiles->back().cluster[7] = 200;
        m.texels.tiles = {tiles, std::span<const atlas::TexelTile>(*tiles)};
    });
}

TEST_F(ModelCache, EveryOptionAndEveryPointChangesTheKey) {
    std::set<std::pair<std::uint64_t, std::uint64_t>> keys;
    std::size_t n = 0;
    const auto add = [&](const mesh::PolygonSoup& soup, const ModelOptions& options) {
        const CacheKey key = model_key(soup, options);
        keys.insert({key.high(), key.low()});
        EXPECT_EQ(keys.size(), ++n);
    };
    const mesh::PolygonSoup soup = ball();
    add(soup, {});
    const auto with = [&](const auto& change) {
        ModelOptions options;
        change(options);
        add(soup, options);
    };
    with([](auto& o) { o.repair.metres_per_unit = 1; });
    with([](auto& o) { o.repair.y_up = true; });
    with([](auto& o) { o.repair.crease_angle = 0.5; });
    with([](auto& o) { o.repair.sides = mesh::OpenSides::file; });
    with([](auto& o) { o.unwrap.size = 512; });
    with([](auto& o) { o.unwrap.texel_size = 1e-3; });
    with([](auto& o) { o.unwrap.pages = 4; });
    with([](auto& o) { o.unwrap.gutter = 8; });
    with([](auto& o) { o.unwrap.uvs = atlas::UvPolicy::renew; });
    with([](auto& o) { o.unwrap.seams.groups = true; });
    with([](auto& o) { o.unwrap.seams.sharp_angle = 0.7; });
    with([](auto& o) { o.unwrap.max_size = 8192; });
    with([](auto& o) { o.unwrap.cutting = atlas::Cutting::tight; });
    mesh::PolygonSoup other = ball();
    other.points[17].x += 1e-12;
    add(other, {});
    other = ball();
    other.polygon_groups[5] = 1;
    add(other, {});
    other = ball();
    other.group_names[1] = "other";
    add(other, {});
}

// Sizes, indices and numbers inside an entry with right hashes are checked too.
TEST_F(ModelCache, AnEntryThatPointsOutsideItsArraysIsMadeAgain) {
    const Model made = prepare();
    const auto with = [&](const auto& change) {
        Model bad;
        bad.mesh = std::make_unique<mesh::TriangleMesh>(*made.mesh);
        bad.repairs = made.repairs;
        bad.atlas = made.atlas;
        bad.atlas_report = made.atlas_report;
        change(bad);
        ModelOptions options;
        options.unwrap.size = 256;
        const DiskCache cache(folder_);
        ASSERT_TRUE(cache.write(model_key(ball(), options), [&](CacheWriter& entry) { put_model(entry, bad, 1); }));
        std::set<std::string> phases;
        const Model again = prepare(&phases);
        EXPECT_TRUE(phases.contains("charts"));
        expect_same_bits(made, again);
    };
    with([](Model& m) { m.mesh->triangles[3][1] = 1'000'000; });
    with([](Model& m) { m.mesh->neighbours[3] = 1'000'000; });
    with([](Model& m) { m.mesh->neighbours.pop_back(); });
    with([](Model& m) { m.mesh->positions[3].x = NAN; });
    with([](Model& m) { m.mesh->triangle_groups[3] = 3; });
    with([](Model& m) { m.atlas.triangle_chart[3] = m.atlas.n_charts; });
    with([](Model& m) { m.atlas.corner_uvs[3].x = INFINITY; });
    with([](Model& m) { m.atlas.size = 0; });
    with([](Model& m) { m.atlas.texel_size = 0; });
    with([](Model& m) { m.atlas.pages = 0; });
}

TEST_F(ModelCache, ADamagedEntryIsMadeAgain) {
    const Model made = prepare();
    fs::resize_file(entry(), fs::file_size(entry()) / 2);
    std::set<std::string> phases;
    expect_same_bits(made, prepare(&phases));
    EXPECT_TRUE(phases.contains("charts"));
    phases.clear();
    expect_same_bits(made, prepare(&phases));
    EXPECT_FALSE(phases.contains("charts"));
}

}  // namespace
}  // namespace tuft::stroke
