#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "paths.h"
#include "program.h"

namespace tuft::test {
namespace {

using nlohmann::json;

class Commands : public Program {};

TEST_F(Commands, PaintLeavesProjectModelAndPicture) {
    write("s.inkml", stroke_file());
    const Ran ran =
        tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --atlas-size 512 --project " +
             path("p.tuft") + " -o " + path("m.glb") + " --preview " + path("v.png") + " --size 160x90 --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json j = json::parse(ran.out);
    EXPECT_EQ(j["strokes"].size(), 1u);
    EXPECT_TRUE(j["strokes"][0]["touched"]);
    EXPECT_GT(j["stamps"], 10);
    EXPECT_EQ(read(path("m.glb")).substr(0, 4), "glTF");
    EXPECT_EQ(read(path("v.png")).substr(1, 3), "PNG");
    EXPECT_TRUE(ran.err.empty()) << ran.err;  // no progress where there is no terminal
}

TEST_F(Commands, CountsOfOneAreSingular) {
    write("s.inkml", stroke_file());
    const Ran unwrapped = tuft("unwrap " + model("sheet.ply") + " -o " + path("m.obj") + " --atlas-size 256");
    const Ran painted = tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") +
                             " --atlas-size 256 --project " + path("p.tuft"));
    const Ran inspected = tuft("inspect " + path("p.tuft")), replayed = tuft("replay " + path("p.tuft"));
    EXPECT_EQ(unwrapped.out.substr(0, 11), "1 chart at ") << unwrapped.out;
    for (const std::string& out : {painted.out, inspected.out, replayed.out}) {
        EXPECT_NE(out.find("1 stroke"), std::string::npos) << out;
        EXPECT_EQ(out.find("1 strokes"), std::string::npos) << out;
        EXPECT_EQ(out.find(" 1 charts"), std::string::npos) << out;
    }
}

TEST_F(Commands, ReplayMakesTheSameTexelsForAnyThreadCount) {
    write("s.inkml", stroke_file());
    const Ran painted = tuft("paint " + model("sphere.ply") + " --strokes " + path("s.inkml") +
                             " --place 0,0,100 --atlas-size 1024 --project " + path("p.tuft") + " --json --threads 1");
    ASSERT_EQ(painted.status, 0) << painted.err;
    const std::string hash = json::parse(painted.out)["canvas_hash"];
    for (const char* threads : {"1", "2", "8"}) {
        const Ran replayed = tuft("replay " + path("p.tuft") + " --json --threads " + threads);
        ASSERT_EQ(replayed.status, 0) << replayed.err;
        EXPECT_EQ(json::parse(replayed.out)["canvas_hash"], hash) << threads << " threads";
    }
}

TEST_F(Commands, APreparedModelIsStoredOnceAndPaintsTheSameTexels) {
    write("s.inkml", stroke_file());
    const std::string cache = "export XDG_CACHE_HOME='" + path("cache") + "';";
    const auto painted = [&](const std::string& options) {
        const Ran ran = tuft("paint " + model("sphere.ply") + " --strokes " + path("s.inkml") +
                                 " --place 0,0,100 --atlas-size 512 --json " + options,
                             cache);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(ran.out).at("canvas_hash").get<std::string>();
    };
    const auto entries = [&] {
        const std::filesystem::path folder = std::filesystem::path(path("cache")) / "tuft" / "models";
        return std::filesystem::exists(folder)
                   ? std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator())
                   : 0;
    };
    const std::string hash = painted("--no-cache");
    EXPECT_EQ(entries(), 0);
    EXPECT_EQ(painted(""), hash);
    EXPECT_EQ(entries(), 1);
    EXPECT_EQ(painted("--threads 2"), hash);
    EXPECT_EQ(entries(), 1);
}

