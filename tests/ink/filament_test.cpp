#include "ink/composite/filament.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/random.h"
#include "ink/spectra/colorimetry.h"

namespace tuft::ink {
namespace {

double delta_e(const Rgb& a, const Rgb& b) {
    return delta_e_2000(lab_of_rgb({double{a[0]}, double{a[1]}, double{a[2]}}),
                        lab_of_rgb({double{b[0]}, double{b[1]}, double{b[2]}}));
}

double luminance(const Rgb& c) {
    return 0.2126 * double{c[0]} + 0.7152 * double{c[1]} + 0.0722 * double{c[2]};
}

TEST(Filament, AThickWallHasItsColourAndAThinOneThatOfTheCore) {
    const Filament red{"red", {0.4f, 0.05f, 0.04f}, 1e-3}, white{"white", {0.9f, 0.9f, 0.88f}, 2e-3};
    // A ten times hiding wall lets 10⁻⁸ through; the bands of a deep red are cut a little.
    EXPECT_LT(delta_e(colour_of_wall(red, white, 1e-2), red.colour), 0.05);
    EXPECT_LT(delta_e(colour_of_wall(red, white, 1e-9), white.colour), 0.05);
    // Over black, as thick as it hides, it has 98 % of its luminance.
    const Filament black{"black", {0, 0, 0}, 0};
    EXPECT_NEAR(luminance(colour_of_wall(red, black, 1e-3)) / luminance(red.colour), 0.98, 1e-3);
    // Its lightness falls from the core's to its own all the while.
    double last = luminance(white.colour);
    for (double wall = 1e-5; wall < 1e-2; wall *= 2) {
        const double now = luminance(colour_of_wall(red, white, wall));
        EXPECT_LT(now, last + 1e-6) << wall;
        last = now;
    }
    EXPECT_EQ(colour_of_wall(black, white, 1e-9), black.colour);  // opaque
}

TEST(Filament, TheChoiceIsTheOptimumOverAllAssignments) {
    const std::vector<Filament> filaments{{"white", {0.9f, 0.9f, 0.88f}, 1e-3},
                                          {"red", {0.4f, 0.05f, 0.04f}, 0.8e-3},
                                          {"blue", {0.02f, 0.05f, 0.3f}, 0.5e-3}};
    std::vector<Rgb> printed;
    for (const Filament& f : filaments) printed.push_back(colour_of_wall(f, filaments[0], 0.45e-3));
    constexpr std::size_t kTriangles = 6;
    Random random(3);
    std::array<std::vector<ColourPatch>, kTriangles> triangles;
    for (auto& patches : triangles)
        for (int i = 0; i < 4; ++i)
            patches.push_back({{static_cast<float>(random.uniform(0, 1)), static_cast<float>(random.uniform(0, 1)),
                                static_cast<float>(random.uniform(0, 1))},
                               random.uniform(0.1, 1)});
    const auto mean = [&](const std::array<std::size_t, kTriangles>& filament) {
        double sum = 0, area = 0;
        for (std::size_t t = 0; t < kTriangles; ++t)
            for (const ColourPatch& p : triangles[t]) {
                sum += p.area * delta_e(p.colour, printed[filament[t]]);
                area += p.area;
            }
        return sum / area;
    };
    std::array<std::size_t, kTriangles> chosen{}, best{};
    for (std::size_t t = 0; t < kTriangles; ++t) chosen[t] = choose_filament(triangles[t], printed).filament;
    double least = 1e300;
    for (std::size_t code = 0; code < 729; ++code) {  // 3⁶
        std::array<std::size_t, kTriangles> all{};
        for (std::size_t t = 0, rest = code; t < kTriangles; ++t, rest /= 3) all[t] = rest % 3;
        if (mean(all) < least) {
            least = mean(all);
            best = all;
        }
    }
    EXPECT_EQ(chosen, best);
    EXPECT_NEAR(mean(chosen), least, 1e-12);  // the same sum
}

TEST(Filament, FilesAreReadAndRefusedWithTheirLine) {
    const std::filesystem::path path =
        std::filesystem::path(::testing::TempDir()) / ("tuft_filaments_" + std::to_string(getpid()) + ".toml");
    const auto read = [&](const std::string& text) {
        std::ofstream(path) << text;
        return load_filaments(path);
    };
    const auto two = read(
        "[[filament]]\nname = \"PLA\"\ncolour = \"#ffffff\"\nhiding_mm = 1.5\n"
        "[[filament]]\ncolour = \"#102030\"\n");
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].name, "PLA");
    EXPECT_DOUBLE_EQ(two[0].hiding, 1.5e-3);
    EXPECT_EQ(two[1].name, "#102030");
    for (const char* bad : {"", "x = 1\n", "[[filament]]\nname = \"a\"\n", "[[filament]]\ncolour = \"reddish\"\n",
                            "[[filament]]\ncolour = \"#fff\"\nhiding_mm = -1\n", "[filament]\ncolour = \"#fff\"\n"})
        EXPECT_THROW(read(bad), Error) << bad;
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace tuft::ink
