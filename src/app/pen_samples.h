#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/events.h"

/// What a pen tablet reports, made into the window's events. Knows no X server: what the
/// server says comes in as plain data, as the XInput 2 protocol has it.
namespace tuft::app {

/// One axis of a device: its number among the valuators and its range.
struct PenAxis {
    int number = -1;          ///< below 0: the device has none
    double lo = 0, hi = 1, value = 0;

    /// Position in the range, 0–1.
    double part() const;
};

struct PenDevice {
    std::string name;
    PenAxis x, y, pressure, tilt_x, tilt_y;
    bool eraser = false;
};

/// One XIDeviceEvent: only axes that changed are in it, lowest number first.
struct PenReport {
    int device = 0;
    bool motion = true;       ///< else a button
    double time = 0;          ///< seconds on the server's clock
    std::vector<int> axes;    ///< numbers, rising
    std::vector<double> values;
    double window_x = 0, window_y = 0;  ///< the server's own position, window coordinates
};

/// Where the window lies on the screen.
struct PenScreen {
    double left = 0, top = 0;           ///< of the window, screen coordinates
    double width = 1, height = 1;       ///< of the screen
    double scale = 1;                   ///< picture pixels per window coordinate
};

class PenSamples {
  public:
    /// The devices that are plugged in now. Returns true when one with pressure has gone.
    bool set_devices(std::map<int, PenDevice> devices);
    bool any() const { return !devices_.empty(); }

    /// Takes a report; `now` on the window's clock, which the server's is set against at the
    /// first report and whenever they are a second apart.
    void take(const PenReport& report, const PenScreen& screen, double now);
    /// Puts the samples taken since the last call in the place of the cursor movements that the
    /// window saw at the same time, and gives presses the pen's pressure.
    void merge(EventQueue& events, double now);

  private:
    void with_pen(Event& event) const;

    std::map<int, PenDevice> devices_;
    std::vector<Event> samples_;
    Event last_;
    double last_sample_ = -1, offset_ = 0;
    bool synchronised_ = false;
};

}  // namespace tuft::app
