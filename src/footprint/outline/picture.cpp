#include "footprint/outline/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "core/simd.h"
#include "footprint/outline/isa.h"

namespace tuft::footprint {
namespace {

/// Bits that all, and bits that any of four rows have set, column by column.
TUFT_CLONES void column_bits(const std::array<const std::uint8_t*, 4>& rows, int n, std::uint8_t* __restrict all,
                             std::uint8_t* __restrict any) {
    const std::uint8_t* __restrict row0 = rows[0], * __restrict row1 = rows[1];
    const std::uint8_t* __restrict row2 = rows[2], * __restrict row3 = rows[3];
#pragma omp simd
    for (int i = 0; i < n; ++i) {
        all[i] = row0[i] & row1[i] & row2[i] & row3[i];
        any[i] = row0[i] | row1[i] | row2[i] | row3[i];
    }
}

constexpr int kSquare = 16;  // cells along the side of a square that is transposed at once

/// Sixteen rows of sixteen cells become columns: rows k and k + 8 are interleaved four times.
void transpose_square(const std::uint8_t* in, std::ptrdiff_t next_in, std::uint8_t* out, std::ptrdiff_t next_out) {
    using Cells [[gnu::vector_size(kSquare)]] = std::uint8_t;
    Cells a[kSquare], b[kSquare];
    for (int k = 0; k < kSquare; ++k) std::memcpy(&a[k], in + k * next_in, sizeof a[k]);
    const auto interleave = [](const Cells* from, Cells* to) {
        for (int k = 0; k < kSquare / 2; ++k) {
            const Cells &p = from[k], &q = from[k + kSquare / 2];
            to[2 * k] = __builtin_shufflevector(p, q, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
            to[2 * k + 1] = __builtin_shufflevector(p, q, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
        }
    };
    interleave(a, b), interleave(b, a), interleave(a, b), interleave(b, a);
    for (int k = 0; k < kSquare; ++k) std::memcpy(out + k * next_out, &a[k], sizeof a[k]);
}

constexpr int kLanes = 16;

/// The picture as the loops see it.
struct Blocks {
    const std::uint32_t* to_left;
    int width, height, cells_x, cells_y;
};

/// Adds up, row by row of blocks, what the discs meet. Cell centres are whole numbers: block k
/// reaches from 4 k − ½ to 4 k + 3½.
[[gnu::always_inline]] inline void count_blocks(const Blocks& blocks, const float* __restrict x,
                                                const float* __restrict y, const float* __restrict r,
                                                std::uint32_t* __restrict found, std::size_t n) {
    constexpr float kBlock = BlockTally::kBlock, kPart = 1 / kBlock;
    const auto width = static_cast<float>(blocks.width), height = static_cast<float>(blocks.height);
    const auto last_x = static_cast<float>(blocks.cells_x - 1), last_y = static_cast<float>(blocks.cells_y - 1);
    const std::uint32_t* __restrict to_left = blocks.to_left;
    const int stride = blocks.width + 1, last_row = blocks.height - 1;
    for (std::size_t i = 0; i < n; i += kLanes) {
        const float *cx = x + i, *cy = y + i, *cr = r + i;
        alignas(64) int first[kLanes], end[kLanes];
        alignas(64) std::uint32_t met[kLanes];
        int rows = 0;
#pragma omp simd reduction(max : rows)
        for (int k = 0; k < kLanes; ++k) {
            const float low = (cy[k] - cr[k] + 0.5f) * kPart, high = (cy[k] + cr[k] + 0.5f) * kPart + 1;
            const float from = low > 0.0f ? low : 0.0f, to = high > 0.0f ? high : 0.0f;
            first[k] = static_cast<int>(from < height ? from : height);
            end[k] = static_cast<int>(to < height ? to : height);
            const bool inside =
                (cx[k] - cr[k] >= 0) & (cy[k] - cr[k] >= 0) & (cx[k] + cr[k] <= last_x) & (cy[k] + cr[k] <= last_y);
            met[k] = inside ? 0u : 1u;
            const int span = end[k] - first[k];
            rows = span > rows ? span : rows;
        }
        for (int row = 0; row < rows; ++row) {
#pragma omp simd
            for (int k = 0; k < kLanes; ++k) {
                const int at = first[k] + row, line = at < last_row ? at : last_row;
                const float top = static_cast<float>(line) * kBlock - 0.5f;
                const float below = top - cy[k], above = cy[k] - top - kBlock;
                const float off = below > above ? below : above, dy = off > 0.0f ? off : 0.0f;
                const float left = cr[k] * cr[k] - dy * dy;
                const float half = __builtin_sqrtf(left > 0.0f ? left : 0.0f);
                const float low = (cx[k] - half + 0.5f) * kPart, high = (cx[k] + half + 0.5f) * kPart + 1;
                const float from = low > 0.0f ? low : 0.0f, to = high > 0.0f ? high : 0.0f;
                const int a = line * stride + static_cast<int>(from < width ? from : width);
                const int b = line * stride + static_cast<int>(to < width ? to : width);
                const std::uint32_t mask = at < end[k] ? ~0u : 0u;
                met[k] |= (to_left[b] - to_left[a]) & mask;
            }
        }
        for (int k = 0; k < kLanes; ++k) found[i + k] = met[k];
    }
}

using Count = void (*)(const Blocks&, const float*, const float*, const float*, std::uint32_t*, std::size_t);

void count_baseline(const Blocks& b, const float* x, const float* y, const float* r, std::uint32_t* found,
                    std::size_t n) {
    count_blocks(b, x, y, r, found, n);
}

#ifdef TUFT_X86
[[gnu::target(TUFT_AVX2)]] void count_avx2(const Blocks& b, const float* x, const float* y, const float* r,
                                           std::uint32_t* found, std::size_t n) {
    count_blocks(b, x, y, r, found, n);
}

[[gnu::target(TUFT_AVX512)]] void count_avx512(const Blocks& b, const float* x, const float* y, const float* r,
                                               std::uint32_t* found, std::size_t n) {
    count_blocks(b, x, y, r, found, n);
}
#endif

Count counter(Isa isa) {
#ifdef TUFT_X86
    if (isa == Isa::avx512) return count_avx512;
    if (isa == Isa::avx2) return count_avx2;
#endif
    (void)isa;
    return count_baseline;
}

}  // namespace

void Discs::reserve_one() {
    const std::size_t n = std::max<std::size_t>(64, 2 * x_.size());
    for (std::vector<float>* v : {&x_, &y_, &r_}) v->resize(n);
    found_.resize(n);
}

Cover Discs::cover(std::size_t i) const {
    return (found_[i] >> 16) == 0 ? Cover::empty : (found_[i] & 0xffff) == 0 ? Cover::full : Cover::mixed;
}

void transpose(std::span<const std::uint8_t> cells, int width, int height, Recycled<std::uint8_t>& turned) {
    turned.resize(static_cast<std::size_t>(width) * height);
    const auto in = [&](int x, int y) { return cells.data() + static_cast<std::ptrdiff_t>(y) * width + x; };
    const auto out = [&](int x, int y) { return turned.data() + static_cast<std::ptrdiff_t>(x) * height + y; };
    if (width < kSquare || height < kSquare) {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) *out(x, y) = *in(x, y);
        return;
    }
    // The last squares of a row and of a column of them overlap those before.
    for (int row = 0; row < height; row += kSquare)
        for (int column = 0; column < width; column += kSquare) {
            const int x = std::min(column, width - kSquare), y = std::min(row, height - kSquare);
            transpose_square(in(x, y), width, out(x, y), height);
        }
}

void BlockTally::count(const Footprint& footprint) {
    cells_x_ = footprint.width;
    cells_y_ = footprint.height;
    width_ = (cells_x_ + kBlock - 1) / kBlock;
    height_ = (cells_y_ + kBlock - 1) / kBlock;
    to_left_.resize(static_cast<std::size_t>(width_ + 1) * height_);
    static_assert(kBlock == sizeof(std::uint32_t));
    all_.resize(width_);
    any_.resize(width_);
    for (int j = 0; j < height_; ++j) {
        all_.back() = ~0u;  // beyond the last cell
        any_.back() = 0;
        // Beyond the last row: that one again.
        const auto row = [&](int k) {
            return footprint.coverage.data() + std::size_t(std::min(j * kBlock + k, cells_y_ - 1)) * cells_x_;
        };
        column_bits({row(0), row(1), row(2), row(3)}, cells_x_, reinterpret_cast<std::uint8_t*>(all_.data()),
                    reinterpret_cast<std::uint8_t*>(any_.data()));
        std::uint32_t* left = to_left_.data() + std::size_t(j) * (width_ + 1);
        left[0] = 0;
        for (int i = 0; i < width_; ++i)
            left[i + 1] = left[i] + (all_[i] != ~0u ? 1u : 0u) + (any_[i] != 0 ? 1u << 16 : 0u);
    }
}

void BlockTally::find_coverage(Discs& discs, Isa isa) const {
    const std::size_t n = (discs.n_ + kLanes - 1) / kLanes * kLanes;
    for (std::size_t i = discs.n_; i < n; ++i) discs.x_[i] = discs.y_[i] = discs.r_[i] = 0;
    counter(std::min(isa, best_isa()))({to_left_.data(), width_, height_, cells_x_, cells_y_}, discs.x_.data(),
                                       discs.y_.data(), discs.r_.data(), discs.found_.data(), n);
}

}  // namespace tuft::footprint
