#include "stroke/drawing/fit_trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>

#include "core/ease.h"
#include "core/geometry/plane_vectors.h"
#include "core/hat.h"
#include "core/system/interrupt.h"
#include "core/system/parallel.h"
#include "stroke/drawing/plane_ink.h"
#include "stroke/gesture/mix_samples.h"
#include "stroke/gesture/tractrix.h"

namespace tuft::stroke {
namespace {

using std::numbers::pi;

// Widths of the line.
constexpr double kApart = 0.1;      // stations of the path
constexpr double kStep = 1.0 / 10;  // of the hand
constexpr double kCell = 1.0 / 24;  // of the picture
constexpr double kFarthest = 0.8;   // that ink is looked for beyond the wanted edge
constexpr double kSoft = 0.4;       // of the path to both sides over which corrections are smoothed
constexpr double kAbout = 2.5;      // of the path about a turn that is corrected
constexpr double kMostMoved = 1.5;  // that the path moves
constexpr double kSettle = 2;       // of the path before a place is corrected, besides kFollow
constexpr double kOwn = 0.8;        // of the path from a place within which the tuft lays its ink there
constexpr double kEdge = 0.08;      // of the half width within which a place still belongs to the edge
constexpr double kUnder = 0.1;      // of another line's half width from its edge: less may be bare
constexpr double kSharpLift = 1;    // of the path about a sharp turn in which the hand lifts at first

constexpr double kTurn = 0.35,
                 kSharp = 1.7;    // radians within a width: less is no corner; more, and the tuft turns over
constexpr double kFan = pi / 12;  // radians between edge points round a corner
constexpr double kLifted = 0.65;  // part of the width that a first try leaves out at a sharp turn
constexpr double kShift = 0.6, kPress = 0.3, kKick = 2;  // parts of an error taken back at once
constexpr double kFollow = 0.6;  // of the tuft's length: a path over which the tip comes to follow its holder
constexpr int kTries = 8;
constexpr double kLongest = 2000;  // widths: longer lines are not fitted
constexpr double kEnough = 0.008,
                 kGain = 0.97;  // rms in widths that nobody sees; of the one before, less is a gain

/// A place of the path and the half width that the ink is to have there.
struct Station {
    Vec2 centre{0};
    double half = 0;
};

/// A point of the wanted edge.
struct EdgePoint {
    Vec2 at{0}, out{0};  ///< metres; unit
    std::size_t station = 0;
    double farthest = 0;  ///< metres outwards before the wanted area begins again
};

/// Samples that lie about kApart apart, corners among them.
std::vector<StrokeSample> evenly(const std::vector<StrokeSample>& s, double apart) {
    std::vector<StrokeSample> out{s.front()};
    for (std::size_t i = 1; i < s.size(); ++i) {
        const double length = glm::distance(s[i].position, s[i - 1].position);
        const auto n = static_cast<int>(std::clamp(std::round(length / apart), 1.0, 1e4));
        for (int k = 1; k <= n; ++k) out.push_back(mix_samples(s[i - 1], s[i], static_cast<double>(k) / n));
    }
    return out;
}

/// Direction of the path before and behind a station.
Vec2 heading(const std::vector<Station>& s, std::size_t i, int step) {
    for (std::size_t k = i; step < 0 ? k > 0 : k + 1 < s.size();) {
        k = step < 0 ? k - 1 : k + 1;
        const Vec2 d = static_cast<double>(step) * (s[k].centre - s[i].centre);
        if (glm::length(d) > 1e-9) return glm::normalize(d);
    }
    return Vec2{0};
}

}  // namespace

/// Discs of many lines, found by the squares of a grid.
class DrawnArea {
  public:
    void add(std::size_t of_line, const Vec2& centre, double half) {
        if (!(half > 0)) return;
        const Vec2 lo = glm::floor((centre - half) / kSquare), hi = glm::floor((centre + half) / kSquare);
        for (auto j = static_cast<std::int64_t>(lo.y); j <= static_cast<std::int64_t>(hi.y); ++j)
            for (auto i = static_cast<std::int64_t>(lo.x); i <= static_cast<std::int64_t>(hi.x); ++i)
                squares_[key(i, j)].push_back({of_line, centre, half});
    }
    /// Whether a point lies by more than `slack` of their half widths within a disc of a line other
    /// than `but`.
    bool covers(const Vec2& p, std::size_t but, double slack) const {
        const auto at = squares_.find(key(static_cast<std::int64_t>(std::floor(p.x / kSquare)),
                                          static_cast<std::int64_t>(std::floor(p.y / kSquare))));
        return at != squares_.end() && std::any_of(at->second.begin(), at->second.end(), [&](const Disc& d) {
                   return d.line != but && glm::distance(p, d.centre) < (1 - slack) * d.half;
               });
    }

