#include "render/picture/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/hash.h"
#include "core/random.h"
#include "core/system/parallel.h"
#include "render/picture/light_buffer.h"
#include "render/picture/sampling.h"

namespace tuft::render {
namespace {

/// Sphere of radius 50 mm that stands on z = 0, smooth normals, UVs by longitude and height.
mesh::TriangleMesh make_sphere(int rings = 32) {
    mesh::TriangleMesh m;
    const int around = 2 * rings;
    const double r = 0.05;
    const auto point = [&](int i, int j) {
        const double theta = std::numbers::pi * j / rings, phi = 2 * std::numbers::pi * i / around;
        return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    };
    for (int j = 0; j <= rings; ++j)
        for (int i = 0; i < around; ++i) m.positions.emplace_back(r * point(i, j) + Vec3{0, 0, r});
    for (int j = 0; j < rings; ++j)
        for (int i = 0; i < around; ++i) {
            const std::uint32_t a = j * around + i, b = j * around + (i + 1) % around;
            const std::uint32_t c = a + around, d = b + around;
            const auto add = [&](std::uint32_t p, std::uint32_t q, std::uint32_t s, std::array<Vec2, 3> uv) {
                m.triangles.push_back({p, q, s});
                for (const std::uint32_t v : {p, q, s})
                    m.corner_normals.emplace_back(glm::normalize(Vec3(m.positions[v]) - Vec3{0, 0, r}));
                for (const Vec2& at : uv) m.corner_uvs.emplace_back(at);
            };
            const double u0 = double(i) / around, u1 = double(i + 1) / around, v0 = 1 - double(j) / rings,
                         v1 = 1 - double(j + 1) / rings;
            if (j + 1 < rings) add(a, c, d, {Vec2{u0, v0}, Vec2{u0, v1}, Vec2{u1, v1}});
            if (j > 0) add(a, d, b, {Vec2{u0, v0}, Vec2{u1, v1}, Vec2{u1, v0}});
        }
    m.neighbours.assign(3 * m.n_triangles(), 0);
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    return m;
}

double grey(const Image& image, int x, int y) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return -1;
    return image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x) + 1];
}

TEST(Sampling, CosineDirectionsHaveTheirMoments) {
    // With density cos θ/π the mean of cos θ is 2/3 and that of the sideways parts 0.
    const Vec3f n = glm::normalize(Vec3f{0.3f, -0.5f, -0.8f});
    Vec3f sum{0};
    for (std::uint32_t i = 0; i < 1024; ++i) sum += cosine_direction(n, sobol_point(i));
    EXPECT_NEAR(glm::length(sum / 1024.0f - n * (2.0f / 3)), 0, 2e-3);  // stratified: about 1/N
}

TEST(Sampling, SobolPointsFillEveryElementaryInterval) {
    for (int split = 0; split <= 8; ++split) {
        std::vector<int> count(256, 0);
        for (std::uint32_t i = 0; i < 256; ++i) {
            const Vec2f p = sobol_point(i);
            ++count[static_cast<int>(p.x * (1 << split)) * (256 >> split) + static_cast<int>(p.y * (256 >> split))];
        }
        for (const int c : count) EXPECT_EQ(c, 1);
    }
}

TEST(Material, BilinearLookupIsExactOnLinearMaps) {
    const mesh::TriangleMesh m = make_sphere(8);
    constexpr std::uint32_t kTexelsAcross = 64;
    std::vector<Vec3f> map(kTexelsAcross * kTexelsAcross);
    for (std::uint32_t y = 0; y < kTexelsAcross; ++y)
        for (std::uint32_t x = 0; x < kTexelsAcross; ++x)
            map[y * kTexelsAcross + x] = {(x + 0.5f) / kTexelsAcross, (y + 0.5f) / kTexelsAcross, 0.25f};
    Appearance a;
    a.maps = {.size = kTexelsAcross, .corner_uvs = m.corner_uvs, .base_colour = map};
    const MaterialReader reader(m, a);
    for (std::uint32_t t = 20; t < 60; ++t) {
        const float b1 = 0.3f, b2 = 0.4f;
        const Vec2f uv = 0.3f * m.corner_uvs[3 * t] + b1 * m.corner_uvs[3 * t + 1] + b2 * m.corner_uvs[3 * t + 2];
        const Vec3f c = reader.albedo(t, b1, b2);
        if (uv.x < 0.02f || uv.x > 0.98f) continue;  // the border texels are constant
        EXPECT_NEAR(c.x, uv.x, 1e-5);
        EXPECT_NEAR(c.y, uv.y, 1e-5);
        EXPECT_NEAR(c.z, 0.25, 1e-6);
    }
}

