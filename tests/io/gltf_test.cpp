#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/files/files.h"
#include "core/random.h"
#include "io/export/export.h"
#include "io/gltf/read_gltf.h"
#include "io/image/image.h"
#include "io/scene/json_number.h"
#include "sample_model.h"

namespace tuft::io {
namespace {

using namespace testing;
using nlohmann::json;

std::string base64(const std::vector<char>& bytes) {
    static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t v = 0;
        for (std::size_t k = 0; k < 3; ++k)
            v = v << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (int k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[v >> (18 - 6 * k) & 63];
    }
    return out;
}

/// A right triangle with indices 0 1 2 (u16), UVs, in a data URI.
json triangle() {
    const std::vector<float> numbers{0, 0, 0, 1, 0, 0, 0, 1, 0, /* uv */ 0, 0, 1, 0, 0, 0.25f};
    std::vector<char> bytes(numbers.size() * 4 + 8);
    std::memcpy(bytes.data(), numbers.data(), numbers.size() * 4);
    const std::uint16_t indices[3] = {0, 1, 2};
    std::memcpy(&bytes[60], indices, 6);
    return json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
      "nodes":[{"mesh":0}],
      "meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
                   {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
                   {"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
                     {"buffer":0,"byteOffset":60,"byteLength":6}],
      "buffers":[{"byteLength":68,"uri":"data:application/octet-stream;base64,)" +
                       base64(bytes) + R"("}]})");
}

mesh::PolygonSoup read(const json& j, const std::filesystem::path& path = "x.gltf") {
    const std::string text = j.dump();
    return read_gltf({text.begin(), text.end()}, path);
}

std::string fault(const json& j) {
    try {
        read(j);
    } catch (const Error& e) {
        return e.what();
    }
    return "read without complaint";
}

TEST(Gltf, TurnsYUpIntoZUpAndVDownIntoVUp) {
    const mesh::PolygonSoup soup = read(triangle());
    ASSERT_EQ(soup.n_polygons(), 1u);
    EXPECT_EQ(soup.points[1], Vec3(1, 0, 0));
    EXPECT_EQ(soup.points[2], Vec3(0, 0, 1)) << "glTF's up is ours";
    EXPECT_EQ(soup.corner_uvs[2], Vec2f(0, 0.75f));
    EXPECT_EQ(soup.group_names, std::vector<std::string>{"tri"});
}

TEST(Gltf, NodeTransformsAreComposed) {
    json j = triangle();
    j["nodes"] = json::parse(R"([{"children":[1],"translation":[0,0,5]},
        {"children":[2],"rotation":[0,0,0.70710678118654757,0.70710678118654757]},
        {"mesh":0,"scale":[2,3,-1]}])");
    const mesh::PolygonSoup soup = read(j);
    // (1,0,0) → scaled (2,0,0) → turned a quarter about z (0,2,0) → moved (0,2,5) → z up (0,−5,2).
    const auto near = [](const Vec3& a, const Vec3& b) {
        EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << " " << a.y << " " << a.z;
    };
    near(soup.points[1], {0, -5, 2});
    near(soup.points[2], {-3, -5, 0});
    EXPECT_EQ(soup.corners, (std::vector<std::uint32_t>{0, 2, 1})) << "a mirrored mesh is turned round";
    j["nodes"][0] = json::parse(R"({"children":[1],"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1]})");
    near(read(j).points[1], {0, -5, 2});
}

TEST(Gltf, StripsAndFansBecomeTriangles) {
    json j = triangle();
    auto& primitive = j["meshes"][0]["primitives"][0];
    primitive["mode"] = 5;
    EXPECT_EQ(read(j).corners, (std::vector<std::uint32_t>{0, 1, 2}));
    primitive["mode"] = 6;
    EXPECT_EQ(read(j).n_polygons(), 1u);
    primitive.erase("indices");
    primitive["mode"] = 4;
    EXPECT_EQ(read(j).corners, (std::vector<std::uint32_t>{0, 1, 2}));
    primitive["mode"] = 1;
    EXPECT_NE(fault(j).find("no triangles"), std::string::npos);
}

