#include "cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>

namespace tuft::cli {
namespace {

std::atomic<bool> g_stop{false};
extern "C" void on_interrupt(int) {
    // A second Ctrl-C ends the program the ordinary way.
    std::signal(SIGINT, SIG_DFL);
    g_stop = true;
}

}  // namespace

struct Console::State {
    using Clock = std::chrono::steady_clock;
    bool quiet = false;
    bool terminal = false;
    bool bar_shown = false;
    std::string phase;
    Clock::time_point phase_start, last_drawn;
    std::mutex mutex;

    void draw(std::string_view name, double fraction) {
        const std::lock_guard lock(mutex);
        const auto now = Clock::now();
        if (name != phase) {
            phase = name;
            phase_start = now;
        } else if (now - last_drawn < std::chrono::milliseconds(80) && fraction < 1) {
            return;
        }
        last_drawn = now;
        const double seconds = std::chrono::duration<double>(now - phase_start).count();
        const int filled = static_cast<int>(fraction * 30 + 0.5);
        std::string left;
        if (fraction > 0.02 && fraction < 1 && seconds > 0.5)
            left = fmt::format("{:.0f} s left", seconds * (1 - fraction) / fraction);
        fmt::print(stderr, "\r{:<14} [{:<30}] {:3.0f} %  {:<14}", name, std::string(filled, '#'),
                   100 * fraction, left);
        std::fflush(stderr);
        bar_shown = true;
    }
};

Console::Console(bool quiet) : state_(std::make_unique<State>()) {
    state_->quiet = quiet;
    state_->terminal = ::isatty(STDERR_FILENO) == 1;
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
}

Console::~Console() { clear(); }

ProgressFn Console::progress() {
    return [state = state_.get()](std::string_view phase, double fraction) {
        if (state->terminal && !state->quiet) state->draw(phase, fraction);
        return !g_stop.load();
    };
}

void Console::note(const std::string& line) {
    if (state_->quiet) return;
    clear();
    fmt::print(stderr, "tuft: {}\n", line);
}

void Console::clear() {
    const std::lock_guard lock(state_->mutex);
    if (!state_->bar_shown) return;
    fmt::print(stderr, "\r{:70}\r", "");
    std::fflush(stderr);
    state_->bar_shown = false;
}

}  // namespace tuft::cli
