#include "atlas/pack_mask.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "atlas/hull.h"
#include "core/hash.h"

namespace tuft::atlas {
namespace {

double turn(const Vec2& o, const Vec2& a, const Vec2& b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// The first bit from `i` on that differs from those of `all`, all zeros or all ones; the end where
/// there is none.
std::size_t next_bit(std::span<const std::uint64_t> line, std::size_t i, std::uint64_t all) {
    for (; i < 64 * line.size(); i = (i / 64 + 1) * 64) {
        const std::uint64_t rest = (line[i / 64] ^ all) >> (i % 64);
        if (rest != 0) return i + static_cast<std::size_t>(std::countr_zero(rest));
    }
    return 64 * line.size();
}

}  // namespace

Shape make_shape(const std::vector<Vec2>& border) {
    Shape shape;
    shape.border = &border;
    for (std::size_t i = 0; i < border.size(); ++i)
        shape.area += 0.5 * turn(border[0], border[i], border[(i + 1) % border.size()]);
    const Rectangle box = smallest_rectangle(convex_hull(border));
    shape.extent = box.length;
    shape.angle = -std::atan2(box.s, box.c);
    return shape;
}

Mask make_mask(const Shape& shape, double scale, double angle, double cell) {
    Mask mask;
    mask.c = std::cos(angle);
    mask.s = std::sin(angle);
    std::vector<Vec2> p(shape.border->size());
    Vec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2& q = (*shape.border)[i];
        p[i] = scale * Vec2(mask.c * q.x - mask.s * q.y, mask.s * q.x + mask.c * q.y);
        lo = glm::min(lo, p[i]);
        hi = glm::max(hi, p[i]);
    }
    mask.corner = lo;
    for (Vec2& q : p) q = (q - lo) / cell;
    const Vec2 side = (hi - lo) / cell;
    mask.width = static_cast<std::uint32_t>(side.x) + 1;
    mask.height = static_cast<std::uint32_t>(side.y) + 1;
    const std::size_t words = (mask.width + 63) / 64;
    std::vector<std::uint64_t> bits(words * mask.height, 0);
    std::vector<std::pair<std::uint32_t, double>> crossings;  // rows, and where the border crosses their middles
    const auto fill = [&](std::size_t row, double a, double b) {
        const auto first = static_cast<std::size_t>(std::max(a, 0.0));
        const auto last =
            std::min<std::size_t>(static_cast<std::size_t>(std::max(b, 0.0)), mask.width - 1);
        for (std::size_t w = first / 64; w <= last / 64; ++w) {
            std::uint64_t m = ~std::uint64_t{0};
            if (w == first / 64) m &= ~std::uint64_t{0} << (first % 64);
            if (w == last / 64) m &= ~std::uint64_t{0} >> (63 - last % 64);
            bits[row * words + w] |= m;
        }
    };
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2 a = p[i], b = p[(i + 1) % p.size()];
        const double y0 = std::min(a.y, b.y), y1 = std::max(a.y, b.y);
        const double slope = y1 > y0 ? (b.x - a.x) / (b.y - a.y) : 0;
        const auto last = std::min(static_cast<std::uint32_t>(y1), mask.height - 1);
        for (auto row = static_cast<std::uint32_t>(y0); row <= last; ++row) {
            double xa = std::min(a.x, b.x), xb = std::max(a.x, b.x);
            if (y1 > y0) {  // every cell of this row that the edge touches
                const double u = a.x + slope * (std::clamp<double>(row, y0, y1) - a.y);
                const double v = a.x + slope * (std::clamp<double>(row + 1.0, y0, y1) - a.y);
                xa = std::max(xa, std::min(u, v) - 1e-9);
                xb = std::min(xb, std::max(u, v) + 1e-9);
            }
            fill(row, xa, xb);
            const double middle = row + 0.5;
            if ((a.y <= middle) != (b.y <= middle))
                crossings.emplace_back(row, a.x + slope * (middle - a.y));
        }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)  // an even number in every row
        fill(crossings[i].first, crossings[i].second, crossings[i + 1].second);
    for (std::uint32_t row = 0; row < mask.height; ++row) {
        const std::span line(bits.data() + row * words, words);
        for (std::size_t i = next_bit(line, 0, 0); i < 64 * words;) {
            const std::size_t end = next_bit(line, i, ~std::uint64_t{0});
            mask.runs.push_back({row, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(end - 1)});
            i = next_bit(line, end, 0);
        }
    }
    // The widest runs of sparse rows first: most places are ruled out by the first few tests.
    const auto stride = [&](const Run& r) {
        return std::min(std::countr_zero(r.row | 1u << 31), 4);
    };
    std::stable_sort(mask.runs.begin(), mask.runs.end(), [&](const Run& a, const Run& b) {
        if (stride(a) != stride(b)) return stride(a) > stride(b);
        return a.last - a.first > b.last - b.first;
    });
    mask.hash = hash_bytes(mask.runs.data(), mask.runs.size() * sizeof(Run));
    return mask;
}

}  // namespace tuft::atlas
