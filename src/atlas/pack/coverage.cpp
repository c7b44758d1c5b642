#include "atlas/pack/coverage.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "atlas/pack/raster.h"
#include "atlas/seams/half_edges.h"
#include "core/geometry/segment.h"

namespace tuft::atlas {
namespace {

struct Segment {
    Vec2 a, b;  // texels
    std::uint32_t chart;
};

double distance(const Segment& s, const Segment& t) {
    const auto side = [](const Segment& g, const Vec2& p) {
        return (g.b.x - g.a.x) * (p.y - g.a.y) - (g.b.y - g.a.y) * (p.x - g.a.x);
    };
    if (side(s, t.a) * side(s, t.b) < 0 && side(t, s.a) * side(t, s.b) < 0) return 0;
    return std::min(std::min(segment_distance(t.a, t.b, s.a), segment_distance(t.a, t.b, s.b)),
                    std::min(segment_distance(s.a, s.b, t.a), segment_distance(s.a, s.b, t.b)));
}

/// Segments by the square cells they pass, in compressed rows.
class SegmentGrid {
  public:
    SegmentGrid(const std::vector<Segment>& segments, double cell, double side)
        : cell_(cell), columns_(static_cast<std::size_t>(side / cell) + 1) {
        start_.assign(columns_ * columns_ + 1, 0);
        for (const Segment& s : segments) for_cells(s, 0, [&](std::size_t c) { ++start_[c + 1]; });
        for (std::size_t c = 0; c + 1 < start_.size(); ++c) start_[c + 1] += start_[c];
        std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
        items_.resize(start_.back());
        for (std::uint32_t i = 0; i < segments.size(); ++i)
            for_cells(segments[i], 0, [&](std::size_t c) { items_[fill[c]++] = i; });
    }

    std::span<const std::uint32_t> at(std::size_t c) const {
        return {items_.data() + start_[c], start_[c + 1] - start_[c]};
    }

    /// Cells within `reach` of the segment, row by row.
    template <class Visit>
    void for_cells(const Segment& s, double reach, Visit&& visit) const {
        const auto index = [&](double x) {
            const double c = std::floor(x / cell_);
            return static_cast<std::size_t>(std::clamp(c, 0.0, static_cast<double>(columns_ - 1)));
        };
        const std::size_t y0 = index(std::min(s.a.y, s.b.y) - reach);
        const std::size_t y1 = index(std::max(s.a.y, s.b.y) + reach);
        const double dy = s.b.y - s.a.y;
        for (std::size_t y = y0; y <= y1; ++y) {
            double xa = std::min(s.a.x, s.b.x), xb = std::max(s.a.x, s.b.x);
            if (std::abs(dy) > cell_) {
                const double slope = (s.b.x - s.a.x) / dy;
                const double lo = static_cast<double>(y) * cell_ - reach;
                const double hi = static_cast<double>(y + 1) * cell_ + reach;
                const double p = s.a.x + slope * (lo - s.a.y), q = s.a.x + slope * (hi - s.a.y);
                xa = std::max(xa, std::min(p, q) - 1e-6 * cell_);
                xb = std::min(xb, std::max(p, q) + 1e-6 * cell_);
            }
            for (std::size_t x = index(xa - reach); x <= index(xb + reach); ++x) visit(y * columns_ + x);
        }
    }

