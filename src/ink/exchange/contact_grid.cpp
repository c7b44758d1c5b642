#include "ink/exchange/contact_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ink/simd.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kSums = 16;
constexpr double kLeastStep = 1e-6;  // metres between nodes

using Texels = std::array<float, kN>;

inline float limited(float x, float last) {
    const float low = x > 0 ? x : 0;
    return low < last ? low : last;
}

/// A node coordinate over the surface: slope · (p − origin) + offset.
struct NodeAxis {
    Vec3f slope{0};  ///< nodes a metre, world
    float offset = 0;
};

TUFT_CLONES void node_coordinates(TexelPlaces& out, const atlas::TexelShape& shape, const Vec3f& origin,
                                  const NodeAxis& along_axis, const NodeAxis& across_axis) {
    float* __restrict along = out.along.data(), * __restrict across = out.across.data();
    const float* __restrict x = shape.px.data(), * __restrict y = shape.py.data(), * __restrict z = shape.pz.data();
    const Vec3f &a = along_axis.slope, &b = across_axis.slope;
    const float a0 = along_axis.offset, b0 = across_axis.offset;
    for (int t = 0; t < kN; ++t) {
        const float dx = x[t] - origin.x, dy = y[t] - origin.y, dz = z[t] - origin.z;
        along[t] = limited(dx * a.x + dy * a.y + dz * a.z + a0, kAlong - 1);
        across[t] = limited(dx * b.x + dy * b.y + dz * b.z + b0, kAcross - 1);
    }
}

TUFT_CLONES void values_at(float* __restrict out, const float* __restrict across, const float* __restrict furrows,
                           float scale) {
    for (int t = 0; t < kN; ++t) {
        const float x = across[t] * scale;
        int i = static_cast<int>(x);
        i = i < kFirmnessSamples - 2 ? i : kFirmnessSamples - 2;
        out[t] = furrows[i] + (x - static_cast<float>(i)) * (furrows[i + 1] - furrows[i]);
    }
}

TUFT_CLONES void hat(float* __restrict out, const float* __restrict at, const float* __restrict coverage, float node) {
    for (int t = 0; t < kN; ++t) {
        const float d = at[t] - node, w = 1 - (d < 0 ? -d : d);
        out[t] = w > 0 && coverage[t] > 0 ? w : 0;
    }
}

TUFT_CLONES void product(float* __restrict out, const float* __restrict a, const float* __restrict b) {
    for (int t = 0; t < kN; ++t) out[t] = a[t] * b[t];
}

// Planes of weights follow each other; a few at a time, so that each pass over the texels does more
// than read them.
constexpr int kAtOnce = 4;

/// out, or 0 if fresh, plus Σ of kCount planes of weights times their values.
template <int kCount, bool kFresh>
inline __attribute__((always_inline)) void add_scaled(float* __restrict out, const float* __restrict w,
                                                      const float* value) {
    float v[kCount];
    for (int k = 0; k < kCount; ++k) v[k] = value[k];
    for (int t = 0; t < kN; ++t) {
        float sum = kFresh ? 0 : out[t];
        for (int k = 0; k < kCount; ++k) sum += w[k * kN + t] * v[k];
        out[t] = sum;
    }
}
TUFT_CLONES void weighted_sum(float* __restrict out, const float* __restrict w, const float* values, int count) {
    int k = 0;
    if (count >= kAtOnce)
        add_scaled<kAtOnce, true>(out, w, values), k = kAtOnce;
    else if (count >= 2)
        add_scaled<2, true>(out, w, values), k = 2;
    else
        add_scaled<1, true>(out, w, values), k = 1;
    for (; k + kAtOnce <= count; k += kAtOnce) add_scaled<kAtOnce, false>(out, w + k * kN, values + k);
    for (; k + 2 <= count; k += 2) add_scaled<2, false>(out, w + k * kN, values + k);
    for (; k < count; ++k) add_scaled<1, false>(out, w + k * kN, values + k);
}

/// Σ of kCount planes of weights times x. Several sums at once do not wait for each other.
template <int kCount>
inline __attribute__((always_inline)) void few_dots(float* __restrict out, const float* __restrict w,
                                                    const float* __restrict x) {
    static_assert(kCount <= 4);
    float a[kSums] = {}, b[kSums] = {}, c[kSums] = {}, d[kSums] = {};
    for (int t = 0; t < kN; t += kSums)
        for (int i = 0; i < kSums; ++i) {
            const float here = x[t + i];
            a[i] += w[t + i] * here;
            if constexpr (kCount > 1) b[i] += w[kN + t + i] * here;
            if constexpr (kCount > 2) c[i] += w[2 * kN + t + i] * here;
            if constexpr (kCount > 3) d[i] += w[3 * kN + t + i] * here;
        }
    float sum[4] = {};
    for (int i = 0; i < kSums; ++i) sum[0] += a[i], sum[1] += b[i], sum[2] += c[i], sum[3] += d[i];
    for (int k = 0; k < kCount; ++k) out[k] = sum[k];
}
TUFT_CLONES void dots(float* __restrict out, const float* __restrict w, const float* __restrict x, int count) {
    int k = 0;
    for (; k + kAtOnce <= count; k += kAtOnce) few_dots<kAtOnce>(out + k, w + k * kN, x);
    for (; k + 2 <= count; k += 2) few_dots<2>(out + k, w + k * kN, x);
    for (; k < count; ++k) few_dots<1>(out + k, w + k * kN, x);
}

