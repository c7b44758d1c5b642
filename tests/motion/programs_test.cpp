#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>

#include "core/error.h"
#include "io/motion/motion_files.h"

namespace tuft::io {
namespace {

constexpr double kPi = std::numbers::pi;

/// Three points of a stroke and its approach; the holder leans by `lean` about x.
MotionProgram program(double lean) {
    MotionProgram p;
    p.title = "sheet";
    p.strokes.resize(1);
    p.strokes[0].brush = "wolf-medium";
    p.strokes[0].ink = "carbon";
    p.strokes[0].seed = 99;
    p.strokes[0].label = "heng";
    p.strokes[0].settings = stroke::StrokeSettings{};
    p.strokes[0].before = {stroke::BrushAction{.what = stroke::Wipe{.amount = 0.5}}};
    const Quat rotation = glm::angleAxis(lean, Vec3(1, 0, 0));
    motion::Move approach{motion::MoveKind::approach, 0, {}}, stroke{motion::MoveKind::stroke, 0, {}};
    approach.points = {{{{0.01, 0.02, 0.06}, rotation, 0}}, {{{0.01, 0.02, 0.02}, rotation, 0.5}}};
    for (int i = 0; i < 3; ++i)
        stroke.points.push_back({{{0.01 + 0.005 * i, 0.02, 0.02}, rotation, 0.5 + 0.1 * i}, {0, 0, 0.02}});
    p.trajectory.moves = {approach, stroke};
    return p;
}

std::vector<std::vector<double>> numbers_in(const std::string& text, const std::regex& line) {
    std::vector<std::vector<double>> all;
    for (auto it = std::sregex_iterator(text.begin(), text.end(), line); it != std::sregex_iterator(); ++it) {
        all.emplace_back();
        for (std::size_t k = 1; k < it->size(); ++k) all.back().push_back(std::stod((*it)[k]));
    }
    return all;
}

const std::string kNumber = R"((-?[0-9.]+))";

// The tool's z axis points along the hair: with an upright brush (0, 0, −1).
TEST(Programs, TcpPointsAlongTheHair) {
    const MotionFrame tcp = tcp_of({{0.1, 0.2, 0.3}, glm::angleAxis(0.4, Vec3(0, 1, 0)), 0}, {});
    EXPECT_LT(glm::length(tcp.rotation * Vec3(0, 0, 1) - glm::angleAxis(0.4, Vec3(0, 1, 0)) * Vec3(0, 0, -1)), 1e-12);
    EXPECT_LT(glm::length(tcp.rotation * Vec3(1, 0, 0) - glm::angleAxis(0.4, Vec3(0, 1, 0)) * Vec3(1, 0, 0)), 1e-12);
}

TEST(Programs, UrScriptHoldsPositionsRotationsAndSpeeds) {
    const double lean = 0.3;
    const auto moves =
        numbers_in(urscript_text(program(lean)),
                   std::regex("move[pl]\\(p\\[" + kNumber + ", " + kNumber + ", " + kNumber + ", " + kNumber + ", " +
                              kNumber + ", " + kNumber + "\\], a=" + kNumber + ", v=" + kNumber));
    ASSERT_EQ(moves.size(), 3u);  // one line of the approach, two of the stroke
    EXPECT_NEAR(moves[2][0], 0.02, 1e-6);
    // Half a turn about x after the lean about x: a turn by π + 0.3, or π − 0.3 the other way round.
    EXPECT_NEAR(std::hypot(moves[2][3], moves[2][4], moves[2][5]), kPi - lean, 1e-5);
    EXPECT_NEAR(std::abs(moves[2][3]), kPi - lean, 1e-5);
    EXPECT_NEAR(moves[2][7], 0.05, 1e-5);  // 5 mm in 0.1 s
}

TEST(Programs, RapidHoldsMillimetresQuaternionsAndTimes) {
    const auto moves =
        numbers_in(rapid_text(program(0.3)),
                   std::regex("MoveL \\[\\[" + kNumber + ", " + kNumber + ", " + kNumber + "\\], \\[" + kNumber + ", " +
                              kNumber + ", " + kNumber + ", " + kNumber + "\\][^\\n]*\\\\T:=" + kNumber));
    ASSERT_EQ(moves.size(), 3u);
    EXPECT_NEAR(moves[1][0], 15, 1e-3);
    EXPECT_NEAR(moves[1][2], 20, 1e-3);
    const Quat q(moves[1][3], moves[1][4], moves[1][5], moves[1][6]);
    EXPECT_LT(glm::length(q * Vec3(0, 0, 1) - glm::angleAxis(0.3, Vec3(1, 0, 0)) * Vec3(0, 0, -1)), 1e-6);
    EXPECT_NEAR(moves[0][7], 0.5, 1e-6);
    EXPECT_NEAR(moves[1][7], 0.1, 1e-6);
}

TEST(Programs, KrlHoldsEulerAnglesAboutZYX) {
    const auto lines =
        numbers_in(krl_text(program(0.3)),
                   std::regex("VEL.CP = " + kNumber + "\\n  LIN \\{X " + kNumber + ", Y " + kNumber + ", Z " + kNumber +
                              ", A " + kNumber + ", B " + kNumber + ", C " + kNumber + "\\}"));
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_NEAR(lines[1][0], 0.05, 1e-5);
    EXPECT_NEAR(lines[1][1], 15, 1e-3);
    const auto turn = [](double degrees, const Vec3& axis) { return glm::angleAxis(degrees * kPi / 180, axis); };
    const Quat q = turn(lines[1][4], {0, 0, 1}) * turn(lines[1][5], {0, 1, 0}) * turn(lines[1][6], {1, 0, 0});
    EXPECT_LT(glm::length(q * Vec3(0, 0, 1) - glm::angleAxis(0.3, Vec3(1, 0, 0)) * Vec3(0, 0, -1)), 1e-5);
    EXPECT_LT(glm::length(q * Vec3(1, 0, 0) - Vec3(1, 0, 0)), 1e-5);
}

/// The hand rests for 0.4 s, drifts by 10 nm in 0.3 s, which no program's digits hold, and creeps by 20 um in 0.5 s.
MotionProgram resting() {
    MotionProgram p = program(0);
    std::vector<motion::Waypoint>& points = p.trajectory.moves[1].points;
    for (const auto& [x, time] : {std::pair{0.0, 0.4}, {1e-8, 0.3}, {2e-5, 0.5}}) {
        motion::Waypoint next = points.back();
        next.pose.position.x += x;
        next.pose.time += time;
        points.push_back(next);
    }
    return p;
}

// A speed of 0 is refused by controllers, and one that they raise loses the time in which ink flows.
TEST(Programs, WhereTheHandRestsTheToolWaits) {
    const MotionProgram p = resting();
    const auto waits = [&](const std::string& text, const std::string& wait) {
        std::vector<double> all;
        for (const std::vector<double>& found : numbers_in(text, std::regex(wait))) all.push_back(found[0]);
        return all;
    };
    EXPECT_EQ(waits(urscript_text(p), "sleep\\(" + kNumber + "\\)"), (std::vector{0.4, 0.3}));
    EXPECT_EQ(waits(rapid_text(p), "WaitTime \\\\InPos, " + kNumber), (std::vector{0.4, 0.3}));
    EXPECT_EQ(waits(gcode_text(p), "G4 P" + kNumber), (std::vector{0.4, 0.3}));
    // KRL's path is 0.1 mm/s fast at least: the creep's 20 um take 0.2 s of their 0.5 s.
    EXPECT_EQ(waits(krl_text(p), "WAIT SEC " + kNumber), (std::vector{0.4, 0.3, 0.3}));
    for (const double v : waits(urscript_text(p), " v=" + kNumber)) EXPECT_GE(v, 1e-4);
    for (const double feed : waits(gcode_text(p), " F" + kNumber)) EXPECT_GT(feed, 0);
}

/// A hand that creeps by `length` each `time`, 300 times.
MotionProgram creeping(double length, double time) {
    MotionProgram p = program(0);
    std::vector<motion::Waypoint>& points = p.trajectory.moves[1].points;
    for (int i = 0; i < 300; ++i) {
        motion::Waypoint next = points.back();
        next.pose.position.x += length;
        next.pose.time += time;
        points.push_back(next);
    }
    return p;
}

/// Seconds that a program of moves and waits takes from `at` on: `way` has x, y, z and the speed.
double duration(const std::string& text, const std::string& way, double speed, const std::string& wait, double metres,
                Vec3 at) {
    double seconds = 0;
    for (const std::vector<double>& m : numbers_in(text, std::regex(way))) {
        const Vec3 to = metres * Vec3(m[0], m[1], m[2]);
        seconds += glm::distance(to, at) / (speed * m[3]);
        at = to;
    }
    for (const std::vector<double>& w : numbers_in(text, std::regex(wait))) seconds += w[0];
    return seconds;
}

// Steps shorter than the digits of a program are waited, and then made at the speed of their printed length.
TEST(Programs, ASlowCreepTakesItsTime) {
    const std::string place = "G1 X" + kNumber + " Y" + kNumber + " Z" + kNumber + " F" + kNumber;
    const auto gcode = [&](const MotionProgram& p) {
        return duration(gcode_text(p), place, 1e-3 / 60, "G4 P" + kNumber, 1e-3, {0.01, 0.02, 0.06});
    };
    EXPECT_NEAR(gcode(creeping(6e-8, 0.01)), 0.7 + 3, 0.002);  // feeds have six digits behind the point
    EXPECT_NEAR(gcode(creeping(2e-10, 0.01)), 0.7 + 3, 0.002) << "one step crosses the edge of a digit";
    const MotionProgram p = creeping(4e-7, 0.004);
    const std::string text = urscript_text(p);
    const double made = duration(
        text, "movep\\(p\\[" + kNumber + ", " + kNumber + ", " + kNumber + ", [^\\]]*\\], a=[^,]*, v=" + kNumber, 1,
        "(?:sleep\\(|t=)" + kNumber, 1, {0.01, 0.02, 0.02});
    EXPECT_NEAR(made, 0.7 + 1.2, 0.002) << "the approach has a time of its own";
}

// The path of a holder that turns in its place has no length: in KRL its turn has a speed.
TEST(Programs, KrlTurnsInItsPlaceInItsTime) {
    MotionProgram p = program(0);
    p.trajectory.moves[1].points[2].pose = p.trajectory.moves[1].points[1].pose;
    p.trajectory.moves[1].points[2].pose.rotation = glm::angleAxis(0.5, Vec3(0, 0, 1));
    p.trajectory.moves[1].points[2].pose.time += 2;
    const auto speeds = numbers_in(krl_text(p), std::regex("VEL.ORI1 = " + kNumber));
    ASSERT_EQ(speeds.size(), 2u);
    EXPECT_NEAR(speeds[0][0], p.limits.turn * 180 / kPi, 1e-4);
    EXPECT_NEAR(speeds[1][0], 0.25 * 180 / kPi, 1e-4);
    // A turn whose speed would be printed as 0.
    p.trajectory.moves[1].points[2].pose.rotation = glm::angleAxis(2e-6, Vec3(0, 0, 1));
    EXPECT_EQ(numbers_in(krl_text(p), std::regex("VEL.ORI1 = " + kNumber)).size(), 1u);
}

// KUKA's controllers want the file's name; no language takes its own words as names, nor `main` beside RAPID's `main`.
TEST(Programs, TitlesAreNamesInEachLanguage) {
    EXPECT_EQ(program_title("/a/b.c/bowl_2.src"), "bowl_2");
    for (const char* word : {"end", "Main", "LIN", "movel", "tBrush", "True", "with"})
        EXPECT_EQ(program_title(word + std::string(".mod")), "p_" + std::string(word));
    EXPECT_EQ(program_title("ending.src"), "ending");
    for (const char* odd :
         {"7 bowls.src", "\xe7\x9b\x98.src", "_.src", "it's a (very) long name, of a bowl.src", ".src"}) {
        const std::string name = program_title(odd);
        EXPECT_TRUE(std::regex_match(name, std::regex("[A-Za-z][A-Za-z0-9_]{0,23}"))) << name;
    }
}

// Before INITMOV a controller has no speeds of axes and of turning, and INITMOV resets the tool.
TEST(Programs, KrlInitialisesMotionBeforeItSetsTheTool) {
    const std::string text = krl_text(program(0.3));
    const std::size_t init = text.find("\n  BAS (#INITMOV, 0)\n");
    ASSERT_NE(init, std::string::npos);
    EXPECT_LT(text.find("\nDEF "), init);
    EXPECT_LT(init, text.find("$TOOL"));
    EXPECT_LT(text.find("$TOOL"), text.find("PTP"));
}

TEST(Programs, GCodeIsForUprightBrushesOnly) {
    const auto lines = numbers_in(gcode_text(program(0)),
                                  std::regex("G1 X" + kNumber + " Y" + kNumber + " Z" + kNumber + " F" + kNumber));
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_NEAR(lines[2][0], 20, 1e-3);
    EXPECT_NEAR(lines[2][3], 3000, 0.1);  // 50 mm/s
    MotionProgram leans = program(0);
    leans.trajectory.moves[1].points[2].pose.rotation = glm::angleAxis(0.3, Vec3(1, 0, 0));
    try {
        gcode_text(leans);
        ADD_FAILURE() << "a plotter cannot lean its brush";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("leans by 17 degrees"), std::string::npos) << error.what();
    }
}

class TrajectoryFile : public testing::Test {
  protected:
    std::filesystem::path file_ =
        std::filesystem::path(testing::TempDir()) / ("tuft_motion_" + std::to_string(::getpid()) + ".json");
    void TearDown() override { std::filesystem::remove(file_); }
};

TEST_F(TrajectoryFile, ReadsBackToTheBit) {
    const MotionProgram p = program(0.3);
    write_trajectory(file_, p);
    const std::vector<stroke::RecordedStroke> read = read_trajectory(file_);
    ASSERT_EQ(read.size(), 1u);
    EXPECT_FALSE(read[0].flat);
    EXPECT_EQ(read[0].brush, "wolf-medium");
    EXPECT_EQ(read[0].seed, 99u);
    EXPECT_EQ(read[0].label, "heng");
    EXPECT_EQ(read[0].before.size(), 1u);
    ASSERT_EQ(read[0].samples.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(read[0].samples[i].position, p.trajectory.moves[1].points[i].pose.position);
        EXPECT_EQ(read[0].samples[i].rotation, p.trajectory.moves[1].points[i].pose.rotation);
    }
    EXPECT_EQ(read[0].samples[0].time, 0);
}

TEST_F(TrajectoryFile, ATableReadsBackToItsDigits) {
    const MotionProgram p = program(0.3);
    file_.replace_extension(".csv");
    write_trajectory(file_, p);
    const std::vector<stroke::RecordedStroke> read = read_trajectory(file_);
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0].brush, "wolf-medium");
    EXPECT_EQ(read[0].ink, "carbon");
    EXPECT_EQ(read[0].seed, 99u);
    EXPECT_EQ(read[0].before.size(), 1u);
    EXPECT_TRUE(read[0].settings);
    ASSERT_EQ(read[0].samples.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const brush::Pose& pose = p.trajectory.moves[1].points[i].pose;
        EXPECT_LT(glm::length(read[0].samples[i].position - pose.position), 1e-9);  // six digits of a millimetre
        const Quat off = read[0].samples[i].rotation - pose.rotation;
        EXPECT_LT(std::sqrt(glm::dot(off, off)), 2e-9);  // nine digits of each part
        EXPECT_NEAR(read[0].samples[i].time, 0.1 * static_cast<double>(i), 1e-6);
    }
}

