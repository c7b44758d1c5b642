#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/input/events.h"

/// \file
/// Conversion of pen reports into input events. It does not depend on X: reports are plain data as in the XInput 2
/// protocol. Window thread.
namespace tuft::app {

/// One axis of a device: its valuator number and range.
struct PenAxis {
    int number = -1;                   ///< negative: missing
    double lo = 0, hi = 1, value = 0;  ///< range and state, units of the device

    /// Returns the position in the range, 0–1.
    double part() const;
};

/// A pen device and its axes.
struct PenDevice {
    std::string name;
    PenAxis x, y, pressure, tilt_x, tilt_y, turn;  ///< the range of `turn` is one revolution
    bool eraser = false;
};

/// One XIDeviceEvent. It contains only axes that changed, lowest number first.
struct PenReport {
    int device = 0;
    bool motion = true;  ///< else a button
    int button = 0;      ///< number at the server: 1 left (the tip), 2 middle, 3 right
    bool pressed = false;
    double time = 0;                    ///< seconds on the server's clock
    std::vector<int> axes;              ///< numbers, ascending
    std::vector<double> values;         ///< [axes]
    double window_x = 0, window_y = 0;  ///< position by the server, window coordinates
};

/// Position of the window on the screen.
struct PenScreen {
    double left = 0, top = 0;      ///< of the window, screen coordinates
    double width = 1, height = 1;  ///< of the screen
    double scale = 1;              ///< picture pixels per window coordinate
};

/// Merges pen reports into the window's events.
class PenSamples {
  public:
    /// Sets the devices that are plugged in. Returns true when one with pressure was removed.
    bool set_devices(std::map<int, PenDevice> devices);
    bool any() const { return !devices_.empty(); }

    /// Adds a report. `now`: seconds on the window's clock. The server's clock is aligned with it at the first report
    /// and whenever they differ by a second.
    void take(const PenReport& report, const PenScreen& screen, double now);
    /// Replaces the window's cursor movements by the samples since the last call, and moves the window's presses and
    /// releases to where the pen reports them, with its pressure. The window may see a button later than the pen
    /// reports it; later samples are held back until then. Movements of the window are dropped while the tip is down
    /// and shortly after.
    void merge(EventQueue& events, double now);

  private:
    Event with_pen(Event event);

    std::map<int, PenDevice> devices_;
    std::vector<Event> samples_;  ///< movements, presses and releases
    Event last_;
    bool down_ = false;  ///< the tip
    int ahead_ = 0;      ///< buttons that the window reported earlier than the pen
    double last_sample_ = -1, held_since_ = -1, offset_ = 0;
    bool synchronised_ = false;
};

}  // namespace tuft::app
