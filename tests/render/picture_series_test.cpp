#include "render/picture/picture_series.h"

#include <gtest/gtest.h>

#include <numbers>

#include "brush/tuft/tuft.h"
#include "render/picture/brush_in_picture.h"
#include "render/picture/camera_path.h"

namespace tuft::render {
namespace {

constexpr std::uint32_t kSize = 128;  // texels

/// A trough: two square walls of 100 mm that meet at a right angle and mirror each other. UVs: one half each.
mesh::TriangleMesh make_trough() {
    mesh::TriangleMesh m;
    const auto wall = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d, float u) {
        const auto base = static_cast<std::uint32_t>(m.positions.size());
        m.positions.insert(m.positions.end(), {a, b, c, d});
        m.triangles.push_back({base, base + 1, base + 2});
        m.triangles.push_back({base, base + 2, base + 3});
        m.corner_normals.insert(m.corner_normals.end(), 6, glm::normalize(glm::cross(b - a, c - a)));
        for (const Vec2f& uv : {Vec2f{0, 0}, Vec2f{0.5f, 0}, Vec2f{0.5f, 1}, Vec2f{0, 0}, Vec2f{0.5f, 1}, Vec2f{0, 1}})
            m.corner_uvs.push_back(uv + Vec2f{u, 0});
    };
    wall({-0.1f, 0, 0.1f}, {-0.1f, -0.1f, 0.1f}, {0, -0.1f, 0}, {0, 0, 0}, 0);
    wall({0, 0, 0}, {0, -0.1f, 0}, {0.1f, -0.1f, 0.1f}, {0.1f, 0, 0.1f}, 0.5f);
    m.neighbours.assign(3 * m.n_triangles(), kNone);
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    return m;
}

struct Painted {
    mesh::TriangleMesh mesh = make_trough();
    mesh::SurfaceQuery query{mesh};
    std::vector<Vec3f> bare = std::vector<Vec3f>(kSize * kSize, Vec3f{0.8f});

