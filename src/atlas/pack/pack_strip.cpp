#include "atlas/pack/pack_strip.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "core/simd.h"

namespace tuft::atlas {
namespace {

/// Words all of whose cells are taken, after each row: runs are tested beyond its end too.
constexpr std::size_t kPadding = 2;
constexpr std::size_t kRoundedUp = 4;  // words that are read beyond those, and count for nothing
constexpr std::size_t kGapTests = 8;   // runs whose rows must have a gap as long, tested first

template <std::size_t n>
using Words = std::array<std::uint64_t, n>;

}  // namespace

std::vector<int> reach_by_row(double gap) {
    std::vector<int> reach;
    for (int dy = 0; std::max(dy - 1, 0) < gap; ++dy) {
        const double left = gap * gap - std::pow(std::max(dy - 1, 0), 2);
        int dx = 0;
        while (dx * dx < left) ++dx;
        reach.push_back(dx);
    }
    if (reach.empty()) reach.push_back(0);
    return reach;
}

Strip::Strip(std::uint32_t width, std::vector<int> reach)
    : width_(width), words_(width / 64 + 1), stride_(words_ + kPadding), reach_(std::move(reach)) {
    while ((1u << (levels_ + 1)) <= width_) ++levels_;
    ++levels_;
    beyond_.assign(stride_, 0);
    for (std::uint32_t x = width_; x < 64 * stride_; ++x) beyond_[x / 64] |= std::uint64_t{1} << (x % 64);
}

void Strip::place(const Mask& mask, const Spot& spot) {
    const int reach_rows = static_cast<int>(reach_.size()) - 1;
    for (const Run& run : mask.runs)
        for (int d = -reach_rows; d <= reach_rows; ++d) {
            const std::int64_t row = std::int64_t{spot.y} + run.row + d;
            if (row < 0) continue;
            const int e = reach_[static_cast<std::size_t>(std::abs(d))];
            const auto y = static_cast<std::uint32_t>(row);
            grow(y + 1);
            take(y, std::int64_t{spot.x} + run.first - e, std::int64_t{spot.x} + run.last + e);
        }
    top_ = std::max(top_, spot.y + mask.height);
}

void Strip::grow(std::uint32_t rows) {
    if (rows <= n_rows_) return;
    if (rows > built_.size()) {
        const std::size_t capacity = std::max<std::size_t>({rows, 3 * built_.size() / 2, width_});
        rows_.resize(capacity * static_cast<std::size_t>(levels_) * stride_ + kRoundedUp);
        built_.resize(capacity);
        gap_.resize(capacity);
    }
    for (; n_rows_ < rows; ++n_rows_) {
        std::copy(beyond_.begin(), beyond_.end(), level(n_rows_, 0));
        built_[n_rows_] = 1;
        gap_[n_rows_] = width_;
    }
}

void Strip::take(std::uint32_t y, std::int64_t first, std::int64_t last) {
    const auto a = static_cast<std::size_t>(std::max<std::int64_t>(first, 0));
    const auto b = static_cast<std::size_t>(std::min<std::int64_t>(last, width_ - 1));
    built_[y] = 1;
    gap_[y] = kNone;
    set_cells(level(y, 0), a, b);
}

void Strip::build_level(std::uint32_t y, int k) {
    for (; built_[y] <= k; ++built_[y]) {
        const std::uint64_t* from = level(y, built_[y] - 1);
        std::uint64_t* to = level(y, built_[y]);
        const std::size_t shift = std::size_t{1} << (built_[y] - 1);
        const std::uint64_t* moved = from + shift / 64;
        const int i = static_cast<int>(shift % 64);
        for (std::size_t w = 0; w < words_; ++w) to[w] = from[w] | moved[w] >> i | moved[w + 1] << 1 << (63 - i);
        for (std::size_t w = words_; w < stride_; ++w) to[w] = ~std::uint64_t{0};
    }
}

void Strip::measure_gap(std::uint32_t y) {
    const std::uint64_t* row = level(y, 0);
    std::uint32_t longest = 0, run = 0;
    for (std::size_t w = 0; w < words_; ++w) {
        std::uint64_t taken = row[w];
        if (taken == 0) {
            run += 64;
            continue;
        }
        std::uint32_t left = 64;
        while (taken != 0) {
            const auto free = static_cast<std::uint32_t>(std::countr_zero(taken));
            longest = std::max(longest, run + free);
            run = 0;
            left -= free;
            taken >>= free;
            const auto hit = static_cast<std::uint32_t>(std::countr_one(taken));
            left -= hit;
            taken = hit < 64 ? taken >> hit : 0;
        }
        run = left;
    }
    gap_[y] = std::max(longest, run);
}

template <class Words>
[[gnu::always_inline]] inline bool Strip::block(const Run& run, std::uint32_t y, Words& valid) {
    const std::uint32_t row = y + run.row;
    if (row >= n_rows_) return true;
    const int k = std::bit_width(run.last - run.first + 1) - 1;
    const std::uint64_t* taken = built_level(row, k);
    // Both ends of the run, each of 2^k cells.
    const std::size_t a = run.first, b = run.last + 1 - (std::size_t{1} << k);
    const std::uint64_t* first = taken + a / 64;
    const std::uint64_t* second = taken + b / 64;
    const int i = static_cast<int>(a % 64), j = static_cast<int>(b % 64);
    std::uint64_t any = 0;
    for (std::size_t w = 0; w < valid.size(); ++w) {
        valid[w] &= ~(first[w] >> i | first[w + 1] << 1 << (63 - i) | second[w] >> j | second[w + 1] << 1 << (63 - j));
        any |= valid[w];
    }
    return any != 0;
}

template <class Words>
[[gnu::always_inline]] inline Strip::Spot Strip::find_among(const Mask& mask, std::uint32_t from_row,
                                                            std::uint32_t limit, Words valid) {
    const std::uint32_t places = width_ - mask.width + 1, words = (places + 63) / 64;
    const std::uint64_t last = places % 64 != 0 ? ~std::uint64_t{0} >> (64 - places % 64) : ~std::uint64_t{0};
    const std::span tests(mask.runs.data(), std::min(mask.runs.size(), kGapTests));
    std::size_t killer = 0;
    for (std::uint32_t y = from_row; y + mask.height <= limit; ++y) {
        if (!std::all_of(tests.begin(), tests.end(),
                         [&](const Run& r) { return has_gap(y + r.row, r.last - r.first + 1); }))
            continue;
        std::fill(valid.begin(), valid.end(), ~std::uint64_t{0});
        valid[words - 1] = last;
        std::fill(valid.begin() + words, valid.end(), 0);
        bool any = block(mask.runs[killer], y, valid);
        for (std::size_t r = 0; any && r < mask.runs.size(); ++r) {
            any = block(mask.runs[r], y, valid);
            if (!any) killer = r;
        }
        if (!any) continue;
        for (std::size_t w = 0; w < words; ++w)
            if (valid[w] != 0) return {static_cast<std::uint32_t>(64 * w + std::countr_zero(valid[w])), y};
    }
    return {};
}

TUFT_CLONES Strip::Spot Strip::find(const Mask& mask, std::uint32_t from_row, std::uint32_t limit) {
    if (mask.width > width_) return {};
    const std::uint32_t words = (width_ - mask.width) / 64 + 1;
    // Places of a row of up to 1024 cells stay in registers.
    if (words <= 1) return find_among(mask, from_row, limit, Words<1>{});
    if (words <= 2) return find_among(mask, from_row, limit, Words<2>{});
    if (words <= 4) return find_among(mask, from_row, limit, Words<4>{});
    if (words <= 8) return find_among(mask, from_row, limit, Words<8>{});
    if (words <= 12) return find_among(mask, from_row, limit, Words<12>{});
    if (words <= 16) return find_among(mask, from_row, limit, Words<16>{});
    valid_.resize(words);
    return find_among(mask, from_row, limit, std::span(valid_));
}

}  // namespace tuft::atlas
