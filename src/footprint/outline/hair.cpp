#include "footprint/outline/hair.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/ease.h"
#include "core/noise.h"
#include "core/random.h"
#include "core/simd.h"
#include "footprint/outline/bands.h"
#include "footprint/outline/slip.h"

namespace tuft::footprint {
namespace {

constexpr double kClosing = 0.4;   // s_c
constexpr double kFastHair = 0.7;  // v_c, m/s
constexpr double kRolling =
    12e-3;  // m of travel over which the hair of a bundle rolls off and on, longer than it touches
constexpr double kBreaking = 4e-3;  // m of travel over which the ink under a single bristle breaks and closes
constexpr double kRollingPart = 0.2, kBreakingPart = 0.2;  // of the wetness at which they stop
constexpr double kThinning = 0.02;                         // wetness over which a thread of ink tapers before it breaks
constexpr double kAside = 0.35;  // sine of the angle from the tuft's way, or the hand's course, at which hair that
                                 // lands or leaves is swept aside
constexpr double kLessLanding =
    0.75;                         // of what it may measure across its motion, that it lacks while it lands or leaves
constexpr double kTapers = 0.08;  // sine up to which it is not: hair draws together as a stroke runs out
constexpr double kTrails = 0.25;  // sine from the course by which hair that goes along itself
                                  // trails behind the hand round a curve
constexpr double kMark = 45e-6;   // m, half width of what a bristle leaves by itself: hair is 70–135 µm thick
constexpr double kSkirt = 0.7,
                 kFullSkirt =
                     0.9;  // wetness from which ink stands out beyond the outermost hair, and as far as it bridges
constexpr double kBridge = 0.5;        // spacings that ink bridges from one bristle to the next at half wetness
constexpr double kLeastContact = 0.1;  // part of what lies down of it that the driest bristle touches with
constexpr double kSameEnd = 0.01;      // of the length
constexpr double kBeyond = 0.5;        // widest half width that the outermost hair's ink may reach further

/// Height of a place over its section's centre.
double rise(const Cut& cut, const Vec2& place) {
    return cut.a * place.x * cut.e.z + cut.b * place.y * cut.m.z;
}

/// The section's underside at the place is at or below the surface.
bool touches(const Trail& trail, const Cut& cut, const Vec2& place) {
    const double chord = trail.chord(place.x);
    return cut.z + cut.a * place.x * cut.e.z - chord * cut.b * std::abs(cut.m.z) <= 0;
}

/// Where a place of the whole tuft lies at cut i, for the branch that the trail follows.
struct Placed {
    Vec2 whole{0};
    brush::BranchPlace part;

    Placed(const brush::Bundles& bundles, const Vec2& place, int branches)
        : whole(place), part(brush::in_branch(bundles, place, branches)) {}
    const Vec2* at(const Trail& trail, std::size_t i) const {
        if (i >= trail.trunk) return &whole;
        return part.branch == trail.branch ? &part.place : nullptr;
    }
};

/// Noise in [-1, 1] along a line, smooth over one unit.
double roll(std::uint64_t seed, double x) {
    return value_noise(x, [&](std::uint64_t cell) { return 2 * uniform(seed, cell) - 1; });
}

/// Whether most of the hair lies rather along the picture's columns.
bool mostly_steep(std::span<const Trail> trails) {
    int steep = 0;
    for (const Trail& trail : trails)
        for (const Cut& cut : trail.cuts) steep += std::abs(cut.e.x) > std::abs(cut.e.y) ? 1 : -1;
    return steep > 0;
}

/// A band of hair that gives ink: from bristle to bristle across the section, and ink beyond them.
struct Strand {
    double lo = 0, hi = 0;            ///< places of its outermost bristles
    double past_lo = 0, past_hi = 0;  ///< metres of ink beyond them
    double begin = 0, end = 1;        ///< parts of the tuft's length from the root
};

/// From root to tip, parts of the tuft's length.
struct Lying {
    double begin = 0, end = 1;
};

/// One bristle of the lower half, as it is drawn.
struct Lower {
    double x = 0;
    const brush::Bristle* bristle = nullptr;
};

std::uint64_t own_seed(const brush::Bundles& bundles, const brush::Bristle& b) {
    return hash_bits(bundles.seed, 100000 + static_cast<std::uint64_t>(&b - bundles.bristles.data()));
}

/// Wetness at which the thread of ink under a bristle breaks now.
double breaks_at(const brush::Bundles& bundles, const brush::Bristle& b, double travel) {
    const std::uint64_t own = own_seed(bundles, b);
    const double phase = uniform(own, 1);
    const double rolls = roll(hash_bits(bundles.seed, 1000 + b.bundle), travel / kRolling + 0.5 * phase + 1);
    const double breaks = roll(own, travel / kBreaking + phase + 16);
    return (1 - kThinning) * ((1 - kRollingPart - kBreakingPart) * (1 - static_cast<double>(b.readiness)) +
                              kRollingPart * (0.5 + 0.5 * rolls) + kBreakingPart * (0.5 + 0.5 * breaks));
}

/// What lies down of the hair, parts of the tuft's length, and what it measures across its motion; of hair that lands
/// or leaves also across the hand's course.
struct Laid {
    Lying lies;
    TransverseLength across;
    double press_share = 0, over_course = 0;  ///< metres, of that

