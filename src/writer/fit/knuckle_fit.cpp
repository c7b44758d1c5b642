#include "writer/fit/knuckle_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/system/interrupt.h"
#include "writer/fit/ink_score.h"
#include "writer/fit/path.h"

namespace tuft::writer {
namespace {

double env(const char* name, double otherwise) {
    const char* v = std::getenv(name);
    return v ? std::atof(v) : otherwise;
}
static const double kChanged = env("T_REACH", 48);       // units about a knuckle in which the path changes
static const double kWholeHead = env("T_HEAD", 60);        // units from the first station: the head changes
static const double kDrawnBefore = env("T_BEFORE", 16);  // units before a change from which it is drawn
static const double kDrawnAfter = env("T_AFTER", 40);    // units after it to which it is drawn: the hair trails
static const double kFirstChange = env("T_STEP", 4);     // units
static const int kSearchRounds = static_cast<int>(env("T_ROUNDS", 2));
static const double kKnucklePrice = env("T_PRICE", 0.002);  // of the score, for a knuckle of the least curvature
static const std::size_t kMostKnuckles = static_cast<std::size_t>(env("T_MOST", 4));
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

/// Coverage by what a drawing inked before or after a time.
std::vector<float> coverage_but(const stroke::PlaneInk& ink, const Cells& cells, double unit, double from,
                                double until) {
    std::vector<float> rest = coverage_by(ink, cells);
    for (int j = 0; j < cells.height; ++j)
        for (int i = 0; i < cells.width; ++i) {
            float& there = rest[std::size_t(j) * cells.width + i];
            if (!(there > 0)) continue;
            const double when = ink.when(cells.centre(i, j) * unit);
            if (when < 0 || (when >= from && when <= until)) there = 0;
        }
    return rest;
}

/// A path and what its ink is worth.
struct Drawn {
    Change change{};
    InkScore reached;
    double value = 0;
    bool smooth = false;  // no knuckle is left where one was
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
        const Cells& cells = t_.target.wanted;
        std::vector<Vec2> tried;
        while (tried.size() < kMostKnuckles) {
            const stroke::StrokeSamples trace = samples_of(fitted.stations, hand_, pace_);
            const stroke::PlaneInk ink = drawing_.draw(trace);
            std::vector<EdgeTurn> knuckles = seen_knuckles(t_.whole, wanted_turns_, coverage_by(ink, cells));
            std::erase_if(knuckles, [&](const EdgeTurn& k) {
                return std::ranges::any_of(tried, [&](const Vec2& p) { return is_same(p, k); });
            });
            if (knuckles.empty()) return;
            at_ = std::ranges::max_element(knuckles, {}, [](const EdgeTurn& k) { return std::abs(k.curvature); })->at;
            tried.push_back(at_);
            const Part part(fitted.stations, at_);
            const double from = part.begin(trace);
            rest_ = coverage_but(ink, cells, hand_.unit, from, part.end(trace));
            drawing_.keep(trace, from);
            const Drawn best = search(part);
            if (best.change == Change{}) continue;
            fitted.stations = part.changed(best.change);
            fitted.iou = best.reached.iou, fitted.score = best.reached.score;
        }
    }

  private:
    static bool is_same(const Vec2& p, const EdgeTurn& knuckle) { return glm::distance(p, knuckle.at) < kSameKnuckle; }

    Drawn drawn(const Part& part, const Change& change) {
        check_interrupt();
        const stroke::StrokeSamples trace = samples_of(part.changed(change), hand_, pace_);
        std::vector<float> coverage = coverage_by(drawing_.draw_part(trace, part.end(trace)), t_.target.wanted);
        for (std::size_t i = 0; i < coverage.size(); ++i) coverage[i] = std::max(coverage[i], rest_[i]);
        const std::vector<EdgeTurn> knuckles = seen_knuckles(t_.whole, wanted_turns_, coverage);
        Drawn out{.change = change, .reached = score_of(t_.target, t_.depths, coverage)};
        out.value = out.reached.score - kKnucklePrice * sharpness_of(knuckles);
        out.smooth = std::ranges::none_of(knuckles, [&](const EdgeTurn& k) { return is_same(at_, k); });
        return out;
    }

    Drawn search(const Part& part) {
        Drawn best = drawn(part, {});
        double step = kFirstChange;
        for (int round = 0; round < kSearchRounds && !best.smooth; ++round, step *= 0.5)
            for (std::size_t k = 0; k < kNumbers; ++k)
                for (const double sign : {1.0, -1.0}) {
                    Change next = best.change;
                    next[k] += sign * step;
                    const Drawn own = drawn(part, next);
                    if (!(own.value > best.value)) continue;
                    best = own;
                    break;
                }
        return best;
    }

    const KnuckleTarget& t_;
    const BrushHand& hand_;
    const Pace& pace_;
    stroke::PlaneDrawing drawing_;
    std::vector<EdgeTurn> wanted_turns_;
    std::vector<float> rest_;
    Vec2 at_{0};
};

}  // namespace

void take_off_knuckles(FitResult& fitted, const KnuckleTarget& target, const BrushHand& hand, const Pace& pace,
                       const FitOptions& options) {
    KnuckleFit(target, hand, pace, options).fit(fitted);
}

}  // namespace tuft::writer
