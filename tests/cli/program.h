#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "paths.h"

/// Runs the real program, as a shell would.
namespace tuft::test {

struct Ran {
    int status = -1;  ///< exit status, or 128 + signal
    std::string out, err;

    /// Lines on standard error.
    long error_lines() const { return std::count(err.begin(), err.end(), '\n'); }
};

class Program : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("tuft_cli_" + std::to_string(::getpid()) + "_" +
                   std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string model(const std::string& name) const { return source_folder() + "/models/" + name; }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }

    /// `prefix` goes before the program, such as "ulimit -f 8;".
    Ran tuft(const std::string& arguments, const std::string& prefix = "") const {
        return run(tuft_program(), arguments, prefix);
    }
    /// The same of another program, such as a copy of it.
    Ran run(const std::string& program, const std::string& arguments, const std::string& prefix = "") const {
        const std::string command = "export TUFT_DATA='" + source_folder() + "'; " + prefix + " '" + program + "' " +
                                    arguments + " >'" + path(".out") + "' 2>'" + path(".err") + "'";
        const int raw = std::system(("bash -c \"" + escaped(command) + "\"").c_str());
        Ran ran;
        ran.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
        ran.out = read(path(".out"));
        ran.err = read(path(".err"));
        return ran;
    }

    static std::string read(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }

    /// Pen data of one line of `length` mm on the model near `origin`.
    static std::string stroke_file(const std::string& origin = "0 0 0", const std::string& brush = "wolf-small",
                                   double length = 10) {
        std::ostringstream ink;
        ink << "<?xml version=\"1.0\"?>\n<ink xmlns=\"http://www.w3.org/2003/InkML\">\n<definitions>"
               "<traceFormat xml:id=\"f\"><channel name=\"X\" type=\"decimal\" units=\"mm\"/>"
               "<channel name=\"Y\" type=\"decimal\" units=\"mm\"/>"
               "<channel name=\"P\" type=\"decimal\" min=\"0\" max=\"1\"/>"
               "<channel name=\"T\" type=\"decimal\" units=\"ms\"/></traceFormat>"
               "<context xml:id=\"c\" traceFormatRef=\"#f\"/></definitions>\n"
               "<traceGroup contextRef=\"#c\"><annotation type=\"tuft:brush\">"
            << brush
            << "</annotation>"
               "<annotation type=\"tuft:origin\">"
            << origin
            << "</annotation>"
               "<annotation type=\"tuft:right\">1 0 0</annotation>"
               "<annotation type=\"tuft:down\">0 -1 0</annotation>\n<trace>";
        for (int i = 0; i <= 50; ++i)
            ink << (i ? ", " : "") << length * (i / 50.0 - 0.5) << " 0 " << (i == 0 || i == 50 ? 0.0 : 0.4) << ' '
                << 8 * i;
        ink << "</trace>\n</traceGroup></ink>\n";
        return ink.str();
    }

    std::filesystem::path folder_;

  private:
    static std::string escaped(const std::string& text) {
        std::string out;
        for (const char c : text) {
            if (c == '"' || c == '\\' || c == '$' || c == '`') out += '\\';
            out += c;
        }
        return out;
    }
};

}  // namespace tuft::test
