#include "haptic/device/haply.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "haptic/device/haply_messages.h"
#include "haptic/loop.h"
#include "haptic/strokes.h"
#include "trial_model.h"

namespace tuft::haptic {
namespace {

using namespace std::chrono_literals;

HaplyState some_state() {
    return {.device = "A14",
            .state = {.position = {0.01, -0.2, 1.0 / 3},
                      .velocity = {1, 2, 3},
                      .rotation = glm::angleAxis(0.4, Vec3{0, 1, 0}),
                      .buttons = 5}};
}

TEST(HaplyMessages, StatesAndCommandsComeBackAsTheyWere) {
    HaplyState read;
    ASSERT_TRUE(read_haply_state(haply_state_text(some_state()), read));
    EXPECT_EQ(read.device, "A14");
    EXPECT_EQ(read.state.position, some_state().state.position);
    EXPECT_EQ(read.state.velocity, some_state().state.velocity);
    EXPECT_LT(glm::length(read.state.rotation - some_state().state.rotation), 1e-15);  // normalised anew
    EXPECT_EQ(read.state.buttons, 5u);
    DeviceCommand command;
    ASSERT_TRUE(read_haply_command(haply_command_text("A14", {.force = {0.1, -7.9, 1.0 / 3}}), command));
    EXPECT_EQ(command.force, Vec3(0.1, -7.9, 1.0 / 3));
}

// As the service's documentation shows them, with members that are of no use here.
TEST(HaplyMessages, AMessageOfTheServiceIsUnderstood) {
    HaplyState read;
    ASSERT_TRUE(read_haply_state(
        R"({"session_id":3,"inverse3":[{"device_id":"049D","config":{"type":"inverse3"},"state":{"angular_position":
        {"a0":1,"a1":2,"a2":3},"cursor_position":{"x":0.04,"y":-0.15,"z":0.2},"cursor_velocity":{"x":0,"y":0,"z":0}},
        "status":{"ready":true}}],"verse_grip":[],"wireless_verse_grip":[{"device_id":"61548","state":{"orientation":
        {"w":0.7071068,"x":0,"y":0.7071068,"z":0},"hall":0,"buttons":{"a":false,"b":true,"c":false},
        "battery_level":0.8}}]})",
        read));
    EXPECT_EQ(read.device, "049D");
    EXPECT_EQ(read.state.position, Vec3(0.04, -0.15, 0.2));
    EXPECT_EQ(read.state.buttons, 2u);
    EXPECT_NEAR(read.state.rotation.y, std::sqrt(0.5), 1e-6);
}

TEST(HaplyMessages, WhatIsNoStateIsRefusedAndChangesNothing) {
    const std::string whole = haply_state_text(some_state());
    std::vector<std::string> broken{"",
                                    "{",
                                    "[]",
                                    "null",
                                    "{}",
                                    R"({"inverse3":[]})",
                                    R"({"inverse3":{}})",
                                    R"({"inverse3":[{"state":{"cursor_position":{"x":NaN,"y":0,"z":0}}}]})",
                                    R"({"inverse3":[{"state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]})",
                                    R"({"inverse3":[{"state":{"cursor_position":{"x":1e9,"y":0,"z":0}}}]})",
                                    R"({"inverse3":[{"state":{"cursor_position":{"x":"1","y":0,"z":0}}}]})",
                                    R"({"inverse3":[{"state":{"cursor_position":[0,0,0]}}]})",
                                    std::string(50000, '['),
                                    std::string(70000, ' ') + whole};
    for (std::size_t cut = 1; cut < whole.size(); cut += 7) broken.push_back(whole.substr(0, cut));
    for (const std::string& text : broken) {
        HaplyState read = some_state();
        read.state.position = {9, 9, 9};
        EXPECT_FALSE(read_haply_state(text, read)) << text.substr(0, 80);
        EXPECT_EQ(read.state.position, Vec3(9, 9, 9));
    }
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
        std::string text = whole;
        for (int k = 0; k < 3; ++k) text[random.bits() % text.size()] = static_cast<char>(random.bits());
        HaplyState read;
        if (read_haply_state(text, read)) {
            ASSERT_TRUE(std::isfinite(glm::length(read.state.position))) << text;
        }
    }
}

/// A server in a thread of its own.
struct Server {
    std::atomic<bool> stop{false}, faulty{false};
    std::atomic<double> force{0};
    std::promise<int> port;
    std::thread thread;

