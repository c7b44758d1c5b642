#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "program.h"

namespace tuft::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::HasSubstr;

class Variants : public Program {
  protected:
    /// A plan of one small sheet, a stroke, an ink and `samples` deviations.
    void write_plan(int samples) const {
        write("sheet.obj", "v -20 -15 0\nv 20 -15 0\nv 20 15 0\nv -20 15 0\nf 1 2 3 4\n");
        write("line.inkml", stroke_file());
        write("plan.toml",
              "name = 'lines'\nmodels = [{ file = 'sheet.obj', unit = 'mm', up = 'z', atlas_size = 128 }]\n"
              "strokes = ['line.inkml']\ninks = ['carbon']\n"
              "[[tolerance]]\nname = 'jig'\nsamples = " +
                  std::to_string(samples) +
                  "\nshift_mm = 1\nturn_deg = 2\nhand_mm = 0.2\npressure = 0.1\n"
                  "[picture]\nof = 'planned'\nwidth = 32\nheight = 24\n");
    }
    std::string in_folder(const std::string& name) const { return "'" + path(name) + "'"; }
    Ran lay_out(const std::string& jobs) const {
        return tuft("variants " + in_folder("plan.toml") + " -o " + in_folder(jobs));
    }
    /// All of the table but the times.
    std::map<std::size_t, nlohmann::json> table(const std::string& jobs) const {
        std::map<std::size_t, nlohmann::json> rows;
        const nlohmann::json table = nlohmann::json::parse(read(path(jobs + "/table.json")));
        for (nlohmann::json row : table["variants"]) {
            row.erase("seconds");
            const auto index = row["task"].get<std::size_t>();
            EXPECT_FALSE(rows.contains(index)) << "twice: " << index;
            rows[index] = std::move(row);
        }
        return rows;
    }
    /// What there is in results/ besides one folder per task.
    std::vector<std::string> left_over(const std::string& jobs, std::size_t tasks) const {
        std::vector<std::string> other;
        std::size_t folders = 0;
        for (const auto& entry : fs::directory_iterator(path(jobs + "/results")))
            if (entry.path().filename().string().size() == 32)
                ++folders;
            else
                other.push_back(entry.path().filename().string());
        EXPECT_EQ(folders, tasks);
        return other;
    }
};

std::vector<pid_t> children_of(pid_t parent) {
    std::ifstream list("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children");
    std::vector<pid_t> pids;
    for (pid_t pid; list >> pid;) pids.push_back(pid);
    return pids;
}

pid_t start_program(const std::vector<std::string>& words) {
    const pid_t pid = ::fork();
    if (pid != 0) return pid;
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::setenv("TUFT_DATA", source_folder().c_str(), 1);
    for (const int fd : {1, 2}) ::dup2(::open("/dev/null", O_WRONLY), fd);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
}

TEST_F(Variants, OneAndFourWorkersGiveTheSameTable) {
    write_plan(19);
    for (const char* jobs : {"one", "four"}) {
        ASSERT_EQ(lay_out(jobs).status, 0);
        const Ran ran =
            tuft("variants " + in_folder(jobs) + " --run --quiet --threads " + (jobs[0] == 'o' ? "1" : "4"));
        ASSERT_EQ(ran.status, 0) << ran.err;
        EXPECT_THAT(ran.out, HasSubstr("20 of 20 variants done, 0 failed, 0 open"));
        EXPECT_THAT(left_over(jobs, 20), testing::IsEmpty());
        for (const char* file : {"contact-sheet-01.png", "tolerance-map-01-ink.png", "tolerance-map-01-moved.png",
                                 "tolerance.csv", "table.csv", "slurm.sh", "parallel.sh", "openjd.yaml"})
            EXPECT_TRUE(fs::exists(path(std::string(jobs) + "/" + file))) << file;
    }
    const std::string png = read(path("one/tolerance-map-01-ink.png"));
    EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x01\xe0\0\0\x01\x68", 8)) << "480 x 360, as the scale needs";
    const auto one = table("one");
    EXPECT_EQ(one.size(), 20u);
    EXPECT_EQ(one, table("four"));
    for (const auto& [i, row] : one) {
        EXPECT_EQ(row["state"], "done");
        EXPECT_EQ(row["mismatches"], 0);
        EXPECT_GT(row["ink_area_mm2"].get<double>(), 1);
    }
}

TEST_F(Variants, KilledAtAnyTimeNoneIsLostOrDouble) {
    write_plan(29);
    ASSERT_EQ(lay_out("whole").status, 0);
    ASSERT_EQ(tuft("variants " + in_folder("whole") + " --run --quiet --threads 2").status, 0);
    ASSERT_EQ(lay_out("killed").status, 0);
    std::mt19937 random(3);
    bool ended = false;
    for (int run = 0; run < 6 && !ended; ++run) {
        const pid_t parent = start_program({tuft_program(), "variants", path("killed"), "--run", "--threads", "2"});
        for (int kill = 0; kill < 6 && !ended; ++kill) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50 + random() % 250));
            const std::vector<pid_t> workers = children_of(parent);
            if (!workers.empty()) ::kill(workers[random() % workers.size()], SIGKILL);
            ended = ::waitpid(parent, nullptr, WNOHANG) == parent;
        }
        if (ended) break;
        ::kill(parent, SIGKILL);  // its workers end when they next report
        ::waitpid(parent, nullptr, 0);
    }
    const Ran last = tuft("variants " + in_folder("killed") + " --run --quiet --threads 2");
    for (int i = 0; i < 100 && last.out.find(" 0 open") == std::string::npos; ++i) {
        std::this_thread::sleep_for(100ms);  // orphans of the last kill still had a task
        if (tuft("variants " + in_folder("killed") + " --run --quiet --threads 2").status == 0) break;
    }
    EXPECT_THAT(left_over("killed", 30), testing::IsEmpty());
    EXPECT_EQ(table("killed").size(), 30u);
    EXPECT_EQ(table("killed"), table("whole"));
}

