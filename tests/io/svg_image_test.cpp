#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <numbers>

#include "core/files/files.h"
#include "io/image/image.h"
#include "io/svg/svg.h"

/// Pictures in drawings: read as stencils of ink by darkness.
namespace tuft::io {
namespace {

/// 16 × 16 pixels, grey from black at the left to white at the right (mjpeg of ffmpeg 6).
constexpr const char* kJpeg =
    "data:image/jpeg;base64,"
    "/9j/4AAQSkZJRgABAgAAAQABAAD//gAQTGF2YzU5LjM3LjEwMAD/"
    "2wBDAAgEBAQEBAUFBQUFBQYGBgYGBgYGBgYGBgYHBwcICAgHBwcGBgcHCAgICAkJ"
    "CQgICAgJCQoKCgwMCwsODg4RERT/"
    "xABSAAEBAQAAAAAAAAAAAAAAAAAABwgBAQAAAAAAAAAAAAAAAAAAAAAQAAIDAQEAAAAAAAAAAAAAAAACcsEHMzQR"
    "AQAAAAAAAAAAAAAAAAAAAAD/wAARCAAQABADARIAAhIAAxIA/9oADAMBAAIRAxEAPwCaZX2SdjK+yTsANM5d51hQy7zrCgA//9k=";

std::string base64(const std::vector<unsigned char>& bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t v = 0;
        for (std::size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[v >> (18 - 6 * k) & 63];
    }
    return out;
}

/// Grey with alpha, 4 × 2: light rises to the right, the lower row is half transparent.
std::vector<unsigned char> png() {
    const std::uint8_t pixels[] = {0, 255, 80, 255, 160, 255, 255, 255, 0, 128, 80, 128, 160, 128, 255, 128};
    return png_bytes(view_of(4, 2, 2, pixels));
}

struct Read {
    std::vector<stroke::FlatArea> areas;
    std::vector<std::string> notes;
};

Read read(const std::string& inside, const std::filesystem::path& folder = {}) {
    Read out;
    SvgOptions options{.painting = SvgPainting::areas, .folder = folder};
    options.ink.note = [&](const Message& line) { out.notes.push_back(line.text()); };
    // A mark keeps a drawing without its image from being empty.
    for (const stroke::RecordedStroke& r : parse_svg(
             "<svg width='100mm' viewBox='0 0 100 100'><rect width='1' height='1' fill='red'/>" + inside + "</svg>",
             "a.svg", options))
        if (const auto& area = std::get<stroke::Fill>(r.before.at(0)).area;
            area->gradient != stroke::AreaGradient::none)
            out.areas.push_back(*area);
    return out;
}

double area_of(const stroke::FlatArea& area) {
    double sum = 0;
    for (const auto& ring : area.rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
            sum += 0.5 * (a.x * b.y - a.y * b.x);
        }
    return 1e6 * std::abs(sum);
}

TEST(SvgImage, APngIsInkByDarknessTimesAlpha) {
    const Read r =
        read("<image x='20' y='30' width='40' height='20' href='data:image/png;base64," + base64(png()) + "'/>");
    ASSERT_EQ(r.areas.size(), 1u);
    const stroke::FlatArea& area = r.areas[0];
    EXPECT_EQ(area.image.width, 4);
    EXPECT_EQ(area.image.height, 2);
    EXPECT_EQ(area.image.darkness, (std::vector<std::uint8_t>{255, 175, 95, 0, 128, 88, 48, 0}));
    EXPECT_NEAR(area_of(area), 800, 1e-4);  // Clipper's grid: 2⁻³⁰ of 0.1 m along 120 mm
    // The middles of the pixels, and half between two: bilinear.
    EXPECT_NEAR(along_area(area, {0.025, 0.035}), 1, 1e-9);
    EXPECT_NEAR(along_area(area, {0.035, 0.035}), 175 / 255.0, 1e-9);
    EXPECT_NEAR(along_area(area, {0.030, 0.035}), 0.5 * (1 + 175 / 255.0), 1e-9);
    EXPECT_NEAR(along_area(area, {0.055, 0.045}), 0, 1e-9);
    // The mean over the whole picture is that of its pixels but for the half pixels at its rim.
    EXPECT_NEAR(along_area(area, {0.04, 0.04}, 0.02), (175 + 95 + 88 + 48) / 4 / 255.0, 0.02);
    EXPECT_EQ(area.stops.front().opacity, 0);
    EXPECT_EQ(area.stops.back().opacity, 1);
    EXPECT_EQ(area.stops.back().ink, "#000000");
    EXPECT_EQ(stroke::area_of_text(stroke::text_of(area)).image, area.image);
}

TEST(SvgImage, AJpegClippedAndTurnedKeepsItsPlace) {
    const Read r = read(
        "<clipPath id='c'><circle cx='20' cy='20' r='12'/></clipPath><g transform='translate(50 40) "
        "rotate(90)'><image width='32' height='32' transform='translate(4 4)' href='" +
        std::string(kJpeg) + "' clip-path='url(#c)' opacity='.5'/></g>");
    ASSERT_EQ(r.areas.size(), 1u);
    const stroke::FlatArea& area = r.areas[0];
    EXPECT_EQ(area.stops.back().opacity, 0.5);
    EXPECT_NEAR(area_of(area), std::numbers::pi * 144, 1) << "chords of the clip path";
    // (x, y) of the image lies at (50 − y − 4, 40 + x + 4) mm: it grows lighter downwards. The pixels are those of
    // another decoder; decoders round to within 2.
    constexpr int kPixels[] = {0, 2, 20, 41, 61, 81, 100, 120, 140, 160, 179, 199, 220, 239, 255, 255};
    for (int x = 0; x < 16; ++x)
        EXPECT_NEAR(along_area(area, 1e-3 * Vec2(50 - 20, 44 + 2 * x + 1)), 1 - kPixels[x] / 255.0, 2 / 255.0) << x;
}

TEST(SvgImage, FillsItsRectangleAsItsRatioSays) {
    const std::string image = "<image x='10' y='10' width='40' height='40' href='data:image/png;base64," +
                              base64(png()) + "' preserveAspectRatio='";
    EXPECT_NEAR(area_of(read(image + "xMidYMid'/>").areas.at(0)), 40 * 20, 1e-3);
    EXPECT_NEAR(area_of(read(image + "none'/>").areas.at(0)), 40 * 40, 1e-3);
    const stroke::FlatArea slice = read(image + "xMinYMin slice'/>").areas.at(0);
    EXPECT_NEAR(area_of(slice), 40 * 40, 1e-3);
    EXPECT_NEAR(along_area(slice, {0.02, 0.02}), 1, 1e-9) << "pixels of 20 mm";
}

TEST(SvgImage, AFileLiesInTheDrawingsFolder) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / ("tuft_svg_image_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "in");
    const std::vector<unsigned char> bytes = png();
    for (const char* name : {"in/a b.png", "out.png"}) write_file(folder / name, bytes.data(), bytes.size());
    const auto image = [](const std::string& href) { return "<image width='9' height='9' href='" + href + "'/>"; };
    EXPECT_EQ(read(image("a%20b.png"), folder / "in").areas.size(), 1u);
    EXPECT_EQ(read(image("in/a b.png"), folder).areas.size(), 1u);
    for (const std::string& href :
         {std::string("../out.png"), (folder / "out.png").string(), std::string("https://a.b/c.png"),
          std::string("file:///etc/passwd"), std::string("gone.png"), std::string("data:image/png;base64,AAAA"),
          std::string("data:image/png,abc"), std::string("data:image/svg+xml;base64,PHN2Zy8+"), std::string()}) {
        const Read r = read(image(href), folder / "in");
        EXPECT_TRUE(r.areas.empty()) << href;
        ASSERT_EQ(r.notes.size(), 1u) << href;
        EXPECT_TRUE(r.notes[0].starts_with("an image is left out: ")) << r.notes[0];
    }
    EXPECT_NE(read(image("../out.png"), folder / "in").notes[0].find("'s folder"), std::string::npos);
    EXPECT_TRUE(read(image("a b.png")).areas.empty()) << "no folder, no file";
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace tuft::io