    Server(const TrialModel& f, const brush::Preset& brush, ServerFault fault) {
        thread = std::thread([this, &f, brush, fault] {
            serve_simulated(
                SimulatedArm(device_preset("inverse3"), hand_path(HandMotion::rest, f.place, brush)),
                {.port = 0, .fault = fault, .fault_after = 2.5, .faulty = &faulty}, [this] { return !stop; },
                [this](int p) { port.set_value(p); }, &force);
        });
    }
    ~Server() {
        stop = true;
        thread.join();
    }
};

/// What a session over the wire did.
struct Session {
    bool had_force = false;   ///< there was force
    bool seen = false;        ///< and then what the server did wrong
    std::size_t strokes = 0;  ///< that began and ended
    std::size_t poses = 0;
    double left = -1;  ///< N, on the simulated arm at the end
    LoopStatus status;
};

/// Whether the loop shows that the server has gone wrong, `periods` after it did. A flood shows nothing.
bool is_seen(ServerFault fault, const LoopStatus& status, std::uint64_t periods) {
    switch (fault) {
        case ServerFault::none:
            return true;
        case ServerFault::jumps:
            return status.fault == Fault::jump;
        case ServerFault::silent:  // for 30 ms; then force comes back over half a second
            return status.pass < 1;
        case ServerFault::floods:
            return periods > 500;
        default:
            return status.fault == Fault::silence;
    }
}

// Presses the tuft by a server that goes wrong after 2.5 s, and closes in mid-stroke. Deadlines of threads are no
// matter here: they are judged in virtual time (safety_test.cpp).
Session paint_over_the_wire(ServerFault fault) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    Session session;
    {
        Server server(f, tuft.preset, fault);
        HaplyDevice device(device_preset("inverse3"), {.port = server.port.get_future().get()});
        Loop loop(device, HairSolver(tuft, *f.surface), {.law = {.limits = device.limits()}});
        loop.start();
        StrokeCutter cutter;
        const auto take = [&] {
            SolvedPose pose;
            while (loop.pop(pose)) {
                const StrokeCutter::Cut cut = cutter.add(pose);
                session.poses += cut.poses.size();
                session.strokes += cut.ends;
            }
        };
        std::optional<std::uint64_t> began;  // period
        for (int i = 0; i < 3000 && !session.seen; ++i) {
            std::this_thread::sleep_for(10ms);
            take();
            session.status = loop.status();
            session.had_force = session.had_force || glm::length(session.status.force) > 0.02;
            if (!began && (server.faulty || fault == ServerFault::none)) began = session.status.counts.periods;
            session.seen = session.had_force && session.poses > 100 && began &&
                           is_seen(fault, session.status, session.status.counts.periods - *began);
        }
        loop.stop();
        take();
        session.strokes += cutter.in_stroke();
        cutter.end();
        session.status = loop.status();
        for (int i = 0; i < 200 && server.force > 0; ++i) std::this_thread::sleep_for(10ms);
        session.left = server.force;
    }
    return session;
}

TEST(Haply, AStrokeIsKeptAndNoForceIsLeftWhateverTheServerDoes) {
    const auto expect_kept = [](ServerFault fault, const Session& session) {
        SCOPED_TRACE(static_cast<int>(fault));
        EXPECT_TRUE(session.had_force);
        EXPECT_TRUE(session.seen);
        EXPECT_GE(session.strokes, 1u);
        EXPECT_GT(session.poses, 100u);
        EXPECT_EQ(session.status.force, Vec3{0});
        EXPECT_EQ(session.left, 0);
        if (fault == ServerFault::dies || fault == ServerFault::not_a_number) {
            EXPECT_EQ(session.status.fault, Fault::silence);
        }
    };
    // Two at a time: they wait for their periods, not for a core.
    for (const auto& [one, other] : {std::pair{ServerFault::none, ServerFault::dies},
                                     {ServerFault::not_a_number, ServerFault::jumps},
                                     {ServerFault::silent, ServerFault::floods}}) {
        std::future<Session> beside = std::async(std::launch::async, paint_over_the_wire, other);
        expect_kept(one, paint_over_the_wire(one));
        expect_kept(other, beside.get());
    }
}

TEST(Haply, NoServiceIsNoErrorButSaidInOneLine) {
    HaplyDevice device(device_preset("inverse3"), {.port = 1});
    DeviceState state;
    for (int i = 0; i < 300 && device.trouble().empty(); ++i) std::this_thread::sleep_for(10ms);
    EXPECT_FALSE(device.read(state));
    EXPECT_FALSE(device.connected());
    EXPECT_EQ(device.trouble().text(), "no service answers there");
}

}  // namespace
}  // namespace tuft::haptic
