#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/input/events.h"
#include "core/message.h"

namespace tuft::app {

/// A SpaceMouse (six degrees of freedom under one cap), through the spacenav daemon: libspnav,
/// socket $SPNAV_SOCKET or /var/run/spnav.sock. A thread of its own listens, so that the cap is felt at
/// once; where no daemon runs it is looked for again every `retry` seconds. The cap's deflection stands
/// until the daemon sends another one, as its devices report changes only.
class SpaceMouse {
  public:
    virtual ~SpaceMouse() = default;
    /// Appends a `fly` event with the cap's way since the last call (at most 0.1 s of it), and an
    /// event for each button pressed. `now` on the window's clock, for their time.
    virtual void merge(EventQueue& events, double now) = 0;
    /// The cap is held out of its rest.
    virtual bool held() const = 0;
    /// What is worth a message: the device or its daemon came or went; "" if nothing.
    virtual Message take_trouble() = 0;
};

/// `wake` is called on the listening thread whenever something came. nullptr in a program that was
/// built without libspnav. One at a time, as the library has one connection.
std::unique_ptr<SpaceMouse> open_space_mouse(std::function<void()> wake, double retry = 5);

}  // namespace tuft::app