const Image8 kRedOverGreen{.width = 1, .height = 2, .channels = 3, .pixels = {255, 0, 0, 0, 255, 0}};

/// The triangle and a picture in texture 0.
json pictured_triangle() {
    const std::vector<unsigned char> png = png_bytes(view_of(kRedOverGreen));
    json j = triangle();
    j["images"] = {{{"uri", "data:image/png;base64," + base64({png.begin(), png.end()})}}};
    j["textures"] = {{{"source", 0}}};
    return j;
}

TEST(Gltf, BaseColourIsFactorTimesPictureTimesVertexColours) {
    json j = pictured_triangle();
    j["materials"] = {
        {{"name", "m"},
         {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.25, 1}}, {"baseColorTexture", {{"index", 0}}}}}}};
    j["meshes"][0]["primitives"][0]["material"] = 0;
    j["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 0;  // the positions serve
    const mesh::PolygonSoup soup = read(j);
    ASSERT_EQ(soup.materials.size(), 1u);
    EXPECT_EQ(soup.group_names, std::vector<std::string>{"tri"});
    ASSERT_TRUE(soup.materials[0].picture);
    EXPECT_EQ(soup.materials[0].picture->rgb, kRedOverGreen.pixels);
    EXPECT_TRUE(soup.materials[0].tinted);
    EXPECT_NEAR(soup.materials[0].colour.g, 0.7354, 1e-3) << "sRGB of the linear factor 0.5";
    ASSERT_EQ(soup.point_colours.size(), 3u);
    EXPECT_EQ(soup.point_colours[1], (std::array<std::uint8_t, 4>{255, 0, 0, 255}));
    EXPECT_EQ(soup.point_colours[2], (std::array<std::uint8_t, 4>{0, 255, 0, 255}));
}

