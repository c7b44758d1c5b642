#include "haptic/followed_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <string>

#include "core/cubic.h"
#include "core/error.h"

namespace tuft::haptic {
namespace {

constexpr std::string_view kPlaces = "t,x,y,z", kTurned = "t,x,y,z,qw,qx,qy,qz";
constexpr double kMean = 8e-3;   // s: a count of noise in a velocity over one period would be 0.06 m/s on Touch
constexpr double kFarthest = 2;  // m, beyond any arm's reach

// Means of what was read in each 8 ms: of noise in counts little is left.
std::vector<TimedPlace> mean_places(const std::vector<RecordedPeriod>& periods) {
    std::vector<TimedPlace> places;
    TimedPlace sum;
    double count = 0, begin = 0;
    const auto end_window = [&] {
        places.push_back({sum.time / count, sum.position / count, sum.rotation, sum.buttons});
        count = 0;
    };
    for (const RecordedPeriod& p : periods) {
        if (!p.fresh) continue;
        if (count > 0 && p.state.time - begin >= kMean - 0.5 * kPeriod) end_window();
        if (count == 0) {
            sum = {};
            begin = p.state.time;
        }
        sum.time += p.state.time;
        sum.position += p.state.position;
        sum.rotation = p.state.rotation;
        sum.buttons = p.state.buttons;
        ++count;
    }
    if (count > 0) end_window();
    return places;
}

constexpr std::size_t kLongestRow = 1000, kMostPlaces = 1 << 24;

std::vector<TimedPlace> read_places(std::ifstream& in, const std::string& file, bool turned) {
    const std::string_view columns = turned ? kTurned : kPlaces;
    std::vector<TimedPlace> places;
    std::string line;
    for (long number = 2; std::getline(in, line); ++number) {
        std::array<double, 8> v{};
        const auto fail = [&](const Message& what) { throw Error(file, number, what); };
        if (line.size() > kLongestRow) fail("this line is too long for a recording");
        if (places.size() == kMostPlaces) fail("a recording of more than four hours");
        if (!read_row(line, std::span(v).first(turned ? 8 : 4))) fail(Message("expected {}", std::string(columns)));
        TimedPlace p{.time = v[0], .position = {v[1], v[2], v[3]}};
        if (turned) p.rotation = {v[4], v[5], v[6], v[7]};
        const double size = glm::length(p.rotation);
        if (!(std::abs(size - 1) < 0.01)) fail("this is no rotation");
        p.rotation /= size;
        if (!(glm::length(p.position) < kFarthest)) fail("this place is beyond the reach of an arm");
        if (!std::isfinite(p.time) || (!places.empty() && p.time <= places.back().time)) fail("the times rise");
        places.push_back(p);
    }
    return places;
}

Vec3 slope(const std::vector<TimedPlace>& places, std::size_t i) {
    if (i == 0 || i + 1 == places.size()) return Vec3{0};  // the hand stands at both ends
    return (places[i + 1].position - places[i - 1].position) / (places[i + 1].time - places[i - 1].time);
}

}  // namespace

std::vector<TimedPlace> read_followed_path(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string head;
    if (!in || !std::getline(in, head)) throw Error(file.string(), "cannot be read");
    while (!head.empty() && (head.back() == '\r' || head.back() == ' ')) head.pop_back();
    const bool table = head == kPlaces || head == kTurned;
    std::vector<TimedPlace> places =
        table ? read_places(in, file.string(), head == kTurned) : mean_places(read_recording(file));
    if (places.empty()) throw Error(file.string(), "has no place of a hand");
    const double begin = places.front().time;
    for (TimedPlace& p : places) p.time -= begin;
    return places;
}

HandPath followed_path(std::vector<TimedPlace> places) {
    const auto way = std::make_shared<const std::vector<TimedPlace>>(std::move(places));
    return [way](double time) {
        const std::vector<TimedPlace>& p = *way;
        const auto after = std::ranges::upper_bound(p, time, {}, &TimedPlace::time);
        if (after == p.begin() || after == p.end()) {
            const TimedPlace& end = after == p.begin() ? p.front() : p.back();
            return HandTarget{.position = end.position, .rotation = end.rotation, .buttons = end.buttons};
        }
        const auto i = static_cast<std::size_t>(after - p.begin()) - 1;
        const TimedPlace &a = p[i], &b = p[i + 1];
        const double h = b.time - a.time, u = (time - a.time) / h;
        const Vec3 va = slope(p, i), vb = slope(p, i + 1);
        return HandTarget{.position = hermite(a.position, b.position, va, vb, h, u),
                          .velocity = hermite_slope(a.position, b.position, va, vb, h, u),
                          .rotation = glm::slerp(a.rotation, b.rotation, u),
                          .buttons = a.buttons};
    };
}

}  // namespace tuft::haptic
