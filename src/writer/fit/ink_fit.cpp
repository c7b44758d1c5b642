#include "writer/fit/ink_fit.h"

#include <algorithm>
#include <cmath>

#include "core/system/interrupt.h"
#include "writer/fit/fairing.h"
#include "writer/fit/ink_score.h"
#include "writer/fit/knuckle_fit.h"
#include "writer/fit/path.h"

namespace tuft::writer {
namespace {

constexpr double kMove = 0.6, kPress = 0.5, kLengthen = 0.6;  // parts of an error taken back at once
constexpr double kOwn = 60;              // units along the path within which ink is a station's own
constexpr double kMostMoved = 60;        // units from the path of the first try
constexpr double kTip = 16;              // units of half width at a tip
constexpr double kGrown = 1.15;          // of the first half width, with kTip more: beyond it corners become balls
constexpr double kEndFade = 20;          // units over which a moved end fades
constexpr std::size_t kHead = 3;         // stations of a head, which move as one
constexpr double kSoft = 2;              // stations of the Gaussian that smooths corrections
constexpr double kSharp = 1.6;           // radians of a turn at which corrections are smoothed less
constexpr double kCornerSoft = 1.2;      // stations, there
constexpr std::size_t kCornerReach = 3;  // stations
constexpr double kLastSoft = 1.2;        // stations, at most, in the last corrections
constexpr double kNeedle = 24;           // units about an end in which its ink must not reach further than wanted
constexpr double kNeedleBack = 0.6;      // part of that taken back at once
constexpr float kDeepest = 24;           // units of depth that count
constexpr double kPrice = 0.002;         // of the score, for a knuckle of the least curvature
constexpr double kFairPrice = 0.0015;    // likewise, where lines are made fair
constexpr double kStiffWay = 0.4, kStiffHalf = 0.05;  // of the path and its half widths: halve waves of 40 and 24 units
constexpr double kRound = 0.9;                        // of a stroke's half width: the radius that a print of it has
constexpr float kSpike = 0.1f;                        // weight of wanted cells that such prints cannot reach
constexpr double kLevel = 4;                          // units between the radii that are told apart
constexpr int kLevels = 8;
constexpr double kGood = 0.98, kSettled = 0.002;  // a path that scores so much, and gains less in a try, stays
constexpr double kBehind = 0.06;                  // over the tries so far: less than the best by more is given up

struct Errors {
    std::vector<double> left, right, kick;  ///< units, [stations]
    double head = 0, tail = 0;              ///< units by which the ends are to be longer
};

/// What a drawing of a path shows.
struct Try {
    InkScore reached;
    Errors errors;
    std::vector<float> inked;  ///< coverage of the target's cells
};

/// How the sides and the head of a path are treated when it is corrected.
struct Manner {
    /// Left and right are those of the first path. Corrections fold a sharp corner, and the directions of a folded path
    /// point anywhere; but they follow a path that is moved far.
    bool first_sides = false;
    /// The stations of the head move as one. The hand takes the direction in which it sets the tuft down from the first
    /// of them: turned by a correction, the tuft may sweep through the head.
    bool whole_head = false;
};
constexpr Manner kManners[] = {{false, false}, {true, true}};

/// Distance of each cell from the edge of an area on the cell's side of it, units, at most `kDeepest`.
std::vector<float> depths_of(const Cells& wanted) {
    Cells outside = wanted;
    for (std::uint8_t& cell : outside.inside) cell = cell == 0;
    std::vector<float> depth = clearances(wanted);
    const std::vector<float> beyond = clearances(outside);
    for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = std::min(std::max(depth[i], beyond[i]), kDeepest);
    return depth;
}

std::vector<double> smoothed(const std::vector<double>& v, const std::vector<double>& soft) {
    const int n = static_cast<int>(v.size());
    std::vector<double> out(v.size(), 0);
    for (int i = 0; i < n; ++i) {
        const double sigma = soft[static_cast<std::size_t>(i)];
        const int reach = static_cast<int>(std::ceil(3 * sigma));
        double sum = 0, all = 0;
        for (int k = std::max(0, i - reach); k <= std::min(n - 1, i + reach); ++k) {
            const double z = (k - i) / sigma, w = std::exp(-0.5 * z * z);
            sum += w * v[static_cast<std::size_t>(k)], all += w;
        }
        out[static_cast<std::size_t>(i)] = sum / all;
    }
    return out;
}

/// How far ink and wanted area reach beyond an end, in a strip about its axis. A needle there has hardly an area.
struct Reach {
    double wanted = 0, ink = 0;  ///< units

