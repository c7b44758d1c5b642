#include "io/model/read_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "core/error.h"
#include "core/files/extension.h"
#include "core/files/files.h"
#include "core/manual/manual.h"
#include "io/export/export.h"
#include "sample_model.h"

namespace tuft::io {
namespace {

using namespace testing;

TEST(ReadModel, ObjReadBackIsTheSameMeshInTheGivenUnit) {
    const Folder folder("obj");
    const mesh::TriangleMesh mesh = cylinder();
    const ModelMaps maps = pattern_maps(64);
    for (const auto& [unit, metres] : {std::pair{"mm", 1e-3}, std::pair{"in", 0.0254}, std::pair{"m", 1.0}}) {
        export_model(folder / "m.obj", mesh, cylinder_atlas(mesh), maps, {.frame = {.unit = unit}});
        const mesh::PolygonSoup soup = read_model(folder / "m.obj");
        expect_same(soup, mesh, metres, 0);
        EXPECT_EQ(soup.points.size(), mesh.n_vertices()) << "vertices stay as they are";
    }
    EXPECT_EQ(folder.n_files(), exported_files(folder / "m.obj", maps).size());
}

TEST(ReadModel, FormatsAreRecognisedByContentThenByExtension) {
    const Folder folder("formats");
    const mesh::TriangleMesh mesh = cylinder();
    export_model(folder / "m.glb", mesh, cylinder_atlas(mesh), pattern_maps(16));
    std::filesystem::rename(folder / "m.glb", folder / "m.obj");
    EXPECT_EQ(read_model(folder / "m.obj").n_polygons(), mesh.n_triangles()) << "a GLB under a wrong name";
    const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    write_file(folder / "m.txt", off.data(), off.size());
    EXPECT_EQ(read_model(folder / "m.txt").n_polygons(), 1u);
    const std::string text = "hello";
    write_file(folder / "hello.txt", text.data(), text.size());
    EXPECT_THROW(read_model(folder / "hello.txt"), Error);
    EXPECT_THROW(read_model(folder / "missing.obj"), Error);
    EXPECT_TRUE(states_unit("a/m.GLB"));
    EXPECT_FALSE(states_unit("m.obj"));
}

TEST(ReadModel, ShellsCompleteTheNamesOfAllFilesThatAreRead) {
    const std::vector<std::string> completed = file_extensions({.value = "FILE", .text = "mesh"});
    for (const std::string& extension : completed) EXPECT_TRUE(is_model_file("m." + extension)) << extension;
    std::istringstream formats(kModelFormats);  // each is also an extension
    for (std::string word; formats >> word;) {
        if (word == "and") continue;
        std::erase(word, ',');
        EXPECT_EQ(std::ranges::count(completed, lower_extension("m." + word).substr(1)), 1) << word;
    }
}

}  // namespace
}  // namespace tuft::io