TEST_F(Variants, ADamagedResultIsPaintedAgain) {
    write_plan(1);
    ASSERT_EQ(lay_out("jobs").status, 0);
    ASSERT_EQ(tuft("variants " + in_folder("jobs") + " --run --quiet").status, 0);
    const auto before = table("jobs");
    const std::string hash = before.at(1).at("hash");
    fs::resize_file(path("jobs/results/" + hash + "/coverage.bin"), 5);
    const Ran ran = tuft("variants " + in_folder("jobs") + " --run");
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("1 damaged result is painted again"));
    EXPECT_EQ(table("jobs"), before);
}

TEST_F(Variants, AFailedTaskIsNamedAndTheOthersArePainted) {
    write_plan(1);
    const std::string plan = read(path("plan.toml"));
    write("broken.obj", "v 0 0 0\n");
    write("plan.toml", "models = ['sheet.obj', 'broken.obj']\n" + plan.substr(plan.find("strokes")));
    ASSERT_EQ(lay_out("jobs").status, 0);
    const Ran ran = tuft("variants " + in_folder("jobs") + " --run --quiet");
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("2 of 4 failed, the first task 2 (broken line carbon)"));
    EXPECT_THAT(ran.out, HasSubstr("2 of 4 variants done"));
    const Ran one = tuft("run-task " + in_folder("jobs") + " 2");
    EXPECT_EQ(one.status, 1);
    EXPECT_EQ(one.error_lines(), 1) << one.err;
}

TEST_F(Variants, WrongCommandLinesGetOneLine) {
    write_plan(1);
    for (const auto& [arguments, status] :
         std::vector<std::pair<std::string, int>>{{"variants " + in_folder("plan.toml"), 2},
                                                  {"variants " + in_folder("none.toml") + " -o x", 1},
                                                  {"variants " + in_folder("") + " --run", 1},
                                                  {"variants " + in_folder("plan.toml") + " -o " + in_folder(""), 1},
                                                  {"run-task " + in_folder("") + " 0", 1},
                                                  {"run-task " + in_folder(""), 2},
                                                  {"run-task x -3", 2},
                                                  {"run-task x 0 --rest", 2},
                                                  {"run-task x --count 2 --rest", 2}}) {
        const Ran ran = tuft(arguments);
        EXPECT_EQ(ran.status, status) << arguments << ran.err;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    ASSERT_EQ(lay_out("jobs").status, 0);
    EXPECT_THAT(tuft("run-task " + in_folder("jobs") + " 9").err, HasSubstr("there is no task 9; they are 0 to 1"));
}

TEST_F(Variants, GnuParallelRunsThemAll) {
    if (std::system("command -v parallel >/dev/null") != 0) GTEST_SKIP() << "GNU parallel is not installed";
    write_plan(2);
    ASSERT_EQ(lay_out("jobs").status, 0);
    const Ran ran = run("/bin/sh", in_folder("jobs/parallel.sh") + " --jobs 2", "export HOME='" + path("") + "';");
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(tuft("variants " + in_folder("jobs") + " --gather").out, HasSubstr("3 of 3 variants done"));
}

TEST_F(Variants, AnArrayJobOfSlurmPaintsThemAll) {
    const std::string script = source_folder() + "/samples/variants/slurm-node.sh";
    const Ran node = run("/bin/bash", "'" + script + "' start " + in_folder("slurm"));
    if (node.status == 77) GTEST_SKIP() << node.err;
    ASSERT_EQ(node.status, 0) << node.err;
    write_plan(3);
    EXPECT_EQ(lay_out("local").status, 0);
    EXPECT_EQ(tuft("variants " + in_folder("local") + " --run --quiet").status, 0);
    EXPECT_EQ(lay_out("jobs").status, 0);
    const Ran ran =
        run("/usr/bin/sbatch", "--wait " + in_folder("jobs/slurm.sh"), node.out.substr(0, node.out.find('\n')) + ";");
    EXPECT_EQ(ran.status, 0) << ran.err;
    run("/bin/bash", "'" + script + "' stop " + in_folder("slurm"));
    EXPECT_EQ(tuft("variants " + in_folder("jobs") + " --gather").status, 0);
    EXPECT_EQ(table("jobs").size(), 4u);
    EXPECT_EQ(table("jobs"), table("local"));
    std::this_thread::sleep_for(500ms);  // for what its daemons still write
}

}  // namespace
}  // namespace tuft::test
