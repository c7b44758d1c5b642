#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/picture/picture_series.h"

/// \file
/// Product pictures of models with parts of glass, one or the frames of a film. Called by `tuft` and by the studio's
/// exports.
namespace tuft::render {

/// What lets light pass. The span must outlive the call.
struct Glass {
    std::vector<std::uint8_t> triangles;              ///< [n_triangles] 1: of glass; empty: none
    std::vector<std::uint8_t> hidden = {};            ///< [n_triangles] 1: not in the picture; empty: none
    std::uint32_t size = 0;                           ///< texels per side of the map, row 0 at v = 0
    std::span<const std::uint8_t> transmission = {};  ///< [size²] part of the light that passes, × 255
};

/// Draws the model as `render_picture` does, and what is behind glass through it. With τ the transmission of the point
/// that a ray meets first, F(θ) its Fresnel reflectance ([Schlick1994], F0 = 0.04) and c its colour as an opaque
/// surface,
///
///     seen = (1 − t) opaque + t c behind,    t = τ (1 − F(θ)),
///
/// in linear light, for up to two walls of glass on a ray: one that faces the eye, then any. Light is not refracted and
/// glass casts no shadow on what is behind it. 4 × 4 rays per pixel decide where glass is. Cost: that of three
/// pictures.
Image render_with_glass(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& appearance,
                        const Glass& glass, const PictureOptions& options = {});

/// `PictureSeries` of a model with parts of glass: its frames are what `render_with_glass` draws, to the bit where they
/// show `lit`. Cost: that of a `PictureSeries` without glass, else of two or three; each change traces the rays of all
/// pixels that show glass. Where the picture has less than 8 edge samples, 2 × 2 rays per pixel decide where glass is.
class GlassSeries {
  public:
    /// `mesh`, `query`, and the maps of `lit` and `glass` must outlive it. Throws as `PictureSeries` does.
    GlassSeries(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& lit, Glass glass,
                const PictureOptions& options, PictureSeries::Length length = PictureSeries::Length::many);
    ~GlassSeries();
    GlassSeries(const GlassSeries&) = delete;
    GlassSeries& operator=(const GlassSeries&) = delete;

    /// Draws as `PictureSeries::draw` does. `transmission`: that of `Glass` with the paint `shown`.
    const Image& draw(const Appearance& shown, std::span<const std::uint8_t> transmission,
                      std::span<const std::uint32_t> changed = {});
    /// Moves the camera as `PictureSeries::look_from` does.
    void look_from(const View& view);

    /// Returns the camera of the last picture.
    const Camera& camera() const;
    /// Moves the picture out; the series ends with it.
    Image take_image();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::render
