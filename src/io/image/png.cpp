#include "io/image/png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <exception>

namespace tuft::io {
namespace {

/// One file in work. libpng leaves its functions by longjmp, so whatever has a destructor stands here and not in the
/// functions that call it.
struct PngWork {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::array<char, 128> fault{};               // what libpng says
    const unsigned char* next = nullptr;         // of the file to be decoded
    std::size_t left = 0;                        // bytes
    std::vector<unsigned char>* file = nullptr;  // being encoded
    std::vector<std::uint16_t> row;              // of floats
    bool writes = false;

    explicit PngWork(bool to_write);
    ~PngWork() {
        if (writes)
            png_destroy_write_struct(&png, &info);
        else
            png_destroy_read_struct(&png, &info, nullptr);
    }
    PngWork(const PngWork&) = delete;
    PngWork& operator=(const PngWork&) = delete;
};

void leave(png_structp png, png_const_charp words) {
    auto& work = *static_cast<PngWork*>(png_get_error_ptr(png));
    std::strncpy(work.fault.data(), words, work.fault.size() - 1);
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

void take_bytes(png_structp png, png_bytep to, std::size_t n) {
    auto& work = *static_cast<PngWork*>(png_get_io_ptr(png));
    if (n > work.left) png_error(png, "unexpected end of file");
    std::memcpy(to, work.next, n);
    work.next += n;
    work.left -= n;
}

bool append(std::vector<unsigned char>& file, png_bytep from, std::size_t n) {
    try {
        file.insert(file.end(), from, from + n);
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

void put_bytes(png_structp png, png_bytep from, std::size_t n) {
    auto& work = *static_cast<PngWork*>(png_get_io_ptr(png));
    if (!append(*work.file, from, n)) png_error(png, "out of memory");
}

PngWork::PngWork(bool to_write) : writes(to_write) {
    png = to_write ? png_create_write_struct(PNG_LIBPNG_VER_STRING, this, leave, ignore)
                   : png_create_read_struct(PNG_LIBPNG_VER_STRING, this, leave, ignore);
    if (png) info = png_create_info_struct(png);
}

ImageFault fault_of(const PngWork& work) {
    if (work.fault[0]) return {.message = {}, .library = work.fault.data()};
    return {.message = "it is damaged", .library = {}};
}

/// Reads up to the pixels, and has libpng expand them to 8 or 16 bits a sample.
bool read_head(PngWork& work, PixelView::Type type) {
    if (setjmp(png_jmpbuf(work.png))) return false;
    png_set_read_fn(work.png, &work, take_bytes);
    // Sizes are checked against the caller's limit.
    png_set_user_limits(work.png, 0x7fffffff, 0x7fffffff);
    // What stands beside the pixels is not used.
    png_set_keep_unknown_chunks(work.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(work.png, work.info);
    png_set_expand(work.png);
    const bool stored_wide = png_get_bit_depth(work.png, work.info) == 16;
    if (type == PixelView::Type::u8) png_set_scale_16(work.png);
    if (type == PixelView::Type::u16) png_set_expand_16(work.png);
    if (type == PixelView::Type::u16 || (type == PixelView::Type::f32 && stored_wide)) png_set_swap(work.png);
    png_set_interlace_handling(work.png);
    return true;
}

bool update_info(PngWork& work) {
    if (setjmp(png_jmpbuf(work.png))) return false;
    png_read_update_info(work.png, work.info);
    return true;
}

bool read_pixels(PngWork& work, unsigned char** rows) {
    if (setjmp(png_jmpbuf(work.png))) return false;
    png_read_image(work.png, rows);  // nothing after the pixels is used: it may be missing
    return true;
}

/// Spreads samples that stand at the end of the buffer over the whole of it. A sample is read before it is written
/// over, because a float is no shorter than it.
template <class T>
void spread_to_floats(std::vector<unsigned char>& bytes) {
    const std::size_t n = bytes.size() / sizeof(float);
    const unsigned char* from = bytes.data() + n * (sizeof(float) - sizeof(T));
    constexpr float kScale = 1.0F / static_cast<float>(static_cast<T>(-1));
    for (std::size_t i = 0; i < n; ++i) {
        T sample;
        std::memcpy(&sample, from + i * sizeof(T), sizeof(T));
        const float value = static_cast<float>(sample) * kScale;
        std::memcpy(bytes.data() + i * sizeof(float), &value, sizeof(float));
    }
}

std::size_t size_of(PixelView::Type type) {
    return type == PixelView::Type::u8 ? 1 : type == PixelView::Type::u16 ? 2 : 4;
}

ImageFault decode_checked(const DecodeRequest& request, DecodedImage& out) {
    PngWork work(false);
    work.next = static_cast<const unsigned char*>(request.bytes);
    work.left = request.size;
    if (!work.info || !read_head(work, request.type)) return fault_of(work);
    const std::size_t width = png_get_image_width(work.png, work.info);
    const std::size_t height = png_get_image_height(work.png, work.info);
    if (width == 0 || height == 0) return {.message = "it has no pixels", .library = {}};
    if (width > request.max_pixels / height)
        return {.message = Message("it has {} × {} pixels with {} channels, which is too many", width, height,
                                   png_get_channels(work.png, work.info)),
                .library = {}};
    if (!update_info(work)) return fault_of(work);
    const std::size_t channels = png_get_channels(work.png, work.info);
    const std::size_t stored_row = png_get_rowbytes(work.png, work.info);
    const std::size_t row = width * channels * size_of(request.type);
    if (row * height > request.max_bytes)
        return {.message = Message("its pixels take {} MiB, more memory than there is", row * height >> 20),
                .library = {}};
    out.bytes.resize(row * height);
    std::vector<unsigned char*> rows(height);
    for (std::size_t y = 0; y < height; ++y) rows[y] = out.bytes.data() + (row - stored_row) * height + y * stored_row;
    if (!read_pixels(work, rows.data())) return fault_of(work);
    if (request.type == PixelView::Type::f32)
        stored_row == row / 2 ? spread_to_floats<std::uint16_t>(out.bytes) : spread_to_floats<std::uint8_t>(out.bytes);
    static const std::vector<std::string> names[5] = {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    out.width = static_cast<int>(width);
    out.height = static_cast<int>(height);
    out.channels = static_cast<int>(channels);
    out.channel_names = names[std::min<std::size_t>(channels, 4)];
    return {};
}

void round_to_16_bits(const float* from, std::vector<std::uint16_t>& to) {
    for (std::size_t i = 0; i < to.size(); ++i)
        to[i] = static_cast<std::uint16_t>(from[i] > 0 ? std::min(from[i], 1.0F) * 65535.0F + 0.5F : 0.0F);
}

bool write_file(PngWork& work, const EncodeRequest& request) {
    if (setjmp(png_jmpbuf(work.png))) return false;
    const PixelView& px = request.pixels;
    const ImageOptions& options = *request.options;
    const int colour_type[5] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                PNG_COLOR_TYPE_RGB_ALPHA};
    png_set_write_fn(work.png, &work, put_bytes, nullptr);
    png_set_user_limits(work.png, 0x7fffffff, 0x7fffffff);
    png_set_IHDR(work.png, work.info, static_cast<png_uint_32>(px.width), static_cast<png_uint_32>(px.height),
                 px.type == PixelView::Type::u8 ? 8 : 16, colour_type[px.channels], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(work.png, options.compression);
    png_set_compression_buffer_size(work.png, std::size_t{1} << 16);
    png_set_filter(work.png, PNG_FILTER_TYPE_BASE, PNG_NO_FILTERS);
    // A file has a profile or else says sRGB; not both (PNG, 11.3.2.5).
    if (!options.icc_profile.empty())
        png_set_iCCP(work.png, work.info, "ICC profile", PNG_COMPRESSION_TYPE_BASE, options.icc_profile.data(),
                     static_cast<png_uint_32>(options.icc_profile.size()));
    else if (options.srgb)
        png_set_sRGB_gAMA_and_cHRM(work.png, work.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(work.png, work.info);
    if (px.type != PixelView::Type::u8) png_set_swap(work.png);
    for (int y = 0; y < px.height; ++y) {
        const auto* row = static_cast<const unsigned char*>(px.first) + y * px.row_bytes;
        if (px.type == PixelView::Type::f32) {
            round_to_16_bits(reinterpret_cast<const float*>(row), work.row);
            row = reinterpret_cast<const unsigned char*>(work.row.data());
        }
        png_write_row(work.png, row);
    }
    png_write_end(work.png, work.info);
    return true;
}

ImageFault encode_checked(const EncodeRequest& request, std::vector<unsigned char>& out) {
    out.clear();
    PngWork work(true);
    work.file = &out;
    if (request.pixels.type == PixelView::Type::f32)
        work.row.resize(static_cast<std::size_t>(request.pixels.width) * request.pixels.channels);
    if (!work.info || !write_file(work, request)) return fault_of(work);
    return {};
}

}  // namespace

ImageFault encode_png(const EncodeRequest& request, std::vector<unsigned char>& out) {
    try {
        return encode_checked(request, out);
    } catch (const std::exception& e) {
        return {.message = {}, .library = e.what()};
    }
}

ImageFault decode_png(const DecodeRequest& request, DecodedImage& out) {
    try {
        return decode_checked(request, out);
    } catch (const std::exception& e) {
        return {.message = {}, .library = e.what()};
    }
}

}  // namespace tuft::io
