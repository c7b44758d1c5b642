#include "footprint/stamp/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/simd.h"

namespace tuft::footprint {
namespace {

/// Values of a line of the sheared picture that are worked on at a time: all lines of so many stay
/// in the nearer cache, whatever the picture's size, and loops over them have no remainder.
constexpr int kStrip = 64;

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
    }

    /// Values [from, from + kStrip) of all lines into `out` [n_lines kStrip]; outside the picture
    /// they are 0.
    void strip(int from, SweepScratch& scratch, float* out) const {
        constexpr int kCells = kStrip + 1;
        scratch.strip.resize(static_cast<std::size_t>(n_lines) * kCells);
        scratch.parts.resize(static_cast<std::size_t>(n_lines));
        scratch.rows.resize(static_cast<std::size_t>(n_lines));
        for (int i = 0; i < n_lines; ++i) {
            const double begin = first + slope * i;  // the cell that the line's first value lies at
            const auto cell = static_cast<int>(std::floor(begin));
            scratch.parts[i] = static_cast<float>(begin - cell);
            const std::uint8_t* line = cells + static_cast<std::ptrdiff_t>(i) * n_cells;
            const int lo = cell + from;
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
        blend(scratch.rows.data(), scratch.parts.data(), out, n_lines);
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
        sheared.strip(from, scratch, line_of(lines, 1));
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

/// Computes M into the scratch's picture.
void take_maximum(const Sheared& sheared, SweepScratch& scratch) {
    const int n_lines = sheared.n_lines;
    const double back = std::min(sheared.length, 0.0), on = std::max(sheared.length, 0.0);
    // The same number of whole lines lies between both ends of the motion at every position.
    const int begin = static_cast<int>(std::ceil(back)), count = static_cast<int>(std::floor(on)) - begin + 1;
    const int margin = count + 3;  // empty lines before and after the picture
    const int total = n_lines + 2 * margin;
    std::vector<float>& lines = scratch.lines;
    lines.resize(static_cast<std::size_t>(total) * kStrip);
    std::fill_n(line_of(lines, 0), std::size_t(margin) * kStrip, 0.0f);
    std::fill_n(line_of(lines, margin + n_lines), std::size_t(margin) * kStrip, 0.0f);
    if (count > 1) {
        scratch.sums.resize(static_cast<std::size_t>(total) * kStrip);
        std::fill_n(line_of(scratch.sums, total - 1), kStrip, 0.0f);  // which no maximum ahead of it is computed for
    }
    std::vector<float>& most = count > 1 ? scratch.sums : lines;  // the largest value of `wide` lines from here on
    int wide = 1;
    while (2 * wide <= count) wide *= 2;
    Footprint& swept = sheared.size_picture(scratch);
    scratch.maxima.resize(static_cast<std::size_t>(swept.height) * kStrip + 2);
    scratch.swept_lines.resize(static_cast<std::size_t>(swept.height));
    for (int k = 0; k < swept.height; ++k) {
        const int x = sheared.start() + k + margin;
        const auto between = [&](double y, std::size_t& line, float& after) {
            const int i = std::clamp(static_cast<int>(std::floor(y)), 0, total - 2);
            line = std::size_t(i) * kStrip;
            after = static_cast<float>(std::clamp(y - i, 0.0, 1.0));
        };
        SweepScratch::SweptLines& p = scratch.swept_lines[k];
        between(x + back, p.back, p.after_back);
        between(x + on, p.on, p.after_on);
        p.first = std::size_t(std::clamp(x + begin, 0, total - 1)) * kStrip;
        p.last = std::size_t(std::clamp(x + begin + count - wide, 0, total - 1)) * kStrip;
    }
    constexpr int kValues = kStrip - 2;
    for (int from = 0; from < sheared.across; from += kValues) {
        sheared.strip(from - 1, scratch, line_of(lines, margin));
        for (int w = 1; w < wide; w *= 2)
            max_ahead(w == 1 ? lines.data() : most.data(), std::size_t(w) * kStrip, most.data(),
                      std::size_t(total - w) * kStrip);
        max_over_motion(lines.data(), most.data(), scratch.swept_lines.data(), swept.height, scratch.maxima.data());
        std::uint8_t* out = swept.coverage.data() + from;
        if (from + kStrip <= sheared.across) {  // the next strip goes over the last two
            soften(scratch.maxima.data(), swept.height, out, std::size_t(sheared.across));
            continue;
        }
        scratch.strip.resize(static_cast<std::size_t>(swept.height) * kStrip);
        soften(scratch.maxima.data(), swept.height, scratch.strip.data(), kStrip);
        for (int k = 0; k < swept.height; ++k)
            std::copy_n(scratch.strip.data() + std::size_t(k) * kStrip, std::min(kValues, sheared.across - from),
                        out + std::size_t(k) * sheared.across);
    }
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
