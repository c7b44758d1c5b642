#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/types.h"
#include "mesh/triangle_mesh.h"
#include "render/gl/gl_camera.h"
#include "render/gl/gl_light.h"
#include "render/gl/gl_target.h"

/// \file
/// The window's picture by OpenGL 3.3 core. `app` draws through it. Every call needs the current context in which
/// the object was made.
namespace tuft::render {

/// How the window shows the model; the numbers are those of the shader.
enum class Shading { glaze = 0, clay = 1, flat = 2, height = 3, texels = 4, triangles = 5 };

/// Colour mesh for things that change every frame, such as the tuft.
struct GlSolid {
    std::vector<Vec3f> positions;  ///< metres, world
    std::vector<Vec3f> normals;    ///< unit
    std::vector<Vec3f> colours;    ///< linear
    std::vector<std::uint32_t> triangles;
};

inline constexpr int kTextureLevels = 5;  ///< 16 × 16 down to 1 × 1 texels of a tile

/// Axis-aligned box, metres, world.
struct GlBox {
    Vec3f lo{0}, hi{0};
};

/// Height code of the texture's fourth channel, 0–255, for thin ink and thick paint. A step is 0.1 µm near 0 and
/// 1/48 of the height at large heights; 255 is 969 µm.
inline constexpr double kCodeHeight = 4.8, kCodeSteps = 48;
inline double height_of_code(double code) {
    return kCodeHeight * std::expm1(code / kCodeSteps);
}
inline double code_of_height(double micrometres) {
    return kCodeSteps * std::log1p(micrometres / kCodeHeight);
}

/// One tile of the atlas at all levels, RGBA: sRGB colour and the code of the height.
struct TilePixels {
    static constexpr std::array<int, kTextureLevels + 1> kStart{0, 256, 320, 336, 340, 341};
    std::uint32_t tile = 0;  ///< row · per side + column
    std::array<std::array<std::uint8_t, 4>, 341> rgba;
    std::vector<GlBox> boxes;  ///< bounds of the surface coloured by this tile at any level
};

/// The whole atlas at all levels, row 0 at v = 0.
struct MapPixels {
    std::uint32_t size = 0;  ///< texels per side, a multiple of 16
    std::array<std::vector<std::array<std::uint8_t, 4>>, kTextureLevels> levels;
};

/// How the model is drawn.
struct DrawOptions {
    Shading shading = Shading::glaze;
    float roughness = 0.1f;   ///< of the coat
    float height_range = 10;  ///< micrometres of ink that get the last colour of the ramp
    Vec4f section{0};         ///< plane, metres; cuts away dot((p, 1), section) > 0; zero: none

    bool operator==(const DrawOptions&) const = default;
};

/// GPU twin of one model with its texture.
class GlScene {
  public:
    GlScene();
    ~GlScene();
    GlScene(const GlScene&) = delete;
    GlScene& operator=(const GlScene&) = delete;

    /// Uploads the mesh; `corner_uvs` [3 n_triangles], v up. Corners that agree in place,
    /// normal and uv become one vertex.
    void set_mesh(const mesh::TriangleMesh& mesh, std::span<const Vec2f> corner_uvs);
    /// Leaves out triangles, [n_triangles] 1: hidden; empty: none. `transmission` [n_triangles]: part of the light that
    /// passes a triangle without ink; empty: none lets light pass. Glass is drawn last, the farthest first, in the lit
    /// views: it reflects as a coat does, and ink of height h hides what is behind it by 1 − exp(−h / 0.625 µm), which
    /// is exp(−4) per film unit. `set_mesh` shows all triangles, opaque.
    void set_parts(std::span<const std::uint8_t> hidden, std::span<const float> transmission);
    /// Whether a visible triangle lets light pass.
    bool has_glass() const;
    /// sRGB-encoded colours for `Shading::triangles` [n_triangles].
    void set_triangle_colours(std::span<const std::array<std::uint8_t, 4>> colours);
    void set_texture(const MapPixels& map);
    void update_tiles(std::span<const TilePixels> tiles);

    /// Clears the picture to the backdrop, from sRGB colour `low` at the bottom to `high`.
    void draw_backdrop(const GlCamera& camera, const Vec3f& low, const Vec3f& high);
    /// Draws the model. With `still` it records the hidden surfaces, which makes `redraw_model` cheaper.
    void draw_model(const GlCamera& camera, const GlLight& light, const DrawOptions& options, bool still = false);
    /// Redraws the surface inside the boxes in a part of the picture, after the texture changed there. Camera,
    /// section and depth must be those of the last `draw_model`. The result is that of `draw_model` now. Not for a
    /// scene with glass.
    void redraw_model(const GlCamera& camera, const GlLight& light, const DrawOptions& options, const PixelRect& part,
                      std::span<const GlBox> changed);
    /// Draws the atlas flat into a part of the picture: `centre` in uv lies in its middle,
    /// `pixels_per_side` is the whole atlas. What needs light is shown as flat colour.
    struct AtlasWindow {
        PixelRect part;
        Vec2 centre{0.5};
        double pixels_per_side = 512;
        Vec3f backdrop{0.1f};  ///< sRGB-encoded
    };
    /// Draws the texture as a flat square into `window.part`.
    void draw_atlas(const AtlasWindow& window, const DrawOptions& options);
    void draw_solid(const GlCamera& camera, const GlLight& light, const GlSolid& solid, float opacity);

  private:
    struct VisibleCluster;
    void begin_model(const GlCamera& camera, const GlLight& light, const DrawOptions& options);
    std::vector<VisibleCluster> clusters_in(const GlCamera& camera, const PixelRect& part) const;
    void draw_glass(std::span<const VisibleCluster> seen, const DrawOptions& options);

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::render
