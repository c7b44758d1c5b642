#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "io/svg/svg.h"

/// Static files of the W3C's test suite for SVG 1.1: those of the Debian package librsvg2-tests, or in the folder
/// TUFT_SVG_SUITE; skipped where neither is there.
namespace tuft::io {
namespace {

namespace fs = std::filesystem;

// What every drawing program writes is never refused, and something of it is painted.
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
        EXPECT_FALSE(read_svg(file.path(), {.painting = SvgPainting::areas}).empty()) << name;
    }
    EXPECT_GT(n, 30u);
}

}  // namespace
}  // namespace tuft::io
