#pragma once

#include <cstdint>
#include <vector>

/// \file
/// Offscreen picture in graphics memory. `app` draws the view into it and copies parts to the window.
namespace tuft::render {

/// Part of a picture, pixels, lower left corner first as GL has it.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;

    bool empty() const { return width <= 0 || height <= 0; }
};

/// Picture in graphics memory to draw into: antialiased colour and depth, resolved to a
/// plain colour picture. Needs the current context it was made in.
class GlTarget {
  public:
    GlTarget() = default;
    ~GlTarget();
    GlTarget(const GlTarget&) = delete;
    GlTarget& operator=(const GlTarget&) = delete;

    /// Makes it width × height pixels with the given samples per pixel (0 or 1: none).
    void resize(int width, int height, int samples);
    void bind();
    /// Copies colours of a part to another framebuffer (0: the window), moved by (dx, dy).
    void resolve_to(unsigned framebuffer, const PixelRect& part, int dx = 0, int dy = 0);
    /// Copies colours and depth of a part to the same place of another target.
    void copy_to(GlTarget& target, const PixelRect& part);
    unsigned framebuffer() const { return framebuffer_; }

  private:
    void clear();

    unsigned framebuffer_ = 0, colour_ = 0, depth_ = 0;
    int width_ = 0, height_ = 0, samples_ = 0;
};

/// The bound framebuffer's colours, RGB, row 0 at the top [3 width height].
std::vector<std::uint8_t> read_pixels(int x, int y, int width, int height);

}  // namespace tuft::render
