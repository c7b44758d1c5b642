#include "footprint/stamp/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "core/simd.h"

namespace tuft::footprint {
namespace {

/// Values of a line of the sheared picture that are worked on at a time: all lines of so many stay
/// in the nearer cache, whatever the picture's size, and loops over them have no remainder.
constexpr int kStrip = 64;

/// Cells of a line from the first to the last that is not 0.
struct Content {
    int first = 0, end = 0;
};

Content content_of(std::span<const std::uint8_t> line) {
    constexpr std::size_t kAtOnce = sizeof(std::uint64_t);
    const auto empty_at = [&](std::size_t i) {
        std::uint64_t word;
        std::memcpy(&word, line.data() + i, kAtOnce);
        return word == 0;
    };
    std::size_t first = 0, end = line.size();
    while (first + kAtOnce <= end && empty_at(first)) first += kAtOnce;
    while (first < end && line[first] == 0) ++first;
    while (first + kAtOnce <= end && empty_at(end - kAtOnce)) end -= kAtOnce;
    while (first < end && line[end - 1] == 0) --end;
    return {static_cast<int>(first), static_cast<int>(end)};
}

/// out = low + f (high − low): `n` lines of cells each seen f of a cell further.
TUFT_CLONES void blend(const std::uint8_t* const* lines, const float* __restrict f, float* __restrict out, int n) {
    for (int i = 0; i < n; ++i, out += kStrip) {
        const std::uint8_t* __restrict cells = lines[i];
        const float part = f[i];
#pragma omp simd
        for (int j = 0; j < kStrip; ++j) {
            const auto low = static_cast<float>(int{cells[j]}), high = static_cast<float>(int{cells[j + 1]});
            out[j] = low + part * (high - low);
        }
    }
}

/// sum_out = sum_in + (before + now) / 2: the integral of values linear between two of the `n + 1` lines.
TUFT_CLONES void integrate_lines(const float* __restrict lines, float* __restrict sums, int n) {
    for (int i = 0; i < n; ++i, lines += kStrip, sums += kStrip) {
#pragma omp simd
        for (int j = 0; j < kStrip; ++j) sums[j + kStrip] = sums[j] + 0.5f * (lines[j] + lines[j + kStrip]);
    }
}

/// Data of the integral up to a fraction t between a line and the next; `integral`: up to the line.
struct LineIntegral {
    const float *integral, *line, *next;
    float t;
};

/// out = (upper − lower) scale, rounded.
TUFT_CLONES void difference(const LineIntegral& to, const LineIntegral& from, float scale,
                            std::uint8_t* __restrict out) {
    const float t = to.t, s = from.t;
    const float *ti = to.integral, *ta = to.line, *tb = to.next;
    const float *si = from.integral, *sa = from.line, *sb = from.next;
#pragma omp simd
    for (int j = 0; j < kStrip; ++j) {
        const float high = ti[j] + t * (ta[j] + 0.5f * t * (tb[j] - ta[j]));
        const float low = si[j] + s * (sa[j] + 0.5f * s * (sb[j] - sa[j]));
        const float e = (high - low) * scale + 0.5f;
        out[j] = static_cast<std::uint8_t>(static_cast<int>(e < 255.0f ? e : 255.0f));
    }
}

/// out = the larger one of `in` here and `ahead` values on; both may be the same.
TUFT_CLONES void max_ahead(const float* in, std::size_t ahead, float* out, std::size_t n) {
#pragma omp simd
    for (std::size_t j = 0; j < n; ++j) out[j] = in[j] > in[j + ahead] ? in[j] : in[j + ahead];
}

/// out = the maximum of `most` at two lines and of the values between two pairs of lines, line for line.
TUFT_CLONES void max_over_motion(const float* __restrict lines, const float* __restrict most,
                                 const SweepScratch::SweptLines* swept_lines, int n, float* __restrict out) {
    for (int k = 0; k < n; ++k, out += kStrip) {
        const SweepScratch::SweptLines& p = swept_lines[k];
        const float s = p.after_back, t = p.after_on;
        const float *pa = lines + p.back, *pb = pa + kStrip, *qa = lines + p.on, *qb = qa + kStrip;
        const float *c = most + p.first, *d = most + p.last;
#pragma omp simd
        for (int j = 0; j < kStrip; ++j) {
            const float low = pa[j] + s * (pb[j] - pa[j]), high = qa[j] + t * (qb[j] - qa[j]);
            const float ends = low > high ? low : high, inner = c[j] > d[j] ? c[j] : d[j];
            out[j] = ends > inner ? ends : inner;
        }
    }
}

/// out = (value before + 2 value + value after) / 4 along each of `lines`, rounded: the mean over
/// two cells, a texel, wherever between the cells it is read. The last two of a line are of no use.
/// `in` has two values more.
TUFT_CLONES void soften(const float* __restrict in, int lines, std::uint8_t* __restrict out, std::size_t stride) {
    for (int k = 0; k < lines; ++k, in += kStrip, out += stride)
#pragma omp simd
        for (int j = 0; j < kStrip; ++j)
            out[j] = static_cast<std::uint8_t>(static_cast<int>(0.25f * (in[j] + 2 * in[j + 1] + in[j + 2]) + 0.5f));
}

/// The picture in lines across the motion, columns of it or rows, sheared so that the motion leads
/// from line to line: value j of line i lies `first` + j + `slope` i cells along the line.
struct Sheared {
    bool along_x = true;
    double length = 0, slope = 0;  // cells; of the motion, and shear from line to line
    int n_lines = 0, n_cells = 0, first = 0, across = 0;
    const std::uint8_t* cells = nullptr;  // [n_lines n_cells]
    Recycled<int> first_cell;             // by line: the cell that its first value lies in

