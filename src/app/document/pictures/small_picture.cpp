#include "app/document/pictures/small_picture.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace tuft::app {

SmallPicture small_picture(const io::Image8& p, int most) {
    const int n = std::max(1, (std::max(p.width, p.height) + most - 1) / most);
    SmallPicture out{
        .width = std::max(1, p.width / n), .height = std::max(1, p.height / n), .reduced = double(n), .rgb = {}};
    const auto c = static_cast<std::size_t>(p.channels);
    out.rgb.reserve(std::size_t{3} * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            for (std::size_t k = 0; k < 3; ++k) {
                unsigned sum = 0, count = 0;
                for (int j = n * y; j < std::min(n * y + n, p.height); ++j)
                    for (int i = n * x; i < std::min(n * x + n, p.width); ++i, ++count) {
                        const std::uint8_t* at =
                            &p.pixels[c * (static_cast<std::size_t>(j) * static_cast<std::size_t>(p.width) +
                                           static_cast<std::size_t>(i))];
                        const unsigned alpha = c == 2 ? at[1] : c == 4 ? at[3] : 255u;
                        sum += 255 - alpha * (255u - at[c < 3 ? 0 : k]) / 255;
                    }
                out.rgb.push_back(static_cast<std::uint8_t>(sum / std::max(1u, count)));
            }
    return out;
}

void upload(unsigned& texture, const SmallPicture& picture) {
    release(texture);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, picture.width, picture.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 picture.rgb.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void release(unsigned& texture) {
    if (texture) glDeleteTextures(1, &texture);
    texture = 0;
}

}  // namespace tuft::app
