#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/view/display.h"
#include "core/error.h"
#include "paths.h"
#include "projects.h"

namespace tuft::app {

namespace fs = std::filesystem;

/// Returns why the studio cannot draw on this machine without a display; "": it can.
inline std::string lack_of_opengl() {
    try {
        open_offscreen(16, 16);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

/// The real program, played by scripts without a display.
struct Ran {
    int status = -1;
    std::string out, err;
};

class StudioProgram : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft_studio_" + std::to_string(getpid()) + "_" +
                                                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        if (const std::string lack = lack_of_opengl(); !lack.empty()) GTEST_SKIP() << lack;
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    static std::string read(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }

    // Arguments for exec: a shell that sets the surroundings and becomes the program.
    std::string command(const std::string& script, const std::string& options) {
        std::ofstream(path("script.txt")) << script;
        return "cd '" + folder_.string() + "'; export TUFT_DATA='" + source_folder() + "' XDG_STATE_HOME='" +
               path("state") + "'; unset DISPLAY; exec '" + studio_program() + "' " + options + " --script '" +
               path("script.txt") + "' >'" + path(".out") + "' 2>'" + path(".err") + "'";
    }
    Ran studio(const std::string& script, const std::string& options = "--headless --size 884x520") {
        const int raw = std::system(("bash -c \"" + command(script, options) + "\"").c_str());
        return {WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw), read(path(".out")), read(path(".err"))};
    }
    /// A click on the model, by default in the middle of the bowl's wall, after which the journal has `n` strokes.
    static std::string click_for(int n, const std::string& at = "52%,62%") {
        return "wait-ready\nmove " + at + "\nwait 0.1\npress\nrelease\nwait-ready\nexpect strokes " +
               std::to_string(n) + "\n";
    }
    nlohmann::json tuft(const std::string& arguments) const { return test::tuft(arguments, path("tuft.json")); }

    // Where `places` says that each label lies.
    static std::map<std::string, std::pair<double, double>> places(const std::string& out) {
        std::map<std::string, std::pair<double, double>> found;
        std::istringstream lines(out);
        for (std::string line; std::getline(lines, line);) {
            std::istringstream in(line);
            double x = 0, y = 0;
            std::string name;
            if (in >> x >> y && std::getline(in >> std::ws, name)) found[name] = {x, y};
        }
        return found;
    }

    // The same for each `places` that is followed by `report`.
    static std::vector<std::map<std::string, std::pair<double, double>>> places_in_turn(const std::string& out) {
        std::vector<std::map<std::string, std::pair<double, double>>> all;
        std::istringstream lines(out);
        std::string part;
        for (std::string line; std::getline(lines, line);) {
            if (!line.starts_with('{')) {
                part += line + "\n";
                continue;
            }
            all.push_back(places(part));
            part.clear();
        }
        return all;
    }

    fs::path folder_;
};

/// Few frames are drawn, but all that are looked at: to draw one takes a software driver longer than to handle it.
inline const std::string kBowl =
    "set draw-every 16\nopen " + source_folder() +
    "/models/bowl.ply\nwait-ready\nset texels 512\nclick \"Unwrap and paint\"\nwait-ready\nexpect model\n";
inline const std::string kTwoStrokes =
    "stroke 46%,58% 50%,61% 54%,58%\nset brush goat-medium\nset ink cinnabar\nstroke 44%,57%,0.2 47%,60%,0.6 "
    "51%,58%,0.1\nwait-ready\nexpect strokes 2\n";

}  // namespace tuft::app
