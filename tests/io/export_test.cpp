#include "io/export/export.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "io/gltf/read_gltf.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "mesh/read/polygon_soup.h"
#include "sample_model.h"

namespace tuft::io {
namespace {

using namespace testing;

/// The JSON chunk of a GLB file.
nlohmann::json glb_json(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path);
    std::uint32_t size = 0;
    std::memcpy(&size, &bytes[12], 4);
    return nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + size);
}

TEST(Export, GlbReadBackIsTheSameMesh) {
    const Folder folder("glb");
    const mesh::TriangleMesh mesh = cylinder();
    export_model(folder / "m.glb", mesh, cylinder_atlas(mesh), pattern_maps(64));
    const mesh::PolygonSoup soup = read_gltf(read_file(folder / "m.glb"), folder / "m.glb");
    // 1 − (1 − v) in float loses at most half a unit in the last place of 1.
    expect_same(soup, mesh, 1, 6e-8);
    // The seam repeats one column of vertices, the border of the two groups, which are nodes of their own, one
    // row; everything else is shared.
    EXPECT_EQ(soup.points.size(), mesh.n_vertices() + kUp + 1 + kAround + 1);
}

TEST(Export, GlbHoldsThePicturesRightWayUp) {
    const Folder folder("glb_maps");
    const mesh::TriangleMesh mesh = cylinder();
    const ModelMaps maps = pattern_maps(64);
    export_model(folder / "m.glb", mesh, cylinder_atlas(mesh), maps);
    const nlohmann::json json = glb_json(folder / "m.glb");
    ASSERT_EQ(json["images"].size(), 3u);
    EXPECT_EQ(json["asset"]["version"], "2.0");
    const auto& primitive = json["meshes"][0]["primitives"][0];
    for (const char* attribute : {"POSITION", "NORMAL", "TEXCOORD_0", "TANGENT"})
        EXPECT_TRUE(primitive["attributes"].contains(attribute)) << attribute;
    const auto& view = json["bufferViews"][json["images"][0]["bufferView"].get<int>()];
    const std::vector<char> bytes = read_file(folder / "m.glb");
    std::uint32_t json_size = 0;
    std::memcpy(&json_size, &bytes[12], 4);
    const std::size_t at = 20 + json_size + 8 + view.value("byteOffset", 0u);
    write_file(folder / "base.png", &bytes[at], view["byteLength"].get<std::size_t>());
    const Image8 base = read_image8(folder / "base.png");
    ASSERT_EQ(base.pixels.size(), maps.base_colour.texels.size());
    for (int y = 0; y < 64; ++y)
        for (int i = 0; i < 64 * 3; ++i)
            ASSERT_EQ(base.pixels[(63 - y) * 64 * 3 + i], maps.base_colour.texels[y * 64 * 3 + i]);
}

TEST(Export, PigmentAmountsComeBackByNameFromAnExrFile) {
    const Folder folder("pigments");
    const mesh::TriangleMesh mesh = cylinder();
    const atlas::TexelMap map = atlas::build_texel_map(mesh, cylinder_atlas(mesh));
    ink::Canvas canvas(map.n_slots());
    for (const char* name : {"carbon black", "R", "a.b"}) {
        ink::Pigment p;
        p.name = name;
        canvas.add_pigment(p);
    }
    for (std::uint32_t slot = 0; slot < map.n_slots(); slot += 2)
        for (int p = 0; p < 3; ++p)
            for (int t = 0; t < atlas::kTileTexels; ++t)
                for (const int film : {ink::kOpenFilm, ink::kFirstDryFilm})
                    canvas.touch_film(slot, film, p)[t] = static_cast<float>(uniform(10 * film + p, 256 * slot + t));
    const ink::AtlasMap<float> amounts = ink::compose_amounts(canvas, map, {.gutter = 0});
    ImageOptions options;
    options.srgb = false;
    for (const ink::Pigment& p : canvas.pigments()) options.channel_names.push_back(channel_name(p.name));
    write_image(folder / "pigments.exr", view_of(amounts), options);
    const ImageF read = read_image_float(folder / "pigments.exr");
    ASSERT_EQ(read.channels, 3);
    const auto channel = [&](const std::string& name) {
        return std::find(read.channel_names.begin(), read.channel_names.end(), name) - read.channel_names.begin();
    };
    const std::array<std::ptrdiff_t, 3> at{channel("carbon black"), channel("R-"), channel("a-b")};
    for (const auto c : at) ASSERT_LT(c, 3) << "each pigment has its channel";
    int seen = 0;
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            if (map.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            const std::uint32_t tile = map.tile_of_slot[slot];
            const std::uint32_t x = tile % map.tiles_per_side * 16 + t % 16,
                                y = tile / map.tiles_per_side * 16 + t / 16;
            if (x >= map.size || y >= map.size) continue;
            for (int p = 0; p < 3; ++p) {
                float sum = 0;
                for (const int film : {ink::kOpenFilm, ink::kFirstDryFilm})
                    if (const ink::Plane* w = canvas.film_plane(slot, film, p)) sum += (*w)[t];
                ASSERT_EQ(read.pixels[((map.size - 1 - y) * map.size + x) * 3 + static_cast<std::size_t>(at[p])], sum);
                seen += sum > 0;
            }
        }
    EXPECT_GT(seen, 1000);
}

