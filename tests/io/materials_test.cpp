#include "io/scene/materials.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "io/project/project.h"
#include "mesh/repair/repair.h"
#include "sample_model.h"
#include "stroke/surface/model.h"

namespace tuft::io {
namespace {

using namespace testing;
namespace fs = std::filesystem;

void put(const fs::path& path, const std::string& text) {
    write_file(path, text.data(), text.size());
}

/// Four pixels: red, green / blue, white.
Image8 four_colours() {
    return {.width = 2, .height = 2, .channels = 3, .pixels = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};
}

std::string png_text() {
    const std::vector<unsigned char> png = png_bytes(view_of(four_colours()));
    return {png.begin(), png.end()};
}

const std::string kTwoTriangles =
    "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl one\nf 1/1 2/2 3/3\nusemtl two\nf 1/1 3/3 4/4\n";

TEST(Materials, ObjHasTheColoursAndPicturesOfItsLibrary) {
    const Folder folder("mtl");
    put(folder / "m.obj", "mtllib lib with blank.mtl\n" + kTwoTriangles);
    put(folder / "lib with blank.mtl",
        "newmtl one\nKd 1 0.5 0\nmap_Kd -s 1 1 1 -clamp on a picture.png\nnewmtl two\nKd 0.25 0.5 "
        "1\n");
    put(folder / "a picture.png", png_text());
    const mesh::PolygonSoup soup = read_model(folder / "m.obj");
    ASSERT_EQ(soup.materials.size(), 2u);
    ASSERT_TRUE(soup.materials[0].picture);
    EXPECT_EQ(soup.materials[0].picture->rgb, four_colours().pixels);
    EXPECT_EQ(soup.materials[0].colour, Vec3f(1)) << "a picture is not tinted: exporters write any Kd beside it";
    EXPECT_FALSE(soup.materials[1].picture);
    EXPECT_EQ(soup.materials[1].colour, Vec3f(0.25f, 0.5f, 1));
    EXPECT_TRUE(soup.warnings.empty());
}

TEST(Materials, WhatIsMissingOrDamagedIsReportedAndLeftOut) {
    const Folder folder("missing");
    put(folder / "m.obj", "mtllib none.mtl\n" + kTwoTriangles);
    mesh::PolygonSoup soup = read_model(folder / "m.obj");
    EXPECT_TRUE(soup.materials.empty());
    ASSERT_EQ(soup.warnings.size(), 1u);
    EXPECT_NE(soup.warnings[0].text().find("none.mtl"), std::string::npos);

    put(folder / "m.obj", "mtllib m.mtl\n" + kTwoTriangles);
    put(folder / "m.mtl", "newmtl one\nmap_Kd gone.png\nnewmtl two\nmap_Kd text.png\nKd 1 0 0\n");
    put(folder / "text.png", "\x89PNG\r\n\x1a\nno picture");
    soup = read_model(folder / "m.obj");
    ASSERT_EQ(soup.materials.size(), 2u);
    EXPECT_FALSE(soup.materials[0].picture);
    EXPECT_FALSE(soup.materials[1].picture);
    EXPECT_EQ(soup.materials[1].colour, Vec3f(1, 0, 0)) << "its colour is what is left";
    EXPECT_EQ(soup.warnings.size(), 2u);
}

TEST(Materials, NoNameLeadsOutOfTheFolder) {
    const Folder folder("outside");
    fs::create_directories(folder / "in");
    put(folder / "secret.png", png_text());
    put(folder / "in/m.mtl",
        "newmtl one\nmap_Kd ../secret.png\nnewmtl two\nmap_Kd " + fs::absolute(folder / "secret.png").string() + "\n");
    put(folder / "in/m.obj", "mtllib m.mtl\n" + kTwoTriangles);
    mesh::PolygonSoup soup = read_model(folder / "in/m.obj");
    EXPECT_TRUE(soup.materials.empty());
    EXPECT_EQ(soup.warnings.size(), 2u);
    fs::create_symlink(fs::absolute(folder / "secret.png"), folder / "in/secret.png");
    soup = read_model(folder / "in/m.obj");
    EXPECT_TRUE(soup.materials.empty()) << "a link leads out as well";
    fs::remove(folder / "in/secret.png");
    put(folder / "in/secret.png", png_text());
    soup = read_model(folder / "in/m.obj");
    ASSERT_EQ(soup.materials.size(), 2u) << "paths of the exporter's machine end in the picture's name";
    EXPECT_TRUE(soup.materials[0].picture && soup.materials[0].picture == soup.materials[1].picture);
}

TEST(Materials, OneGreyForAllSaysNothing) {
    const Folder folder("grey");
    put(folder / "m.obj", "mtllib m.mtl\n" + kTwoTriangles);
    put(folder / "m.mtl", "newmtl one\nKd 0.8 0.8 0.8\nnewmtl two\nKd 0.8 0.8 0.8\n");
    EXPECT_TRUE(read_model(folder / "m.obj").materials.empty());
    put(folder / "m.mtl", "newmtl one\nKd 0.8 0.8 0.8\nnewmtl two\nKd 0.2 0.2 0.2\n");
    EXPECT_EQ(read_model(folder / "m.obj").materials.size(), 2u);
    put(folder / "m.mtl", "newmtl one\nKd 0.8 0 0\nnewmtl two\nKd 0.8 0 0\n");
    EXPECT_EQ(read_model(folder / "m.obj").materials.size(), 2u);
}

TEST(Materials, PlyNamesItsPictureInAComment) {
    const Folder folder("ply");
    put(folder / "scan.png", png_text());
    put(folder / "m.ply",
        "ply\nformat ascii 1.0\ncomment TextureFile scan.png\nelement vertex 3\nproperty float "
        "x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list "
        "uchar float texcoord\n"
        "end_header\n0 0 0\n100 0 0\n0 100 0\n3 0 1 2 6 0 0 1 0 0 1\n");
    const mesh::PolygonSoup soup = read_model(folder / "m.ply");
    ASSERT_EQ(soup.materials.size(), 1u);
    ASSERT_TRUE(soup.materials[0].picture);
    EXPECT_EQ(soup.materials[0].picture->name, "scan.png");
}

TEST(Materials, ColoursOfFacetsAreThoseOfTheirGroups) {
    const Folder folder("facets");
    put(folder / "m.off", "OFF\n4 2 0\n0 0 0\n100 0 0\n100 100 0\n0 100 0\n3 0 1 2 255 0 51\n3 0 2 3 0 102 0\n");
    const mesh::PolygonSoup soup = read_model(folder / "m.off");
    ASSERT_EQ(soup.materials.size(), 2u);
    EXPECT_EQ(soup.materials[0].colour, Vec3f(255, 0, 51) / 255.0f);
    EXPECT_EQ(soup.materials[1].colour, Vec3f(0, 102, 0) / 255.0f);
    put(folder / "m.off", "OFF\n4 2 0\n0 0 0\n100 0 0\n100 100 0\n0 100 0\n3 0 1 2 255 0 51\n3 0 2 3 255 0 51\n");
    const mesh::PolygonSoup one = read_model(folder / "m.off");
    EXPECT_TRUE(one.group_names.empty());
    ASSERT_EQ(one.materials.size(), 1u);
    EXPECT_EQ(one.materials[0].colour, Vec3f(255, 0, 51) / 255.0f);
}

stroke::Model model_of(const mesh::PolygonSoup& soup, std::uint32_t size) {
    stroke::ModelOptions options;
    options.unwrap.size = size;
    return stroke::prepare_model(soup, options);
}

ProjectModel contents(const stroke::Model& model) {
    ProjectModel stored;
    stored.source = "m.obj";
    stored.mesh = *model.mesh;
    stored.atlas = model.atlas;
    stored.substrate = "name = 'x'\n";
    return stored;
}

TEST(Materials, AProjectKeepsThemAndMakesTheSameBaseColourAgain) {
    const Folder folder("project");
    put(folder / "m.obj", "mtllib m.mtl\n" + kTwoTriangles);
    put(folder / "m.mtl", "newmtl one\nmap_Kd p.png\nnewmtl two\nKd 0.25 0.5 1\n");
    put(folder / "p.png", png_text());
    const stroke::Model model = model_of(read_model(folder / "m.obj"), 64);
    ASSERT_FALSE(model.base_colour.empty());
    Project::create(folder / "m.tuft", contents(model));
    const Project project = Project::open(folder / "m.tuft");
    EXPECT_EQ(project.format(), kColoursFormat) << "older programs do not know them";
    ProjectModel stored = project.model();
    fs::remove(folder / "p.png");
    ASSERT_EQ(stored.mesh.materials.size(), 2u);
    EXPECT_EQ(stored.mesh.materials[0].picture->bytes, model.mesh->materials[0].picture->bytes);
    const stroke::Model again = stroke::prepare_model(std::move(stored.mesh), std::move(stored.atlas));
    ASSERT_EQ(again.base_colour.tiles.size(), model.base_colour.tiles.size());
    for (std::size_t slot = 0; slot < again.base_colour.tiles.size(); ++slot)
        ASSERT_EQ(again.base_colour.tiles[slot].rgb, model.base_colour.tiles[slot].rgb);
}

/// Faces on the tiles 1002, 1011 and 1020.
const std::string kThreeTiles =
    "mtllib m.mtl\nusemtl one\nv 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nv 0 0 50\nv 100 0 50\nv 0 0 90\nv 100 0 90\n"
    "vt 1 0\nvt 2 0\nvt 2 1\nvt 1 1\nvt 0 1\nvt 1 2\nvt 9 1\nvt 10 1\nvt 10 2\n"
    "f 1/1 2/2 3/3 4/4\nf 1/5 2/4 6/6\nf 4/7 3/8 8/9\n";

TEST(Materials, ANumberInAPicturesNameStandsForItsTile) {
    const Folder folder("udim");
    put(folder / "m.obj", kThreeTiles);
    put(folder / "m.mtl", "newmtl one\nmap_Kd -clamp on p.<udim>.png\nmap_Bump n.<UDIM>.png\n");
    put(folder / "p.1002.png", png_text());
    const Image8 green{.width = 1, .height = 1, .channels = 3, .pixels = {0, 255, 0}};
    const std::vector<unsigned char> png = png_bytes(view_of(green));
    put(folder / "p.1011.png", {png.begin(), png.end()});
    const mesh::PolygonSoup soup = read_model(folder / "m.obj");
    ASSERT_EQ(soup.materials.size(), 1u);
    const std::vector<mesh::PictureTile>& tiles = soup.materials[0].tiles;
    ASSERT_EQ(tiles.size(), 2u);
    EXPECT_EQ(tiles[0].udim, 1002u);
    EXPECT_EQ(tiles[0].picture->rgb, four_colours().pixels);
    EXPECT_EQ(tiles[1].udim, 1011u);
    std::string said;
    for (const Message& warning : soup.warnings) said += warning.text() + "\n";
    EXPECT_EQ(soup.warnings.size(), 2u) << said;
    EXPECT_NE(said.find("p.1020.png"), std::string::npos) << said;
    EXPECT_NE(said.find("n.<UDIM>.png"), std::string::npos) << said;

    const stroke::Model model = model_of(soup, 64);
    const auto colour = [&](const Vec3& p) {
        double nearest = 1;
        std::array<int, 3> rgb{};
        for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot)
            for (int t = 0; t < atlas::kTileTexels; ++t)
                if (const double d = glm::distance(Vec3(model.texels.position(slot, t)), p);
                    model.texels.tiles[slot].cluster[t] != atlas::kNoCluster && d < nearest) {
                    nearest = d;
                    for (std::size_t c = 0; c < 3; ++c) rgb[c] = model.base_colour.tiles[slot].rgb[c][t];
                }
        return rgb;
    };
    // Well inside the pixels: row 0 of the picture is at v = 1.
    EXPECT_EQ(colour({0.015, 0.085, 0}), (std::array{255, 0, 0}));
    EXPECT_EQ(colour({0.085, 0.015, 0}), (std::array{255, 255, 255}));
    EXPECT_EQ(colour({0.015, 0.015, 0}), (std::array{0, 0, 255}));
    EXPECT_EQ(colour({0.08, 0, 0.02}), (std::array{0, 255, 0}));
    EXPECT_EQ(colour({0.08, 0.05, 0.045}), (std::array{255, 255, 255})) << "a tile without a picture";

