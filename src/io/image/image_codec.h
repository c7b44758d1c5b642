#pragma once

#include <string>
#include <vector>

#include "core/message.h"
#include "io/image/image.h"

/// \file
/// Interface between image.cpp and the codecs: png.h, and the module `tuft_images`, which links OpenImageIO. image.cpp
/// loads the module with the first picture that is no PNG and calls it through these function pointers. The functions
/// may run on any thread.
namespace tuft::io {

/// Format of a picture file.
enum class ImageFormat { png, exr, jpeg, tiff };

/// Pixels to be encoded.
struct EncodeRequest {
    ImageFormat format = ImageFormat::png;
    PixelView pixels;
    const ImageOptions* options = nullptr;
};

/// Bytes of a file to be decoded, and limits of the result.
struct DecodeRequest {
    ImageFormat format = ImageFormat::png;
    const void* bytes = nullptr;
    std::size_t size = 0;
    PixelView::Type type = PixelView::Type::u8;  ///< of the result
    std::size_t max_pixels = 0;
    std::size_t max_bytes = 0;  ///< of the pixels as wanted
};

/// Pixels of a decoded file.
struct DecodedImage {
    int width = 0, height = 0, channels = 0;
    std::vector<std::string> channel_names;
    std::vector<unsigned char> bytes;  ///< top row first
};

/// Why a picture is not read or written: our words, or else those of a library. Both empty: it is.
struct ImageFault {
    Message message;
    std::string library;
};

/// Both functions return the fault. They do not throw.
struct ImageCodec {
    ImageFault (*encode)(const EncodeRequest& request, std::vector<unsigned char>& out) = nullptr;
    ImageFault (*decode)(const DecodeRequest& request, DecodedImage& out) = nullptr;
};

/// Symbol of the module's function without arguments that returns `const ImageCodec*`.
inline constexpr const char* kImageCodecSymbol = "tuft_image_codec";

}  // namespace tuft::io
