#pragma once

#include <cstdint>
#include <vector>

#include "io/image/image.h"

/// \file
/// Pictures that people choose, small enough for a panel. `upload` needs the window's OpenGL context.
namespace tuft::app {

struct SmallPicture {
    int width = 0, height = 0;      ///< pixels
    double reduced = 1;             ///< pixels of the picture along one of these
    std::vector<std::uint8_t> rgb;  ///< [3 width height], row 0 at the top
};

/// Returns the means of whole squares of pixels, over white, at most `most` pixels along a side. Any thread.
SmallPicture small_picture(const io::Image8& picture, int most);

/// Makes the texture of the picture, with its mip levels, in place of the one of that OpenGL name; 0: none yet.
void upload(unsigned& texture, const SmallPicture& picture);
/// Frees a texture that there is, and sets its name to 0.
void release(unsigned& texture);

}  // namespace tuft::app