TEST(Export, HeightAndNormalsKeepSixteenBits) {
    const ModelMaps maps = pattern_maps(64);
    const ink::AtlasMap<std::uint16_t> height = height16(maps.height);
    for (std::size_t i = 0; i < height.texels.size(); ++i)
        EXPECT_NEAR(height.texels[i] * 0.01, maps.height.texels[i], 0.0051) << "steps of 0.01 um";
    EXPECT_EQ(height16({.size = 1, .channels = 1, .texels = {1e6f}}).texels[0], 65535) << "cut, not wrapped";
    const ink::AtlasMap<float> vectors = normal_map_float(maps.height, 1e-5);
    const ink::AtlasMap<std::uint16_t> fine = normal_map16(maps.height, 1e-5);
    const ink::AtlasMap<std::uint8_t> coarse = normal_map(maps.height, 1e-5);
    for (std::size_t i = 0; i < vectors.texels.size(); ++i) {
        EXPECT_NEAR(fine.texels[i] / 65535.0 * 2 - 1, vectors.texels[i], 1.01 / 65535);
        EXPECT_NEAR(coarse.texels[i] / 255.0 * 2 - 1, vectors.texels[i], 1.01 / 255);
    }
    for (std::size_t i = 0; i < vectors.texels.size(); i += 3)
        EXPECT_NEAR(std::hypot(vectors.texels[i], vectors.texels[i + 1], vectors.texels[i + 2]), 1, 1e-6);
}

TEST(Export, WithoutHeightThereIsNoNormalMap) {
    const Folder folder("flat");
    const mesh::TriangleMesh mesh = cylinder();
    export_model(folder / "m.glb", mesh, cylinder_atlas(mesh), pattern_maps(64, true));
    const nlohmann::json json = glb_json(folder / "m.glb");
    EXPECT_EQ(json["images"].size(), 2u);
    EXPECT_FALSE(json["meshes"][0]["primitives"][0]["attributes"].contains("TANGENT"));
    EXPECT_FALSE(json["materials"][0].contains("normalTexture"));
}

TEST(Export, GltfWithFilesReadBackIsTheSameMesh) {
    const Folder folder("gltf");
    const mesh::TriangleMesh mesh = cylinder();
    const ModelMaps maps = pattern_maps(64);
    export_model(folder / "blue bowl.gltf", mesh, cylinder_atlas(mesh), maps);
    expect_same(read_gltf(read_file(folder / "blue bowl.gltf"), folder / "blue bowl.gltf"), mesh, 1, 6e-8);
    const auto files = exported_files(folder / "blue bowl.gltf", maps);
    EXPECT_EQ(files.size(), 5u);
    EXPECT_EQ(folder.n_files(), files.size());
    for (const auto& file : files) EXPECT_TRUE(std::filesystem::exists(file)) << file;
    EXPECT_EQ(read_image8(folder / "blue_bowl_base_colour.png").width, 64);
}

/// The cylinder's lower half on page 1001, the upper one on 1002, each 64 texels wide.
atlas::Atlas two_pages(const mesh::TriangleMesh& mesh) {
    atlas::Atlas a = cylinder_atlas(mesh, 128);
    a.pages = 2;
    a.n_charts = 2;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        a.triangle_chart[t] = mesh.triangle_groups[t];
        for (std::size_t c = 3 * t; c < 3 * t + 3; ++c)
            a.corner_uvs[c] = 0.5f * (mesh.corner_uvs[c] + Vec2f(float(mesh.triangle_groups[t]), 0));
    }
    return a;
}

