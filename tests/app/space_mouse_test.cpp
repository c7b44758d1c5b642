#include "app/input/space_mouse.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <functional>
#include <thread>

#include "space_daemon.h"

namespace tuft::app {
namespace {

using test::SpaceDaemon;

// The clock only bounds how long a broken program is waited for.
bool comes_true(const std::function<bool()>& what) {
    for (int i = 0; i < 2000; ++i) {
        if (what()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

class SpaceMouseTest : public testing::Test {
  protected:
    void SetUp() override {
        std::signal(SIGPIPE, SIG_IGN);
        setenv("SPNAV_SOCKET", path_.c_str(), 1);
    }
    void TearDown() override {
        unsetenv("SPNAV_SOCKET");
        unlink(path_.c_str());
    }
    std::string path_ = testing::TempDir() + "tuft_spnav_" + std::to_string(getpid());
    std::atomic<int> woken_{0};
};

TEST_F(SpaceMouseTest, TheDisplacementOfTheCapIsItsDeflectionTimesItsDuration) {
    SpaceDaemon daemon(path_);
    const auto mouse = open_space_mouse([this] { ++woken_; }, 0.02);
    if (!mouse) GTEST_SKIP() << "built without libspnav: no SpaceMouse is tested";
    ASSERT_TRUE(daemon.accept());
    EXPECT_FALSE(mouse->held());
    daemon.motion({175, 0, 350, 0, -70, 0});
    ASSERT_TRUE(comes_true([&] { return mouse->held(); }));
    EXPECT_GT(woken_, 0);
    EventQueue events;
    mouse->merge(events, 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    mouse->merge(events, 2);
    ASSERT_GE(events.size(), 1u);
    const Event& e = events.back();
    EXPECT_EQ(e.kind, Event::Kind::fly);
    // At least the 20 ms slept, at most the 0.1 s that one look covers, of 0.5 deflections to the right.
    EXPECT_GE(e.push.x, 0.5 * 0.020);
    EXPECT_LE(e.push.x, 0.5 * 0.1 + 1e-12);
    // The other axes went the same time: 1 away from the person, -0.2 about the upright.
    EXPECT_NEAR(e.push.z / e.push.x, -2, 1e-12);
    EXPECT_NEAR(e.twist.y / e.push.x, -0.4, 1e-12);
    EXPECT_EQ(e.push.y, 0);
    EXPECT_EQ(e.twist.x, 0);

    daemon.button(1);
    daemon.motion({});
    ASSERT_TRUE(comes_true([&] { return !mouse->held(); }));
    events.clear();
    mouse->merge(events, 3);
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events.back().kind, Event::Kind::cap_button);
    EXPECT_EQ(events.back().button, 1);
    events.clear();
    mouse->merge(events, 4);
    EXPECT_TRUE(events.empty()) << "a cap at rest goes nowhere";
}

TEST_F(SpaceMouseTest, AnUnpluggedOneStandsStillAndOneThatComesBackIsTaken) {
    auto daemon = std::make_unique<SpaceDaemon>(path_);
    const auto mouse = open_space_mouse([] {}, 0.02);
    if (!mouse) GTEST_SKIP() << "built without libspnav: no SpaceMouse is tested";
    ASSERT_TRUE(daemon->accept());
    daemon->motion({0, 350, 0, 0, 0, 0});
    ASSERT_TRUE(comes_true([&] { return mouse->held(); }));
    daemon->device(1);  // the device is unplugged
    std::string reported;
    ASSERT_TRUE(comes_true([&] { return !(reported = mouse->take_fault().text()).empty(); }));
    EXPECT_NE(reported.find("unplugged"), std::string::npos) << reported;
    EXPECT_FALSE(mouse->held());

    daemon->motion({0, 0, 0, 350, 0, 0});
    ASSERT_TRUE(comes_true([&] { return mouse->held(); }));
    daemon.reset();  // the daemon is killed
    ASSERT_TRUE(comes_true([&] { return !(reported = mouse->take_fault().text()).empty(); }));
    EXPECT_NE(reported.find("ended"), std::string::npos) << reported;
    EXPECT_FALSE(mouse->held());

    daemon = std::make_unique<SpaceDaemon>(path_);
    ASSERT_TRUE(daemon->accept());
    daemon->motion({0, 0, 0, 0, 350, 0});
    EXPECT_TRUE(comes_true([&] { return mouse->held(); }));
}

TEST_F(SpaceMouseTest, WithoutADaemonNothingComesAndNothingHangs) {
    const auto mouse = open_space_mouse([this] { ++woken_; }, 0.005);
    if (!mouse) GTEST_SKIP() << "built without libspnav: no SpaceMouse is tested";
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EventQueue events;
    mouse->merge(events, 1);
    EXPECT_TRUE(events.empty());
    EXPECT_TRUE(mouse->take_fault().empty());
    EXPECT_EQ(woken_, 0);
}

}  // namespace
}  // namespace tuft::app
