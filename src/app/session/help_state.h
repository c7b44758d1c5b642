#pragma once

#include <cstddef>
#include <string>

namespace tuft::app {

/// The manual, and the guided first minute.
struct HelpState {
    bool manual = false;  ///< its dialog is open
    std::size_t page = 0;

    int step = -1;          ///< of the guide; -1: it is not shown
    bool seen = false;      ///< it was shown once, or skipped: it does not come by itself again
    bool by_itself = true;  ///< it may come by itself; not while a script plays
    // As things were when the step began.
    bool fresh = true;  ///< the step has just begun
    double azimuth = 0, elevation = 0, distance = 0;
    std::size_t strokes = 0;
    std::string brush;
};

/// Begins the guided first minute.
inline void start_guide(HelpState& help) {
    help.step = 0;
    help.fresh = true;
}

}  // namespace tuft::app
