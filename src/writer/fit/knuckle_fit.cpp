#include "writer/fit/knuckle_fit.h"

#include <algorithm>
#include <cmath>

#include "core/system/interrupt.h"
#include "writer/fit/ink_score.h"
#include "writer/gesture/knuckles.h"

namespace tuft::writer {
namespace {

constexpr double kPrice = 0.01;  // of the score, for a knuckle of the least curvature
constexpr double kSoft = 1.5;    // stations of the Gaussian over which a place is changed
constexpr double kHead = 45;     // units from the first station within which a knuckle is the head's
constexpr double kSame = 30;     // units by which a knuckle moves when the path is changed, at most
constexpr int kRounds = 3;       // over the knuckles of a stroke
constexpr double kLeastGain = 5e-4;
constexpr std::size_t kBeyond = 10;  // stations after a changed one from which ink is taken as that of the path before

/// A path as it is drawn.
struct Drawing {
    std::vector<Station> stations;
    InkScore reached;
    double value = 0;                // what the changes raise
    std::vector<EdgeTurn> knuckles;  // sharpest first
};

class KnuckleFit {
  public:
    KnuckleFit(const FitTarget& target, const std::vector<float>& depths, const BrushHand& hand, const Pace& pace,
               const FitOptions& options, stroke::PlaneDrawing& drawing)
        : target_(target),
          depths_(depths),
          hand_(hand),
          pace_(pace),
          options_(options),
          turns_(edge_turns(target.wanted, coverage_of(target.wanted), 0.5 * kKnuckle)),
          drawing_(drawing) {}

    Drawing draw(std::vector<Station> stations) {
        check_interrupt();
        ++draws_;
        trace_ = samples_of(stations, hand_, pace_);
        return judged(std::move(stations), drawing_.draw(trace_));
    }

    /// Draws a path that differs from the last one of `draw` or `finish` about the station `at`: as far as it differs.
    Drawing draw_part(std::vector<Station> stations, std::size_t at) {
        check_interrupt();
        ++draws_;
        part_ = samples_of(stations, hand_, pace_);
        const std::size_t touch = part_.samples.size() - 1 - stations.size();  // samples before the first station
        const std::size_t end = std::min(touch + at + kBeyond, part_.samples.size() - 1);
        return judged(std::move(stations),
                      drawing_.draw_part(part_, part_.samples[end].time, trace_.samples[end].time));
    }

    /// Draws the rest of the last path of `draw_part`.
    Drawing finish(std::vector<Station> stations) {
        trace_ = part_;
        return judged(std::move(stations), drawing_.finish());
    }

    bool may_draw() const { return draws_ < options_.knuckle_tries; }
    int draws() const { return draws_; }

  private:
    Drawing judged(std::vector<Station> stations, const stroke::PlaneInk& ink) const {
        Drawing out{.stations = std::move(stations)};
        const Cells& wanted = target_.wanted;
        const std::vector<float> coverage = coverage_by(ink, wanted);
        out.reached = score_of(target_, depths_, coverage);
        out.value = out.reached.score;
        for (const EdgeTurn& turn : knuckles_of(wanted, coverage, turns_)) {
            if (is_under_another(turn.at)) continue;
            out.value -= kPrice * std::abs(turn.curvature) / kKnuckle;
            out.knuckles.push_back(turn);
        }
        std::stable_sort(out.knuckles.begin(), out.knuckles.end(), [](const EdgeTurn& a, const EdgeTurn& b) {
            return std::abs(a.curvature) > std::abs(b.curvature);
        });
        return out;
    }

    bool is_under_another(const Vec2& p) const {
        const Cells& c = target_.wanted;
        const Vec2 cell = glm::floor((p - c.lo) / c.cell);
        const auto i = static_cast<int>(cell.x), j = static_cast<int>(cell.y);
        if (i < 0 || j < 0 || i >= c.width || j >= c.height) return false;
        return target_.weight(std::size_t(j) * c.width + static_cast<std::size_t>(i)) < 1;
    }