TEST_F(Commands, ReplayTakesAnotherSizeInkAndModel) {
    write("s.inkml", stroke_file());
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --atlas-size 256 --project " +
                   path("p.tuft"))
                  .status,
              0);
    const Ran larger =
        tuft("replay " + path("p.tuft") + " --atlas-size 512 --ink cinnabar --project " + path("q.tuft") + " --json");
    ASSERT_EQ(larger.status, 0) << larger.err;
    EXPECT_EQ(json::parse(larger.out)["atlas"]["size"], 512);
    const Ran inspected = tuft("inspect " + path("q.tuft") + " --json");
    ASSERT_EQ(inspected.status, 0) << inspected.err;
    EXPECT_EQ(json::parse(inspected.out)["strokes"][0]["ink"], "cinnabar");
    const Ran revised = tuft("replay " + path("p.tuft") + " --model " + model("thin_plate.ply") + " --json");
    ASSERT_EQ(revised.status, 0) << revised.err;
    EXPECT_EQ(json::parse(revised.out)["missed"], 0);
}

TEST_F(Commands, InkIsOverTheModelsOwnColoursUnlessPlain) {
    const std::string faces = "3 0 1 2\n3 0 2 3\n";
    const auto ply = [&](const std::string& properties, const std::string& colour) {
        std::string text =
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
            properties + "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
        for (const char* point : {"-100 -100 0", "100 -100 0", "100 100 0", "-100 100 0"})
            text += point + colour + "\n";
        return text + faces;
    };
    write("grey.ply", ply("", ""));
    write("red.ply", ply("property uchar red\nproperty uchar green\nproperty uchar blue\n", " 200 30 20"));
    write("s.inkml", stroke_file());
    const auto picture = [&](const std::string& source, const std::string& options, const std::string& shown = "") {
        EXPECT_EQ(tuft("paint " + path(source) + " --unit mm --strokes " + path("s.inkml") +
                       " --atlas-size 256 --project " + path("p.tuft") + options)
                      .status,
                  0);
        EXPECT_EQ(tuft("export " + path("p.tuft") + " -o " + path("m.png") + shown).status, 0);
        return read(path("m.png"));
    };
    const std::string grey = picture("grey.ply", ""), red = picture("red.ply", "");
    EXPECT_NE(red, grey);
    EXPECT_EQ(picture("red.ply", " --plain"), grey);
    EXPECT_EQ(picture("red.ply", "", " --substrate porcelain"), grey) << "another material is seen whole";
    ASSERT_EQ(tuft("replay " + path("p.tuft") + " --project " + path("q.tuft")).status, 0);
    ASSERT_EQ(tuft("export " + path("q.tuft") + " -o " + path("m.png")).status, 0);
    EXPECT_EQ(read(path("m.png")), red);
}

TEST_F(Commands, ExportWritesModelAndMaps) {
    write("s.inkml", stroke_file());
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --atlas-size 256 --project " +
                   path("p.tuft"))
                  .status,
              0);
    for (const char* name : {"a.glb", "a.gltf", "a.obj", "a.png", "a.exr"}) {
        const Ran ran = tuft("export " + path("p.tuft") + " -o " + path(name));
        EXPECT_EQ(ran.status, 0) << name << ": " << ran.err;
        EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
    }
}

TEST_F(Commands, ExportWritesEveryMap) {
    write("s.inkml", stroke_file());
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --atlas-size 256 --project " +
                   path("p.tuft"))
                  .status,
              0);
    for (const char* map : {"base-colour", "normal", "height", "roughness", "pigments"})
        for (const char* extension : {".png", ".exr"}) {
            const std::string file = path(std::string("m") + map + extension);
            const Ran ran = tuft("export " + path("p.tuft") + " -o " + file + " --map " + map);
            const bool possible = std::string(map) != "pigments" || std::string(extension) == ".exr";
            EXPECT_EQ(ran.status, possible ? 0 : 2) << file << ": " << ran.err;
            EXPECT_EQ(std::filesystem::exists(file), possible) << file;
        }
    // The file's name says which map, when it is the name of one.
    ASSERT_EQ(tuft("export " + path("p.tuft") + " -o " + path("height.exr")).status, 0);
    EXPECT_EQ(read(path("height.exr")), read(path("mheight.exr")));
    EXPECT_EQ(tuft("export " + path("p.tuft") + " -o " + path("m.glb") + " --map height").status, 2);
}

