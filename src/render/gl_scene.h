#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/types.h"
#include "ink/composite.h"
#include "mesh/triangle_mesh.h"

/// The window's picture by OpenGL 3.3 core. Every call needs the current context that the
/// object was made in.
namespace tuft::render {

enum class Shading { lit = 0, flat = 1, texels = 2 };

struct GlCamera {
    Vec3 eye{0};                    ///< metres, world
    Vec3 right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};
    double field_of_view = 0.6;     ///< radians over the height
    double near = 0.01, far = 10;   ///< metres
    int width = 1280, height = 720; ///< pixels
};

/// Colour mesh for things that change every frame, such as the tuft.
struct GlSolid {
    std::vector<Vec3f> positions;   ///< metres, world
    std::vector<Vec3f> normals;     ///< unit
    std::vector<Vec3f> colours;     ///< linear
    std::vector<std::uint32_t> triangles;
};

/// GPU twin of one model with its base colour map.
class GlScene {
  public:
    GlScene();
    ~GlScene();
    GlScene(const GlScene&) = delete;
    GlScene& operator=(const GlScene&) = delete;

    /// Uploads the mesh with one vertex per corner; `corner_uvs` [3 n_triangles], v up.
    void set_mesh(const mesh::TriangleMesh& mesh, std::span<const Vec2f> corner_uvs);
    /// Uploads the whole map and its mip levels.
    void set_base_colour(const ink::AtlasMap<std::uint8_t>& map);
    /// Uploads the 16 × 16 tiles at `tiles` (index = row · per side + column), a margin of
    /// `gutter` texels round each, and the mip levels under them.
    void update_tiles(const ink::AtlasMap<std::uint8_t>& map, std::span<const std::uint32_t> tiles,
                      int gutter);

    void clear(const GlCamera& camera);
    void draw_model(const GlCamera& camera, Shading shading, float roughness);
    void draw_solid(const GlCamera& camera, const GlSolid& solid, float opacity);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::render
