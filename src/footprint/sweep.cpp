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

}  // namespace

void sweep(const Footprint& footprint, const Vec2& shift, StampJobs& jobs, SweepScratch& scratch) {
    const Vec2 w = shift / footprint.cell;
    const bool along_x = std::abs(w.x) >= std::abs(w.y);
    const double length = along_x ? w.x : w.y, slope = (along_x ? w.y : w.x) / length;
    // Lines lie across the motion: columns of the picture, or its rows.
    const int n_lines = along_x ? footprint.width : footprint.height;
    const int n_cells = along_x ? footprint.height : footprint.width;
    const double lean = slope * (n_lines - 1);
    const int first = static_cast<int>(std::floor(-std::max(lean, 0.0)));
    const int across = static_cast<int>(std::ceil(n_cells - 1 - std::min(lean, 0.0))) - first + 1;

    // Each line with room on both sides, so that it can be read shifted by any lean.
    const auto pad = static_cast<std::size_t>(across) + 2;
    const std::size_t row = 2 * pad + n_cells;
    std::vector<std::uint8_t>& padded = scratch.line;
    padded.assign(row, 0);
    std::vector<float>&lines = scratch.lines, &sums = scratch.sums;
    // One line of nothing before the picture and one after it.
    lines.assign(static_cast<std::size_t>(n_lines + 2) * across, 0);
    sums.assign(static_cast<std::size_t>(n_lines + 2) * across, 0);
    const auto at = [&](std::vector<float>& v, int line) {
        return v.data() + std::size_t(line) * across;
    };
    for (int i = 0; i < n_lines; ++i) {
        for (int j = 0; j < n_cells; ++j)
            padded[pad + j] = footprint.coverage[along_x ? std::size_t(j) * footprint.width + i
                                                         : std::size_t(i) * footprint.width + j];
        const double begin = first + slope * i;  // the cell that the first value across lies at
        const auto cell = static_cast<int>(std::floor(begin));
        blend(padded.data() + (static_cast<std::ptrdiff_t>(pad) + cell),
              static_cast<float>(begin - cell), at(lines, i + 1), across);
        add_line(at(sums, i), at(lines, i), at(lines, i + 1), at(sums, i + 1), across);
    }
    add_line(at(sums, n_lines), at(lines, n_lines), at(lines, n_lines + 1), at(sums, n_lines + 1),
             across);

    // Places along the motion where the picture passes, and a cell more on either side.
    const int start = static_cast<int>(std::floor(-std::max(length, 0.0))) - 1;
    const int stop = static_cast<int>(std::ceil(n_lines - 1 - std::min(length, 0.0))) + 1;
    const int along = stop - start + 1;
    jobs.gain = static_cast<float>(std::min(1.0, (n_lines + 1) / std::abs(length)));
    const auto scale = static_cast<float>(1 / (std::abs(length) * jobs.gain));
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
    pack_picture(swept, jobs.pairs);
    jobs.width = across - 1;
    jobs.height = along - 1;
    const auto lean_by = static_cast<float>(-slope);
    SubPose pose{.du = static_cast<float>(-first), .dv = static_cast<float>(-start)};
    pose.xu = along_x ? lean_by : 1.0f;
    pose.xv = along_x ? 1.0f : lean_by;
    pose.yu = along_x ? 1.0f : 0.0f;
    pose.yv = along_x ? 0.0f : 1.0f;
    jobs.sub_poses.assign(1, pose);
}

}  // namespace tuft::footprint
