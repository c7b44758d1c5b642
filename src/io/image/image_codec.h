#pragma once

#include <string>
#include <vector>

#include "io/image/image.h"

/// The wall between `io` and OpenImageIO: image.cpp opens the module `tuft_images` when the
/// first picture is read or written and reaches it by these function pointers only.
namespace tuft::io {

enum class ImageFormat { png, exr, jpeg, tiff };

struct EncodeRequest {
    ImageFormat format = ImageFormat::png;
    PixelView pixels;
    const ImageOptions* options = nullptr;
};

struct DecodeRequest {
    ImageFormat format = ImageFormat::png;
    const void* bytes = nullptr;
    std::size_t size = 0;
    PixelView::Type type = PixelView::Type::u8;  ///< wanted
    std::size_t max_pixels = 0;
    std::size_t max_bytes = 0;  ///< of the pixels as wanted
};

struct DecodedImage {
    int width = 0, height = 0, channels = 0;
    std::vector<std::string> channel_names;
    std::vector<unsigned char> bytes;  ///< top row first
};

/// Both return what went wrong, or nothing; no exception crosses the wall.
struct ImageCodec {
    std::string (*encode)(const EncodeRequest& request, std::vector<unsigned char>& out) = nullptr;
    std::string (*decode)(const DecodeRequest& request, DecodedImage& out) = nullptr;
};

/// Name under which the module offers a function without arguments that returns
/// `const ImageCodec*`.
inline constexpr const char* kImageCodecSymbol = "tuft_image_codec";

}  // namespace tuft::io
