#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "app/document/pictures/small_picture.h"
#include "app/view/display.h"
#include "app/view/texture.h"
#include "app/view/viewport.h"
#include "core/random.h"
#include "models.h"
#include "render/gl/gl_view.h"

namespace tuft::app {
namespace {

constexpr int kWidth = 240, kHeight = 180;

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
        out[static_cast<std::size_t>(k)] =
            static_cast<std::uint8_t>(std::lround(255 * ink::srgb_encode(glm::clamp(light[k], 0.0f, 1.0f))));
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
        for (const render::LightRig rig :
             {render::LightRig::studio, render::LightRig::window, render::LightRig::raking})
            for (const float roughness : {0.05f, 0.5f, 0.9f})
                for (const double parallel : {0.0, 2.5}) {
                    const Vec3f normal = glm::normalize(n);
                    scene.set_mesh(facing_square(normal), {});
                    c.parallel_height = parallel;
                    render::GlLight light = render::make_light(rig, c);
                    light.relief = 0;
                    target.bind();
                    scene.draw_backdrop(c, Vec3f(0), Vec3f(0));
                    scene.draw_model(c, light, {.roughness = roughness});
                    for (const auto& [x, y] : {std::pair{120, 90}, std::pair{95, 75}}) {
                        const std::vector<std::uint8_t> pixel = render::read_pixels(x, kHeight - 1 - y, 1, 1);
                        const Ray ray = render::ray_at(c, x + 0.5, y + 0.5);
                        const auto want =
                            encoded(render::glazed(light, base, normal, Vec3f(-ray.direction), roughness));
                        // One step of eight bits for rounding, one for the GPU's single precision and its texture
                        // decoding.
                        for (std::size_t k = 0; k < 3; ++k)
                            EXPECT_NEAR(pixel[k], want[k], 2) << "channel " << k << " roughness " << roughness;
                    }
                }
}

class Painted : public Gl {
  protected:
    void compare(const stroke::Model& model, std::uint64_t seed);
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

// Appearance somewhere at the model, near or far, cut open or not, in a view that shows ink.
render::GlView::Frame any_frame(const stroke::Model& model, Random& random) {
    const Box& b = model.mesh->bounds;
    Orbit orbit;
    orbit.azimuth = random.uniform(-3.1, 3.1);
    orbit.elevation = random.uniform(-1.2, 1.4);
    orbit.roll = random.uniform() < 0.3 ? random.uniform(-1, 1) : 0;
    orbit.parallel = random.uniform() < 0.3;
    orbit.frame(b);
    const auto near = [&](double x) { return 0.3 * (x - 0.5); };
    orbit.target += near(random.uniform()) * b.size();
    orbit.zoom(random.uniform(-6, 12), orbit.target);
    render::GlView::Frame frame{.camera = orbit.camera(kWidth, kHeight, b)};
    constexpr render::Shading shadings[] = {render::Shading::glaze, render::Shading::glaze,  render::Shading::clay,
                                            render::Shading::flat,  render::Shading::height, render::Shading::texels};
    frame.appearance.options.shading = shadings[static_cast<std::size_t>(random.uniform(0, 6))];
    if (random.uniform() < 0.3) frame.appearance.options.section = Vec4f(0, -1, 0, static_cast<float>(b.centre().y));
    frame.appearance.light =
        render::make_light(random.uniform() < 0.5 ? render::LightRig::studio : render::LightRig::raking, frame.camera);
    frame.moving = random.uniform() < 0.1;
    return frame;
}

// Strokes that reach over the model, drawn while it is looked at from everywhere: each picture that was changed
// piece by piece is the one that is drawn at once.
void Painted::compare(const stroke::Model& model, std::uint64_t seed) {
    stroke::Document painting(model);
    Texture texture(painting);
    render::GlScene scene;
    scene.set_mesh(*model.mesh, model.atlas.corner_uvs);
    scene.set_texture(texture.pixels());
    render::GlView view;
    Random random(seed);
    int inked = 0;
    for (int round = 0; round < 9; ++round) {
        render::GlView::Frame frame = any_frame(model, random);
        frame.framebuffer = display_->framebuffer();
        const auto shot = [&](render::GlView& with) {
            with.draw(scene, frame);
            glBindFramebuffer(GL_FRAMEBUFFER, frame.framebuffer);
            return render::read_pixels(0, 0, kWidth, kHeight);
        };
        const auto bare = shot(view);
        frame.moving = frame.moving && random.uniform() < 0.5;
        stroke::PaintStroke stroke;
        stroke.trace.flat = false;
        stroke.brush = round % 3 == 0 ? "goat-large" : "wolf-medium";
        stroke.ink = round % 2 ? "carbon" : "cinnabar";
        painting.begin(stroke);
        const std::vector<brush::Pose> poses = test::poses_above(
            model, painting.materials().brush(stroke.brush), random.uniform(0.04, 0.2), random.uniform(-0.02, 0.02));
        std::vector<std::uint8_t> pieces;
        for (std::size_t i = 0; i < poses.size(); i += poses.size() / 3 + 1) {
            painting.extend(std::span(poses).subspan(i, std::min(poses.size() / 3 + 1, poses.size() - i)));
            const auto tiles = texture.refresh(painting.appearance().take_dirty(), painting);
            scene.update_tiles(tiles);
            for (const render::TilePixels& t : tiles) view.texture_changed(t.boxes);
            pieces = shot(view);
        }
        painting.end();
        render::GlView fresh;
        frame.moving = false;
        const auto whole = shot(fresh);
        EXPECT_EQ(difference(shot(view), whole).second, 0) << "round " << round;
        inked += difference(bare, whole).second > 25;
    }
    EXPECT_GT(inked, 2);  // in some of the pictures the new ink is seen
}

TEST_F(Painted, InkDrawnPieceByPieceIsThePictureDrawnAtOnce) {
    std::uint64_t seed = 1;
    for (const char* name : {"cylinder.ply", "bowl.ply", "torus.ply", "sheet.ply"}) {
        SCOPED_TRACE(name);
        compare(test::shipped_model(name, 512), seed++);
    }
}

// A brush near the eye has its corners beside the picture, and its handle goes on to the edge of it.
TEST_F(Painted, ASolidWithItsCornersBesideThePictureCoversIt) {
    const stroke::Model model = test::shipped_model("bowl.ply", 512);
    stroke::Document painting(model);
    Texture texture(painting);
    render::GlScene scene;
    scene.set_mesh(*model.mesh, model.atlas.corner_uvs);
    scene.set_texture(texture.pixels());
    Random random(1);
    render::GlView::Frame frame = any_frame(model, random);
    frame.framebuffer = display_->framebuffer();
    frame.moving = false;
    frame.camera.parallel_height = 0;
    const render::GlCamera& c = frame.camera;
    const double depth = 2 * c.near, size = 20 * depth;
    const Vec3 at = c.eye + depth * c.forward;
    const render::GlSolid solid{.positions = {Vec3f(at - size * (c.right + c.up)), Vec3f(at + size * (c.right - c.up)),
                                              Vec3f(at + size * c.up)},
                                .normals = std::vector<Vec3f>(3, Vec3f(-c.forward)),
                                .colours = std::vector<Vec3f>(3, Vec3f(0.9f, 0.1f, 0.1f)),
                                .triangles = {0, 1, 2}};
    frame.solid = &solid;
    frame.opacity = 1;
    render::GlView view;
    view.draw(scene, frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame.framebuffer);
    const std::vector<std::uint8_t> pixels = render::read_pixels(0, 0, kWidth, kHeight);
    const std::size_t channels = pixels.size() / (static_cast<std::size_t>(kWidth) * kHeight);
    int red = 0;
    for (std::size_t i = 0; i < pixels.size(); i += channels) red += pixels[i] > 2 * pixels[i + 1];
    EXPECT_EQ(red, kWidth * kHeight);
}

// A driver gives the same name again once it is free.
TEST_F(Gl, ASmallPictureTakesThePlaceOfTheTextureBeforeIt) {
    const auto of_width = [](int width) {
        return SmallPicture{.width = width, .height = 1, .rgb = std::vector<std::uint8_t>(3 * std::size_t(width), 7)};
    };
    const auto width_of = [](unsigned texture) {
        int width = 0;
        glBindTexture(GL_TEXTURE_2D, texture);
        glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
        return width;
    };
    unsigned other = 0, texture = 0;
    upload(other, of_width(3));
    upload(texture, of_width(5));
    const unsigned first = texture;
    upload(texture, of_width(7));
    EXPECT_EQ(width_of(texture), 7);
    EXPECT_EQ(width_of(other), 3);
    EXPECT_TRUE(first == texture || !glIsTexture(first));
    int alignment = 0;
    glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment);
    EXPECT_EQ(alignment, 4) << "as OpenGL has it";
    const unsigned last = texture;
    release(texture);
    release(other);
    EXPECT_EQ(texture, 0u);
    EXPECT_FALSE(glIsTexture(last));
    release(texture);
}

}  // namespace
}  // namespace tuft::app
