#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/system/parallel.h"
#include "render/picture/light_buffer.h"

namespace tuft::render {
namespace {

constexpr float kLeastCosine = 0.8f;  // between the normals of one smooth surface
constexpr float kMostOff = 4;         // of the reach, off each other's tangent planes
constexpr int kBlock = 64;            // pixels of a row that are computed side by side

float luma(const Vec3f& c) {
    return 0.25f * c.x + 0.5f * c.y + 0.25f * c.z;
}

/// e^−x of x >= 0 to 3e-7, without a branch, so that loops over it are vectorised.
inline float exp_minus(float x) {
    constexpr float kPerLn2 = 1.44269504f, kLn2 = 0.693147181f;
    const float t = std::min(x * kPerLn2, 126.0f);
    const int n = static_cast<int>(t + 0.5f);
    const float u = (static_cast<float>(n) - t) * kLn2;  // |u| <= ln 2 / 2: the next term is 1.2e-7
    const float e =
        1 + u * (1 + u * (1 / 2.0f + u * (1 / 6.0f + u * (1 / 24.0f + u * (1 / 120.0f + u * (1 / 720.0f))))));
    return e * std::bit_cast<float>((127 - n) << 23);
}

/// What is seen, by components.
struct Sights {
    int width = 0, height = 0;
    std::vector<std::int32_t> kind;
    std::array<std::vector<float>, 3> normal, position;
    std::vector<float> per_pixel;  ///< 1/m, over the size of a pixel there

    Sights(const LightBuffer& in, const Camera& camera) : width(in.width), height(in.height) {
        const std::size_t n = in.hits.size();
        kind.resize(n);
        per_pixel.resize(n);
        for (int c = 0; c < 3; ++c) normal[c].resize(n), position[c].resize(n);
        const float per_metre = static_cast<float>(2 * camera.tan_half_height / camera.height * in.step);
        for (std::size_t k = 0; k < n; ++k) {
            const ViewHit& s = in.hits[k];
            kind[k] = static_cast<std::int32_t>(s.kind);
            for (int c = 0; c < 3; ++c) normal[c][k] = s.normal[c], position[c][k] = s.position[c];
            per_pixel[k] = 1 / (per_metre * std::max(glm::length(s.position - Vec3f(camera.eye)), 1e-20f));
        }
    }
};

/// The light, by components: direct r, g, b, around r, g, b; luma and variance of both parts.
struct LightPlanes {
    std::array<std::vector<float>, 6> light;
    std::array<std::vector<float>, 2> luma, variance;

    explicit LightPlanes(std::size_t n) {
        for (auto& plane : light) plane.resize(n);
        for (auto& plane : luma) plane.resize(n);
        for (auto& plane : variance) plane.resize(n);
    }
    void set(std::size_t k, const Light& l) {
        for (int c = 0; c < 3; ++c) light[c][k] = l.direct[c], light[3 + c][k] = l.around[c];
        luma[0][k] = render::luma(l.direct), luma[1][k] = render::luma(l.around);
    }
    Light at(std::size_t k) const {
        return {{light[0][k], light[1][k], light[2][k]}, {light[3][k], light[4][k], light[5][k]}};
    }
};

/// Pixels side by side in a row.
struct Block {
    int x = 0, y = 0, n = 0;

    std::size_t first(const Sights& s) const { return static_cast<std::size_t>(y) * s.width + x; }
};

/// Those pixels of a block that have a neighbour at (dx, dy): from `begin` to `end`.
struct Neighbours {
    int begin = 0, end = 0;
    std::ptrdiff_t offset = 0;  ///< of the neighbour