TEST_F(Commands, RecolouringChangesColoursButNoAmount) {
    write("s.inkml", stroke_file());
    const Ran painted = tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") +
                             " --ink carbon --atlas-size 256 --project " + path("p.tuft") + " --json");
    ASSERT_EQ(painted.status, 0) << painted.err;
    const std::string hash = json::parse(painted.out)["canvas_hash"];
    const auto colour = [&](const std::string& project, const std::string& options) {
        const Ran ran = tuft("export " + path(project) + " -o " + path("c.exr") + " --json " + options);
        EXPECT_EQ(ran.status, 0) << ran.err;
        EXPECT_EQ(json::parse(ran.out)["canvas_hash"], hash) << options;
        return read(path("c.exr"));
    };
    const std::string black = colour("p.tuft", ""), red = colour("p.tuft", "--recolour carbon=cinnabar"),
                      on_clay = colour("p.tuft", "--substrate clay"),
                      both = colour("p.tuft", "--substrate clay --recolour carbon=cinnabar");
    EXPECT_NE(red, black);
    EXPECT_NE(on_clay, black);
    EXPECT_NE(both, on_clay);
    EXPECT_EQ(colour("p.tuft", "--recolour carbon=carbon --substrate porcelain"), black);
    // Kept in a project, the look stays a look: what is painted is as before, however often.
    const Ran kept = tuft("replay " + path("p.tuft") + " --substrate clay --recolour carbon=cinnabar --project " +
                          path("q.tuft") + " --json");
    ASSERT_EQ(kept.status, 0) << kept.err;
    EXPECT_EQ(json::parse(kept.out)["canvas_hash"], hash);
    EXPECT_EQ(colour("q.tuft", ""), both);
    const Ran again = tuft("replay " + path("q.tuft") + " --project " + path("r.tuft") + " --json");
    EXPECT_EQ(json::parse(again.out)["canvas_hash"], hash);
    EXPECT_EQ(colour("r.tuft", ""), both);
    EXPECT_EQ(colour("r.tuft", "--recolour carbon=carbon --substrate porcelain"), black) << "and back";
    const Ran unknown = tuft("export " + path("p.tuft") + " -o " + path("c.png") + " --recolour cobalt=carbon");
    EXPECT_EQ(unknown.status, 1);
    EXPECT_EQ(unknown.error_lines(), 1) << unknown.err;
    EXPECT_EQ(tuft("export " + path("p.tuft") + " -o " + path("c.png") + " --recolour carbon").status, 2);
}