    Project::create(folder / "m.tuft", contents(model));
    const Project project = Project::open(folder / "m.tuft");
    EXPECT_EQ(project.format(), kTilesFormat) << "older programs would repeat one picture";
    ProjectModel stored = project.model();
    ASSERT_EQ(stored.mesh.materials[0].tiles.size(), 2u);
    EXPECT_EQ(stored.mesh.materials[0].tiles[1].picture->bytes, tiles[1].picture->bytes);
    const stroke::Model again = stroke::prepare_model(std::move(stored.mesh), std::move(stored.atlas));
    for (std::size_t slot = 0; slot < again.base_colour.tiles.size(); ++slot)
        ASSERT_EQ(again.base_colour.tiles[slot].rgb, model.base_colour.tiles[slot].rgb);
}

TEST(Materials, TilesAreReadFromTheFolderOnlyAndNoMoreThanSomeHundred) {
    const Folder folder("udim_hostile");
    fs::create_directories(folder / "in");
    put(folder / "p.1002.png", png_text());
    put(folder / "in/m.obj", kThreeTiles);
    for (const std::string& name :
         {std::string("../p.<UDIM>.png"), (fs::absolute(folder / "p.").string() + "<UDIM>.png")}) {
        put(folder / "in/m.mtl", "newmtl one\nmap_Kd " + name + "\n");
        EXPECT_TRUE(read_model(folder / "in/m.obj").materials.empty()) << name;
    }
    // UVs on all tiles, beside them, and none at all.
    std::string obj = "mtllib m.mtl\nusemtl one\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = -5; i < 1010; ++i)
        obj += "vt " + std::to_string(i % 10 + 0.1) + " " + std::to_string(i / 10 + 0.1) + "\nf 1/-1 2/-1 3/-1\n";
    put(folder / "in/m.obj", obj + "vt 1e30 nan\nf 1/-1 2/-1 3/-1\nf 1 2 3\n");
    put(folder / "in/m.mtl", "newmtl one\nmap_Kd p.<UDIM>.png\n");
    const mesh::PolygonSoup soup = read_model(folder / "in/m.obj");
    EXPECT_GT(soup.warnings.size(), kMostPictureTiles);
    EXPECT_LT(soup.warnings.size(), kMostPictureTiles + 10) << "one for each tile that is looked for";
}

TEST(Materials, AModelWithoutColoursKeepsAnOlderFormat) {
    const Folder folder("plain");
    put(folder / "m.obj", kTwoTriangles);
    const stroke::Model model = model_of(read_model(folder / "m.obj"), 64);
    EXPECT_TRUE(model.base_colour.empty());
    const Project project = Project::create(folder / "m.tuft", contents(model));
    EXPECT_LT(project.format(), kColoursFormat);
}

}  // namespace
}  // namespace tuft::io
