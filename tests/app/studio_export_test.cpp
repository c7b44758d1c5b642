#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "ink/composite/composite.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "studio_program.h"

/// \file
/// What the studio exports.
namespace tuft::app {
namespace {

TEST_F(StudioProgram, AnExportIsWhatItsPresetSays) {
    std::string script = kBowl + kTwoStrokes;
    const std::pair<const char*, const char*> presets[] = {
        {"Blender", "a.glb"},     {"Unreal", "b.glb"},    {"Unity", "c.gltf"},      {"Web", "d.glb"},
        {"Print proof", "e.obj"}, {"Strokes", "f.inkml"}, {"16-bit maps", "g.png"}, {"EXR maps", "h.exr"}};
    for (const auto& [preset, file] : presets)
        script += "key ctrl+e\nclick Preset\nwait 0.1\nclick \"" + std::string(preset) +
                  "\"\nwait 0.1\nclick \"Choose a file...\"\nwait 0.1\nkey ctrl+a\ntype " +
                  path(fs::path(file).stem()) + "\nkey enter\nwait-ready\nexpect message " + path(file) + "\n";
    const Ran ran = studio(script);
    ASSERT_EQ(ran.status, 0) << ran.err;
    for (const auto& [preset, file] : presets) EXPECT_TRUE(fs::exists(path(file))) << preset;
    EXPECT_EQ(io::read_model(path("c.gltf")).n_polygons(), io::read_model(path("e.obj")).n_polygons());
    EXPECT_LT(fs::file_size(path("d.glb")), fs::file_size(path("a.glb")));
    // Of single maps the names say what they hold; both formats hold the same colours.
    for (const char* file :
         {"g_roughness.png", "g_normal.png", "g_height.png", "h_roughness.exr", "h_normal.exr", "h_height.exr"})
        EXPECT_TRUE(fs::exists(path(file))) << file;
    const io::Image16 encoded = io::read_image16(path("g.png"));
    const io::ImageF linear = io::read_image_float(path("h.exr"));
    ASSERT_EQ(encoded.pixels.size(), linear.pixels.size());
    double most = 0;
    std::set<std::uint16_t> values;
    for (std::size_t i = 0; i < linear.pixels.size(); ++i) {
        // EXR has half floats: 2^-11 of the value, of which the curve's slope leaves 0.45 · 65535 · 2^-11 steps, and
        // half a step.
        most = std::max(
            most, std::abs(65535.0 * static_cast<double>(ink::srgb_encode(linear.pixels[i])) - encoded.pixels[i]));
        values.insert(encoded.pixels[i]);
    }
    EXPECT_LT(most, 15);
    EXPECT_GT(values.size(), 256u) << "no more than eight bits";
}

TEST_F(StudioProgram, AnExportAtAnotherSizeIsPaintedAnew) {
    const Ran ran = studio(kBowl + kTwoStrokes +
                           "set export-size 256\nset export-pictures 1\nset export-picture-width 96\nexport "
                           "small.obj\nwait-ready\nexpect message Exported\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(fs::exists(path("small.picture.png")));
    bool found = false;
    for (const auto& entry : fs::directory_iterator(folder_))
        if (entry.path().filename().string().find("colour") != std::string::npos) {
            found = true;
            EXPECT_EQ(io::read_image8(entry.path(), 1 << 24).width, 256);
        }
    EXPECT_TRUE(found);
}

}  // namespace
}  // namespace tuft::app
