#include <gtest/gtest.h>
#include <imgui.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/input/imgui_feed.h"
#include "app/script/script.h"
#include "core/error.h"

namespace tuft::app {
namespace {

class Feed : public testing::Test {
  protected:
    void SetUp() override {
        ImGui::CreateContext();
        start_imgui_feed();
    }
    void TearDown() override { ImGui::DestroyContext(); }
    EventQueue queue_;
};

TEST_F(Feed, EveryMovementBetweenTwoFramesComesThrough) {
    for (int i = 0; i < 1000; ++i) queue_.push_back({.kind = Event::Kind::move, .time = 0.001 * i, .x = 1.0 * i});
    const std::vector<Event> events = feed_imgui(queue_, 100, 100, 0.1);
    ASSERT_EQ(events.size(), 1000u);
    EXPECT_EQ(events[123].x, 123);
    EXPECT_EQ(ImGui::GetIO().MousePos.x, 999);
}

TEST_F(Feed, AQuickClickIsSeenAsPressAndThenRelease) {
    queue_.push_back({.kind = Event::Kind::press, .x = 5, .y = 5});
    queue_.push_back({.kind = Event::Kind::release, .x = 5, .y = 5});
    EXPECT_EQ(feed_imgui(queue_, 100, 100, 0.1).size(), 1u);
    EXPECT_TRUE(ImGui::GetIO().MouseDown[0]);
    EXPECT_EQ(feed_imgui(queue_, 100, 100, 0.1).size(), 1u);
    EXPECT_FALSE(ImGui::GetIO().MouseDown[0]);
}

TEST_F(Feed, KeysOutsideTheTableAreHarmless) {
    for (const int key : {-1, -100, 512, 100000}) queue_.push_back({.kind = Event::Kind::key_down, .key = key});
    for (int i = 0; i < 4; ++i) EXPECT_EQ(feed_imgui(queue_, 100, 100, 0.1).size(), 1u);
}

std::string error_of(const std::string& text) {
    const std::string path = testing::TempDir() + "/tuft_script_test_" + std::to_string(getpid()) + ".txt";
    std::ofstream(path) << text;
    std::string fault;
    try {
        parse_script(path);
    } catch (const Error& error) {
        fault = std::string(error.what()).substr(path.size());
    }
    std::filesystem::remove(path);
    return fault;
}

TEST(ScriptParse, ReadsPlacesQuotesAndComments) {
    const std::string path = testing::TempDir() + "/tuft_script_good_" + std::to_string(getpid()) + ".txt";
    std::ofstream(path) << "# a comment\n\nstroke 10,20 30%,40%,0.5  # more\nclick \"Frame all\"\n";
    const auto commands = parse_script(path);
    std::filesystem::remove(path);
    ASSERT_EQ(commands.size(), 2u);
    EXPECT_EQ(commands[0].line, 3);
    EXPECT_EQ(commands[0].points[0].x, 10);
    EXPECT_LT(commands[0].points[0].pressure, 0);
    EXPECT_TRUE(commands[0].points[1].relative_x);
    EXPECT_EQ(commands[0].points[1].y, 0.4);
    EXPECT_EQ(commands[0].points[1].pressure, 0.5);
    EXPECT_EQ(commands[1].words[0], "Frame all");
}

TEST(ScriptParse, NamesTheLineOfAMistake) {
    EXPECT_EQ(error_of("undo\nscrenshot a.png\n"), ":2: unknown command 'screnshot', did you mean 'screenshot'?");
    EXPECT_EQ(error_of("move here,there\n"), ":1: 'here,there' is not a place; write X,Y or X%,Y%");
    EXPECT_EQ(error_of("click \"Open\n"), ":1: a quote is not closed");
    EXPECT_EQ(error_of("wait\n"), ":1: 'wait' needs 1 word(s) after it");
}

}  // namespace
}  // namespace tuft::app