TEST_F(Commands, UnwrapReportsItsFigures) {
    const Ran ran = tuft("unwrap " + model("torus.ply") + " -o " + path("t.obj") + " --atlas-size 1024 --picture " +
                         path("t.png") + " --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json j = json::parse(ran.out)["atlas"];
    EXPECT_EQ(j["flips"], 0);
    EXPECT_EQ(j["overlapping_texels"], 0);
    EXPECT_EQ(j["roomless_triangles"], 0);
    const Ran kept = tuft("unwrap " + path("t.obj") + " -o " + path("u.obj") + " --keep-uv --atlas-size 1024 --json");
    ASSERT_EQ(kept.status, 0) << kept.err;
    EXPECT_TRUE(json::parse(kept.out)["atlas"]["uvs_from_file"]);
}

TEST_F(Commands, BrushPrintsItsTableAndListsItself) {
    const Ran list = tuft("brush --json");
    ASSERT_EQ(list.status, 0) << list.err;
    EXPECT_GE(json::parse(list.out)["brushes"].size(), 9u);
    const Ran table = tuft("brush wolf --json --picture " + path("b.png") + " --sweep-depth " + path("b.csv"));
    ASSERT_EQ(table.status, 0) << table.err;
    double last = -1;
    for (const json& row : json::parse(table.out)["rows"]) {
        EXPECT_GT(row["moment_mNm"], last);  // the table rises
        last = row["moment_mNm"];
    }
    EXPECT_TRUE(read(path("b.csv")).starts_with("z_mm,width_mm,drag_mm,offset_mm\n"));
    ASSERT_EQ(tuft("brush wolf*0.1 --sweep-depth " + path("fine.csv")).status, 0);
    EXPECT_EQ(std::ranges::count(read(path("fine.csv")), char(10)), 12) << "a tenth of the working depth to the next";
}

TEST_F(Commands, BrushComparesItsSpineMethodsWithAMeasuredBrush) {
    const std::string measured = source_folder() + "/tests/data/brush/brush_robot2020_even.csv";
    const Ran ran = tuft("brush robot-2020 --compare " + measured + " --json --picture " + path("c.png"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json models = json::parse(ran.out)["models"];
    constexpr const char* kSpines[] = {"rod", "table", "macro", "chain", "truss"};
    ASSERT_EQ(models.size(), std::size(kSpines));
    for (std::size_t m = 0; m < models.size(); ++m) {
        EXPECT_EQ(models[m]["spine"], kSpines[m]);
        EXPECT_EQ(models[m]["rows"].size(), 7u) << "0 to 12 mm by 2";
        // The rod was fitted to this table.
        if (m == 0) continue;
        EXPECT_GT(models[m]["rms"]["offset_mm"], models[0]["rms"]["offset_mm"]);
    }
    EXPECT_GT(read(path("c.png")).size(), 10'000u);
    const Ran text = tuft("brush robot-2020 --compare " + measured);
    ASSERT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("rms difference"), std::string::npos);
}

// A brush that only some models bend was refused by a key of its file; a blade and a geometry did not fit hair as long
// as the measured brush's.
TEST_F(Commands, BrushComparesTheSpineMethodsThatCanBendIt) {
    write("few.csv", "# hair (tip) length 30 mm\nz_mm,width_mm,drag_mm,offset_mm\n3,3,3,2\n");
    const std::vector<std::string> all{"rod", "table", "macro", "chain", "truss"}, flat{"rod", "chain", "truss"};
    for (const auto& [brush, spines] : {std::pair{"goat-small", all},
                                        {"bright-12", flat},
                                        {"filbert-12", flat},
                                        {"sword-8", {"rod"}},
                                        {"sponge-30", {"rod"}},
                                        {"leaf-28", {"rod"}}}) {
        const Ran ran = tuft("brush " + std::string(brush) + " --compare " + path("few.csv") + " --json");
        ASSERT_EQ(ran.status, 0) << brush << ran.err;
        std::vector<std::string> compared;
        const json out = json::parse(ran.out);
        EXPECT_EQ(out["brush"], brush);
        for (const json& model : out["models"]) {
            compared.push_back(model["spine"]);
            EXPECT_TRUE(model["rows"][0]["width_mm"].is_number()) << brush;
        }
        EXPECT_EQ(compared, spines) << brush;
    }
    // In that size the end of its hair would be wider than a preset may state.
    write("long.csv", "# hair (tip) length 50 mm\nz_mm,width_mm,drag_mm,offset_mm\n3,3,3,2\n");
    EXPECT_EQ(tuft("brush stippler-10 --compare " + path("long.csv")).status, 0);
}

TEST_F(Commands, APersistentBrushReplaysTheSame) {
    // Three strokes beside each other; before the third the brush is dipped into another ink.
    std::string ink = stroke_file();
    const std::size_t at = ink.find("<trace>"), end = ink.find("</trace>") + 8;
    const std::string trace = ink.substr(at, end - at);
    std::string annotated = trace;
    annotated.insert(7, "<annotation type=\"tuft:reshape\"/><annotation type=\"tuft:dip\">cinnabar</annotation>");
    write("s.inkml", ink.substr(0, at) + trace + trace + annotated + ink.substr(end));
    const std::string common =
        "paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --atlas-size 256 --json";
    const Ran carried = tuft(common + " --dip persistent --project " + path("p.tuft"));
    ASSERT_EQ(carried.status, 0) << carried.err;
    const json j = json::parse(carried.out);
    ASSERT_EQ(j["strokes"].size(), 3u);
    EXPECT_NE(j["canvas_hash"], json::parse(tuft(common).out)["canvas_hash"]) << "a fresh brush each time";
    const Ran replayed = tuft("replay " + path("p.tuft") + " --json");
    ASSERT_EQ(replayed.status, 0) << replayed.err;
    EXPECT_EQ(json::parse(replayed.out)["canvas_hash"], j["canvas_hash"]);
    EXPECT_EQ(json::parse(replayed.out)["strokes"], 3);
    const json entries = json::parse(tuft("inspect " + path("p.tuft") + " --json").out)["strokes"];
    ASSERT_EQ(entries.size(), 5u);
    EXPECT_EQ(entries[2]["action"], "reshape");
    EXPECT_EQ(entries[3]["action"], "dip");
    EXPECT_EQ(entries[3]["ink"], "cinnabar");
}

// A wavy line without pressure; `slant` leans it, `width` of the path in mm.
std::string plain_pen(double slant, bool with_pressure, double pressure = 0.5) {
    std::ostringstream ink;
    ink << "<ink><traceFormat><channel name=\"X\" type=\"decimal\" units=\"mm\"/>"
           "<channel name=\"Y\" type=\"decimal\" units=\"mm\"/>";
    if (with_pressure) ink << "<channel name=\"P\" type=\"decimal\" min=\"0\" max=\"1\"/>";
    ink << "<channel name=\"T\" type=\"decimal\" units=\"ms\"/></traceFormat>";
    for (int stroke = 0; stroke < 4; ++stroke) {
        ink << "<trace>";
        for (int i = 0; i <= 60; ++i) {
            const double u = i / 60.0, x = 10 * u - 5 + stroke, y = (stroke - 1.5) * 4 * u * u - 2 * u;
            ink << (i ? ", " : "") << x + slant * y << ' ' << y;
            if (with_pressure) ink << ' ' << pressure;
            ink << ' ' << 10 * i;
        }
        ink << "</trace>";
    }
    return ink.str() + "</ink>";
}

TEST_F(Commands, AHandWithoutPressureGetsItWhenAsked) {
    write("plain.inkml", plain_pen(0, false));
    write("pressed.inkml", plain_pen(0, true));
    const auto hash = [&](const std::string& file, const std::string& more) {
        const Ran ran = tuft("paint " + model("sheet.ply") + " --place 0,0,0 --strokes " + path(file) +
                             " --brush wolf-small --atlas-size 256 --json --project " + path("p.tuft") + " " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        const std::string painted = json::parse(ran.out)["canvas_hash"];
        EXPECT_EQ(json::parse(tuft("replay " + path("p.tuft") + " --json").out)["canvas_hash"], painted) << more;
        return painted;
    };
    const std::string plain = hash("plain.inkml", "");
    EXPECT_NE(hash("plain.inkml", "--pressure speed"), plain);
    EXPECT_NE(hash("plain.inkml", "--pressure speed+dwell"), hash("plain.inkml", "--pressure speed"));
    EXPECT_NE(hash("plain.inkml", "--stabilise 2 --smooth 1"), plain);
    // A pen that has pressure keeps it.
    EXPECT_EQ(hash("pressed.inkml", "--pressure speed"), hash("pressed.inkml", ""));
    EXPECT_EQ(tuft("paint a.ply --strokes b.inkml --pressure guess").status, 2);
    EXPECT_EQ(tuft("paint a.ply --strokes b.inkml --stabilise -1").status, 2);
}

TEST_F(Commands, AWideFerruleRollsAsToldAndReplaysTheSame) {
    write("short.inkml",
          "<ink><traceFormat><channel name='X'/><channel name='Y'/><channel name='P' max='1'/><channel name='T'/>"
          "</traceFormat><trace>0 0 0.5 0, 2 0 0.5 40, 4 0 0.5 80, 6 1 0.5 120</trace></ink>");
    const auto hash = [&](const std::string& more) {
        const Ran ran = tuft("paint " + model("sheet.ply") + " --place 0,0,0 --strokes " + path("short.inkml") +
                             " --brush flat-12*0.3 --atlas-size 512 --json --project " + path("p.tuft") + " " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        const std::string painted = json::parse(ran.out)["canvas_hash"];
        EXPECT_EQ(json::parse(tuft("replay " + path("p.tuft") + " --json").out)["canvas_hash"], painted) << more;
        return painted;
    };
    const std::string plain = hash("--roll 0"), turned = hash("--roll 60"), follows = hash("--roll-follow");
    EXPECT_NE(turned, plain);
    EXPECT_NE(follows, plain);
    EXPECT_NE(follows, turned);
    EXPECT_EQ(tuft("paint a.ply --strokes b.inkml --roll 400").status, 2);
    EXPECT_EQ(tuft("paint a.ply --strokes b.inkml --roll east").status, 2);
}

TEST_F(Commands, AWritersBiasIsLearnedAndCorrected) {
    write("meant.inkml", plain_pen(0, true, 0.5));
    write("written.inkml", plain_pen(-0.3, true, 0.4));
    const Ran learned =
        tuft("bias " + path("meant.inkml") + " " + path("written.inkml") + " -o " + path("h.toml") + " --json");
    ASSERT_EQ(learned.status, 0) << learned.err;
    const json j = json::parse(learned.out);
    EXPECT_NEAR(j["pressure_ratio"].get<double>(), 1.25, 0.01);
    EXPECT_NEAR(j["linear"][0][1].get<double>(), 0.3, 0.02);  // the pull to the identity
    const auto ink_of = [&](const std::string& file, const std::string& more) {
        const Ran ran = tuft("paint " + model("sheet.ply") + " --place 0,0,0 --strokes " + path(file) +
                             " --brush wolf-small --atlas-size 256 --json " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(ran.out)["ink_mm3"].get<double>();
    };
    const double meant = ink_of("meant.inkml", ""), written = ink_of("written.inkml", "");
    const double corrected = ink_of("written.inkml", "--bias " + path("h.toml"));
    EXPECT_LT(std::abs(corrected - meant), 0.2 * std::abs(written - meant));
    write("one.inkml", plain_pen(0, true).substr(0, plain_pen(0, true).find("</trace>")) + "</trace></ink>");
    const Ran bad = tuft("bias " + path("one.inkml") + " " + path("written.inkml") + " -o " + path("x.toml"));
    EXPECT_EQ(bad.status, 1);
    EXPECT_EQ(std::count(bad.err.begin(), bad.err.end(), '\n'), 1) << bad.err;
    EXPECT_FALSE(std::filesystem::exists(path("x.toml")));
}

TEST_F(Commands, ForcesAreATableOfNumbers) {
    write("s.inkml", stroke_file());
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --atlas-size 256 --forces " +
                   path("f.csv"))
                  .status,
              0);
    std::istringstream csv(read(path("f.csv")));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line,
              "stroke,time_s,x_m,y_m,z_m,qw,qx,qy,qz,force_x_N,force_y_N,force_z_N,"
              "hand_x_N,hand_y_N,hand_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,moment_Nm");
    int rows = 0;
    double last = -1;
    while (std::getline(csv, line)) {
        ++rows;
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 18);
        const double time = std::stod(line.substr(line.find(',') + 1));
        EXPECT_GE(time, last);
        last = time;
    }
    EXPECT_GT(rows, 20);
    // A row for each sample of the hand: the size of a texel has no part in it.
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --atlas-size 512 --forces " +
                   path("fine.csv"))
                  .status,
              0);
    const std::string fine = read(path("fine.csv"));
    EXPECT_EQ(std::count(fine.begin(), fine.end(), '\n'), rows + 1);
}

