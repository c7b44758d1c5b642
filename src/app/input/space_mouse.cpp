#include "app/input/space_mouse.h"

#ifdef TUFT_SPNAV
#include <poll.h>
#include <spnav.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>
#endif

namespace tuft::app {

#ifdef TUFT_SPNAV
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFull = 350;        // counts of a cap pushed to its stop (SpaceNavigator at sensitivity 1)
constexpr double kMost = 3;          // full deflections: no sensitivity makes the view jump
constexpr double kLongestGap = 0.1;  // seconds that one look may cover

class Daemon : public SpaceMouse {
  public:
    Daemon(std::function<void()> wake, double retry)
        : wake_(std::move(wake)), retry_ms_(static_cast<int>(1e3 * retry)) {
        if (pipe(stop_.data()) == 0) thread_ = std::thread([this] { listen(); });
    }
    ~Daemon() override {
        if (!thread_.joinable()) return;
        const char byte = 0;
        while (write(stop_[1], &byte, 1) < 0 && errno == EINTR) {
        }
        thread_.join();
        for (const int end : stop_) close(end);
    }

    void merge(EventQueue& events, double now) override {
        const std::scoped_lock lock(mutex_);
        advance();
        const double part = motion_seconds_ > kLongestGap ? kLongestGap / motion_seconds_ : 1;
        if (motion_.push != Vec3(0) || motion_.twist != Vec3(0))
            events.push_back(
                {.kind = Event::Kind::fly, .time = now, .push = part * motion_.push, .twist = part * motion_.twist});
        motion_ = {};
        motion_seconds_ = 0;
        for (const int button : std::exchange(buttons_, {}))
            events.push_back({.kind = Event::Kind::cap_button, .time = now, .button = button});
    }
    bool held() const override {
        const std::scoped_lock lock(mutex_);
        return cap_.push != Vec3(0) || cap_.twist != Vec3(0);
    }
    Message take_fault() override {
        const std::scoped_lock lock(mutex_);
        return std::exchange(trouble_, {});
    }

  private:
    struct Cap {
        Vec3 push{0}, twist{0};
    };

    // The motion under the deflection that stood until now.
    void advance() {
        const Clock::time_point now = Clock::now();
        const double seconds = std::chrono::duration<double>(now - since_).count();
        since_ = now;
        if (cap_.push == Vec3(0) && cap_.twist == Vec3(0)) return;
        motion_.push += seconds * cap_.push;
        motion_.twist += seconds * cap_.twist;
        motion_seconds_ += seconds;
    }
    void put(const Cap& cap, Message trouble) {
        {
            const std::scoped_lock lock(mutex_);
            advance();
            cap_ = cap;
            if (!trouble.empty()) trouble_ = std::move(trouble);
        }
        wake_();
    }
    void take(const spnav_event& event) {
        if (event.type == SPNAV_EVENT_MOTION) {
            const auto part = [](int counts) { return std::clamp(counts / kFull, -kMost, kMost); };
            const spnav_event_motion& m = event.motion;
            // The daemon's third axis points away from the person.
            put({{part(m.x), part(m.y), -part(m.z)}, {part(m.rx), part(m.ry), -part(m.rz)}}, "");
        } else if (event.type == SPNAV_EVENT_BUTTON && event.button.press) {
            const std::scoped_lock lock(mutex_);
            buttons_.push_back(event.button.bnum);
        } else if (event.type == SPNAV_EVENT_DEV) {
            put({}, event.dev.op == SPNAV_DEV_RM ? "The SpaceMouse was unplugged; the mouse goes on."
                                                 : "The SpaceMouse is ready.");
        }
        wake_();
    }

    // True when it is time to end.
    bool wait(int fd, int milliseconds) const {
        pollfd ends[2] = {{stop_[0], POLLIN, 0}, {fd, POLLIN, 0}};
        poll(ends, fd < 0 ? 1 : 2, milliseconds);
        return (ends[0].revents & POLLIN) != 0;
    }
    void listen() {
        bool had = false;
        for (;;) {
            errno = 0;  // the library takes an interruption of long ago for one of its own
            if (spnav_open() != 0) {
                if (wait(-1, retry_ms_)) return;
                continue;
            }
            if (spnav_protocol() > 0) spnav_evmask(SPNAV_EVMASK_DEFAULT);
            if (had) put({}, "The SpaceMouse is ready.");
            had = true;
            const bool ends = listen_to(spnav_fd());
            spnav_close();
            if (ends) return;
            put({}, "The SpaceMouse's driver has ended; the mouse goes on.");
            if (wait(-1, retry_ms_)) return;
        }
    }
    bool listen_to(int fd) {
        for (;;) {
            if (wait(fd, -1)) return true;
            char byte;
            const ssize_t there = recv(fd, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
            if (there == 0 || (there < 0 && errno != EAGAIN && errno != EINTR)) return false;
            spnav_event event;
            if (there > 0 && spnav_poll_event(&event) != 0) take(event);
        }
    }

    std::function<void()> wake_;
    int retry_ms_;
    std::array<int, 2> stop_{-1, -1};
    mutable std::mutex mutex_;
    Cap cap_, motion_;  // deflection now; its integral since the last look
    double motion_seconds_ = 0;
    Clock::time_point since_ = Clock::now();
    std::vector<int> buttons_;
    Message trouble_;
    std::thread thread_;
};

}  // namespace

std::unique_ptr<SpaceMouse> open_space_mouse(std::function<void()> wake, double retry) {
    return std::make_unique<Daemon>(std::move(wake), retry);
}

#else

std::unique_ptr<SpaceMouse> open_space_mouse(std::function<void()>, double) {
    return nullptr;
}

#endif

}  // namespace tuft::app
