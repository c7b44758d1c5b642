#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "app/input/events.h"
#include "core/random.h"

/// \file
/// Random input for robustness tests. Window thread.
namespace tuft::app {

class Studio;

/// Generates mostly plausible input and some that nobody intends: strokes, rotations, keys, buttons and list entries
/// anywhere, dialogs, window sizes. A seed repeats a run as far as the screens are equal.
class UiFuzzer {
  public:
    UiFuzzer(std::size_t count, std::uint64_t seed);

    /// Returns the next few dozen events; none at the end.
    std::vector<Event> next(const Studio& studio);
    /// Returns the seconds between two events.
    double pause() { return random_.uniform(0, 0.02); }
    /// Contains the program after a frame: it does not quit, and writes only in its working folder.
    void contain(Studio& studio);
    /// Number of times that the program would have quit.
    std::size_t quits() const { return quits_; }

  private:
    void single(std::vector<Event>& events);
    void calm(std::vector<Event>& events);
    void draw(const Studio& studio, std::vector<Event>& events);
    void click_label(const Studio& studio, std::vector<Event>& events);

    std::size_t left_;
    Random random_;
    std::filesystem::path home_;         ///< working folder
    double width_ = 860, height_ = 520;  ///< pixels of the window
    Event at_;
    bool down_[3] = {};
    std::size_t quits_ = 0;
};

}  // namespace tuft::app
