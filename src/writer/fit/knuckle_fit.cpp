#include "writer/fit/knuckle_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/system/interrupt.h"
#include "writer/fit/edge_response.h"
#include "writer/fit/ink_score.h"
#include "writer/fit/path.h"

namespace tuft::writer {
namespace {

constexpr double kChanged = 48;      // units about a knuckle in which the path changes
constexpr double kWholeHead = 60;    // units from the first station: the head changes
constexpr double kDrawnBefore = 16;  // units before a change from which it is drawn
constexpr double kDrawnAfter = 40;   // units after it to which it is drawn: the hair trails
constexpr double kSlopeStep = 1;     // units of a number by which its slope is taken
constexpr double kFirstStep = 4;     // units of a number in a search
constexpr double kLastStep = 0.5;
constexpr int kSweeps = 2;               // over all numbers in steps of a size
constexpr double kMostChange = 8;        // units of a number in a search from what is drawn
constexpr int kDrawn = 4;                // finds that are drawn
constexpr double kWindow = 60;           // units about the changed path in which its ink may answer
constexpr double kFrame = 22;            // units within the border of the window where turns may be cuts of it
constexpr double kKnucklePrice = 0.002;  // of the score, for a knuckle of the least curvature
constexpr std::size_t kMostKnuckles = 4;
constexpr double kSameKnuckle = 40;  // units: a knuckle so near to one that was tried is that one
constexpr std::size_t kNumbers = 6;

using Change = std::array<double, kNumbers>;

/// The part of a stroke about a knuckle.
class Part {
  public:
    Part(const std::vector<Station>& path, const Vec2& knuckle)
        : path_(path), along_(lengths_of(path)), middle_(nearest_station(path, knuckle)) {
        if (along_[middle_] < kWholeHead) middle_ = 0;
        ahead_ = direction_at(path, middle_ > 0 ? middle_ : std::min<std::size_t>(1, path.size() - 1));
    }

    std::vector<Station> changed(const Change& c) const {
        std::vector<Station> s = path_;
        const Vec2 left(-ahead_.y, ahead_.x);
        for (std::size_t i = 0; i < s.size(); ++i) {
            const double from = along_[i] - along_[middle_], near = 1 - std::abs(from) / kChanged;
            if (!(near > 0)) continue;
            const double moves = near * near, turns = std::copysign(4 * near * (1 - near), from);
            s[i].centre += (moves * c[0] + turns * c[1]) * left + (moves * c[2] + turns * c[3]) * ahead_;
            s[i].half = std::max(0.0, s[i].half + moves * c[4] + turns * c[5]);
        }
        return s;
    }

    bool is_head() const { return middle_ == 0; }

    /// The box of the path that is drawn again, units.
    void bounds(Vec2& lo, Vec2& hi) const {
        lo = Vec2(1e300), hi = Vec2(-1e300);
        for (std::size_t i = 0; i < path_.size(); ++i)
            if (std::abs(along_[i] - along_[middle_]) <= kChanged)
                lo = glm::min(lo, path_[i].centre), hi = glm::max(hi, path_[i].centre);
    }

    /// Times of a trace between which it is drawn.
    double begin(const stroke::StrokeSamples& trace) const {
        const double from = along_[middle_] - kChanged - kDrawnBefore;
        return middle_ == 0 || from < 0 ? -std::numeric_limits<double>::infinity() : time_at(trace, from);
    }
    double end(const stroke::StrokeSamples& trace) const {
        const double to = along_[middle_] + kChanged + kDrawnAfter;
        return to < along_.back() ? time_at(trace, to) : std::numeric_limits<double>::infinity();
    }

  private:
    double time_at(const stroke::StrokeSamples& trace, double length) const {
        const std::size_t touch = trace.samples.size() - 1 - path_.size();  // samples before the first station's
        const auto after = std::upper_bound(along_.begin() + 1, along_.end(), length);
        return trace.samples[touch + static_cast<std::size_t>(after - along_.begin()) - 1].time;
    }

    const std::vector<Station>& path_;
    std::vector<double> along_;
    std::size_t middle_;
    Vec2 ahead_{0};
};

void add_coverage(std::vector<float>& to, const std::vector<float>& more) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = std::max(to[i], more[i]);
}

/// What ink is worth.
struct Worth {
    InkScore reached;
    std::vector<EdgeTurn> knuckles;
    double value = 0;
};

double value_of(const InkScore& reached, std::span<const EdgeTurn> knuckles) {
    return reached.score - kKnucklePrice * sharpness_of(knuckles);
}

/// A rectangle of the cells of a target.
struct Window {
    int i0 = 0, j0 = 0, i1 = 0, j1 = 0;

