#include "atlas/pack/pack_mask.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "atlas/flatten/hull.h"
#include "core/geometry/plane_vectors.h"
#include "core/hash.h"

namespace tuft::atlas {
namespace {

/// The first bit from `i` on that differs from those of `all`, all zeros or all ones; the end where
/// there is none.
std::size_t next_bit(std::span<const std::uint64_t> line, std::size_t i, std::uint64_t all) {
    for (; i < 64 * line.size(); i = (i / 64 + 1) * 64) {
        const std::uint64_t rest = (line[i / 64] ^ all) >> (i % 64);
        if (rest != 0) return i + static_cast<std::size_t>(std::countr_zero(rest));
    }
    return 64 * line.size();
}

/// Cells as bits, row by row.
struct Bits {
    std::uint32_t width = 0, height = 0;
    std::size_t words = 0;  // per row
    std::vector<std::uint64_t> bits;

    Bits(std::uint32_t w, std::uint32_t h) : width(w), height(h), words((w + 63) / 64), bits(words * h, 0) {}

    std::span<std::uint64_t> row(std::uint32_t y) { return {bits.data() + y * words, words}; }
    std::span<const std::uint64_t> row(std::uint32_t y) const { return {bits.data() + y * words, words}; }
};

/// Takes the cells of a row from those of `a` to those of `b`.
void take(Bits& cells, std::uint32_t row, double a, double b) {
    const auto first = static_cast<std::size_t>(std::max(a, 0.0));
    const auto last = std::min<std::size_t>(static_cast<std::size_t>(std::max(b, 0.0)), cells.width - 1);
    set_cells(cells.row(row).data(), first, last);
}

/// All cells that a polygon touches, from the corner of its box on; `p` in cells.
Bits contact_cells(std::span<const Vec2> p, std::uint32_t width, std::uint32_t height) {
    Bits cells(width, height);
    // A bit where the border passes a row's middle: the parity of those before is "inside".
    Bits passed(width + 1, height);
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2 a = p[i], b = p[i + 1 < p.size() ? i + 1 : 0];
        const double y0 = std::min(a.y, b.y), y1 = std::max(a.y, b.y);
        const double slope = y1 > y0 ? (b.x - a.x) / (b.y - a.y) : 0;
        const auto last = std::min(static_cast<std::uint32_t>(y1), height - 1);
        for (auto row = static_cast<std::uint32_t>(y0); row <= last; ++row) {
            double xa = std::min(a.x, b.x), xb = std::max(a.x, b.x);
            if (y1 > y0) {  // every cell of this row that the edge touches
                const double u = a.x + slope * (std::clamp<double>(row, y0, y1) - a.y);
                const double v = a.x + slope * (std::clamp<double>(row + 1.0, y0, y1) - a.y);
                xa = std::max(xa, std::min(u, v) - 1e-9);
                xb = std::min(xb, std::max(u, v) + 1e-9);
            }
            take(cells, row, xa, xb);
            const double middle = row + 0.5;
            if ((a.y <= middle) == (b.y <= middle)) continue;
            const double x = std::clamp<double>(a.x + slope * (middle - a.y), 0, width - 1);
            const auto cell = static_cast<std::uint32_t>(x);  // touched by the edge itself
            passed.row(row)[(cell + 1) / 64] ^= std::uint64_t{1} << ((cell + 1) % 64);
        }
    }
    for (std::uint32_t y = 0; y < height; ++y) {
        std::uint64_t carry = 0;
        for (std::size_t w = 0; w < cells.words; ++w) {
            std::uint64_t parity = passed.row(y)[w];
            for (int k = 1; k < 64; k *= 2) parity ^= parity << k;
            parity ^= carry;
            carry = parity >> 63 ? ~std::uint64_t{0} : 0;
            cells.row(y)[w] |= parity;
        }
        // The last crossing may lie in the last cell; nothing beyond it is inside.
        if (width % 64 != 0) cells.row(y).back() &= ~std::uint64_t{0} >> (64 - width % 64);
    }
    return cells;
}

/// Rows become columns.
Bits transposed(const Bits& cells) {
    Bits out(cells.height, cells.width);
    std::uint64_t block[64];
    for (std::uint32_t y0 = 0; y0 < cells.height; y0 += 64)
        for (std::size_t w = 0; w < cells.words; ++w) {
            const std::uint32_t rows = std::min(64u, cells.height - y0);
            std::uint64_t any = 0;
            for (std::uint32_t i = 0; i < 64; ++i) any |= block[i] = i < rows ? cells.row(y0 + i)[w] : 0;
            if (any == 0) continue;
            std::uint64_t low = 0xffffffffull;  // H. S. Warren, Hacker's Delight, 7-3
            for (int j = 32; j != 0; j /= 2, low ^= low << j)
                for (int i = 0; i < 64; i = ((i | j) + 1) & ~j) {
                    const std::uint64_t t = ((block[i] >> j) ^ block[i | j]) & low;
                    block[i] ^= t << j;
                    block[i | j] ^= t;
                }
            const auto x0 = static_cast<std::uint32_t>(64 * w);
            for (std::uint32_t i = 0; i < 64 && x0 + i < cells.width; ++i) out.row(x0 + i)[y0 / 64] = block[i];
        }
    return out;
}

std::vector<Run> runs_of(const Bits& cells) {
    std::vector<Run> runs;
    runs.reserve(2 * std::size_t{cells.height});
    for (std::uint32_t y = 0; y < cells.height; ++y) {
        const std::span line = cells.row(y);
        for (std::size_t i = next_bit(line, 0, 0); i < 64 * cells.words;) {
            const std::size_t end = next_bit(line, i, ~std::uint64_t{0});
            runs.push_back({y, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(end - 1)});
            i = next_bit(line, end, 0);
        }
    }
    return runs;
}

/// Runs of sparse rows first, the widest of the sparsest before all: most places are ruled
/// out by the first few tests.
std::vector<Run> in_order_of_tests(const std::vector<Run>& rows) {
    std::vector<Run> runs;
    runs.reserve(rows.size());
    for (int stride = 4; stride >= 0; --stride) {
        const std::size_t from = runs.size();
        for (const Run& r : rows)
            if (std::min(std::countr_zero(r.row | 1u << 31), 4) == stride) runs.push_back(r);
        if (stride >= 3)
            std::stable_sort(runs.begin() + static_cast<std::ptrdiff_t>(from), runs.end(),
                             [](const Run& a, const Run& b) { return a.last - a.first > b.last - b.first; });
    }
    return runs;
}

/// The same cells turned by half a circle.
std::vector<Run> turned_round(const std::vector<Run>& rows, std::uint32_t width, std::uint32_t height) {
    std::vector<Run> turned;
    turned.reserve(rows.size());
    for (auto r = rows.rbegin(); r != rows.rend(); ++r)
        turned.push_back({height - 1 - r->row, width - 1 - r->last, width - 1 - r->first});
    return turned;
}

Mask finished(const std::vector<Run>& rows, std::uint32_t width, std::uint32_t height) {
    Mask mask;
    mask.width = width;
    mask.height = height;
    mask.runs = in_order_of_tests(rows);
    double cells = 0;
    for (const Run& r : rows) {
        const double n = r.last - r.first + 1.0;
        cells += n;
        mask.middle += n * (r.row + 0.5);
    }
    mask.middle /= cells;
    mask.hash = hash_bytes(mask.runs.data(), mask.runs.size() * sizeof(Run));
    return mask;
}

}  // namespace

