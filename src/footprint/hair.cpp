#include "footprint/hair.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"

namespace tuft::footprint {
namespace {

constexpr double kClosing = 0.4;       // s_c
constexpr double kFastHair = 0.7;      // v_c, m/s
constexpr double kRolling = 12e-3;     // m of travel over which bristles roll off and on, longer than they touch
constexpr double kOwnPhase = 64;       // of rolling: neighbours in readiness do not roll together
constexpr double kRollingPart = 0.25;  // of the wetness at which they stop
constexpr double kThinning = 0.1;      // wetness over which a bristle thins before it stops
constexpr double kReach = 3;           // spacings that ink reaches at half wetness
constexpr double kSameEnd = 0.01;      // of the length
constexpr double kBeyond = 0.5;        // widest half width that the outermost hair's ink may reach further

/// Height of a place over its section's centre.
double rise(const Cut& cut, const Vec2& place) {
    return cut.a * place.x * cut.e.z + cut.b * place.y * cut.m.z;
}

/// The section's underside at the place is at or below the surface.
bool touches(const Cut& cut, const Vec2& place) {
    const double chord = std::sqrt(std::max(0.0, 1 - place.x * place.x));
    return cut.z + cut.a * place.x * cut.e.z - chord * cut.b * std::abs(cut.m.z) <= 0;
}

/// Where a place of the whole tuft lies at cut i, for the branch that the trail follows.
struct Placed {
    Vec2 whole{0};
    brush::BranchPlace part;

    Placed(const Vec2& place, int branches) : whole(place), part(brush::in_branch(place, branches)) {}
    const Vec2* at(const Trail& trail, std::size_t i) const {
        if (i >= trail.trunk) return &whole;
        return part.branch == trail.branch ? &part.place : nullptr;
    }
};

/// Value noise in [-1, 1] along a line, smooth over one unit.
double roll(std::uint64_t seed, double x) {
    const double cell = std::floor(x), f = x - cell, g = f * f * (3 - 2 * f);
    const auto value = [&](double c) { return 2 * uniform(seed, static_cast<std::uint64_t>(c)) - 1; };
    return value(cell) + g * (value(cell + 1) - value(cell));
}

/// Adds bands to a picture by columns, or rows for steep ones, with the area they cover.
class Bands {
  public:
    Bands(int width, int height) : width_(width), height_(height), level_(std::size_t(width) * height, 0) {}

    /// From p to q (cells), of half width r at p and s at q, measured along `across` (unit).
    void draw(Vec2 p, Vec2 q, double r, double s, const Vec2& across) {
        const bool steep = std::abs(across.x) > std::abs(across.y);
        if (steep) {
            std::swap(p.x, p.y);
            std::swap(q.x, q.y);
        }
        if (p.x > q.x) {
            std::swap(p, q);
            std::swap(r, s);
        }
        const double run = q.x - p.x;
        if (!(run > 1e-9)) return;
        const double slope = (q.y - p.y) / run, grow = (s - r) / run;
        // A band is cut along its columns; what it measures there.
        const double along = steep ? across.y : across.x, over = steep ? across.x : across.y;
        const double stretch = std::min(std::abs(over - slope * along), 1.0);
        const int columns = steep ? height_ : width_, rows = steep ? width_ : height_;
        const std::size_t next_column = steep ? std::size_t(width_) : 1, next = steep ? 1 : std::size_t(width_);
        const int first = std::max(static_cast<int>(p.x), 0);
        const int last = std::min(static_cast<int>(q.x), columns - 1);
        for (int i = first; i <= last; ++i) {
            const double from = std::max(p.x, double(i)), to = std::min(q.x, double(i) + 1);
            if (!(to > from)) continue;
            const double x = 0.5 * (from + to) - p.x, y = p.y + slope * x, reach = (r + grow * x) * stretch;
            column(static_cast<float>(255 * (to - from)), static_cast<float>(y - reach), static_cast<float>(y + reach),
                   rows, level_.data() + std::size_t(i) * next_column, next);
        }
    }

    const std::vector<std::uint8_t>& level() const { return level_; }

  private:
    static void add(std::uint8_t& cell, float v) {
        cell = static_cast<std::uint8_t>(std::min(255.0f, static_cast<float>(cell) + v + 0.5f));
    }

    static void column(float whole, float lo, float hi, int rows, std::uint8_t* cells, std::size_t next) {
        lo = std::max(lo, 0.0f);
        hi = std::min(hi, static_cast<float>(rows));
        if (!(hi > lo)) return;
        const int j0 = static_cast<int>(lo), j1 = std::min(static_cast<int>(hi), rows - 1);
        if (j0 == j1) {
            add(cells[std::size_t(j0) * next], whole * (hi - lo));
            return;
        }
        add(cells[std::size_t(j0) * next], whole * (static_cast<float>(j0 + 1) - lo));
        for (int j = j0 + 1; j < j1; ++j) add(cells[std::size_t(j) * next], whole);
        add(cells[std::size_t(j1) * next], whole * (hi - static_cast<float>(j1)));
    }