TEST_F(Commands, APlacementInsideASolidIsReported) {
    const std::string head = "<ink xmlns='http://www.w3.org/2003/InkML'>",
                      channels =
                          "<channel name='X' type='decimal' units='mm'/><channel name='Y' type='decimal' units='mm'/>";
    // In space, from outside the sphere of 100 mm into its middle.
    write("into.inkml", head + "<traceFormat>" + channels +
                            "<channel name='Z' type='decimal' units='mm'/></traceFormat>"
                            "<annotation type='tuft:brush'>wolf-small</annotation><trace>0 0 130, 0 0 110, 0 0 90, 0 0 "
                            "60</trace></ink>");
    const Ran into = tuft("paint " + model("sphere.ply") + " --atlas-size 256 --forces " + path("f.csv") +
                          " --strokes " + path("into.inkml"));
    EXPECT_EQ(into.status, 0) << into.err;
    EXPECT_NE(into.err.find("ferrule into the model"), std::string::npos) << into.err;
    std::istringstream csv(read(path("f.csv")));
    std::string line;
    std::getline(csv, line);
    while (std::getline(csv, line)) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields(line);
        double x, force[3];
        for (int i = 0; i < 9; ++i) fields >> x;
        fields >> force[0] >> force[1] >> force[2];
        EXPECT_LT(std::hypot(force[0], force[1], force[2]), 60) << line;
    }
    // Flat, by the file and by the command line.
    write("flat.inkml",
          head + "<traceFormat>" + channels +
              "</traceFormat><annotation type='tuft:origin'>0 -20 50</annotation>"
              "<annotation type='tuft:brush'>wolf-small</annotation><trace>0 0, 10 0, 20 2</trace></ink>");
    const Ran flat = tuft("paint " + model("sphere.ply") + " --atlas-size 256 --strokes " + path("flat.inkml"));
    EXPECT_NE(flat.err.find("mm inside the model"), std::string::npos) << flat.err;
    const Ran placed =
        tuft("paint " + model("sphere.ply") + " --atlas-size 256 --place 0,-20,50 --strokes " + path("flat.inkml"));
    EXPECT_NE(placed.err.find("--place 0,-20,50 lies"), std::string::npos) << placed.err;
    // As many strokes as there are, in one line.
    write("many.inkml", head + "<traceFormat>" + channels +
                            "</traceFormat><annotation type='tuft:origin'>0 -20 50</annotation>"
                            "<annotation type='tuft:brush'>wolf-small</annotation><trace>0 0, 10 0</trace><trace>0 5, "
                            "10 5</trace><trace>0 9, 10 9</trace></ink>");
    const Ran many = tuft("paint " + model("sphere.ply") + " --atlas-size 256 --strokes " + path("many.inkml"));
    EXPECT_NE(many.err.find("the place of 3 strokes, the first stroke 1, lies up to 29.98 mm inside the model"),
              std::string::npos)
        << many.err;
    EXPECT_EQ(std::count(many.err.begin(), many.err.end(), '\n'), 1) << many.err;
    // A place that is rounded to the millimetre is what a person reads off the model.
    const Ran rounded =
        tuft("paint " + model("sphere.ply") + " --atlas-size 256 --place 0,-49.3,50 --strokes " + path("flat.inkml"));
    EXPECT_EQ(rounded.err.find("inside"), std::string::npos) << rounded.err;
    const Ran on =
        tuft("paint " + model("sphere.ply") + " --atlas-size 256 --place 0,-50,50 --strokes " + path("flat.inkml"));
    EXPECT_EQ(on.err.find("inside"), std::string::npos) << on.err;
}

