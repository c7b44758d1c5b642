#include <algorithm>
#include <cmath>

#include "core/system/parallel.h"
#include "render/picture/light_buffer.h"

namespace tuft::render {
namespace {

float luma(const Vec3f& c) {
    return 0.25f * c.x + 0.5f * c.y + 0.25f * c.z;
}

/// Part of the geometric weight between two pixels: 0 across edges, 1 on one smooth surface.
float likeness(const ViewHit& a, const ViewHit& b, float reach) {
    if (a.kind != b.kind) return 0;
    if (a.kind == HitKind::floor) return 1;
    const float cosine = glm::dot(a.normal, b.normal);
    if (cosine < 0.8f) return 0;
    const Vec3f d = b.position - a.position;
    const float off = std::max(std::abs(glm::dot(a.normal, d)), std::abs(glm::dot(b.normal, d))) / reach;
    if (off > 4) return 0;
    const float c2 = cosine * cosine, c4 = c2 * c2, c8 = c4 * c4, c16 = c8 * c8;
    return c16 * c16 * std::exp(-off * off);
}

/// Mean and variance of each part over the 7 × 7 pixels of the same surface.
void local_variance(const LightBuffer& in, const Camera& camera, std::vector<Vec2f>& variance) {
    const float per_metre = static_cast<float>(2 * camera.tan_half_height / camera.height * in.step);
    parallel_for(in.hits.size(), 2048, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const ViewHit& s = in.hits[k];
            if (s.kind == HitKind::backdrop) continue;
            const int x = static_cast<int>(k % in.width), y = static_cast<int>(k / in.width);
            const float reach = 3 * per_metre * glm::length(s.position - Vec3f(camera.eye));
            float w_sum = 0;
            Vec2f sum{0}, sum2{0};
            for (int j = std::max(0, y - 3); j <= std::min(in.height - 1, y + 3); ++j)
                for (int i = std::max(0, x - 3); i <= std::min(in.width - 1, x + 3); ++i) {
                    const std::size_t q = static_cast<std::size_t>(j) * in.width + i;
                    const float w = likeness(s, in.hits[q], reach);
                    if (w <= 0) continue;
                    const Vec2f l{luma(in.light[q].direct), luma(in.light[q].around)};
                    w_sum += w;
                    sum += w * l;
                    sum2 += w * l * l;
                }
            const Vec2f mean = sum / w_sum;
            variance[k] = glm::max(sum2 / w_sum - mean * mean, Vec2f{0});
        }
    });
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
                    if (q == k || likeness(s, buffer.hits[q], reach) <= 0) continue;
                    most = glm::max(most, Vec2f{luma(buffer.light[q].direct), luma(buffer.light[q].around)});
                }
            const Vec2f own{luma(out[k].direct), luma(out[k].around)};
            if (most.x > 0 && own.x > most.x) out[k].direct *= most.x / own.x;
            if (most.y > 0 && own.y > most.y) out[k].around *= most.y / own.y;
        }
    });
    buffer.light = std::move(out);
}

void smooth_light(LightBuffer& buffer, std::vector<Vec2f>& variance, const Camera& camera) {
    constexpr float kernel[3] = {0.375f, 0.25f, 0.0625f};
    constexpr int kPasses = 4;
    constexpr float kStop = 2.5f;  // standard deviations of noise that still count as the same light
    local_variance(buffer, camera, variance);
    const float per_metre = static_cast<float>(2 * camera.tan_half_height / camera.height * buffer.step);
    std::vector<Light> out(buffer.light.size());
    std::vector<Vec2f> out_variance(variance.size());
    for (int pass = 0; pass < kPasses; ++pass) {
        const int step = 1 << pass;
        parallel_for(buffer.hits.size(), 2048, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const ViewHit& s = buffer.hits[k];
                if (s.kind == HitKind::backdrop) continue;
                const int x = static_cast<int>(k % buffer.width), y = static_cast<int>(k / buffer.width);
                const float reach = (1 + step) * per_metre * glm::length(s.position - Vec3f(camera.eye));
                const Vec2f centre{luma(buffer.light[k].direct), luma(buffer.light[k].around)};
                const Vec2f tolerance = 1.0f / (kStop * glm::sqrt(variance[k]) + 2e-3f);
                Light sum;
                Vec2f total{0}, spread{0};
                for (int dj = -2; dj <= 2; ++dj) {
                    const int j = y + dj * step;
                    if (j < 0 || j >= buffer.height) continue;
                    for (int di = -2; di <= 2; ++di) {
                        const int i = x + di * step;
                        if (i < 0 || i >= buffer.width) continue;
                        const std::size_t q = static_cast<std::size_t>(j) * buffer.width + i;
                        float w = kernel[std::abs(di)] * kernel[std::abs(dj)];
                        if (q != k) w *= likeness(s, buffer.hits[q], reach);
                        if (w <= 0) continue;
                        const Light& l = buffer.light[q];
                        const Vec2f gap = glm::abs(Vec2f{luma(l.direct), luma(l.around)} - centre) * tolerance;
                        const Vec2f weight = w * Vec2f{std::exp(-gap.x), std::exp(-gap.y)};
                        sum.direct += weight.x * l.direct;
                        sum.around += weight.y * l.around;
                        total += weight;
                        spread += weight * weight * variance[q];
                    }
                }
                out[k].direct = sum.direct / total.x;
                out[k].around = sum.around / total.y;
                out_variance[k] = spread / (total * total);
            }
        });
        std::swap(buffer.light, out);
        std::swap(variance, out_variance);
    }
}

}  // namespace tuft::render
