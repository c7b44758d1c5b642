#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ink/composite/composite.h"

/// Picture files: PNG with 8 or 16 bits, OpenEXR, and reading them back. The codec
/// (OpenImageIO, 250 shared objects, 0.25 s) is loaded when the first picture is.
namespace tuft::io {

/// Picture in memory, row 0 at the top, channels interleaved.
template <class T>
struct Image {
    int width = 0, height = 0, channels = 0;
    std::vector<T> pixels;                        ///< [width * height * channels]
    std::vector<std::string> channel_names = {};  ///< of a file that was read

    /// Same size and pixels.
    bool operator==(const Image& o) const {
        return width == o.width && height == o.height && channels == o.channels && pixels == o.pixels;
    }
};
using Image8 = Image<std::uint8_t>;
using Image16 = Image<std::uint16_t>;
using ImageF = Image<float>;

/// Pixels that belong to somebody else, read row by row.
struct PixelView {
    enum class Type { u8, u16, f32 };
    Type type = Type::u8;
    int width = 0, height = 0, channels = 0;
    const void* first = nullptr;   ///< top left pixel
    std::ptrdiff_t row_bytes = 0;  ///< from a row to the one below it; may be negative
};

template <class T>
PixelView view_of(int width, int height, int channels, const T* pixels) {
    static_assert(std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::uint16_t> || std::is_same_v<T, float>);
    return {.type = sizeof(T) == 1   ? PixelView::Type::u8
                    : sizeof(T) == 2 ? PixelView::Type::u16
                                     : PixelView::Type::f32,
            .width = width,
            .height = height,
            .channels = channels,
            .first = pixels,
            .row_bytes = static_cast<std::ptrdiff_t>(sizeof(T)) * width * channels};
}

template <class T>
PixelView view_of(const Image<T>& image) {
    return view_of(image.width, image.height, image.channels, image.pixels.data());
}

/// An atlas map as a picture: its last row (v = 1) becomes the top one. No copy.
template <class T>
PixelView view_of(const ink::AtlasMap<T>& map) {
    PixelView view = view_of(static_cast<int>(map.size), static_cast<int>(map.size), map.channels, map.texels.data());
    view.first = static_cast<const char*>(view.first) + view.row_bytes * (static_cast<std::ptrdiff_t>(map.size) - 1);
    view.row_bytes = -view.row_bytes;
    return view;
}

struct ImageOptions {
    /// What the numbers mean; stored in the file. Nothing is converted.
    bool srgb = true;
    /// Names of the channels in an EXR file; empty: Y, or R, G, B, A.
    std::vector<std::string> channel_names;
    /// Floats go into an EXR file as 16 bits (1 part in 2048, as renderers keep colour): half the
    /// memory of who opens it, and far less than half of the file.
    bool half = false;
    /// 0 (fast) – 9 (small), PNG only.
    int compression = 4;
};

/// Writes a picture atomically; the extension chooses the format: `.png` (u8, u16; floats
/// become u16 of [0, 1]) or `.exr` (f32 or half; u8 and u16 become [0, 1]). 1–4 channels in PNG,
/// alpha not premultiplied. Throws `Error` for another extension or a failed write.
void write_image(const std::filesystem::path& path, const PixelView& pixels, const ImageOptions& options = {});

/// The bytes of a PNG file.
std::vector<unsigned char> png_bytes(const PixelView& pixels, const ImageOptions& options = {});

/// The same as `read_image8` from the bytes of a file; `name` is for messages.
Image8 decode_image8(const std::vector<char>& bytes, const std::string& name, std::size_t max_pixels);

/// Reads a PNG, EXR, JPEG or TIFF file into the asked type, colours as stored (no
/// conversion but that of the number range). Throws `Error` for damaged files and for
/// pictures of more than `max_pixels` or than half of the free memory, before memory is taken.
Image8 read_image8(const std::filesystem::path& path, std::size_t max_pixels = std::size_t{1} << 29);
Image16 read_image16(const std::filesystem::path& path, std::size_t max_pixels = std::size_t{1} << 29);
ImageF read_image_float(const std::filesystem::path& path, std::size_t max_pixels = std::size_t{1} << 29);

}  // namespace tuft::io
