#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "app/display.h"
#include "app/texture.h"
#include "models.h"
#include "render/gl_view.h"

namespace tuft::app {
namespace {

constexpr int kWidth = 320, kHeight = 240;

class Gl : public testing::Test {
  protected:
    void SetUp() override {
        try {
            display_ = open_offscreen(kWidth, kHeight);
        } catch (const Error& error) {
            GTEST_SKIP() << "no OpenGL here: " << error.what();
        }
    }
    void TearDown() override { display_.reset(); }
    std::unique_ptr<Display> display_;
};

std::array<std::uint8_t, 3> encoded(const Vec3f& light) {
    std::array<std::uint8_t, 3> out;
    for (int k = 0; k < 3; ++k)
        out[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(255 * ink::srgb_encode(glm::clamp(light[k], 0.0f, 1.0f))));
    return out;
}

mesh::TriangleMesh facing_square(const Vec3f& normal) {
    mesh::TriangleMesh m;
    m.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    m.triangles = {{0, 1, 2}, {0, 2, 3}};
    m.corner_normals.assign(6, normal);
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    return m;
}

TEST_F(Gl, ShadersAgreeWithTheirTwinOnTheProcessor) {
    render::GlScene scene;
    render::MapPixels map{.size = 16};
    const std::array<std::uint8_t, 4> colour{180, 90, 40, 0};
    for (std::size_t level = 0; level < render::kTextureLevels; ++level)
        map.levels[level].assign((16u >> level) * (16u >> level), colour);
    scene.set_texture(map);
    const Vec3f base(ink::srgb_decode(180 / 255.0f), ink::srgb_decode(90 / 255.0f), ink::srgb_decode(40 / 255.0f));
    render::GlCamera c{.eye = {0, -3, 0}, .near = 0.1, .far = 10, .width = kWidth, .height = kHeight};
    render::GlTarget target;
    target.resize(kWidth, kHeight, 0);
    for (const Vec3f& n : {Vec3f(0, -1, 0), Vec3f(0.6f, -0.8f, 0), Vec3f(-0.3f, -0.5f, 0.8f)})
        for (const render::LightRig rig : {render::LightRig::studio, render::LightRig::window, render::LightRig::raking})
            for (const float roughness : {0.05f, 0.5f, 0.9f})
                for (const double parallel : {0.0, 2.5}) {
                    const Vec3f normal = glm::normalize(n);
                    scene.set_mesh(facing_square(normal), {});
                    c.parallel_height = parallel;
                    render::GlLight light = render::make_light(rig, c);
                    light.relief = 0;
                    target.bind();
                    const render::PixelRect all{0, 0, kWidth, kHeight};
                    scene.draw_backdrop(c, Vec3f(0), Vec3f(0), all);
                    scene.draw_model(c, light, {.roughness = roughness}, all);
                    for (const auto& [x, y] : {std::pair{160, 120}, std::pair{130, 100}}) {
                        const std::vector<std::uint8_t> pixel = render::read_pixels(x, kHeight - 1 - y, 1, 1);
                        const render::GlRay ray = render::ray_at(c, x + 0.5, y + 0.5);
                        const auto want = encoded(render::glazed(light, base, normal, Vec3f(-ray.direction), roughness));
                        // One step of eight bits for rounding, one for the GPU's single precision and its texture decoding.
                        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(pixel[k], want[k], 2) << "channel " << k << " roughness " << roughness;
                    }
                }
}

class Painted : public Gl {
  protected:
    void compare(const stroke::Model& model);
    // Mean and greatest difference of two pictures.
    static std::pair<double, int> difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
        double sum = 0;
        int most = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const int d = std::abs(a[i] - b[i]);
            sum += d;
            most = std::max(most, d);
        }
        return {sum / static_cast<double>(a.size()), most};
    }
};

void Painted::compare(const stroke::Model& model) {
    stroke::Painting painting(model);
    Texture texture(painting);
    render::GlScene scene;
    scene.set_mesh(*model.mesh, model.atlas.corner_uvs);
    scene.set_texture(texture.pixels());
    const Box& b = model.mesh->bounds;
    render::GlView::Frame frame{.camera = {.eye = b.centre() + Vec3(0, -0.15, 0.3), .right = {1, 0, 0}, .near = 0.01, .far = 2,
                                           .width = kWidth, .height = kHeight},
                                .framebuffer = display_->framebuffer()};
    frame.camera.forward = glm::normalize(b.centre() - frame.camera.eye);
    frame.camera.up = glm::cross(frame.camera.right, frame.camera.forward);
    frame.look.light = render::make_light(render::LightRig::studio, frame.camera);
    render::GlView view;
    view.draw(scene, frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame.framebuffer);
    const auto bare = render::read_pixels(0, 0, kWidth, kHeight);

    stroke::Stroke stroke;
    stroke.trace.flat = false;
    stroke.trace.brush = "wolf-medium";
    stroke.trace.ink = "carbon";
    painting.begin(std::move(stroke));
    for (const brush::Pose& pose : test::poses_above(model, painting.brush("wolf-medium"), 0.08)) {
        painting.extend(std::span(&pose, 1));
        const auto tiles = texture.refresh(painting.take_dirty(), painting);
        scene.update_tiles(tiles);
        for (const render::TilePixels& t : tiles)
            if (t.lo.x <= t.hi.x) view.texture_changed(t.lo, t.hi);
        view.draw(scene, frame);
    }
    const auto pieces = render::read_pixels(0, 0, kWidth, kHeight);
    render::GlView fresh;
    fresh.draw(scene, frame);
    const auto whole = render::read_pixels(0, 0, kWidth, kHeight);
    EXPECT_GT(difference(bare, whole).second, 25);  // there is ink to be seen
    EXPECT_EQ(difference(pieces, whole).second, 0);
}

TEST_F(Painted, InkDrawnPieceByPieceIsThePictureDrawnAtOnce) {
    for (const char* name : {"plate.ply", "bowl.ply", "torus.ply"}) compare(test::shipped_model(name, 512));
}

}  // namespace
}  // namespace tuft::app
