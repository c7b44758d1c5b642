#include "footprint/picture.h"

#include <algorithm>
#include <cmath>

// As in ink/simd.h: all versions give the same bits, these loops hold integers only.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TUFT_CLONES __attribute__((target_clones("default", "arch=x86-64-v3")))
#else
#define TUFT_CLONES
#endif

namespace tuft::footprint {
namespace {

TUFT_CLONES void pack_rows(const std::uint8_t* __restrict low, const std::uint8_t* __restrict high,
                           std::uint16_t* __restrict out, std::size_t n) {
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i)
        out[i] = static_cast<std::uint16_t>(low[i] | high[i] << 8);
}

/// Bits that all, and bits that any of the rows have set, column by column.
TUFT_CLONES void column_bits(const std::uint8_t* from, int stride, int rows, int n,
                             std::uint8_t* __restrict all, std::uint8_t* __restrict any) {
    for (int i = 0; i < n; ++i) all[i] = any[i] = from[i];
    for (int r = 1; r < rows; ++r) {
        const std::uint8_t* __restrict row = from + static_cast<std::size_t>(r) * stride;
#pragma omp simd
        for (int i = 0; i < n; ++i) {
            all[i] = all[i] & row[i];
            any[i] = any[i] | row[i];
        }
    }
}

}  // namespace

void pack_picture(const Footprint& footprint, std::vector<std::uint16_t>& pairs) {
    const auto row = static_cast<std::size_t>(footprint.width);
    pairs.resize(row * (footprint.height - 1));
    pack_rows(footprint.coverage.data(), footprint.coverage.data() + row, pairs.data(), pairs.size());
}

void BlockTally::count(const Footprint& footprint) {
    cells_x_ = footprint.width;
    cells_y_ = footprint.height;
    width_ = (cells_x_ + kBlock - 1) / kBlock;
    height_ = (cells_y_ + kBlock - 1) / kBlock;
    not_full_.resize(static_cast<std::size_t>(width_ + 1) * height_);
    not_empty_.resize(not_full_.size());
    static_assert(kBlock == sizeof(std::uint32_t));
    all_.resize(width_);
    any_.resize(width_);
    for (int j = 0; j < height_; ++j) {
        const int rows = std::min(kBlock, cells_y_ - j * kBlock);
        all_.back() = ~0u;  // beyond the last cell
        any_.back() = 0;
        column_bits(footprint.coverage.data() + std::size_t(j) * kBlock * cells_x_, cells_x_, rows,
                    cells_x_, reinterpret_cast<std::uint8_t*>(all_.data()),
                    reinterpret_cast<std::uint8_t*>(any_.data()));
        std::uint16_t* full = not_full_.data() + std::size_t(j) * (width_ + 1);
        std::uint16_t* empty = not_empty_.data() + std::size_t(j) * (width_ + 1);
        std::uint16_t f = 0, e = 0;
        full[0] = empty[0] = 0;
        for (int i = 0; i < width_; ++i) {
            f = static_cast<std::uint16_t>(f + (all_[i] != ~0u));
            e = static_cast<std::uint16_t>(e + (any_[i] != 0));
            full[i + 1] = f;
            empty[i + 1] = e;
        }
    }
}

Cover BlockTally::look(const Vec2f& c, float r) const {
    constexpr float kFar = 1e5f;  // cells
    if (!(r < kFar && std::abs(c.x) < kFar && std::abs(c.y) < kFar)) return Cover::mixed;
    // Rounds down; std::floor would be a call.
    const auto block = [](float cell) {
        constexpr int kShift = 1 << 18;
        return static_cast<int>((cell + 0.5f) * (1.0f / kBlock) + kShift) - kShift;
    };
    bool full = c.x - r >= 0 && c.y - r >= 0 && c.x + r <= float(cells_x_ - 1) &&
                c.y + r <= float(cells_y_ - 1);
    bool empty = true;
    const int first = std::max(block(c.y - r), 0), last = std::min(block(c.y + r), height_ - 1);
    for (int j = first; j <= last && (full || empty); ++j) {
        const float y0 = float(j * kBlock) - 0.5f, y1 = y0 + kBlock;
        const float dy = std::max({y0 - c.y, c.y - y1, 0.0f});
        const float half = std::sqrt(std::max(r * r - dy * dy, 0.0f));
        const int a = std::clamp(block(c.x - half), 0, width_);
        const int b = std::clamp(block(c.x + half) + 1, 0, width_);
        const std::size_t row = std::size_t(j) * (width_ + 1);
        full = full && not_full_[row + b] == not_full_[row + a];
        empty = empty && not_empty_[row + b] == not_empty_[row + a];
    }
    return empty ? Cover::empty : full ? Cover::full : Cover::mixed;
}

}  // namespace tuft::footprint
