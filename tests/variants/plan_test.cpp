#include "variants/plan.h"

#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include "core/error.h"
#include "paths.h"

namespace tuft::variants {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class PlanFolder : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft_plan_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "in");
        for (const char* name : {"a.ply", "b.ply", "one.inkml", "two.inkml", "in/c.ply"})
            std::ofstream(folder_ / name) << name;
        ::setenv("TUFT_DATA", source_folder().c_str(), 1);
    }
    void TearDown() override { fs::remove_all(folder_); }

    Plan parse(const std::string& text) const { return parse_plan(text, "plan.toml", folder_); }
    std::string fault_of(const std::string& text) const {
        try {
            tasks_of(parse(text));
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    fs::path folder_;
};

constexpr const char* kWhole = R"(
name = "all keys"
seed = 7
models = ["a.ply", { file = "b.ply", unit = "mm", up = "y", atlas_size = 512 }]
strokes = ["one.inkml", "two.inkml"]
inks = ["carbon", "#c03020"]
brushes = ["wolf-small", "wolf*0.5"]
[painting]
substrate = "clay"
film = "wet"
dip = "endless"
fit_brush = true
[placement]
side = "front"
width_mm = 40
turn_deg = -5
mapping = "wrap"
[picture]
of = "planned"
width = 100
height = 80
view_deg = [30, 20]
zoom = 2
[[tolerance]]
name = "jig"
samples = 3
shift_mm = 0.5
turn_deg = 1
scale = 0.01
[[tolerance]]
name = "hand"
samples = 2
hand_mm = 0.3
hand_length_mm = 8
pressure = 0.1
)";

TEST_F(PlanFolder, MakesEachCombinationOncePlannedAndOncePerSample) {
    const std::vector<Task> tasks = tasks_of(parse(kWhole));
    ASSERT_EQ(tasks.size(), 2u * 2 * 2 * 2 * (1 + 3 + 2));
    std::set<std::string> names, hashes;
    for (const Task& t : tasks) names.insert(t.name), hashes.insert(hash_of(t));
    EXPECT_EQ(names.size(), tasks.size());
    EXPECT_EQ(hashes.size(), tasks.size());
    for (std::size_t i = 0; i < tasks.size(); ++i) EXPECT_EQ(tasks[i].sample == 0, i % 6 == 0);
    // Sample k deviates alike for every decoration.
    for (std::size_t i = 6; i < tasks.size(); ++i) EXPECT_EQ(tasks[i].seed, tasks[i % 6].seed);
}

TEST_F(PlanFolder, TaskComesBackFromItsTextWithTheSameHash) {
    for (const Task& t : tasks_of(parse(kWhole))) {
        const Task back = task_of_json(json_of(t), "t");
        EXPECT_EQ(back, t);
        EXPECT_EQ(hash_of(back), hash_of(t));
    }
}

TEST_F(PlanFolder, BrushesStayInHandByThePresentWordAndByTheEarlierOne) {
    const std::string text = "models = ['a.ply']\nstrokes = ['one.inkml']\n[painting]\ndip = ";
    const std::vector<Task> now = tasks_of(parse(text + "'persistent'\n")),
                            before = tasks_of(parse(text + "'carry'\n"));
    EXPECT_EQ(now[0].painting.dip, "persistent");
    EXPECT_EQ(before, now);
    // The tasks of earlier versions say "carry", under a hash of that.
    Task earlier = now[0];
    earlier.painting.dip = "carry";
    EXPECT_EQ(hash_of(now[0]), hash_of(earlier));
}

TEST_F(PlanFolder, HashChangesWithEveryFileAndNothingElse) {
    const std::string text = "models = ['a.ply']\nstrokes = ['one.inkml']\n";
    const std::string before = hash_of(tasks_of(parse(text))[0]);
    EXPECT_EQ(hash_of(tasks_of(parse("# a note\nname = 'other'\n" + text))[0]), before);
    std::ofstream(folder_ / "b.ply") << "changed";
    EXPECT_EQ(hash_of(tasks_of(parse(text))[0]), before);
    for (const char* name : {"a.ply", "one.inkml"}) {
        std::ofstream(folder_ / name) << "changed";
        const std::string after = hash_of(tasks_of(parse(text))[0]);
        EXPECT_NE(after, before) << name;
        std::ofstream(folder_ / name) << name;
        EXPECT_EQ(hash_of(tasks_of(parse(text))[0]), before);
    }
}

