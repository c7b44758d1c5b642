#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/system/progress.h"
#include "mesh/query/surface_query.h"
#include "render/picture/camera.h"

/// \file
/// Product pictures of a textured model without a GPU or a screen. Called by `tuft` and by the studio's export.
namespace tuft::render {

/// RGB picture, sRGB encoded, 8 bits, row 0 at the top.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< [3 width height]
};

/// Surface of the model without ink.
enum class Finish {
    porcelain,  ///< white body under a clear smooth coat (refractive index 1.5)
    clay,       ///< matt warm grey-brown
};

/// Maps over the atlas, each `size` × `size` texels with row 0 at v = 0 and texel centres
/// at +0.5, read bilinearly; gutters must be filled. The arrays must outlive the call.
/// Empty spans mean "no such map".
struct TextureMaps {
    std::uint32_t size = 0;
    std::span<const Vec2f> corner_uvs{};                              ///< [3 n_triangles], v up
    std::span<const Vec3f> base_colour{};                             ///< linear RGB reflectance, or
    std::span<const std::array<std::uint8_t, 4>> base_colour_srgb{};  ///< sRGB, alpha over the body
    std::span<const float> roughness{};                               ///< of the coat, 0 mirror … 1 matt
    std::span<const float> height{};                                  ///< metres of ink above the surface
};

/// Material of the model.
struct Appearance {
    Finish finish = Finish::porcelain;
    std::optional<Vec3f> body_colour;  ///< linear RGB; by default that of the finish
    bool vertex_colours = true;        ///< use those of the mesh where there is no base colour map
    TextureMaps maps;
};

/// Lamps of a picture.
enum class Lights {
    studio,  ///< three soft boxes
    raking,  ///< one small lamp from the side, which shows the relief of the ink with its shadows
};

/// Size, view and quality of a picture.
struct PictureOptions {
    int width = 1280, height = 720;  ///< pixels
    View view;
    bool floor = true;  ///< stands on a seamless studio floor with its shadow
    Lights lights = Lights::studio;
    /// Radians the lights are turned about z, raking light about the camera's axis; they follow the camera.
    double light_azimuth = 0;
    double exposure = 1;  ///< factor on the light
    /// Rays per pixel on edges, up to eight times as many on thin lights. Elsewhere a quarter; below 8 that is the one
    /// through the pixel's middle.
    int edge_samples = 16;
    int light_samples = 28;  ///< rays per pixel towards lights and surroundings
    int light_step = 1;      ///< light is sampled at each pixel so many apart along both sides, and interpolated; >= 1
    std::uint64_t seed = 1;
    ProgressFn progress;
};

/// Draws the model in a photographer's studio: soft boxes, a dim dome, light that bounces
/// between the surfaces, a seamless floor. The lights scale with the object and turn with the
/// camera. Light is linear; it is encoded as sRGB, and only values above 0.8 are compressed to keep
/// highlights from clipping. The same arguments give the same bits for any thread count.
/// Throws `Error` for sizes out of range or maps that do not match `size` or the mesh.
/// Cost at 1280 × 720 and 100,000 triangles: about 10 s of one core.
Image render_picture(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& appearance,
                     const PictureOptions& options = {});

/// Frame `index` of `count` of a turntable: the model turns once counter-clockwise.
PictureOptions turntable_frame(PictureOptions options, int index, int count);

}  // namespace tuft::render
