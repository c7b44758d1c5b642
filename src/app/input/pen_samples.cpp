#include "app/input/pen_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/text/units.h"

namespace tuft::app {
namespace {

constexpr double kEcho = 0.25;     // seconds after a sample in which the window's movements are still the pen's
constexpr double kNear = 8;        // pixels
constexpr double kPatience = 0.1;  // seconds that the window's copy of a button is waited for

// Axes count degrees; wacom's go from -64 to 63.
double tilt_of(const PenAxis& axis) {
    return axis.number < 0 ? 0 : std::clamp(axis.value, -64.0, 64.0) * kDegree;
}

// From -π to π; an axis that never moves says 0.
double turn_of(const PenAxis& axis) {
    const double range = axis.hi - axis.lo + 1;
    return axis.number < 0 || range < 2
               ? 0
               : 2 * std::numbers::pi * std::clamp((axis.value - 0.5 * (axis.lo + axis.hi + 1)) / range, -0.5, 0.5);
}

}  // namespace

double PenAxis::part() const {
    return hi > lo ? std::clamp((value - lo) / (hi - lo), 0.0, 1.0) : 0;
}

bool PenSamples::set_devices(std::map<int, PenDevice> devices) {
    const bool gone =
        std::any_of(devices_.begin(), devices_.end(), [&](const auto& d) { return !devices.contains(d.first); });
    devices_ = std::move(devices);
    return gone;
}

void PenSamples::take(const PenReport& report, const PenScreen& screen, double now) {
    const auto at = devices_.find(report.device);
    if (at == devices_.end()) return;
    PenDevice& d = at->second;
    for (std::size_t i = 0; i < std::min(report.axes.size(), report.values.size()); ++i)
        for (PenAxis* axis : {&d.x, &d.y, &d.pressure, &d.tilt_x, &d.tilt_y, &d.turn})
            if (axis->number == report.axes[i] && std::isfinite(report.values[i])) axis->value = report.values[i];
    if (!synchronised_ || std::abs(report.time + offset_ - now) > 1.0) {
        offset_ = now - report.time;
        synchronised_ = true;
    }
    const double time = std::min(now, report.time + offset_);
    if (!report.motion) {
        if (report.button < 1 || report.button > 3) return;
        samples_.push_back({.kind = report.pressed ? Event::Kind::press : Event::Kind::release,
                            .time = time,
                            .button = report.button == 1   ? 0
                                      : report.button == 2 ? 2
                                                           : 1});
        return;
    }
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
    e.turn = turn_of(d.turn);
    e.time = time;
    samples_.push_back(e);
}

Event PenSamples::with_pen(Event e) {
    e.x = last_.x;
    e.y = last_.y;
    e.pressure = last_.pressure;
    e.tilt = last_.tilt;
    e.turn = last_.turn;
    e.eraser = last_.eraser;
    if (e.button == 0) down_ = e.kind == Event::Kind::press;
    return e;
}

void PenSamples::merge(EventQueue& events, double now) {
    if (!samples_.empty()) last_sample_ = now;
    const bool pens = down_ || (last_sample_ >= 0 && now - last_sample_ < kEcho);
    if (!pens) {
        ahead_ = 0;
        return;
    }
    std::erase_if(events, [](const Event& e) { return e.kind == Event::Kind::move; });
    EventQueue own;
    own.swap(events);
    std::size_t used = 0;
    for (; used < samples_.size(); ++used) {
        const Event& s = samples_[used];
        if (s.kind == Event::Kind::move) {
            events.push_back(last_ = s);
            continue;
        }
        if (ahead_ > 0) {
            --ahead_;
            continue;
        }
        const auto copy = std::find_if(own.begin(), own.end(),
                                       [&](const Event& e) { return e.kind == s.kind && e.button == s.button; });
        if (copy == own.end()) {
            if (held_since_ < 0) held_since_ = now;
            if (now - held_since_ < kPatience) break;
            held_since_ = -1;
            continue;  // it went to another window
        }
        held_since_ = -1;
        events.insert(events.end(), own.begin(), copy);
        events.push_back(with_pen(*copy));
        events.back().time = s.time;
        own.erase(own.begin(), copy + 1);
    }
    samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(used));
    for (Event& e : own) {
        // A mouse that is clicked right after the pen is elsewhere.
        const bool near = down_ || std::hypot(e.x - last_.x, e.y - last_.y) < kNear;
        const bool button = near && (e.kind == Event::Kind::press || e.kind == Event::Kind::release);
        ahead_ += button;
        events.push_back(button ? with_pen(std::move(e)) : std::move(e));
    }
}

}  // namespace tuft::app
