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

/// Opens a dialog of the File menu, chooses a format and writes to a name.
std::string written_by(const std::string& dialog, const std::string& format, const std::string& name) {
    return "click File\nwait 0.1\nclick \"" + dialog + "\"\nwait 0.1\nclick Format\nwait 0.1\nclick " + format +
           "\nwait 0.1\nclick \"Choose a file...\"\nwait 0.1\nkey ctrl+a\ntype " + name + "\nkey enter\n";
}

TEST_F(StudioProgram, DecalSheetsAreWhatTheirDialogSays) {
    const Ran ran = studio(kBowl + kTwoStrokes + written_by("Decal sheets...", "PDF", path("a")) +
                           "wait-ready\nexpect message Pieces\n" + written_by("Decal sheets...", "SVG", path("b")) +
                           "wait-ready\nexpect message Pieces\n" + written_by("Decal sheets...", "DXF", path("c")) +
                           "wait-ready\nexpect message Pieces\n");
    ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
    EXPECT_TRUE(read(path("a.pdf")).starts_with("%PDF"));
    EXPECT_NE(read(path("b.svg")).find("width=\"210.0000mm\""), std::string::npos);
    EXPECT_NE(read(path("c.dxf")).find("CutContour"), std::string::npos);
}

TEST_F(StudioProgram, AFilmHasItsFramesAndEndsWithTheWork) {
    const Ran ran = studio(kBowl + kTwoStrokes + "set film-width 64\nset film-seconds 0.4\nsave work.tuft\n" +
                           written_by("Film...", "Pictures", path("frames")) + "wait-ready\nexpect message Exported\n");
    ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
    const auto frame = [&](int number) {
        char name[32];
        std::snprintf(name, sizeof name, "frames/frame-%05d.png", number);
        return read(path(name));
    };
    // 0.4 s of work and 2 s of its end, 25 frames a second.
    EXPECT_FALSE(frame(60).empty());
    EXPECT_TRUE(frame(61).empty());
    EXPECT_EQ(frame(60), frame(10));
    EXPECT_NE(frame(1), frame(10));
    // The work is as it was.
    EXPECT_EQ(tuft("inspect '" + path("work.tuft") + "' --json")["strokes"].size(), 2u);
}

TEST_F(StudioProgram, AFilmIsStoppedAndPaintingGoesOn) {
    const Ran ran =
        studio(kBowl + kTwoStrokes + "set film-seconds 3000\n" + written_by("Film...", "Pictures", path("frames")) +
               "wait 0.5\nclick Stop\nwait-ready\nexpect message Stopped\n"
               "stroke 46%,58% 50%,61%\nwait-ready\nexpect strokes 3\n");
    ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
    EXPECT_FALSE(fs::exists(path("frames")));
}

TEST_F(StudioProgram, NothingPaintedIsNeitherCutNorFilmed) {
    const Ran ran = studio(kBowl + written_by("Decal sheets...", "PDF", path("a")) +
                           "wait-ready\nexpect message \"nothing is painted\"\n" +
                           written_by("Film...", "Pictures", path("frames")) +
                           "wait-ready\nexpect message \"nothing is painted\"\n");
    ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
    EXPECT_FALSE(fs::exists(path("a.pdf")));
    EXPECT_FALSE(fs::exists(path("frames")));
}

}  // namespace
}  // namespace tuft::app
