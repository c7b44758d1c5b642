#pragma once

#include <cstddef>
#include <string>

/// \file
/// State of the manual and of the guide. Window thread.
namespace tuft::app {

/// The manual, and the guide through the first minute.
struct HelpState {
    bool manual = false;  ///< its dialog is open
    std::size_t page = 0;

    int step = -1;          ///< of the guide; −1: hidden
    bool seen = false;      ///< it was shown or skipped before; then it does not start automatically
    bool by_itself = true;  ///< it may start automatically; false while a script plays
    // State at the beginning of the step.
    bool fresh = true;                                ///< the step has just begun
    double azimuth = 0, elevation = 0, distance = 0;  ///< of the view: radians, metres
    std::size_t strokes = 0;
    std::string brush;
};

/// Starts the guide.
inline void start_guide(HelpState& help) {
    help.step = 0;
    help.fresh = true;
}

}  // namespace tuft::app