// The hand was twice as fast as the tool: a stroke takes the hand's clock where the file has it, else the tool's.
TEST_F(TrajectoryFile, StrokesAreReadOnTheHandsClock) {
    MotionProgram p = program(0.3);
    std::vector<motion::Waypoint>& points = p.trajectory.moves[1].points;
    for (std::size_t i = 0; i < points.size(); ++i) points[i].hand_time = 0.05 * static_cast<double>(i);
    for (const char* extension : {".json", ".csv"}) {
        file_.replace_extension(extension);
        write_trajectory(file_, p);
        const std::vector<stroke::RecordedStroke> read = read_trajectory(file_);
        ASSERT_EQ(read.at(0).samples.size(), 3u);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(read[0].samples[i].time, 0.05 * static_cast<double>(i), 1e-6) << extension;  // six digits
        std::filesystem::remove(file_);
    }
    const std::string start = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,hand_s\n1,0,0,0,1,0,0,0,";
    EXPECT_EQ(parse_trajectory_csv(start + "\n3,1,0,0,1,0,0,0,\n", "log.csv")[0].samples[1].time, 2);
    EXPECT_EQ(parse_trajectory_csv(start + "7\n3,1,0,0,1,0,0,0,8\n", "log.csv")[0].samples[1].time, 1);
    EXPECT_THROW(parse_trajectory_csv(start + "7\n3,1,0,0,1,0,0,0,\n", "log.csv"), Error);
}

