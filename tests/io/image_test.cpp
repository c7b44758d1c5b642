#include "io/image/image.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>

#include "core/error.h"
#include "core/files/files.h"
#include "core/random.h"
#include "io/image/exr_header.h"
#include "sample_model.h"

namespace tuft::io {
namespace {

using testing::Folder;

template <class T>
Image<T> noise(int width, int height, int channels, std::uint64_t seed) {
    Image<T> image{.width = width, .height = height, .channels = channels, .pixels = {}};
    for (int i = 0; i < width * height * channels; ++i) {
        if constexpr (std::is_same_v<T, float>)
            image.pixels.push_back(static_cast<float>(uniform(seed, i) * 1000 - 300));
        else
            image.pixels.push_back(static_cast<T>(hash_bits(seed, i)));
    }
    return image;
}

TEST(Image, Png8BringsBackEveryByte) {
    const Folder folder("png8");
    for (int channels = 1; channels <= 4; ++channels) {
        // Four channels with alpha 0 and partial alpha: colour must survive there too.
        const Image8 image = noise<std::uint8_t>(37, 21, channels, channels);
        for (const bool srgb : {false, true}) {
            write_image(folder / "a.png", view_of(image), {.srgb = srgb, .channel_names = {}});
            EXPECT_EQ(read_image8(folder / "a.png"), image) << channels;
        }
    }
}

TEST(Image, Png16BringsBackEveryValue) {
    const Folder folder("png16");
    for (int channels = 1; channels <= 4; ++channels) {
        const Image16 image = noise<std::uint16_t>(19, 33, channels, channels);
        write_image(folder / "a.png", view_of(image));
        EXPECT_EQ(read_image16(folder / "a.png"), image) << channels;
    }
}

/// Writes a 5 × 3 picture as others store theirs. Samples are packed into rows from the highest bit on.
void write_foreign_png(const std::filesystem::path& path, int type, int bits, bool interlaced, bool one_transparent,
                       const std::function<int(int x, int y, int channel)>& sample) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::FILE* file = std::fopen(path.c_str(), "wb");
    png_init_io(png, file);
    png_set_IHDR(png, info, 5, 3, bits, type, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
    const png_color colours[3] = {{10, 20, 30}, {40, 50, 60}, {200, 100, 0}};
    const png_byte alphas[2] = {255, 77};
    png_color_16 clear{};
    clear.gray = 1;
    if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, colours, 3);
    if (one_transparent) png_set_tRNS(png, info, alphas, 2, &clear);
    const int channels = png_get_channels(png, info);
    std::vector<png_byte> pixels(3 * png_get_rowbytes(png, info));
    std::vector<png_bytep> rows;
    for (int y = 0; y < 3; ++y) {
        rows.push_back(pixels.data() + y * png_get_rowbytes(png, info));
        for (int i = 0; i < 5 * channels; ++i)
            for (int bit = 0; bit < bits; ++bit)
                if (sample(i / channels, y, i % channels) >> (bits - 1 - bit) & 1)
                    rows[y][(i * bits + bit) / 8] |= static_cast<png_byte>(0x80 >> (i * bits + bit) % 8);
    }
    png_set_rows(png, info, rows.data());
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

TEST(Image, PngOfEveryKindIsReadAsItsStandardSays) {
    const Folder folder("foreign");
    const std::filesystem::path path = folder / "a.png";
    const auto level = [](int x, int y, int channel) { return (x * 7 + y * 13 + channel * 29 + 5) % 251; };
    for (const bool interlaced : {false, true}) {
        for (const int bits : {1, 2, 4, 8}) {  // grey: a sample v of b bits is v / (2^b − 1)
            const int top = (1 << bits) - 1;
            write_foreign_png(path, PNG_COLOR_TYPE_GRAY, bits, interlaced, false,
                              [&](int x, int y, int c) { return level(x, y, c) & top; });
            const Image8 grey = read_image8(path);
            const Image16 wide = read_image16(path);
            const ImageF real = read_image_float(path);
            ASSERT_EQ(grey.channels, 1);
            EXPECT_EQ(grey.channel_names, std::vector<std::string>{"Y"});
            for (int i = 0; i < 15; ++i) {
                const int v = level(i % 5, i / 5, 0) & top;
                EXPECT_EQ(grey.pixels[i], v * 255 / top);
                EXPECT_EQ(wide.pixels[i], v * 65535 / top);
                EXPECT_FLOAT_EQ(real.pixels[i], static_cast<float>(v) / static_cast<float>(top));
            }
        }
        for (const bool clear : {false, true}) {
            for (const int bits : {2, 8}) {  // a palette
                write_foreign_png(path, PNG_COLOR_TYPE_PALETTE, bits, interlaced, clear,
                                  [&](int x, int y, int c) { return level(x, y, c) % 3; });
                const Image8 image = read_image8(path);
                ASSERT_EQ(image.channels, clear ? 4 : 3);
                const int colours[3][4] = {{10, 20, 30, 255}, {40, 50, 60, 77}, {200, 100, 0, 255}};
                for (int i = 0; i < 15 * image.channels; ++i)
                    EXPECT_EQ(
                        image.pixels[i],
                        colours[level(i / image.channels % 5, i / image.channels / 5, 0) % 3][i % image.channels]);
            }
        }
        write_foreign_png(path, PNG_COLOR_TYPE_GRAY, 8, interlaced, true, [](int x, int, int) { return x; });
        const Image8 keyed = read_image8(path);  // one level is transparent
        ASSERT_EQ(keyed.channels, 2);
        for (int i = 0; i < 15; ++i) {
            EXPECT_EQ(keyed.pixels[2 * i], i % 5);
            EXPECT_EQ(keyed.pixels[2 * i + 1], i % 5 == 1 ? 0 : 255);
        }
        const auto wide_level = [&](int x, int y, int c) { return level(x, y, c) * 257 + 100; };
        write_foreign_png(path, PNG_COLOR_TYPE_RGB_ALPHA, 16, interlaced, false, wide_level);
        const Image16 wide = read_image16(path);
        const Image8 narrow = read_image8(path);
        const ImageF real = read_image_float(path);
        ASSERT_EQ(wide.channels, 4);
        for (int i = 0; i < 60; ++i) {
            const int v = wide_level(i / 4 % 5, i / 20, i % 4);
            EXPECT_EQ(wide.pixels[i], v);
            EXPECT_EQ(narrow.pixels[i], std::lround(v * 255.0 / 65535));
            EXPECT_FLOAT_EQ(real.pixels[i], static_cast<float>(v) / 65535);
        }
    }
}

TEST(Image, ExrBringsBackEveryFloat) {
    const Folder folder("exr");
    for (int channels : {1, 3, 8}) {
        const ImageF image = noise<float>(20, 17, channels, channels);
        ImageOptions options;
        if (channels == 8) options.channel_names = {"p0", "p1", "p2", "p3", "p4", "p5", "p6", "p7"};
        write_image(folder / "a.exr", view_of(image), options);
        EXPECT_EQ(read_image_float(folder / "a.exr"), image) << channels;
    }
}

// Binary16 has 11 significant bits: rounding is off by at most 2^-11 of the value, above its
// least normal number, 2^-14 (below, by half of 2^-24).
TEST(Image, HalfFloatsInExrAreOffByTheirRoundingOnly) {
    const Folder folder("half");
    const ImageF image = noise<float>(20, 17, 3, 3);
    ImageOptions half;
    half.half = true;
    write_image(folder / "h.exr", view_of(image), half);
    write_image(folder / "f.exr", view_of(image));
    const ImageF read = read_image_float(folder / "h.exr");
    ASSERT_EQ(read.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < read.pixels.size(); ++i)
        EXPECT_LE(std::abs(read.pixels[i] - image.pixels[i]),
                  std::max(std::ldexp(std::abs(image.pixels[i]), -11), 0x1p-25f));
    EXPECT_NE(read, image);
    EXPECT_LT(std::filesystem::file_size(folder / "h.exr"), std::filesystem::file_size(folder / "f.exr"));
}

TEST(Image, FloatsBecomeSixteenBitsInPng) {
    const Folder folder("float_png");
    ImageF image{.width = 5, .height = 1, .channels = 1, .pixels = {0, 0.25f, 0.5f, 1, 2}};
    write_image(folder / "a.png", view_of(image));
    const Image16 back = read_image16(folder / "a.png");
    EXPECT_EQ(back.pixels[0], 0);
    EXPECT_NEAR(back.pixels[1], 16384, 1);
    EXPECT_NEAR(back.pixels[2], 32768, 1);
    EXPECT_EQ(back.pixels[3], 65535);
    EXPECT_EQ(back.pixels[4], 65535) << "clipped";
}

TEST(Image, AtlasMapsAreTurnedUpsideDown) {
    const Folder folder("flip");
    ink::AtlasMap<std::uint8_t> map{.size = 2, .channels = 1, .texels = {1, 2, 3, 4}};
    write_image(folder / "a.png", view_of(map));
    EXPECT_EQ(read_image8(folder / "a.png").pixels, (std::vector<std::uint8_t>{3, 4, 1, 2}))
        << "the row at v = 0 is the last one in the file";
}

// OpenEXR takes memory for an attribute and for the rows of a picture before it reads them.
TEST(Image, SizesInTheHeadOfAnExrFileAreCheckedBeforeMemoryIsTaken) {
    const Folder folder("exr_head");
    write_image(folder / "a.exr", view_of(noise<float>(20, 17, 3, 1)));
    const std::vector<char> sound = read_file(folder / "a.exr");
    ASSERT_TRUE(exr_header_fault(sound, 20 * 17).empty());
    EXPECT_NE(exr_header_fault(sound, 20 * 17 - 1).text().find("20 × 17 pixels"), std::string::npos);
    const auto fault_with = [&](const std::string& name, const std::string& type, std::size_t at, std::uint32_t value) {
        const std::string head = name + '\0' + type + '\0';
        std::vector<char> bytes = sound;
        const auto place = std::search(bytes.begin(), bytes.end(), head.begin(), head.end());
        EXPECT_NE(place, bytes.end()) << name;
        std::memcpy(&*place + head.size() + at, &value, sizeof value);
        write_file(folder / "b.exr", bytes.data(), bytes.size());
        try {
            read_image_float(folder / "b.exr");
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    for (const std::uint32_t size : {0x7fffffffu, 0xffffffffu, static_cast<std::uint32_t>(sound.size())})
        EXPECT_NE(fault_with("channels", "chlist", 0, size).find("an attribute of its header"), std::string::npos);
    // After the attribute's size: xMin, yMin, xMax, yMax.
    EXPECT_NE(fault_with("dataWindow", "box2i", 16, 0x7fffffff).find("pixels, which is too many"), std::string::npos);
    EXPECT_NE(fault_with("dataWindow", "box2i", 4, 0x7fffffff).find("no pixels"), std::string::npos);
    // The head ends before the first row.
    for (std::size_t n = 0; n < 200; ++n) EXPECT_FALSE(exr_header_fault(std::span(sound).first(n), 1000).empty()) << n;
}

TEST(Image, BadFilesAreErrors) {
    const Folder folder("bad");
    write_image(folder / "a.png", view_of(noise<std::uint8_t>(64, 64, 3, 1)));
    std::vector<char> bytes = read_file(folder / "a.png");
    for (const std::size_t size : {bytes.size() - 1, bytes.size() / 2, std::size_t{40}, std::size_t{9}}) {
        write_file(folder / "cut.png", bytes.data(), size);
        // The last byte is only part of a checksum after the picture.
        if (size < bytes.size() - 1)
            EXPECT_THROW(read_image8(folder / "cut.png"), Error) << size;
        else
            EXPECT_EQ(read_image8(folder / "cut.png"), read_image8(folder / "a.png"));
    }
    EXPECT_THROW(read_image8(folder / "missing.png"), Error);
    EXPECT_THROW(read_image8(folder / "a.png", 4000), Error) << "64 × 64 is more";
    const std::string text = "this is no picture";
    write_file(folder / "text.png", text.data(), text.size());
    EXPECT_THROW(read_image8(folder / "text.png"), Error);
    EXPECT_THROW(write_image(folder / "a.bmp", view_of(noise<std::uint8_t>(4, 4, 3, 1))), Error);
    EXPECT_THROW(write_image(folder / "no/such/folder/a.png", view_of(noise<std::uint8_t>(4, 4, 3, 1))), Error);
    EXPECT_THROW(write_image(folder / "a.png", PixelView{}), Error);
}

}  // namespace
}  // namespace tuft::io
