#include "stroke/drawing/long_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stroke/gesture/mix_samples.h"
#include "stroke/gesture/tractrix.h"

namespace tuft::stroke {
namespace {

constexpr double kInkGiven = 0.28;      // part of the ink that a brush gives before gaps show
constexpr double kLeastPressure = 0.3;  // least pressure of a brush that is taken larger for its ink
constexpr double kTipSupply = 30;       // seconds, of a brush that is taken larger
constexpr double kCutSlack = 0.1;       // of a piece, to both sides, within which a cut is looked for
constexpr double kShortestPiece = 4;    // overlaps

/// A line as a function of the metres along it; of a closed one, round and round.
class Path {
  public:
    explicit Path(const StrokeSamples& trace)
        : samples_(trace.samples), along_(travelled<StrokeSample>(trace.samples)) {
        turned_.assign(samples_.size(), 0);
        Vec2 before{0};
        for (std::size_t i = 1; i < samples_.size(); ++i) {
            const Vec2 step = samples_[i].position - samples_[i - 1].position;
            double turn = 0;
            if (glm::length(step) > 0) {
                if (before != Vec2(0))
                    turn = std::abs(std::atan2(before.x * step.y - before.y * step.x, glm::dot(before, step)));
                before = step;
            }
            turned_[i] = turned_[i - 1] + turn;
        }
    }
    double length() const { return along_.back(); }
    bool closed() const {
        return samples_.size() > 3 &&
               glm::length(samples_.back().position - samples_.front().position) <= 1e-6 * length();
    }
    /// Radians by which it turns within `reach` to both sides of a place.
    double turn(double at, double reach) const { return turned_at(at + reach) - turned_at(at - reach); }

    /// The samples from one place to another; what lies past the end goes on from the beginning.
    std::vector<StrokeSample> part(double from, double to) const {
        std::vector<StrokeSample> out;
        add(out, from, std::min(to, length()), 0);
        if (to > length()) add(out, 0, to - length(), samples_.back().time - samples_.front().time);
        const double start = out.front().time;
        for (StrokeSample& s : out) s.time -= start;
        return out;
    }

  private:
    std::size_t segment(double at) const {  // that ends behind `at`
        const auto next = std::upper_bound(along_.begin() + 1, along_.end() - 1, at);
        return static_cast<std::size_t>(next - along_.begin());
    }
    double within(std::size_t i, double at) const {
        const double length = along_[i] - along_[i - 1];
        return length > 0 ? std::clamp((at - along_[i - 1]) / length, 0.0, 1.0) : 0;
    }
    double turned_at(double at) const {
        at = std::clamp(at, 0.0, length());
        const std::size_t i = segment(at);
        return std::lerp(turned_[i - 1], turned_[i], within(i, at));
    }
    void add(std::vector<StrokeSample>& out, double from, double to, double later) const {
        const std::size_t first = segment(from), last = segment(to);
        const auto put = [&](StrokeSample s) {
            s.time += later;
            if (out.empty() || out.back().position != s.position) out.push_back(s);
        };
        put(mix_samples(samples_[first - 1], samples_[first], within(first, from)));
        for (std::size_t i = first; i < last; ++i) put(samples_[i]);
        put(mix_samples(samples_[last - 1], samples_[last], within(last, to)));
    }

    std::span<const StrokeSample> samples_;
    std::vector<double> along_, turned_;
};

/// Where, near `even`, a cut shows least.
double best_cut(const Path& path, double even, double slack, double overlap) {
    constexpr int kTried = 20;
    constexpr double kSlackTurn = 0.02;  // radians that the whole slack counts
    double best = even, least = 1e30;
    for (int k = -kTried; k <= kTried; ++k) {
        const double off = static_cast<double>(k) / kTried, at = even + off * slack;
        const double cost = path.turn(at, overlap) + kSlackTurn * std::abs(off);
        if (cost < least) least = cost, best = at;
    }
    return best;
}

}  // namespace

double whole_length(const brush::Preset& preset, double width, double film) {
    return kInkGiven * preset.capacity / std::max(film * width, 1e-30);
}

double supply_time(const brush::Preset& preset, double width, double film, double speed) {
    return preset.capacity / std::max(film * width * speed, 1e-30);
}

void pace_line(StrokeSamples& trace, const brush::Preset& preset, double film) {
    const double seconds = trace.samples.empty() ? 0 : trace.samples.back().time - trace.samples.front().time;
    if (!(seconds > 0)) return;
    const double slower = kSteadySupply / supply_time(preset, trace.line_width, film, length_of(trace) / seconds);
    if (slower > 1)
        for (StrokeSample& s : trace.samples) s.time *= slower;
}

std::string brush_for_line(const std::string& name, WidthTables& tables, double width, double length, double film,
                           double speed) {
    const LineWidths& widths = tables.of(name);
    const std::string fits = brush_for_width(name, widths, width);
    if (whole_length(tables.preset(fits), width, film) >= length) return fits;
    const brush::SizedName sized = brush::sized_name(fits);
    // Hair grows with the brush, the ink round it does not.
    const double hair = widths.at(kLeastPressure) - 2 * kSkinFilm;
    const double most = std::min(brush::kMostSize, (width - 2 * kSkinFilm) / hair * brush::sized_name(name).factor);
    std::string larger = fits;
    for (double size = std::log(sized.factor) / std::log(kBrushSizes);;) {
        size = std::floor(size + 1e-6) + 1;
        const double factor = std::pow(kBrushSizes, size);
        if (factor > most * (1 + 1e-9)) break;
        const std::string next = brush::name_of({sized.base, factor});
        if (supply_time(tables.preset(next), width, film, speed) < kTipSupply) continue;
        larger = next;
        if (whole_length(tables.preset(larger), width, film) >= length) break;
    }
    return larger;
}

double length_of(const StrokeSamples& trace) {
    return trace.samples.empty() ? 0 : travelled<StrokeSample>(trace.samples).back();
}

std::vector<StrokeSamples> cut_line(const StrokeSamples& trace, double longest, double overlap) {
    if (trace.samples.size() < 2 || !(overlap > 0) || !(longest > 0)) return {trace};
    const Path path(trace);
    const double whole = path.length();
    const auto n =
        static_cast<std::size_t>(std::min(std::ceil(whole / longest), std::floor(whole / (kShortestPiece * overlap))));
    if (n < 2) return {trace};
    const double even = whole / static_cast<double>(n);
    std::vector<double> cuts{0};
    for (std::size_t k = 1; k < n; ++k)
        cuts.push_back(
            best_cut(path, even * static_cast<double>(k), std::min(kCutSlack * even, 0.5 * even - overlap), overlap));
    cuts.push_back(whole);
    std::vector<StrokeSamples> pieces;
    for (std::size_t k = 0; k < n; ++k) {
        StrokeSamples piece = trace;
        const double over = k + 1 < n ? 0.5 * overlap : path.closed() ? overlap : 0;
        piece.samples = path.part(k > 0 ? cuts[k] - 0.5 * overlap : 0, cuts[k + 1] + over);
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

}  // namespace tuft::stroke
