#include "footprint/sweep.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"

namespace tuft::footprint {
namespace {

/// out = low + f (high − low): a line of the picture seen half a cell further.
TUFT_CLONES void blend(const std::uint8_t* __restrict line, float f, float* __restrict out, int n) {
#pragma omp simd
    for (int j = 0; j < n; ++j) {
        const auto low = static_cast<float>(int{line[j]}),
                   high = static_cast<float>(int{line[j + 1]});
        out[j] = low + f * (high - low);
    }
}

/// sum_out = sum_in + (before + now) / 2: the integral of what is linear between two lines.
TUFT_CLONES void add_line(const float* __restrict sum_in, const float* __restrict before,
                          const float* __restrict now, float* __restrict sum_out, int n) {
#pragma omp simd
    for (int j = 0; j < n; ++j) sum_out[j] = sum_in[j] + 0.5f * (before[j] + now[j]);
}

/// The integral up to a part t of the way between lines a and b with integrals ia and ib.
struct Upper {
    const float *integral, *line, *next;
    float t;
};

/// out = (upper − lower) scale, rounded.
TUFT_CLONES void difference(const Upper& to, const Upper& from, float scale,
                            std::uint8_t* __restrict out, int n) {
    const float t = to.t, s = from.t;
    const float *ti = to.integral, *ta = to.line, *tb = to.next;
    const float *si = from.integral, *sa = from.line, *sb = from.next;
#pragma omp simd
    for (int j = 0; j < n; ++j) {
        const float high = ti[j] + t * (ta[j] + 0.5f * t * (tb[j] - ta[j]));
        const float low = si[j] + s * (sa[j] + 0.5f * s * (sb[j] - sa[j]));
        const float e = (high - low) * scale + 0.5f;
        out[j] = static_cast<std::uint8_t>(static_cast<int>(e < 255.0f ? e : 255.0f));
    }
}

/// out = the larger one.
TUFT_CLONES void larger(const float* __restrict a, const float* __restrict b, float* __restrict out, int n) {
#pragma omp simd
    for (int j = 0; j < n; ++j) out[j] = a[j] > b[j] ? a[j] : b[j];
}

/// A place between line a and the next one.
struct Between {
    const float *a, *b;
    float t;
};

/// out = the largest of four lines, two of them between lines.
TUFT_CLONES void largest(const Between& p, const Between& q, const float* __restrict c,
                         const float* __restrict d, float* __restrict out, int n) {
    const float s = p.t, t = q.t;
    const float *pa = p.a, *pb = p.b, *qa = q.a, *qb = q.b;
#pragma omp simd
    for (int j = 0; j < n; ++j) {
        const float low = pa[j] + s * (pb[j] - pa[j]), high = qa[j] + t * (qb[j] - qa[j]);
        const float ends = low > high ? low : high, inner = c[j] > d[j] ? c[j] : d[j];
        out[j] = ends > inner ? ends : inner;
    }
}

/// out = (line before + 2 line + line after) / 4 of each value's neighbours, rounded: the mean over two cells, a
/// texel, wherever between the cells it is read. `line` has a value before and after the n.
TUFT_CLONES void soften(const float* __restrict line, std::uint8_t* __restrict out, int n) {
#pragma omp simd
    for (int j = 0; j < n; ++j)
        out[j] = static_cast<std::uint8_t>(
            static_cast<int>(0.25f * (line[j] + 2 * line[j + 1] + line[j + 2]) + 0.5f));
}

/// The picture in lines across the motion, columns of it or rows, sheared so that the motion leads
/// from line to line: value j of line i lies `first` + j + `slope` i cells along the line.
struct Sheared {
    bool along_x = true;
    double length = 0, slope = 0;  // cells; of the motion, and aside on the way from line to line
    int n_lines = 0, first = 0, across = 0;

