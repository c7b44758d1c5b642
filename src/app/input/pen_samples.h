#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/input/events.h"

/// What a pen tablet reports, made into the window's events. Knows no X server: what the
/// server says comes in as plain data, as the XInput 2 protocol has it.
namespace tuft::app {

/// One axis of a device: its number among the valuators and its range.
struct PenAxis {
    int number = -1;  ///< below 0: the device has none
    double lo = 0, hi = 1, value = 0;

    /// Position in the range, 0–1.
    double part() const;
};

struct PenDevice {
    std::string name;
    PenAxis x, y, pressure, tilt_x, tilt_y, turn;  ///< `turn`: its range is one turn
    bool eraser = false;
};

/// One XIDeviceEvent: only axes that changed are in it, lowest number first.
struct PenReport {
    int device = 0;
    bool motion = true;  ///< else a button
    int button = 0;      ///< its number at the server: 1 left (the tip), 2 middle, 3 right
    bool pressed = false;
    double time = 0;        ///< seconds on the server's clock
    std::vector<int> axes;  ///< numbers, rising
    std::vector<double> values;
    double window_x = 0, window_y = 0;  ///< the server's own position, window coordinates
};

/// Where the window lies on the screen.
struct PenScreen {
    double left = 0, top = 0;      ///< of the window, screen coordinates
    double width = 1, height = 1;  ///< of the screen
    double scale = 1;              ///< picture pixels per window coordinate
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
    /// window saw of them, and the window's presses and releases where the pen's own stand among them, with its
    /// pressure. The window may see a button later than the pen reports it: what follows it is
    /// held back until then. While the tip is down and shortly after the window's movements are the pen's,
    /// and dropped.
    void merge(EventQueue& events, double now);

  private:
    Event with_pen(Event event);

    std::map<int, PenDevice> devices_;
    std::vector<Event> samples_;  ///< and presses and releases among them
    Event last_;
    bool down_ = false;  ///< the tip
    int ahead_ = 0;      ///< buttons that the window reported before the pen
    double last_sample_ = -1, held_since_ = -1, offset_ = 0;
    bool synchronised_ = false;
};

}  // namespace tuft::app
