#pragma once

#include <cstdint>
#include <vector>

#include "core/system/progress.h"
#include "render/picture/camera.h"
#include "render/picture/light_cache.h"

/// \file
/// Light per pixel of a product picture: sampled sparsely, then smoothed over the picture with edges of objects and
/// shadows preserved. Called by picture.h.
namespace tuft::render {

/// What a ray meets.
enum class HitKind : std::uint8_t { backdrop, floor, object };

/// A surface seen through a picture position.
struct ViewHit {
    HitKind kind = HitKind::backdrop;
    std::uint32_t triangle = kNone;
    float b1 = 0, b2 = 0;   ///< barycentric weights of corners 1 and 2
    Vec3f position{0};      ///< metres, world
    Vec3f normal{0, 0, 1};  ///< unit, smooth, towards the eye
    Vec3f face{0, 0, 1};    ///< unit, of the flat triangle, towards the eye
};
ViewHit trace_view_ray(const Scene& scene, const Camera& camera, const Vec3f& direction);

/// Light at a point: from the boxes, and from everything else. On the floor both are
/// differences to the empty studio, so that they vanish where the object does nothing.
struct Light {
    Vec3f direct{0}, around{0};
};

/// Rays of one pixel, by what they look for.
struct LightSamples {
    std::array<int, 3> boxes{8, 3, 3};
    int around = 12;
    int on_floor = 4;  ///< times `boxes` on the floor, whose even grey shows most
};
/// Shares `total` rays among the kinds.
LightSamples share_samples(int total);

/// A pixel and the seed of the picture: together they fix the random numbers of the pixel.
struct PixelSeed {
    int x = 0, y = 0;  ///< from the upper left
    std::uint64_t seed = 0;
};

/// Returns a Monte Carlo estimate of the light at a sight of a pixel.
Light sample_light(const Scene& scene, const LightCache& cache, const ViewHit& at, const LightSamples& samples,
                   const PixelSeed& pixel);

/// Per pixel or per square of `step` × `step` pixels, at its middle; row-major from the top.
struct LightBuffer {
    int width = 0, height = 0;
    int step = 1;
    std::vector<ViewHit> hits;
    std::vector<Light> light;

    /// Light for any sight seen through (x, y) of the picture, from the squares round it that show the same
    /// surface. `pixel_size`: of the picture, metres at the sight. False when none does.
    bool find(float x, float y, const ViewHit& at, float pixel_size, Light& light) const;
};

/// Options of `fill_light_buffer`.
struct LightBufferOptions {
    LightSamples samples;
    std::uint64_t seed = 1;
    int step = 1;
    ProgressFn progress;
};

/// Samples the light of each pixel, or of every `step`-th one along both axes. The same for any number of threads.
LightBuffer fill_light_buffer(const Scene& scene, const LightCache& cache, const Camera& camera,
                              const LightBufferOptions& options);

/// Limits both parts of the light of each square to the brightest of the squares round it that show the same surface: a
/// single ray that met a bright spot leaves no speck.
void remove_specks(LightBuffer& buffer, const Camera& camera);

/// Edge-stopping à-trous smoothing ([Dammertz2010]; variance-guided as in
/// [Schied2017]) of both parts of the light. With l the luma of a part, σ² its variance over the 7 × 7 pixels of the
/// same surface, h the kernel (1/16, 1/4, 3/8, 1/4, 1/16) and q over 5 × 5 pixels s = 1, 2, 4, 8 apart, one pass each:
///
///     w(p, q) = h h g(p, q) e^(−|l_q − l_p| / (2.5 σ_p + 0.002)),  l'_p = Σ w l_q / Σ w,  σ'²_p = Σ w² σ²_q / (Σ w)²
///     g = (n_p · n_q)³² e^(−o²),  o = the farther of p and q off the other's tangent plane over 1 + s pixels
///
/// g is 0 between floor, object and backdrop, for n_p · n_q < 0.8 and o > 4, and 1 on the floor. e^x is exact to 3e-7.
void smooth_light(LightBuffer& buffer, const Camera& camera);

}  // namespace tuft::render
