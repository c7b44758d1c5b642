#include "writer/fit/knuckle_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/system/interrupt.h"
#include "writer/fit/ink_score.h"
#include "writer/fit/path.h"

namespace tuft::writer {
namespace {

constexpr double kChanged = 48;           // units about a knuckle in which the path changes
constexpr double kWholeHead = 60;         // units from the first station: the head changes
constexpr double kDrawnBefore = 16;       // units before a change from which it is drawn
constexpr double kDrawnAfter = 40;        // units after it to which it is drawn: the hair trails
constexpr double kFirstChange = 4;        // units
constexpr int kSearchRounds = 3;          // each with half the step of the one before
constexpr double kKnucklePrice = 0.0015;  // of the score, for a knuckle of the least curvature
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

/// Coverage by what a drawing inked before a time.
std::vector<float> coverage_before(const stroke::PlaneInk& ink, const Cells& cells, double unit, double until) {
    std::vector<float> rest = coverage_by(ink, cells);
    for (int j = 0; j < cells.height; ++j)
        for (int i = 0; i < cells.width; ++i) {
            float& there = rest[std::size_t(j) * cells.width + i];
            if (!(there > 0)) continue;
            const double when = ink.when(cells.centre(i, j) * unit);
            if (when < 0 || when >= until) there = 0;
        }
    return rest;
}

void add_coverage(std::vector<float>& to, const std::vector<float>& more) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = std::max(to[i], more[i]);
}

/// What ink is worth.
struct Worth {
    InkScore reached;
    std::vector<EdgeTurn> knuckles;
    double value = 0;
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
        Worth now = worth_of_stroke(fitted.stations);
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
            const Change best = search(part);
            if (best == Change{}) continue;
            std::vector<Station> next = part.changed(best);
            Worth after = worth_of_stroke(next);
            if (!(after.value > now.value)) continue;  // what follows the part is bent otherwise
            fitted.stations = std::move(next);
            fitted.iou = after.reached.iou, fitted.score = after.reached.score;
            now = std::move(after);
        }
    }

  private:
    static bool is_same(const Vec2& p, const EdgeTurn& knuckle) { return glm::distance(p, knuckle.at) < kSameKnuckle; }

    Worth worth_of(const std::vector<float>& coverage) const {
        Worth out{.reached = score_of(t_.target, t_.depths, coverage),
                  .knuckles = seen_knuckles(t_.whole, wanted_turns_, coverage)};
        out.value = out.reached.score - kKnucklePrice * sharpness_of(out.knuckles);
        return out;
    }

    Worth worth_of_stroke(const std::vector<Station>& stations) {
        return worth_of(coverage_by(drawing_.draw(samples_of(stations, hand_, pace_)), t_.target.wanted));
    }

    /// Bends the tuft up to a part, and keeps what is inked before and after it.
    void keep_rest(const Part& part, const std::vector<Station>& stations) {
        const Cells& cells = t_.target.wanted;
        const stroke::StrokeSamples trace = samples_of(stations, hand_, pace_);
        const double from = part.begin(trace), until = part.end(trace);
        rest_ = coverage_before(drawing_.draw(trace), cells, hand_.unit, from);
        if (std::isfinite(until)) {
            drawing_.keep(trace, until);
            add_coverage(rest_, coverage_by(drawing_.draw_part(trace, trace.samples.back().time + 1), cells));
        }
        drawing_.keep(trace, from);
    }

    Worth worth_of_part(const Part& part, const Change& change) {
        check_interrupt();
        const stroke::StrokeSamples trace = samples_of(part.changed(change), hand_, pace_);
        std::vector<float> coverage = coverage_by(drawing_.draw_part(trace, part.end(trace)), t_.target.wanted);
        add_coverage(coverage, rest_);
        return worth_of(coverage);
    }

    Change search(const Part& part) {
        Change best{};
        Worth worth = worth_of_part(part, best);
        double step = kFirstChange;
        const auto has_knuckle = [&] {
            return std::ranges::any_of(worth.knuckles, [&](const EdgeTurn& k) { return is_same(at_, k); });
        };
        for (int round = 0; round < kSearchRounds && has_knuckle(); ++round, step *= 0.5)
            for (std::size_t k = 0; k < best.size(); ++k)
                for (const double sign : {1.0, -1.0}) {
                    Change next = best;
                    next[k] += sign * step;
                    Worth own = worth_of_part(part, next);
                    if (!(own.value > worth.value)) continue;
                    best = next, worth = std::move(own);
                    break;
                }
        return best;
    }

    const KnuckleTarget& t_;
    const BrushHand& hand_;
    const Pace& pace_;
    stroke::PlaneDrawing drawing_;
    std::vector<EdgeTurn> wanted_turns_;
    std::vector<float> rest_;  // coverage by what is not drawn again
    Vec2 at_{0};               // the knuckle
};

}  // namespace

void take_off_knuckles(FitResult& fitted, const KnuckleTarget& target, const BrushHand& hand, const Pace& pace,
                       const FitOptions& options) {
    KnuckleFit(target, hand, pace, options).fit(fitted);
}

}  // namespace tuft::writer