    Laid(const Trail& trail, std::size_t begin, std::size_t end, const HairInk& ink)
        : lies{trail.along[end - 1], trail.along[begin]},
          across(trail, begin, end, ink.before, ink.direction),
          press_share(ink.press_share) {
        const double size = glm::length(ink.course);
        for (std::size_t i = begin; i + 1 < end && size > 0; ++i) {
            const Vec2 run = trail.cuts[i + 1].centre - trail.cuts[i].centre;
            over_course += std::abs(run.x * ink.course.y - run.y * ink.course.x) / size;
        }
    }
    double measure(double x) const { return std::max(across.at(x), press_share * over_course); }
};

/// Where a bristle touches: with all that lies down of it where ink closes the gaps, with a part of it, here or there,
/// where it must touch itself, since hair is not quite straight and lies over other hair. Drawn sideways it has ink for
/// no wider a way than drawn along itself.
Lying touching(const brush::Bundles& bundles, const brush::Bristle& b, double wet, double x, const Laid& laid) {
    const Lying& lies = laid.lies;
    if (wet >= 1) return {-4, 4};
    // Water draws the ends to a point.
    const double end = static_cast<double>(b.end) + (1 - static_cast<double>(b.end)) * std::max(0.0, 2 * wet - 1);
    const double limit =
        2 * kMark * std::max(1.0, (1 - kLessLanding * laid.press_share) * 0.5 * wet / ((1 - wet) * (1 - wet)));
    const double part = std::min({1.0, kLeastContact + 1.25 * wet * wet, limit / std::max(laid.measure(x), 1e-9)});
    const double rest = (1 - part) * std::max(0.0, end - lies.begin), behind = uniform(own_seed(bundles, b), 2);
    return {part < 1 ? lies.begin + (1 - behind * behind) * rest : -4, part < 1 ? end - behind * behind * rest : end};
}

/// How much what the hand presses or lifts sweeps the hair at x aside, 0–1: off the way of the tuft, or with it off the
/// course.
double swept_aside(const TransverseLength& across, double x, const HairInk& ink) {
    const double course = std::max(ink.sine_to_course, across.sine_to(x, ink.course));
    const double off_course = std::max(std::min(course, across.mean_sine(x)), course - kTrails);
    const double off = std::max(across.sine_to(x, ink.direction), off_course);
    return ink.press_share * smooth_step((off - kTapers) / (kAside - kTapers));
}

/// Bristles side by side into bands, in a section of half width `a` metres.
std::vector<Strand> strands_of(std::vector<Lower>& lower, const brush::Bundles& bundles, const HairInk& ink, double a,
                               const Laid& laid) {
    std::vector<Strand> strands;
    std::sort(lower.begin(), lower.end(),
              [](const Lower& p, const Lower& q) { return p.x != q.x ? p.x < q.x : p.bristle < q.bristle; });
    const double spacing = 2 * a / std::max<double>(1, static_cast<double>(lower.size()));
    const auto wet_of = [&](const brush::Bristle& b) { return b.bundle < ink.wet.size() ? ink.wet[b.bundle] : 1; };
    double bridge_before = 0;
    for (std::size_t i = 0; i < lower.size(); ++i) {
        const brush::Bristle& b = *lower[i].bristle;
        const double aside = ink.press_share > 0 ? swept_aside(laid.across, lower[i].x, ink) : 0;
        const double wet = wet_of(b), own = breaks_at(bundles, b, ink.travel), breaks = own + aside * (1 - own);
        const double active = std::clamp((wet - std::min(breaks, 1 - kThinning)) / kThinning, 0.0, 1.0);
        if (!(active > 0)) continue;
        const double bridge = wet >= 1 ? 8 * a : active * std::max(kMark, kBridge * spacing * wet / (1 - wet));
        const double mark = active * kMark;
        const Lying on = touching(bundles, b, wet, lower[i].x, laid);
        const double skirt = std::lerp(mark, bridge, smooth_step((wet - kSkirt) / (kFullSkirt - kSkirt)));
        const double past_lo = i == 0 ? skirt : mark;
        const double past_hi = i + 1 == lower.size() ? skirt : mark;
        const double gap = strands.empty() ? 1e9 : (lower[i].x - strands.back().hi) * a;
        const bool bridged = gap <= bridge_before + bridge;
        if (bridged && std::abs(strands.back().begin - on.begin) < kSameEnd &&
            std::abs(strands.back().end - on.end) < kSameEnd) {
            strands.back().hi = lower[i].x;
            strands.back().past_hi = past_hi;
        } else {
            if (bridged) strands.back().past_hi = std::max(strands.back().past_hi, 0.5 * gap);
            strands.push_back(
                {lower[i].x, lower[i].x, bridged ? std::max(past_lo, 0.5 * gap) : past_lo, past_hi, on.begin, on.end});
        }
        bridge_before = bridge;
    }
    return strands;
}

/// Where the section at lateral place x meets the surface, or its middle where all of it is below.
Vec2 on_surface(const Trail& trail, const Cut& cut, double x) {
    const double height = cut.b * cut.m.z, need = cut.z + cut.a * x * cut.e.z;
    const double chord = trail.chord(x);
    const double y = std::abs(height) > 1e-9 ? std::clamp(-need / height, -chord, chord) : 0;
    return cut.at(x, need < -chord * std::abs(height) ? 0 : y);
}

/// Draws bands along the cuts [begin, end) of a trail. Its first and last cluster go on a little:
/// the outline bounds them.
void draw_strands(const Trail& trail, std::size_t begin, std::size_t end, std::span<const Strand> strands,
                  const Vec2& zero, double cell, Bands& bands) {
    constexpr std::size_t kStride = 3;
    std::vector<std::size_t> at;
    for (std::size_t i = begin; i < end; i += kStride) at.push_back(i);
    if (at.empty()) return;
    if (at.back() + 1 != end) at.push_back(end - 1);
    if (at.size() < 2) return;
    std::vector<Vec2> across(at.size());
    double widest = 0;
    for (std::size_t k = 0; k < at.size(); ++k) {
        const Vec2 e(trail.cuts[at[k]].e);
        across[k] = glm::length(e) > 1e-9 ? glm::normalize(e) : Vec2{1, 0};
        widest = std::max(widest, trail.cuts[at[k]].a);
    }
    for (const Strand& strand : strands) {
        const double x = 0.5 * (strand.lo + strand.hi), half = 0.5 * (strand.hi - strand.lo);
        // Ink reaches beyond the hair by a length of its own, so that the sides close where sections end in a point.
        const double most = kBeyond * widest;
        const double past_lo = std::min(strand.past_lo, most) / cell, past_hi = std::min(strand.past_hi, most) / cell;
        const auto place = [&](std::size_t k) {
            return (on_surface(trail, trail.cuts[at[k]], x) - zero) / cell + 0.5 * (past_hi - past_lo) * across[k];
        };
        const auto half_width = [&](std::size_t k) {
            return half * trail.cuts[at[k]].a / cell + 0.5 * (past_hi + past_lo);
        };
        // Pieces from tip to root; the first and the last may end between two cuts.
        const std::size_t last = at.size() - 1;
        std::size_t k = 0;
        while (k + 1 < last && trail.along[at[k + 1]] > strand.end) ++k;
        Vec2 before{0}, step{0};
        double half_before = 0;
        const auto part_of = [&](std::size_t i, double along) {  // of the cluster from cut i on
            const double run = trail.along[at[i]] - trail.along[at[i + 1]];
            return run > 1e-12 ? std::clamp((trail.along[at[i]] - along) / run, 0.0, 1.0) : 0.0;
        };
        const bool whole_tip = trail.along[at[0]] <= strand.end, whole_root = trail.along[at[last]] >= strand.begin;
        bool first = true;
        for (; k < last && trail.along[at[k]] > strand.begin && trail.along[at[k + 1]] < strand.end; ++k) {
            const Vec2 p = place(k), q = place(k + 1);
            const double r = half_width(k), s = half_width(k + 1), f = part_of(k, strand.end),
                         g = part_of(k, strand.begin);
            const double from = trail.along[at[k]] > strand.end ? f : 0,
                         to = trail.along[at[k + 1]] < strand.begin ? g : 1;
            const Vec2 start = glm::mix(p, q, from);
            const double half_start = glm::mix(r, s, from);
            before = glm::mix(p, q, to);
            half_before = glm::mix(r, s, to);
            step = q - p;
            if (first && whole_tip && glm::length(step) > 1e-9)
                bands.draw(start - widest / cell * glm::normalize(step), start, half_start, half_start, across[k]);
            bands.draw(start, before, half_start, half_before, across[k]);
            first = false;
        }
        if (!first && whole_root && glm::length(step) > 1e-9)
            bands.draw(before, before + widest / cell * glm::normalize(step), half_before, half_before, across.back());
    }
}

/// coverage = coverage level / 255, rounded; returns the sum of what it was. For at most 2^16 cells.
TUFT_CLONES std::uint32_t thin(std::uint8_t* __restrict coverage, const std::uint8_t* __restrict level, int n) {
    std::uint32_t sum = 0;
    for (int i = 0; i < n; ++i) {
        const auto was = static_cast<std::uint16_t>(coverage[i]);
        sum += was;
        const auto t = static_cast<std::uint16_t>(was * level[i] + 127);  // t / 255 without dividing, exact below 65535
        coverage[i] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(t + 1 + (t >> 8)) >> 8);
    }
    return sum;
}

/// Calls f(bundle, cut, place in the section, length) for what of the bundles lies on the surface.
template <class F>
void each_touch(const Trail& trail, const brush::Bundles& bundles, int branches, F f) {
    constexpr std::size_t kStride = 3;  // sections looked at
    const std::size_t count = trail.cuts.size();
    for (std::size_t k = 0; k < bundles.place.size(); ++k) {
        const Placed placed(bundles, bundles.place[k], branches);
        for (std::size_t i = 0; i < count; i += kStride) {
            const Vec2* at = placed.at(trail, i);
            if (!at || rise(trail.cuts[i], *at) > 0 || !touches(trail, trail.cuts[i], *at)) continue;
            const std::size_t a = i > 0 ? i - 1 : i, b = std::min(i + 1, count - 1);
            f(k, i, *at, std::abs(trail.along[a] - trail.along[b]));
        }
    }
}

}  // namespace

