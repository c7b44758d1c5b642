#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include "core/files/files.h"
#include "io/image/icc_profile.h"
#include "io/image/image.h"
#include "io/package/zip.h"
#include "program.h"

/// Colour spaces and layers of `tuft export`, as other programs read them.
namespace tuft::test {
namespace {

using io::Image8;
using io::ImageF;

class Colours : public Program {
  protected:
    /// Three layers on the sheet: plain, half as opaque and multiplied, hidden.
    void SetUp() override {
        Program::SetUp();
        write("a.inkml", stroke_file("0 0 0", "wolf-small", 30));
        write("b.inkml", stroke_file("2 1 0", "goat-small", 30));
        const std::string p = " " + path("p.tuft");
        run_tuft("paint " + model("sheet.ply") + " --atlas-size 256 --ink cinnabar --strokes " + path("a.inkml") +
                 " --project" + p);
        run_tuft("paint" + p + " --strokes " + path("b.inkml") + " --layer 'blue & <thin>' --ink indigo");
        run_tuft("paint" + p + " --strokes " + path("b.inkml") + " --layer unseen --ink gamboge");
        run_tuft("layer" + p + " opacity 'blue & <thin>' 0.5");
        run_tuft("layer" + p + " blend 'blue & <thin>' multiply");
        run_tuft("layer" + p + " hide unseen");
    }
    void run_tuft(const std::string& arguments) const {
        const Ran ran = tuft(arguments);
        ASSERT_EQ(ran.status, 0) << arguments << '\n' << ran.err;
    }
    void exported(const std::string& name, const std::string& more = "") const {
        run_tuft("export " + path("p.tuft") + " -o " + path(name) + " --quiet " + more);
    }
    static Image8 picture_in(io::Zip& zip, const std::string& name) {
        return io::decode_image8(zip.read(name), name, std::size_t{1} << 24);
    }
};

TEST_F(Colours, OpenRasterHasTheLayersAndGivesTheWholePicture) {
    exported("p.ora");
    const std::vector<char> bytes = read_file(path("p.ora"));
    EXPECT_EQ(std::string(&bytes[30], 24), "mimetypeimage/openraster");  // first, stored: `file` finds it here
    io::Zip zip(bytes, "p.ora");
    const std::vector<char> text = zip.read("stack.xml");
    pugi::xml_document xml;
    ASSERT_TRUE(xml.load_buffer(text.data(), text.size()));
    const pugi::xml_node stack = xml.child("image").child("stack");
    EXPECT_EQ(xml.child("image").attribute("w").as_int(), 256);
    std::vector<pugi::xml_node> layers(stack.begin(), stack.end());
    ASSERT_EQ(layers.size(), 4u);  // the topmost first
    EXPECT_STREQ(layers[0].attribute("name").value(), "unseen");
    EXPECT_STREQ(layers[0].attribute("visibility").value(), "hidden");
    EXPECT_STREQ(layers[1].attribute("name").value(), "blue & <thin>");
    EXPECT_STREQ(layers[1].attribute("composite-op").value(), "svg:multiply");
    EXPECT_STREQ(layers[1].attribute("opacity").value(), "0.5");
    EXPECT_STREQ(layers[2].attribute("composite-op").value(), "svg:src-over");
    // Mixed as a reader mixes them.
    const Image8 merged = picture_in(zip, "mergedimage.png");
    std::vector<float> sum(merged.pixels.size(), 1);
    for (std::size_t l = layers.size(); l-- > 0;) {
        if (std::string_view(layers[l].attribute("visibility").value()) == "hidden") continue;
        const Image8 own = picture_in(zip, layers[l].attribute("src").value());
        ASSERT_EQ(own.pixels.size(), merged.pixels.size());
        const bool multiply = std::string_view(layers[l].attribute("composite-op").value()) == "svg:multiply";
        const float opacity = layers[l].attribute("opacity").as_float();
        for (std::size_t i = 0; i < own.pixels.size(); i += 4) {
            const float a = opacity * static_cast<float>(own.pixels[i + 3]) / 255;
            for (std::size_t c = i; c < i + 3; ++c) {
                const float v = static_cast<float>(own.pixels[c]) / 255;
                sum[c] = (1 - a) * sum[c] + a * (multiply ? v * sum[c] : v);
            }
        }
    }
    int painted = 0;
    double off = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        if (i % 4 == 3) continue;
        // Half a code of each of two layers, and of the colour below; what opacity 0.5 cannot darken is cut.
        const double d = std::abs(255 * sum[i] - merged.pixels[i]);
        off = std::max(off, d);
        painted += merged.pixels[i] != merged.pixels[i % 4];
    }
    EXPECT_LE(off, 2.0);
    EXPECT_GT(painted, 500);  // of 65,536 texels, in three channels
    const Image8 thumbnail = picture_in(zip, "Thumbnails/thumbnail.png");
    EXPECT_LE(thumbnail.width, 256);
}

TEST_F(Colours, ExrLayersByNameGiveTheWholePictureOverEachOther) {
    exported("l.exr", "--map layers --colour-space acescg");
    const ImageF all = io::read_image_float(path("l.exr"));
    ASSERT_EQ(all.channels, 3 + 4 * 3);  // the whole, the substrate, two layers
    const auto channel = [&](const std::string& name) {
        const auto at = std::find(all.channel_names.begin(), all.channel_names.end(), name);
        EXPECT_NE(at, all.channel_names.end()) << name;
        return static_cast<std::size_t>(at - all.channel_names.begin());
    };
    const std::vector<std::string> layers{"porcelain", "Layer 1", "blue & <thin>"};
    double off = 0;
    for (const char* c : {"R", "G", "B"})
        for (std::size_t i = 0; i < all.pixels.size(); i += static_cast<std::size_t>(all.channels)) {
            float sum = 0;
            for (const std::string& layer : layers)
                sum = sum * (1 - all.pixels[i + channel(layer + ".A")]) + all.pixels[i + channel(layer + "." + c)];
            off = std::max(off, double{std::abs(sum - all.pixels[i + channel(c)])});
        }
    EXPECT_LT(off, 3 * 1.0 / 2048);  // half floats: of two layers and the whole
}

TEST_F(Colours, PicturesCarryTheirSpaceAndAnotherReaderFindsIt) {
    exported("base-colour.png", "--colour-space display-p3 --bits 16");
    exported("srgb.png", "--colour-space srgb");
    exported("plain.png");
    exported("aces.png", "--colour-space acescg --bits 16");
    exported("aces.exr", "--colour-space acescg");
    // The same numbers with and without the profile of sRGB.
    EXPECT_EQ(io::read_image8(path("srgb.png")).pixels, io::read_image8(path("plain.png")).pixels);
    EXPECT_NE(read(path("srgb.png")).find("iCCP"), std::string::npos);
    EXPECT_EQ(read(path("plain.png")).find("iCCP"), std::string::npos);
    EXPECT_NE(read(path("aces.exr")).find("chromaticities"), std::string::npos);
    const Ran found = run("identify", "-verbose " + path("base-colour.png"));
    if (found.status != 0) GTEST_SKIP() << "ImageMagick is not installed";
    EXPECT_NE(found.out.find("icc:description: Display P3"), std::string::npos) << found.out;
    const Ran aces = run("identify", "-verbose " + path("aces.png"));
    EXPECT_NE(aces.out.find("icc:description: ACEScg"), std::string::npos) << aces.out;
}

TEST_F(Colours, RefusesSpacesThatAFileCannotHold) {
    for (const std::string& arguments :
         {"-o " + path("a.png") + " --colour-space acescg", "-o " + path("a.ora") + " --colour-space acescg",
          "-o " + path("a.glb") + " --colour-space display-p3", "-o " + path("height.png") + " --colour-space srgb",
          "-o " + path("a.png") + " --colour-space adobe", "-o " + path("a.png") + " --map layers",
          "-o " + path("a.glb") + " --filaments '#fff'", "-o " + path("a.3mf") + " --filaments red"}) {
        const Ran ran = tuft("export " + path("p.tuft") + " " + arguments);
        EXPECT_EQ(ran.status, 2) << arguments;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
}

TEST_F(Colours, FilamentsArePaintedAndTheDifferenceIsSaid) {
    exported("f.3mf", "--filaments '#f4f2ea,#b03020,#203060' --detail 1");
    EXPECT_TRUE(std::filesystem::exists(path("f.3mf")));
    const Ran inspected = tuft("inspect " + path("f.3mf"));
    EXPECT_EQ(inspected.status, 0) << inspected.err;
    exported("t.3mf");
    EXPECT_EQ(tuft("inspect " + path("t.3mf")).status, 0);
}

}  // namespace
}  // namespace tuft::test