    int width_, height_;
    std::vector<std::uint8_t> level_;
};

/// A band of hair that gives ink: places from lo to hi across the section.
struct Strand {
    double lo = 0, hi = 0;
    double end = 1;  ///< part of the tuft's length from the root
};

/// One bristle of the lower half, as it is drawn.
struct Lower {
    double x = 0;
    const brush::Bristle* bristle = nullptr;
};

/// Bristles side by side into bands. Each covers the way to half between it and its neighbours,
/// as far as its ink reaches, or nothing once it has stopped.
std::vector<Strand> strands_of(std::vector<Lower>& lower, const brush::Bundles& bundles, const HairInk& ink) {
    std::vector<Strand> strands;
    std::sort(lower.begin(), lower.end(), [](const Lower& a, const Lower& b) {
        return a.x != b.x ? a.x < b.x : a.bristle < b.bristle;
    });
    const double spacing = 2.0 / std::max<double>(1, static_cast<double>(lower.size()));
    std::vector<double> rolled(bundles.place.size());
    for (std::size_t i = 0; i < lower.size(); ++i) {
        const brush::Bristle& b = *lower[i].bristle;
        const double wet = b.bundle < ink.wet.size() ? ink.wet[b.bundle] : 1;
        const double turn = roll(hash_bits(bundles.seed, 1000 + b.bundle),
                                 ink.travel / kRolling + kOwnPhase * static_cast<double>(b.readiness));
        const double stops = (1 - kThinning) * ((1 - kRollingPart) * (1 - static_cast<double>(b.readiness)) + kRollingPart * (0.5 + 0.5 * turn));
        const double active = std::clamp((wet - stops) / kThinning, 0.0, 1.0);
        if (!(active > 0)) continue;
        const double reach = wet >= 1 ? 4 : kReach * spacing * wet / (1 - wet);
        const double left = i == 0 ? 4 : 0.5 * (lower[i].x - lower[i - 1].x);
        const double right = i + 1 == lower.size() ? 4 : 0.5 * (lower[i + 1].x - lower[i].x);
        // Water draws the ends to a point.
        const double end = wet >= 1 ? 4 : static_cast<double>(b.end) + (1 - static_cast<double>(b.end)) * std::max(0.0, 2 * wet - 1);
        const Strand strand{lower[i].x - active * std::min(left, reach), lower[i].x + active * std::min(right, reach), end};
        if (!strands.empty() && strands.back().hi >= strand.lo - 1e-12 &&
            std::abs(strands.back().end - strand.end) < kSameEnd)
            strands.back().hi = strand.hi;
        else
            strands.push_back(strand);
    }
    return strands;
}

/// Where the section at lateral place x meets the surface, or its middle where all of it is below.
Vec2 on_surface(const Cut& cut, double x) {
    const double height = cut.b * cut.m.z, need = cut.z + cut.a * x * cut.e.z;
    const double chord = std::sqrt(std::max(0.0, 1 - x * x));
    const double y = std::abs(height) > 1e-9 ? std::clamp(-need / height, -chord, chord) : 0;
    return cut.at(x, need < -chord * std::abs(height) ? 0 : y);
}

/// Draws bands along the cuts [begin, end) of a trail. Its first and last piece go on a little:
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
        const double lo = std::clamp(strand.lo, -1.0, 1.0), hi = std::clamp(strand.hi, -1.0, 1.0);
        const double x = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
        // What reaches beyond the section's sides does so by a length of its own, so that the sides
        // close where sections end in a point.
        const double beyond_lo = std::clamp(-1 - strand.lo, 0.0, kBeyond) * widest / cell;
        const double beyond_hi = std::clamp(strand.hi - 1, 0.0, kBeyond) * widest / cell;
        const auto place = [&](std::size_t k) { return (on_surface(trail.cuts[at[k]], x) - zero) / cell + 0.5 * (beyond_hi - beyond_lo) * across[k]; };
        const auto half_width = [&](std::size_t k) { return half * trail.cuts[at[k]].a / cell + 0.5 * (beyond_hi + beyond_lo); };
        Vec2 before{0}, step{0};
        double half_before = 0;
        bool had = false, first = true;
        for (std::size_t k = 0; k < at.size(); ++k) {
            const double along = trail.along[at[k]];
            if (along > strand.end) continue;
            const Vec2 here = place(k);
            const double h = half_width(k);
            if (!had && k > 0) {
                // It ends between two cuts.
                const double f = (strand.end - along) / std::max(trail.along[at[k - 1]] - along, 1e-12);
                before = glm::mix(here, place(k - 1), f);
                half_before = glm::mix(h, half_width(k - 1), f);
                had = true;
            }
            if (had) {
                step = here - before;
                const Vec2 direction = glm::length(step) > 1e-9 ? glm::normalize(step) : Vec2{0};
                if (first && k == 1 && trail.along[at[0]] <= strand.end)
                    bands.draw(before - widest / cell * direction, before, half_before, half_before, across[k]);
                bands.draw(before, here, half_before, h, across[k]);
                first = false;
            }
            before = here;
            half_before = h;
            had = true;
        }
        if (!first && glm::length(step) > 1e-9)
            bands.draw(before, before + widest / cell * glm::normalize(step), half_before, half_before, across.back());
    }
}

