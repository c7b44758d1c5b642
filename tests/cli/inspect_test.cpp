#include <filesystem>
#include <nlohmann/json.hpp>

#include "program.h"

namespace tuft::test {
namespace {

using nlohmann::json;

class Inspect : public Program {};

TEST_F(Inspect, MeasuresUvsOfAModelAsUnwrapDoes) {
    const Ran bare = tuft("inspect " + model("torus.ply") + " --json");
    ASSERT_EQ(bare.status, 0) << bare.err;
    const json none = json::parse(bare.out);
    EXPECT_EQ(none["has_uvs"], false);
    EXPECT_TRUE(none.contains("atlas") && none["atlas"].is_null());
    EXPECT_TRUE(none.contains("uv_fault") && none["uv_fault"].is_null());
    EXPECT_NE(tuft("inspect " + model("torus.ply")).out.find("UVs: none"), std::string::npos);

    const Ran made = tuft("unwrap " + model("torus.ply") + " -o " + path("t.obj") + " --atlas-size 2048 --json");
    ASSERT_EQ(made.status, 0) << made.err;
    const json unwrapped = json::parse(made.out)["atlas"];
    const Ran inspected = tuft("inspect " + path("t.obj") + " --json");
    ASSERT_EQ(inspected.status, 0) << inspected.err;
    const json with = json::parse(inspected.out);
    EXPECT_EQ(with["has_uvs"], true);
    EXPECT_TRUE(with["uv_fault"].is_null()) << with["uv_fault"];
    for (const auto& [key, value] : unwrapped.items()) EXPECT_TRUE(with["atlas"].contains(key)) << key;
    for (const char* key :
         {"charts", "flips", "overlapping_texels", "roomless_triangles", "smallest_gap", "size", "udims", "pages"})
        EXPECT_EQ(with["atlas"][key], unwrapped[key]) << key;
    // The file has nine digits of floats and lengths in millimetres: 1e-6 of each figure.
    for (const char* key : {"seam_length", "l2_stretch", "linf_stretch", "angle_distortion", "area_distortion",
                            "utilisation", "texel_size_mm"})
        EXPECT_NEAR(with["atlas"][key].get<double>() / unwrapped[key].get<double>(), 1, 1e-5) << key;

    write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1e30 0\nvt 0 nan\nf 1/1 2/2 3/3\n");
    const Ran far = tuft("inspect " + path("far.obj") + " --json");
    ASSERT_EQ(far.status, 0) << far.err;
    EXPECT_TRUE(json::parse(far.out)["uv_fault"].is_string()) << far.out;
}

TEST_F(Inspect, ReportsWeaknessesOfValidUvs) {
    // Three squares of 10 mm: the second has a quarter of the first one's texels along a side and lies
    // 1.5 texels of 2048 beside it, the third, of 0.01 mm, has two texels.
    const auto square = [](double x, double side, double u, double v, double width, int first) {
        std::string text;
        for (int k = 0; k < 4; ++k) {
            const double i = k == 1 || k == 2, j = k > 1;
            text += "v " + std::to_string(x + side * i) + " " + std::to_string(side * j) + " 0\n";
            text += "vt " + std::to_string(u + width * i) + " " + std::to_string(v + width * j) + "\n";
        }
        text += "f";
        for (int k = 0; k < 4; ++k) text += " " + std::to_string(first + k) + "/" + std::to_string(first + k);
        return text + "\n";
    };
    const double gap = 1.5 / 2048;
    write("s.obj", square(0, 10, 0.1, 0.1, 0.2, 1) + square(20, 10, 0.3 + gap, 0.1, 0.05, 5) +
                       square(40, 0.01, 0.5, 0.5, 0.0007, 9));
    const json found = json::parse(tuft("inspect " + path("s.obj") + " --json").out);
    EXPECT_TRUE(found["uv_fault"].is_null()) << found["uv_fault"];
    ASSERT_EQ(found["uv_notes"].size(), 3u) << found["uv_notes"];
    EXPECT_NE(found["uv_notes"][0].get<std::string>().find("1 texel apart"), std::string::npos);
    EXPECT_EQ(found["uv_notes"][1].get<std::string>().find("1 of the charts"), 0u);
    // 10 mm over 0.2 and 0.05 of 2048 texels.
    EXPECT_NE(found["uv_notes"][2].get<std::string>().find("0.0244 to 0.0977 mm"), std::string::npos)
        << found["uv_notes"];

    write("far.obj", square(0, 10, 0.1, 0.1, 0.2, 1) + square(20, 10, 0.4, 0.1, 0.2, 5));
    EXPECT_EQ(json::parse(tuft("inspect " + path("far.obj") + " --json").out)["uv_notes"], json::array());
}

TEST_F(Inspect, UvsOnSeveralPagesAreKept) {
    const Ran made =
        tuft("unwrap " + model("bowl.ply") + " -o " + path("b.obj") + " --atlas-size 256 --pages 3 --json");
    ASSERT_EQ(made.status, 0) << made.err;
    const json first = json::parse(made.out)["atlas"];
    EXPECT_EQ(first["udims"], (json{1001, 1002, 1011}));
    const Ran again = tuft("unwrap " + path("b.obj") + " -o " + path("c.obj") + " --atlas-size 256 --keep-uv --json");
    ASSERT_EQ(again.status, 0) << again.err;
    const json second = json::parse(again.out)["atlas"];
    EXPECT_EQ(second["uvs_from_file"], true);
    for (const char* key : {"pages", "udims", "charts", "size", "flips", "overlapping_texels", "smallest_gap"})
        EXPECT_EQ(second[key], first[key]) << key;
    const auto uvs = [&](const char* file) {
        const std::string text = read(path(file));
        return text.substr(text.find("\nvt "), text.find("\nvn ") - text.find("\nvt "));
    };
    EXPECT_TRUE(uvs("b.obj") == uvs("c.obj"));  // to the last digit

    write("s.inkml", stroke_file("0 0 60"));
    const Ran painted = tuft("paint " + path("b.obj") + " --strokes " + path("s.inkml") +
                             " --atlas-size 256 --keep-uv --project " + path("p.tuft") + " --export " + path("e.obj"));
    ASSERT_EQ(painted.status, 0) << painted.err;
    EXPECT_TRUE(std::filesystem::exists(path("e_base_colour.1011.png")));
    const Ran larger = tuft("replay " + path("p.tuft") + " --atlas-size 512 --project " + path("q.tuft"));
    ASSERT_EQ(larger.status, 0) << larger.err;
    const json kept = json::parse(tuft("inspect " + path("q.tuft") + " --json").out)["atlas"];
    EXPECT_EQ(kept["udims"], first["udims"]);
    EXPECT_EQ(kept["size"], 512);
    EXPECT_EQ(kept["uvs_from_file"], true);

    std::string far = read(path("b.obj"));
    const std::size_t vt = far.find("\nvt ");
    far.replace(vt, far.find('\n', vt + 1) - vt, "\nvt 9.5 399.5");  // on page 5000
    const Ran refused = tuft("unwrap " + write("f.obj", far) + " -o " + path("g.obj") + " --keep-uv");
    EXPECT_EQ(refused.status, 1);
    EXPECT_EQ(refused.error_lines(), 1) << refused.err;
    EXPECT_NE(refused.err.find("cannot be kept"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(path("g.obj")));
}

}  // namespace
}  // namespace tuft::test
