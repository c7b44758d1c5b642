#include "app/script/ui_fuzzer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "app/studio/studio.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr std::size_t kAtOnce = 40;  // events, before it looks at the screen again

constexpr int kKeys[] = {GLFW_KEY_Z,
                         GLFW_KEY_Y,
                         GLFW_KEY_HOME,
                         GLFW_KEY_1,
                         GLFW_KEY_3,
                         GLFW_KEY_7,
                         GLFW_KEY_5,
                         GLFW_KEY_LEFT_BRACKET,
                         GLFW_KEY_RIGHT_BRACKET,
                         GLFW_KEY_LEFT,
                         GLFW_KEY_UP,
                         GLFW_KEY_B,
                         GLFW_KEY_L,
                         GLFW_KEY_X,
                         GLFW_KEY_ESCAPE,
                         GLFW_KEY_PERIOD,
                         GLFW_KEY_F1,
                         GLFW_KEY_BACKSLASH,
                         GLFW_KEY_E,
                         GLFW_KEY_C,
                         GLFW_KEY_G,
                         GLFW_KEY_I,
                         GLFW_KEY_M,
                         GLFW_KEY_T,
                         GLFW_KEY_P,
                         GLFW_KEY_TAB,
                         GLFW_KEY_U,
                         GLFW_KEY_V,
                         GLFW_KEY_ENTER,
                         GLFW_KEY_DELETE,
                         GLFW_KEY_BACKSPACE};
constexpr int kDialogs[] = {GLFW_KEY_O, GLFW_KEY_S, GLFW_KEY_E};

template <class List>
const auto& one_of(const List& list, Random& random) {
    return list[std::min(std::size(list) - 1,
                         static_cast<std::size_t>(random.uniform(0, static_cast<double>(std::size(list)))))];
}

Event key(int code, unsigned modifiers = 0) {
    return {.kind = Event::Kind::key_down, .key = code, .modifiers = modifiers};
}

}  // namespace

UiFuzzer::UiFuzzer(std::size_t count, std::uint64_t seed)
    : left_(count), random_(seed), home_(fs::weakly_canonical(fs::current_path())) {}

void UiFuzzer::single(std::vector<Event>& events) {
    Event e = at_;
    e.modifiers = random_.uniform() < 0.2 ? static_cast<unsigned>(random_.uniform(0, 8)) : 0;
    const double what = random_.uniform();
    if (what < 0.55) {
        const double reach = random_.uniform() < 0.1 ? 600 : 25;
        e.kind = Event::Kind::move;
        at_.x = e.x = std::clamp(at_.x + random_.uniform(-reach, reach), -20.0, width_ + 20);
        at_.y = e.y = std::clamp(at_.y + random_.uniform(-reach, reach), -10.0, height_ + 20);
        if (random_.uniform() < 0.3) e.pressure = random_.uniform();
        e.eraser = e.pressure >= 0 && random_.uniform() < 0.1;
    } else if (what < 0.8) {
        e.button = random_.uniform() < 0.8 ? 0 : random_.uniform() < 0.5 ? 1 : 2;
        bool& held = down_[e.button];
        e.kind = held ? Event::Kind::release : Event::Kind::press;
        held = !held;
    } else if (what < 0.85) {
        e.kind = Event::Kind::scroll;
        e.steps = random_.uniform(-3, 3);
    } else if (what < 0.97) {
        e.kind = random_.uniform() < 0.5 ? Event::Kind::key_down : Event::Kind::key_up;
        e.key = one_of(kKeys, random_);
        if (e.key == GLFW_KEY_Z && random_.uniform() < 0.5)
            e.modifiers = kControl | (random_.uniform() < 0.5 ? unsigned{kShift} : 0u);
    } else if (what < 0.975) {
        events.push_back(key(one_of(kDialogs, random_), kControl));
        // Mostly cancelled: a dialog that stays keeps all else away.
        e = key(random_.uniform() < 0.8 ? GLFW_KEY_ESCAPE : GLFW_KEY_ENTER);
    } else if (what < 0.98) {
        e.kind = Event::Kind::resize;
        e.x = width_ = std::floor(random_.uniform(320, 1400));
        e.y = height_ = std::floor(random_.uniform(240, 900));
    } else if (what < 0.983) {
        e.kind = Event::Kind::text;
        e.text = random_.uniform() < 0.5 ? "a" : "\xe5\xa2\xa8";
    } else {
        e.kind = Event::Kind::hover_end;
    }
    events.push_back(std::move(e));
}