  private:
    static constexpr double kSquare = 4e-3;  // metres
    struct Disc {
        std::size_t line = 0;
        Vec2 centre{0};
        double half = 0;
    };
    static std::uint64_t key(std::int64_t i, std::int64_t j) {
        return (static_cast<std::uint64_t>(i) << 32) ^ (static_cast<std::uint64_t>(j) & 0xFFFFFFFFu);
    }
    std::unordered_map<std::uint64_t, std::vector<Disc>> squares_;
};

namespace {

/// The edge of the discs round the stations.
std::vector<EdgePoint> find_edge_points(const std::vector<Station>& stations, const std::vector<double>& weight,
                                        double width, const FittedLine& line) {
    std::vector<EdgePoint> points;
    DrawnArea own;
    for (const Station& s : stations) own.add(0, s.centre, s.half);
    const auto add = [&](std::size_t i, const Vec2& out) {
        const Vec2 at = stations[i].centre + stations[i].half * out;
        if (own.covers(at, 1, kEdge) || (line.area && line.area->covers(at, line.number, kUnder))) return;
        double far = 0;
        while (far < kFarthest * width && !own.covers(at + (far + 0.1 * width) * out, 1, 0)) far += 0.1 * width;
        points.push_back({at, out, i, far});
    };
    for (std::size_t i = 0; i < stations.size(); ++i) {
        check_interrupt();
        if (weight[i] <= 0) continue;
        Vec2 in = heading(stations, i, -1), on = heading(stations, i, 1);
        const bool head = in == Vec2(0), tail = on == Vec2(0);
        if (head && tail) continue;
        if (head || tail) {
            const Vec2 away = head ? -on : in;
            for (double a = -pi / 2; a <= pi / 2 + 1e-9; a += kFan) add(i, turned(away, a));
            continue;
        }
        const Vec2 left_in = turned(in, pi / 2);
        const double turn = angle_between(in, on);
        const int n = static_cast<int>(std::abs(turn) / kFan);
        for (int k = 0; k <= n + 1; ++k) {
            // On the outer side of a turn one after the other, on the inner one the mean.
            const double part = n == 0 ? 0.5 : static_cast<double>(k) / (n + 1);
            if (n == 0 && k > 0) break;
            const Vec2 side = turned(left_in, part * turn);
            add(i, turn > 0 ? -side : side);
        }
        add(i, (turn > 0 ? 1.0 : -1.0) * turned(left_in, 0.5 * turn));
    }
    return points;
}

/// How far the ink reaches over the wanted edge, metres; negative: it stays behind.
double reach_over(const PlaneInk& ink, const EdgePoint& point, double half) {
    const double step = 0.5 * ink.cell(), from = -std::min(half, 16 * ink.cell());
    double before = ink.at({point.at.x + from * point.out.x, -(point.at.y + from * point.out.y)});
    if (before < 0.5) return from;
    for (double t = from + step; t <= point.farthest; t += step) {
        const Vec2 p = point.at + t * point.out;
        const double now = ink.at({p.x, -p.y});
        if (now < 0.5) return t - step * (0.5 - now) / std::max(before - now, 1e-9);
        before = now;
    }
    return point.farthest;
}

/// By how much the path turns within half a width to both sides of each station, radians.
std::vector<double> turns_of(const std::vector<Station>& stations, const std::vector<double>& along, double width) {
    const std::size_t n = stations.size();
    std::vector<double> turns(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t a = i, b = i;
        while (a > 0 && along[i] - along[a] < 0.5 * width) --a;
        while (b + 1 < n && along[b] - along[i] < 0.5 * width) ++b;
        if (a < i && b > i)
            turns[i] = std::abs(
                angle_between(stations[i].centre - stations[a].centre, stations[b].centre - stations[i].centre));
    }
    return turns;
}

/// Metres along the path from each station to the nearest with a turn of more than `least`.
std::vector<double> far_from_turns(const std::vector<double>& turns, const std::vector<double>& along, double least) {
    const std::size_t n = turns.size();
    std::vector<double> far(n, 1e30);
    for (std::size_t i = 0; i < n; ++i)
        if (turns[i] > least && turns[i] >= turns[i > 0 ? i - 1 : i] && turns[i] >= turns[std::min(i + 1, n - 1)])
            far[i] = 0;
    for (std::size_t i = 1; i < n; ++i) far[i] = std::min(far[i], far[i - 1] + along[i] - along[i - 1]);
    for (std::size_t i = n - 1; i-- > 0;) far[i] = std::min(far[i], far[i + 1] + along[i + 1] - along[i]);
    return far;
}

/// Means over kSoft to both sides, nearer ones counting more.
template <class T>
std::vector<T> smoothed(const std::vector<T>& v, const std::vector<double>& along, double soft) {
    std::vector<T> out(v.size());
    std::size_t first = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        while (along[i] - along[first] > soft) ++first;
        T sum{};
        double all = 0;
        for (std::size_t k = first; k < v.size() && along[k] - along[i] <= soft; ++k) {
            const double w = hat(along[k] - along[i], 1.001 * soft);
            sum += w * v[k];
            all += w;
        }
        out[i] = sum / all;
    }
    return out;
}

/// Path that is corrected: its stations, `along` metres, and the weight of each.
struct FittedPath {
    std::vector<Station> stations;
    std::vector<double> along, weight;
    double width = 0;  // metres, of the line
};

/// Errors of the ink at the stations, before they are smoothed.
struct InkErrors {
    std::vector<Vec2> shift;           // metres that the path has to move
    std::vector<double> press, kicks;  // metres that the line has to widen; that ink of other stations reaches too far
    double rms = 0;                    // of the errors, in widths
};

/// Compares the ink of `tried` with the edge points of the line.
InkErrors measure_ink(const PlaneInk& ink, const StrokeSamples& tried, const FittedPath& path,
                      std::span<const EdgePoint> edge) {
    const std::size_t n = path.stations.size();
    InkErrors out{std::vector<Vec2>(n, Vec2{0}), std::vector<double>(n, 0), std::vector<double>(n, 0)};
    std::vector<double> count(n, 0);
    double sum = 0, all = 0;
    for (const EdgePoint& point : edge) {
        const double e = reach_over(ink, point, path.stations[point.station].half);
        sum += path.weight[point.station] * e * e;
        all += path.weight[point.station];
        std::size_t by = point.station;
        if (e > 0) {
            const Vec2 p = point.at + 0.7 * e * point.out;
            const double when = ink.when({p.x, -p.y});
            const auto at = std::lower_bound(tried.samples.begin(), tried.samples.end(), when,
                                             [](const StrokeSample& s, double time) { return s.time < time; });
            by = std::min<std::size_t>(static_cast<std::size_t>(at - tried.samples.begin()), n - 1);
        }
        if (std::abs(path.along[by] - path.along[point.station]) < kOwn * path.width) {
            out.shift[point.station] -= e * point.out;
            out.press[point.station] -= e;
            ++count[point.station];
        } else
            out.kicks[by] = std::max(out.kicks[by], e);
    }
    out.rms = std::sqrt(sum / std::max(all, 1e-9)) / path.width;
    for (std::size_t i = 0; i < n; ++i) {
        const double m = std::max(count[i], 1.0);
        out.shift[i] *= path.weight[i] / m;
        out.press[i] = path.weight[i] * (2 * out.press[i] / m - kKick * out.kicks[i]);
    }
    return out;
}

/// Correction of each station: metres that it is moved, and that its line is pressed wider.
struct Correction {
    std::vector<Vec2> moved;
    std::vector<double> wider;
};

void correct(Correction& correction, const InkErrors& errors, const FittedPath& path) {
    const std::vector<Vec2> shift = smoothed(errors.shift, path.along, kSoft * path.width);
    const std::vector<double> press = smoothed(errors.press, path.along, kSoft * path.width);
    for (std::size_t i = 0; i < path.stations.size(); ++i) {
        Vec2& moved = correction.moved[i];
        double& wider = correction.wider[i];
        moved += kShift * shift[i];
        if (const double far = glm::length(moved); far > kMostMoved * path.width)
            moved *= kMostMoved * path.width / far;
        const double half = path.stations[i].half;
        wider = std::clamp(wider + kPress * press[i], -1.6 * half, 0.8 * half);
    }
}

/// The samples that decide where the ink of the corrected ones lies: those, and what the tuft needs to follow.
std::span<const StrokeSample> deciding(std::span<const StrokeSample> samples, const FittedPath& path, double lead) {
    const auto corrected = [](double weight) { return weight > 0; };
    const auto first = std::ranges::find_if(path.weight, corrected) - path.weight.begin();
    const auto last =
        std::find_if(path.weight.rbegin(), path.weight.rend(), corrected).base() - path.weight.begin() - 1;
    const auto& along = path.along;
    const auto from = std::lower_bound(along.begin(), along.end(), along[first] - lead) - along.begin();
    const auto to = std::upper_bound(along.begin(), along.end(), along[last] + lead) - along.begin();
    return samples.subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from));
}

}  // namespace