    const FitTarget& target_;
    const std::vector<float>& depths_;
    const BrushHand& hand_;
    const Pace& pace_;
    const FitOptions& options_;
    std::vector<EdgeTurn> turns_;
    stroke::PlaneDrawing& drawing_;
    stroke::StrokeSamples trace_, part_;  // of the last path drawn to its end, and of that of `draw_part`
    int draws_ = 0;
};

/// Changes of a path near a station: a shift, a factor of the half width.
struct Change {
    Vec2 shift{0};
    double factor = 1;
};

std::vector<Station> changed(std::vector<Station> s, std::size_t at, const Change& change) {
    for (std::size_t i = 0; i < s.size(); ++i) {
        const double z = (static_cast<double>(i) - static_cast<double>(at)) / kSoft, w = std::exp(-0.5 * z * z);
        if (w < 0.01) continue;
        s[i].centre += w * change.shift;
        s[i].half *= 1 + w * (change.factor - 1);
    }
    return s;
}

Vec2 unit_of(const Vec2& v) {
    const double size = glm::length(v);
    return size > 1e-9 ? v / size : Vec2(1, 0);
}

/// Changes that may take a knuckle off: of a swelling or of a neck.
std::vector<std::pair<std::size_t, Change>> changes_at(const std::vector<Station>& s, const EdgeTurn& knuckle) {
    std::size_t near = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
        if (glm::distance(s[i].centre, knuckle.at) < glm::distance(s[near].centre, knuckle.at)) near = i;
    const Vec2 out = unit_of(knuckle.at - s[near].centre);
    const bool neck = knuckle.curvature < 0;
    std::vector<std::pair<std::size_t, Change>> all;
    if (neck)
        for (const Change& c : {Change{Vec2(0), 1.12}, Change{3.0 * out, 1}}) all.emplace_back(near, c);
    else
        for (const Change& c : {Change{-3.0 * out, 1}, Change{Vec2(0), 0.88}, Change{Vec2(0), 1.12},
                                Change{3.0 * out, 1}, Change{3.0 * out, 0.88}, Change{6.0 * out, 0.8}})
            all.emplace_back(near, c);
    if (!neck && glm::distance(s[0].centre, knuckle.at) < kHead && s.size() > 4) {
        const Vec2 on = unit_of(s[2].centre - s[0].centre), left(-on.y, on.x);
        for (const Vec2& shift : {4.0 * left, -4.0 * left, 4.0 * on, -4.0 * on}) all.push_back({0, {shift, 1}});
        for (const double factor : {1.3, 0.7}) all.push_back({0, {Vec2(0), factor}});
    }
    return all;
}

bool has_like(const std::vector<EdgeTurn>& knuckles, const EdgeTurn& one) {
    return std::any_of(knuckles.begin(), knuckles.end(), [&](const EdgeTurn& k) {
        return k.curvature * one.curvature > 0 && glm::distance(k.at, one.at) < kSame;
    });
}

}  // namespace

FitResult take_off_knuckles(FitResult fitted, const FitTarget& target, const std::vector<float>& depths,
                            const BrushHand& hand, const Pace& pace, const FitOptions& options,
                            stroke::PlaneDrawing& drawing) {
    if (options.knuckle_tries <= 0 || fitted.stations.size() < 4) return fitted;
    KnuckleFit fit(target, depths, hand, pace, options, drawing);
    Drawing best = fit.draw(fitted.stations);
    for (int round = 0; round < kRounds && !best.knuckles.empty(); ++round) {
        const double before = best.value;
        const std::vector<EdgeTurn> knuckles = best.knuckles;
        for (const EdgeTurn& knuckle : knuckles)
            for (const auto& [at, change] : changes_at(best.stations, knuckle)) {
                if (!fit.may_draw() || !has_like(best.knuckles, knuckle)) break;
                Drawing next = fit.draw_part(changed(best.stations, at, change), at);
                if (!(next.value > best.value)) continue;
                next = fit.finish(std::move(next.stations));
                if (next.value > best.value)
                    best = std::move(next);
                else if (fit.may_draw())
                    fit.draw(best.stations);
            }
        if (best.value < before + kLeastGain) break;
    }
    fitted.stations = best.stations, fitted.iou = best.reached.iou, fitted.score = best.reached.score;
    fitted.tries += fit.draws();
    return fitted;
}

}  // namespace tuft::writer
