#pragma once

#include <memory>
#include <string>

#include "core/progress.h"

namespace tuft::cli {

/// The terminal: progress bars and notes on standard error. The bar is drawn only when
/// standard error is a terminal; Ctrl-C makes the callback answer "stop".
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
