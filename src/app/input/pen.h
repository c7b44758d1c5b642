#pragma once

#include <memory>

#include "app/input/events.h"

struct GLFWwindow;

/// \file
/// Pen tablets of a window. Window thread.
namespace tuft::app {

/// Pen tablets through XInput2: pressure, tilt, rotation and eraser end, all samples with the server's time. It reads
/// the pens on a connection of its own; the window's mouse events are not affected.
class Pen {
  public:
    virtual ~Pen() = default;
    /// Replaces the cursor movements that the window saw by the pen's samples since the last call, and adds the pen's
    /// pressure to presses. `now`: seconds on the window's clock. `scale`: picture pixels per window coordinate.
    virtual bool merge(EventQueue& events, double now, double scale) = 0;
};

/// Opens the pens. Returns nullptr when the window is not on an X server with XInput 2.2.
std::unique_ptr<Pen> open_pen(GLFWwindow* window);

}  // namespace tuft::app