Shape make_shape(const std::vector<Vec2>& border) {
    Shape shape;
    shape.border = &border;
    for (std::size_t i = 0; i < border.size(); ++i)
        shape.area += 0.5 * cross(border[i] - border[0], border[(i + 1) % border.size()] - border[0]);
    const Rectangle box = smallest_rectangle(convex_hull(border));
    shape.extent = box.length;
    shape.angle = -std::atan2(box.s, box.c);
    return shape;
}

std::vector<Mask> make_masks(const Shape& shape, double scale, double angle, double cell, bool all) {
    const double c = std::cos(angle), s = std::sin(angle);
    std::vector<Vec2> p(shape.border->size());
    Vec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2& q = (*shape.border)[i];
        p[i] = scale * Vec2(c * q.x - s * q.y, s * q.x + c * q.y);
        lo = glm::min(lo, p[i]);
        hi = glm::max(hi, p[i]);
    }
    for (Vec2& q : p) q = (q - lo) / cell;
    const Vec2 side = (hi - lo) / cell;
    const auto width = static_cast<std::uint32_t>(side.x) + 1;
    const auto height = static_cast<std::uint32_t>(side.y) + 1;
    const Bits cells = contact_cells(p, width, height);
    const std::vector<Run> rows = runs_of(cells);
    std::vector<Mask> masks;
    masks.push_back(finished(rows, width, height));
    masks[0].c = c;
    masks[0].s = s;
    masks[0].corner = lo;
    if (!all) return masks;
    // A quarter turn takes (x, y) to (−y, x); the box of cells is turned with the chart.
    const Bits across = transposed(cells);
    std::vector<Run> mirrored = runs_of(across);
    std::vector<Run> quarter, three;
    for (const Run& r : mirrored) quarter.push_back({r.row, height - 1 - r.last, height - 1 - r.first});
    for (auto r = mirrored.rbegin(); r != mirrored.rend(); ++r)
        three.push_back({width - 1 - r->row, r->first, r->last});
    masks.push_back(finished(quarter, height, width));
    masks.push_back(finished(turned_round(rows, width, height), width, height));
    masks.push_back(finished(three, height, width));
    const Vec2 far = lo + cell * Vec2(width, height);  // the upper right corner of the cells
    const Vec2 corner[4] = {lo, {-far.y, lo.x}, -far, {lo.y, -far.x}};
    const double cosine[4] = {c, -s, -c, s}, sine[4] = {s, c, -s, -c};
    for (std::size_t k = 1; k < 4; ++k) {
        masks[k].c = cosine[k];
        masks[k].s = sine[k];
        masks[k].corner = corner[k];
    }
    return masks;
}

}  // namespace tuft::atlas
