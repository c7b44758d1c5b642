#include "footprint/outline/hair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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
// Metres of travel over which the hair of a bundle rolls off and on; longer than it touches.
constexpr double kRolling = 12e-3;
constexpr double kBreaking = 4e-3;  // m of travel over which the ink under a single bristle breaks and closes
constexpr double kRollingPart = 0.2, kBreakingPart = 0.2;  // of the wetness at which they stop
constexpr double kThinning = 0.02;                         // wetness over which a thread of ink tapers before it breaks
// Sine of the angle from the tuft's motion, or the hand's course, at which hair that lands or leaves is swept aside.
constexpr double kAside = 0.35;
// Fraction of its allowed length across its motion that hair lacks while it lands or leaves.
constexpr double kLessLanding = 0.75;
constexpr double kTapers = 0.08;  // sine up to which it is not: hair draws together as a stroke runs out
// Sine from the course by which hair that goes along itself trails behind the hand round a curve.
constexpr double kTrails = 0.25;
constexpr double kMark = 45e-6;  // m, half width of a bristle's own streak: hair is 70–135 µm thick
// Wetness from which ink stands out beyond the outermost hair, and as far as it bridges.
constexpr double kSkirt = 0.7, kFullSkirt = 0.9;
constexpr double kBridge = 0.5;        // spacings that ink bridges from one bristle to the next at half wetness
constexpr double kLeastContact = 0.1;  // fraction of its length on the surface that the driest bristle touches with
constexpr double kSameEnd = 0.01;      // of the length
constexpr double kLeastLength = 1e-6;  // of the length, that hair touches with at least
constexpr double kStands = 0.3;        // height of a strip's thickness over itself up to which hair stands: on no side
constexpr double kBeyond = 0.5;        // widest half width that the outermost hair's ink may reach further

/// What of a section says which of its hair is on the surface.
struct Underside {
    double z = 0, a = 0, b = 0, e_z = 0, m_z = 0;  ///< of a disc, see Cut
    double thick_z = 0;                            ///< of a strip
    bool strip = false, touches = false;
    double length = 0;  ///< of hair that it stands for. The cap of an edge that just touches has none.

    Underside(const Trail& trail, std::size_t i) : Underside(trail.cuts[i]) {
        const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, trail.cuts.size() - 1);
        length = std::max(std::abs(trail.along[before] - trail.along[after]), kLeastLength);
        strip = trail.strip;
        if (!strip) return;
        const Cut& cut = trail.cuts[i];
        thick_z = cut.thick().z;
        touches = cut.overlap() >= 0;
    }
    /// Returns true where a place is in the half of its section that faces the surface, and the underside there is at
    /// or below the surface. The half of a strip is one of its broad sides: hair at the higher edge of a leaning strip
    /// is also on the surface. All of a strip that touches gives its ink: a leaning one comes down bundle by bundle,
    /// and would be of one bundle's ink for a stamp. `chord`: of the place, see Trail.
    bool is_on_surface(const Vec2& place, double chord) const {
        if (strip) return touches && place.y * thick_z <= 0;
        const double along_e = a * place.x * e_z;
        return along_e + b * place.y * m_z <= 0 && z + along_e - chord * b * std::abs(m_z) <= 0;
    }

  private:
    explicit Underside(const Cut& cut) : z(cut.z), a(cut.a), b(cut.b), e_z(cut.e.z), m_z(cut.m.z) {}
};

/// Position of a bristle in the sections of a trail: in the whole tuft, and in the branch that it belongs to.
struct BristlePlace {
    Vec2 whole{0};
    brush::BranchPlace part;

    BristlePlace(const brush::Bundles& bundles, const Vec2& place, int branches)
        : whole(place), part(brush::in_branch(bundles, place, branches)) {}
    const Vec2* at(const Trail& trail, std::size_t i) const& {
        if (i >= trail.trunk) return &whole;
        return part.branch == trail.branch ? &part.place : nullptr;
    }
    const Vec2* at(const Trail& trail, std::size_t i) const&& = delete;  // of no temporary
};

/// Noise in [-1, 1] along a line, smooth over one unit.
double smooth_noise(std::uint64_t seed, double x) {
    return value_noise(x, [&](std::uint64_t cell) { return 2 * uniform(seed, cell) - 1; });
}

