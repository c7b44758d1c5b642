#include "io/image/image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

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
        // The last byte is only part of a checksum after the picture; libpng may do without.
        if (size < bytes.size() - 1) {
            EXPECT_THROW(read_image8(folder / "cut.png"), Error) << size;
        }
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
