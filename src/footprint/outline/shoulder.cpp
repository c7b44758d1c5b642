#include "footprint/outline/shoulder.h"

#include <algorithm>
#include <cmath>

namespace tuft::footprint {
namespace {

constexpr int kWithin = 6;  // cells of the coarse picture that the rounded edge is wide, at least
constexpr float kFar = 1e9f;

/// Distances along lines of squared ones, [n] with a stride: min over q of (p − q)² + f(q). The
/// lower envelope of parabolas [Felzenszwalb2012].
class Envelope {
  public:
    explicit Envelope(int longest) : line_(longest), from_(longest), border_(longest + 1) {}

    void transform(float* f, int n, int stride) {
        for (int q = 0; q < n; ++q) line_[q] = f[std::size_t(q) * stride];
        int k = 0;
        from_[0] = 0;
        border_[0] = -kFar;
        border_[1] = kFar;
        for (int q = 1; q < n; ++q) {
            float s = meet(q, from_[k]);
            while (k > 0 && s <= border_[k]) s = meet(q, from_[--k]);
            if (s <= border_[k]) s = border_[k];
            from_[++k] = q;
            border_[k] = s;
            border_[k + 1] = kFar;
        }
        k = 0;
        for (int p = 0; p < n; ++p) {
            while (border_[k + 1] < static_cast<float>(p)) ++k;
            const auto d = static_cast<float>(p - from_[k]);
            f[std::size_t(p) * stride] = d * d + line_[from_[k]];
        }
    }

  private:
    float meet(int q, int v) const {
        const auto a = static_cast<float>(q), b = static_cast<float>(v);
        return ((line_[q] + a * a) - (line_[v] + b * b)) / (2 * (a - b));
    }

    Recycled<float> line_;
    Recycled<int> from_;
    Recycled<float> border_;
};

/// Distance of each block of `part` × `part` cells from the edge, in blocks, with a frame of empty
/// ones: block (i, j) at (j + 1) * width + i + 1.
struct Blocks {
    int width = 0, height = 0;
    Recycled<float> far;

    Blocks(const Footprint& f, int part)
        : width((f.width + part - 1) / part + 2), height((f.height + part - 1) / part + 2) {
        far.assign(std::size_t(width) * height, 0);
        Recycled<std::uint32_t> sum(far.size(), 0);
        for (int y = 0; y < f.height; ++y) {
            std::uint32_t* to = sum.data() + std::size_t(y / part + 1) * width + 1;
            const std::uint8_t* from = f.coverage.data() + std::size_t(y) * f.width;
            for (int x = 0; x < f.width; ++to)
                for (const int end = std::min(x + part, f.width); x < end; ++x) *to += from[x];
        }
        for (std::size_t i = 0; i < far.size(); ++i) {
            // A block that is covered in part has the edge in it, so far from its middle.
            const float inside = static_cast<float>(sum[i]) / static_cast<float>(255 * part * part) - 0.5f;
            far[i] = inside > 0.499f ? 1e6f : inside > 0 ? inside * inside : 0;
        }
        Envelope envelope(std::max(width, height));
        for (int y = 0; y < height; ++y) envelope.transform(far.data() + std::size_t(y) * width, width, 1);
        for (int x = 0; x < width; ++x) envelope.transform(far.data() + x, height, width);
        for (float& v : far) v = std::sqrt(v);
    }
};

}  // namespace

void round_edges(Footprint& f, double length) {
    if (f.empty() || !(length > 0)) return;
    const int part = std::max(1, static_cast<int>(length / (kWithin * f.cell)));
    const Blocks blocks(f, part);
    const float scale = static_cast<float>(part * f.cell / length), step = 1 / static_cast<float>(part);
    for (int y = 0; y < f.height; ++y) {
        // Between the middles of blocks, bilinear.
        const float v = (static_cast<float>(y) + 0.5f) * step + 0.5f;
        const int j = static_cast<int>(v);
        const float fv = v - static_cast<float>(j);
        const float *row = blocks.far.data() + std::size_t(j) * blocks.width, *next = row + blocks.width;
        std::uint8_t* cells = f.coverage.data() + std::size_t(y) * f.width;
        for (int x = 0; x < f.width; ++x) {
            std::uint8_t& cell = cells[x];
            if (!cell) continue;
            const float u = (static_cast<float>(x) + 0.5f) * step + 0.5f;
            const int i = static_cast<int>(u);
            const float fu = u - static_cast<float>(i);
            const float lo = row[i] + fu * (row[i + 1] - row[i]);
            const float hi = next[i] + fu * (next[i + 1] - next[i]);
            const float far = (lo + fv * (hi - lo)) * scale;
            if (far >= 1) continue;
            cell = static_cast<std::uint8_t>(static_cast<float>(cell) * std::sqrt(far * (2 - far)) + 0.5f);
        }
    }
}

}  // namespace tuft::footprint
