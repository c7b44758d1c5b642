#include "haptic/loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "core/error.h"
#include "core/system/allocations.h"
#include "haptic/device/exchange.h"
#include "haptic/followed_path.h"
#include "trial_model.h"

namespace tuft::haptic {
namespace {

using namespace std::chrono_literals;

TEST(Exchange, AReaderSeesWholeValuesThatOnlyGrow) {
    struct Pair {
        std::uint64_t a = 0, b = 0;
    };
    TripleBuffer<Pair> buffer;
    constexpr std::uint64_t kLast = 200000;
    std::thread writer([&] {
        for (std::uint64_t i = 1; i <= kLast; ++i) buffer.write({i, ~i});
    });
    Pair seen;
    std::uint64_t before = 0;
    while (seen.a < kLast) {
        if (!buffer.read(seen)) continue;
        ASSERT_EQ(seen.b, ~seen.a);
        ASSERT_GT(seen.a, before);
        before = seen.a;
    }
    writer.join();
    EXPECT_FALSE(buffer.read(seen));
}

TEST(Exchange, AQueueKeepsTheOrderAndCountsWhatDoesNotFit) {
    BoundedQueue<int, 8> queue;
    for (int i = 0; i < 11; ++i) queue.push(i);
    EXPECT_EQ(queue.overflow(), 3u);
    int value = -1;
    for (int i = 0; i < 8; ++i) {
        ASSERT_TRUE(queue.pop(value));
        EXPECT_EQ(value, i);
    }
    EXPECT_FALSE(queue.pop(value));
}

/// A live loop of a simulated arm over the sheet.
struct Live {
    TrialModel f = load_trial_model("sheet");
    brush::Tuft tuft;
    SimulatedDevice device{SimulatedArm(device_preset("inverse3"), hand_path(HandMotion::drag, f.place, tuft.preset))};
    LawOptions law{.limits = device_preset("inverse3")};
    Loop loop{device,
              HairSolver(tuft, *f.surface),
              {.law = law, .record = true, .count_allocations = allocations_of_this_thread}};
    explicit Live(const char* brush = "wolf-small") : tuft(tuft_of(brush)) {}
};

/// Runs the loop until the hair has pressed for 300 periods. Returns the poses that were solved.
std::vector<SolvedPose> run_until_pressed(Loop& loop) {
    constexpr std::uint64_t kPressed = 300;  // periods
    loop.start();
    std::vector<SolvedPose> poses;
    SolvedPose pose;
    std::uint64_t since = 0;
    for (int i = 0; i < 6000; ++i) {
        std::this_thread::sleep_for(10ms);
        while (loop.pop(pose)) poses.push_back(pose);
        const LoopStatus status = loop.status();
        if (since == 0 && glm::length(status.force) > 0.05) since = status.counts.periods;
        if (since > 0 && status.counts.periods >= since + kPressed) break;
    }
    loop.stop();
    while (loop.pop(pose)) poses.push_back(pose);
    return poses;
}

TEST(Loop, TheServoAllocatesNothingAndTheQueueHoldsWhatWasSolved) {
    Live live;
    const std::vector<SolvedPose> poses = run_until_pressed(live.loop);
    const LoopStatus status = live.loop.status();
    EXPECT_EQ(status.counts.allocations, 0u);
    EXPECT_GT(status.counts.periods, 100u);
    EXPECT_EQ(status.counts.cycle.count, status.counts.periods);
    EXPECT_EQ(status.counts.lost_poses, 0u);
    EXPECT_EQ(status.force, Vec3{0});
    EXPECT_FALSE(status.running);
    ASSERT_GT(poses.size(), 100u);
    for (std::size_t i = 1; i < poses.size(); ++i) ASSERT_GT(poses[i].pose.tick, poses[i - 1].pose.tick);
    EXPECT_LE(live.loop.recent_forces().size(), 3000u);
}

// Spines side by side, foam and a carried shape hold many times the memory of one spine at once.
TEST(Loop, WideTuftsAllocateNothingEither) {
    for (const char* brush : {"bright-12", "hake-60", "sponge-30", "leaf-28"}) {
        Live live(brush);
        const std::vector<SolvedPose> poses = run_until_pressed(live.loop);
        EXPECT_GT(std::ranges::count(poses, true, &SolvedPose::touching), 0) << brush << ": a busy machine solves some";
        EXPECT_EQ(live.loop.status().counts.allocations, 0u) << brush;
    }
}

// Whatever was late, the recording says so: played again, each force is the same to the bit.
TEST(Loop, ARecordedSessionGivesTheSameForcesWhenItIsPlayedAgain) {
    Live live;
    run_until_pressed(live.loop);
    const std::vector<RecordedPeriod> periods = live.loop.take_recording();
    ASSERT_GT(periods.size(), 100u);
    double greatest = 0;
    for (const RecordedPeriod& p : periods) greatest = std::max(greatest, glm::length(p.force));
    EXPECT_GT(greatest, 0.05);
    const std::vector<Vec3> forces = replay_forces(periods, HairSolver(live.tuft, *live.f.surface), live.law);
    for (std::size_t i = 0; i < forces.size(); ++i) ASSERT_EQ(forces[i], periods[i].force) << i;

    const std::string file = testing::TempDir() + "/tuft_session_" + std::to_string(::getpid()) + ".csv";
    {
        std::ofstream out(file);
        write_recording(out, periods);
    }
    const std::vector<RecordedPeriod> read = read_recording(file);
    std::filesystem::remove(file);
    EXPECT_EQ(replay_forces(read, HairSolver(live.tuft, *live.f.surface), live.law), forces);
}

TEST(Recording, AddedForcesAreKeptAndFelt) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-small");
    const HandPath path = hand_path(HandMotion::drag, f.place, tuft.preset);
    std::vector<RecordedPeriod> periods;
    for (std::uint64_t tick = 1; tick <= 1700; ++tick) {
        const HandTarget at = path(static_cast<double>(tick) * kPeriod);
        periods.push_back(
            {.tick = tick,
             .fresh = true,
             .state = {.time = static_cast<double>(tick) * kPeriod, .position = at.position, .rotation = at.rotation},
             .answer = tick,
             .solved = tick > 100});
    }
    const LawOptions law{.limits = device_preset("inverse3")};
    const auto forces = [&] { return replay_forces(periods, HairSolver(tuft, *f.surface), law); };
    const std::vector<Vec3> plain = forces();
    std::ostringstream before;
    write_recording(before, periods);
    EXPECT_TRUE(before.str().starts_with("tick,fresh,x,y,z,qw,qx,qy,qz,buttons,control,answer,solved,fx,fy,fz\n"));
    for (RecordedPeriod& p : periods) p.added = {.proximity = 0.01, .yield_stress = 400};
    const std::vector<Vec3> felt = forces();
    EXPECT_NE(felt, plain);
    const std::string file = testing::TempDir() + "/tuft_added_" + std::to_string(::getpid()) + ".csv";
    {
        std::ofstream out(file);
        write_recording(out, periods);
    }
    periods = read_recording(file);
    std::filesystem::remove(file);
    EXPECT_EQ(forces(), felt);
}

// An arm moves by itself, then a hand follows what was recorded while a force of a newton pulls at it.
TEST(FollowedPath, AHandFollowsARecordingWithinTheSagOfItsSpring) {
    const TrialPlace place{"plane", make_frame({0, 0, 0}, {0, 0, 1}, {1, 0, 0})};
    const DeviceLimits& limits = device_preset("touch");
    SimulatedArm first(limits, hand_path(HandMotion::drag, place, brush::load_preset("wolf-small")));
    std::vector<RecordedPeriod> periods;
    std::vector<Vec3> truth;
    for (std::uint64_t tick = 1; tick <= 3000; ++tick) {
        first.advance(static_cast<double>(tick) * kPeriod);
        periods.push_back({.tick = tick, .fresh = true, .state = first.measure()});
        truth.push_back(first.position());
    }
    const std::string file = testing::TempDir() + "/tuft_way_" + std::to_string(::getpid()) + ".csv";
    {
        std::ofstream out(file);
        write_recording(out, periods);
    }
    const std::vector<TimedPlace> places = read_followed_path(file);
    std::filesystem::remove(file);
    const double begin = 0.0045;  // s, middle of the first eight periods
    const HandPath path = followed_path(places);
    SimulatedArm arm(limits, path);
    const HandModel hand;
    double inertia = 0, from_truth = 0, sag = 0;
    for (std::size_t i = 10; i + 10 < truth.size(); ++i) {
        const double time = static_cast<double>(i + 1) * kPeriod - begin;
        arm.advance(time);
        arm.command({.force = {0, 0, 1}}, time);
        const HandTarget at = path(time);
        from_truth = std::max(from_truth, glm::distance(at.position, truth[i]));
        if (time < 1) continue;  // until the pull has settled
        sag = std::max(sag, glm::distance(arm.position(), at.position));
        inertia =
            std::max(inertia, (limits.mass + hand.mass) *
                                      glm::distance(path(time + 5e-3).velocity, path(time - 5e-3).velocity) / 1e-2 +
                                  limits.damping * glm::length(at.velocity));
    }
    EXPECT_LT(from_truth, limits.count);
    EXPECT_GT(sag, 0.9 / hand.stiffness - limits.friction / hand.stiffness);
    // A spring answers what begins at once with no more than twice its sag.
    EXPECT_LT(sag, (1 + 2 * (limits.friction + inertia)) / hand.stiffness);
}

TEST(FollowedPath, ATableOfTimesAndPlacesIsAPath) {
    const std::string file = testing::TempDir() + "/tuft_table_" + std::to_string(::getpid()) + ".csv";
    std::ofstream(file) << "t,x,y,z\n5,0,0,0.05\n6,0.01,0,0.05\n7,0.03,0,0.05\n";
    const HandPath path = followed_path(read_followed_path(file));
    EXPECT_EQ(path(-1).position, (Vec3{0, 0, 0.05}));
    EXPECT_NEAR(path(1).position.x, 0.01, 1e-15);
    EXPECT_NEAR(path(1).velocity.x, 0.015, 1e-15);  // the slope between its neighbours
    EXPECT_EQ(path(9).position, (Vec3{0.03, 0, 0.05}));
    EXPECT_EQ(path(9).velocity, Vec3{0});
    for (const char* broken : {"t,x,y,z\n", "t,x,y,z\n1,2,3\n", "t,x,y,z\n1,0,0,0\n1,0,0,0\n", "t,x,y,z\n1,9,0,0\n",
                               "t,x,y,z\nnan,0,0,0\n", "t,x,y,z,qw,qx,qy,qz\n1,0,0,0,0,0,0,0\n", "a,b\n1,2\n", ""}) {
        std::ofstream(file) << broken;
        EXPECT_THROW(read_followed_path(file), Error) << broken;
    }
    std::filesystem::remove(file);
}

TEST(Recording, BrokenTablesAreOneClearError) {
    const std::string file = testing::TempDir() + "/tuft_broken_" + std::to_string(::getpid()) + ".csv";
    const std::string head = "tick,fresh,x,y,z,qw,qx,qy,qz,buttons,control,answer,solved,fx,fy,fz\n";
    for (const std::string& text :
         {std::string("a,b\n1,2\n"), head + "1,1,0,0\n", head + "1,1,x,0,0,1,0,0,0,0,0,0,0,0,0,0\n",
          head + "2,1,0,0,0,1,0,0,0,0,0,0,0,0,0,0\n1,1,0,0,0,1,0,0,0,0,0,0,0,0,0,0\n", head + std::string(5000, '1')}) {
        std::ofstream(file) << text;
        EXPECT_THROW(read_recording(file), Error) << text.substr(0, 100);
    }
    std::filesystem::remove(file);
}

TEST(Replay, ADevicePlaysItsStatesInOrder) {
    std::vector<RecordedPeriod> periods;
    for (std::uint64_t i = 1; i <= 50; ++i)
        periods.push_back({.tick = i, .fresh = true, .state = {.position = {1e-3 * static_cast<double>(i), 0, 0}}});
    ReplayDevice device(device_preset("touch"), periods);
    double last = 0;
    while (device.open()) {
        DeviceState state;
        if (!device.read(state)) continue;
        EXPECT_GT(state.position.x, last);
        last = state.position.x;
    }
    EXPECT_NEAR(last, 0.05, 1e-12);
}

}  // namespace
}  // namespace tuft::haptic