/// Returns true when most of the hair lies rather along the picture's columns.
bool mostly_steep(std::span<const Trail> trails) {
    int steep = 0;
    for (const Trail& trail : trails)
        for (const Cut& cut : trail.cuts) steep += std::abs(cut.e.x) > std::abs(cut.e.y) ? 1 : -1;
    return steep > 0;
}

/// A band of hair that gives ink: from bristle to bristle across the section, and ink beyond them.
struct Strand {
    double lo = 0, hi = 0;            ///< positions of its outermost bristles in the section
    double past_lo = 0, past_hi = 0;  ///< metres of ink beyond them
    double begin = 0, end = 1;        ///< fractions of the tuft's length from the root
};

/// Part of the hair from root to tip, fractions of the tuft's length.
struct HairRange {
    double begin = 0, end = 1;
};

/// A bristle of the lower half of its section.
struct LowerBristle {
    double x = 0;  ///< position in the section, along e
    const brush::Bristle* bristle = nullptr;
};

std::uint64_t own_seed(const brush::Bundles& bundles, const brush::Bristle& b) {
    return hash_bits(bundles.seed, 100000 + static_cast<std::uint64_t>(&b - bundles.bristles.data()));
}

/// Wetness at which the thread of ink under a bristle breaks now.
double breaks_at(const brush::Bundles& bundles, const brush::Bristle& b, double travel) {
    const std::uint64_t own = own_seed(bundles, b);
    const double phase = uniform(own, 1);
    const double rolls = smooth_noise(hash_bits(bundles.seed, 1000 + b.bundle), travel / kRolling + 0.5 * phase + 1);
    const double breaks = smooth_noise(own, travel / kBreaking + phase + 16);
    return (1 - kThinning) * ((1 - kRollingPart - kBreakingPart) * (1 - static_cast<double>(b.readiness)) +
                              kRollingPart * (0.5 + 0.5 * rolls) + kBreakingPart * (0.5 + 0.5 * breaks));
}

/// Hair of a part of a trail, all of which lies on the surface, and its length across its motion; of hair that lands or
/// leaves also across the hand's course.
struct LyingHair {
    HairRange range;
    TransverseLength across;
    double press_share = 0, over_course = 0;  ///< metres, of that

    LyingHair(const TrailPart& part, const HairInk& ink)
        : range{part.trail.along[part.end - 1], part.trail.along[part.begin]},
          across(part, ink.before, ink.direction),
          press_share(ink.press_share) {
        const double size = glm::length(ink.course);
        for (std::size_t i = part.begin; i + 1 < part.end && size > 0; ++i) {
            const Vec2 run = part.trail.cuts[i + 1].centre - part.trail.cuts[i].centre;
            over_course += std::abs(run.x * ink.course.y - run.y * ink.course.x) / size;
        }
    }
    double measure(double x) const { return std::max(across.at(x), press_share * over_course); }
};

/// Part of a bristle that touches. Where ink closes the gaps it is all that lies on the surface. Elsewhere the bristle
/// must touch itself, with a part here or there, since hair is not quite straight and lies over other hair. Drawn
/// sideways it has ink for no wider a path than drawn along itself.
HairRange contact_range(const brush::Bundles& bundles, const brush::Bristle& b, double wet, double x,
                        const LyingHair& lying) {
    const HairRange& range = lying.range;
    if (wet >= 1) return {-4, 4};
    // Water draws the ends to a point.
    const double end = static_cast<double>(b.end) + (1 - static_cast<double>(b.end)) * std::max(0.0, 2 * wet - 1);
    const double limit =
        2 * kMark * std::max(1.0, (1 - kLessLanding * lying.press_share) * 0.5 * wet / ((1 - wet) * (1 - wet)));
    const double part = std::min({1.0, kLeastContact + 1.25 * wet * wet, limit / std::max(lying.measure(x), 1e-9)});
    const double rest = (1 - part) * std::max(0.0, end - range.begin), behind = uniform(own_seed(bundles, b), 2);
    return {part < 1 ? range.begin + (1 - behind * behind) * rest : -4, part < 1 ? end - behind * behind * rest : end};
}

