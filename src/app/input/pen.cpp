#include "app/input/pen.h"

#define GLFW_INCLUDE_NONE
#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3.h>
#include <GLFW/glfw3native.h>
#include <X11/extensions/XInput2.h>

#include <cstring>
#include <map>

#include "app/input/pen_samples.h"

namespace tuft::app {
namespace {

// A tablet that is unplugged while its devices are asked for must not end the program; GLFW's
// own connection has a handler of its own while it needs one.
int ignore_x_error(::Display*, XErrorEvent*) {
    return 0;
}

class X11Pen : public Pen {
  public:
    X11Pen(::Display* display, ::Window window, int opcode) : display_(display), window_(window), opcode_(opcode) {
        XSetErrorHandler(ignore_x_error);
        unsigned char all[XIMaskLen(XI_LASTEVENT)] = {};
        XISetMask(all, XI_HierarchyChanged);
        XIEventMask mask{XIAllDevices, static_cast<int>(sizeof all), all};
        XISelectEvents(display_, DefaultRootWindow(display_), &mask, 1);
        find_pens();
    }
    ~X11Pen() override { XCloseDisplay(display_); }

    bool merge(EventQueue& events, double now, double scale) override {
        bool gone = false;
        PenScreen screen{.scale = scale};
        bool asked = false;
        while (XPending(display_)) {
            XEvent event;
            XNextEvent(display_, &event);
            if (event.xcookie.type != GenericEvent || event.xcookie.extension != opcode_ ||
                !XGetEventData(display_, &event.xcookie))
                continue;
            if (event.xcookie.evtype == XI_HierarchyChanged) {
                gone = find_pens() || gone;
            } else {
                if (!asked) ask_screen(screen);
                asked = true;
                samples_.take(report_of(*static_cast<XIDeviceEvent*>(event.xcookie.data)), screen, now);
            }
            XFreeEventData(display_, &event.xcookie);
        }
        samples_.merge(events, now);
        return gone;
    }

  private:
    void ask_screen(PenScreen& screen) const {
        int x = 0, y = 0;
        ::Window child;
        XTranslateCoordinates(display_, window_, DefaultRootWindow(display_), 0, 0, &x, &y, &child);
        screen.left = x;
        screen.top = y;
        screen.width = DisplayWidth(display_, DefaultScreen(display_));
        screen.height = DisplayHeight(display_, DefaultScreen(display_));
    }

    static PenReport report_of(const XIDeviceEvent& event) {
        PenReport report{.device = event.deviceid,
                         .motion = event.evtype == XI_Motion,
                         .button = event.detail,
                         .pressed = event.evtype == XI_ButtonPress,
                         .time = static_cast<double>(event.time) * 1e-3,
                         .window_x = event.event_x,
                         .window_y = event.event_y};
        const double* value = event.valuators.values;
        for (int i = 0; i < event.valuators.mask_len * 8; ++i)
            if (XIMaskIsSet(event.valuators.mask, i)) {
                report.axes.push_back(i);
                report.values.push_back(*value++);
            }
        return report;
    }

    bool find_pens() {
        std::map<int, PenDevice> devices;
        int count = 0;
        XIDeviceInfo* list = XIQueryDevice(display_, XIAllDevices, &count);
        const Atom pressure = XInternAtom(display_, "Abs Pressure", True),
                   tilt_x = XInternAtom(display_, "Abs Tilt X", True),
                   tilt_y = XInternAtom(display_, "Abs Tilt Y", True), wheel = XInternAtom(display_, "Abs Wheel", True),
                   rotary = XInternAtom(display_, "Abs Rotary Z", True);
        for (int i = 0; list && i < count; ++i) {
            if (list[i].use != XISlavePointer && list[i].use != XIFloatingSlave) continue;
            PenDevice d{.name = list[i].name};
            for (int k = 0; k < list[i].num_classes; ++k) {
                if (list[i].classes[k]->type != XIValuatorClass) continue;
                const auto& v = *reinterpret_cast<XIValuatorClassInfo*>(list[i].classes[k]);
                const PenAxis axis{v.number, v.min, v.max, v.value};
                if (v.number == 0) d.x = axis;
                if (v.number == 1) d.y = axis;
                if (pressure != None && v.label == pressure) d.pressure = axis;
                if (tilt_x != None && v.label == tilt_x) d.tilt_x = axis;
                if (tilt_y != None && v.label == tilt_y) d.tilt_y = axis;
                if (v.label != None && (v.label == wheel || v.label == rotary))
                    d.turn = axis;  // wacom's art pen; others
            }
            if (d.pressure.number < 0) continue;
            d.eraser = std::strstr(list[i].name, "raser") != nullptr;
            unsigned char bits[XIMaskLen(XI_LASTEVENT)] = {};
            XISetMask(bits, XI_Motion);
            XISetMask(bits, XI_ButtonPress);
            XISetMask(bits, XI_ButtonRelease);
            XIEventMask mask{list[i].deviceid, static_cast<int>(sizeof bits), bits};
            XISelectEvents(display_, window_, &mask, 1);
            devices[list[i].deviceid] = std::move(d);
        }
        if (list) XIFreeDeviceInfo(list);
        XFlush(display_);
        return samples_.set_devices(std::move(devices));
    }

    ::Display* display_;
    ::Window window_;
    int opcode_;
    PenSamples samples_;
};

}  // namespace

std::unique_ptr<Pen> open_pen(GLFWwindow* window) {
    ::Display* display = XOpenDisplay(nullptr);
    if (!display) return nullptr;
    int opcode = 0, event = 0, error = 0, major = 2, minor = 2;
    if (!XQueryExtension(display, "XInputExtension", &opcode, &event, &error) ||
        XIQueryVersion(display, &major, &minor) != Success) {
        XCloseDisplay(display);
        return nullptr;
    }
    return std::make_unique<X11Pen>(display, glfwGetX11Window(window), opcode);
}

}  // namespace tuft::app