TEST(Material, ReliefGivesTheSlopeOfARamp) {
    // One 10 mm × 10 mm right triangle that spans half the texture; height rises 0.2 m per metre in
    // x.
    mesh::TriangleMesh m;
    m.positions = {{0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0}};
    m.triangles = {{0, 1, 2}};
    m.corner_normals.assign(3, Vec3f{0, 0, 1});
    m.corner_uvs = {{0, 0}, {0, 1}, {1, 0}};  // turned: u runs along y
    constexpr std::uint32_t kTexelsAcross = 32;
    std::vector<float> height(kTexelsAcross * kTexelsAcross);
    for (std::uint32_t y = 0; y < kTexelsAcross; ++y)
        for (std::uint32_t x = 0; x < kTexelsAcross; ++x)
            height[y * kTexelsAcross + x] = 0.2f * 0.01f * (y + 0.5f) / kTexelsAcross;
    Appearance a;
    a.maps = {.size = kTexelsAcross, .corner_uvs = m.corner_uvs, .height = height};
    const Vec3f slope = MaterialReader(m, a).read(0, 0.3f, 0.3f).slope;
    EXPECT_NEAR(slope.x, 0.2, 1e-5);
    EXPECT_NEAR(slope.y, 0, 1e-5);
    EXPECT_NEAR(slope.z, 0, 1e-5);
}

TEST(Material, SrgbRoundTripAndKnownValues) {
    for (int i = 0; i <= 255; ++i) EXPECT_NEAR(encode_srgb(decode_srgb(i / 255.0f)) * 255, i, 1e-3);
    EXPECT_NEAR(decode_srgb(0.5f), 0.2140411, 1e-6);  // IEC 61966-2-1
}

TEST(Material, RefusesMapsThatDoNotFit) {
    const mesh::TriangleMesh m = make_sphere(8);
    const std::vector<Vec3f> map(10);
    Appearance a;
    a.maps = {.size = 4, .corner_uvs = m.corner_uvs, .base_colour = map};
    EXPECT_THROW(MaterialReader(m, a), Error);
    const std::vector<Vec3f> fits(16);
    a.maps = {.size = 4, .base_colour = fits};
    EXPECT_THROW(MaterialReader(m, a), Error);
}

TEST(Light, NothingShadesAConvexBody) {
    // Without a floor a sphere cannot see itself: each point gets the light of the open studio.
    const mesh::TriangleMesh m = make_sphere(96);
    const mesh::SurfaceQuery query(m);
    const Appearance a;
    const MaterialReader material(m, a);
    Scene scene{m, query, material, make_studio(m.bounds, 0.3, 0, false, 1), 2e-6f};
    const LightCache cache(scene);
    for (std::uint32_t t = 500; t < m.n_triangles(); t += 1111) {
        ViewHit s;
        s.kind = HitKind::object;
        s.triangle = t;
        s.face = face_normal(m, t);
        s.normal = s.face;
        s.position = Vec3f(mesh::surface_point(m, t, 1.0 / 3, 1.0 / 3).position);
        Light sum;
        for (int i = 0; i < 16; ++i) {
            const Light l = sample_light(scene, cache, s, share_samples(400), {i, 3 * i, 5});
            sum.direct += l.direct / 16.0f;
            sum.around += l.around / 16.0f;
        }
        const Vec3f expected = open_light(scene.studio, s.position, s.face);
        // 64 against 6400 points of a low-discrepancy sum; the triangle's neighbours hide at most
        // 1e-3.
        EXPECT_NEAR(sum.direct.y + sum.around.y, expected.y, 0.015);
        EXPECT_NEAR(cache.object_light(s.position, s.face).y, expected.y,
                    0.06);  // patches of 1/64 of the size
    }
}

TEST(Light, ClosedHollowIsDark) {
    mesh::TriangleMesh m = make_sphere(24);
    for (auto& t : m.triangles) std::swap(t[1], t[2]);  // seen from inside
    for (Vec3f& n : m.corner_normals) n = -n;
    const mesh::SurfaceQuery query(m);
    const Appearance a;
    const MaterialReader material(m, a);
    Scene scene{m, query, material, make_studio(m.bounds, 0, 0, true, 1), 2e-6f};
    const LightCache cache(scene);
    const Vec3f light = cache.object_light({0, 0, 0}, {0, 0, 1});
    EXPECT_NEAR(light.x + light.y + light.z, 0, 1e-6);
}

