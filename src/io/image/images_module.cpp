// The module `tuft_images`: the only code that sees OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <exception>
#include <memory>
#include <utility>

#include "io/image/image_codec.h"

namespace tuft::io {
namespace {

const char* extension_of(ImageFormat format) {
    switch (format) {
        case ImageFormat::png:
            break;  // png.h
        case ImageFormat::exr:
            return "picture.exr";
        case ImageFormat::jpeg:
            return "picture.jpg";
        case ImageFormat::tiff:
            return "picture.tif";
    }
    return "";
}

OIIO::TypeDesc type_of(PixelView::Type type) {
    switch (type) {
        case PixelView::Type::u8:
            return OIIO::TypeDesc::UINT8;
        case PixelView::Type::u16:
            return OIIO::TypeDesc::UINT16;
        case PixelView::Type::f32:
            return OIIO::TypeDesc::FLOAT;
    }
    return OIIO::TypeDesc::UNKNOWN;
}

ImageFault ours(Message message) {
    return {.message = std::move(message), .library = {}};
}

/// What a library says; never nothing.
ImageFault said(std::string words) {
    return words.empty() ? ours("it is damaged") : ImageFault{.message = {}, .library = std::move(words)};
}

/// Of an EXR file: no other format is written here.
ImageFault encode_checked(const EncodeRequest& request, std::vector<unsigned char>& out) {
    const PixelView& px = request.pixels;
    OIIO::ImageSpec spec(px.width, px.height, px.channels,
                         request.options->half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    static const std::vector<std::string> names[5] = {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    if (!request.options->channel_names.empty())
        spec.channelnames = request.options->channel_names;
    else if (px.channels <= 4)
        spec.channelnames = names[px.channels];
    spec.alpha_channel = -1;
    // Pixels count as premultiplied otherwise, and colour is lost where alpha is 0.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const std::vector<float>& chromaticities = request.options->chromaticities;
    if (chromaticities.size() == 8)
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities.data());
    spec.attribute("compression", "zip");
    // Otherwise the time of day goes into the file, and no two are the same.
    spec.attribute("DateTime", "1970:01:01 00:00:00");

    const char* name = extension_of(request.format);
    OIIO::Filesystem::IOVecOutput memory;
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name, &memory);
    if (!output) return said(OIIO::geterror());
    if (!output->open(name, spec)) return said(output->geterror());
    if (!output->write_image(type_of(px.type), px.first, OIIO::AutoStride, px.row_bytes))
        return said(output->geterror());
    if (!output->close()) return said(output->geterror());
    out = memory.buffer();
    return out.empty() ? ours("the encoder wrote nothing") : ImageFault{};
}

ImageFault decode_checked(const DecodeRequest& request, DecodedImage& out) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    OIIO::Filesystem::IOMemReader memory(const_cast<void*>(request.bytes), request.size);
    const char* name = extension_of(request.format);
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(name, false, &config, &memory);
    if (!input) return said(OIIO::geterror());
    OIIO::ImageSpec spec;
    if (!input->set_ioproxy(&memory) || !input->open(name, spec, config)) return said(input->geterror());
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1) return ours("it has no pixels");
    if (static_cast<std::size_t>(spec.width) > request.max_pixels / static_cast<std::size_t>(spec.height) ||
        spec.nchannels > 64)
        return ours(Message("it has {} × {} pixels with {} channels, which is too many", spec.width, spec.height,
                            spec.nchannels));
    out.width = spec.width;
    out.height = spec.height;
    out.channels = spec.nchannels;
    out.channel_names = spec.channelnames;
    const OIIO::TypeDesc type = type_of(request.type);
    const std::size_t bytes = std::size_t(spec.width) * spec.height * spec.nchannels * type.size();
    if (bytes > request.max_bytes)
        return ours(Message("its pixels take {} MiB, more memory than there is", bytes >> 20));
    out.bytes.resize(bytes);
    if (!input->read_image(0, 0, 0, spec.nchannels, type, out.bytes.data())) return said(input->geterror());
    return {};
}

ImageFault encode(const EncodeRequest& request, std::vector<unsigned char>& out) {
    try {
        return encode_checked(request, out);
    } catch (const std::exception& e) {
        return said(e.what());
    }
}

ImageFault decode(const DecodeRequest& request, DecodedImage& out) {
    try {
        const ImageFault fault = decode_checked(request, out);
        return fault.message.empty() && fault.library.empty() && out.bytes.empty() ? said("") : fault;
    } catch (const std::exception& e) {
        return said(e.what());
    }
}

const ImageCodec kCodec{.encode = encode, .decode = decode};

}  // namespace
}  // namespace tuft::io

extern "C" __attribute__((visibility("default"))) const tuft::io::ImageCodec* tuft_image_codec() {
    return &tuft::io::kCodec;
}
