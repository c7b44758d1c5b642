#pragma once

#include <deque>
#include <string>

#include "core/geometry/types.h"

namespace tuft::app {

/// Keys of a chord, besides the key itself.
enum Modifier : unsigned { kShift = 1, kControl = 2, kAlt = 4 };

/// One thing a person did, from a window or a script. Positions in pixels of the picture,
/// origin at the top left.
struct Event {
    enum class Kind { move, press, release, scroll, key_down, key_up, text, drop, hover_end, fly, cap_button, resize };
    Kind kind = Kind::move;
    double time = 0;       ///< seconds on the window's clock
    double x = 0, y = 0;   ///< pixels; every kind but keys and text carries the cursor; resize: the new size
    int button = 0;        ///< 0 left, 1 right, 2 middle; of a SpaceMouse from 0
    double pressure = -1;  ///< 0–1 from a pen; below 0: a device without pressure
    Vec2 tilt{0};          ///< radians from a pen: to the right, towards the person
    double turn = 0;       ///< radians about itself, clockwise for who holds it, of a pen that reports it
    bool eraser = false;   ///< the pen's other end
    double steps = 0;      ///< of the wheel, away from the person
    int key = 0;           ///< GLFW key code
    unsigned modifiers = 0;
    Vec3 push{0}, twist{0};  ///< of a SpaceMouse's cap, along and about right, up, towards the person:
                             ///< full deflections · seconds since the last event
    std::string text;        ///< what was typed (UTF-8), or the dropped file
};

using EventQueue = std::deque<Event>;

}  // namespace tuft::app