TEST(Export, PagesOfAnObjFollowTheUdimConvention) {
    const Folder folder("udim");
    const mesh::TriangleMesh mesh = cylinder();
    const atlas::Atlas atlas = two_pages(mesh);
    const ModelMaps maps = pattern_maps(128);
    export_model(folder / "m.obj", mesh, atlas, maps);
    for (const auto& file : exported_files(folder / "m.obj", maps, {}, atlas))
        EXPECT_TRUE(std::filesystem::exists(file)) << file;
    EXPECT_EQ(folder.n_files(), 2u + 3 * 2);
    const std::vector<char> mtl = read_file(folder / "m.mtl");
    EXPECT_NE(std::string(mtl.begin(), mtl.end()).find("map_Kd m_base_colour.<UDIM>.png"), std::string::npos);
    const mesh::PolygonSoup soup = mesh::read_obj(read_file(folder / "m.obj"), "m.obj");
    for (std::size_t c = 0; c < 3 * mesh.n_triangles(); ++c) {
        const Vec2f expected = mesh.corner_uvs[c] + Vec2f(float(mesh.triangle_groups[c / 3]), 0);
        // UVs went through halves and back: two roundings of floats below 2.
        EXPECT_NEAR(soup.corner_uvs[c].x, expected.x, 3e-7);
        EXPECT_NEAR(soup.corner_uvs[c].y, expected.y, 3e-7);
    }
    for (const int column : {0, 1}) {
        const Image8 page = read_image8(folder / ("m_base_colour.100" + std::to_string(column + 1) + ".png"));
        ASSERT_EQ(page.width, 64);
        ASSERT_EQ(page.height, 64);
        for (int y = 0; y < 64; ++y)
            for (int i = 0; i < 64 * 3; ++i)
                ASSERT_EQ(page.pixels[(63 - y) * 64 * 3 + i], maps.base_colour.texels[(y * 128 + 64 * column) * 3 + i]);
    }
    // And back: each page is a tile of the material.
    const mesh::PolygonSoup again = read_model(folder / "m.obj");
    ASSERT_EQ(again.materials.size(), 2u);
    for (std::size_t group = 0; group < 2; ++group) {
        ASSERT_EQ(again.materials[group].tiles.size(), 1u);
        const mesh::PictureTile& tile = again.materials[group].tiles[0];
        EXPECT_EQ(tile.udim, 1001 + group);
        EXPECT_EQ(tile.picture->rgb, read_image8(folder / tile.picture->name).pixels);
    }
    for (const Message& warning : again.warnings)  // its maps of normals and roughness
        EXPECT_NE(warning.text().find("only those of colours"), std::string::npos) << warning.text();
}

TEST(Export, PagesOfAGltfArePrimitivesWithTheirOwnMaterials) {
    const Folder folder("gltf_pages");
    const mesh::TriangleMesh mesh = cylinder();
    export_model(folder / "m.glb", mesh, two_pages(mesh), pattern_maps(128));
    const nlohmann::json json = glb_json(folder / "m.glb");
    ASSERT_EQ(json["meshes"].size(), 2u) << "the two groups, each on a page";
    ASSERT_EQ(json["materials"].size(), 2u);
    EXPECT_EQ(json["images"].size(), 6u);
    for (int page = 0; page < 2; ++page) {
        const auto& primitives = json["meshes"][page]["primitives"];
        ASSERT_EQ(primitives.size(), 1u);
        EXPECT_EQ(primitives[0]["material"], page);
        const auto& indices = json["accessors"][primitives[0]["indices"].get<int>()];
        EXPECT_EQ(indices["count"], 3 * mesh.n_triangles() / 2);
        const auto& colour = json["materials"][page]["pbrMetallicRoughness"]["baseColorTexture"];
        const auto& texture = json["textures"][colour["index"].get<int>()];
        EXPECT_EQ(json["images"][texture["source"].get<int>()]["name"], "base_colour");
        EXPECT_EQ(texture["source"], 3 * page);  // colour, orm and normal of each
    }
    // Each triangle's UVs are those of its own page, in its column when they are read.
    mesh::TriangleMesh beside = mesh;
    const atlas::Atlas atlas = two_pages(mesh);
    for (std::size_t c = 0; c < beside.corner_uvs.size(); ++c)
        beside.corner_uvs[c].x += static_cast<float>(atlas.page_of(c / 3));
    expect_same(read_gltf(read_file(folder / "m.glb"), folder / "m.glb"), beside, 1, 3e-7);
}

TEST(Export, FailuresLeaveNothingBehind) {
    const Folder folder("fail");
    const mesh::TriangleMesh mesh = cylinder();
    const atlas::Atlas atlas = cylinder_atlas(mesh);
    const ModelMaps maps = pattern_maps(16);
    EXPECT_THROW(export_model(folder / "m.fbx", mesh, atlas, maps), Error);
    EXPECT_THROW(export_model(folder / "m.obj", mesh, atlas, maps, {.frame = {.unit = "furlong"}}), Error);
    EXPECT_THROW(export_model(folder / "none/m.glb", mesh, atlas, maps), Error);
    EXPECT_THROW(write_together(folder / "m.glb",
                                [](const std::filesystem::path& staging) {
                                    std::ofstream(staging / "half") << "half";
                                    throw Error("disk full");
                                }),
                 Error);
    EXPECT_EQ(folder.n_files(), 0u);
}

TEST(Export, NormalsFollowTheSlopeOfTheHeight) {
    // A ramp of 0.1 µm per texel of 1 µm in u and −0.2 in v.
    ink::AtlasMap<float> height{.size = 16, .channels = 1, .texels = {}};
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) height.texels.push_back(0.1f * x - 0.2f * y);
    const auto normals = normal_map(height, 1e-6);
    const Vec3 expected = glm::normalize(Vec3(-0.1, 0.2, 1));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(normals.texels[(8 * 16 + 8) * 3 + k] / 127.5 - 1, expected[k], 0.5 / 127);
}

}  // namespace
}  // namespace tuft::io
