#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "atlas/texels/texel_map.h"
#include "core/error.h"
#include "core/files/files.h"
#include "gltf_maker.h"
#include "ink/colour/base_colour.h"
#include "io/export/export.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "io/project/project.h"
#include "sample_model.h"
#include "stroke/document/document.h"

/// Objects, groups and materials of a file, through painting to the exported model.
namespace tuft::io {
namespace {

using namespace testing;
using nlohmann::json;
using test::GltfMaker;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;
namespace fs = std::filesystem;

const Image8 kTwoPixels{.width = 1, .height = 2, .channels = 3, .pixels = {255, 0, 0, 0, 255, 0}};

/// A truck: a body of paint and glass, two wheels of one mesh (one of them mirrored) on an axle, a
/// textured flag whose normals lie by other UVs.
std::vector<char> truck_glb() {
    GltfMaker maker;
    json& d = maker.document;
    const std::vector<unsigned char> png = png_bytes(view_of(kTwoPixels));
    for (const char* name : {"rubber", "flag", "flag normals"})
        d["images"].push_back(
            {{"name", name}, {"mimeType", "image/png"}, {"bufferView", maker.add_view(png.data(), png.size())}});
    d["samplers"] = {{{"wrapS", 33648}}};
    for (int i = 0; i < 3; ++i) d["textures"].push_back({{"source", i}, {"sampler", 0}});
    d["extensionsUsed"] = {"KHR_materials_transmission", "KHR_texture_transform"};
    d["materials"] = json::parse(R"([
      {"name":"Paint","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[0.6,0.05,0.05,1],"metallicFactor":0.2}},
      {"name":"Glass","alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[0.6,0.8,0.9,0.3]},
       "extensions":{"KHR_materials_transmission":{"transmissionFactor":0.5}}},
      {"name":"Rubber","pbrMetallicRoughness":{"baseColorTexture":{"index":0},"roughnessFactor":0.9}},
      {"name":"Chrome","emissiveFactor":[0.1,0,0],"pbrMetallicRoughness":{"roughnessFactor":0.1}},
      {"name":"Flag","alphaMode":"MASK","alphaCutoff":0.4,"pbrMetallicRoughness":{"baseColorTexture":{"index":1}},
       "normalTexture":{"index":2,"texCoord":1,"extensions":{"KHR_texture_transform":{"scale":[2,2]}}}}])");
    d["meshes"].push_back({{"name", "body mesh"},
                           {"primitives", {maker.box({0, 1, 0}, {4, 1, 2}, 0), maker.box({1, 2, 0}, {1, 1, 2}, 1)}}});
    d["meshes"].push_back(
        {{"name", "wheel mesh"},
         {"primitives", {maker.box({0, 0, 0}, {1, 1, 0.5f}, 2), maker.box({0.1f, 0, 0}, {0.5f, 0.5f, 0.7f}, 3)}}});
    d["meshes"].push_back({{"name", "flag mesh"}, {"primitives", {maker.box({0, 0, 0}, {1, 1, 0.1f}, 4)}}});
    d["nodes"] = json::parse(R"([
      {"name":"Truck","children":[1,2,5],"translation":[0.5,0,0.25],"rotation":[0,0.14943813,0,0.98877108]},
      {"name":"Body","mesh":0,"extras":{"plate":"TU FT 1"}},
      {"name":"Axle","children":[3,4],"scale":[1,1,1.5]},
      {"name":"Wheel left","mesh":1,"translation":[1.5,0.4,-1.5]},
      {"name":"Wheel right","mesh":1,"translation":[1.5,0.4,1.5],"scale":[1,1,-1]},
      {"name":"Flag","mesh":2,"translation":[-1,3,0]}])");
    d["scenes"] = {{{"nodes", {0}}}};
    return maker.glb();
}

stroke::Model model_of(mesh::PolygonSoup soup, double metres_per_unit = 1) {
    stroke::ModelOptions options;
    options.repair.metres_per_unit = metres_per_unit;
    options.unwrap.size = 256;
    return stroke::prepare_model(std::move(soup), options);
}

/// Texels with ink all over the parts of an object and material.
ink::Canvas ink_on(const stroke::Model& model, const std::string& object, const std::string& material) {
    ink::Canvas canvas(model.texels.n_slots());
    ink::Pigment pigment;
    pigment.name = "black";
    canvas.add_pigment(pigment);
    std::mutex guard;
    atlas::visit_texels(*model.mesh, model.atlas, model.texels,
                        [&](std::uint32_t slot, int texel, std::uint32_t t, const Vec3&) {
                            const mesh::ScenePart& part = model.mesh->scene->parts[mesh::part_of(*model.mesh, t)];
                            if (part.object != object || part.material != material) return;
                            const std::scoped_lock lock(guard);
                            canvas.touch(slot, 0)[static_cast<std::size_t>(texel)] = 2;
                        });
    return canvas;
}

std::vector<std::string> export_painted(const fs::path& path, const stroke::Model& model, const ink::Canvas& canvas,
                                        bool flat = true) {
    const ink::Stack stack(canvas);
    const ModelMaps maps = pattern_maps(model.atlas.size, flat);
    return texts(export_model(path, *model.mesh, model.atlas, maps,
                              {.painted = painted_parts(stack, *model.mesh, model.atlas, model.texels)}));
}

json glb_json(const fs::path& path) {
    const std::vector<char> bytes = read_file(path);
    std::uint32_t size = 0;
    std::memcpy(&size, &bytes[12], 4);
    return json::parse(bytes.begin() + 20, bytes.begin() + 20 + size);
}

struct PartSum {
    std::size_t triangles = 0;
    Box bounds;
};

/// Triangles and extent (metres) of each "object / material" of a file.
std::map<std::string, PartSum> parts_in(const fs::path& path, double metres_per_unit = 1) {
    const mesh::PolygonSoup soup = read_model(path);
    std::map<std::string, PartSum> parts;
    for (std::size_t p = 0; p < soup.n_polygons(); ++p) {
        const std::uint32_t index = soup.polygon_parts.empty() ? soup.polygon_groups[p] : soup.polygon_parts[p];
        const mesh::ScenePart& part = soup.scene->parts[index];
        PartSum& sum = parts[part.object + " / " + part.material];
        ++sum.triangles;
        for (std::size_t c = soup.polygon_start[p]; c < soup.polygon_start[p + 1]; ++c)
            sum.bounds.add(metres_per_unit * soup.points[soup.corners[c]]);
    }
    return parts;
}

const json& material_named(const json& document, const std::string& name) {
    static const json none;
    for (const json& m : document["materials"])
        if (m["name"] == name) return m;
    return none;
}

std::vector<std::string> names_in(const json& list) {
    std::vector<std::string> names;
    for (const json& item : list) names.push_back(item.value("name", ""));
    return names;
}

class Parts : public ::testing::Test {
  protected:
    Parts() {
        const std::vector<char> bytes = truck_glb();
        write_file(folder / "truck.glb", bytes.data(), bytes.size());
    }
    Folder folder{"parts"};
};

TEST_F(Parts, OnlyWhatIsPaintedGetsTheDecoratedMaterial) {
    const stroke::Model model = model_of(read_model(folder / "truck.glb"));
    export_painted(folder / "out.glb", model, ink_on(model, "Wheel right", "Rubber"));
    const json before = glb_json(folder / "truck.glb"), after = glb_json(folder / "out.glb");
    EXPECT_EQ(names_in(after["nodes"]), names_in(before["nodes"]));
    for (std::size_t n = 0; n < before["nodes"].size(); ++n) {
        json node = after["nodes"][n];
        if (node.contains("extras") && node["extras"].erase("tuft_parts") && node["extras"].empty())
            node.erase("extras");
        for (const char* key : {"children", "translation", "rotation", "scale", "extras"})
            EXPECT_EQ(node.value(key, json()), before["nodes"][n].value(key, json())) << n << key;
    }
    EXPECT_THAT(names_in(after["materials"]), ElementsAre("Paint", "Glass", "Rubber", "Chrome", "Flag", "decorated"));
    EXPECT_THAT(names_in(after["meshes"]), ElementsAre("body mesh", "wheel mesh", "flag mesh", "wheel mesh"))
        << "the other wheel shows the mesh that both had";
    for (const char* name : {"Paint", "Glass", "Rubber", "Chrome"})
        EXPECT_EQ(material_named(after, name), material_named(before, name));
    const auto& wheel = after["meshes"][after["nodes"][4]["mesh"].get<std::size_t>()]["primitives"];
    ASSERT_EQ(wheel.size(), 2u);
    EXPECT_EQ(after["materials"][wheel[0]["material"].get<std::size_t>()]["name"], "decorated");
    EXPECT_EQ(after["materials"][wheel[1]["material"].get<std::size_t>()]["name"], "Chrome");
    EXPECT_TRUE(wheel[1]["attributes"].contains("TEXCOORD_1")) << "written as it was read";
}

TEST_F(Parts, TheExportHasTheSameTrianglesInTheSamePlaces) {
    const stroke::Model model = model_of(read_model(folder / "truck.glb"));
    const auto before = parts_in(folder / "truck.glb");
    for (const auto& [object, material] :
         {std::pair("Wheel right", "Rubber"), std::pair("Body", "Paint"), std::pair("Flag", "Flag")}) {
        export_painted(folder / "out.glb", model, ink_on(model, object, material), false);
        auto after = parts_in(folder / "out.glb");
        const std::string painted = std::string(object) + " / ";
        ASSERT_TRUE(after.contains(painted + "decorated")) << painted;
        after[painted + material] = after[painted + "decorated"];
        after.erase(painted + "decorated");
        ASSERT_EQ(after.size(), before.size());
        for (const auto& [name, sum] : before) {
            EXPECT_EQ(after[name].triangles, sum.triangles) << name;
            // There and back through the node's frame in floats, 4 m across.
            EXPECT_LT(glm::distance(after[name].bounds.lo, sum.bounds.lo), 2e-6) << name;
            EXPECT_LT(glm::distance(after[name].bounds.hi, sum.bounds.hi), 2e-6) << name;
        }
        const stroke::Model again = model_of(read_model(folder / "out.glb"));
        EXPECT_EQ(again.repairs.faces_flipped, model.repairs.faces_flipped) << "also in the frame that mirrors";
    }
}

TEST_F(Parts, PicturesAndVerticesThatNothingShowsAnyMoreAreLeftOut) {
    const stroke::Model model = model_of(read_model(folder / "truck.glb"));
    export_painted(folder / "out.glb", model, ink_on(model, "Flag", "Flag"));
    const json after = glb_json(folder / "out.glb");
    EXPECT_THAT(names_in(after["images"]), ElementsAre("rubber", "base_colour", "orm"));
    EXPECT_EQ(material_named(after, "Flag"), json());
    const json& rubber = material_named(after, "Rubber");
    const auto texture = rubber["pbrMetallicRoughness"]["baseColorTexture"]["index"].get<std::size_t>();
    EXPECT_EQ(after["images"][after["textures"][texture]["source"].get<std::size_t>()]["name"], "rubber");
    EXPECT_EQ(after["textures"][texture]["sampler"], 0);
    EXPECT_EQ(after["samplers"][0]["wrapS"], 33648);
    const json before = glb_json(folder / "truck.glb");
    // The flag's three vectors of 24 vertices and its indices went, those of the new one with
    // normals came.
    EXPECT_EQ(after["accessors"].size(), before["accessors"].size());
}

TEST_F(Parts, AProjectKeepsThem) {
    const stroke::Model model = model_of(read_model(folder / "truck.glb"));
    const ink::Canvas canvas = ink_on(model, "Body", "Paint");
    export_painted(folder / "out.glb", model, canvas);
    const std::vector<char> expected = read_file(folder / "out.glb");
    ProjectModel stored;
    stored.source = "truck.glb";
    stored.mesh = *model.mesh;
    stored.atlas = model.atlas;
    stored.substrate = "name = 'x'\n";
    Project::create(folder / "p.tuft", stored);
    fs::remove(folder / "truck.glb");
    ProjectModel back = Project::open(folder / "p.tuft").model();
    ASSERT_TRUE(back.mesh.scene);
    EXPECT_EQ(back.mesh.scene->parts, model.mesh->scene->parts);
    EXPECT_EQ(back.mesh.triangle_parts, model.mesh->triangle_parts);
    const stroke::Model again = stroke::prepare_model(std::move(back.mesh), std::move(back.atlas));
    export_painted(folder / "out.glb", again, canvas);
    EXPECT_EQ(read_file(folder / "out.glb"), expected);
}

TEST_F(Parts, ObjHasTheObjectsAndMaterialsToo) {
    const stroke::Model model = model_of(read_model(folder / "truck.glb"));
    const std::vector<std::string> notes = export_painted(folder / "out.obj", model, ink_on(model, "Body", "Paint"));
    auto before = parts_in(folder / "truck.glb");
    before["Body / decorated"] = before["Body / Paint"];
    before.erase("Body / Paint");
    const auto after = parts_in(folder / "out.obj", 1e-3);
    ASSERT_EQ(after.size(), before.size());
    for (const auto& [name, sum] : before) {
        ASSERT_TRUE(after.contains(name)) << name;
        EXPECT_EQ(after.at(name).triangles, sum.triangles) << name;
        EXPECT_LT(glm::distance(after.at(name).bounds.hi, sum.bounds.hi), 2e-6) << name;
    }
    const mesh::PolygonSoup soup = read_model(folder / "out.obj");
    EXPECT_TRUE(soup.warnings.empty());
    std::map<std::string, const mesh::Material*> materials;
    for (std::size_t i = 0; i < soup.scene->parts.size(); ++i)
        materials[soup.scene->parts[i].material] = &soup.materials[i];
    ASSERT_TRUE(materials.at("Rubber")->picture);
    EXPECT_EQ(materials.at("Rubber")->picture->rgb, kTwoPixels.pixels);
    EXPECT_NEAR(materials.at("Glass")->colour.b, 0.9547, 1e-3) << "sRGB of 0.9";
    const json document = json::parse(soup.scene->document);
    EXPECT_NEAR(material_named(document, "Glass")["pbrMetallicRoughness"]["baseColorFactor"][3], 0.3, 1e-6);
    EXPECT_EQ(material_named(document, "Glass")["alphaMode"], "BLEND");
    EXPECT_NEAR(material_named(document, "Chrome")["pbrMetallicRoughness"]["roughnessFactor"], 0.1, 1e-6);
    EXPECT_NEAR(material_named(document, "Chrome")["pbrMetallicRoughness"]["metallicFactor"], 1, 1e-6);
    EXPECT_NEAR(material_named(document, "Chrome")["emissiveFactor"][0], 0.1, 1e-6);
    EXPECT_THAT(notes, Contains(HasSubstr("1 of 7 parts get the material 'decorated'")));
}

TEST_F(Parts, InkOnATransparentPartIsReported) {
    const stroke::Model model = model_of(read_model(folder / "truck.glb"));
    EXPECT_THAT(export_painted(folder / "out.glb", model, ink_on(model, "Body", "Glass")),
                Contains(HasSubstr("part 'Body' is transparent in its file")));
}

TEST_F(Parts, WithoutInkTheFileIsWrittenAsItWas) {
    const stroke::Model model = model_of(read_model(folder / "truck.glb"));
    export_painted(folder / "out.glb", model, ink::Canvas(model.texels.n_slots()));
    json before = glb_json(folder / "truck.glb"), after = glb_json(folder / "out.glb");
    for (const char* key :
         {"nodes", "meshes", "materials", "textures", "images", "samplers", "accessors", "scenes", "extensionsUsed"})
        EXPECT_EQ(after[key], before[key]) << key;
    EXPECT_EQ(parts_in(folder / "out.glb").size(), parts_in(folder / "truck.glb").size());
}

void put(const fs::path& path, const std::string& text) {
    write_file(path, text.data(), text.size());
}

/// Two objects, one of them with two groups; pictures and transparency in the library.
void put_obj(const Folder& folder) {
    std::string text = "mtllib m.mtl\n";
    for (int i = 0; i < 3; ++i) {
        const std::string x = std::to_string(100 * i), x1 = std::to_string(100 * i + 80);
        text += "v " + x + " 0 0\nv " + x1 + " 0 0\nv " + x1 + " 80 0\nv " + x + " 80 0\n";
    }
    text +=
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\no Car\ng doors\nusemtl Red paint\nf 1/1 2/2 3/3 4/4\n"
        "g windows\nusemtl Glass\nf 5/1 6/2 7/3 8/4\no Bench seat\ng\nusemtl Cloth\nf 9/1 10/2 "
        "11/3 12/4\n";
    put(folder / "m.obj", text);
    put(folder / "m.mtl",
        "newmtl Red paint\nKd 0.8 0.1 0.1\nNs 225\n\nnewmtl Glass\nKd 0.5 0.7 0.9\nd 0.25\nNi 1.5\n"
        "newmtl Cloth\nmap_Kd -s 2 2 2 cloth.png\nmap_Bump -bm 0.5 cloth.png\nKe 0.5 0 0\n");
    const std::vector<unsigned char> png = png_bytes(view_of(kTwoPixels));
    put(folder / "cloth.png", {png.begin(), png.end()});
}

TEST(PartsOfObj, AreNodesAndMaterialsOfGltf) {
    const Folder folder("obj_parts");
    put_obj(folder);
    const stroke::Model model = model_of(read_model(folder / "m.obj"), 1e-3);
    export_painted(folder / "out.glb", model, ink_on(model, "Car", "Red paint"));
    const json j = glb_json(folder / "out.glb");
    EXPECT_THAT(names_in(j["nodes"]), ElementsAre("Car", "doors", "windows", "Bench seat"));
    EXPECT_EQ(j["nodes"][0]["children"], json({1, 2}));
    EXPECT_THAT(names_in(j["materials"]), UnorderedElementsAre("Glass", "Cloth", "decorated"));
    const json& glass = material_named(j, "Glass");
    EXPECT_EQ(glass["alphaMode"], "BLEND");
    EXPECT_EQ(glass["pbrMetallicRoughness"]["baseColorFactor"][3], 0.25);
    const json& cloth = material_named(j, "Cloth");
    EXPECT_EQ(cloth["emissiveFactor"], json({0.5, 0.0, 0.0}));
    EXPECT_TRUE(cloth["pbrMetallicRoughness"].contains("baseColorTexture"));
    EXPECT_TRUE(cloth.contains("normalTexture"));
    const auto parts = parts_in(folder / "out.glb");
    ASSERT_TRUE(parts.contains("windows / Glass") && parts.contains("doors / decorated") &&
                parts.contains("Bench seat / Cloth"));
    EXPECT_NEAR(parts.at("Bench seat / Cloth").bounds.hi.x, 0.28, 1e-6);
}

TEST(PartsOfObj, StayWithTheStatementsOfTheirMaterials) {
    const Folder folder("obj_obj");
    put_obj(folder);
    const stroke::Model model = model_of(read_model(folder / "m.obj"), 1e-3);
    export_painted(folder / "out.obj", model, ink_on(model, "Car", "Red paint"));
    const std::vector<char> obj = read_file(folder / "out.obj"), mtl = read_file(folder / "out.mtl");
    const std::string text(obj.begin(), obj.end()), library(mtl.begin(), mtl.end());
    for (const char* line :
         {"\no Car\n", "\ng doors\n", "\ng windows\n", "\no Bench seat\n", "\nusemtl Glass\n", "\nusemtl decorated\n"})
        EXPECT_THAT(text, HasSubstr(line));
    for (const char* line : {"newmtl Glass\nKd 0.5 0.7 0.9\nd 0.25\nNi 1.5\n", "map_Kd -s 2 2 2 out_cloth.png\n",
                             "map_Bump -bm 0.5 out_cloth.png\n"})
        EXPECT_THAT(library, HasSubstr(line));
    const mesh::PolygonSoup soup = read_model(folder / "out.obj");
    EXPECT_THAT(soup.group_names,
                ElementsAre("Car / doors / decorated", "Car / windows / Glass", "Bench seat / Cloth"));
    EXPECT_TRUE(soup.warnings.empty());
    const mesh::Surface again = mesh::build_surface(soup);
    for (std::size_t t = 0; t < again.mesh.n_triangles(); ++t)
        for (std::size_t c = 3 * t; c < 3 * t + 3 && again.mesh.triangle_groups[t] > 0; ++c)
            EXPECT_EQ(again.mesh.corner_uvs[c], model.mesh->corner_uvs[c]) << "without ink they lie by their own UVs";
}

// A part made of glass here lets light pass where there is no ink, under its name; the file's own glass stays as it is.
TEST_F(Parts, OfGlassKeepTheirNamesAndGetATransmissionMap) {
    const stroke::Model model = model_of(read_model(folder / "truck.glb"));
    stroke::Document painting(model);
    const std::vector<std::string> names = stroke::part_names(*model.mesh);
    const auto named = [&](const std::string& word) {
        const auto at = std::ranges::find_if(names, [&](const std::string& n) { return n.find(word) != n.npos; });
        EXPECT_NE(at, names.end()) << word;
        return *at;
    };
    stroke::PartEdit edit;
    edit.parts = {{.name = named("Chrome"), .substrate = ink::load_substrate("clay")},
                  {.name = named("Paint"), .substrate = ink::load_substrate("glass")}};
    painting.paint(edit);
    const stroke::Appearance& shown = painting.appearance();
    const ModelMaps maps = make_maps(shown.stack(), model.texels, shown.substrate());
    ASSERT_FALSE(maps.transmission.texels.empty());
    const ExportOptions options{
        .painted = painted_parts(shown.stack(), *model.mesh, model.atlas, model.texels),
        .transmits = transmitting_parts(shown.stack(), shown.substrate(), *model.mesh, model.atlas, model.texels)};
    for (const char* file : {"out.glb", "out.gltf"}) {
        export_model(folder / file, *model.mesh, model.atlas, maps, options);
        const mesh::PolygonSoup again = read_model(folder / file);
        for (const char* object : {"Body", "Wheel left", "Wheel right", "Flag"})
            EXPECT_THAT(again.scene->parts, Contains(::testing::Field(&mesh::ScenePart::object, object)));
    }
    const json j = glb_json(folder / "out.glb");
    EXPECT_THAT(names_in(j["nodes"]),
                ::testing::IsSupersetOf({"Truck", "Body", "Axle", "Wheel left", "Wheel right", "Flag"}));
    EXPECT_THAT(j["extensionsUsed"], Contains("KHR_materials_transmission"));
    const json& glass = material_named(j, "decorated.glass");
    const json& transmission = glass["extensions"]["KHR_materials_transmission"];
    EXPECT_EQ(transmission["transmissionFactor"], 1);
    EXPECT_EQ(j["images"][j["textures"][transmission["transmissionTexture"]["index"].get<int>()]["source"].get<int>()]
               ["name"],
              "transmission");
    EXPECT_EQ(material_named(j, "decorated").count("extensions"), 0u) << "clay is opaque";
    const json& own = material_named(j, "Glass");
    EXPECT_EQ(own["alphaMode"], "BLEND");
    EXPECT_EQ(own["extensions"]["KHR_materials_transmission"]["transmissionFactor"], 0.5);
    // The map is that of bare glass on the body, 0.9, and 0 elsewhere.
    std::set<int> values(maps.transmission.texels.begin(), maps.transmission.texels.end());
    EXPECT_THAT(values, ::testing::IsSupersetOf({0, 230}));
    EXPECT_THAT(texts(export_model(folder / "plain.obj", *model.mesh, model.atlas, maps, options)),
                Contains(HasSubstr("are of glass; this format has no map of it")));
    EXPECT_FALSE(fs::exists(folder / "plain_transmission.png"));
}

/// Boxes as Blender writes them: objects that share a material, one of them of two; one with a mesh of its own
/// material.
std::vector<char> blender_glb(const json& part_names = {}) {
    GltfMaker maker;
    json& d = maker.document;
    d["materials"] = json::parse(R"([{"name":"Paint","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}},
      {"name":"Glass"},{"name":"Rubber","pbrMetallicRoughness":{"baseColorFactor":[0,0,1,1]}}])");
    const auto at = [](float x) { return Vec3f(x, 0, 0); };
    const Vec3f size(1);
    d["meshes"].push_back({{"name", "Cube.001"}, {"primitives", {maker.box(at(0), size, 0)}}});
    d["meshes"].push_back(
        {{"name", "Cube.002"}, {"primitives", {maker.box(at(2), size, 0), maker.box(at(4), size, 1)}}});
    d["meshes"].push_back({{"name", "Cube.003"}, {"primitives", {maker.box(at(6), size, 2)}}});
    d["meshes"].push_back({{"name", "Cube.004"}, {"primitives", {maker.box(at(8), size, 1)}}});
    d["nodes"] = json::parse(R"([{"name":"Hood","mesh":0},{"name":"Door","mesh":1},{"name":"Tyre","mesh":2},
      {"name":"Window","mesh":3},{"name":"Tyre","mesh":2,"translation":[0,3,0]}])");
    if (!part_names.is_null()) d["nodes"][1]["extras"]["tuft_parts"] = part_names;
    d["scenes"] = {{{"nodes", {0, 1, 2, 3, 4}}}};
    return maker.glb();
}

