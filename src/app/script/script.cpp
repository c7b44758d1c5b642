#include "app/script/script.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "app/dialogs/dialogs.h"
#include "app/panels/panels.h"
#include "app/studio/set_by_name.h"
#include "app/studio/studio.h"
#include "core/text/units.h"
#include "io/image/image.h"
#include "render/gl/gl_target.h"

namespace tuft::app {
namespace {

constexpr double kStrokeSpeed = 260;  // pixels per second
constexpr double kLongestWait = 120;  // seconds until a wait is given up, where the script names no other
constexpr double kLabelWait = 5;      // seconds until a label is given up

int key_code(const std::string& name) {
    static const std::map<std::string, int> names{
        {"home", GLFW_KEY_HOME},   {"end", GLFW_KEY_END},       {"escape", GLFW_KEY_ESCAPE},
        {"enter", GLFW_KEY_ENTER}, {"tab", GLFW_KEY_TAB},       {"space", GLFW_KEY_SPACE},
        {"left", GLFW_KEY_LEFT},   {"right", GLFW_KEY_RIGHT},   {"up", GLFW_KEY_UP},
        {"down", GLFW_KEY_DOWN},   {"delete", GLFW_KEY_DELETE}, {"backspace", GLFW_KEY_BACKSPACE},
        {"f1", GLFW_KEY_F1},       {"f2", GLFW_KEY_F2}};
    if (const auto at = names.find(name); at != names.end()) return at->second;
    if (name.size() == 1) return std::toupper(static_cast<unsigned char>(name[0]));
    return -1;
}

unsigned modifier_of(const std::string& name) {
    return name == "ctrl"    ? unsigned{kControl}
           : name == "shift" ? unsigned{kShift}
           : name == "alt"   ? unsigned{kAlt}
                             : 0u;
}

int button_of(const ScriptCommand& c) {
    if (c.words.empty() || c.words[0] == "left") return 0;
    return c.words[0] == "right" ? 1 : 2;
}

// Whether the program is the same after the command as before it.
bool only_looks(const ScriptCommand& c) {
    return c.name == "expect" || c.name == "names" || c.name == "places" || c.name == "report";
}

// What the arm does, in a word.
std::string arm_word(const ArmState& arm) {
    if (!arm.arm) return "off";
    const haptic::LoopStatus& now = arm.arm->status();
    if (!arm.arm->feels() || !now.running) return "waiting";
    if (arm.emergency) return glm::length(now.force) > 0 ? "stopping" : "stopped";
    if (!now.engaged) return "free";
    return arm.in_stroke() ? "painting" : "engaged";
}

}  // namespace

Script::Script(const std::filesystem::path& path) : path_(path), commands_(parse_script(path)) {}

void Script::fail(const ScriptCommand& command, const Message& why) const {
    throw Error(path_.string(), command.line, why);
}

void Script::add(Event event, double after) {
    clock_ += after;
    event.time = clock_;
    if (event.kind != Event::Kind::text) event.modifiers |= held_;
    if (event.kind != Event::Kind::key_down && event.kind != Event::Kind::key_up && event.kind != Event::Kind::text &&
        event.kind != Event::Kind::focus && event.kind != Event::Kind::focus_lost)
        cursor_ = event;
    pending_.push_back(std::move(event));
}

void Script::click(double x, double y, int button) {
    add({.kind = Event::Kind::move, .x = x, .y = y}, 0.02);
    add({.kind = Event::Kind::press, .x = x, .y = y, .button = button}, 0.05);
    add({.kind = Event::Kind::release, .x = x, .y = y, .button = button}, 0.05);
}

void Script::press_key(const std::string& chord, int line) {
    unsigned modifiers = 0;
    std::string rest = chord;
    for (std::size_t plus; (plus = rest.find('+')) != std::string::npos && plus > 0; rest = rest.substr(plus + 1)) {
        const unsigned m = modifier_of(rest.substr(0, plus));
        if (!m) throw Error(path_.string(), line, Message("unknown key '{}'", chord));
        modifiers |= m;
    }
    const int code = key_code(rest);
    if (code < 0) throw Error(path_.string(), line, Message("unknown key '{}'", chord));
    add({.kind = Event::Kind::key_down, .key = code, .modifiers = modifiers}, 0.03);
    add({.kind = Event::Kind::key_up, .key = code}, 0.03);
}

void Script::hold(const std::string& chord, int line) {
    static constexpr std::pair<unsigned, int> keys[] = {
        {kShift, GLFW_KEY_LEFT_SHIFT}, {kControl, GLFW_KEY_LEFT_CONTROL}, {kAlt, GLFW_KEY_LEFT_ALT}};
    unsigned wanted = 0;
    std::istringstream names(chord == "none" ? "" : chord);
    for (std::string name; std::getline(names, name, '+');) {
        const unsigned m = modifier_of(name);
        if (!m) throw Error(path_.string(), line, Message("'{}' cannot be held; ctrl, shift, alt or none", name));
        wanted |= m;
    }
    const unsigned before = held_;
    for (const auto& [bit, key] : keys) {
        if ((before & bit) == (wanted & bit)) continue;
        held_ ^= bit;
        add({.kind = held_ & bit ? Event::Kind::key_down : Event::Kind::key_up, .key = key}, 0.03);
    }
}

void Script::stroke(Studio& studio, const ScriptCommand& command) {
    const Area& area = studio.session().view.area;
    std::vector<Vec3> places;
    for (const ScriptPoint& p : command.points)
        places.emplace_back(p.relative_x ? area.x + p.x * area.width : p.x,
                            p.relative_y ? area.y + p.y * area.height : p.y, p.pressure);
    add({.kind = Event::Kind::move, .x = places[0].x, .y = places[0].y}, 0.05);
    add({.kind = Event::Kind::press, .x = places[0].x, .y = places[0].y, .pressure = places[0].z}, 0.02);
    for (std::size_t i = 1; i < places.size(); ++i) {
        const double length = std::hypot(places[i].x - places[i - 1].x, places[i].y - places[i - 1].y);
        const int n = std::clamp(static_cast<int>(length / (kStrokeSpeed * sample_)), 1, 100000);
        for (int k = 1; k <= n; ++k) {
            const Vec3 p = glm::mix(places[i - 1], places[i], static_cast<double>(k) / n);
            add({.kind = Event::Kind::move, .x = p.x, .y = p.y, .pressure = p.z}, sample_);
        }
    }
    add({.kind = Event::Kind::release, .x = places.back().x, .y = places.back().y, .pressure = places.back().z},
        sample_);
}

void Script::report(Studio& studio, double now) {
    const double seconds = now - report_.start;
    std::vector<double> delays = studio.take_delays();
    std::sort(delays.begin(), delays.end());
    const auto at = [&](double q) {
        return delays.empty() ? 0.0
                              : 1e3 * delays[static_cast<std::size_t>(q * static_cast<double>(delays.size() - 1))];
    };
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds_of = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    const double cpu = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    std::printf(
        "{\"frames\": %zu, \"seconds\": %.3f, \"frames_per_second\": %.1f, \"delay_ms_median\": %.1f, "
        "\"delay_ms_p95\": %.1f, "
        "\"samples\": %zu, \"strokes\": %zu, \"undo_ms\": %.1f, \"since_start\": %.3f, \"cpu_seconds\": %.2f, "
        "\"peak_mb\": %.0f, "
        "\"quits\": %zu, \"azimuth_deg\": %.3f, \"elevation_deg\": %.3f, \"distance_mm\": %.3f, "
        "\"roll_deg\": %.3f, \"target_mm\": [%.3f, %.3f, %.3f]}\n",
        report_.frames, seconds, static_cast<double>(report_.frames) / std::max(1e-9, seconds), at(0.5), at(0.95),
        studio.samples(), studio.session().journal.lines.size(), 1e3 * studio.session().reported.document.undo_seconds,
        now, cpu - report_.cpu, static_cast<double>(usage.ru_maxrss) / 1024, quits_,
        studio.session().view.orbit.azimuth / kDegree, studio.session().view.orbit.elevation / kDegree,
        studio.session().view.orbit.distance / kMillimetre, studio.session().view.orbit.roll / kDegree,
        studio.session().view.orbit.target.x / kMillimetre, studio.session().view.orbit.target.y / kMillimetre,
        studio.session().view.orbit.target.z / kMillimetre);
    report_.cpu = cpu;
    std::fflush(stdout);
    report_.frames = 0;
    report_.start = now;
}

void Script::expect(Studio& studio, const ScriptCommand& c) const {
    const Session& s = studio.session();
    const std::string& what = c.words[0];
    const std::string value = c.words.size() > 1 ? c.words[1] : "";
    if (what == "strokes") {
        if (s.journal.lines.size() != static_cast<std::size_t>(std::atoi(value.c_str())))
            fail(c, Message("there are {} strokes, not {}", s.journal.lines.size(), value));
    } else if (what == "model" || what == "no-model") {
        if ((s.paint_thread != nullptr) != (what == "model"))
            fail(c, s.paint_thread ? Message("a model is open") : Message("no model is open: {}", s.status.text));
    } else if (what == "kept") {
        if (!s.reported.file.trouble.empty()) fail(c, s.reported.file.trouble);
    } else if (what == "message") {
        if (s.status.text.text().find(value) == std::string::npos &&
            s.reported.file.trouble.text().find(value) == std::string::npos)
            fail(c, Message("the message is '{}'", s.status.text));
    } else if (what == "label") {
        if (!s.ui.find(value)) fail(c, Message("'{}' is not on the screen", value));
    } else if (what == "arm") {
        const std::string state = arm_word(s.arm);
        if (state != value) fail(c, Message("the arm is {}, not {}", state, value));
    } else if (what == "force") {
        const double force = s.arm.arm ? glm::length(s.arm.arm->status().force) : 0;
        if (force < std::atof(value.c_str())) fail(c, Message("the arm's force is {} N", force));
    } else {
        fail(c, Message("unknown expectation '{}'", what));
    }
}

// Whether the command was one of these: events of mouse, pen and keyboard.
bool Script::play(Studio& studio, const ScriptCommand& c) {
    const std::string word = c.words.empty() ? "" : c.words[0];
    const Area& area = studio.session().view.area;
    Event e = cursor_;
    e.modifiers = 0;
    if (c.name == "open")
        add({.kind = Event::Kind::drop, .text = word}, 0);
    else if (c.name == "move") {
        const ScriptPoint& p = c.points[0];
        add({.kind = Event::Kind::move,
             .x = p.relative_x ? area.x + p.x * area.width : p.x,
             .y = p.relative_y ? area.y + p.y * area.height : p.y,
             .pressure = p.pressure},
            sample_);
    } else if (c.name == "press" || c.name == "release") {
        e.kind = c.name == "press" ? Event::Kind::press : Event::Kind::release;
        e.button = button_of(c);
        add(e, 0.02);
    } else if (c.name == "scroll") {
        e.kind = Event::Kind::scroll;
        e.steps = std::atof(word.c_str());
        add(e, 0.02);
    } else if (c.name == "stroke")
        stroke(studio, c);
    else if (c.name == "key")
        press_key(word, c.line);
    else if (c.name == "undo")
        press_key("ctrl+z", c.line);
    else if (c.name == "redo")
        press_key("ctrl+shift+z", c.line);
    else if (c.name == "hold")
        hold(word, c.line);
    else if (c.name == "type")
        add({.kind = Event::Kind::text, .text = word}, 0.02);
    else
        return false;
    return true;
}

// Commands that may have to wait: whether they are done; nothing for another command.
std::optional<bool> Script::wait_for(Studio& studio, const ScriptCommand& c, double waited) {
    Session& s = studio.session();
    const std::string word = c.words.empty() ? "" : c.words[0];
    if (c.name == "wait-ready") {
        if (waited > (word.empty() ? kLongestWait : std::atof(word.c_str()))) fail(c, "waited too long");
        return is_settled(s) && !s.brush.shelf.busy() && !s.view.model_changed && waited > 0 && frames_.count > 1;
    }
    if (c.name == "wait") return waited >= std::atof(word.c_str());
    if (c.name == "click" || c.name == "right-click" || (c.name == "move" && c.points.empty())) {
        const Ui::Place* place = s.ui.find(word);
        if (!place && waited < kLabelWait) return false;
        if (!place) fail(c, Message("'{}' is not on the screen", word));
        // Panels that change their layout move: a place counts once it has stayed.
        if (waited == 0 || place->x != wait_.place.x || place->y != wait_.place.y) {
            wait_.place = {place->x, place->y};
            return false;
        }
        if (c.name == "move")
            add({.kind = Event::Kind::move, .x = place->x, .y = place->y}, sample_);
        else
            click(place->x, place->y, c.name == "right-click" ? 1 : 0);
        return true;
    }
    if (c.name == "expect") {
        if (word == "label" && !s.ui.find(c.words.back()) && waited < kLabelWait) return false;
        expect(studio, c);
        return true;
    }
    if (c.name == "await") {
        try {
            expect(studio, c);
            return true;
        } catch (const Error&) {
            if (waited > kLongestWait) throw;
            return false;
        }
    }
    if (c.name != "random") return std::nullopt;
    if (!fuzzer_)
        fuzzer_.emplace(static_cast<std::size_t>(std::max(0, std::atoi(word.c_str()))),
                        static_cast<std::uint64_t>(std::atoll(c.words[1].c_str())));
    for (Event& event : fuzzer_->next(studio)) add(std::move(event), fuzzer_->pause());
    if (!pending_.empty()) return false;
    quits_ += fuzzer_->quits();
    fuzzer_.reset();
    return true;
}

// Commands to the program, and to the player of the script.
void Script::act(Studio& studio, const ScriptCommand& c, double now) {
    Session& s = studio.session();
    const std::string word = c.words.empty() ? "" : c.words[0];
    if (c.name == "revise")
        revise_with(s, word);
    else if (c.name == "rate")
        sample_ = 1.0 / std::clamp(std::atof(word.c_str()), 10.0, 10000.0);
    else if (c.name == "set" && word == "draw-every")
        frames_.draw_every = static_cast<std::size_t>(std::clamp(number_of(c.words[1]), 1.0, 1000.0));
    else if (c.name == "set")
        studio.set(word, c.words[1]);
    else if (c.name == "save")
        save_as(s, word);
    else if (c.name == "export") {
        if (s.paint_thread) s.paint_thread->post(export_command(s.dialogs.export_settings, s.view.orbit, word));
    } else if (c.name == "close") {
        studio.finish();
        s.project.start_page.recent = recent_projects();
        s.project.recovery.lost = find_lost_work();
    } else if (c.name == "screenshot")
        wanted_.picture = word;
    else if (c.name == "focus" || c.name == "unfocus")
        add({.kind = c.name == "focus" ? Event::Kind::focus : Event::Kind::focus_lost}, 0.02);
    else if (c.name == "pace")
        pace_ = {.on = word == "on", .start = now, .from = clock_};
    else if (c.name == "resize")
        wanted_.size = {std::clamp(std::atoi(word.c_str()), 320, 8192),
                        std::clamp(std::atoi(c.words[1].c_str()), 240, 8192)};
    else if (c.name == "lose-graphics")
        wanted_.loss = true;
    else if (c.name == "report")
        report(studio, now);
    else if (c.name == "names") {
        for (const std::string& name : s.ui.names()) std::printf("%s\n", name.c_str());
    } else if (c.name == "places") {
        for (const std::string& name : s.ui.names())
            std::printf("%.1f %.1f %s\n", s.ui.find(name)->x, s.ui.find(name)->y, name.c_str());
    } else if (c.name == "quit")
        request_close(s, {});
}

// True when the command is done; false: again at the next frame.
bool Script::perform(Studio& studio, const ScriptCommand& c, double now) {
    if (wait_.since < 0) wait_.since = now;
    if (const std::optional<bool> done = wait_for(studio, c, now - wait_.since)) return *done;
    if (!play(studio, c)) act(studio, c, now);
    return true;
}

void Script::before_frame(Studio& studio, EventQueue& events, double now) {
    const auto hand_out = [&] {
        while (!pending_.empty() && !wanted_.size &&
               (!pace_.on || pending_.front().time - pace_.from <= now - pace_.start)) {
            Event event = std::move(pending_.front());
            pending_.pop_front();
            if (event.kind == Event::Kind::resize) {
                wanted_.size = {static_cast<int>(event.x), static_cast<int>(event.y)};
                continue;
            }
            // Delays are measured on the window's clock.
            if (pace_.on) event.time += pace_.start - pace_.from;
            events.push_back(std::move(event));
        }
    };
    hand_out();
    while (next_ < commands_.size() && pending_.empty() && events.empty() && wanted_.picture.empty()) {
        const bool done = perform(studio, commands_[next_], now), changes = !only_looks(commands_[next_]);
        wait_.on = !done;
        if (!done) break;
        ++next_;
        wait_.since = -1;
        if (pace_.on && !pending_.empty()) {
            pace_.start = now;
            pace_.from = pending_.front().time;
        }
        hand_out();
        // What was done is seen before the next command looks.
        if (changes) break;
    }
}

double Script::patience(const Studio& studio) const {
    if (!pending_.empty() || !wanted_.picture.empty()) return pace_.on ? 0.001 : 0;
    return wait_.on ? std::min(0.02, studio.patience()) : 0;
}

bool Script::looks() {
    if (!wanted_.picture.empty()) return true;
    return (!wait_.on || pace_.on || fuzzer_) && ++frames_.looked % frames_.draw_every == 0;
}

void Script::after_frame(Studio& studio, int width, int height, bool drawn) {
    if (fuzzer_) fuzzer_->contain(studio);
    ++frames_.count;
    if (drawn) ++report_.frames;
    if (wanted_.picture.empty()) return;
    const std::vector<std::uint8_t> rgb = render::read_pixels(0, 0, width, height);
    io::write_image(wanted_.picture, io::view_of(width, height, 3, rgb.data()));
    wanted_.picture.clear();
}

}  // namespace tuft::app