    template <typename T>
    std::vector<T> cut(const std::vector<T>& from, const Cells& frame) const {
        std::vector<T> out;
        if (from.empty()) return out;
        for (int j = j0; j < j1; ++j) {
            const auto row = from.begin() + std::ptrdiff_t(j) * frame.width;
            out.insert(out.end(), row + i0, row + i1);
        }
        return out;
    }
    FitTarget cut(const FitTarget& from) const {
        FitTarget out{.wanted = {.lo = from.wanted.lo + from.wanted.cell * Vec2(i0, j0),
                                 .cell = from.wanted.cell,
                                 .width = i1 - i0,
                                 .height = j1 - j0,
                                 .inside = cut(from.wanted.inside, from.wanted)},
                      .weights = cut(from.weights, from.wanted)};
        return out;
    }
};

Window window_about(const Part& part, const Cells& cells) {
    Vec2 lo, hi;
    part.bounds(lo, hi);
    const Vec2 a = glm::floor((lo - kWindow - cells.lo) / cells.cell),
               b = glm::ceil((hi + kWindow - cells.lo) / cells.cell);
    return {std::clamp(static_cast<int>(a.x), 0, cells.width), std::clamp(static_cast<int>(a.y), 0, cells.height),
            std::clamp(static_cast<int>(b.x), 0, cells.width), std::clamp(static_cast<int>(b.y), 0, cells.height)};
}

/// The part of a target about a knuckle, in which a change is judged by where the edge of the ink is expected.
class Near {
  public:
    Near(const KnuckleTarget& t, const Window& window, std::span<const EdgeTurn> turns, const std::vector<float>& drawn)
        : window_(window),
          frame_(t.target.wanted),
          target_(window.cut(t.target)),
          whole_(window.cut(t.whole)),
          depths_(window.cut(t.depths, t.target.wanted)),
          turns_(turns) {
        const InkSums all = sums_of(t.target, t.depths, drawn),
                      here = sums_of(target_, depths_, window.cut(drawn, frame_));
        outside_ = {all.both - here.both, all.either - here.either, all.deep - here.deep};
    }

    std::vector<float> distances(const std::vector<float>& drawn) const {
        return edge_distances(target_.wanted, window_.cut(drawn, frame_));
    }

    double value(const std::vector<float>& distances) const {
        const auto cell = static_cast<float>(target_.wanted.cell);
        std::vector<float> coverage(distances.size());
        for (std::size_t k = 0; k < coverage.size(); ++k)
            coverage[k] = std::clamp(0.5f + distances[k] / cell, 0.0f, 1.0f);
        InkSums sums = sums_of(target_, depths_, coverage);
        sums.both += outside_.both, sums.either += outside_.either, sums.deep += outside_.deep;
        std::vector<EdgeTurn> knuckles = seen_knuckles(whole_, turns_, coverage);
        const Cells& c = target_.wanted;
        const Vec2 lo = c.lo + kFrame, hi = c.lo + c.cell * Vec2(c.width, c.height) - kFrame;
        std::erase_if(knuckles, [&](const EdgeTurn& k) {
            return !(k.at.x > lo.x && k.at.y > lo.y && k.at.x < hi.x && k.at.y < hi.y);
        });
        return value_of(score_of(sums), knuckles);
    }

  private:
    Window window_;
    const Cells& frame_;
    FitTarget target_, whole_;
    std::vector<float> depths_;
    std::span<const EdgeTurn> turns_;
    InkSums outside_;
};

/// Fits a stroke part by part.
class KnuckleFit {
  public:
    KnuckleFit(const KnuckleTarget& target, const BrushHand& hand, const Pace& pace, const FitOptions& options)
        : t_(target),
          hand_(hand),
          pace_(pace),
          drawing_(hand.preset, hand.hold, options.fine_step * hand.unit, target.target.wanted.cell * hand.unit),
          wanted_turns_(wanted_edge_turns(target.target.wanted)) {}

    void fit(FitResult& fitted) {
        std::vector<Vec2> tried;
        if (fitted.inked.empty())
            fitted.inked = coverage_of_ink(drawing_.draw(samples_of(fitted.stations, hand_, pace_)));
        Worth now = worth_of(fitted.inked);
        while (tried.size() < kMostKnuckles) {
            std::vector<EdgeTurn> left = now.knuckles;
            std::erase_if(left, [&](const EdgeTurn& k) {
                return std::ranges::any_of(tried, [&](const Vec2& p) { return is_same(p, k); });
            });
            if (left.empty()) return;
            at_ = std::ranges::max_element(left, {}, [](const EdgeTurn& k) { return std::abs(k.curvature); })->at;
            tried.push_back(at_);
            const Part part(fitted.stations, at_);
            keep_rest(part, fitted.stations);
            const Change best = search(part, fitted.inked, now.value);
            if (best == Change{}) continue;
            std::vector<Station> next = part.changed(best);
            std::vector<float> inked = draw_from_part(next);
            Worth after = worth_of(inked);
            if (!(after.value > now.value)) continue;  // what follows the part is bent otherwise
            fitted.stations = std::move(next), fitted.inked = std::move(inked);
            fitted.iou = after.reached.iou, fitted.score = after.reached.score;
            now = std::move(after);
        }
    }