    Sheared(const Footprint& footprint, const Vec2& shift, SweepScratch& scratch) {
        const Vec2 w = shift / footprint.cell;
        along_x = std::abs(w.x) >= std::abs(w.y);
        length = along_x ? w.x : w.y;
        slope = (along_x ? w.y : w.x) / length;
        n_lines = along_x ? footprint.width : footprint.height;
        n_cells = along_x ? footprint.height : footprint.width;
        const double shear = slope * (n_lines - 1);
        first = static_cast<int>(std::floor(-std::max(shear, 0.0)));
        across = static_cast<int>(std::ceil(n_cells - 1 - std::min(shear, 0.0))) - first + 1;
        if (along_x) transpose(footprint.coverage, footprint.width, footprint.height, scratch.transposed);
        cells = along_x ? scratch.transposed.data() : footprint.coverage.data();
        first_cell.reserve(static_cast<std::size_t>(n_lines));
        scratch.parts.resize(static_cast<std::size_t>(n_lines));
        for (int i = 0; i < n_lines; ++i) {
            const double begin = first + slope * i;
            first_cell.push_back(static_cast<int>(std::floor(begin)));
            scratch.parts[i] = static_cast<float>(begin - first_cell.back());
        }
    }

    /// Finds the cells that values [from, from + kStrip) of all lines lie between; outside the picture they are 0.
    void find_strip(int from, SweepScratch& scratch) const {
        constexpr int kCells = kStrip + 1;
        scratch.strip.resize(static_cast<std::size_t>(n_lines) * kCells);
        scratch.rows.resize(static_cast<std::size_t>(n_lines));
        for (int i = 0; i < n_lines; ++i) {
            const std::uint8_t* line = cells + static_cast<std::ptrdiff_t>(i) * n_cells;
            const int lo = first_cell[i] + from;
            if (lo >= 0 && lo + kCells <= n_cells) {
                scratch.rows[i] = line + lo;
                continue;
            }
            std::uint8_t* row = scratch.strip.data() + std::size_t(i) * kCells;
            const int a = std::clamp(-lo, 0, kCells), b = std::clamp(n_cells - lo, a, kCells);
            std::fill(row, row + a, std::uint8_t{0});
            if (b > a) std::copy_n(line + lo + a, b - a, row + a);
            std::fill(row + b, row + kCells, std::uint8_t{0});
            scratch.rows[i] = row;
        }
    }

    /// Values of the strip that was found last, lines [first_line, end), into `out` [end − first_line, kStrip].
    void values_of_strip(const SweepScratch& scratch, int first_line, int end, float* out) const {
        blend(scratch.rows.data() + first_line, scratch.parts.data() + first_line, out, end - first_line);
    }

