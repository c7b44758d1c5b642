#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "render/gl/gl_camera.h"
#include "stroke/document/document.h"

/// \file
/// Small pictures of single layers on the bare model, for the list of layers. Paint thread.
namespace tuft::app {

/// Small picture of one layer.
struct Thumbnail {
    std::uint32_t layer = 0;
    int width = 0, height = 0;       ///< pixels
    std::vector<std::uint8_t> rgba;  ///< [4 width height], rows from the top; transparent beside the model
};

/// Draws the thumbnails. One ray per pixel finds its texel, once per view. Cost: about 15 µs per visible tile of
/// painted texels.
class Thumbnails {
  public:
    /// Sets view and size. All thumbnails are drawn again.
    void look_from(const stroke::Model& model, const render::GlCamera& camera);
    /// Marks slots that changed in some layer.
    void touch(std::span<const std::uint32_t> slots) { touched_.insert(slots.begin(), slots.end()); }
    /// Drops all thumbnails, so that they are drawn again.
    void forget() { pictures_.clear(); }
    /// Returns true when there may be something to draw.
    bool waiting(const stroke::Document& painting) const;
    /// Returns the thumbnails that changed since the last call.
    std::vector<Thumbnail> draw(stroke::Document& painting);

  private:
    struct Pixel {
        std::uint32_t at = 0;  ///< index in the picture
        std::uint8_t texel = 0;
        float light = 1;  ///< irradiance of the surface there
    };

    Thumbnail bare(const ink::Substrate& substrate, std::uint32_t layer) const;
    bool paint(Thumbnail& picture, const ink::Canvas& canvas, const ink::Substrate& substrate, bool all) const;

    int width_ = 0, height_ = 0;
    std::map<std::uint32_t, std::vector<Pixel>> pixels_;  ///< by slot
    std::set<std::uint32_t> touched_;                     ///< slots
    std::map<std::uint32_t, Thumbnail> pictures_;         ///< by layer
};

}  // namespace tuft::app
