#include "app/pen_samples.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tuft::app {
namespace {

// Axes count degrees; wacom's go from -64 to 63.
double tilt_of(const PenAxis& axis) { return axis.number < 0 ? 0 : std::clamp(axis.value, -64.0, 64.0) * kDegree; }

}  // namespace

double PenAxis::part() const { return hi > lo ? std::clamp((value - lo) / (hi - lo), 0.0, 1.0) : 0; }

bool PenSamples::set_devices(std::map<int, PenDevice> devices) {
    const bool gone = std::any_of(devices_.begin(), devices_.end(), [&](const auto& d) { return !devices.contains(d.first); });
    devices_ = std::move(devices);
    return gone;
}

void PenSamples::take(const PenReport& report, const PenScreen& screen, double now) {
    const auto at = devices_.find(report.device);
    if (at == devices_.end()) return;
    PenDevice& d = at->second;
    for (std::size_t i = 0; i < std::min(report.axes.size(), report.values.size()); ++i)
        for (PenAxis* axis : {&d.x, &d.y, &d.pressure, &d.tilt_x, &d.tilt_y})
            if (axis->number == report.axes[i] && std::isfinite(report.values[i])) axis->value = report.values[i];
    if (!report.motion) return;
    Event e{.kind = Event::Kind::move, .pressure = d.pressure.part(), .eraser = d.eraser};
    // The server's own coordinates lag one event behind; the axes do not.
    if (d.x.hi > d.x.lo && d.y.hi > d.y.lo) {
        e.x = (d.x.part() * screen.width - screen.left) * screen.scale;
        e.y = (d.y.part() * screen.height - screen.top) * screen.scale;
    } else {
        e.x = report.window_x * screen.scale;
        e.y = report.window_y * screen.scale;
    }
    if (d.tilt_x.number >= 0) e.tilt = {tilt_of(d.tilt_x), tilt_of(d.tilt_y)};
    if (!synchronised_ || std::abs(report.time + offset_ - now) > 1.0) {
        offset_ = now - report.time;
        synchronised_ = true;
    }
    e.time = std::min(now, report.time + offset_);
    last_ = e;
    samples_.push_back(e);
}

void PenSamples::with_pen(Event& e) const {
    e.pressure = last_.pressure;
    e.tilt = last_.tilt;
    e.eraser = last_.eraser;
}

void PenSamples::merge(EventQueue& events, double now) {
    if (samples_.empty()) {
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
            e.time = samples_.front().time;
        }
    events.insert(released, samples_.begin(), samples_.end());
    samples_.clear();
}

}  // namespace tuft::app
