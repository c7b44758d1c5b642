#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "haptic/device/haply.h"
#include "program.h"
#include "served.h"

/// \file
/// `tuft device` and samples/device-bridge as programs.
namespace tuft {
namespace {

using namespace std::string_literals;

using Device = test::Program;

TEST_F(Device, ListsTheKnownArms) {
    const test::Ran ran = tuft("device list --port 1 --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const nlohmann::json out = nlohmann::json::parse(ran.out);
    EXPECT_FALSE(out["answers"]);
    ASSERT_EQ(out["presets"].size(), 4u);
    EXPECT_EQ(out["presets"][0]["preset"], "touch");
    EXPECT_EQ(out["presets"][0]["max_force_n"], 3.3);
}

TEST_F(Device, WrongArgumentsAreOneLine) {
    for (const char* arguments :
         {"device", "device fly", "device list --preset omega", "device test --simulate wand", "device record",
          "device simulate --motion jump", "device test --port 1 --seconds 1", "device simulate --brush nosuch",
          "device test --simulate touch --spine table --brush flat-12"}) {
        const test::Ran ran = tuft(arguments);
        EXPECT_TRUE(ran.status == 1 || ran.status == 2) << arguments;
        EXPECT_EQ(ran.error_lines(), 1) << arguments << ran.err;
        EXPECT_EQ(ran.out, "") << arguments;
    }
    const std::string unknown = tuft("device test --simulate wand").err;
    for (const char* known : {"touch", "omega.6"}) EXPECT_NE(unknown.find(known), std::string::npos) << unknown;
}

TEST_F(Device, TestPrintsTheFiguresOfASimulatedArm) {
    for (const std::string spine : {"rod", "table"}) {
        const test::Ran ran =
            tuft("device test --simulate inverse3 --model sheet --seconds 1 --json --quiet --spine " + spine);
        ASSERT_EQ(ran.status, 0) << ran.err;
        const nlohmann::json out = nlohmann::json::parse(ran.out);
        for (const char* key : {"least_energy_uj", "late_percent", "worst_cycle_ms", "largest_step_n", "allocations",
                                "late_solves_percent", "stop_ms"})
            EXPECT_TRUE(out[key].is_number()) << key;
        EXPECT_GE(out["least_energy_uj"], -1) << spine;
        EXPECT_TRUE(out["complete"]);
        EXPECT_EQ(out["allocations"], 0) << spine;
    }
}

/// Shell text that does `stop` to the background process once it is amid its trials, and waits for it. Preparing the
/// sheet takes it less than 0.3 s of CPU (30 ticks of /proc/PID/stat), whatever else the machine does.
std::string stopped_at_work(const std::string& stop) {
    return "p=$!; while [ $(cut -d' ' -f14 /proc/$p/stat) -lt 30 ]; do sleep 0.02; done; " + stop + "; wait $p";
}

TEST_F(Device, AnInterruptedTestPrintsWhatItHas) {
    const std::string test = "device test --simulate touch --model sheet --threads 1 --json --quiet --hands 100000";
    const test::Ran ran =
        tuft(test + " >" + path("figures") + " 2>" + path("said") + " & " + stopped_at_work("kill -INT $p"));
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(read(path("said")), "tuft: stopped\n");
    const nlohmann::json out = nlohmann::json::parse(read(path("figures")));
    EXPECT_FALSE(out["complete"]);
    EXPECT_LT(out["trials"], 18 + 100'000);  // two places, nine motions
    EXPECT_EQ(out["hands"].get<int>() > 0, out["trials"].get<int>() > 18);
    EXPECT_FALSE(out.contains("stop_ms"));
}

// On a machine where it hardly runs: it is halted for longer than other work has after a signal.
TEST_F(Device, AnInterruptedTestPrintsWhatItHasHoweverSlowItIs) {
    const test::Ran ran =
        tuft("device test --simulate touch --model sheet --threads 1 --json --hands 100000 >" + path("figures") +
             " 2>/dev/null & " + stopped_at_work("kill -INT $p; sleep 0.005; kill -STOP $p; sleep 0.9; kill -CONT $p"));
    EXPECT_EQ(ran.status, 1);
    EXPECT_FALSE(nlohmann::json::parse(read(path("figures")))["complete"]);
}

TEST_F(Device, ARecordingPlaysAgainToTheBit) {
    test::Ran ran = tuft("device record --simulate touch --seconds 2.5 -o '" + path("a.csv") + "' --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_GT(nlohmann::json::parse(ran.out)["greatest_force_n"], 0);
    ran = tuft("device record --simulate touch --replay '" + path("a.csv") + "' -o '" + path("b.csv") + "' --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(nlohmann::json::parse(ran.out)["different"], 0);
    EXPECT_EQ(read(path("a.csv")), read(path("b.csv")));
}

// The recording says what was felt besides hair, so that it needs no option when it is played again.
TEST_F(Device, AHandFollowsATableAndFeelsPaste) {
    write("way.csv", "t,x,y,z\n0,0,0,0.1\n0.1,0,0,0.1\n0.4,0.01,0,0.1\n");
    test::Ran ran = tuft("device record --simulate touch --model sheet --proximity 0.1 --paste 400 --follow '" +
                         path("way.csv") + "' --seconds 0.6 -o '" + path("a.csv") + "' --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const std::string table = read(path("a.csv"));
    EXPECT_NE(table.find(",proximity,yield\n"), std::string::npos);
    EXPECT_NE(table.find(",400\n"), std::string::npos);
    const std::size_t last = table.rfind('\n', table.size() - 2);
    double tick = 0, fresh = 0, x = 0;
    ASSERT_EQ(std::sscanf(table.c_str() + last + 1, "%lf,%lf,%lf", &tick, &fresh, &x), 3);
    EXPECT_NEAR(x, 0.01, 1e-3);  // m, what the arm's friction of 0.2 N leaves of the spring's 300 N/m
    ran = tuft("device record --simulate touch --model sheet --replay '" + path("a.csv") + "' -o '" + path("b.csv") +
               "'");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(table, read(path("b.csv")));
}

TEST_F(Device, SimulateServesAnArmThatListAndRecordFind) {
    const Served server(tuft_program(), "device simulate --preset omega.6 --port 0");
    ASSERT_GT(server.port, 0);
    const std::string port = " --port " + std::to_string(server.port);
    test::Ran ran = tuft("device list --json" + port);
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(nlohmann::json::parse(ran.out)["answers"]);
    ran = tuft("device record --preset omega.6 --seconds 1 -o '" + path("a.csv") + "' --json" + port);
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_GT(nlohmann::json::parse(ran.out)["periods"], 100);
}

// A service that the program knows nothing of but the wire. On a machine that is too slow for an arm it says so.
TEST_F(Device, TestChecksTheSafetyOfAnArmThatNobodyHolds) {
    const Served server(tuft_program(), "device simulate --preset touch --model sheet --port 0 --hands-off");
    ASSERT_GT(server.port, 0);
    const test::Ran ran =
        tuft("device test --model sheet --seconds 0.2 --json --quiet --port " + std::to_string(server.port));
    const nlohmann::json out = nlohmann::json::parse(ran.out);
    const bool safe = out["safe"].get<bool>();
    if (!safe) {  // of a safe arm too where the loop falls silent on a slow machine
        EXPECT_EQ(ran.status, 1);
    }
    for (const char* key :
         {"states_per_s", "count_um", "noise_um", "moved_mm", "check_force_n", "check_step_n", "ramp_ms", "stop_ms"})
        EXPECT_TRUE(out[key].is_number()) << key;
    EXPECT_EQ(out.contains("late_percent"), safe);  // the loop runs only where the arm may be taken up
    if (safe) {
        EXPECT_GE(out["stop_ms"], 0);
        EXPECT_LT(out["stop_ms"], 20);
        EXPECT_GT(out["check_force_n"], 0.019);
        EXPECT_GE(out["ramp_ms"], 400);
    }
    EXPECT_EQ(out["stop_after_ms"].size(), 5u);
    EXPECT_LT(out["moved_mm"], 0.01);  // a check moves no arm
    EXPECT_LE(out["check_force_n"], 0.0201);
}

// A hand carries it at 0.1 m/s.
TEST_F(Device, TestGivesNoForceOfHairToAnArmThatMoves) {
    write("way.csv", "t,x,y,z\n0,0,0,0.1\n10,1,0,0.1\n");
    const Served server(tuft_program(),
                        "device simulate --preset touch --model sheet --port 0 --follow '" + path("way.csv") + "'");
    ASSERT_GT(server.port, 0);
    const test::Ran ran =
        tuft("device test --model sheet --seconds 0.2 --json --quiet --port " + std::to_string(server.port));
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find("the arm moves"), std::string::npos) << ran.err;
    const nlohmann::json out = nlohmann::json::parse(ran.out);
    EXPECT_FALSE(out["safe"]);
    for (const char* key : {"late_percent", "worst_cycle_ms", "lost_poses"}) EXPECT_FALSE(out.contains(key)) << key;
}

// What was felt until then is kept, and one line says what has failed.
TEST_F(Device, AServerThatDiesEndsARecordingWithWhatThereIs) {
    for (const char* fault : {"dies", "nan"}) {
        const Served server(
            tuft_program(),
            "device simulate --preset omega.6 --model sheet --port 0 --fault-after 1 --fault "s + fault);
        ASSERT_GT(server.port, 0);
        const test::Ran ran = tuft("device record --preset omega.6 --model sheet --seconds 60 -o '" + path("a.csv") +
                                   "' --port " + std::to_string(server.port));
        EXPECT_EQ(ran.status, 1) << fault;
        EXPECT_EQ(ran.error_lines(), 1) << fault << ran.err;
        EXPECT_NE(ran.err.find("the arm"), std::string::npos) << ran.err;
        EXPECT_GT(read(path("a.csv")).size(), 1000u) << fault;
    }
}

TEST_F(Device, TheSampleBridgeSpeaksTheProtocol) {
    const Served bridge(TUFT_BRIDGE, "0");
    ASSERT_GT(bridge.port, 0);
    haptic::HaplyDevice device(haptic::device_preset("touch"), {.port = bridge.port});
    haptic::DeviceState state;
    int states = 0;
    for (int i = 0; i < 3000 && states < 20; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        device.send({.force = {0, 0, 2}});  // 40 mm against its spring of 50 N/m
        states += device.read(state);
    }
    EXPECT_GE(states, 20);
    EXPECT_EQ(device.device_id(), "bridge");
    for (int i = 0; i < 3000 && state.position.z < 0.02; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        device.send({.force = {0, 0, 2}});
        device.read(state);
    }
    EXPECT_GT(state.position.z, 0.02);
}

}  // namespace
}  // namespace tuft