    /// Positions along the motion where the picture passes, and a cell more on either side.
    int start() const { return static_cast<int>(std::floor(-std::max(length, 0.0))) - 1; }
    int stop() const { return static_cast<int>(std::ceil(n_lines - 1 - std::min(length, 0.0))) + 1; }

    /// Sizes the scratch's picture for those positions.
    Footprint& size_picture(SweepScratch& scratch) const {
        Footprint& swept = scratch.swept;
        swept.width = across;
        swept.height = stop() - start() + 1;
        swept.coverage.resize(static_cast<std::size_t>(across) * swept.height);
        return swept;
    }

    /// Stores the picture over those positions as the jobs' one sub-pose.
    void store(Footprint& swept, StampJobs& jobs) const {
        std::swap(swept.coverage, jobs.cells);
        jobs.width = swept.width - 1;
        jobs.height = swept.height - 1;
        const auto shear = static_cast<float>(-slope);
        SubPose pose{.du = static_cast<float>(-first), .dv = static_cast<float>(-start())};
        pose.xu = along_x ? shear : 1.0f;
        pose.xv = along_x ? 1.0f : shear;
        pose.yu = along_x ? 1.0f : 0.0f;
        pose.yv = along_x ? 0.0f : 1.0f;
        jobs.sub_poses.assign(1, pose);
    }
};

float* line_of(std::vector<float>& v, int line) {
    return v.data() + static_cast<std::ptrdiff_t>(line) * kStrip;
}

/// Computes E into the scratch's picture; returns its gain.
float take_mean(const Sheared& sheared, SweepScratch& scratch) {
    const int n_lines = sheared.n_lines;
    const double length = sheared.length;
    std::vector<float>&lines = scratch.lines, &sums = scratch.sums;
    // One empty line before the picture and one after it. The others are computed.
    lines.resize(static_cast<std::size_t>(n_lines + 2) * kStrip);
    sums.resize(static_cast<std::size_t>(n_lines + 2) * kStrip);
    std::fill_n(line_of(lines, 0), kStrip, 0.0f);
    std::fill_n(line_of(lines, n_lines + 1), kStrip, 0.0f);
    std::fill_n(line_of(sums, 0), kStrip, 0.0f);
    const auto gain = static_cast<float>(std::min(1.0, (n_lines + 1) / std::abs(length)));
    const auto scale = static_cast<float>(1 / (std::abs(length) * gain));
    const auto upper = [&](double x) {  // line k of `lines` lies at k − 1
        const double p = std::clamp(x + 1, 0.0, double(n_lines + 1));
        const int k = std::min(static_cast<int>(p), n_lines);
        return LineIntegral{line_of(sums, k), line_of(lines, k), line_of(lines, k + 1), static_cast<float>(p - k)};
    };
    Footprint& swept = sheared.size_picture(scratch);
    alignas(64) std::array<std::uint8_t, kStrip> values;
    for (int from = 0; from < sheared.across; from += kStrip) {
        sheared.find_strip(from, scratch);
        sheared.values_of_strip(scratch, 0, n_lines, line_of(lines, 1));
        integrate_lines(lines.data(), sums.data(), n_lines + 1);
        const int n = std::min(kStrip, sheared.across - from);
        for (int k = 0; k < swept.height; ++k) {
            const double x = sheared.start() + k;
            difference(upper(std::max(x, x + length)), upper(std::min(x, x + length)), scale, values.data());
            std::copy_n(values.data(), n, swept.coverage.data() + std::size_t(k) * sheared.across + from);
        }
    }
    return gain;
}

/// Computes M strip by strip into the scratch's picture.
class Maximum {
  public:
    Maximum(const Sheared& sheared, SweepScratch& scratch)
        : sheared_(sheared),
          scratch_(scratch),
          back_(std::min(sheared.length, 0.0)),
          on_(std::max(sheared.length, 0.0)),
          begin_(static_cast<int>(std::ceil(back_))),
          count_(static_cast<int>(std::floor(on_)) - begin_ + 1),
          margin_(count_ + 3) {
        while (2 * wide_ <= count_) wide_ *= 2;
        const std::size_t values = std::size_t(sheared.n_lines + 2 * margin_) * kStrip;
        scratch.lines.resize(values);
        if (wide_ > 1) scratch.sums.resize(values);
        sheared.size_picture(scratch);
        scratch.maxima.resize(std::size_t(scratch.swept.height) * kStrip + 2);
        find_swept_lines();
        content_.reserve(std::size_t(sheared.n_lines));
        for (int i = 0; i < sheared.n_lines; ++i)
            content_.push_back(
                content_of({sheared.cells + std::size_t(i) * sheared.n_cells, std::size_t(sheared.n_cells)}));
    }