TEST(Picture, SameBitsForAnyThreadCount) {
    const mesh::TriangleMesh m = make_sphere(20);
    const mesh::SurfaceQuery query(m);
    PictureOptions o;
    o.width = 120;
    o.height = 80;
    std::uint64_t first = 0;
    for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        const Image image = render_picture(m, query, {}, o);
        const std::uint64_t hash = hash_span<std::uint8_t>(image.rgb);
        if (threads == 1) first = hash;
        EXPECT_EQ(hash, first);
    }
    set_thread_count(0);
}

TEST(Picture, NoVisibleNoise) {
    const mesh::TriangleMesh m = make_sphere(48);
    const mesh::SurfaceQuery query(m);
    PictureOptions o;
    o.width = 240;
    o.height = 160;
    const Image one = render_picture(m, query, {}, o);
    o.seed = 99;
    const Image two = render_picture(m, query, {}, o);
    double sum2 = 0;
    int worst = 0;
    for (std::size_t i = 0; i < one.rgb.size(); ++i) {
        const int d = std::abs(one.rgb[i] - two.rgb[i]);
        sum2 += d * d;
        worst = std::max(worst, d);
    }
    // Rounding with dither alone gives 0.4; a difference of 1.2 codes rms cannot be seen. The worst
    // pixels lie on the silhouette, where rays are drawn until their halves agree within 5 codes.
    EXPECT_LT(std::sqrt(sum2 / static_cast<double>(one.rgb.size())), 1.2);
    EXPECT_LT(worst, 15);
}

/// A plate that faces the camera, and before it upright wires, ever more oblique, a third of a
/// pixel thick.
mesh::TriangleMesh make_wires() {
    mesh::TriangleMesh m;
    const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        const auto base = static_cast<std::uint32_t>(m.positions.size());
        for (const Vec3& p : {a, b, c, d}) m.positions.emplace_back(p);
        m.triangles.push_back({base, base + 1, base + 2});
        m.triangles.push_back({base, base + 2, base + 3});
        m.corner_normals.insert(m.corner_normals.end(), 6, Vec3f(glm::normalize(glm::cross(b - a, c - a))));
    };
    quad({-0.05, 0, 0}, {0.05, 0, 0}, {0.05, 0, 0.06}, {-0.05, 0, 0.06});
    constexpr double kThick = 1.5e-4;
    for (int i = 0; i < 10; ++i) {
        const Vec3 foot(-0.045 + 0.009 * i, -0.002, 0.004), top = foot + Vec3(0.0007 * i, 0, 0.05);
        const Vec3 corner[4] = {{0, -kThick, 0}, {kThick, 0, 0}, {0, kThick, 0}, {-kThick, 0, 0}};
        for (int k = 0; k < 4; ++k)
            quad(foot + corner[k], foot + corner[(k + 1) % 4], top + corner[(k + 1) % 4], top + corner[k]);
    }
    m.neighbours.assign(3 * m.n_triangles(), kNone);
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    return m;
}

// A highlight or a gap thinner than a pixel shows as a line, not as a row of specks: its pixels
// have the same code whichever rays chance chooses.
TEST(Picture, ThinLightsAreNoSpecks) {
    const mesh::TriangleMesh m = make_wires();
    const mesh::SurfaceQuery query(m);
    for (const Finish finish : {Finish::porcelain, Finish::clay}) {
        Appearance a;
        a.finish = finish;
        PictureOptions o;
        o.width = 240;
        o.height = 160;
        const Image one = render_picture(m, query, a, o);
        o.seed = 99;
        const Image two = render_picture(m, query, a, o);
        int specks = 0;
        for (std::size_t i = 0; i < one.rgb.size(); i += 3) specks += std::abs(one.rgb[i + 1] - two.rgb[i + 1]) > 12;
        // Both halves of a pixel's rays agree within 5 codes, so that their mean is some 2 codes
        // off; light adds 2.
        EXPECT_LE(specks, 4) << (finish == Finish::clay ? "clay" : "porcelain");
    }
}