/// Calls f(bundle, cut, place in the section, length) for what of the bundles lies on the surface.
template <class F>
void each_touch(const Trail& trail, const brush::Bundles& bundles, int branches, F f) {
    constexpr std::size_t kStride = 3;  // sections looked at
    const std::size_t count = trail.cuts.size();
    for (std::size_t k = 0; k < bundles.place.size(); ++k) {
        const Placed placed(bundles.place[k], branches);
        for (std::size_t i = 0; i < count; i += kStride) {
            const Vec2* at = placed.at(trail, i);
            if (!at || rise(trail.cuts[i], *at) > 0 || !touches(trail.cuts[i], *at)) continue;
            const std::size_t a = i > 0 ? i - 1 : i, b = std::min(i + 1, count - 1);
            f(k, i, *at, std::abs(trail.along[a] - trail.along[b]));
        }
    }
}

}  // namespace

double wetness_of_bundle(double saturation, double holds, double speed) {
    return saturation * holds / (kClosing * (1 + std::max(speed, 0.0) / kFastHair));
}

std::vector<float> touched_cells(std::span<const Trail> trails, const brush::Bundles& bundles,
                                 int branches, std::span<const double> ends) {
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

std::vector<HairTouch> hair_touches(std::span<const Trail> trails, const brush::Bundles& bundles, int branches) {
    std::vector<HairTouch> found;
    for (const Trail& trail : trails)
        each_touch(trail, bundles, branches, [&](std::size_t k, std::size_t i, const Vec2& place, double length) {
            found.push_back({static_cast<std::uint32_t>(k), on_surface(trail.cuts[i], place.x), trail.along[i], length});
        });
    return found;
}

HairMarks hair_marks(std::span<const Trail> trails, std::span<const Outline> outlines,
                     const brush::Bundles& bundles, int branches, const HairInk& ink,
                     const Frame& frame, std::uint32_t triangle, double cell) {
    HairMarks result{rasterise(outlines, frame, triangle, cell), 0};
    Footprint& f = result.footprint;
    if (f.empty()) return result;
    cell = f.cell;
    std::vector<Placed> places;
    places.reserve(bundles.bristles.size());
    for (const brush::Bristle& b : bundles.bristles) places.emplace_back(brush::place_of(bundles, b), branches);
    Bands bands(f.width, f.height);
    std::vector<Lower> lower;
    const auto draw = [&](const Trail& trail, std::size_t begin, std::size_t end) {
        if (begin >= end) return;
        // The one nearest to the root of those as wide: splayed tips are as wide, but without height.
        std::size_t widest = end - 1;
        for (std::size_t i = end - 1; i-- > begin;)
            if (trail.cuts[i].a > (1 + 1e-6) * trail.cuts[widest].a) widest = i;
        lower.clear();
        for (std::size_t k = 0; k < places.size(); ++k) {
            const Vec2* at = places[k].at(trail, widest);
            if (at && rise(trail.cuts[widest], *at) <= 0) lower.push_back({at->x, &bundles.bristles[k]});
        }
        draw_strands(trail, begin, end, strands_of(lower, bundles, ink), f.lo, cell, bands);
    };
    for (const Trail& trail : trails) {
        // The bands of both parts meet between two cuts.
        draw(trail, 0, std::min(trail.trunk + 1, trail.cuts.size()));
        draw(trail, trail.trunk, trail.cuts.size());
    }
    const std::vector<std::uint8_t>& level = bands.level();
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < level.size(); ++i) {
        sum += f.coverage[i];
        f.coverage[i] = static_cast<std::uint8_t>((f.coverage[i] * level[i] + 127) / 255);
    }
    result.closed_area = static_cast<double>(sum) / 255 * cell * cell;
    return result;
}

}  // namespace tuft::footprint
