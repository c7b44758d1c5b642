#pragma once

#include <memory>
#include <string>

#include "core/system/progress.h"

/// \file
/// Signals and the terminal. Called by main.cpp and the commands on the main thread.
namespace tuft::cli {

/// Makes interrupt, termination and hang-up signals cancel all work (core/system/interrupt.h). The program ends at
/// once, half-written files removed, after a second signal or 0.7 s without an end (`LastWords`: 10 s). Call it once,
/// before any other thread starts.
void listen_for_signals();

/// Progress bars and notes on standard error. The bar is drawn only on a terminal. Main thread, except the callback of
/// `progress`: any thread, one at a time.
class Console {
  public:
    explicit Console(bool quiet);
    ~Console();

    /// Returns a callback for long work. It draws "phase [####    ] 43 %  12 s left" and returns false after a signal.
    ProgressFn progress();
    /// Writes one line for the user, such as a warning, above the bar.
    void note(const std::string& line);
    /// Removes the bar.
    void clear();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// While it lives, interrupted work has ten seconds to print what it has. A second signal ends it at once.
class LastWords {
  public:
    LastWords();
    ~LastWords();
    LastWords(const LastWords&) = delete;
    LastWords& operator=(const LastWords&) = delete;
};

}  // namespace tuft::cli