/// Returns how much pressing or lifting sweeps the hair at x aside, 0–1: off the motion of the tuft, or with it off the
/// course.
double swept_share(const TransverseLength& across, double x, const HairInk& ink) {
    const double course = std::max(ink.sine_to_course, across.sine_to(x, ink.course));
    const double off_course = std::max(std::min(course, across.mean_sine(x)), course - kTrails);
    const double off = std::max(across.sine_to(x, ink.direction), off_course);
    return ink.press_share * smooth_step((off - kTapers) / (kAside - kTapers));
}

/// Bristles side by side into bands, in a section of half width `a` metres. `strip`: of a row.
Recycled<Strand> strands_of(Recycled<LowerBristle>& lower, const brush::Bundles& bundles, const HairInk& ink, double a,
                            const LyingHair& lying, bool strip) {
    Recycled<Strand> strands;
    std::sort(lower.begin(), lower.end(), [](const LowerBristle& p, const LowerBristle& q) {
        return p.x != q.x ? p.x < q.x : p.bristle < q.bristle;
    });
    const double spacing = 2 * a / std::max<double>(1, static_cast<double>(lower.size()));
    const auto wet_of = [&](const brush::Bristle& b) { return b.bundle < ink.wet.size() ? ink.wet[b.bundle] : 1; };
    double bridge_before = 0;
    for (std::size_t i = 0; i < lower.size(); ++i) {
        const brush::Bristle& b = *lower[i].bristle;
        const double aside = ink.press_share > 0 && !strip ? swept_share(lying.across, lower[i].x, ink) : 0;
        const double wet = wet_of(b), own = breaks_at(bundles, b, ink.travel), breaks = own + aside * (1 - own);
        const double active = std::clamp((wet - std::min(breaks, 1 - kThinning)) / kThinning, 0.0, 1.0);
        if (!(active > 0)) continue;
        const double bridge = wet >= 1 ? 8 * a : active * std::max(kMark, kBridge * spacing * wet / (1 - wet));
        const double mark = active * kMark;
        const HairRange on = contact_range(bundles, b, wet, lower[i].x, lying);
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

/// Returns the point where the section at lateral position x meets the surface, or its middle where all of it is below.
/// `chord`: of the trail at x.
Vec2 point_on_surface(const Trail& trail, const Cut& cut, double x, double chord) {
    const double height = trail.strip ? cut.thick().z : cut.b * cut.m.z;
    const double need = cut.z + (trail.strip ? x * cut.broad().z : cut.a * x * cut.e.z);
    const double meets = std::abs(height) > 1e-9 ? std::clamp(-need / height, -chord, chord) : 0;
    const double y = need < -chord * std::abs(height) ? 0 : meets;
    return trail.strip ? cut.centre + cut.bent(x) + x * Vec2(cut.broad()) + y * Vec2(cut.thick()) : cut.at(x, y);
}

/// Picture into which strands are drawn.
struct StrandPicture {
    Bands bands;
    Vec2 lo{0};       ///< metres, lower corner of cell (0, 0)
    double cell = 0;  ///< metres
};

/// Draws strands along a part of a trail. The first and the last piece of a strand go on a little: the outline bounds
/// them.
class StrandPen {
  public:
    StrandPen(const TrailPart& part, StrandPicture& picture) : trail_(part.trail), picture_(picture) {
        constexpr std::size_t kStride = 3;
        for (std::size_t i = part.begin; i < part.end; i += kStride) at_.push_back(i);
        if (!at_.empty() && at_.back() + 1 != part.end) at_.push_back(part.end - 1);
        across_.resize(at_.size());
        for (std::size_t k = 0; k < at_.size(); ++k) {
            const Vec2 e(trail_.strip ? trail_.cuts[at_[k]].broad() : trail_.cuts[at_[k]].e);
            across_[k] = glm::length(e) > 1e-9 ? glm::normalize(e) : Vec2{1, 0};
            widest_ = std::max(widest_, trail_.cuts[at_[k]].a);
        }
    }

    void draw(const Strand& strand) {
        if (at_.size() < 2) return;
        const Line line = line_of(strand);
        const double cell = picture_.cell;
        // Pieces from tip to root; the first and the last may end between two cuts.
        const std::size_t last = at_.size() - 1;
        std::size_t k = 0;
        while (k + 1 < last && along(k + 1) > strand.end) ++k;
        Vec2 before{0}, step{0};
        double half_before = 0;
        const bool whole_tip = along(0) <= strand.end, whole_root = along(last) >= strand.begin;
        bool first = true;
        Vec2 q = centre(line, k);
        double s = half_width(line, k);
        for (; k < last && along(k) > strand.begin && along(k + 1) < strand.end; ++k) {
            const Vec2 p = std::exchange(q, centre(line, k + 1));
            const double r = std::exchange(s, half_width(line, k + 1));
            const double from = along(k) > strand.end ? fraction(k, strand.end) : 0,
                         to = along(k + 1) < strand.begin ? fraction(k, strand.begin) : 1;
            const Vec2 start = glm::mix(p, q, from);
            const double half_start = glm::mix(r, s, from);
            before = glm::mix(p, q, to);
            half_before = glm::mix(r, s, to);
            step = q - p;
            if (first && whole_tip && glm::length(step) > 1e-9)
                picture_.bands.draw(start - widest_ / cell * glm::normalize(step), start, half_start, half_start,
                                    across_[k]);
            picture_.bands.draw(start, before, half_start, half_before, across_[k]);
            first = false;
        }
        if (!first && whole_root && glm::length(step) > 1e-9)
            picture_.bands.draw(before, before + widest_ / cell * glm::normalize(step), half_before, half_before,
                                across_.back());
    }

  private:
    /// A strand's middle and half width, as positions in the sections, and the ink beyond them, cells.
    struct Line {
        double x, chord, half, past_lo, past_hi;
    };
    Line line_of(const Strand& strand) const {
        // Ink reaches beyond the hair by a length of its own, so that the sides close where sections end in a point.
        const double most = kBeyond * widest_;
        const double x = 0.5 * (strand.lo + strand.hi);
        return {x, trail_.chord(x), 0.5 * (strand.hi - strand.lo), std::min(strand.past_lo, most) / picture_.cell,
                std::min(strand.past_hi, most) / picture_.cell};
    }
    double along(std::size_t k) const { return trail_.along[at_[k]]; }
    /// Centre and half width of a strand at cut k of the pen, cells.
    Vec2 centre(const Line& line, std::size_t k) const {
        return (point_on_surface(trail_, trail_.cuts[at_[k]], line.x, line.chord) - picture_.lo) / picture_.cell +
               0.5 * (line.past_hi - line.past_lo) * across_[k];
    }
    double half_width(const Line& line, std::size_t k) const {
        const Cut& cut = trail_.cuts[at_[k]];
        const double a = trail_.strip ? glm::length(Vec2(cut.broad())) : cut.a;
        return line.half * a / picture_.cell + 0.5 * (line.past_hi + line.past_lo);
    }
    /// Position of `at`, along the hair, between the cuts k and k + 1 of the pen, 0–1.
    double fraction(std::size_t k, double at) const {
        const double run = along(k) - along(k + 1);
        return run > 1e-12 ? std::clamp((along(k) - at) / run, 0.0, 1.0) : 0.0;
    }

    const Trail& trail_;
    StrandPicture& picture_;
    Recycled<std::size_t> at_;  // every third cut of the part, and its last
    Recycled<Vec2> across_;     // unit, of these cuts
    double widest_ = 0;         // metres
};

/// level = 255 − apart (255 − level), rounded; apart 0–256.
TUFT_CLONES void close_gaps(std::uint8_t* __restrict level, std::uint16_t apart, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
        level[i] = static_cast<std::uint8_t>(255 - static_cast<std::uint16_t>((255 - level[i]) * apart + 127) / 256);
}

/// coverage = coverage level / 255, rounded; returns the sum of what it was. For at most 2^16 cells.
TUFT_CLONES std::uint32_t scale_coverage(std::uint8_t* __restrict coverage, const std::uint8_t* __restrict level,
                                         int n) {
    std::uint32_t sum = 0;
    for (int i = 0; i < n; ++i) {
        const auto was = static_cast<std::uint16_t>(coverage[i]);
        sum += was;
        const auto t = static_cast<std::uint16_t>(was * level[i] + 127);  // t / 255 without dividing, exact below 65535
        coverage[i] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(t + 1 + (t >> 8)) >> 8);
    }
    return sum;
}

/// Calls f(bundle, cut, position in the section, length) for each part of a bundle on the surface. Returns true where
/// there is one.
template <class F>
bool for_each_contact(const Trail& trail, const brush::Bundles& bundles, int branches, F f) {
    constexpr std::size_t kStride = 3;  // sections looked at
    const std::size_t count = trail.cuts.size();
    Recycled<Underside> undersides;
    undersides.reserve(count / kStride + 1);
    for (std::size_t i = 0; i < count; i += kStride) undersides.emplace_back(trail, i);
    // Of them those of the sub-spine; the others are the trunk's.
    const std::size_t outer = std::min((trail.trunk + kStride - 1) / kStride, undersides.size());
    bool any = false;
    for (std::size_t k = 0; k < bundles.place.size(); ++k) {
        const BristlePlace placed(bundles, bundles.place[k], branches);
        const auto look = [&](std::size_t begin, std::size_t end, const Vec2& at) {
            const double chord = trail.chord(at.x);
            for (std::size_t s = begin; s < end; ++s) {
                if (!undersides[s].is_on_surface(at, chord)) continue;
                f(k, s * kStride, at, undersides[s].length);
                any = true;
            }
        };
        if (placed.part.branch == trail.branch) look(0, outer, placed.part.place);
        look(outer, undersides.size(), placed.whole);
    }
    return any;
}

/// The same of a spine of a ferrule that just touches, with less than a bundle: all its bundles, where it is lowest.
template <class F>
void for_each_bundle(const Trail& trail, const brush::Bundles& bundles, int branches, F f) {
    if (bundles.strips.empty() && bundles.around == 0) return;
    const auto deepest = std::max_element(trail.cuts.begin(), trail.cuts.end(),
                                          [](const Cut& p, const Cut& q) { return p.overlap() < q.overlap(); });
    const auto i = static_cast<std::size_t>(deepest - trail.cuts.begin());
    const double length = std::max(std::abs(trail.along.front() - trail.along.back()), kLeastLength);
    for (std::size_t k = 0; k < bundles.place.size(); ++k) {
        const BristlePlace place(bundles, bundles.place[k], branches);
        if (const Vec2* at = place.at(trail, i)) f(k, i, *at, length);
    }
}

}  // namespace