void write_blender(const fs::path& path, const json& part_names) {
    const std::vector<char> bytes = blender_glb(part_names);
    write_file(path, bytes.data(), bytes.size());
}

TEST(PartsOfNodes, ThatShareAMaterialAreOneEach) {
    const Folder folder("nodes");
    const std::vector<char> bytes = blender_glb();
    write_file(folder / "in.glb", bytes.data(), bytes.size());
    const mesh::PolygonSoup soup = read_model(folder / "in.glb");
    EXPECT_THAT(soup.group_names, ElementsAre("Hood", "Door / Paint", "Door / Glass", "Tyre", "Window", "Tyre 2"));
    ASSERT_EQ(soup.materials.size(), 6u);
    for (const std::size_t i : {0u, 1u}) EXPECT_EQ(soup.materials[i].colour, Vec3f(1, 0, 0));
    for (const std::size_t i : {3u, 5u}) EXPECT_EQ(soup.materials[i].colour, Vec3f(0, 0, 1));
}

TEST(PartsOfNodes, AreTheSameInWhatIsExported) {
    const Folder folder("again");
    for (const bool truck : {false, true}) {
        const std::vector<char> bytes = truck ? truck_glb() : blender_glb();
        write_file(folder / "in.glb", bytes.data(), bytes.size());
        const stroke::Model model = model_of(read_model(folder / "in.glb"));
        for (const auto& [object, material] : {truck ? std::pair("Body", "Paint") : std::pair("Door", "Paint"),
                                               truck ? std::pair("Wheel left", "Rubber") : std::pair("Hood", "Paint"),
                                               truck ? std::pair("Flag", "Flag") : std::pair("Tyre", "Rubber")}) {
            export_painted(folder / "out.glb", model, ink_on(model, object, material));
            const mesh::PolygonSoup again = read_model(folder / "out.glb");
            EXPECT_EQ(again.group_names, model.mesh->group_names) << object;
            EXPECT_EQ(again.polygon_groups, model.mesh->triangle_groups) << object;
            const stroke::Model twice = model_of(read_model(folder / "out.glb"));
            export_painted(folder / "twice.glb", twice, ink_on(twice, object, "decorated"));
            EXPECT_EQ(read_model(folder / "twice.glb").group_names, model.mesh->group_names) << object;
        }
    }
}