    void add(const Vec2& from_end, const Vec2& out, bool is_wanted, bool is_ink) {
        const double along = glm::dot(from_end, out);
        if (along < -kNeedle || along > 2 * kNeedle || std::abs(out.x * from_end.y - out.y * from_end.x) > kNeedle)
            return;
        if (is_wanted) wanted = std::max(wanted, along + kNeedle);
        if (is_ink) ink = std::max(ink, along + kNeedle);
    }
    double too_short() const { return ink > wanted ? kNeedleBack * (wanted - ink) : 1e9; }
};

/// What a try drew.
struct TriedInk {
    const stroke::StrokeSamples& trace;
    const stroke::PlaneInk& ink;
    const std::vector<float>& coverage;  ///< of the target's cells
    double unit = 1;                     ///< metres, of the stations
};

/// The station, of n, at whose time ink first covered a place.
std::size_t station_that_inked(const Vec2& p, const TriedInk& tried, std::size_t n) {
    const std::vector<stroke::StrokeSample>& samples = tried.trace.samples;
    const std::size_t touch = samples.size() - 1 - n;  // samples before that of the first station
    const auto later = std::lower_bound(samples.begin(), samples.end(), tried.ink.when(p * tried.unit),
                                        [](const stroke::StrokeSample& a, double time) { return a.time < time; });
    const auto index = static_cast<std::size_t>(later - samples.begin());
    return std::min(index - std::min(index, touch), n - 1);
}

/// Compares the ink of a try with the target. `sides`: stations whose directions part left and right.
Errors errors_of(const std::vector<Station>& s, const std::vector<Station>& sides, const FitTarget& target,
                 const TriedInk& tried) {
    const std::vector<float>& coverage = tried.coverage;
    const Cells& cells = target.wanted;
    const std::size_t n = s.size();
    const std::vector<double> along = lengths_of(s);
    Errors e{.left = std::vector<double>(n, 0), .right = std::vector<double>(n, 0), .kick = std::vector<double>(n, 0)};
    const double spacing = std::max(along.back() / static_cast<double>(n - 1), 1.0);
    const double part = cells.cell * cells.cell / spacing;
    double head = 0, tail = 0;
    Reach reach_head, reach_tail;
    const Vec2 out_head = -direction_at(sides, 0), out_tail = direction_at(sides, n - 1);
    const auto station_of = [&](const Vec2& p) { return station_that_inked(p, tried, n); };
    for (int j = 0; j < cells.height; ++j)
        for (int i = 0; i < cells.width; ++i) {
            const Vec2 p = cells.centre(i, j);
            const std::size_t at = std::size_t(j) * cells.width + i;
            const bool wanted = cells.inside[at] != 0, there = coverage[at] > kTaken;
            if (!wanted && !there) continue;
            reach_head.add(p - s[0].centre, out_head, wanted, there && (wanted || station_of(p) == 0));
            reach_tail.add(p - s[n - 1].centre, out_tail, wanted, there);
            if (wanted && there) continue;
            const double error = target.weight(at) * (wanted ? part : -part);
            const std::size_t k = nearest_station(s, p);
            if (k < 2 && glm::dot(p - s[0].centre, out_head) > 0) {
                // A belly that reaches back beyond the head is too wide; a shorter path would only press it together.
                if (const std::size_t by = there ? station_of(p) : 0; by > 0)
                    e.kick[by] -= error;
                else
                    head += error * spacing;
                continue;
            }
            if (k + 2 >= n && glm::dot(p - s[n - 1].centre, out_tail) > 0) {
                tail += error * spacing;
                continue;
            }
            if (there) {
                const std::size_t by = station_of(p);
                if (std::abs(along[by] - along[k]) > kOwn) {
                    e.kick[by] -= error;
                    continue;
                }
            }
            const Vec2 d = direction_at(sides, k), off = p - s[k].centre;
            (d.x * off.y - d.y * off.x > 0 ? e.left : e.right)[k] += error;
        }
    const auto width = [&](std::size_t k) { return std::max(2 * s[k].half, 12.0); };
    e.head = head / width(std::min<std::size_t>(2, n - 1));
    e.tail = tail / width(n - 1 - std::min<std::size_t>(2, n - 1));
    e.head = std::min(e.head, reach_head.too_short());
    e.tail = std::min(e.tail, reach_tail.too_short());
    return e;
}

double turn_at(const std::vector<Station>& s, std::size_t i) {
    const Vec2 in = s[i].centre - s[i - kCornerReach].centre, on = s[i + kCornerReach].centre - s[i].centre;
    return std::abs(std::atan2(in.x * on.y - in.y * on.x, glm::dot(in, on)));
}

/// Stations over which corrections are smoothed: fewer at sharp corners, which would be cut.
std::vector<double> softness_of(const std::vector<Station>& s) {
    const std::size_t n = s.size();
    std::vector<double> soft(n, kSoft);
    for (std::size_t i = kCornerReach; i + kCornerReach < n; ++i) {
        if (turn_at(s, i) < kSharp) continue;
        for (std::size_t k = i - 1; k <= i + 1; ++k) soft[k] = kCornerSoft;
    }
    return soft;
}

/// That of the last corrections, which follow what is narrow.
std::vector<double> last_softness_of(const std::vector<Station>& s) {
    std::vector<double> soft = softness_of(s);
    for (double& stations : soft) stations = std::min(stations, kLastSoft);
    return soft;
}

/// Moves the stations of the head as one.
void keep_head(std::vector<Station>& s, const std::vector<Station>& first) {
    if (s.size() <= 2 * kHead) return;
    Vec2 moved{0};
    for (std::size_t i = 0; i < kHead; ++i) moved += (s[i].centre - first[i].centre) / double{kHead};
    for (std::size_t i = 0; i < kHead; ++i) s[i].centre = first[i].centre + moved;
}

void correct(std::vector<Station>& s, const std::vector<Station>& first, const std::vector<double>& soft,
             const Errors& e, const Manner& manner) {
    const std::size_t n = s.size();
    const std::vector<double> left = smoothed(e.left, soft), right = smoothed(e.right, soft),
                              kick = smoothed(e.kick, soft), along = lengths_of(s);
    const std::vector<Station> sides = manner.first_sides ? first : s;
    const Vec2 out_head = -direction_at(sides, 0), out_tail = direction_at(sides, n - 1);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 d = direction_at(sides, i);
        s[i].centre += kMove * 0.5 * (left[i] - right[i]) * Vec2(-d.y, d.x);
        s[i].half += kPress * (0.5 * (left[i] + right[i]) - kick[i]);
        const double from_head = std::max(0.0, 1 - along[i] / kEndFade),
                     from_tail = std::max(0.0, 1 - (along.back() - along[i]) / kEndFade);
        s[i].centre += kLengthen * (from_head * std::clamp(e.head, -20.0, 20.0) * out_head +
                                    from_tail * std::clamp(e.tail, -20.0, 20.0) * out_tail);
        const Vec2 moved = s[i].centre - first[i].centre;
        if (const double far = glm::length(moved); far > kMostMoved)
            s[i].centre = first[i].centre + kMostMoved / far * moved;
        const double tip = std::min(along[i], along.back() - along[i]);
        s[i].half = std::clamp(s[i].half, 0.0, std::min(kTip + tip, kGrown * first[i].half + kTip));
    }
    if (manner.whole_head) keep_head(s, first);
}

/// Lowers the weight of wanted cells that no round print of the stroke reaches from within: sharp corners. A path that
/// is drawn into them leaves balls beside them.
FitTarget without_spikes(FitTarget target, const std::vector<Station>& stations) {
    const Cells& wanted = target.wanted;
    const std::vector<float> room = clearances(wanted);
    std::vector<std::uint8_t> level(wanted.inside.size(), 0);
    for (int j = 0; j < wanted.height; ++j)
        for (int i = 0; i < wanted.width; ++i) {
            const std::size_t at = std::size_t(j) * wanted.width + i;
            if (!wanted.inside[at]) continue;
            const double half = stations[nearest_station(stations, wanted.centre(i, j))].half;
            level[at] = static_cast<std::uint8_t>(std::clamp(static_cast<int>(kRound * half / kLevel), 0, kLevels));
        }
    if (target.weights.empty()) target.weights.assign(wanted.inside.size(), 1.0f);
    for (int l = 1; l <= kLevels; ++l) {
        const auto radius = static_cast<float>(l * kLevel);
        Cells narrow = wanted;  // where no disc of this radius has its middle
        for (std::size_t at = 0; at < room.size(); ++at) narrow.inside[at] = room[at] < radius;
        const std::vector<float> distance = clearances(narrow);
        for (std::size_t at = 0; at < room.size(); ++at)
            if (level[at] == l && distance[at] > radius) target.weights[at] *= kSpike;
    }
    return target;
}

/// Draws stations and compares their ink with the target. `sides`: stations whose directions part left and right.
Try try_out(stroke::PlaneDrawing& plane, const KnuckleTarget& goal, const BrushHand& hand, const Pace& pace,
            const std::vector<Station>& next, const std::vector<Station>& sides) {
    check_interrupt();
    const stroke::StrokeSamples trace = samples_of(next, hand, pace);
    const stroke::PlaneInk& ink = plane.draw(trace);
    std::vector<float> inked = coverage_by(ink, goal.target.wanted);
    Errors errors = errors_of(next, sides, goal.target, {trace, ink, inked, hand.unit});
    return {score_of(goal.target, goal.depths, inked), std::move(errors), std::move(inked)};
}

/// The last drawings, in steps nearly as fine as those of painting.
void fit_finely(FitResult& best, const KnuckleTarget& goal, const BrushHand& hand, const Pace& pace,
                const FitOptions& options) {
    const FitTarget& target = goal.target;
    // Ink depends on the step: in the steps of a painter it lies a unit beside that of the tries.
    stroke::PlaneDrawing fine(hand.preset, hand.hold, options.fine_step * hand.unit, target.wanted.cell * hand.unit);
    const std::vector<EdgeTurn> wanted_turns = wanted_edge_turns(target.wanted);
    const std::vector<Station> before_last = best.stations;
    const std::vector<double> soft = last_softness_of(before_last);
    std::vector<Station> next = before_last;
    const double price = options.fair ? kFairPrice : kPrice;
    double best_value = 0;
    for (int t = 1; t <= options.last_tries; ++t) {
        Try now = try_out(fine, goal, hand, pace, next, next);
        const double value = now.reached.score - price * sharpness_of(goal.whole, wanted_turns, now.inked);
        ++best.tries;
        if (t == 1 || value > best_value) {
            best.stations = next, best.iou = now.reached.iou, best.score = now.reached.score, best_value = value;
            best.inked = std::move(now.inked);
        }
        if (t == options.last_tries) break;
        correct(next, before_last, soft, now.errors, kManners[0]);
        if (options.fair) make_fair(next, kStiffWay, kStiffHalf);
    }
}

}  // namespace

