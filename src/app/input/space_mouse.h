#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/input/events.h"
#include "core/message.h"

/// \file
/// Six-degree-of-freedom input devices.
namespace tuft::app {

/// A SpaceMouse through the spacenav daemon: libspnav, socket $SPNAV_SOCKET or /var/run/spnav.sock. A thread of its own
/// listens, so that the program wakes at once. Without a daemon it looks again every `retry` seconds. A deflection
/// holds until the daemon sends another, because devices report changes only. Methods are for the window thread.
class SpaceMouse {
  public:
    virtual ~SpaceMouse() = default;
    /// Appends a `fly` event with the cap's displacement since the last call (at most 0.1 s of it), and an event for
    /// each button pressed. `now`: seconds on the window's clock.
    virtual void merge(EventQueue& events, double now) = 0;
    /// True while the cap is deflected.
    virtual bool held() const = 0;
    /// Returns a message when the device or its daemon appeared or vanished; else "".
    virtual Message take_fault() = 0;
};

/// Opens the device. `wake` is called on the listening thread whenever a report arrives. At most one exists at a time:
/// the library has one connection. Returns nullptr in a program built without libspnav.
std::unique_ptr<SpaceMouse> open_space_mouse(std::function<void()> wake, double retry = 5);

}  // namespace tuft::app