double wetness_of_bundle(double saturation, double holds, double speed) {
    return saturation * holds / (kClosing * (1 + std::max(speed, 0.0) / kFastHair));
}

std::vector<float> contact_cells(std::span<const Trail> trails, const brush::Bundles& bundles, int branches,
                                 std::span<const double> ends) {
    const std::size_t n = bundles.place.size(), cells = ends.size();
    std::vector<double> sum(n * cells, 0);
    const auto cell_at = [&](double along) {
        return std::min<std::size_t>(std::upper_bound(ends.begin(), ends.end(), along) - ends.begin(), cells - 1);
    };
    double front = 0;
    for (const Trail& trail : trails) {
        front = std::max(front, trail.along.front());
        each_touch(trail, bundles, branches, [&](std::size_t k, std::size_t i, const Vec2&, double length) {
            sum[k * cells + cell_at(trail.along[i])] += length;
        });
    }
    double all = 0;
    for (const double v : sum) all += v;
    if (!(all > 0)) {
        for (std::size_t k = 0; k < n; ++k) sum[k * cells + cell_at(front)] = 1;
        all = static_cast<double>(n);
    }
    std::vector<float> parts(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) parts[i] = static_cast<float>(sum[i] / all);
    return parts;
}

std::vector<HairContactPoint> hair_contact_points(std::span<const Trail> trails, const brush::Bundles& bundles,
                                                  int branches) {
    std::vector<HairContactPoint> found;
    for (const Trail& trail : trails)
        each_touch(trail, bundles, branches, [&](std::size_t k, std::size_t i, const Vec2& place, double length) {
            found.push_back(
                {static_cast<std::uint32_t>(k), on_surface(trail, trail.cuts[i], place.x), trail.along[i], length});
        });
    return found;
}

