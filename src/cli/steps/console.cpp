#include "cli/steps/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <string_view>
#include <thread>

#include "core/system/interrupt.h"
#include "core/text/text.h"

namespace tuft::cli {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLongestNote = 1000;  // bytes

/// For work to unwind by itself: a second less what the machine may be busy with.
constexpr std::chrono::nanoseconds kPatience = 650ms, kTogether = 50ms;
constexpr std::chrono::nanoseconds kLongPatience = 10s;  // for `LastWords`, on a machine where the program hardly runs

std::atomic<int> g_last_words{0};

/// The next of these signals, or 0 after `patience`.
int next_signal(const sigset_t& signals, std::chrono::nanoseconds patience) {
    const timespec most{.tv_sec = 0, .tv_nsec = patience.count()};
    for (;;) {
        const int signal = ::sigtimedwait(&signals, nullptr, &most);
        if (signal > 0) return signal;
        if (errno != EINTR) return 0;
    }
}

void await_signals(const sigset_t& signals) {
    int first = 0;
    while (::sigwait(&signals, &first) != 0) {
    }
    request_interrupt();
    // A terminal, `timeout` and others send one to the process and its group: it comes twice at the same time.
    std::this_thread::sleep_for(kTogether);
    while (next_signal(signals, 0ns) > 0) {
    }
    int second = next_signal(signals, kPatience);
    for (auto waited = kPatience; second == 0 && g_last_words > 0 && waited < kLongPatience; waited += kTogether)
        second = next_signal(signals, kTogether);
    remove_unfinished();
    if (second > 0) {  // ends the ordinary way
        std::signal(second, SIG_DFL);
        ::pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
        ::raise(second);
    }
    constexpr std::string_view kStopped = "tuft: stopped\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kStopped.data(), kStopped.size());
    ::_exit(1);
}

}  // namespace

LastWords::LastWords() {
    ++g_last_words;
}

LastWords::~LastWords() {
    --g_last_words;
}

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
        fmt::print(stderr, "\r{:<14} [{:<30}] {:3.0f} %  {:<14}", name, std::string(filled, '#'), 100 * fraction, left);
        std::fflush(stderr);
        bar_shown = true;
    }
};

void listen_for_signals() {
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is a write that fails, with a message
    std::signal(SIGPIPE, SIG_IGN);  // so is a reader that went away
    sigset_t signals;
    ::sigemptyset(&signals);
    ::sigaddset(&signals, SIGINT);
    ::sigaddset(&signals, SIGTERM);
    struct sigaction hang_up {};
    ::sigaction(SIGHUP, nullptr, &hang_up);
    if (hang_up.sa_handler != SIG_IGN) ::sigaddset(&signals, SIGHUP);  // ignored under nohup
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread(await_signals, signals).detach();
}

Console::Console(bool quiet) : state_(std::make_unique<State>()) {
    state_->quiet = quiet;
    state_->terminal = ::isatty(STDERR_FILENO) == 1;
}

Console::~Console() {
    clear();
}

ProgressFn Console::progress() {
    return [state = state_.get()](std::string_view phase, double fraction) {
        if (state->terminal && !state->quiet) state->draw(phase, fraction);
        return !interrupted();
    };
}

void Console::note(const std::string& line) {
    if (state_->quiet) return;
    clear();
    fmt::print(stderr, "tuft: {}\n", excerpt(line, kLongestNote));
}

void Console::clear() {
    const std::lock_guard lock(state_->mutex);
    if (!state_->bar_shown) return;
    fmt::print(stderr, "\r{:70}\r", "");
    std::fflush(stderr);
    state_->bar_shown = false;
}

}  // namespace tuft::cli