TEST(Picture, DrawsAnyMeshFromAnywhere) {
    mesh::TriangleMesh empty;
    mesh::TriangleMesh flake;  // one triangle far from the origin
    flake.positions = {{1000, 1000, 5}, {1000.1f, 1000, 5}, {1000, 1000.1f, 5}};
    flake.triangles = {{0, 1, 2}};
    flake.corner_normals.assign(3, Vec3f{0, 0, 1});
    flake.neighbours.assign(3, kNone);
    for (const Vec3f& p : flake.positions) flake.bounds.add(Vec3(p));
    const mesh::TriangleMesh sphere = make_sphere(6);
    for (const mesh::TriangleMesh* m : std::initializer_list<const mesh::TriangleMesh*>{&empty, &flake, &sphere}) {
        const mesh::SurfaceQuery query(*m);
        for (const double elevation : {-1.5, -0.2, 0.0, 1.57})
            for (const int width : {1, 33}) {
                PictureOptions o;
                o.width = width;
                o.height = 17;
                o.floor = width > 1 || elevation > 0;
                o.view.elevation = elevation;
                const Image image = render_picture(*m, query, {}, o);
                EXPECT_EQ(image.rgb.size(), 3u * width * 17);
            }
    }
    PictureOptions inside;
    inside.width = inside.height = 16;
    inside.view.target = Vec3{0, 0, 0.05};
    inside.view.distance = 0.01;
    const mesh::SurfaceQuery query(sphere);
    const Image dark = render_picture(sphere, query, {}, inside);
    EXPECT_LE(*std::max_element(dark.rgb.begin(), dark.rgb.end()), 2);  // no light gets in
}

TEST(Picture, TextureIsWhereItsUvsSayAndTheFloorIsDarkUnderTheObject) {
    const mesh::TriangleMesh m = make_sphere(48);
    const mesh::SurfaceQuery query(m);
    constexpr std::uint32_t kTexelsAcross = 64;
    std::vector<Vec3f> map(kTexelsAcross * kTexelsAcross, Vec3f{0.8f});
    for (std::uint32_t y = 0; y < kTexelsAcross; ++y)
        for (std::uint32_t x = 0; x < kTexelsAcross; ++x)
            if (y >= kTexelsAcross / 2) map[y * kTexelsAcross + x] = Vec3f{0.02f};  // upper half of the sphere is black
    Appearance a;
    a.finish = Finish::clay;
    a.maps = {.size = kTexelsAcross, .corner_uvs = m.corner_uvs, .base_colour = map};
    PictureOptions o;
    o.width = 240;
    o.height = 180;
    o.view.elevation = 0.2;
    const Image image = render_picture(m, query, a, o);
    const Camera camera = make_camera(o.view, o.width, o.height, m.positions);
    const auto at = [&](const Vec3& p) {
        const auto q = project(camera, p);
        return grey(image, static_cast<int>(q->x), static_cast<int>(q->y));
    };
    const Vec3 towards = -camera.forward;
    const Vec3 side = glm::normalize(Vec3{towards.x, towards.y, 0});
    const Vec3 centre{0, 0, 0.05};
    EXPECT_LT(at(centre + 0.05 * glm::normalize(side + Vec3{0, 0, 0.5})), 80);
    EXPECT_GT(at(centre + 0.05 * glm::normalize(side - Vec3{0, 0, 0.1})), 110);
    // The open floor shows the backdrop itself; at the foot of the sphere it is darker.
    const Vec3f open = backdrop(0.02f, 0.97f);
    EXPECT_NEAR(grey(image, static_cast<int>(0.02 * 240), static_cast<int>(0.97 * 180)), 255 * encode_srgb(open.y), 6);
    const auto foot = project(camera, 0.012 * side);
    const Vec3f behind = backdrop(static_cast<float>(foot->x) / 240, static_cast<float>(foot->y) / 180);
    EXPECT_GE(at(0.012 * side), 0);
    EXPECT_LT(at(0.012 * side), 0.75 * 255 * encode_srgb(behind.y));
}

/// Light of random noise on two planes that meet in a ridge, over a floor and a backdrop.
LightBuffer noisy_ridge(const Camera& camera) {
    LightBuffer buffer{.width = camera.width, .height = camera.height, .hits = {}, .light = {}};
    Random random(7);
    for (int y = 0; y < buffer.height; ++y)
        for (int x = 0; x < buffer.width; ++x) {
            const Vec3f right = glm::normalize(Vec3f(0.4f, -1, 0)), left = glm::normalize(Vec3f(-0.3f, -1, 0));
            const float at = 1e-3f * static_cast<float>(x - 80);
            ViewHit hit;
            hit.kind = y < 3 ? HitKind::backdrop : y > 14 ? HitKind::floor : HitKind::object;
            hit.normal = hit.kind == HitKind::floor ? Vec3f(0, 0, 1) : x < 80 ? left : right;
            hit.position = {at, std::abs(at) * (x < 80 ? 0.3f : 0.4f), 1e-3f * static_cast<float>(10 - y)};
            buffer.hits.push_back(hit);
            Light light;
            for (int c = 0; c < 3; ++c) {
                light.direct[c] = static_cast<float>(0.5 + (x > 30) + 0.2 * random.uniform());
                light.around[c] = static_cast<float>(0.1 * random.uniform());
            }
            buffer.light.push_back(light);
        }
    return buffer;
}