    Sheared(const Footprint& footprint, const Vec2& shift) {
        const Vec2 w = shift / footprint.cell;
        along_x = std::abs(w.x) >= std::abs(w.y);
        length = along_x ? w.x : w.y;
        slope = (along_x ? w.y : w.x) / length;
        n_lines = along_x ? footprint.width : footprint.height;
        const double lean = slope * (n_lines - 1);
        first = static_cast<int>(std::floor(-std::max(lean, 0.0)));
        across = static_cast<int>(std::ceil(n_cells(footprint) - 1 - std::min(lean, 0.0))) - first + 1;
    }

    int n_cells(const Footprint& footprint) const { return along_x ? footprint.height : footprint.width; }

    /// Line i into `out` [across]. `padded` is room for a line of cells.
    void line(const Footprint& footprint, int i, std::vector<std::uint8_t>& padded, float* out) const {
        // With room on both sides, so that it can be read shifted by any lean.
        const auto pad = static_cast<std::size_t>(across) + 2;
        const int cells = n_cells(footprint);
        if (i == 0) padded.assign(2 * pad + cells, 0);
        for (int j = 0; j < cells; ++j)
            padded[pad + j] = footprint.coverage[along_x ? std::size_t(j) * footprint.width + i
                                                         : std::size_t(i) * footprint.width + j];
        const double begin = first + slope * i;  // the cell that the first value lies at
        const auto cell = static_cast<int>(std::floor(begin));
        blend(padded.data() + (static_cast<std::ptrdiff_t>(pad) + cell), static_cast<float>(begin - cell), out,
              across);
    }

    /// Places along the motion where the picture passes, and a cell more on either side.
    int start() const { return static_cast<int>(std::floor(-std::max(length, 0.0))) - 1; }
    int stop() const { return static_cast<int>(std::ceil(n_lines - 1 - std::min(length, 0.0))) + 1; }

