#include "variants/jobs.h"

#include <gmock/gmock.h>

#include <fstream>

#include "core/error.h"
#include "paths.h"
#include "variants/gather.h"
#include "variants/scripts.h"

namespace tuft::variants {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class JobsFolder : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft_jobs_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        std::ofstream(folder_ / "a.ply") << "a";
        std::ofstream(folder_ / "one.inkml") << "one";
        ::setenv("TUFT_DATA", source_folder().c_str(), 1);
    }
    void TearDown() override { fs::remove_all(folder_); }

    Plan plan(int samples = 3) const {
        return parse_plan("models = ['a.ply']\nstrokes = ['one.inkml']\n[[tolerance]]\nname = 'jig'\nsamples = " +
                              std::to_string(samples) + "\nshift_mm = 1\n",
                          "plan.toml", folder_);
    }
    Jobs jobs(int samples = 3) const {
        const Plan p = plan(samples);
        return lay_out(p, tasks_of(p), folder_ / "jobs");
    }
    /// What takes the place of painting: all follows from the seed.
    static Outcome outcome(const Task& task) {
        Outcome out;
        out.figures.canvas_hash = std::to_string(task.seed);
        out.figures.view_deg = {30, 20};
        out.coverage.n_slots = 9;
        out.coverage.slots = {2, 5};
        out.coverage.painted = {{task.seed, 1, 2, 3}, {4, 5, 6, 7}};
        out.coverage.feet = {Vec3f(0.5f, 0, 0)};
        out.picture = {16, 16, std::vector<std::uint8_t>(16 * 16 * 3, 77)};
        return out;
    }

    fs::path folder_;
};

TEST_F(JobsFolder, ATaskRunsOnceAndItsResultComesBack) {
    const Jobs j = jobs();
    ASSERT_EQ(j.size(), 4u);
    ContentHashes known;
    int painted = 0;
    const PaintTask paint = [&](const Task& t) { return ++painted, outcome(t); };
    EXPECT_EQ(j.state(1), TaskState::open);
    EXPECT_EQ(run_task(j, 1, paint, known), TaskResult::painted);
    EXPECT_EQ(run_task(j, 1, paint, known), TaskResult::done_before);
    EXPECT_EQ(painted, 1);
    EXPECT_EQ(j.state(1), TaskState::done);
    const Outcome out = outcome(j.task(1));
    EXPECT_EQ(j.figures(1), out.figures);
    EXPECT_EQ(j.coverage(1), out.coverage);
    EXPECT_FALSE(j.remove_damaged(1));
}

TEST_F(JobsFolder, ATaskThatAnotherHasIsLeft) {
    const Jobs j = jobs();
    ContentHashes known;
    {
        const auto other = j.lock(2);
        ASSERT_TRUE(other);
        EXPECT_EQ(run_task(j, 2, outcome, known), TaskResult::taken);
    }
    EXPECT_EQ(run_task(j, 2, outcome, known), TaskResult::painted);
}

TEST_F(JobsFolder, AFaultIsStoredAndAStopIsNot) {
    const Jobs j = jobs();
    ContentHashes known;
    EXPECT_EQ(run_task(
                  j, 0, [](const Task&) -> Outcome { throw Error("no such brush"); }, known),
              TaskResult::failed);
    EXPECT_EQ(j.state(0), TaskState::failed);
    EXPECT_EQ(j.failure(0), "no such brush");
    EXPECT_THROW(run_task(
                     j, 1, [](const Task&) -> Outcome { throw Cancelled(); }, known),
                 Cancelled);
    EXPECT_EQ(j.state(1), TaskState::open);
    EXPECT_EQ(run_task(j, 0, outcome, known), TaskResult::painted);  // again, and now it goes
    EXPECT_EQ(j.state(0), TaskState::done);
}

TEST_F(JobsFolder, AFileThatChangedIsNotPaintedUnderItsOldHash) {
    const Jobs j = jobs();
    std::ofstream(folder_ / "one.inkml") << "two";
    ContentHashes known;
    EXPECT_EQ(run_task(j, 0, outcome, known), TaskResult::failed);
    EXPECT_THAT(j.failure(0), HasSubstr("'one.inkml' has changed since the tasks were written"));
}