TEST_F(Commands, RenderDrawsATurntable) {
    const Ran ran = tuft("render " + model("torus.ply") + " -o " + path("r.png") + " --size 64x48 --turntable 3");
    ASSERT_EQ(ran.status, 0) << ran.err;
    for (const char* name : {"r-0.png", "r-1.png", "r-2.png"}) EXPECT_TRUE(std::filesystem::exists(path(name)));
}

TEST_F(Commands, EveryFinishedStrokeSurvivesAKill) {
    std::string many = stroke_file();
    const std::size_t at = many.find("<trace>"), end = many.find("</trace>") + 8;
    const std::string trace = many.substr(at, end - at);
    std::string traces;
    for (int i = 0; i < 400; ++i) traces += trace + "\n";
    many.replace(at, end - at, traces);
    write("many.inkml", many);
    // Kill it in the middle: when the project has grown by some strokes, however long that takes.
    const std::string project = path("p.tuft");
    const std::string script = "export TUFT_DATA='" + source_folder() + "'\n'" + tuft_program() + "' paint '" +
                               model("sheet.ply") + "' --strokes '" + path("many.inkml") +
                               "' --atlas-size 1024 --threads 1 --project '" + project + "' >/dev/null 2>&1 &\n" +
                               "pid=$!; first=0\nwhile kill -0 $pid 2>/dev/null; do\n  size=$(stat -c %s '" + project +
                               "' 2>/dev/null || echo 0)\n  [ $first -eq 0 ] && first=$size\n"
                               "  [ $first -gt 0 ] && [ $size -gt $((first + 20000)) ] && break\n  sleep 0.01\ndone\n"
                               "kill -KILL $pid 2>/dev/null; wait $pid 2>/dev/null; true\n";
    ASSERT_EQ(std::system(("bash '" + write("kill.sh", script) + "'").c_str()), 0);
    const Ran inspected = tuft("inspect " + path("p.tuft") + " --json");
    ASSERT_EQ(inspected.status, 0) << inspected.err;
    const json strokes = json::parse(inspected.out)["strokes"];
    EXPECT_GT(strokes.size(), 0u);
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        EXPECT_EQ(strokes[i]["id"], i + 1);
        EXPECT_EQ(strokes[i]["samples"], 51);
    }
    EXPECT_EQ(tuft("replay " + path("p.tuft")).status, 0);
}