TEST_F(PlanFolder, HostilePlansGetOneLine) {
    fs::create_symlink("/etc/hostname", folder_ / "link.ply");
    const std::string good = "models = ['a.ply']\nstrokes = ['one.inkml']\n";
    EXPECT_EQ(fault_of(good), "");
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "names no 'models'"},
        {"models = ['a.ply']", "names no 'strokes'"},
        {"models = ['/etc/passwd']\nstrokes = ['one.inkml']", "does not lie in the folder"},
        {"models = ['../a.ply']\nstrokes = ['one.inkml']", "does not lie in the folder"},
        {"models = ['in/../../a.ply']\nstrokes = ['one.inkml']", "does not lie in the folder"},
        {"models = ['link.ply']\nstrokes = ['one.inkml']", "is a link out of"},
        {"models = ['none.ply']\nstrokes = ['one.inkml']", "there is no file 'none.ply'"},
        {"models = ['a.ply', 'a.ply']\nstrokes = ['one.inkml']", "has 'a.ply' twice"},
        {"models = 'a.ply'\nstrokes = ['one.inkml']", "plan.toml:1: 'models' must be a list"},
        {"models = [7]\nstrokes = ['one.inkml']", "must be a table"},
        {"models = []\nstrokes = ['one.inkml']", "must be a list of 1"},
        {"models = [{ file = 'a.ply', atlas_size = 70000 }]\nstrokes = ['one.inkml']", "whole number from 1 to 65536"},
        {"models = [{ file = 'a.ply', unit = 'parsec' }]\nstrokes = ['one.inkml']", "there is no unit 'parsec'"},
        {good + "ink = ['carbon']", "did you mean 'inks'"},
        {good + "inks = ['carbom']", "carbom"},
        {good + "brushes = ['../x.toml']", "does not lie in the folder"},
        {good + "[[tolerance]]\nname = 'x'\nsamples = 1000000000", "whole number from 1 to"},
        {good + "[[tolerance]]\nname = 'x'\nsamples = 3\nshift_mm = -1", "'shift_mm' must be a number from 0"},
        {good + "[[tolerance]]\nname = 'x'\nsamples = 3\nshift_mm = nan", "'shift_mm' must be a number from 0"},
        {good + "[[tolerance]]\nname = 'x'\nsamples = 3\nhand_mm = inf", "'hand_mm' must be a number from 0"},
        {good + "[[tolerance]]\nname = \"a\\u0001b\"\nsamples = 3", "'name' must be a line of text"},
        {good + "[placement]\nside = 'west'", "there is no side 'west'"},
        {good + "[placement]\nside = 'front'\nat_mm = [0, 0, 0]", "has both"},
        {good + "[picture]\nwidth = 100000", "whole number from 16 to 2048"},
        {good + "[picture]\nof = 'some'", "'of' must be one of all, planned, none"},
        {good + "[painting]\nfilm = 'oil'", "'film' must be one of"},
        {good + "name = ", "plan.toml:3"},
        {"models = " + std::string(50'000, '[') + std::string(50'000, ']'), "plan.toml"}};
    for (const auto& [text, words] : cases) {
        const std::string fault = fault_of(text);
        EXPECT_THAT(fault, HasSubstr(words)) << text.substr(0, 200);
        EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
        EXPECT_LT(fault.size(), 400u);
    }
}

TEST_F(PlanFolder, TooManyVariantsAreRefusedBeforeAnyIsMade) {
    std::string text = "models = ['a.ply']\nstrokes = ['one.inkml']\ninks = [";
    for (int i = 0; i < 9999; ++i) text += "'#" + std::to_string(100000 + i) + "', ";
    text += "'carbon']\n[[tolerance]]\nname = 'x'\nsamples = 10000\n";
    EXPECT_THAT(fault_of(text), HasSubstr("makes 100010000 variants; at most 100000"));
}

TEST_F(PlanFolder, ATaskFileWithOtherValuesIsRefused) {
    const Task good = tasks_of(parse(kWhole))[1];
    for (const auto change : {+[](Task& t) { t.tolerance.shift_mm = 1e9; }, +[](Task& t) { t.picture.width = 1 << 30; },
                              +[](Task& t) { t.model.up = "x"; },
                              +[](Task& t) {
                                  t.placement.at_mm = {1, 2};
                              },
                              +[](Task& t) {
                                  t.picture.view_deg = {0, 91};
                              },
                              +[](Task& t) { t.name = "a\nb"; }}) {
        Task t = good;
        change(t);
        EXPECT_THROW(task_of_json(json_of(t), "t"), Error);
    }
    for (const char* text : {"", "{", "[]", "7", "{\"format\": \"tuft variant 1\"}", "{\"format\": \"x\"}"})
        EXPECT_THROW(task_of_json(text, "t"), Error) << text;
}

}  // namespace
}  // namespace tuft::variants
