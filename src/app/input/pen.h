#pragma once

#include <memory>

#include "app/input/events.h"

struct GLFWwindow;

namespace tuft::app {

/// Pen tablets through XInput2: pressure, tilt, turn about itself and the eraser end, every sample with the
/// server's time. Listens to the pens themselves on a connection of its own, so that the
/// window gets its mouse events as before.
class Pen {
  public:
    virtual ~Pen() = default;
    /// Puts the pen's samples since the last call in the place of the cursor movements that
    /// the window saw at the same time, and gives presses the pen's pressure. `now`: the
    /// window's clock; `scale`: picture pixels per window coordinate.
    /// Returns true when a pen was unplugged.
    virtual bool merge(EventQueue& events, double now, double scale) = 0;
};

/// nullptr when the window is not on an X server with XInput 2.2.
std::unique_ptr<Pen> open_pen(GLFWwindow* window);

}  // namespace tuft::app
