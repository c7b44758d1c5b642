#include "atlas/pack_strip.h"

#include <algorithm>
#include <bit>

namespace tuft::atlas {
namespace {

/// Word w of a row moved `shift` places to the left; beyond its end all is taken.
std::uint64_t shifted(const std::uint64_t* row, std::size_t words, std::size_t w,
                      std::size_t shift) {
    const std::size_t i = w + shift / 64;
    const std::size_t bit = shift % 64;
    const std::uint64_t lo = i < words ? row[i] : ~std::uint64_t{0};
    if (bit == 0) return lo;
    const std::uint64_t hi = i + 1 < words ? row[i + 1] : ~std::uint64_t{0};
    return lo >> bit | hi << (64 - bit);
}

}  // namespace

Strip::Strip(std::uint32_t width, std::vector<int> reach)
    : width_(width), words_(width / 64 + 1), reach_(std::move(reach)) {
    while ((1u << (levels_ + 1)) <= width_) ++levels_;
    ++levels_;
}

Strip::Spot Strip::find(const Mask& mask, std::uint32_t from_row, std::uint32_t limit) const {
    Spot spot;
    if (mask.width > width_) return spot;
    const std::uint32_t places = width_ - mask.width + 1;
    std::vector<std::uint64_t> valid((places + 63) / 64);
    std::size_t killer = 0;
    for (std::uint32_t y = from_row; y + mask.height <= limit; ++y) {
        std::fill(valid.begin(), valid.end(), ~std::uint64_t{0});
        if (places % 64 != 0) valid.back() = ~std::uint64_t{0} >> (64 - places % 64);
        bool any = block(mask.runs[killer], y, valid);
        for (std::size_t r = 0; any && r < mask.runs.size(); ++r) {
            any = block(mask.runs[r], y, valid);
            if (!any) killer = r;
        }
        if (!any) continue;
        for (std::size_t w = 0; w < valid.size(); ++w)
            if (valid[w] != 0) {
                spot = {static_cast<std::uint32_t>(64 * w + std::countr_zero(valid[w])), y};
                return spot;
            }
    }
    return spot;
}

void Strip::place(const Mask& mask, const Spot& spot) {
    const int reach_rows = static_cast<int>(reach_.size()) - 1;
    std::uint32_t low = kNone, high = 0;
    for (const Run& run : mask.runs)
        for (int d = -reach_rows; d <= reach_rows; ++d) {
            const std::int64_t row = std::int64_t{spot.y} + run.row + d;
            if (row < 0) continue;
            const int e = reach_[static_cast<std::size_t>(std::abs(d))];
            const auto y = static_cast<std::uint32_t>(row);
            grow(y + 1);
            take(y, std::int64_t{spot.x} + run.first - e, std::int64_t{spot.x} + run.last + e);
            low = std::min(low, y);
            high = std::max(high, y);
        }
    for (std::uint32_t y = low; y <= high && low != kNone; ++y) rebuild(y);
    top_ = std::max(top_, spot.y + mask.height);
}

void Strip::grow(std::uint32_t rows) {
    if (rows <= n_rows_) return;
    rows_.resize(std::size_t{rows} * static_cast<std::size_t>(levels_) * words_, 0);
    for (; n_rows_ < rows; ++n_rows_)  // cells beyond the right edge are taken
        for (int k = 0; k < levels_; ++k)
            for (std::uint32_t x = width_; x < 64 * words_; ++x)
                level(n_rows_, k)[x / 64] |= std::uint64_t{1} << (x % 64);
}

void Strip::take(std::uint32_t y, std::int64_t first, std::int64_t last) {
    const auto a = static_cast<std::size_t>(std::max<std::int64_t>(first, 0));
    const auto b = static_cast<std::size_t>(std::min<std::int64_t>(last, width_ - 1));
    std::uint64_t* row = level(y, 0);
    for (std::size_t w = a / 64; w <= b / 64; ++w) {
        std::uint64_t m = ~std::uint64_t{0};
        if (w == a / 64) m &= ~std::uint64_t{0} << (a % 64);
        if (w == b / 64) m &= ~std::uint64_t{0} >> (63 - b % 64);
        row[w] |= m;
    }
}

void Strip::rebuild(std::uint32_t y) {
    for (int k = 1; k < levels_; ++k) {
        const std::uint64_t* from = level(y, k - 1);
        std::uint64_t* to = level(y, k);
        for (std::size_t w = 0; w < words_; ++w)
            to[w] = from[w] | shifted(from, words_, w, std::size_t{1} << (k - 1));
    }
}

/// Clears the places where the run hits something; false when none is left.
bool Strip::block(const Run& run, std::uint32_t y, std::vector<std::uint64_t>& valid) const {
    const std::uint32_t row = y + run.row;
    if (row >= n_rows_) return true;
    const std::uint32_t length = run.last - run.first + 1;
    const int k = std::bit_width(length) - 1;
    const std::uint64_t* taken = level(row, k);
    const std::size_t a = run.first, b = run.last + 1 - (std::size_t{1} << k);
    std::uint64_t any = 0;
    for (std::size_t w = 0; w < valid.size(); ++w) {
        if (valid[w] == 0) continue;
        valid[w] &= ~(shifted(taken, words_, w, a) | shifted(taken, words_, w, b));
        any |= valid[w];
    }
    return any != 0;
}

}  // namespace tuft::atlas