  private:
    double cell_;
    std::size_t columns_;
    std::vector<std::uint32_t> start_, items_;
};

}  // namespace

std::vector<std::uint8_t> uv_seams(std::span<const std::uint32_t> twin, std::span<const Vec2f> corner_uvs) {
    std::vector<std::uint8_t> seam(twin.size(), 1);
    for (std::uint32_t h = 0; h < twin.size(); ++h) {
        const std::uint32_t g = twin[h];
        if (g == kNone) continue;
        seam[h] = corner_uvs[h] != corner_uvs[next_half(g)] || corner_uvs[next_half(h)] != corner_uvs[g];
    }
    return seam;
}

Coverage cover(std::span<const Vec2f> corner_uvs, std::span<const std::uint32_t> triangle_chart, std::uint32_t size) {
    const std::size_t words = (std::size_t{size} + 63) / 64;
    std::vector<std::uint64_t> once(words * size, 0), twice(words * size, 0);
    const std::size_t n = corner_uvs.size() / 3;
    const auto for_words = [&](std::size_t t, auto&& visit) {
        const std::array<Vec2f, 3> uv{corner_uvs[3 * t], corner_uvs[3 * t + 1], corner_uvs[3 * t + 2]};
        raster_rows(uv, size, [&](std::uint32_t row, std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t w = first / 64; w <= last / 64; ++w) {
                std::uint64_t bits = ~std::uint64_t{0};
                if (w == first / 64) bits &= ~std::uint64_t{0} << (first % 64);
                if (w == last / 64) bits &= ~std::uint64_t{0} >> (63 - last % 64);
                visit(row * words + w, bits);
            }
        });
    };
    for (std::size_t t = 0; t < n; ++t)
        for_words(t, [&](std::size_t w, std::uint64_t bits) {
            twice[w] |= once[w] & bits;
            once[w] |= bits;
        });
    Coverage coverage;
    for (std::size_t w = 0; w < once.size(); ++w) {
        coverage.covered += static_cast<std::size_t>(std::popcount(once[w]));
        coverage.twice += static_cast<std::size_t>(std::popcount(twice[w]));
    }
    if (coverage.twice == 0 || triangle_chart.empty()) return coverage;
    for (std::size_t t = 0; t < n; ++t) {
        bool hit = false;
        for_words(t, [&](std::size_t w, std::uint64_t bits) { hit |= (twice[w] & bits) != 0; });
        if (hit) coverage.charts_twice.push_back(triangle_chart[t]);
    }
    auto& charts = coverage.charts_twice;
    std::sort(charts.begin(), charts.end());
    charts.erase(std::unique(charts.begin(), charts.end()), charts.end());
    return coverage;
}

int smallest_gap(std::span<const std::uint8_t> seam, std::span<const Vec2f> corner_uvs,
                 std::span<const std::uint32_t> triangle_chart, std::uint32_t size) {
    std::vector<Segment> segments;
    for (std::uint32_t h = 0; h < seam.size(); ++h) {
        if (!seam[h]) continue;
        const Vec2f a = corner_uvs[h], b = corner_uvs[next_half(h)];
        if (!is_finite(a) || !is_finite(b) || a == b) continue;
        const Vec2f lo = glm::min(a, b), hi = glm::max(a, b);
        if (std::max(lo.x, lo.y) > 1 || std::min(hi.x, hi.y) < 0) continue;
        segments.push_back({Vec2(a) * double(size), Vec2(b) * double(size), triangle_chart[h / 3]});
    }
    constexpr double kMost = 64;
    for (double reach = 2; reach <= kMost; reach *= 2) {
        const SegmentGrid grid(segments, std::max(reach, size / 1024.0), size);
        double nearest = kMost + 1;
        for (std::uint32_t i = 0; i < segments.size(); ++i)
            grid.for_cells(segments[i], reach, [&](std::size_t c) {
                for (const std::uint32_t j : grid.at(c))
                    if (j > i && segments[j].chart != segments[i].chart)
                        nearest = std::min(nearest, distance(segments[i], segments[j]));
            });
        // Rounding to floats moves a border by at most 2⁻²⁴ of the page.
        if (nearest <= reach) return static_cast<int>(nearest + 1e-6 * size);
    }
    return static_cast<int>(kMost);
}

int smallest_gap(std::span<const std::uint8_t> seam, const Atlas& atlas) {
    if (atlas.pages == 1) return smallest_gap(seam, atlas.corner_uvs, atlas.triangle_chart, atlas.size);
    std::vector<std::vector<std::uint32_t>> halves(atlas.pages);
    for (std::uint32_t h = 0; h < seam.size(); ++h)
        if (seam[h]) halves[std::min(atlas.page_of(h / 3), atlas.pages - 1)].push_back(h);
    std::vector<std::uint8_t> of_page(seam.size(), 0);
    int least = std::numeric_limits<int>::max();
    for (const std::vector<std::uint32_t>& page : halves) {
        for (const std::uint32_t h : page) of_page[h] = 1;
        least = std::min(least, smallest_gap(of_page, atlas.corner_uvs, atlas.triangle_chart, atlas.size));
        for (const std::uint32_t h : page) of_page[h] = 0;
    }
    return least;
}

}  // namespace tuft::atlas