    /// Values [from, from + kValues) of all lines of the result.
    void take_strip(int from) {
        const auto [first, end] = lines_with_content(from - 1);
        std::size_t first_row = 0, end_row = 0;
        if (first < end) {
            sheared_.find_strip(from - 1, scratch_);
            const auto row_at = [&](double x) {
                return std::size_t(std::clamp(static_cast<int>(x) - sheared_.start(), 0, scratch_.swept.height));
            };
            first_row = row_at(std::floor(first - 1 - on_));
            end_row = row_at(std::ceil(end - back_) + 1);
            take_maxima(first, end, first_row, end_row);
        }
        write(from, first_row, end_row);
    }

    static constexpr int kValues = kStrip - 2;

  private:
    // Lines, results and what is between them that stay in the nearest cache.
    static constexpr int kLinesAtOnce = 16;

    void find_swept_lines() {
        const int total = sheared_.n_lines + 2 * margin_;
        scratch_.swept_lines.resize(static_cast<std::size_t>(scratch_.swept.height));
        for (int k = 0; k < scratch_.swept.height; ++k) {
            const int x = sheared_.start() + k + margin_;
            const auto between = [&](double y, std::size_t& line, float& after) {
                const int i = std::clamp(static_cast<int>(std::floor(y)), 0, total - 2);
                line = std::size_t(i) * kStrip;
                after = static_cast<float>(std::clamp(y - i, 0.0, 1.0));
            };
            SweepScratch::SweptLines& p = scratch_.swept_lines[k];
            between(x + back_, p.back, p.after_back);
            between(x + on_, p.on, p.after_on);
            p.first = std::size_t(std::clamp(x + begin_, 0, total - 1)) * kStrip;
            p.last = std::size_t(std::clamp(x + begin_ + count_ - wide_, 0, total - 1)) * kStrip;
        }
    }

    /// The lines with content in values [from, from + kStrip), and those between.
    std::pair<int, int> lines_with_content(int from) const {
        int first = 0, end = sheared_.n_lines;
        const auto empty = [&](int i) {
            const int lo = sheared_.first_cell[i] + from;
            return content_[i].first >= content_[i].end || content_[i].end <= lo || content_[i].first > lo + kStrip;
        };
        while (first < end && empty(first)) ++first;
        while (first < end && empty(end - 1)) --end;
        return {first, end};
    }

    /// Lines of `most` up to `known` lines that hold the largest value of `wide` lines from theirs on become those of
    /// 2 `wide`, and so on; the last ones wait for the lines after them. `done`: up to where, of each width.
    void widen(int known, std::array<int, 32>& done) {
        const float* in = scratch_.lines.data();
        float* const most = scratch_.sums.data();
        int level = 0;
        for (int w = 1; w < wide_; w *= 2, ++level) {
            const int end = std::max(known - w, done[level]);
            const std::size_t from = std::size_t(done[level]) * kStrip;
            max_ahead(in + from, std::size_t(w) * kStrip, most + from, std::size_t(end - done[level]) * kStrip);
            done[level] = known = end;
            in = most;
        }
    }

