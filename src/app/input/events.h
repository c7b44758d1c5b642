#pragma once

#include <deque>
#include <string>

#include "core/geometry/types.h"

/// \file
/// Input events. A window or a script produces them on the window thread.
namespace tuft::app {

/// Modifier keys of a chord.
enum Modifier : unsigned { kShift = 1, kControl = 2, kAlt = 4 };

/// One input event. Positions are in pixels of the picture, origin at the top left.
struct Event {
    enum class Kind {
        move,
        press,
        release,
        scroll,
        key_down,
        key_up,
        text,
        drop,
        hover_end,
        fly,
        cap_button,
        resize,
        focus,
        focus_lost
    };
    Kind kind = Kind::move;
    double time = 0;       ///< seconds on the window's clock
    double x = 0, y = 0;   ///< pixels, of the cursor, for all kinds but keys and text; resize: the new size
    int button = 0;        ///< 0 left, 1 right, 2 middle; of a SpaceMouse from 0
    double pressure = -1;  ///< 0–1 of a pen; negative: a device without pressure
    Vec2 tilt{0};          ///< radians, of a pen: to the right, towards the user
    double turn = 0;       ///< radians, a pen's rotation about its axis, clockwise seen by the user
    bool eraser = false;   ///< the pen's eraser end
    double steps = 0;      ///< of the wheel, away from the user
    int key = 0;           ///< GLFW key code
    unsigned modifiers = 0;
    Vec3 push{0}, twist{0};  ///< of a SpaceMouse's cap, along and about right, up, towards the user: full
                             ///< deflections · seconds since the last event
    std::string text;        ///< typed text (UTF-8), or the path of the dropped file
};

using EventQueue = std::deque<Event>;

}  // namespace tuft::app