TUFT_CLONES double difference_area(const float* __restrict after, const float* __restrict before,
                                   const float* __restrict area) {
    double sums[kSums] = {};
    for (int t = 0; t < kN; t += kSums)
        for (int i = 0; i < kSums; ++i)
            sums[i] += (static_cast<double>(after[t + i]) - static_cast<double>(before[t + i])) *
                       static_cast<double>(area[t + i]);
    double sum = 0;
    for (const double s : sums) sum += s;
    return sum;
}

struct Range {
    int first, last;
};

/// The least and greatest of what lies on covered texels, by lanes.
TUFT_CLONES void extent(float* __restrict lo, float* __restrict hi, const float* __restrict at,
                        const float* __restrict coverage) {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    float least[kSums], most[kSums];
    for (int i = 0; i < kSums; ++i) least[i] = kFar, most[i] = -kFar;
    for (int t = 0; t < kN; t += kSums)
        for (int i = 0; i < kSums; ++i) {
            const bool covered = coverage[t + i] > 0;
            const float low = covered ? at[t + i] : kFar, high = covered ? at[t + i] : -kFar;
            least[i] = low < least[i] ? low : least[i];
            most[i] = high > most[i] ? high : most[i];
        }
    for (int i = 0; i < kSums; ++i) lo[i] = least[i], hi[i] = most[i];
}

/// Nodes whose hats reach covered texels; none when there are none.
Range reached(const Texels& at, std::span<const float, kN> coverage, int nodes) {
    std::array<float, kSums> least, most;
    extent(least.data(), most.data(), at.data(), coverage.data());
    const float lo = *std::min_element(least.begin(), least.end()), hi = *std::max_element(most.begin(), most.end());
    if (!(lo <= hi)) return {0, -1};
    return {static_cast<int>(lo), std::min(static_cast<int>(hi) + 1, nodes - 1)};
}

}  // namespace

ContactGrid make_contact_grid(std::span<const Vec2> places, const Vec2& axis) {
    ContactGrid grid{.axis = axis};
    if (places.empty()) return grid;
    Vec2 lo{std::numeric_limits<double>::infinity()}, hi{-lo};
    for (const Vec2& d : places) {
        const Vec2 p = grid.at(d);  // with unit steps from the origin
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    grid.lo = lo;
    grid.step = glm::max((hi - lo) / Vec2{kAlong - 1, kAcross - 1}, Vec2{kLeastStep});
    return grid;
}

void place_texels(TexelPlaces& out, const ContactGrid& grid, const Frame& frame, const atlas::TexelShape& shape) {
    const Vec3 along = (grid.axis.x * frame.t + grid.axis.y * frame.b) / grid.step.x;
    const Vec3 across = (grid.axis.x * frame.b - grid.axis.y * frame.t) / grid.step.y;
    node_coordinates(out, shape, Vec3f(frame.origin), {Vec3f(along), static_cast<float>(-grid.lo.x / grid.step.x)},
                     {Vec3f(across), static_cast<float>(-grid.lo.y / grid.step.y)});
}

void furrow_depth_at(std::span<float, kN> out, const TexelPlaces& places, const FurrowDepths& furrows) {
    values_at(out.data(), places.across.data(), furrows.data(), float(kFirmnessSamples - 1) / (kAcross - 1));
}

void hat_basis(HatBasis& out, const TexelPlaces& places, std::span<const float, kN> coverage) {
    const Range along = reached(places.along, coverage, kAlong), across = reached(places.across, coverage, kAcross);
    alignas(64) Texels rows;
    alignas(64) std::array<Texels, kAcross> columns;
    for (int j = across.first; j <= across.last; ++j)
        hat(columns[j].data(), places.across.data(), coverage.data(), static_cast<float>(j));
    out.count = 0;
    for (int i = along.first; i <= along.last; ++i) {
        hat(rows.data(), places.along.data(), coverage.data(), static_cast<float>(i));
        for (int j = across.first; j <= across.last; ++j) {
            out.node[out.count] = static_cast<std::uint8_t>(i * kAcross + j);
            product(out.weight[out.count].data(), rows.data(), columns[j].data());
            ++out.count;
        }
    }
}

void integrate_hats(std::span<double, kNodes> out, const HatBasis& hats, const float* x,
                    std::span<const float, kN> area) {
    alignas(64) Texels amounts;
    if (x) product(amounts.data(), x, area.data());
    const float* by = x ? amounts.data() : area.data();
    std::array<float, kNodes> sums;
    dots(sums.data(), hats.weight[0].data(), by, hats.count);
    for (int k = 0; k < hats.count; ++k) out[k] = static_cast<double>(sums[k]);
}

void interpolate(Texels& out, const HatBasis& hats, const std::array<float, kNodes>& values) {
    if (hats.count == 0) return out.fill(0);
    std::array<float, kNodes> by_hat;
    for (int k = 0; k < hats.count; ++k) by_hat[k] = values[hats.node[k]];
    weighted_sum(out.data(), hats.weight[0].data(), by_hat.data(), hats.count);
}

double change_sum(const float* after, const float* before, const float* area) {
    return difference_area(after, before, area);
}

}  // namespace tuft::ink