    /// Rows of the result whose values may not be 0, from the lines of the strip with content and empty ones round
    /// them.
    void take_maxima(int first_line, int end_line, std::size_t first_row, std::size_t end_row) {
        const int first = first_line + margin_, end = end_line + margin_, begin = first_line, stop = end + margin_;
        std::vector<float>& lines = scratch_.lines;
        std::fill_n(line_of(lines, begin), std::size_t(margin_) * kStrip, 0.0f);
        std::fill_n(line_of(lines, end), std::size_t(margin_) * kStrip, 0.0f);
        std::array<int, 32> done;
        done.fill(begin);
        const int behind = wide_ - 1;  // lines of `most` that wait for others
        std::size_t row = first_row;
        for (int known = first; row < end_row;) {
            const int next = std::min(known + kLinesAtOnce, end);
            sheared_.values_of_strip(scratch_, known - margin_, next - margin_, line_of(lines, known));
            known = next == end ? stop : next;
            widen(known, done);
            const std::size_t lines_known = std::size_t(known) * kStrip,
                              most_known = std::size_t(known - behind) * kStrip;
            std::size_t end_known = row;
            for (; end_known < end_row; ++end_known) {
                const SweepScratch::SweptLines& p = scratch_.swept_lines[end_known];
                if (p.on + kStrip >= lines_known || p.last >= most_known) break;
            }
            if (known == stop) end_known = end_row;
            max_over_motion(lines.data(), wide_ > 1 ? scratch_.sums.data() : lines.data(),
                            scratch_.swept_lines.data() + row, static_cast<int>(end_known - row),
                            scratch_.maxima.data() + row * kStrip);
            row = end_known;
        }
    }

    void write(int from, std::size_t first_row, std::size_t end_row) {
        const auto across = std::size_t(sheared_.across),
                   n = std::min<std::size_t>(kValues, across - std::size_t(from));
        std::uint8_t* const out = scratch_.swept.coverage.data() + from;
        for (std::size_t k = 0; k < std::size_t(scratch_.swept.height); ++k)
            if (k < first_row || k >= end_row) std::fill_n(out + k * across, n, std::uint8_t{0});
        const float* const maxima = scratch_.maxima.data() + first_row * kStrip;
        const std::size_t rows = end_row - first_row;
        if (from + kStrip <= sheared_.across) {  // the next strip goes over the last two
            soften(maxima, static_cast<int>(rows), out + first_row * across, across);
            return;
        }
        scratch_.strip.resize(rows * kStrip);
        soften(maxima, static_cast<int>(rows), scratch_.strip.data(), kStrip);
        for (std::size_t k = 0; k < rows; ++k)
            std::copy_n(scratch_.strip.data() + k * kStrip, n, out + (first_row + k) * across);
    }

    const Sheared& sheared_;
    SweepScratch& scratch_;
    double back_, on_;  // ends of the motion
    // The same number of whole lines lies between both ends of the motion at every position.
    int begin_, count_;
    int margin_;                 // empty lines before and after those with content
    int wide_ = 1;               // lines in a run; two of them cover those between the ends
    Recycled<Content> content_;  // of each line
};

/// Computes M into the scratch's picture.
void take_maximum(const Sheared& sheared, SweepScratch& scratch) {
    Maximum maximum(sheared, scratch);
    for (int from = 0; from < sheared.across; from += Maximum::kValues) maximum.take_strip(from);
}

/// most = gain mean + part (most − gain mean), rounded.
TUFT_CLONES void weigh_maximum(const std::uint8_t* __restrict mean, float gain, float part,
                               std::uint8_t* __restrict most, int n) {
#pragma omp simd
    for (int j = 0; j < n; ++j) {
        const float e = gain * static_cast<float>(int{mean[j]});
        most[j] = static_cast<std::uint8_t>(static_cast<int>(e + part * (static_cast<float>(int{most[j]}) - e) + 0.5f));
    }
}

}  // namespace

void sweep(const Footprint& footprint, const Vec2& shift, StampJobs& jobs, SweepScratch& scratch) {
    const Sheared sheared(footprint, shift, scratch);
    jobs.gain = take_mean(sheared, scratch);
    sheared.store(scratch.swept, jobs);
}

void sweep_over(const Footprint& footprint, const Vec2& shift, float part, StampJobs& jobs, SweepScratch& scratch) {
    const Sheared sheared(footprint, shift, scratch);
    Recycled<std::uint8_t> mean;
    float gain = 1;
    if (part < 1) {
        gain = take_mean(sheared, scratch);
        mean = scratch.swept.coverage;
    }
    take_maximum(sheared, scratch);
    Recycled<std::uint8_t>& swept = scratch.swept.coverage;
    if (part < 1) weigh_maximum(mean.data(), gain, part, swept.data(), static_cast<int>(swept.size()));
    jobs.gain = 1;
    sheared.store(scratch.swept, jobs);
}

}  // namespace tuft::footprint