    Appearance with(const std::vector<Vec3f>& map) const {
        Appearance a;
        a.maps = {.size = kSize, .corner_uvs = mesh.corner_uvs, .base_colour = map};
        return a;
    }
    static PictureOptions options() {
        PictureOptions o;
        o.width = 120;
        o.height = 90;
        o.view.elevation = 0.7;
        o.light_samples = 8;
        return o;
    }
};

/// Paints tile (x, y) of 16 × 16 texels.
void paint_tile(std::vector<Vec3f>& map, std::uint32_t x, std::uint32_t y) {
    for (std::uint32_t j = 0; j < 16; ++j)
        for (std::uint32_t i = 0; i < 16; ++i) map[(16 * y + j) * kSize + 16 * x + i] = {0.02f, 0.03f, 0.3f};
}

TEST(PictureSeries, RedrawsOnlyWhatReadsAChangedTileAndGetsTheBitsOfAWholePicture) {
    const Painted p;
    const Appearance lit = p.with(p.bare);
    std::vector<Vec3f> map = p.bare;
    PictureSeries series(p.mesh, p.query, lit, Painted::options());
    series.draw(lit);
    EXPECT_EQ(series.drawn_pixels(), 120u * 90u);
    for (std::uint32_t step = 0; step < 6; ++step) {
        const std::uint32_t x = 1 + step, y = 2 + step % 3;  // over the fold: seen, and mirrored by the other wall
        paint_tile(map, x, y);
        const Appearance now = p.with(map);
        const std::uint32_t changed[] = {y * (kSize / 16) + x};
        const Image image = series.draw(now, changed);
        EXPECT_GT(series.drawn_pixels(), 0u);
        EXPECT_LT(series.drawn_pixels(), 120u * 90u / 4);  // one of 64 tiles, its mirror image, and edges round them
        PictureSeries whole(p.mesh, p.query, lit, Painted::options());
        ASSERT_EQ(image.rgb, whole.draw(now).rgb) << step;
    }
    series.draw(p.with(map), {});
    EXPECT_EQ(series.drawn_pixels(), 0u);
}

TEST(PictureSeries, EndsWithThePictureOfItsLight) {
    const Painted p;
    std::vector<Vec3f> map = p.bare;
    paint_tile(map, 3, 3);
    const Appearance finished = p.with(map);
    PictureSeries series(p.mesh, p.query, finished, Painted::options());
    series.draw(p.with(p.bare));
    const std::uint32_t changed[] = {3 * (kSize / 16) + 3};
    EXPECT_EQ(series.draw(finished, changed).rgb, render_picture(p.mesh, p.query, finished, Painted::options()).rgb);
}

TEST(PictureSeries, ThatMovedDrawsThePictureOfItsNewView) {
    const Painted p;
    std::vector<Vec3f> map = p.bare;
    paint_tile(map, 3, 3);
    const Appearance lit = p.with(map);
    PictureSeries moving(p.mesh, p.query, lit, Painted::options(), PictureSeries::Length::moving);
    PictureOptions options = Painted::options();
    for (int turn = 0; turn < 3; ++turn) {
        options.view.azimuth += 0.4;
        moving.look_from(options.view);
        const Image moved = moving.draw(lit), whole = render_picture(p.mesh, p.query, lit, options);
        // The dome's light is scaled, not summed anew: rounding.
        for (std::size_t i = 0; i < whole.rgb.size(); ++i) ASSERT_NEAR(moved.rgb[i], whole.rgb[i], 1) << i;
    }
}

// Codes from a picture of many samples, on average over pixels and channels: interpolated light, of fewer rays, is as
// near to it as that of each pixel.
TEST(PictureSeries, LightInterpolatedBetweenPixelsIsThatOfThePixels) {
    const Painted p;
    const Appearance lit = p.with(p.bare);
    PictureOptions options = Painted::options();
    options.width = 240;
    options.height = 180;
    options.light_samples = 256;
    const Image truth = render_picture(p.mesh, p.query, lit, options);
    options.light_samples = 16;
    options.light_step = 2;
    options.edge_samples = 4;
    const Image quick = render_picture(p.mesh, p.query, lit, options);
    double sum = 0;
    for (std::size_t i = 0; i < truth.rgb.size(); ++i) sum += std::abs(truth.rgb[i] - quick.rgb[i]);
    EXPECT_LT(sum / static_cast<double>(truth.rgb.size()), 1.0);  // of which the dither makes up to half
}

TEST(CameraPath, IsAtItsKeysAndStandsBetweenEqualOnes) {
    const mesh::TriangleMesh m = make_trough();
    View front, top;
    top.elevation = 1.5;
    View near = front;
    near.target = Vec3{0, -0.05, 0};
    near.distance = 0.2;
    const CameraPath path = standing_path({front, near, top});
    EXPECT_EQ(view_at(path, 0, 120, 90, m.positions), front);
    EXPECT_EQ(view_at(path, 0.2, 120, 90, m.positions), front);
    EXPECT_EQ(view_at(path, 0.5, 120, 90, m.positions), near);
    EXPECT_EQ(view_at(path, 1, 120, 90, m.positions), top);
    // Between: no jump. A step of 1e-4 of the film moves the eye, some 0.4 m in 1/12 of it, by 1.5 · 0.5 mm at most.
    Camera before = make_camera(view_at(path, 0, 120, 90, m.positions), 120, 90, m.positions);
    for (int k = 1; k <= 10'000; ++k) {
        const Camera now = make_camera(view_at(path, 1e-4 * k, 120, 90, m.positions), 120, 90, m.positions);
        ASSERT_LT(glm::length(now.eye - before.eye), 2e-3) << k;
        before = now;
    }
}

TEST(CameraPath, TurntableTurnsOnceAndEndsAtItsView) {
    View view;
    const CameraPath path = turntable_path(view);
    EXPECT_EQ(view_at(path, 1, 120, 90, {}), view);
    EXPECT_DOUBLE_EQ(view_at(path, 0.25, 120, 90, {}).azimuth, view.azimuth + 1.5 * std::numbers::pi);
}

TEST(BrushInPicture, IsSeenBeforeTheModelAndHiddenBehindIt) {
    const Painted p;
    const Camera camera = make_camera(Painted::options().view, 120, 90, p.mesh.positions);
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("wolf-small"));
    const auto changed = [&](const Vec3& at) {
        const brush::TuftState state = brush::step(tuft, {.position = at}, {}, 0);
        Image image{120, 90, std::vector<std::uint8_t>(3 * 120 * 90, 200)};
        draw_brush_in_picture(image, camera, p.query, tuft, state, 0.002);
        return std::count_if(image.rgb.begin(), image.rgb.end(), [](std::uint8_t c) { return c != 200; });
    };
    const Vec3 middle{-0.05, -0.05, 0.05};  // of the left wall, which faces the camera
    const Vec3 away = glm::normalize(camera.eye - middle);
    const Vec3 half{0, 0, 0.5 * tuft.preset.length};
    EXPECT_GT(changed(middle + 0.04 * away + half), 100);
    EXPECT_EQ(changed(middle - 0.04 * away + half), 0);
}

}  // namespace
}  // namespace tuft::render