StrokeSamples fit_trajectory(StrokeSamples trace, const brush::Preset& preset, const LineWidths& widths,
                             const HolderOptions& options, const FittedLine& line) {
    if (!trace.flat || trace.samples.size() < 3 || !(trace.line_width > 0)) return trace;
    const double width = std::max(trace.line_width, widths.least());
    if (travelled<StrokeSample>(trace.samples).back() > kLongest * width) return trace;
    StrokeSamples tried = trace;
    tried.samples = evenly(trace.samples, kApart * width);
    const std::size_t n = tried.samples.size();
    FittedPath path{.stations = {}, .along = travelled<StrokeSample>(tried.samples), .weight = {}, .width = width};
    for (const StrokeSample& s : tried.samples)
        path.stations.push_back({Vec2(s.position), 0.5 * widths.at(s.pressure)});
    const std::vector<double> turns = turns_of(path.stations, path.along, width);
    if (*std::max_element(turns.begin(), turns.end()) < kTurn) return trace;
    path.weight = far_from_turns(turns, path.along, kTurn);
    for (double& w : path.weight) w = 1 - smooth_step(w / width - kAbout + 1);
    Correction correction{std::vector<Vec2>(n, Vec2{0}), far_from_turns(turns, path.along, kSharp)};
    for (std::size_t i = 0; i < n; ++i)
        correction.wider[i] =
            -2 * kLifted * path.stations[i].half * (1 - smooth_step(correction.wider[i] / (kSharpLift * width)));
    const std::vector<EdgePoint> edge = find_edge_points(path.stations, path.weight, width, line);
    if (edge.empty()) return trace;
    double least = 1e300;
    StrokeSamples best = trace, part = trace;
    for (int t = 0, idle = 0; t < kTries && idle < 2; ++t) {
        check_interrupt();
        for (std::size_t i = 0; i < n; ++i) {
            StrokeSample& s = tried.samples[i];
            const Vec2& moved = correction.moved[i];
            const double wider = correction.wider[i];
            s.position = Vec3(path.stations[i].centre + moved, s.position.z);
            s.pressure =
                wider == 0 && moved == Vec2(0) ? s.pressure : widths.pressure(2 * path.stations[i].half + wider);
        }
        const auto samples = deciding(tried.samples, path, kSettle * width + kFollow * preset.length);
        part.samples.assign(samples.begin(), samples.end());
        const PlaneInk ink = plane_ink(part, preset, options, kStep * width, kCell * width);
        const InkErrors errors = measure_ink(ink, tried, path, edge);
        idle = errors.rms < kGain * least ? 0 : idle + 1;
        if (errors.rms < least) {
            least = errors.rms;
            best = tried;
        }
        if (errors.rms < kEnough) break;
        correct(correction, errors, path);
    }
    return best;
}