TEST_F(JobsFolder, AnEnlargedPlanRetainsItsResults) {
    ContentHashes known;
    const Jobs before = jobs(3);
    for (std::size_t i = 0; i < before.size(); ++i) run_task(before, i, outcome, known);
    const Jobs more = jobs(5), less = jobs(2);
    EXPECT_EQ(more.size(), 6u);
    EXPECT_EQ(less.size(), 3u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(more.state(i), TaskState::done);
    EXPECT_EQ(more.state(5), TaskState::open);
    EXPECT_FALSE(fs::exists(folder_ / "jobs/tasks/000003.json"));
}

TEST_F(JobsFolder, DamagedResultsAreFoundAndOpenAgain) {
    const Jobs j = jobs();
    ContentHashes known;
    for (const char* name : {"result.json", "coverage.bin", "picture.png"})
        for (const bool shorter : {true, false}) {
            ASSERT_EQ(run_task(j, 0, outcome, known), TaskResult::painted);
            const fs::path file = j.result_folder(0) / name;
            if (shorter) {
                fs::resize_file(file, fs::file_size(file) / 2);
            } else {
                std::fstream f(file, std::ios::in | std::ios::out | std::ios::binary);
                f.seekp(0);
                f.put('#');
            }
            EXPECT_TRUE(j.remove_damaged(0)) << name;
            EXPECT_EQ(j.state(0), TaskState::open);
        }
}

TEST_F(JobsFolder, OtherFoldersAreLeftAlone) {
    const Plan p = plan();
    EXPECT_THROW(lay_out(p, tasks_of(p), folder_), Error);  // has the plan's files
    EXPECT_THROW(Jobs{folder_}, Error);
    const Jobs j = jobs();
    for (const char* text :
         {"", "{}", "[1]", "{\"format\": \"tuft variants 1\", \"name\": 7}",
          "{\"format\": \"tuft variants 1\", \"name\": \"\", \"folder\": \"/\", \"hashes\": [\"../../x\"]}"}) {
        std::ofstream(folder_ / "jobs/plan.json") << text;
        EXPECT_THROW(Jobs{folder_ / "jobs"}, Error) << text;
    }
}

// A full disk or a power cut while the tasks are written leaves them without their plan.
TEST_F(JobsFolder, AFolderThatWasStoppedHalfWayIsLaidOutAgain) {
    jobs();
    fs::remove(folder_ / "jobs" / "plan.json");
    EXPECT_EQ(jobs().size(), 4u);
}

TEST_F(JobsFolder, CoverageFromForeignBytesIsRefused) {
    const Coverage good = outcome(Task{.seed = 3}).coverage;
    const std::vector<char> bytes = bytes_of(good);
    EXPECT_EQ(coverage_of_bytes(bytes, "c"), good);
    for (std::size_t n = 0; n < bytes.size(); ++n)
        EXPECT_THROW(coverage_of_bytes({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)}, "c"), Error);
    std::vector<char> huge = bytes;
    for (std::size_t i = 12; i < 16; ++i) huge[i] = '\xff';  // the number of tiles
    EXPECT_THROW(coverage_of_bytes(huge, "c"), Error);
}

TEST_F(JobsFolder, TheTableHasOneRowPerTask) {
    const Jobs j = jobs();
    ContentHashes known;
    run_task(j, 0, outcome, known);
    run_task(
        j, 1, [](const Task&) -> Outcome { throw Error("a, \"b\""); }, known);
    const std::vector<Row> rows = gather(j);
    ASSERT_EQ(rows.size(), 4u);
    const std::string csv = csv_of(j, rows);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
    EXPECT_THAT(csv, HasSubstr("\"a, \"\"b\"\"\""));
    EXPECT_THAT(csv, HasSubstr(j.hash(3) + ",a one jig 3,a.ply,one.inkml,,,jig,3,open"));
}

TEST_F(JobsFolder, ScriptsCoverEveryTaskOnce) {
    for (const std::size_t n : {1u, 999u, 1000u, 1001u, 2500u, 100'000u}) {
        const std::string text = slurm_script({.folder = "/a b/it's", .program = "/bin/tuft", .name = "x", .tasks = n});
        const std::size_t at = text.find("--array=0-") + 10;
        const std::size_t last = std::stoul(text.substr(at));
        const std::size_t chunk = std::stoul(text.substr(text.find("TASK_ID * ") + 10));
        EXPECT_LT(last, 1001u);  // MaxArraySize
        EXPECT_GE((last + 1) * chunk, n);
        EXPECT_LT(last * chunk, n);
        EXPECT_THAT(text, HasSubstr("'/a b/it'\\''s'"));
    }
}

// openjd-model: "The default value of PATH parameter ... is an absolute path. Default paths must be relative".
TEST_F(JobsFolder, AJobTemplateNamesItsOwnFolder) {
    const std::string text = openjd_template({.folder = "/a b", .program = "/bin/tuft", .name = "x", .tasks = 7});
    EXPECT_THAT(text, HasSubstr("type: PATH\n    objectType: DIRECTORY\n    dataFlow: INOUT\n    default: .\n"));
    EXPECT_THAT(text, testing::Not(HasSubstr("/a b")));
    EXPECT_THAT(text, HasSubstr("range: \"0-6\""));
}

}  // namespace
}  // namespace tuft::variants
