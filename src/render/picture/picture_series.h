#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "render/picture/picture.h"

/// \file
/// Product pictures of one model from one camera while it is painted: the frames of a film. Called by `tuft film` and
/// by `render_picture`.
namespace tuft::render {

/// Light and camera of a picture, and the picture as it was drawn last.
///
/// A pixel is a function of the texels that its rays read. Its tiles are recorded, so after a change of some tiles only
/// the pixels that read one of them are drawn anew. The image is to the bit that of a series which draws it first.
///
/// Light that painted surfaces throw onto others is that of `lit` in every picture: frames do not flicker, and the
/// frame that shows `lit` is to the bit that of `render_picture`. A caller makes a new series where the paint has gone
/// far from `lit`.
class PictureSeries {
  public:
    /// One picture, many from one camera, or many from a camera that moves. Only `many` records reads, which takes
    /// half the time and memory of the first picture.
    enum class Length { one, many, moving };

    /// Finds the light. `mesh`, `query`, and the maps of `lit` must outlive it. Throws as `render_picture` does. Cost:
    /// three quarters of a whole picture.
    PictureSeries(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& lit,
                  const PictureOptions& options, Length length = Length::many);
    ~PictureSeries();
    PictureSeries(const PictureSeries&) = delete;
    PictureSeries& operator=(const PictureSeries&) = delete;

    /// Draws the model with the paint `shown`; finish, body colour and map size must be those of `lit`. At the first
    /// call everything is drawn, later the pixels that read one of `changed` (tiles of 16 × 16 texels of the colour
    /// map, row · tiles per side + column). With a height map all is drawn anew after any change.
    const Image& draw(const Appearance& shown, std::span<const std::uint32_t> changed = {});

    /// Moves the camera, with which the lights turn; the next `draw` draws all anew. Light that surfaces throw onto
    /// others stays that of the paint `lit`, and its paths are not traced again: half the cost of a new series where
    /// `light_step` and few samples make its pixels cheap. The series must be `Length::moving`.
    void look_from(const View& view);

    /// Returns the camera of the last picture.
    const Camera& camera() const;
    /// Pixels whose colour the last `draw` computed.
    std::size_t drawn_pixels() const;
    /// Moves the picture out; the series ends with it.
    Image take_image();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::render