double wetness_of_bundle(double saturation, double holds, double speed) {
    return saturation * holds / (kClosing * (1 + std::max(speed, 0.0) / kFastHair));
}

Recycled<float> contact_cells(std::span<const Trail> trails, const brush::Bundles& bundles, int branches,
                              std::span<const double> ends) {
    const std::size_t n = bundles.place.size(), cells = ends.size();
    Recycled<double> sum(n * cells, 0);
    const auto cell_at = [&](double along) {
        return std::min<std::size_t>(std::upper_bound(ends.begin(), ends.end(), along) - ends.begin(), cells - 1);
    };
    Recycled<std::size_t> cell_of_cut;
    double front = 0;
    for (const Trail& trail : trails) {
        front = std::max(front, trail.along.front());
        cell_of_cut.clear();
        for (const double along : trail.along) cell_of_cut.push_back(cell_at(along));
        for_each_contact(trail, bundles, branches, [&](std::size_t k, std::size_t i, const Vec2&, double length) {
            sum[k * cells + cell_of_cut[i]] += length;
        });
    }
    double all = 0;
    for (const double v : sum) all += v;
    if (!(all > 0)) {
        for (std::size_t k = 0; k < n; ++k) sum[k * cells + cell_at(front)] = 1;
        all = static_cast<double>(n);
    }
    Recycled<float> parts(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) parts[i] = static_cast<float>(sum[i] / all);
    return parts;
}