void fit_trajectory(std::span<PaintStroke* const> drawing, WidthTables& tables) {
    const auto together = [](const PaintStroke& a, const PaintStroke& b) {
        const Placement &p = a.trace.placement, &q = b.trace.placement;
        return a.ink == b.ink && p.origin == q.origin && p.right == q.right && p.down == q.down &&
               p.mapping == q.mapping;
    };
    struct Line {
        std::size_t number = 0;
        const brush::Preset& preset;
        const LineWidths& widths;
        const HolderOptions& holder;
    };
    std::vector<bool> done(drawing.size(), false);
    for (std::size_t first = 0; first < drawing.size(); ++first) {
        if (done[first]) continue;
        DrawnArea area;
        std::vector<Line> lines;
        for (std::size_t i = first; i < drawing.size(); ++i) {
            if (done[i] || !together(*drawing[i], *drawing[first])) continue;
            done[i] = true;
            const StrokeSamples& t = drawing[i]->trace;
            const std::string& brush = drawing[i]->brush;
            const LineWidths& widths = tables.of(brush);
            lines.push_back({i, tables.preset(brush), widths, tables.holder(brush)});
            if (t.samples.empty() ||
                travelled<StrokeSample>(t.samples).back() > kLongest * std::max(t.line_width, widths.least()))
                continue;
            for (const StrokeSample& s : evenly(t.samples, kApart * std::max(t.line_width, widths.least())))
                area.add(i, Vec2(s.position), 0.5 * widths.at(s.pressure));
        }
        parallel_for(lines.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const Line& line = lines[k];
                StrokeSamples& t = drawing[line.number]->trace;
                t = fit_trajectory(std::move(t), line.preset, line.widths, line.holder, {&area, line.number});
            }
        });
    }
}

}  // namespace tuft::stroke