// Lets everything go and looks at the whole model.
void UiFuzzer::calm(std::vector<Event>& events) {
    for (int button = 0; button < 3; ++button) {
        if (!std::exchange(down_[button], false)) continue;
        Event e = at_;
        e.kind = Event::Kind::release;
        e.button = button;
        events.push_back(e);
    }
    for (const int code : kKeys) events.push_back({.kind = Event::Kind::key_up, .key = code});
    for (int i = 0; i < 3; ++i) events.push_back(key(GLFW_KEY_ESCAPE));
    events.push_back(key(GLFW_KEY_HOME));
}

// A movement of the hand over the middle of the view, with whatever tool is chosen.
void UiFuzzer::draw(const Studio& studio, std::vector<Event>& events) {
    const Area& area = studio.session().view.area;
    const auto place = [&](Event::Kind kind) {
        Event e = at_;
        e.kind = kind;
        e.x = at_.x = area.x + area.width * random_.uniform(0.3, 0.7);
        e.y = at_.y = area.y + area.height * random_.uniform(0.3, 0.75);
        return e;
    };
    events.push_back(place(Event::Kind::move));
    events.push_back(place(Event::Kind::press));
    for (int n = static_cast<int>(random_.uniform(0, 6)); n > 0; --n) {
        const Event from = events.back();
        const Event to = place(Event::Kind::move);
        for (int k = 1; k <= 8; ++k) {
            Event e = to;
            e.x = std::lerp(from.x, to.x, k / 8.0);
            e.y = std::lerp(from.y, to.y, k / 8.0);
            events.push_back(e);
        }
    }
    events.push_back(events.back());
    events.back().kind = Event::Kind::release;
}

void UiFuzzer::click_label(const Studio& studio, std::vector<Event>& events) {
    const Session& s = studio.session();
    const std::vector<std::string> names = s.ui.names();
    if (names.empty()) return;
    const Ui::Place* place = s.ui.find(one_of(names, random_));
    at_.x = place->x;
    at_.y = place->y;
    for (const auto kind : {Event::Kind::move, Event::Kind::press, Event::Kind::release}) {
        Event e = at_;
        e.kind = kind;
        events.push_back(e);
    }
}

std::vector<Event> UiFuzzer::next(const Studio& studio) {
    std::vector<Event> events;
    if (left_ == 0) return events;
    const double what = random_.uniform();
    if (what < 0.1)
        calm(events);
    else if (what < 0.35)
        draw(studio, events);
    else if (what < 0.6)
        click_label(studio, events);
    else
        for (std::size_t i = 0; i < kAtOnce; ++i) single(events);
    if (events.size() >= left_) {
        calm(events);
        left_ = 0;
    } else {
        left_ -= std::max<std::size_t>(1, events.size());
        if (events.empty()) events.push_back({.kind = Event::Kind::hover_end});
    }
    return events;
}

void UiFuzzer::contain(Studio& studio) {
    Session& s = studio.session();
    if (std::exchange(s.project.closing.quit, false)) ++quits_;
    if (!s.dialogs.file.shown() || s.dialogs.file.reads()) return;
    const std::string there = fs::weakly_canonical(s.dialogs.file.folder()).string() + "/";
    if (!there.starts_with(home_.string() + "/")) s.dialogs.file.close();
}

}  // namespace tuft::app
