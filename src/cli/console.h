#pragma once

#include <memory>
#include <string>

#include "core/system/progress.h"

namespace tuft::cli {

/// From here on, interrupt, termination and hang-up signals ask all work to stop
/// (core/system/interrupt.h). Work that has not unwound 0.7 s later, and a second signal, end the program
/// at once; half-written files are removed. To be called once, before any other thread starts.
void listen_for_signals();

/// The terminal: progress bars and notes on standard error. The bar is drawn only when
/// standard error is a terminal; after a signal the callback answers "stop".
class Console {
  public:
    explicit Console(bool quiet);
    ~Console();

    /// A callback for long work. It draws "phase [####    ] 43 %  12 s left".
    ProgressFn progress();
    /// One line for people, such as a warning; above the bar if there is one.
    void note(const std::string& line);
    /// Removes the bar.
    void clear();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::cli
