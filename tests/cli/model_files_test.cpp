#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"

/// CAD files and large scans through the commands.
namespace tuft::test {
namespace {

using nlohmann::json;

class ModelFiles : public Program {
  protected:
    std::string corpus(const std::string& name) const { return source_folder() + "/tests/fuzz/corpus/" + name; }

    json run_json(const std::string& arguments) const {
        const Ran ran = tuft(arguments + " --json");
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(ran.out, nullptr, false);
    }
};

TEST_F(ModelFiles, CadIsInspectedWithItsUnitItsGroupsAndItsChord) {
    const json box = run_json("inspect " + corpus("stp/box.stp"));
    EXPECT_EQ(box["triangles"], 12);
    EXPECT_NEAR(box["area_cm2"].get<double>(), 22, 1e-4);  // 30 x 20 x 10 mm, in floats
    EXPECT_NEAR(box["size_mm"][0].get<double>(), 30, 1e-4);
    EXPECT_EQ(box["unit_note"], "as the file says") << "its numbers are no guess";
    EXPECT_EQ(run_json("inspect --groups faces " + corpus("stp/box.stp"))["groups"].size(), 6u);
    const json coarse = run_json("inspect --chord 0.01 " + corpus("igs/cylinder.igs"));
    const json fine = run_json("inspect --chord 0.0001 " + corpus("igs/cylinder.igs"));
    // The number of chords goes with the root of the tolerance, 10 times more: whole numbers, 70 at least.
    EXPECT_NEAR(fine["triangles"].get<double>() / coarse["triangles"].get<double>(), 10, 0.5);
}

TEST_F(ModelFiles, OptionsOfCadAreRefusedForOtherFiles) {
    for (const char* option : {"--chord 0.1", "--groups faces"}) {
        const Ran ran = tuft("inspect " + std::string(option) + " " + model("bowl.ply"));
        EXPECT_EQ(ran.status, 2) << option;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    EXPECT_EQ(tuft("inspect --chord 0 " + corpus("stp/box.stp")).status, 2);
    const Ran fine = tuft("inspect --chord 0.00001 " + corpus("stp/box.stp"));
    EXPECT_EQ(fine.status, 1);
    EXPECT_EQ(fine.error_lines(), 1) << fine.err;
}

TEST_F(ModelFiles, AUnitThatIsSaidGoesBeforeTheOneThatTheFileStates) {
    // 30 x 20 x 10, stated as millimetres.
    const Ran cad = tuft("inspect --json --unit in --up y " + corpus("stp/box.stp"));
    ASSERT_EQ(cad.status, 0) << cad.err;
    EXPECT_NEAR(json::parse(cad.out)["size_mm"][0].get<double>(), 30 * 25.4, 1e-3);
    for (const char* note : {"box.stp is read in inches (--unit), not in millimetres as it states: 25.4 times as large",
                             "--up is left aside: box.stp"})
        EXPECT_NE(cad.err.find(note), std::string::npos) << cad.err;
    const Ran plain = tuft("inspect --unit mm --up z " + model("bowl.ply"));
    EXPECT_EQ(plain.err, "");
    const Ran agrees = tuft("inspect --json --unit mm " + corpus("stp/box.stp"));
    EXPECT_EQ(agrees.err, "");
    EXPECT_EQ(json::parse(agrees.out)["unit_note"], "as the file says");
}

// A GLB whose numbers are millimetres: its project, and the next version of the file, are in millimetres too.
TEST_F(ModelFiles, AProjectKeepsTheUnitThatWasSaidOfItsModel) {
    ASSERT_EQ(tuft("unwrap " + model("sheet.ply") + " --unit m --atlas-size 256 -o " + path("wrong.glb")).status, 0);
    const std::string strokes = write("s.inkml", stroke_file("0 0 0"));
    const std::string paint = "paint " + path("wrong.glb") + " --strokes " + strokes + " --no-cache --atlas-size 256";
    ASSERT_EQ(tuft(paint + " --unit mm --project " + path("p.tuft")).status, 0);
    const Ran again = tuft("replay --json " + path("p.tuft") + " --model " + path("wrong.glb"));
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(json::parse(again.out)["fit"]["mismatches"], 0);
    EXPECT_NE(again.err.find("wrong.glb is read in millimetres (--unit), not in metres as it states"),
              std::string::npos)
        << again.err;
    // A unit that agrees with the file says nothing of the next one, nor does one of a format that states it.
    const std::string of_step =
        "paint " + corpus("stp/box.stp") + " --on top --atlas-size 256 --no-cache --strokes " + strokes + " --project ";
    ASSERT_EQ(tuft(of_step + path("stated.tuft") + " --unit mm").status, 0);
    const Ran revised = tuft("replay --json " + path("stated.tuft") + " --no-cache --model " + path("wrong.glb"));
    EXPECT_EQ(revised.err.find("as it states"), std::string::npos) << revised.err;
    const Ran stated = tuft("replay --json " + path("p.tuft") + " --unit m --model " + path("wrong.glb"));
    EXPECT_EQ(stated.err.find("as it states"), std::string::npos) << stated.err;
}

TEST_F(ModelFiles, AnAssemblyIsPaintedAndKeepsItsNamesAndColoursInGlb) {
    const std::string strokes = write("s.inkml", stroke_file("10 -4 0"));
    const Ran ran = tuft("paint " + corpus("stp/wheels.stp") + " --strokes " + strokes +
                         " --atlas-size 512 --no-cache --export " + path("out.glb"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    const std::string glb = read(path("out.glb"));
    for (const char* name : {"\"wheel\"", "\"wheel 2\"", "\"#cc190d\""})
        EXPECT_NE(glb.find(name), std::string::npos) << name;
}

TEST_F(ModelFiles, AWorkingCopyHasFewTrianglesNearTheModel) {
    const json by_count = run_json("decimate " + model("vase.ply") + " -o " + path("few.ply") + " --triangles 5000");
    EXPECT_LE(by_count["triangles"].get<int>(), 5000);
    EXPECT_GT(by_count["triangles"].get<int>(), 4000);
    const json again = run_json("inspect " + path("few.ply"));
    EXPECT_EQ(again["triangles"], by_count["triangles"]) << "nothing of it needs repair";
    EXPECT_EQ(again["mesh"]["closed"], run_json("inspect " + model("vase.ply"))["mesh"]["closed"]);
    const json by_distance = run_json("decimate " + model("vase.ply") + " -o " + path("near.ply") + " --error 0.05");
    EXPECT_LT(by_distance["triangles"].get<int>(), by_distance["triangles_before"].get<int>() / 2);
    // The quadric error is a mean over planes: the greatest distance is some times as large.
    EXPECT_LT(by_distance["distance_mm"].get<double>(), 5 * 0.05);
    EXPECT_EQ(tuft("decimate " + model("vase.ply") + " -o " + path("x.ply")).status, 2) << "how far is not said";
    const Ran ran = tuft("decimate " + model("torus.ply") + " --unit cm -o " + path("copy.ply") + " --triangles 1000");
    EXPECT_NE(ran.out.find("paint on it with --unit cm"), std::string::npos) << "its numbers are those of the model";
}

TEST_F(ModelFiles, AWorkingCopyDoesNotReplaceItsModel) {
    const std::string scan = write("scan.ply", read(model("sheet.ply")));
    const std::string before = read(scan);
    const Ran ran = tuft("decimate " + scan + " -o " + scan + " --triangles 10");
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    EXPECT_EQ(read(scan), before);
}

TEST_F(ModelFiles, StrokesPaintedOnAWorkingCopyLieOnTheFullModelToo) {
    ASSERT_EQ(tuft("decimate " + model("bowl.ply") + " -o " + path("few.ply") + " --triangles 4000").status, 0);
    const std::string strokes = source_folder() + "/samples/strokes/qi-shang-ba-xia.inkml";
    const json copy = run_json("paint " + path("few.ply") + " --strokes " + strokes +
                               " --atlas-size 512 --no-cache --project " + path("p.tuft"));
    ASSERT_TRUE(copy.is_object());
    const json full = run_json("replay " + path("p.tuft") + " --model " + model("bowl.ply") + " --atlas-size 512");
    EXPECT_EQ(full["fit"]["mismatches"], 0) << full["fit"];
    // As far as the surfaces are apart, and a little that the hair makes of it.
    EXPECT_LT(full["fit"]["moved_most_mm"].get<double>(), 0.5) << full["fit"];
}

}  // namespace
}  // namespace tuft::test
