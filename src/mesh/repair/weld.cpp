#include "mesh/repair/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/random.h"

namespace tuft::mesh {
namespace {

/// Open-addressed table of indices; the keys stay with the caller.
class IndexTable {
  public:
    explicit IndexTable(std::size_t n)
        : mask_(std::bit_ceil(std::max<std::size_t>(2 * n, 16)) - 1), slots_(mask_ + 1, kNone) {}

    std::size_t slot(std::uint64_t hash) const { return hash & mask_; }
    void prefetch(std::size_t slot) const { __builtin_prefetch(&slots_[slot]); }
    std::uint32_t at(std::size_t slot) const { return slots_[slot]; }
    std::size_t next(std::size_t slot) const { return (slot + 1) & mask_; }
    void put(std::size_t slot, std::uint32_t index) { slots_[slot] = index; }

  private:
    std::size_t mask_;
    std::vector<std::uint32_t> slots_;
};

std::uint64_t hash_point(const Vec3f& p) {
    // Adding zero makes -0 and 0 the same bits.
    const auto bits = [](float f) { return std::uint64_t{std::bit_cast<std::uint32_t>(f + 0.0f)}; };
    return hash_bits(bits(p.x) | bits(p.y) << 32, bits(p.z));
}

using Cell = std::array<std::int64_t, 3>;

std::uint64_t hash_cell(const Cell& c) {
    return hash_bits(static_cast<std::uint64_t>(c[0]) ^ std::rotl(static_cast<std::uint64_t>(c[1]), 32),
                     static_cast<std::uint64_t>(c[2]));
}

}  // namespace

std::vector<std::uint32_t> weld_exact(std::span<const Vec3f> points) {
    constexpr std::size_t kBlock = 32;  // enough loads in flight to hide the table's cache misses
    std::vector<std::uint32_t> target(points.size());
    IndexTable table(points.size());
    std::array<std::size_t, kBlock> slots;
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
        const std::size_t end = std::min(begin + kBlock, points.size());
        for (std::size_t i = begin; i < end; ++i) {
            slots[i - begin] = table.slot(hash_point(points[i]));
            table.prefetch(slots[i - begin]);
        }
        for (std::size_t i = begin; i < end; ++i) {
            std::size_t s = slots[i - begin];
            while (table.at(s) != kNone && points[table.at(s)] != points[i]) s = table.next(s);
            if (table.at(s) == kNone) table.put(s, static_cast<std::uint32_t>(i));
            target[i] = table.at(s);
        }
    }
    return target;
}

void weld_short_edges(std::span<const Vec3f> points, std::span<const std::uint32_t> corners,
                      std::span<const std::uint32_t> polygon_start, double shortest,
                      std::vector<std::uint32_t>& target) {
    const auto root = [&](std::uint32_t v) {
        while (target[v] != v) v = target[v] = target[target[v]];
        return v;
    };
    for (std::size_t p = 0; p + 1 < polygon_start.size(); ++p)
        for (std::uint32_t c = polygon_start[p], last = polygon_start[p + 1]; c < last; ++c) {
            const std::uint32_t a = corners[c], b = corners[c + 1 < last ? c + 1 : polygon_start[p]];
            if (a == b || !(glm::length(Vec3(points[a]) - Vec3(points[b])) <= shortest)) continue;
            const std::uint32_t of_a = root(a), of_b = root(b);
            target[std::max(of_a, of_b)] = std::min(of_a, of_b);
        }
    for (std::uint32_t v = 0; v < target.size(); ++v) target[v] = root(v);
}

void weld_near(std::span<const Vec3f> points, std::span<const std::uint32_t> candidates, double tolerance,
               std::vector<std::uint32_t>& target) {
    if (!(tolerance > 0)) return;
    // Cells are as wide as the tolerance reaches, so two neighbours per axis are enough.
    const double width = 2 * tolerance;
    // Beyond this the cell number leaves the integers; such points are left alone.
    constexpr double kMaxCell = 4e18;
    IndexTable table(candidates.size());  // first candidate of each cell
    std::vector<std::uint32_t> next_in_cell(candidates.size(), kNone);
    std::vector<Cell> cells(candidates.size());
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        const Vec3 p(points[candidates[c]]);
        Cell home{};
        std::array<int, 3> side{};
        bool fits = true;
        for (int k = 0; k < 3; ++k) {
            const double x = p[k] / width;
            fits = fits && std::abs(x) < kMaxCell;
            if (!fits) break;
            home[k] = static_cast<std::int64_t>(std::floor(x));
            side[k] = x - std::floor(x) < 0.5 ? -1 : 1;
        }
        if (!fits) continue;
        std::uint32_t best = kNone;
        double best_distance = tolerance;
        for (int corner = 0; corner < 8; ++corner) {
            Cell cell = home;
            for (int k = 0; k < 3; ++k)
                if (corner >> k & 1) cell[k] += side[k];
            std::size_t s = table.slot(hash_cell(cell));
            while (table.at(s) != kNone && cells[table.at(s)] != cell) s = table.next(s);
            for (std::uint32_t other = table.at(s); other != kNone; other = next_in_cell[other]) {
                const double d = glm::length(Vec3(points[candidates[other]]) - p);
                if (d < best_distance || (d == best_distance && other < best)) {
                    best = other;
                    best_distance = d;
                }
            }
        }
        if (best != kNone) {
            target[candidates[c]] = candidates[best];
            continue;
        }
        cells[c] = home;
        std::size_t s = table.slot(hash_cell(home));
        while (table.at(s) != kNone && cells[table.at(s)] != home) s = table.next(s);
        // A chain per cell, newest last in age but first in the chain.
        next_in_cell[c] = table.at(s);
        table.put(s, static_cast<std::uint32_t>(c));
    }
}

}  // namespace tuft::mesh
