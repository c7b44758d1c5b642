#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/input/pen.h"
#include "app/input/space_mouse.h"
#include "app/view/display.h"
#include "core/error.h"

namespace tuft::app {
namespace {

unsigned modifiers_of(int mods) {
    return (mods & GLFW_MOD_SHIFT ? kShift : 0u) | (mods & GLFW_MOD_CONTROL ? kControl : 0u) |
           (mods & GLFW_MOD_ALT ? kAlt : 0u);
}

std::string utf8(unsigned c) {
    std::string out;
    if (c < 0x80)
        out += static_cast<char>(c);
    else if (c < 0x800)
        out += {static_cast<char>(0xc0 | c >> 6), static_cast<char>(0x80 | (c & 0x3f))};
    else if (c < 0x10000)
        out += {static_cast<char>(0xe0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 0x3f)),
                static_cast<char>(0x80 | (c & 0x3f))};
    return out;
}

class Window : public Display {
  public:
    Window(int width, int height) {
        if (!glfwInit()) throw Error("no display could be opened; set DISPLAY, or use 'tuft' without a window");
        make_window(width, height);
        for (std::size_t i = 0; i < cursors_.size(); ++i) cursors_[i] = glfwCreateStandardCursor(kCursors[i].second);
        space_mouse_ = open_space_mouse([] { glfwPostEmptyEvent(); });
    }
    void renew() override {
        int x = 0, y = 0, w = 1, h = 1;
        glfwGetWindowPos(window_, &x, &y);
        glfwGetWindowSize(window_, &w, &h);
        pen_.reset();
        glfwDestroyWindow(window_);
        make_window(w, h);
        glfwSetWindowPos(window_, x, y);
    }
    void make_window(int width, int height) {
        glfwWindowHintString(GLFW_X11_CLASS_NAME, "tuft-studio");  // as the desktop file says, for its icon
        glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "tuft-studio");
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
        glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
        window_ = glfwCreateWindow(width, height, "tuft studio", nullptr, nullptr);
        if (!window_) {  // a driver that cannot say that it was reset
            glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_NO_ROBUSTNESS);
            window_ = glfwCreateWindow(width, height, "tuft studio", nullptr, nullptr);
        }
        if (!window_) {
            glfwTerminate();
            throw Error("no window with OpenGL 3.3 could be opened; a newer graphics driver is needed");
        }
        glfwMakeContextCurrent(window_);
        glfwSwapInterval(1);
        glfwSetWindowUserPointer(window_, this);
        set_callbacks();
        pen_ = open_pen(window_);
    }
    ~Window() override {
        space_mouse_.reset();
        pen_.reset();
        glfwDestroyWindow(window_);
        glfwTerminate();
    }

    void poll(EventQueue& events, double wait) override {
        const double before = last_poll_;
        fresh_.clear();
        if (space_mouse_ && space_mouse_->held()) wait = 0;
        if (wait > 0)
            glfwWaitEventsTimeout(wait);
        else
            glfwPollEvents();
        last_poll_ = now();
        // Movements since the last call carry no time of their own: they are spread evenly.
        std::size_t moves = 0, done = 0;
        for (const Event& e : fresh_) moves += e.kind == Event::Kind::move;
        const double from = std::max(before, last_poll_ - 0.1);
        for (Event& e : fresh_) {
            if (e.kind == Event::Kind::move) ++done;
            e.time =
                from + (last_poll_ - from) * (moves ? static_cast<double>(done) / static_cast<double>(moves) : 1.0);
        }
        if (pen_ && pen_->merge(fresh_, last_poll_, scale_factor()))
            trouble_ = "The pen was unplugged; the mouse goes on.";
        take_space_mouse();
        events.insert(events.end(), std::make_move_iterator(fresh_.begin()), std::make_move_iterator(fresh_.end()));
        show_cursor();
    }
    Message take_fault() override { return std::exchange(trouble_, {}); }
    void present() override { glfwSwapBuffers(window_); }
    bool closed() const override { return glfwWindowShouldClose(window_); }
    void cancel_close() override { glfwSetWindowShouldClose(window_, GLFW_FALSE); }
    void resize(int width, int height) override { glfwSetWindowSize(window_, width, height); }
    void set_title(const std::string& title) override { glfwSetWindowTitle(window_, title.c_str()); }
    int width() const override { return size().first; }
    int height() const override { return size().second; }
    float scale() const override {
        float x = 1, y = 1;
        glfwGetWindowContentScale(window_, &x, &y);
        return std::max(1.0f, x);
    }

  private:
    static constexpr std::pair<ImGuiMouseCursor, int> kCursors[] = {{ImGuiMouseCursor_Arrow, GLFW_ARROW_CURSOR},
                                                                    {ImGuiMouseCursor_TextInput, GLFW_IBEAM_CURSOR},
                                                                    {ImGuiMouseCursor_ResizeEW, GLFW_HRESIZE_CURSOR},
                                                                    {ImGuiMouseCursor_Hand, GLFW_HAND_CURSOR}};

    std::pair<int, int> size() const {
        int w = 1, h = 1;
        glfwGetFramebufferSize(window_, &w, &h);
        return {std::max(1, w), std::max(1, h)};
    }
    // The daemon reports to every program; only the one in front moves.
    void take_space_mouse() {
        if (!space_mouse_) return;
        EventQueue events;
        space_mouse_->merge(events, last_poll_);
        if (Message trouble = space_mouse_->take_fault(); !trouble.empty()) trouble_ = std::move(trouble);
        if (glfwGetWindowAttrib(window_, GLFW_FOCUSED)) fresh_.insert(fresh_.end(), events.begin(), events.end());
    }
    // Picture pixels per window coordinate.
    double scale_factor() const {
        int w = 1, h = 1;
        glfwGetWindowSize(window_, &w, &h);
        return static_cast<double>(size().first) / std::max(1, w);
    }
    void show_cursor() {
        if (!ImGui::GetCurrentContext()) return;
        const ImGuiMouseCursor wanted = ImGui::GetMouseCursor();
        for (std::size_t i = 0; i < cursors_.size(); ++i)
            if (kCursors[i].first == wanted) glfwSetCursor(window_, cursors_[i]);
    }
    Event event(Event::Kind kind) {
        double x = 0, y = 0;
        glfwGetCursorPos(window_, &x, &y);
        const auto held = [this](int a, int b) {
            return glfwGetKey(window_, a) == GLFW_PRESS || glfwGetKey(window_, b) == GLFW_PRESS;
        };
        return {.kind = kind,
                .x = x * scale_factor(),
                .y = y * scale_factor(),
                .modifiers = (held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT) ? kShift : 0u) |
                             (held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL) ? kControl : 0u) |
                             (held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT) ? kAlt : 0u)};
    }
    static Window& of(GLFWwindow* w) { return *static_cast<Window*>(glfwGetWindowUserPointer(w)); }
    void set_callbacks() {
        glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
            Event e = of(w).event(Event::Kind::move);
            e.x = x * of(w).scale_factor();
            e.y = y * of(w).scale_factor();
            of(w).fresh_.push_back(e);
        });
        glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
            Event e = of(w).event(action == GLFW_PRESS ? Event::Kind::press : Event::Kind::release);
            e.button = button;
            e.modifiers = modifiers_of(mods);
            of(w).fresh_.push_back(e);
        });
        glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double dy) {
            Event e = of(w).event(Event::Kind::scroll);
            e.steps = dy;
            of(w).fresh_.push_back(e);
        });
        glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
            if (action == GLFW_REPEAT) return;
            Event e = of(w).event(action == GLFW_PRESS ? Event::Kind::key_down : Event::Kind::key_up);
            e.key = key;
            e.modifiers = modifiers_of(mods);
            of(w).fresh_.push_back(e);
        });
        glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned c) {
            Event e = of(w).event(Event::Kind::text);
            e.text = utf8(c);
            of(w).fresh_.push_back(e);
        });
        glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
            Event e = of(w).event(Event::Kind::drop);
            if (count > 0) e.text = paths[0];
            of(w).fresh_.push_back(e);
        });
        glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
            of(w).fresh_.push_back(of(w).event(focused ? Event::Kind::focus : Event::Kind::focus_lost));
        });
        glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int inside) {
            if (!inside) of(w).fresh_.push_back(of(w).event(Event::Kind::hover_end));
        });
    }

    GLFWwindow* window_ = nullptr;
    std::unique_ptr<Pen> pen_;
    std::unique_ptr<SpaceMouse> space_mouse_;
    EventQueue fresh_;
    Message trouble_;
    double last_poll_ = 0;
    std::array<GLFWcursor*, std::size(kCursors)> cursors_{};
};

}  // namespace

std::unique_ptr<Display> open_window(int width, int height) {
    return std::make_unique<Window>(width, height);
}

}  // namespace tuft::app