// A robot's log: other columns among them, in another order, by another program's line ends and quotes.
TEST_F(TrajectoryFile, ATableOfAnotherProgramIsRead) {
    const std::string text =
        "\xef\xbb\xbfstroke,qw,qx,qy,qz,\"note, of mine\",z_mm,y_mm,x_mm,t_s\r\n"
        "7,1,0,0,0,\"a \"\"quote\"\", and\na line\",20,2,1,10\r\n"
        "7,1,0,0,0,,20,2,3,10.5\r\n"
        "9,1,0,0,0,,20,2,5,12\r\n";
    const std::vector<stroke::RecordedStroke> read = parse_trajectory_csv(text, "log.csv");
    ASSERT_EQ(read.size(), 2u);
    ASSERT_EQ(read[0].samples.size(), 2u);
    EXPECT_EQ(read[0].samples[1].time, 0.5);
    EXPECT_NEAR(read[0].samples[1].position.x, 0.003, 1e-15);
    EXPECT_EQ(read[1].samples[0].time, 0);
    EXPECT_TRUE(read[0].brush.empty());
    EXPECT_FALSE(read[0].settings);
    for (const char* bad : {"", "t_s,x_mm\n1,2\n", "stroke,qw,qx,qy,qz,z_mm,y_mm,x_mm,t_s\n",
                            "stroke,qw,qx,qy,qz,z_mm,y_mm,x_mm,t_s\n1,1,0,0,0,2,3\n",
                            "stroke,qw,qx,qy,qz,z_mm,y_mm,x_mm,t_s\n1.5,1,0,0,0,2,3,4,5\n",
                            "stroke,qw,qx,qy,qz,z_mm,y_mm,x_mm,t_s\n1,1,0,0,0,2,nan,4,5\n",
                            "stroke,qw,qx,qy,qz,z_mm,y_mm,x_mm,t_s\n1,0,0,0,0,2,3,4,5\n",
                            "stroke,qw,qx,qy,qz,z_mm,y_mm,x_mm,t_s,stroke_json\n1,1,0,0,0,2,3,4,5,{}\n",
                            "stroke,qw,qx,qy,qz,z_mm,y_mm,x_mm,t_s\n\"1,1,0,0,0,2,3,4,5\n"})
        EXPECT_THROW(parse_trajectory_csv(bad, "log.csv"), Error) << bad;
}

TEST_F(TrajectoryFile, RefusesWhatItHasNotWritten) {
    const std::string good = trajectory_json(program(0));
    const auto refused = [&](const std::string& text) {
        std::ofstream(file_) << text;
        try {
            read_trajectory(file_);
        } catch (const Error& error) {
            return std::string(error.what()).starts_with(file_.string() + ": ");
        }
        return false;
    };
    EXPECT_TRUE(refused("{}"));
    EXPECT_TRUE(refused("[1,2"));
    EXPECT_TRUE(refused(std::string(100000, '[')));
    for (const auto& [what, by] : {std::pair<std::string, std::string>{"tuft-trajectory", "other"},
                                   {"\"version\":2", "\"version\":3"},
                                   {"\"stroke\":0", "\"stroke\":5"},
                                   {"\"points\":[[", "\"points\":[[1e999,"},
                                   {"\"points\":[[", "\"points\":[7,["}}) {
        std::string text = good;
        for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
            text.replace(at, what.size(), by);
        EXPECT_TRUE(refused(text)) << what;
    }
    for (std::size_t n = 0; n + 2 < good.size(); n += 97) EXPECT_TRUE(refused(good.substr(0, n))) << n;
}

}  // namespace
}  // namespace tuft::io