// Set 1, scaled, turned a quarter counter-clockwise as seen (to the right becomes up) and moved; v points
// down in the file, up in the soup.
TEST(Gltf, APictureLiesByItsSetOfUvsMovedAsTheFileSays) {
    json j = pictured_triangle();
    j["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}};
    json& texture = j["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    json& primitive = j["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    const mesh::PolygonSoup fallen_back = read(j);
    EXPECT_EQ(fallen_back.warnings.size(), 1u) << "there is no set 1";
    EXPECT_TRUE(fallen_back.materials[0].picture);
    EXPECT_EQ(fallen_back.corner_uvs, (std::vector<Vec2f>{{0, 1}, {1, 1}, {0, 0.75f}}));
    j["accessors"].push_back({{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
    primitive["attributes"]["TEXCOORD_0"] = 3;
    primitive["attributes"]["TEXCOORD_1"] = 1;
    const mesh::PolygonSoup second = read(j);
    EXPECT_TRUE(second.warnings.empty());
    EXPECT_EQ(second.corner_uvs, fallen_back.corner_uvs);
    texture["texCoord"] = 0;
    texture["extensions"]["KHR_texture_transform"] = {
        {"texCoord", 1}, {"scale", {2, 4}}, {"rotation", std::acos(-1) / 2}, {"offset", {0.5, 0.25}}};
    const mesh::PolygonSoup moved = read(j);
    const std::vector<Vec2f> expected{{0.5f, 0.75f}, {0.5f, 2.75f}, {1.5f, 0.75f}};
    ASSERT_EQ(moved.corner_uvs.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LT(glm::length(moved.corner_uvs[i] - expected[i]), 1e-6f) << i << ", by rounding";
    texture["extensions"]["KHR_texture_transform"] = {
        {"scale", {"a", 4}}, {"rotation", {}}, {"offset", 7}, {"texCoord", -5}};
    EXPECT_EQ(read(j).corner_uvs.size(), 3u);
}

// As in every GLB; tinygltf hands over what a buffer view says, wherever that lies.
TEST(Gltf, PicturesInBuffersLieWithinThem) {
    const Image8 image{.width = 1, .height = 2, .channels = 3, .pixels = {255, 0, 0, 0, 255, 0}};
    const std::vector<unsigned char> png = png_bytes(view_of(image));
    json j = triangle();
    j["buffers"].push_back({{"byteLength", png.size()},
                            {"uri", "data:application/octet-stream;base64," + base64({png.begin(), png.end()})}});
    j["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", png.size()}});
    j["images"] = {{{"bufferView", 3}, {"mimeType", "image/png"}}};
    j["textures"] = {{{"source", 0}}};
    j["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    j["meshes"][0]["primitives"][0]["material"] = 0;
    const mesh::PolygonSoup soup = read(j);
    ASSERT_TRUE(soup.materials[0].picture);
    EXPECT_EQ(soup.materials[0].picture->rgb, image.pixels);
    const auto left_out = [&](const char* place, std::size_t value) {
        json k = j;
        k["bufferViews"][3][place] = value;
        const mesh::PolygonSoup without = read(k);
        EXPECT_FALSE(without.materials[0].picture) << place << value;
        EXPECT_EQ(without.warnings.size(), 1u);
    };
    left_out("byteLength", png.size() + 1);
    left_out("byteLength", 100'000'000);
    left_out("byteOffset", 1);
    left_out("byteOffset", png.size() + 4096);
}

TEST(Gltf, MaterialsOfOneNameAreGroupsOfTheirOwn) {
    json j = triangle();
    j["materials"] = json::parse(R"([{"name":"m","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}},{"name":"m"}])");
    j["meshes"][0]["primitives"].push_back(j["meshes"][0]["primitives"][0]);
    j["meshes"][0]["primitives"][0]["material"] = 0;
    j["meshes"][0]["primitives"][1]["material"] = 1;
    const mesh::PolygonSoup soup = read(j);
    EXPECT_EQ(soup.group_names, (std::vector<std::string>{"m", "m 2"}));
    ASSERT_EQ(soup.materials.size(), 2u);
    EXPECT_EQ(soup.materials[0].colour, Vec3f(1, 0, 0));
    EXPECT_EQ(soup.materials[1].colour, Vec3f(1));
}

TEST(Gltf, WhatItCannotReadIsNamed) {
    json j = triangle();
    j["asset"]["version"] = "1.0";
    EXPECT_NE(fault(j).find("is glTF version 1.0"), std::string::npos);
    j = triangle();
    j["buffers"][0]["uri"] = "gone.bin";
    EXPECT_NE(fault(j).find("gone.bin', which is not there"), std::string::npos) << fault(j);
    j["buffers"][0]["uri"] = "../gone.bin";
    EXPECT_NE(fault(j).find("which is outside its folder"), std::string::npos) << fault(j);
    j = triangle();
    j["accessors"][0].erase("bufferView");
    EXPECT_NE(fault(j).find("accessor 0 has no buffer view"), std::string::npos) << fault(j);
}

TEST(Gltf, ARequiredExtensionThatIsNotReadIsRefusedByName) {
    json j = triangle();
    j["extensionsRequired"] = {"KHR_texture_transform", "KHR_materials_unlit", "KHR_mesh_quantization"};
    EXPECT_EQ(fault(j), "read without complaint");
    j["extensionsRequired"] = {"ACME_spline_surfaces"};
    EXPECT_EQ(fault(j),
              "x.gltf: it requires the glTF extension 'ACME_spline_surfaces', which tuft does not know; export it "
              "without that extension");
    for (const char* known : {"KHR_texture_basisu", "EXT_mesh_gpu_instancing", "EXT_texture_webp"}) {
        j["extensionsRequired"] = {known};
        EXPECT_NE(fault(j).find(std::string("requires the glTF extension ") + known), std::string::npos) << fault(j);
        EXPECT_NE(fault(j).find("export"), std::string::npos) << "what to do";
    }
    j["extensionsRequired"] = {7, nullptr};
    EXPECT_EQ(fault(j), "read without complaint");
    j.erase("extensionsRequired");
    j["extensionsUsed"] = {"ACME_spline_surfaces"};
    EXPECT_EQ(fault(j), "read without complaint") << "what is not required may be left aside";
}

TEST(Gltf, NoMessageHoldsAWholeDataUri) {
    const std::string long_uri = "data:application/octet-stream;base64," + std::string(100'000, 'A') + "*";
    json j = triangle();
    j["buffers"][0]["uri"] = long_uri;
    EXPECT_LT(fault(j).size(), 500u) << fault(j).substr(0, 600);
    j["buffers"][0]["uri"] = "data:nothing/known," + std::string(100'000, 'A');
    EXPECT_LT(fault(j).size(), 500u);
    j["buffers"][0]["uri"] = std::string(100'000, 'a') + ".bin";
    EXPECT_LT(fault(j).size(), 500u);
    j = pictured_triangle();
    j["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    j["meshes"][0]["primitives"][0]["material"] = 0;
    for (const std::string& uri :
         {"data:image/png;base64," + std::string(100'000, 'A'), "data:image/bmp;base64," + std::string(100'000, 'A'),
          std::string("data:") + std::string(100'000, 'A')}) {
        j["images"][0]["uri"] = uri;
        std::string reported;
        try {
            for (const std::string& warning : texts(read(j).warnings)) reported += warning;
        } catch (const Error& e) {
            reported = e.what();
        }
        EXPECT_LT(reported.size(), 500u) << reported.substr(0, 600);
    }
}

TEST(Gltf, FaultsAreNamed) {
    const auto with = [](const std::string& pointer, const json& value) {
        json j = triangle();
        j[json::json_pointer(pointer)] = value;
        return fault(j);
    };
    EXPECT_NE(with("/accessors/0/count", 4).find("outside"), std::string::npos);
    EXPECT_NE(with("/accessors/0/count", 4000000000u).find("accessor 0"), std::string::npos);
    EXPECT_NE(with("/accessors/0/type", "VEC2").find("wrong type"), std::string::npos);
    EXPECT_NE(with("/accessors/0/byteOffset", 4).find("outside"), std::string::npos);
    EXPECT_NE(with("/bufferViews/0/byteLength", 100000).find("outside"), std::string::npos);
    EXPECT_NE(with("/bufferViews/0/byteOffset", 4294967290u).find("outside"), std::string::npos);
    EXPECT_NE(with("/bufferViews/0/buffer", 7).find("no buffer"), std::string::npos);
    EXPECT_NE(with("/nodes/0/mesh", 9).find("mesh 9"), std::string::npos);
    EXPECT_NE(with("/nodes/0/children", json::array({0})).find("tree"), std::string::npos);
    EXPECT_NE(with("/scenes/0/nodes", json::array({5})).find("node 5"), std::string::npos);
    EXPECT_NE(with("/accessors/2/count", 0).find("no triangles"), std::string::npos);
    EXPECT_NE(with("/meshes/0/primitives/0/attributes/POSITION", 5).find("accessor 5"), std::string::npos);
    json j = triangle();
    j["accessors"][2] =
        json::parse(R"({"bufferView":0,"componentType":5125,"count":3,"type":"SCALAR","byteOffset":12})");
    EXPECT_NE(fault(j).find("out of range"), std::string::npos);
    j = triangle();
    j["meshes"] = json::array();
    EXPECT_NE(fault(j), "read without complaint");
}

TEST(Gltf, WholeNumbersAreTheOnesInTheFile) {
    const auto taken = [](const char* text) -> std::optional<std::size_t> {
        try {
            return whole_number(json::parse(text), "n", std::size_t{7});
        } catch (const json::exception&) {
            return {};
        }
    };
    EXPECT_EQ(taken("{}"), 7u);
    EXPECT_EQ(taken("{\"n\": 18446744073709551615}"), 18446744073709551615u);
    EXPECT_EQ(taken("{\"n\": 4.0}"), 4u);
    EXPECT_EQ(taken("{\"n\": -0.0}"), 0u);
    for (const char* none : {"-1", "18446744073709551616", "1e300", "-1e300", "0.5", "true", "null", "\"4\"", "[4]"}) {
        EXPECT_EQ(taken(("{\"n\": " + std::string(none) + "}").c_str()), std::nullopt) << none;
        json j = triangle();
        j["bufferViews"][0]["byteOffset"] = json::parse(none);
        // Where tinygltf takes it for a number that is not there, the document of the scene is refused.
        EXPECT_NE(fault(j), "read without complaint") << none;
    }
    EXPECT_EQ(taken("[4]"), std::nullopt);
    EXPECT_EQ(whole_number<std::int32_t>(json(-5)), -5);
    EXPECT_THROW(whole_number<std::int32_t>(json(std::int64_t{1} << 31)), json::exception);
}

TEST(Gltf, BuffersOutsideTheFolderAreRefused) {
    const Folder folder("sandbox");
    std::filesystem::create_directories(folder / "models");
    const std::vector<char> secret(68, '>');  // as floats 0.19
    write_file(folder / "secret.bin", secret.data(), secret.size());
    write_file(folder / "models/own.bin", secret.data(), secret.size());
    json j = triangle();
    for (const std::string& uri : {std::string("../secret.bin"), (folder / "secret.bin").string()}) {
        j["buffers"][0]["uri"] = uri;
        EXPECT_THROW(read(j, folder / "models/m.gltf"), Error) << uri;
    }
    std::filesystem::create_symlink(folder / "secret.bin", folder / "models/link.bin");
    j["buffers"][0]["uri"] = "link.bin";
    EXPECT_THROW(read(j, folder / "models/m.gltf"), Error) << "also by a link";
    j["buffers"][0]["uri"] = "own.bin";
    j["meshes"][0]["primitives"][0].erase("indices");
    EXPECT_EQ(read(j, folder / "models/m.gltf").n_polygons(), 1u);
}

TEST(Gltf, NanVerticesAreDroppedWithTheirTriangles) {
    const Folder folder("nan");
    const std::vector<float> numbers{0, 0, 0, 1, NAN, 0, 0, 1, 0, 0, 0, 0, 2, 0, 0, 0, 2, 0};
    write_file(folder / "n.bin", numbers.data(), numbers.size() * 4);
    json j = triangle();
    j["buffers"][0] = {{"byteLength", 72}, {"uri", "n.bin"}};
    j["bufferViews"][0]["byteLength"] = 72;
    j["accessors"][0]["count"] = 6;
    j["meshes"][0]["primitives"][0] = json::parse(R"({"attributes":{"POSITION":0}})");
    const mesh::PolygonSoup soup = read(j, folder / "m.gltf");
    EXPECT_EQ(soup.n_polygons(), 1u);
    EXPECT_EQ(soup.warnings.size(), 1u);
    EXPECT_TRUE(soup.corner_uvs.empty());
}

TEST(Gltf, HostileBytesNeverCrash) {
    const Folder folder("hostile");
    const mesh::TriangleMesh mesh = cylinder();
    export_model(folder / "m.glb", mesh, cylinder_atlas(mesh), pattern_maps(16));
    const std::vector<char> good = read_file(folder / "m.glb");
    const std::string text = triangle().dump();
    const std::vector<char> good_text(text.begin(), text.end());
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
        std::vector<char> bytes = i % 2 ? good : good_text;
        Random random(i);
        if (i % 4 < 2) bytes.resize(static_cast<std::size_t>(random.uniform() * bytes.size()) + 1);
        // Most faults matter in the JSON and the headers.
        const std::size_t reach = std::min<std::size_t>(bytes.size(), 2500);
        for (int k = 0; k < 1 + i % 5; ++k)
            bytes[static_cast<std::size_t>(random.uniform() * reach)] = static_cast<char>(random.bits());
        try {
            read_gltf(bytes, folder / "x.glb");
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 200);
    const std::string deep(1'000'000, '[');
    EXPECT_THROW(read_gltf({deep.begin(), deep.end()}, "deep.gltf"), Error);
    EXPECT_THROW(read_gltf({'g', 'l', 'T', 'F'}, "short.glb"), Error);
    EXPECT_THROW(read_gltf({'{'}, "short.gltf"), Error);
}

}  // namespace
}  // namespace tuft::io
