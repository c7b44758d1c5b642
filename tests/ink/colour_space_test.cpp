#include "ink/spectra/colour_space.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ink/colour/pigments.h"
#include "ink/composite/composite.h"
#include "ink/spectra/colorimetry.h"

namespace tuft::ink {
namespace {

constexpr std::array kAll{ColourSpace::srgb, ColourSpace::display_p3, ColourSpace::acescg};

void expect_matrix(const Matrix3& m, const Matrix3& expected, double tolerance) {
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(m[i][j], expected[i][j], tolerance) << i << ' ' << j;
}

TEST(ColourSpace, MatricesAreThePublishedOnes) {
    // CSS Color 4, sample code; and OpenColorIO's built-in "ACEScg to linear Rec. 709" inverted: both give eight
    // digits, from whites with four digits and with five.
    expect_matrix(from_linear_srgb(ColourSpace::display_p3),
                  {{{0.82246197, 0.17753803, 0}, {0.03319420, 0.96680580, 0}, {0.01708263, 0.07239744, 0.91051993}}},
                  2e-6);
    expect_matrix(from_linear_srgb(ColourSpace::acescg),
                  {{{0.61309740, 0.33952315, 0.04737945},
                    {0.07019372, 0.91635388, 0.01345240},
                    {0.02061559, 0.10956977, 0.86981463}}},
                  2e-5);
    expect_matrix(from_linear_srgb(ColourSpace::srgb), {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 0);
    // The profile of sRGB by the ICC (sRGB_v4): its colourants, in steps of 1/65536.
    expect_matrix(xyz_d50_of_linear(ColourSpace::srgb),
                  {{{0.4360, 0.3851, 0.1431}, {0.2225, 0.7169, 0.0606}, {0.0139, 0.0971, 0.7141}}}, 2e-4);
}

TEST(ColourSpace, WhiteStaysWhiteAndColoursReturn) {
    for (const ColourSpace space : kAll) {
        for (const float v : transform(from_linear_srgb(space), {1, 1, 1})) EXPECT_NEAR(v, 1, 1e-6);  // rounding
        for (const Rgb& c : {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{0.2f, 0.7f, 0.1f}}) {
            const Rgb back = transform(to_linear_srgb(space), transform(from_linear_srgb(space), c));
            for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[k], c[k], 1e-6);  // of float
        }
        // The primaries have their chromaticities.
        const Matrix3 xyz = xyz_of_linear(space);
        const double sum = xyz[0][1] + xyz[1][1] + xyz[2][1];
        EXPECT_NEAR(xyz[0][1] / sum, data_of(space).green.x, 1e-12);
        EXPECT_NEAR(xyz[1][1] / sum, data_of(space).green.y, 1e-12);
        EXPECT_EQ(colour_space_named(data_of(space).name), space);
    }
    EXPECT_FALSE(colour_space_named("srgbs"));
}

TEST(ColourSpace, IntoGamutKeepsLuminanceAndHue) {
    const Rgb deep =
        into_gamut(transform(from_linear_srgb(ColourSpace::display_p3), {-0.1f, 0.9f, 0.2f}), ColourSpace::display_p3);
    for (const float v : deep) {
        EXPECT_GE(v, -1e-6f);
        EXPECT_LE(v, 1 + 1e-6f);
    }
    const Rgb inside{0.3f, 0.5f, 0.2f};
    EXPECT_EQ(into_gamut(inside, ColourSpace::acescg), inside);
}

/// Lab of the first texel of a tile with `film` units of the ink's pigments on porcelain, composed in a space.
Lab shown(const Ink& ink, double film, ColourSpace space) {
    Canvas canvas(1);
    for (const InkPart& part : ink.parts)
        canvas.touch(0, canvas.add_pigment(part.pigment))[0] += static_cast<float>(film * double{part.fraction});
    const TileAppearance tile = shade_tile(Stack(canvas), 0, load_substrate("porcelain"), true, space);
    const Rgb back = transform(to_linear_srgb(space), {tile.colour[0][0], tile.colour[1][0], tile.colour[2][0]});
    return lab_of_rgb({double{back[0]}, double{back[1]}, double{back[2]}});
}

TEST(ColourSpace, AWiderSpaceIsNearerToTheSpectrumAndTheSameInsideTheGamut) {
    std::size_t cut = 0, inside = 0;
    for (const std::string& name : list_inks()) {
        const Ink ink = load_ink(name);
        if (ink.parts.empty()) continue;
        for (const double film : {0.1, 0.3, 1.0, 3.0}) {
            // Nothing of a pigment lies outside ACEScg.
            const Lab whole = shown(ink, film, ColourSpace::acescg);
            const double srgb = delta_e_2000(shown(ink, film, ColourSpace::srgb), whole),
                         p3 = delta_e_2000(shown(ink, film, ColourSpace::display_p3), whole);
            // Floats of 24 bands and back through two matrices.
            constexpr double kRounding = 2e-3;
            EXPECT_LE(p3, srgb + kRounding) << name << ' ' << film;
            if (srgb <= kRounding)
                ++inside;
            else
                ++cut;
        }
    }
    EXPECT_GT(inside, 10u);  // greys and browns
    EXPECT_GT(cut, 0u);      // yellow and red: what the wider spaces are for
}

}  // namespace
}  // namespace tuft::ink
