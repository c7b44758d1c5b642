#include "app/pen.h"

#define GLFW_INCLUDE_NONE
#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3.h>
#include <GLFW/glfw3native.h>
#include <X11/extensions/XInput2.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace tuft::app {
namespace {

constexpr double kDegree = 0.017453292519943295;

struct Axis {
    int number = -1;
    double lo = 0, hi = 1, value = 0;
    double part() const { return hi > lo ? std::clamp((value - lo) / (hi - lo), 0.0, 1.0) : 0; }
};

struct Device {
    Axis x, y, pressure, tilt_x, tilt_y;
    bool eraser = false;
};

class X11Pen : public Pen {
  public:
    X11Pen(::Display* display, ::Window window, int opcode) : display_(display), window_(window), opcode_(opcode) {
        unsigned char all[XIMaskLen(XI_LASTEVENT)] = {};
        XISetMask(all, XI_HierarchyChanged);
        XIEventMask mask{XIAllDevices, static_cast<int>(sizeof all), all};
        XISelectEvents(display_, DefaultRootWindow(display_), &mask, 1);
        find_pens();
    }
    ~X11Pen() override { XCloseDisplay(display_); }

    void merge(EventQueue& events, double now, double scale) override {
        std::vector<Event> samples;
        while (XPending(display_)) {
            XEvent event;
            XNextEvent(display_, &event);
            if (event.xcookie.type != GenericEvent || event.xcookie.extension != opcode_ || !XGetEventData(display_, &event.xcookie)) continue;
            if (event.xcookie.evtype == XI_HierarchyChanged) find_pens();
            else take(*static_cast<XIDeviceEvent*>(event.xcookie.data), now, scale, samples);
            XFreeEventData(display_, &event.xcookie);
        }
        if (samples.empty()) {
            // A press of the pen may reach the window before its next sample.
            if (now - last_sample_ < 0.05)
                for (Event& e : events)
                    if (e.kind == Event::Kind::press && e.button == 0) with_pen(e);
            return;
        }
        last_sample_ = now;
        // The window's own movements are the same ones without pressure.
        std::erase_if(events, [](const Event& e) { return e.kind == Event::Kind::move; });
        const auto released = std::find_if(events.begin(), events.end(), [](const Event& e) { return e.kind == Event::Kind::release; });
        for (Event& e : events)
            if (e.kind == Event::Kind::press) {
                with_pen(e);
                e.time = samples.front().time;
            }
        events.insert(released, samples.begin(), samples.end());
    }

  private:
    void with_pen(Event& e) const {
        e.pressure = last_.pressure;
        e.tilt = last_.tilt;
        e.eraser = last_.eraser;
    }

    void find_pens() {
        devices_.clear();
        int count = 0;
        XIDeviceInfo* list = XIQueryDevice(display_, XIAllDevices, &count);
        const Atom pressure = XInternAtom(display_, "Abs Pressure", True), tilt_x = XInternAtom(display_, "Abs Tilt X", True),
                   tilt_y = XInternAtom(display_, "Abs Tilt Y", True);
        for (int i = 0; i < count; ++i) {
            if (list[i].use != XISlavePointer && list[i].use != XIFloatingSlave) continue;
            Device d;
            for (int k = 0; k < list[i].num_classes; ++k) {
                if (list[i].classes[k]->type != XIValuatorClass) continue;
                const auto& v = *reinterpret_cast<XIValuatorClassInfo*>(list[i].classes[k]);
                const Axis axis{v.number, v.min, v.max, v.value};
                if (v.number == 0) d.x = axis;
                if (v.number == 1) d.y = axis;
                if (pressure != None && v.label == pressure) d.pressure = axis;
                if (tilt_x != None && v.label == tilt_x) d.tilt_x = axis;
                if (tilt_y != None && v.label == tilt_y) d.tilt_y = axis;
            }
            if (d.pressure.number < 0) continue;
            d.eraser = std::strstr(list[i].name, "raser") != nullptr;
            unsigned char bits[XIMaskLen(XI_LASTEVENT)] = {};
            XISetMask(bits, XI_Motion);
            XISetMask(bits, XI_ButtonPress);
            XISetMask(bits, XI_ButtonRelease);
            XIEventMask mask{list[i].deviceid, static_cast<int>(sizeof bits), bits};
            XISelectEvents(display_, window_, &mask, 1);
            devices_[list[i].deviceid] = d;
        }
        XIFreeDeviceInfo(list);
        XFlush(display_);
    }

    void take(const XIDeviceEvent& event, double now, double scale, std::vector<Event>& samples) {
        const auto at = devices_.find(event.deviceid);
        if (at == devices_.end()) return;
        Device& d = at->second;
        const double* value = event.valuators.values;
        for (int i = 0; i < event.valuators.mask_len * 8; ++i) {
            if (!XIMaskIsSet(event.valuators.mask, i)) continue;
            for (Axis* axis : {&d.x, &d.y, &d.pressure, &d.tilt_x, &d.tilt_y})
                if (axis->number == i) axis->value = *value;
            ++value;
        }
        if (event.evtype != XI_Motion) return;
        Event e{.kind = Event::Kind::move, .pressure = d.pressure.part(), .eraser = d.eraser};
        // The server's own coordinates lag one event behind; the axes do not.
        int wx = 0, wy = 0;
        ::Window child;
        XTranslateCoordinates(display_, window_, DefaultRootWindow(display_), 0, 0, &wx, &wy, &child);
        const int screen = DefaultScreen(display_);
        if (d.x.hi > d.x.lo && d.y.hi > d.y.lo) {
            e.x = (d.x.part() * DisplayWidth(display_, screen) - wx) * scale;
            e.y = (d.y.part() * DisplayHeight(display_, screen) - wy) * scale;
        } else {
            e.x = event.event_x * scale;
            e.y = event.event_y * scale;
        }
        if (d.tilt_x.number >= 0) e.tilt = {tilt_of(d.tilt_x), tilt_of(d.tilt_y)};
        if (!synchronised_ || std::abs(event.time * 1e-3 + offset_ - now) > 1.0) {
            offset_ = now - event.time * 1e-3;
            synchronised_ = true;
        }
        e.time = std::min(now, static_cast<double>(event.time) * 1e-3 + offset_);
        last_ = e;
        samples.push_back(e);
    }

    // Axes count degrees; wacom's go from -64 to 63.
    static double tilt_of(const Axis& axis) { return axis.number < 0 ? 0 : std::clamp(axis.value, -64.0, 64.0) * kDegree; }

    ::Display* display_;
    ::Window window_;
    int opcode_;
    std::map<int, Device> devices_;
    Event last_;
    double last_sample_ = -1, offset_ = 0;
    bool synchronised_ = false;
};

}  // namespace

std::unique_ptr<Pen> open_pen(GLFWwindow* window) {
    ::Display* display = XOpenDisplay(nullptr);
    if (!display) return nullptr;
    int opcode = 0, event = 0, error = 0, major = 2, minor = 2;
    if (!XQueryExtension(display, "XInputExtension", &opcode, &event, &error) || XIQueryVersion(display, &major, &minor) != Success) {
        XCloseDisplay(display);
        return nullptr;
    }
    return std::make_unique<X11Pen>(display, glfwGetX11Window(window), opcode);
}

}  // namespace tuft::app
