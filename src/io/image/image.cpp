#include "io/image/image.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/library_fault.h"
#include "core/files/loaded_module.h"
#include "io/image/exr_header.h"
#include "io/image/image_codec.h"
#include "io/image/png.h"
#include "stroke/surface/model.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

const ImageCodec& load_codec() {
    const ModuleSymbol found = find_in_module("libtuft_images.so", TUFT_IMAGES_BUILT, kImageCodecSymbol);
    using Entry = const ImageCodec* (*)();
    if (found.symbol) return *reinterpret_cast<Entry>(found.symbol)();
    throw Error(Message("the picture library cannot be loaded: {} (looked for {})", found.fault, found.tried));
}

const ImageCodec& codec() {
    static const ImageCodec& loaded = load_codec();
    return loaded;
}

ImageFault encode_format(const EncodeRequest& request, std::vector<unsigned char>& out) {
    return request.format == ImageFormat::png ? encode_png(request, out) : codec().encode(request, out);
}

ImageFault decode_format(const DecodeRequest& request, DecodedImage& out) {
    return request.format == ImageFormat::png ? decode_png(request, out) : codec().decode(request, out);
}

/// Empty: there is no fault.
Message words_of(const ImageFault& fault) {
    return fault.message.empty() && !fault.library.empty() ? library_fault(fault.library) : fault.message;
}

std::vector<unsigned char> encode(ImageFormat format, const PixelView& pixels, const ImageOptions& options,
                                  const std::string& name) {
    if (pixels.width <= 0 || pixels.height <= 0 || pixels.channels <= 0 || !pixels.first)
        throw Error(name, "the picture is empty");
    if (format == ImageFormat::png && pixels.channels > 4)
        throw Error(name, Message("a PNG file has 1 to 4 channels, not {}; write an EXR file", pixels.channels));
    assert(options.channel_names.empty() || options.channel_names.size() == static_cast<std::size_t>(pixels.channels));
    std::vector<unsigned char> bytes;
    const Message fault = words_of(encode_format({.format = format, .pixels = pixels, .options = &options}, bytes));
    if (!fault.empty()) throw Error(name, Message("the picture cannot be written: {}", fault));
    return bytes;
}

ImageFormat format_of(const std::vector<char>& bytes, const fs::path& path) {
    const auto starts = [&](std::string_view magic) {
        return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
    };
    if (starts("\x89PNG\r\n\x1a\n")) return ImageFormat::png;
    if (starts("\x76\x2f\x31\x01")) return ImageFormat::exr;
    if (starts("\xff\xd8\xff")) return ImageFormat::jpeg;
    if (starts("II*") || starts(std::string_view("MM\0*", 4))) return ImageFormat::tiff;
    throw Error(path.string(), "is not a PNG, EXR, JPEG or TIFF picture");
}

/// Of pixels, which are copied once; any machine has room for small pictures.
std::size_t most_bytes() {
    constexpr std::size_t kNoMatter = std::size_t{64} << 20;
    return std::max(kNoMatter, stroke::available_memory() / 2);
}

template <class T>
Image<T> decode(const std::vector<char>& bytes, const fs::path& path, std::size_t max_pixels) {
    DecodedImage decoded;
    const ImageFormat format = format_of(bytes, path);
    Message fault = format == ImageFormat::exr ? exr_header_fault(bytes, max_pixels) : Message();
    if (fault.empty())
        fault = words_of(decode_format({.format = format,
                                        .bytes = bytes.data(),
                                        .size = bytes.size(),
                                        .type = view_of<T>(1, 1, 1, nullptr).type,
                                        .max_pixels = max_pixels,
                                        .max_bytes = most_bytes()},
                                       decoded));
    if (!fault.empty()) throw Error(path.string(), Message("the picture cannot be read: {}", fault));
    Image<T> image{.width = decoded.width,
                   .height = decoded.height,
                   .channels = decoded.channels,
                   .pixels = {},
                   .channel_names = std::move(decoded.channel_names)};
    image.pixels.resize(decoded.bytes.size() / sizeof(T));
    std::memcpy(image.pixels.data(), decoded.bytes.data(), image.pixels.size() * sizeof(T));
    return image;
}

}  // namespace

void write_image(const fs::path& path, const PixelView& pixels, const ImageOptions& options) {
    const std::string extension = path.extension().string();
    if (extension != ".png" && extension != ".exr")
        throw Error(path.string(), Message("pictures are written as .png or .exr, not as '{}'", extension));
    const std::vector<unsigned char> bytes =
        encode(extension == ".png" ? ImageFormat::png : ImageFormat::exr, pixels, options, path.string());
    write_file(path, bytes.data(), bytes.size());
}

std::vector<unsigned char> png_bytes(const PixelView& pixels, const ImageOptions& options) {
    return encode(ImageFormat::png, pixels, options, "PNG");
}

Image8 decode_image8(const std::vector<char>& bytes, const std::string& name, std::size_t max_pixels) {
    return decode<std::uint8_t>(bytes, name, max_pixels);
}

Image8 read_image8(const fs::path& path, std::size_t max_pixels) {
    return decode<std::uint8_t>(read_file(path), path, max_pixels);
}
Image16 read_image16(const fs::path& path, std::size_t max_pixels) {
    return decode<std::uint16_t>(read_file(path), path, max_pixels);
}
ImageF read_image_float(const fs::path& path, std::size_t max_pixels) {
    return decode<float>(read_file(path), path, max_pixels);
}

}  // namespace tuft::io