    /// The picture over those places as the jobs' one sub-pose.
    void hand_over(const Footprint& swept, StampJobs& jobs) const {
        pack_picture(swept, jobs.pairs);
        jobs.width = swept.width - 1;
        jobs.height = swept.height - 1;
        const auto lean_by = static_cast<float>(-slope);
        SubPose pose{.du = static_cast<float>(-first), .dv = static_cast<float>(-start())};
        pose.xu = along_x ? lean_by : 1.0f;
        pose.xv = along_x ? 1.0f : lean_by;
        pose.yu = along_x ? 1.0f : 0.0f;
        pose.yv = along_x ? 0.0f : 1.0f;
        jobs.sub_poses.assign(1, pose);
    }
};

/// E into the scratch's picture; returns the gain that belongs to it.
float mean_over(const Sheared& sheared, const Footprint& footprint, SweepScratch& scratch) {
    const int n_lines = sheared.n_lines, across = sheared.across;
    const double length = sheared.length;
    std::vector<float>&lines = scratch.lines, &sums = scratch.sums;
    // One line of nothing before the picture and one after it.
    lines.assign(static_cast<std::size_t>(n_lines + 2) * across, 0);
    sums.assign(static_cast<std::size_t>(n_lines + 2) * across, 0);
    const auto at = [&](std::vector<float>& v, int line) {
        return v.data() + std::size_t(line) * across;
    };
    for (int i = 0; i < n_lines; ++i) {
        sheared.line(footprint, i, scratch.line, at(lines, i + 1));
        add_line(at(sums, i), at(lines, i), at(lines, i + 1), at(sums, i + 1), across);
    }
    add_line(at(sums, n_lines), at(lines, n_lines), at(lines, n_lines + 1), at(sums, n_lines + 1),
             across);

    const int start = sheared.start(), along = sheared.stop() - start + 1;
    const auto gain = static_cast<float>(std::min(1.0, (n_lines + 1) / std::abs(length)));
    const auto scale = static_cast<float>(1 / (std::abs(length) * gain));
    const auto upper = [&](double x) {  // line k of `lines` lies at k − 1
        const double p = std::clamp(x + 1, 0.0, double(n_lines + 1));
        const int k = std::min(static_cast<int>(p), n_lines);
        return Upper{at(sums, k), at(lines, k), at(lines, k + 1), static_cast<float>(p - k)};
    };
    Footprint& swept = scratch.swept;
    swept.width = across;
    swept.height = along;
    swept.coverage.resize(static_cast<std::size_t>(across) * along);
    for (int k = 0; k < along; ++k) {
        const double x = start + k;
        difference(upper(std::max(x, x + length)), upper(std::min(x, x + length)), scale,
                   swept.coverage.data() + std::size_t(k) * across, across);
    }
    return gain;
}

/// M likewise.
void most_over(const Sheared& sheared, const Footprint& footprint, SweepScratch& scratch) {
    const int n_lines = sheared.n_lines, across = sheared.across;
    const double back = std::min(sheared.length, 0.0), on = std::max(sheared.length, 0.0);
    // The same number of whole lines lies between both ends of the way at every place.
    const int from = static_cast<int>(std::ceil(back)), count = static_cast<int>(std::floor(on)) - from + 1;
    const int room = count + 3;  // lines of nothing before and after the picture
    const int total = n_lines + 2 * room;
    std::vector<float>& lines = scratch.lines;
    std::vector<float>& most = scratch.sums;  // the largest value of `wide` lines from here on
    lines.assign(static_cast<std::size_t>(total) * across, 0);
    const auto at = [&](std::vector<float>& v, int line) {
        return v.data() + std::size_t(line) * across;
    };
    for (int i = 0; i < n_lines; ++i) sheared.line(footprint, i, scratch.line, at(lines, i + room));
    most = lines;
    int wide = 1;
    for (; 2 * wide <= count; wide *= 2)
        for (int i = 0; i + wide < total; ++i) larger(at(most, i), at(most, i + wide), at(most, i), across);

    const int start = sheared.start(), along = sheared.stop() - start + 1;
    Footprint& swept = scratch.swept;
    swept.width = across;
    swept.height = along;
    swept.coverage.resize(static_cast<std::size_t>(across) * along);
    const auto between = [&](double x) {
        const int i = std::clamp(static_cast<int>(std::floor(x)), 0, total - 2);
        return Between{at(lines, i), at(lines, i + 1), static_cast<float>(std::clamp(x - i, 0.0, 1.0))};
    };
    std::vector<float>& line = scratch.across;
    line.assign(static_cast<std::size_t>(across) + 2, 0);
    for (int k = 0; k < along; ++k) {
        const int x = start + k + room, a = std::clamp(x + from, 0, total - 1);
        const int b = std::clamp(x + from + count - wide, 0, total - 1);
        largest(between(x + back), between(x + on), at(most, a), at(most, b), line.data() + 1, across);
        soften(line.data(), swept.coverage.data() + std::size_t(k) * across, across);
    }
}

/// most = gain mean + part (most − gain mean), rounded.
TUFT_CLONES void mix(const std::uint8_t* __restrict mean, float gain, float part, std::uint8_t* __restrict most, int n) {
#pragma omp simd
    for (int j = 0; j < n; ++j) {
        const float e = gain * static_cast<float>(int{mean[j]});
        most[j] = static_cast<std::uint8_t>(static_cast<int>(e + part * (static_cast<float>(int{most[j]}) - e) + 0.5f));
    }
}

}  // namespace

void sweep(const Footprint& footprint, const Vec2& shift, StampJobs& jobs, SweepScratch& scratch) {
    const Sheared sheared(footprint, shift);
    jobs.gain = mean_over(sheared, footprint, scratch);
    sheared.hand_over(scratch.swept, jobs);
}

void sweep_over(const Footprint& footprint, const Vec2& shift, float part, StampJobs& jobs, SweepScratch& scratch) {
    const Sheared sheared(footprint, shift);
    std::vector<std::uint8_t> mean;
    float gain = 1;
    if (part < 1) {
        gain = mean_over(sheared, footprint, scratch);
        mean = scratch.swept.coverage;
    }
    most_over(sheared, footprint, scratch);
    std::vector<std::uint8_t>& swept = scratch.swept.coverage;
    if (part < 1) mix(mean.data(), gain, part, swept.data(), static_cast<int>(swept.size()));
    jobs.gain = 1;
    sheared.hand_over(scratch.swept, jobs);
}

}  // namespace tuft::footprint