HairMarks hair_marks(std::span<const Trail> trails, std::span<const Outline> outlines, const brush::Bundles& bundles,
                     int branches, const HairInk& ink, const Frame& frame, std::uint32_t triangle, double cell) {
    HairMarks result{rasterise(outlines, frame, triangle, cell), 0};
    Footprint& f = result.footprint;
    if (f.empty()) return result;
    cell = f.cell;
    std::vector<Placed> places;
    places.reserve(bundles.bristles.size());
    for (const brush::Bristle& b : bundles.bristles)
        places.emplace_back(bundles, brush::place_of(bundles, b), branches);
    Bands bands(f.width, f.height, mostly_steep(trails));
    std::vector<Lower> lower;
    const auto draw = [&](const Trail& trail, std::size_t begin, std::size_t end) {
        if (begin >= end) return;
        const Laid laid(trail, begin, end, ink);
        double widest = 0;
        // Heights over the middle, of all sections together: one of them would be another at every stamp, and hair that
        // sticks together lies on the same side.
        Vec2 height{0};
        for (std::size_t i = begin; i < end; ++i) {
            const Cut& cut = trail.cuts[i];
            widest = std::max(widest, cut.a);
            if (i + 1 == end) break;
            height += std::abs(trail.along[i + 1] - trail.along[i]) * Vec2{cut.a * cut.e.z, cut.b * cut.m.z};
        }
        lower.clear();
        for (std::size_t k = 0; k < places.size(); ++k) {
            const Vec2* at = places[k].at(trail, begin);
            if (at && glm::dot(height, *at) <= 0) lower.push_back({at->x, &bundles.bristles[k]});
        }
        draw_strands(trail, begin, end, strands_of(lower, bundles, ink, widest, laid), f.lo, cell, bands);
    };
    for (const Trail& trail : trails) {
        // The bands of both parts meet between two cuts.
        draw(trail, 0, std::min(trail.trunk + 1, trail.cuts.size()));
        draw(trail, trail.trunk, trail.cuts.size());
    }
    std::vector<std::uint8_t> level;
    bands.rows(level);
    std::uint64_t sum = 0;
    for (std::size_t row = 0; row < f.coverage.size(); row += static_cast<std::size_t>(f.width))
        sum += thin(f.coverage.data() + row, level.data() + row, f.width);
    result.closed_area = static_cast<double>(sum) / 255 * cell * cell;
    return result;
}

}  // namespace tuft::footprint
