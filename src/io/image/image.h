#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ink/composite/composite.h"

/// \file
/// Reading and writing of picture files: PNG with 8 or 16 bits, OpenEXR; JPEG and TIFF are read only. Any thread. The
/// codec of all formats but PNG (OpenImageIO, 250 shared objects, 0.25 s) is loaded with the first such picture.
namespace tuft::io {

/// Picture in memory, row 0 at the top, channels interleaved.
template <class T>
struct Image {
    int width = 0, height = 0, channels = 0;
    std::vector<T> pixels;                        ///< [width * height * channels]
    std::vector<std::string> channel_names = {};  ///< as in the file that was read; else empty

    /// Compares sizes and pixels, not channel names.
    bool operator==(const Image& o) const {
        return width == o.width && height == o.height && channels == o.channels && pixels == o.pixels;
    }
};
using Image8 = Image<std::uint8_t>;
using Image16 = Image<std::uint16_t>;
using ImageF = Image<float>;

/// View of pixels that another object owns, read row by row.
struct PixelView {
    enum class Type { u8, u16, f32 };
    Type type = Type::u8;
    int width = 0, height = 0, channels = 0;
    const void* first = nullptr;   ///< top left pixel
    std::ptrdiff_t row_bytes = 0;  ///< from a row to the one below it; may be negative
};

/// Returns a view of packed pixels, row 0 at the top.
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

/// Returns a view of the whole image, which must outlive it.
template <class T>
PixelView view_of(const Image<T>& image) {
    return view_of(image.width, image.height, image.channels, image.pixels.data());
}

/// Returns a view of an atlas map as a picture: the map's last row (v = 1) is the top row. No copy.
template <class T>
PixelView view_of(const ink::AtlasMap<T>& map) {
    PixelView view = view_of(static_cast<int>(map.size), static_cast<int>(map.size), map.channels, map.texels.data());
    view.first = static_cast<const char*>(view.first) + view.row_bytes * (static_cast<std::ptrdiff_t>(map.size) - 1);
    view.row_bytes = -view.row_bytes;
    return view;
}

/// Options of `write_image` and `png_bytes`.
struct ImageOptions {
    /// The colour space of the numbers, stored in the file: sRGB, else linear. Nothing is converted.
    bool srgb = true;
    /// ICC profile stored in a PNG file; empty: none.
    std::vector<std::uint8_t> icc_profile = {};
    /// x and y of red, green, blue and white, stored in an EXR file; empty: none, which means Rec. 709 and D65.
    std::vector<float> chromaticities = {};
    /// Names of the channels in an EXR file; empty: Y, or R, G, B, A.
    std::vector<std::string> channel_names = {};
    /// Stores floats in an EXR file in 16 bits, relative error 1/2048. It halves the reader's memory.
    bool half = false;
    /// zlib level of PNG, 0 (fast) – 9 (small).
    int compression = 4;
};

/// Writes a picture atomically. The extension chooses the format. `.png`: u8 or u16; floats in [0, 1] become u16; 1–4
/// channels, alpha not premultiplied. `.exr`: f32 or half; u8 and u16 become [0, 1]. Throws `Error` for another
/// extension or a failed write.
void write_image(const std::filesystem::path& path, const PixelView& pixels, const ImageOptions& options = {});

/// Returns the bytes of a PNG file. Throws `Error`.
std::vector<unsigned char> png_bytes(const PixelView& pixels, const ImageOptions& options = {});

/// Decodes the bytes of a file as `read_image8` does. `name` is for messages.
Image8 decode_image8(const std::vector<char>& bytes, const std::string& name, std::size_t max_pixels);

/// Reads a PNG, EXR, JPEG or TIFF file into the given type. Colours are returned as stored; only the number range is
/// converted. Throws `Error` for damaged files and, before memory is taken, for more than
/// `max_pixels` pixels or than half of the free memory.
Image8 read_image8(const std::filesystem::path& path, std::size_t max_pixels = std::size_t{1} << 29);
Image16 read_image16(const std::filesystem::path& path, std::size_t max_pixels = std::size_t{1} << 29);
ImageF read_image_float(const std::filesystem::path& path, std::size_t max_pixels = std::size_t{1} << 29);

}  // namespace tuft::io