/// One object on two pages as exports write it: all UVs lie in one square, each material has its picture.
std::vector<char> paged_glb(bool with_extras) {
    GltfMaker maker;
    json& d = maker.document;
    for (const int page : {0, 1}) {
        const Image8 picture{
            .width = 1, .height = 1, .channels = 3, .pixels = {255, static_cast<std::uint8_t>(255 * page), 0}};
        const std::vector<unsigned char> png = png_bytes(view_of(picture));
        const std::string name = page == 0 ? "decorated.1001" : "decorated.1002";
        d["images"].push_back({{"mimeType", "image/png"}, {"bufferView", maker.add_view(png.data(), png.size())}});
        d["textures"].push_back({{"source", page}});
        d["materials"].push_back({{"name", name}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", page}}}}}});
    }
    d["meshes"].push_back({{"primitives", {maker.box({0, 0, 0}, Vec3f(1), 0), maker.box({2, 0, 0}, Vec3f(1), 1)}}});
    d["nodes"] = json::parse(R"([{"name":"Hood","mesh":0}])");
    if (with_extras) d["nodes"][0]["extras"]["tuft_parts"] = {"Hood", "Hood"};
    d["scenes"] = {{{"nodes", {0}}}};
    return maker.glb();
}

TEST(PartsOfNodes, OnTwoPagesAreOneWithBothPictures) {
    const Folder folder("pages");
    for (const bool with_extras : {false, true}) {
        const std::vector<char> bytes = paged_glb(with_extras);
        write_file(folder / "in.glb", bytes.data(), bytes.size());
        const stroke::Model model = model_of(read_model(folder / "in.glb"));
        ASSERT_THAT(model.mesh->group_names, ElementsAre("Hood"));
        const ink::BaseColour colours = ink::base_colour_of(*model.mesh, model.atlas, model.texels);
        std::set<std::pair<bool, int>> greens;
        std::mutex guard;
        atlas::visit_texels(*model.mesh, model.atlas, model.texels,
                            [&](std::uint32_t slot, int texel, std::uint32_t t, const Vec3&) {
                                const std::scoped_lock lock(guard);
                                greens.insert({model.mesh->position(t, 0).x > 1, colours.tiles[slot].rgb[1][texel]});
                            });
        EXPECT_EQ(greens, (std::set<std::pair<bool, int>>{{false, 0}, {true, 255}})) << "by the place of the box";
        export_painted(folder / "out.glb", model, ink_on(model, "Hood", "decorated.1002"));
        EXPECT_THAT(read_model(folder / "out.glb").group_names, ElementsAre("Hood"));
    }
}

// Where another program took a primitive away, a list of names says nothing of the others.
TEST(PartsOfNodes, HaveTheirOwnNamesWhereThoseOfAnExportAreNotOneEach) {
    const Folder folder("fewer");
    write_blender(folder / "in.glb", {"Roof", "Lid", "Sill"});
    EXPECT_THAT(read_model(folder / "in.glb").group_names,
                ElementsAre("Hood", "Door / Paint", "Door / Glass", "Tyre", "Window", "Tyre 2"));
}

// What a part of glTF is called is no group: "Door / Paint" would become "Door / Door / Paint / decorated".
TEST(PartsOfNodes, AreNotGroupsInObj) {
    const Folder folder("obj");
    write_blender(folder / "in.glb", {"Door / Paint", "Door / Glass"});
    const stroke::Model model = model_of(read_model(folder / "in.glb"));
    export_painted(folder / "out.obj", model, ink_on(model, "Door", "Paint"));
    const std::vector<char> text = read_file(folder / "out.obj");
    EXPECT_EQ(std::string(text.begin(), text.end()).find("\ng "), std::string::npos);
}

// Another program leaves out what an export says of names.
TEST(PartsOfNodes, AllPaintedAreStillOneEach) {
    const Folder folder("painted");
    put(folder / "m.obj",
        "v 0 0 0\nv 100 0 0\nv 0 100 0\nv 200 0 0\nv 300 0 0\nv 200 100 0\no Lid\nusemtl a\nf 1 2 3\no Pot\nusemtl "
        "b\nf 4 5 6\n");
    const stroke::Model model = model_of(read_model(folder / "m.obj"), 1e-3);
    export_model(folder / "out.gltf", *model.mesh, model.atlas, pattern_maps(256, true),
                 {.painted = std::vector<std::uint8_t>{1, 1}});
    EXPECT_EQ(read_model(folder / "out.gltf").group_names, model.mesh->group_names);
    const std::vector<char> text = read_file(folder / "out.gltf");
    json document = json::parse(text.begin(), text.end());
    for (json& node : document["nodes"]) node.erase("extras");
    put(folder / "out.gltf", document.dump());
    EXPECT_THAT(read_model(folder / "out.gltf").group_names, ElementsAre("Lid", "Pot"));
}

// Groups of colours, and projects made before scenes were kept.
TEST(PartsOfGroups, AreNodesWithTheirColours) {
    const Folder folder("groups");
    put(folder / "m.off",
        "OFF\n6 2 0\n0 0 0\n100 0 0\n0 100 0\n200 0 0\n300 0 0\n200 100 0\n3 0 1 2 255 0 51\n3 3 4 "
        "5 0 102 0\n");
    const stroke::Model model = model_of(read_model(folder / "m.off"), 1e-3);
    const std::vector<std::uint8_t> painted{1, 0};
    const ModelMaps maps = pattern_maps(256, true);
    export_model(folder / "out.glb", *model.mesh, model.atlas, maps, {.painted = painted});
    const json j = glb_json(folder / "out.glb");
    EXPECT_THAT(names_in(j["nodes"]), ElementsAre("#ff0033", "#006600"));
    EXPECT_NEAR(material_named(j, "#006600")["pbrMetallicRoughness"]["baseColorFactor"][1], 0.1329, 1e-3)
        << "linear of 102 / 255";
    EXPECT_NE(material_named(j, "decorated"), json());
    export_model(folder / "out.obj", *model.mesh, model.atlas, maps, {.painted = painted});
    EXPECT_THAT(read_model(folder / "out.obj").group_names,
                ElementsAre("out / _ff0033 / decorated", "out / _006600 / _006600"))
        << "a # begins a comment";
}

}  // namespace
}  // namespace tuft::io