TEST_F(Commands, SampleStrokesFindTheirInksFromAnyFolder) {
    const std::string paint = " --strokes " + source_folder() + "/samples/strokes/vase-plum.inkml --atlas-size 256";
    const Ran ran = tuft("paint " + model("vase.ply") + paint, "cd '" + folder_.string() + "';");
    EXPECT_EQ(ran.status, 0) << ran.err;
    const Ran outside = tuft("paint " + model("vase.ply") + paint + " --ink samples/../../inks/none.toml",
                             "cd '" + folder_.string() + "';");
    EXPECT_EQ(outside.status, 1);
    EXPECT_NE(outside.err.find("samples/../../inks/none.toml: no such file"), std::string::npos) << outside.err;
}

TEST_F(Commands, AReportOfTheBenchmarkIsRefusedBeforeItMeasures) {
    write("other.json", "{\"format\": \"tuft variants 1\"}");
    write("deep.json", std::string(5000, '['));
    for (const auto& [arguments, status] :
         std::vector<std::pair<std::string, int>>{{"--report " + path("a.txt"), 2},
                                                  {"--report " + path("none/a.html"), 1},
                                                  {"--report " + path("a.md") + " --against " + path("none.json"), 1},
                                                  {"--report " + path("a.md") + " --against " + path("other.json"), 1},
                                                  {"--report " + path("a.md") + " --against " + path("deep.json"), 1},
                                                  {"--against " + path("other.json"), 2},
                                                  {"--scaling 0,1", 2},
                                                  {"--scaling 1,2 --report " + path("a.html"), 2}}) {
        const Ran ran = tuft("bench --quick " + arguments);
        EXPECT_EQ(ran.status, status) << arguments << ran.err;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
}

}  // namespace
}  // namespace tuft::test
