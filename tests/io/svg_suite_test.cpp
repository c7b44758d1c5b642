#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/image/image.h"
#include "io/svg/svg.h"
#include "stroke/painting/apply_area.h"

/// Static files of the W3C's test suite for SVG 1.1: those of the Debian package librsvg2-tests, or in the folder
/// TUFT_SVG_SUITE; skipped where neither is there.
namespace tuft::io {
namespace {

namespace fs = std::filesystem;

/// Parts of the suite's picture of a file that its areas paint otherwise, of every fourth row and column: all, and
/// those that are not grey in both. Left out are pixels that differ from a neighbour by more than a shade: edges.
std::pair<double, double> wrong_parts(const fs::path& file, const fs::path& picture) {
    const Image8 wanted = read_image8(picture);
    const std::vector<stroke::RecordedStroke> strokes = read_svg(file, {.painting = SvgPainting::areas});
    constexpr double kPixel = 0.0254 / 96;
    constexpr int kStep = 4, kShade = 48;
    std::map<std::pair<int, int>, Vec3> painted;
    const auto pixel = [&](int x, int y) {
        const std::uint8_t* p = &wanted.pixels[std::size_t(y * wanted.width + x) * std::size_t(wanted.channels)];
        const double cover = wanted.channels == 4 ? p[3] / 255.0 : 1;
        return glm::mix(Vec3(255), Vec3(p[0], p[1], p[2]), cover);
    };
    const auto apart = [](const Vec3& a, const Vec3& b) {
        const Vec3 d = glm::abs(a - b);
        return std::max({d.x, d.y, d.z}) > kShade;
    };
    for (int y = 2; y + 1 < wanted.height; y += kStep)
        for (int x = 2; x + 1 < wanted.width; x += kStep) {
            bool edge = false;
            for (int v = -1; v <= 1; ++v)
                for (int u = -1; u <= 1; ++u) edge |= apart(pixel(x + u, y + v), pixel(x, y));
            if (!edge) painted[{x, y}] = Vec3(255);
        }
    for (const stroke::RecordedStroke& s : strokes) {
        const stroke::FlatArea& area = *std::get<stroke::Fill>(s.before.at(0)).area;
        const stroke::AreaRaster raster(area, kPixel);
        const unsigned long rgb = std::stoul(area.stops.at(0).ink.substr(1), nullptr, 16);
        const Vec3 ink(double(rgb >> 16), double(rgb >> 8 & 255), double(rgb & 255));
        for (auto& [at, colour] : painted) {
            const Vec2 p = kPixel * Vec2(at.first + 0.5, at.second + 0.5);
            if (glm::all(glm::lessThan(raster.low(), p)) && glm::all(glm::lessThan(p, raster.high())))
                colour += raster.mean(p, 1e-9) * area.stops[0].opacity * (ink - colour);
        }
    }
    double wrong = 0, wrong_colours = 0;
    for (const auto& [at, colour] : painted) {
        const Vec3 goal = pixel(at.first, at.second);
        if (!apart(colour, goal)) continue;
        ++wrong;
        const auto is_grey = [&](const Vec3& c) { return !apart(c, Vec3(c.y)); };
        wrong_colours += !is_grey(colour) || !is_grey(goal);
    }
    const double all = double(std::max<std::size_t>(painted.size(), 1));
    return {wrong / all, wrong_colours / all};
}

// What every drawing program writes is never refused, and painted as the suite's pictures have it. Their black
// letters, up to 40 pixels high, are in another font than ours and cover some hundredths of a page.
TEST(SvgSuite, ShapesPathsAndPaintsAreRead) {
    const char* const stated = std::getenv("TUFT_SVG_SUITE");
    const fs::path suite = stated ? stated : "/usr/libexec/installed-tests/RSVG/fixtures/reftests/svg1.1";
    if (!fs::is_directory(suite)) GTEST_SKIP() << suite << " is not here: install librsvg2-tests";
    std::size_t n = 0;
    for (const auto& file : fs::directory_iterator(suite)) {
        const std::string name = file.path().filename().string();
        const auto begins = [&](const char* family) { return name.starts_with(family); };
        constexpr std::array kFamilies{"paths-data-", "shapes-", "painting-stroke-", "coords-trans-"};
        if (file.path().extension() != ".svg" || std::ranges::none_of(kFamilies, begins)) continue;
        ++n;
        const auto [all, coloured] = wrong_parts(file.path(), suite / (file.path().stem().string() + "-ref.png"));
        EXPECT_LT(all, 0.05) << name;
        EXPECT_LT(coloured, 0.01) << name;
    }
    EXPECT_GT(n, 30u);
}

}  // namespace
}  // namespace tuft::io