/// The formula of `smooth_light`, term by term.
std::vector<std::array<double, 6>> smoothed(const LightBuffer& in, const Camera& camera) {
    const int n = in.width * in.height;
    const auto luma = [](const std::array<double, 6>& l, int p) {
        return 0.25 * l[3 * p] + 0.5 * l[3 * p + 1] + 0.25 * l[3 * p + 2];
    };
    const auto likeness = [&](int p, int q, double pixels) {
        const ViewHit &a = in.hits[p], &b = in.hits[q];
        if (a.kind != b.kind) return 0.0;
        if (a.kind != HitKind::object) return 1.0;
        const Vec3 u(a.normal), v(b.normal), d = Vec3(b.position) - Vec3(a.position);
        const double size = 2 * camera.tan_half_height / camera.height * glm::distance(Vec3(a.position), camera.eye);
        const double off = std::max(std::abs(glm::dot(u, d)), std::abs(glm::dot(v, d))) / (pixels * size);
        const double cosine = glm::dot(u, v);
        return cosine < 0.8 || off > 4 ? 0.0 : std::pow(cosine, 32) * std::exp(-off * off);
    };
    const auto for_square = [&](int k, int radius, int step, const auto& visit) {
        for (int j = -radius; j <= radius; ++j)
            for (int i = -radius; i <= radius; ++i) {
                const int x = k % in.width + i * step, y = k / in.width + j * step;
                if (x >= 0 && y >= 0 && x < in.width && y < in.height) visit(y * in.width + x, i, j);
            }
    };
    std::vector<std::array<double, 6>> light(n);
    std::vector<std::array<double, 2>> variance(n);
    for (int k = 0; k < n; ++k)
        for (int c = 0; c < 3; ++c) light[k][c] = in.light[k].direct[c], light[k][3 + c] = in.light[k].around[c];
    for (int k = 0; k < n; ++k)
        for (int p = 0; p < 2; ++p) {
            double w = 0, sum = 0, squares = 0;
            for_square(k, 3, 1, [&](int q, int, int) {
                const double g = likeness(k, q, 3), l = luma(light[q], p);
                w += g, sum += g * l, squares += g * l * l;
            });
            variance[k][p] = std::max(0.0, squares / w - sum / w * (sum / w));
        }
    constexpr double kernel[3] = {0.375, 0.25, 0.0625};
    for (const int step : {1, 2, 4, 8}) {
        const auto before = light;
        const auto spread_before = variance;
        for (int k = 0; k < n; ++k)
            for (int p = 0; p < 2; ++p) {
                double total = 0, spread = 0;
                std::array<double, 3> sum{};
                for_square(k, 2, step, [&](int q, int i, int j) {
                    const double gap = std::abs(luma(before[q], p) - luma(before[k], p));
                    const double w = kernel[std::abs(i)] * kernel[std::abs(j)] *
                                     (q == k ? 1 : likeness(k, q, 1 + step)) *
                                     std::exp(-gap / (2.5 * std::sqrt(spread_before[k][p]) + 2e-3));
                    total += w, spread += w * w * spread_before[q][p];
                    for (int c = 0; c < 3; ++c) sum[c] += w * before[q][3 * p + c];
                });
                for (int c = 0; c < 3; ++c) light[k][3 * p + c] = sum[c] / total;
                variance[k][p] = spread / (total * total);
            }
    }
    return light;
}

TEST(LightBuffer, IsSmoothedByItsFormula) {
    Camera camera;
    camera.eye = {0, -0.5, 0};
    camera.width = 131, camera.height = 18;  // two blocks of pixels side by side and a part of one
    LightBuffer buffer = noisy_ridge(camera);
    const auto want = smoothed(buffer, camera);
    smooth_light(buffer, camera);
    for (std::size_t k = 0; k < want.size(); ++k)
        for (int c = 0; c < 6; ++c) {
            if (buffer.hits[k].kind == HitKind::backdrop) continue;
            const float got = c < 3 ? buffer.light[k].direct[c] : buffer.light[k].around[c - 3];
            // Variances are differences of squares, off by 1e-6 in floats, which counts where they are small.
            ASSERT_NEAR(got, want[k][c], 2e-4) << k << " " << c;
        }
}

}  // namespace
}  // namespace tuft::render