    Neighbours(const Sights& s, const Block& b, int dx, int dy)
        : begin(std::max(0, -(b.x + dx))),
          end(b.y + dy < 0 || b.y + dy >= s.height ? 0 : std::min(b.n, s.width - b.x - dx)),
          offset(static_cast<std::ptrdiff_t>(dy) * s.width + dx) {}
};

/// Geometric weights between pixels and their neighbours: 0 across edges, 1 on one smooth surface. `reach`: in pixels.
void find_likeness(const Sights& s, std::size_t first, const Neighbours& to, float reach, float* weight) {
    const float per_reach = 1 / reach;
    const std::size_t other = first + to.offset;
    const std::int32_t *kind = &s.kind[first], *kind_there = s.kind.data() + other;
    const float *nx = &s.normal[0][first], *ny = &s.normal[1][first], *nz = &s.normal[2][first];
    const float *mx = s.normal[0].data() + other, *my = s.normal[1].data() + other, *mz = s.normal[2].data() + other;
    const float *px = &s.position[0][first], *py = &s.position[1][first], *pz = &s.position[2][first];
    const float *qx = s.position[0].data() + other, *qy = s.position[1].data() + other,
                *qz = s.position[2].data() + other;
    const float* per_pixel = &s.per_pixel[first];
    for (int i = to.begin; i < to.end; ++i) {
        const float cosine = nx[i] * mx[i] + ny[i] * my[i] + nz[i] * mz[i];
        const float dx = qx[i] - px[i], dy = qy[i] - py[i], dz = qz[i] - pz[i];
        const float here = std::abs(nx[i] * dx + ny[i] * dy + nz[i] * dz),
                    there = std::abs(mx[i] * dx + my[i] * dy + mz[i] * dz);
        const float off = std::max(here, there) * per_pixel[i] * per_reach;
        const float c2 = cosine * cosine, c4 = c2 * c2, c8 = c4 * c4, c16 = c8 * c8;
        float w = c16 * c16 * exp_minus(off * off);
        w = cosine < kLeastCosine ? 0 : w;
        w = off > kMostOff ? 0 : w;
        w = kind[i] == static_cast<std::int32_t>(HitKind::object) ? w : 1;
        weight[i] = kind[i] == kind_there[i] ? w : 0;
    }
}

/// Calls `work` with each block of the picture, in parallel.
template <class Work>
void for_blocks(const Sights& s, const Work& work) {
    parallel_for(static_cast<std::size_t>(s.height), std::max(1, 4096 / std::max(1, s.width)),
                 [&](std::size_t begin, std::size_t end) {
                     for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                         for (int x = 0; x < s.width; x += kBlock) work(Block{x, y, std::min(kBlock, s.width - x)});
                 });
}

/// Sets the variance of each part over the 7 × 7 pixels of the same surface.
void set_local_variance(const Sights& s, LightPlanes& in) {
    constexpr int kRadius = 3;
    for_blocks(s, [&](const Block& b) {
        const std::size_t first = b.first(s);
        std::array<float, kBlock> w{}, total{};
        std::array<std::array<float, kBlock>, 2> sum{}, squares{};
        for (int dy = -kRadius; dy <= kRadius; ++dy)
            for (int dx = -kRadius; dx <= kRadius; ++dx) {
                const Neighbours to(s, b, dx, dy);
                if (to.begin >= to.end) continue;
                find_likeness(s, first, to, kRadius, w.data());
                for (int i = to.begin; i < to.end; ++i) total[i] += w[i];
                for (int part = 0; part < 2; ++part) {
                    const float* l = in.luma[part].data() + first + to.offset;
                    for (int i = to.begin; i < to.end; ++i) {
                        sum[part][i] += w[i] * l[i];
                        squares[part][i] += w[i] * l[i] * l[i];
                    }
                }
            }
        for (int part = 0; part < 2; ++part)
            for (int i = 0; i < b.n; ++i) {
                const float mean = sum[part][i] / total[i], square = squares[part][i] / total[i];
                in.variance[part][first + i] = std::max(square - mean * mean, 0.0f);
            }
    });
}

/// One pass: 5 × 5 pixels `step` apart.
void smooth(const Sights& s, int step, const LightPlanes& in, LightPlanes& out) {
    constexpr float kernel[3] = {0.375f, 0.25f, 0.0625f};
    constexpr float kStop = 2.5f;  // standard deviations of noise that still count as the same light
    for_blocks(s, [&](const Block& b) {
        const std::size_t first = b.first(s);
        std::array<float, kBlock> like{}, w{};
        std::array<std::array<float, kBlock>, 2> tolerance, total{}, spread{};
        std::array<std::array<float, kBlock>, 6> sum{};
        for (int part = 0; part < 2; ++part)
            for (int i = 0; i < b.n; ++i)
                tolerance[part][i] = 1.0f / (kStop * std::sqrt(in.variance[part][first + i]) + 2e-3f);
        for (int dj = -2; dj <= 2; ++dj)
            for (int di = -2; di <= 2; ++di) {
                const Neighbours to(s, b, di * step, dj * step);
                if (to.begin >= to.end) continue;
                if (di == 0 && dj == 0)
                    like.fill(1);
                else
                    find_likeness(s, first, to, static_cast<float>(1 + step), like.data());
                const float share = kernel[std::abs(di)] * kernel[std::abs(dj)];
                for (int part = 0; part < 2; ++part) {
                    const float *l = &in.luma[part][first], *l_there = in.luma[part].data() + first + to.offset,
                                *variance = in.variance[part].data() + first + to.offset;
                    for (int i = to.begin; i < to.end; ++i)
                        w[i] = share * like[i] * exp_minus(std::abs(l_there[i] - l[i]) * tolerance[part][i]);
                    for (int i = to.begin; i < to.end; ++i) {
                        total[part][i] += w[i];
                        spread[part][i] += w[i] * w[i] * variance[i];
                    }
                    for (int c = 3 * part; c < 3 * part + 3; ++c) {
                        const float* there = in.light[c].data() + first + to.offset;
                        for (int i = to.begin; i < to.end; ++i) sum[c][i] += w[i] * there[i];
                    }
                }
            }
        for (int part = 0; part < 2; ++part)
            for (int i = 0; i < b.n; ++i)
                out.variance[part][first + i] = spread[part][i] / (total[part][i] * total[part][i]);
        for (int i = 0; i < b.n; ++i)
            out.set(first + i, {{sum[0][i] / total[0][i], sum[1][i] / total[0][i], sum[2][i] / total[0][i]},
                                {sum[3][i] / total[1][i], sum[4][i] / total[1][i], sum[5][i] / total[1][i]}});
    });
}

bool is_same_surface(const ViewHit& a, const ViewHit& b, float reach) {
    if (a.kind != b.kind) return false;
    if (a.kind == HitKind::floor) return true;
    const Vec3f d = b.position - a.position;
    return glm::dot(a.normal, b.normal) >= kLeastCosine &&
           std::max(std::abs(glm::dot(a.normal, d)), std::abs(glm::dot(b.normal, d))) <= kMostOff * reach;
}

}  // namespace

void remove_specks(LightBuffer& buffer, const Camera& camera) {
    const float per_metre = static_cast<float>(2 * camera.tan_half_height / camera.height * buffer.step);
    std::vector<Light> out = buffer.light;
    parallel_for(buffer.hits.size(), 2048, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const ViewHit& s = buffer.hits[k];
            if (s.kind != HitKind::object) continue;
            const int x = static_cast<int>(k % buffer.width), y = static_cast<int>(k / buffer.width);
            const float reach = 2 * per_metre * glm::length(s.position - Vec3f(camera.eye));
            Vec2f most{0};
            for (int j = std::max(0, y - 1); j <= std::min(buffer.height - 1, y + 1); ++j)
                for (int i = std::max(0, x - 1); i <= std::min(buffer.width - 1, x + 1); ++i) {
                    const std::size_t q = static_cast<std::size_t>(j) * buffer.width + i;
                    if (q == k || !is_same_surface(s, buffer.hits[q], reach)) continue;
                    most = glm::max(most, Vec2f{luma(buffer.light[q].direct), luma(buffer.light[q].around)});
                }
            const Vec2f own{luma(out[k].direct), luma(out[k].around)};
            if (most.x > 0 && own.x > most.x) out[k].direct *= most.x / own.x;
            if (most.y > 0 && own.y > most.y) out[k].around *= most.y / own.y;
        }
    });
    buffer.light = std::move(out);
}

void smooth_light(LightBuffer& buffer, const Camera& camera) {
    constexpr int kPasses = 4;
    const Sights sights(buffer, camera);
    LightPlanes in(buffer.light.size()), out(buffer.light.size());
    for (std::size_t k = 0; k < buffer.light.size(); ++k) in.set(k, buffer.light[k]);
    set_local_variance(sights, in);
    for (int pass = 0; pass < kPasses; ++pass) {
        smooth(sights, 1 << pass, in, out);
        std::swap(in, out);
    }
    for (std::size_t k = 0; k < buffer.light.size(); ++k)
        buffer.light[k] = buffer.hits[k].kind == HitKind::backdrop ? Light{} : in.at(k);
}

}  // namespace tuft::render