stroke::PlaneInk draw_on_plane(std::span<const Station> stations, const BrushHand& hand, const Pace& pace, double step,
                               double cell) {
    return stroke::plane_ink(samples_of(stations, hand, pace), hand.preset, hand.hold, step * hand.unit,
                             cell * hand.unit);
}

FitResult fit_stations(const std::vector<Station>& stations, const FitTarget& whole, const BrushHand& hand,
                       const Pace& pace, const FitOptions& options, const std::vector<Station>& other) {
    const FitTarget target = options.fair ? without_spikes(whole, stations) : whole;
    const std::vector<float> depths = depths_of(target.wanted);
    const KnuckleTarget goal{target, whole, depths};
    const double cell = target.wanted.cell * hand.unit;
    stroke::PlaneDrawing coarse(hand.preset, hand.hold, options.step * hand.unit, cell);
    FitResult best{.stations = stations};
    const auto fit_from = [&](const std::vector<Station>& first, const Try& first_try, const Manner& manner) {
        const std::vector<double> soft = softness_of(first);
        FitResult own{.stations = first};
        std::vector<Station> next = first;
        for (int t = 1, idle = 0; t <= options.tries && idle < options.idle; ++t) {
            const Try now =
                t == 1 ? first_try : try_out(coarse, goal, hand, pace, next, manner.first_sides ? first : next);
            const double gain = now.reached.score - own.score;
            idle = gain > 1e-4 ? 0 : idle + 1;
            if (gain > 0) own.score = now.reached.score, own.iou = now.reached.iou, own.stations = next;
            own.tries += t > 1;
            if (t > 2 && own.score > kGood && gain < kSettled) break;
            if (t > 1 && own.score < best.score - kBehind / t) break;
            correct(next, first, soft, now.errors, manner);
            if (options.fair) make_fair(next, kStiffWay, kStiffHalf);
        }
        own.tries += best.tries;
        if (own.score > best.score)
            best = std::move(own);
        else
            best.tries = own.tries;
    };
    for (const std::vector<Station>* begin : {&stations, &other}) {
        if (begin->empty() || (best.tries > 0 && best.iou >= options.weak)) continue;
        const Try first_try = try_out(coarse, goal, hand, pace, *begin, *begin);
        ++best.tries;
        for (const Manner& manner : kManners)
            if (&manner == kManners || best.iou < options.weak) fit_from(*begin, first_try, manner);
    }
    fit_finely(best, goal, hand, pace, options);
    take_off_knuckles(best, goal, hand, pace, options);
    return best;
}

}  // namespace tuft::writer