Recycled<HairContactPoint> hair_contact_points(std::span<const Trail> trails, const brush::Bundles& bundles,
                                               int branches) {
    Recycled<HairContactPoint> found;
    for (const Trail& trail : trails) {
        const auto add = [&](std::size_t k, std::size_t i, const Vec2& place, double length) {
            const Vec2 at = point_on_surface(trail, trail.cuts[i], place.x, trail.chord(place.x));
            found.push_back({static_cast<std::uint32_t>(k), at, trail.along[i], length});
        };
        if (!for_each_contact(trail, bundles, branches, add)) for_each_bundle(trail, bundles, branches, add);
    }
    return found;
}

namespace {

/// Height of the thickness of a part of a strip over itself, along its hair: sine of its lean, −1 to 1.
double lean_of_strip(const TrailPart& part) {
    double height = 0, all = 0;
    for (std::size_t i = part.begin; i + 1 < part.end; ++i) {
        const double length = std::abs(part.trail.along[i + 1] - part.trail.along[i]);
        const Vec3 thick = part.trail.cuts[i].thick();
        height += length * thick.z;
        all += length * glm::length(thick);
    }
    return all > 0 ? height / all : 0;
}

/// Bristles of the lower half in a part of a trail. `places`: of all bristles; `sides`: see HairInk.
Recycled<LowerBristle> find_lower_bristles(const TrailPart& part, const brush::Bundles& bundles,
                                           std::span<const BristlePlace> places, std::span<const signed char> sides) {
    const Trail& trail = part.trail;
    // Heights over the middle, of all sections together: one of them would be another at every stamp, and hair that
    // sticks together lies on the same side.
    Vec2 height{0};
    for (std::size_t i = part.begin; i + 1 < part.end; ++i) {
        const Cut& cut = trail.cuts[i];
        const Vec2 own = trail.strip ? Vec2{0, cut.thick().z} : Vec2{cut.a * cut.e.z, cut.b * cut.m.z};
        height += std::abs(trail.along[i + 1] - trail.along[i]) * own;
    }
    const auto branch = static_cast<std::size_t>(trail.branch);
    if (trail.strip && branch < sides.size() && sides[branch] != 0) height = {0, sides[branch]};
    Recycled<LowerBristle> lower;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Vec2* at = places[k].at(trail, part.begin);
        if (at && glm::dot(height, *at) <= 0) lower.push_back({at->x, &bundles.bristles[k]});
    }
    return lower;
}

}  // namespace

