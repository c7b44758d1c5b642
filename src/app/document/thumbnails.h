#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "render/gl/gl_camera.h"
#include "stroke/painting/painting.h"

/// \file
/// Small pictures of the layers of a painting, each alone on the bare model, for the list of layers.
namespace tuft::app {

struct Thumbnail {
    std::uint32_t layer = 0;
    int width = 0, height = 0;       ///< pixels
    std::vector<std::uint8_t> rgba;  ///< [4 width height], rows from the top; transparent beside the model
};

/// Draws them on the painter's thread: a ray per pixel finds the texel once for a view; what is painted costs
/// some 15 µs for each tile of texels that is seen.
class Thumbnails {
  public:
    /// From where they are seen, and how large they are. All are drawn anew.
    void look_from(const stroke::Model& model, const render::GlCamera& camera);
    /// These slots changed in some layer.
    void touch(std::span<const std::uint32_t> slots) { touched_.insert(slots.begin(), slots.end()); }
    /// All are drawn anew.
    void forget() { pictures_.clear(); }
    /// Whether there may be something to draw.
    bool waiting(const stroke::Document& painting) const;
    /// The pictures that changed since the last call.
    std::vector<Thumbnail> draw(stroke::Document& painting);

  private:
    struct Pixel {
        std::uint32_t at = 0;  ///< index of the pixel
        std::uint8_t texel = 0;
        float light = 1;  ///< of the surface there
    };

    Thumbnail bare(const ink::Substrate& substrate, std::uint32_t layer) const;
    bool paint(Thumbnail& picture, const ink::Canvas& canvas, const ink::Substrate& substrate, bool all) const;

    int width_ = 0, height_ = 0;
    std::map<std::uint32_t, std::vector<Pixel>> pixels_;  ///< by slot
    std::set<std::uint32_t> touched_;                     ///< slots
    std::map<std::uint32_t, Thumbnail> pictures_;         ///< by layer
};

}  // namespace tuft::app
