#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "program.h"

namespace tuft::test {
namespace {

using nlohmann::json;

class Revision : public Program {};

// A bent tile of 60 mm without symmetry that was turned by 10 degrees about (1, 2, 3) and shifted by 20 mm.
TEST_F(Revision, StrokesFollowAModelThatWasMoved) {
    const auto tile = [](double angle, double shift) {
        std::string text;
        const double length = std::sqrt(14.0), c = std::cos(angle), s = std::sin(angle);
        const std::array<double, 3> axis{1 / length, 2 / length, 3 / length};
        for (int j = 0; j <= 20; ++j)
            for (int i = 0; i <= 20; ++i) {
                const double x = 3 * i - 30, y = 3 * j - 30;
                const std::array<double, 3> p{x, y, 4e-3 * x * x + 3e-3 * x * y - 1e-4 * y * y * y};
                const double along = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
                text += "v";
                for (int k = 0; k < 3; ++k) {
                    const int l = (k + 1) % 3, m = (k + 2) % 3;  // Rodrigues' formula
                    const double q = c * p[k] + s * (axis[l] * p[m] - axis[m] * p[l]) + (1 - c) * along * axis[k];
                    text += " " + std::to_string(q + (k == 0 ? shift : 0));
                }
                text += "\n";
            }
        for (int j = 0; j < 20; ++j)
            for (int i = 1; i <= 20; ++i) {
                const int a = 21 * j + i;
                for (const auto& [b, d] : {std::pair(a + 1, a + 22), std::pair(a + 22, a + 21)})
                    text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(d) + "\n";
            }
        return text;
    };
    write("s.inkml", stroke_file());
    write("tile.obj", tile(0, 0));
    write("moved.obj", tile(10 * std::acos(-1.0) / 180, 20));
    ASSERT_EQ(tuft("paint " + path("tile.obj") + " --unit mm --strokes " + path("s.inkml") +
                   " --on top --atlas-size 256 --project " + path("p.tuft"))
                  .status,
              0);
    const std::string revise = "replay " + path("p.tuft") + " --model " + path("moved.obj") + " --json";
    const Ran follows =
        tuft(revise + " --project " + path("q.tuft") + " --moved " + path("moved.png") + " --size 160x90");
    ASSERT_EQ(follows.status, 0) << follows.err;
    const json fit = json::parse(follows.out)["fit"];
    EXPECT_EQ(fit["mismatches"], 0);
    EXPECT_NEAR(fit["model"]["turn_deg"].get<double>(), 10, 0.01);
    EXPECT_LT(fit["moved_on_model_mm"].get<double>(), 0.01) << "the same triangles";
    EXPECT_TRUE(fit["strokes"][0]["followed"]);
    EXPECT_EQ(read(path("moved.png")).substr(1, 3), "PNG");
    const Ran again = tuft("replay " + path("q.tuft") + " --json");
    EXPECT_EQ(json::parse(again.out)["canvas_hash"], json::parse(follows.out)["canvas_hash"]) << "stored as moved";
    const Ran stays = tuft(revise + " --follow none");
    ASSERT_EQ(stays.status, 0) << stays.err;
    EXPECT_EQ(json::parse(stays.out)["fit"]["mismatches"], 1);
    EXPECT_EQ(tuft("replay " + path("p.tuft") + " --follow none").status, 2);
}

// A stroke of a hand in space over a tile that is dented by 4 mm: pulled back it is pressed as deep as before.
TEST_F(Revision, AStrokeInSpaceIsPulledBackOntoADent) {
    const auto tile = [](double dent) {
        std::string text;
        for (int j = 0; j <= 12; ++j)
            for (int i = 0; i <= 12; ++i) {
                const double x = 5 * i - 30, y = 5 * j - 30;
                text += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
                        std::to_string(1e-3 * x * x - dent * std::exp(-(x * x + y * y) / 50)) + "\n";
            }
        for (int j = 0; j < 12; ++j)
            for (int i = 1; i <= 12; ++i) {
                const int a = 13 * j + i;
                text += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(a + 14) + " " +
                        std::to_string(a + 13) + "\n";
            }
        return text;
    };
    write("tile.obj", tile(0));
    write("dent.obj", tile(4));
    std::string trace;
    for (int i = 0; i <= 20; ++i) trace += (i ? ", " : "") + std::to_string(0.5 * i - 5) + " 0 16";
    write("space.inkml",
          "<ink xmlns=\"http://www.w3.org/2003/InkML\"><definitions><traceFormat xml:id=\"f\">"
          "<channel name=\"X\" units=\"mm\"/><channel name=\"Y\" units=\"mm\"/><channel name=\"Z\" "
          "units=\"mm\"/></traceFormat><context xml:id=\"c\" traceFormatRef=\"#f\"/></definitions>"
          "<trace contextRef=\"#c\">" +
              trace + "</trace></ink>");
    ASSERT_EQ(tuft("paint " + path("tile.obj") + " --unit mm --brush wolf-small --strokes " + path("space.inkml") +
                   " --atlas-size 256 --project " + path("p.tuft"))
                  .status,
              0);
    const std::string revise = "replay " + path("p.tuft") + " --model " + path("dent.obj") + " --json";
    const auto fit = [&](const std::string& more) {
        const Ran ran = tuft(revise + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(ran.out)["fit"];
    };
    const json left = fit(""), pulled = fit(" --pull-back");
    EXPECT_EQ(left["misfits"], 1);
    EXPECT_LT(left["strokes"][0]["deeper_mm"].get<double>(), -2) << "in the dent it hardly touches";
    EXPECT_EQ(pulled["misfits"], 0);
    EXPECT_NEAR(pulled["strokes"][0]["deeper_mm"].get<double>(), 0, 0.01);
}

}  // namespace
}  // namespace tuft::test
