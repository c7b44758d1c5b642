#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "paths.h"

namespace tuft {

/// A program in the background whose first line ends with its port; it ends with this.
class Served {
  public:
    Served(const std::string& program, const std::string& arguments) {
        const std::string command =
            "export TUFT_DATA='" + source_folder() + "'; echo $$; exec '" + program + "' " + arguments;
        pipe_ = ::popen(command.c_str(), "r");
        char line[200];
        if (std::fgets(line, sizeof line, pipe_)) pid_ = std::atoi(line);
        if (std::fgets(line, sizeof line, pipe_)) {
            const std::string text = line;
            port = std::atoi(text.substr(text.find_last_of(": ") + 1).c_str());
        }
    }
    ~Served() {
        if (pid_ > 0) ::kill(pid_, SIGTERM);  // a shell makes its background jobs ignore SIGINT
        ::pclose(pipe_);
    }
    /// At once, with nothing said to those who are connected.
    void die() {
        if (pid_ > 0) ::kill(pid_, SIGKILL);
        pid_ = 0;
    }
    Served(const Served&) = delete;
    Served& operator=(const Served&) = delete;

    int port = 0;

  private:
    FILE* pipe_ = nullptr;
    int pid_ = 0;
};

}  // namespace tuft