  private:
    static bool is_same(const Vec2& p, const EdgeTurn& knuckle) { return glm::distance(p, knuckle.at) < kSameKnuckle; }

    std::vector<float> coverage_of_ink(const stroke::PlaneInk& ink) const { return coverage_by(ink, t_.target.wanted); }

    Worth worth_of(const std::vector<float>& coverage) const {
        Worth out{.reached = score_of(t_.target, t_.depths, coverage),
                  .knuckles = seen_knuckles(t_.whole, wanted_turns_, coverage)};
        out.value = value_of(out.reached, out.knuckles);
        return out;
    }

    /// Bends the tuft up to a part, and keeps what is inked before and after it.
    void keep_rest(const Part& part, const std::vector<Station>& stations) {
        const stroke::StrokeSamples trace = samples_of(stations, hand_, pace_);
        const double until = part.end(trace);
        before_ = coverage_of_ink(drawing_.keep(trace, part.begin(trace)));
        rest_ = before_;
        if (!std::isfinite(until)) return;
        drawing_.draw_part(trace, until);
        add_coverage(rest_, coverage_of_ink(drawing_.draw_rest(trace)));
    }

    std::vector<float> draw(const Part& part, const Change& change) {
        check_interrupt();
        const stroke::StrokeSamples trace = samples_of(part.changed(change), hand_, pace_);
        std::vector<float> coverage = coverage_of_ink(drawing_.draw_part(trace, part.end(trace)));
        add_coverage(coverage, rest_);
        return coverage;
    }

    /// The whole stroke. Up to the part it is as it was.
    std::vector<float> draw_from_part(const std::vector<Station>& stations) {
        const stroke::StrokeSamples trace = samples_of(stations, hand_, pace_);
        std::vector<float> coverage =
            coverage_of_ink(drawing_.draw_part(trace, std::numeric_limits<double>::infinity()));
        add_coverage(coverage, before_);
        return coverage;
    }

    using Response = EdgeResponse<kNumbers>;

    /// Compass search where the edge is expected.
    static Change find(const Near& near, const Response& response) {
        Change best = response.at();
        double value = near.value(response.distances(best));
        for (double step = kFirstStep; step >= kLastStep; step *= 0.5)
            for (int sweep = 0; sweep < kSweeps; ++sweep) {
                bool better = false;
                for (std::size_t k = 0; k < best.size(); ++k)
                    for (const double sign : {1.0, -1.0}) {
                        Change next = best;
                        next[k] += sign * step;
                        if (std::abs(next[k] - response.at()[k]) > kMostChange) continue;
                        const double own = near.value(response.distances(next));
                        if (!(own > value)) continue;
                        best = next, value = own, better = true;
                        break;
                    }
                if (!better) break;
            }
        return best;
    }

    /// `drawn`: the coverage without a change, worth `value`.
    Change search(const Part& part, const std::vector<float>& drawn, double value) {
        const Near near(t_, window_about(part, t_.target.wanted), wanted_turns_, drawn);
        Response response(near.distances(drawn));
        for (std::size_t k = 0; k < kNumbers; ++k) {
            Change step{};
            step[k] = part.is_head() || (k != 2 && k != 3) ? kSlopeStep : -kSlopeStep;
            response.set_slope(k, step[k], near.distances(draw(part, step)));
        }
        Change best{}, before{};
        for (int n = 0; n < kDrawn; ++n) {
            const Change next = find(near, response);
            if (next == best || next == before) break;  // a drawing of it would teach nothing
            before = next;
            const std::vector<float> inked = draw(part, next);
            const Worth own = worth_of(inked);
            const bool better = own.value > value;
            response.learn(next, near.distances(inked), better);
            if (better) best = next, value = own.value;
            if (better && std::ranges::none_of(own.knuckles, [&](const EdgeTurn& k) { return is_same(at_, k); })) break;
        }
        return best;
    }

    const KnuckleTarget& t_;
    const BrushHand& hand_;
    const Pace& pace_;
    stroke::PlaneDrawing drawing_;
    std::vector<EdgeTurn> wanted_turns_;
    std::vector<float> before_, rest_;  // coverage by what is drawn before a part, and by all but the part
    Vec2 at_{0};                        // the knuckle
};

}  // namespace

void take_off_knuckles(FitResult& fitted, const KnuckleTarget& target, const BrushHand& hand, const Pace& pace,
                       const FitOptions& options) {
    KnuckleFit(target, hand, pace, options).fit(fitted);
}

}  // namespace tuft::writer