void keep_sides(std::span<const Trail> trails, Recycled<signed char>& sides) {
    for (const Trail& trail : trails) {
        if (!trail.strip) continue;
        const auto branch = static_cast<std::size_t>(trail.branch);
        if (sides.size() <= branch) sides.resize(branch + 1, 0);
        const double lean = lean_of_strip({trail, 0, trail.cuts.size()});
        if (sides[branch] == 0 || std::abs(lean) > kStands) sides[branch] = lean > 0 ? 1 : -1;
    }
}

HairMarks draw_hair_marks(const TouchingHair& hair, const HairInk& ink, const PicturePlane& plane) {
    HairMarks result{rasterise(hair.outlines, plane, hair.edge), 0};
    Footprint& f = result.footprint;
    if (f.empty()) return result;
    Recycled<BristlePlace> places;
    places.reserve(hair.bundles.bristles.size());
    for (const brush::Bristle& b : hair.bundles.bristles)
        places.emplace_back(hair.bundles, brush::place_of(hair.bundles, b), hair.branches);
    StrandPicture picture{Bands(f.width, f.height, mostly_steep(hair.trails)), f.lo, f.cell};
    const auto draw = [&](const TrailPart& part) {
        if (part.begin >= part.end) return;
        double widest = 0;
        for (std::size_t i = part.begin; i < part.end; ++i) widest = std::max(widest, part.trail.cuts[i].a);
        Recycled<LowerBristle> lower = find_lower_bristles(part, hair.bundles, places, ink.sides);
        StrandPen pen(part, picture);
        for (const Strand& s : strands_of(lower, hair.bundles, ink, widest, LyingHair(part, ink), part.trail.strip))
            pen.draw(s);
    };
    for (const Trail& trail : hair.trails) {
        // The bands of both parts meet between two cuts.
        draw({trail, 0, std::min(trail.trunk + 1, trail.cuts.size())});
        draw({trail, trail.trunk, trail.cuts.size()});
    }
    Recycled<std::uint8_t> level;
    picture.bands.copy_rows(level);
    if (ink.apart < 1)
        close_gaps(level.data(), static_cast<std::uint16_t>(256 * std::clamp(ink.apart, 0.0, 1.0) + 0.5), level.size());
    std::uint64_t sum = 0;
    for (std::size_t row = 0; row < f.coverage.size(); row += static_cast<std::size_t>(f.width))
        sum += scale_coverage(f.coverage.data() + row, level.data() + row, f.width);
    result.closed_area = static_cast<double>(sum) / 255 * f.cell * f.cell;
    return result;
}

}  // namespace tuft::footprint
