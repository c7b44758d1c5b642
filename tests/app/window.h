#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "io/project/project.h"
#include "paths.h"
#include "projects.h"

namespace tuft::test {

namespace fs = std::filesystem;

/// The real window on a real X server, driven as by a person's hand through XTEST.
class Window : public testing::Test {
  protected:
    static bool installed(const std::string& tool) {
        return std::system(("command -v " + tool + " >/dev/null").c_str()) == 0;
    }

    void SetUp() override {
        for (const char* tool : {"Xvfb", "xdotool"})
            if (!installed(tool)) GTEST_SKIP() << tool << " is not installed: no window is tested";
        make_folder();
        server_ = start({"Xvfb", "-displayfd", "3", "-screen", "0", "1000x640x24", "-nolisten", "tcp", "-noreset"},
                        "3>'" + path("display") + "'");
        take_display();
    }
    void make_folder() {
        folder_ = fs::path(testing::TempDir()) / ("tuft_window_" + std::to_string(getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    // Of the server that was started with -displayfd 3.
    void take_display() {
        wait_for("the X server", [&] { return read("display").find('\n') != std::string::npos; });
        display_ = ":" + read("display").substr(0, read("display").find('\n'));
    }
    void TearDown() override {
        end(studio_, SIGKILL);
        end(server_, SIGTERM);
        if (!folder_.empty()) fs::remove_all(folder_);
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string read(const std::string& name) const {
        std::ifstream in(folder_ / name, std::ios::binary);
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }
    pid_t start(const std::vector<std::string>& words, const std::string& rest) const {
        std::string line = "exec";
        for (const std::string& word : words) line += " '" + word + "'";
        line += " >>'" + path("log") + "' 2>&1 " + rest;
        const pid_t child = fork();
        if (child == 0) {
            execl("/bin/bash", "bash", "-c", line.c_str(), nullptr);
            _exit(127);
        }
        return child;
    }
    static void end(pid_t& child, int signal) {
        if (child <= 0) return;
        kill(child, signal);
        int status = 0;
        waitpid(child, &status, 0);
        child = 0;
    }
    // The clock only bounds how long a broken program is waited for.
    void wait_for(const std::string& what, const std::function<bool()>& done) const {
        for (int i = 0; i < 900; ++i) {
            if (done()) return;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        throw std::runtime_error("waited in vain for " + what + "\n" + read("log"));
    }
    void open_studio(const std::string& file, std::vector<std::string> options = {}, const std::string& out = "") {
        setenv("DISPLAY", display_.c_str(), 1);
        setenv("TUFT_DATA", source_folder().c_str(), 1);
        setenv("XDG_STATE_HOME", path("state").c_str(), 1);
        options.insert(options.begin(), {studio_program(), "--size", "1000x640"});
        if (!file.empty()) options.push_back(file);
        studio_ = start(options, out.empty() ? "" : ">'" + path(out) + "'");
        wait_for("the window", [&] { return run("xdotool search --name 'tuft studio'") == 0; });
        run("xdotool search --name 'tuft studio' windowfocus");
    }
    int run(const std::string& line) const {
        return std::system(("DISPLAY=" + display_ + " " + line + " >/dev/null 2>&1").c_str());
    }
    void keys(const std::string& words) const { run("xdotool key --delay 120 " + words); }
    void type(const std::string& text) const { run("xdotool type --delay 15 '" + text + "'"); }
    bool titled(const std::string& title) const { return run("xdotool search --name '" + title + "'") == 0; }
    // A stroke along points, some pixels at a time, as a hand moves.
    void stroke(const std::vector<std::pair<int, int>>& points) const {
        std::string line = "xdotool mousemove " + std::to_string(points[0].first) + " " +
                           std::to_string(points[0].second) + " sleep 0.25 mousedown 1 sleep 0.1";
        for (std::size_t i = 1; i < points.size(); ++i)
            for (int k = 1; k <= 12; ++k) {
                const auto at = [&](int a, int b) { return std::to_string(a + (b - a) * k / 12); };
                line += " mousemove " + at(points[i - 1].first, points[i].first) + " " +
                        at(points[i - 1].second, points[i].second) + " sleep 0.01";
            }
        run(line + " sleep 0.15 mouseup 1 sleep 0.15");
    }
    // Strokes in the project that is being worked on; -1: there is none yet.
    int kept(const std::string& file = "") const {
        std::string found = file;
        std::error_code ec;
        if (file.empty())
            for (const auto& entry : fs::directory_iterator(path("state") + "/tuft/sessions", ec))
                if (entry.path().extension() == ".tuft") found = entry.path();
        if (found.empty() || !fs::exists(found)) return -1;
        try {
            return static_cast<int>(io::Project::open(found, {.access = io::Access::read}).n_strokes());
        } catch (const std::exception&) {
            return -1;  // being written
        }
    }
    nlohmann::json tuft(const std::string& arguments) const { return test::tuft(arguments, path("tuft.json")); }

    fs::path folder_;
    std::string display_;
    pid_t server_ = 0, studio_ = 0;
};

}  // namespace tuft::test
