#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "app/input/events.h"
#include "core/random.h"

namespace tuft::app {

class Studio;

/// Does mostly the things that people do, and some that nobody should: strokes, turns, keys, buttons
/// and entries wherever they are, dialogs, sizes of the window. Seeded, so that a run can be
/// repeated as far as the same things are on the screen.
class UiFuzzer {
  public:
    UiFuzzer(std::size_t count, std::uint64_t seed);

    /// What it does next, a few dozen events; none when all are done.
    std::vector<Event> next(const Studio& studio);
    /// Seconds between two events.
    double pause() { return random_.uniform(0, 0.02); }
    /// After a frame: the program does not end, and nothing is written outside the folder it runs in.
    void hold_back(Studio& studio);
    /// Times that it would have ended the program.
    std::size_t quits() const { return quits_; }

  private:
    void single(std::vector<Event>& events);
    void calm(std::vector<Event>& events);
    void draw(const Studio& studio, std::vector<Event>& events);
    void click_label(const Studio& studio, std::vector<Event>& events);

    std::size_t left_;
    Random random_;
    std::filesystem::path home_;         ///< the folder it runs in
    double width_ = 860, height_ = 520;  ///< pixels of the window
    Event at_;
    bool down_[3] = {};
    std::size_t quits_ = 0;
};

}  // namespace tuft::app
