#include "haptic/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <map>
#include <ostream>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/system/clock.h"

namespace tuft::haptic {
namespace {

constexpr std::string_view kColumns = "tick,fresh,x,y,z,qw,qx,qy,qz,buttons,control,answer,solved,fx,fy,fz";
constexpr std::string_view kAdded = ",proximity,yield";
constexpr std::size_t kNumbers = 16, kNumbersAdded = 18, kLongestLine = 1000, kMostPeriods = 1 << 24;  // four hours

std::uint64_t whole(double value) {
    return value >= 0 && value < 1e15 ? static_cast<std::uint64_t>(value) : 0;  // also for NaN
}

}  // namespace

bool read_row(std::string_view line, std::span<double> values) {
    const char* at = line.data();
    const char* end = at + line.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto [next, error] = std::from_chars(at, end, values[i]);
        if (error != std::errc{}) return false;
        at = next;
        if (i + 1 < values.size()) {
            if (at == end || *at != ',') return false;
            ++at;
        }
    }
    return at == end || *at == '\r';
}

void write_recording(std::ostream& out, std::span<const RecordedPeriod> periods) {
    const bool added = std::ranges::any_of(periods, [](const auto& p) { return p.added != AddedForces{}; });
    out << kColumns << (added ? kAdded : "") << '\n';
    for (const RecordedPeriod& p : periods) {
        const Vec3 &x = p.state.position, &f = p.force;
        const Quat& q = p.state.rotation;
        const int control = p.control.paused + 2 * p.control.emergency + 4 * p.control.clutched;
        out << fmt::format("{},{:d},{},{},{},{},{},{},{},{},{},{},{:d},{},{},{}", p.tick, p.fresh, x.x, x.y, x.z, q.w,
                           q.x, q.y, q.z, p.state.buttons, control, p.answer, p.solved, f.x, f.y, f.z);
        if (added) out << fmt::format(",{},{}", p.added.proximity, p.added.yield_stress);
        out << '\n';
    }
}

std::vector<RecordedPeriod> read_recording(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw Error(file.string(), "cannot be read");
    std::string line;
    std::vector<RecordedPeriod> periods;
    std::size_t numbers = kNumbers;
    for (long number = 1; std::getline(in, line); ++number) {
        if (line.size() > kLongestLine) throw Error(file.string(), number, "this line is too long for a recording");
        if (number == 1 && line.starts_with(kColumns)) {
            if (line.substr(kColumns.size()).starts_with(kAdded)) numbers = kNumbersAdded;
            continue;
        }
        std::array<double, kNumbersAdded> v{};
        if (number == 1 || !read_row(line, std::span(v).first(numbers)))
            throw Error(file.string(), number, Message("expected {}", std::string(kColumns)));
        RecordedPeriod p;
        p.tick = whole(v[0]);
        p.fresh = v[1] != 0;
        p.state = {.time = v[0] * kPeriod, .position = {v[2], v[3], v[4]}, .rotation = {v[5], v[6], v[7], v[8]}};
        p.state.buttons = static_cast<std::uint32_t>(whole(v[9]));
        const std::uint64_t control = whole(v[10]);
        p.control.paused = control & 1;
        p.control.emergency = control & 2;
        p.control.clutched = control & 4;
        p.answer = whole(v[11]);
        p.solved = v[12] != 0;
        p.force = {v[13], v[14], v[15]};
        p.added = {v[16], v[17]};
        if (!periods.empty() && p.tick <= periods.back().tick)
            throw Error(file.string(), number, "the ticks of a recording rise");
        if (periods.size() == kMostPeriods) throw Error(file.string(), number, "a recording of more than four hours");
        periods.push_back(p);
    }
    return periods;
}

std::vector<Vec3> replay_forces(std::span<const RecordedPeriod> periods, HairSolver solver, const LawOptions& law,
                                const Workspace& workspace) {
    Servo servo(law);
    std::map<std::uint64_t, std::pair<RootPose, AddedForces>> waiting;
    std::map<std::uint64_t, HairAnswer> answers;
    std::vector<Vec3> forces;
    for (const RecordedPeriod& p : periods) {
        ServoControl control = p.control;
        control.workspace = workspace;
        const RootPose pose = servo.begin(p.tick, p.fresh ? &p.state : nullptr, control);
        if (p.solved) waiting.emplace(p.tick, std::pair{pose, p.added});
        while (!waiting.empty() && waiting.begin()->first <= p.answer) {
            const auto& [asked, added] = waiting.begin()->second;
            solver.set_added(added);
            answers[waiting.begin()->first] = solver.solve(asked);
            waiting.erase(waiting.begin());
        }
        const auto newest = answers.find(p.answer);
        if (newest != answers.end()) answers.erase(answers.begin(), newest);
        forces.push_back(servo.finish(newest != answers.end() ? &newest->second : nullptr).force);
    }
    return forces;
}

ReplayDevice::ReplayDevice(const DeviceLimits& limits, std::vector<RecordedPeriod> periods)
    : limits_(limits), periods_(std::move(periods)) {}

bool ReplayDevice::read(DeviceState& state) noexcept {
    if (begin_ == 0) begin_ = clock_ns();
    const auto tick = static_cast<std::uint64_t>((clock_ns() - begin_) / 1'000'000);
    bool fresh = false;
    std::size_t next = next_.load();
    while (next < periods_.size() && periods_[next].tick - periods_.front().tick <= tick) {
        if (periods_[next].fresh) {
            state = periods_[next].state;
            fresh = true;
        }
        ++next;
    }
    next_ = next;
    return fresh;
}

}  // namespace tuft::haptic
