#include "ink/spectra/colour_space.h"

#include <OpenColorIO/OpenColorIO.h>
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
    // CSS Color 4, sample code, and ACES, "AP1 to linear Rec. 709" inverted: eight digits, the last one rounded.
    expect_matrix(from_linear_srgb(ColourSpace::display_p3),
                  {{{0.82246197, 0.17753803, 0}, {0.03319420, 0.96680580, 0}, {0.01708263, 0.07239744, 0.91051993}}},
                  1e-8);
    expect_matrix(from_linear_srgb(ColourSpace::acescg),
                  {{{0.61309740, 0.33952315, 0.04737945},
                    {0.07019372, 0.91635388, 0.01345240},
                    {0.02061559, 0.10956977, 0.86981463}}},
                  1e-8);
    // The same from chromaticities, as profiles have them: of whites with four digits and with five.
    for (const auto& [space, tolerance] : {std::pair{ColourSpace::display_p3, 2e-6}, {ColourSpace::acescg, 2e-5}})
        for (const Rgb& c : {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}}) {
            const Rgb own = transform(xyz_d50_of_linear(space), transform(from_linear_srgb(space), c)),
                      srgb = transform(xyz_d50_of_linear(ColourSpace::srgb), c);
            for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(own[k], srgb[k], tolerance);
        }
    expect_matrix(from_linear_srgb(ColourSpace::srgb), {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 0);
    // The profile of sRGB by the ICC (sRGB_v4): its colourants, in steps of 1/65536.
    expect_matrix(xyz_d50_of_linear(ColourSpace::srgb),
                  {{{0.4360, 0.3851, 0.1431}, {0.2225, 0.7169, 0.0606}, {0.0139, 0.0971, 0.7141}}}, 2e-4);
}

/// Stored values of a linear colour of sRGB by OpenColorIO, from end to end. Its P3 ends in a power of 2.6, which is
/// taken back before the curve of sRGB.
Rgb stored_by_the_library(ColourSpace space, const Rgb& linear) {
    namespace ocio = OCIO_NAMESPACE;
    const auto group = ocio::GroupTransform::Create();
    const auto add = [&](const char* style, ocio::TransformDirection direction) {
        const auto step = ocio::BuiltinTransform::Create();
        step->setStyle(style);
        step->setDirection(direction);
        group->appendTransform(step);
    };
    const auto curve = ocio::ExponentWithLinearTransform::Create();
    curve->setGamma({2.4, 2.4, 2.4, 1});
    curve->setOffset({0.055, 0.055, 0.055, 0});
    curve->setDirection(ocio::TRANSFORM_DIR_INVERSE);
    if (space == ColourSpace::acescg) {
        add("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE);
    } else if (space == ColourSpace::display_p3) {
        group->appendTransform(curve);
        add("DISPLAY - CIE-XYZ-D65_to_sRGB", ocio::TRANSFORM_DIR_INVERSE);
        add("DISPLAY - CIE-XYZ-D65_to_G2.6-P3-D65", ocio::TRANSFORM_DIR_FORWARD);
        const auto power = ocio::ExponentTransform::Create();
        power->setValue({2.6, 2.6, 2.6, 1});
        group->appendTransform(power);
    }
    if (space != ColourSpace::acescg) group->appendTransform(curve);
    const auto processor = ocio::Config::CreateRaw()->getProcessor(group)->getDefaultCPUProcessor();
    Rgb stored = linear;
    processor->applyRGB(stored.data());
    return stored;
}

TEST(ColourSpace, StoredValuesAreThoseOfOpenColorIO) {
    for (const ColourSpace space : kAll)
        for (const Rgb& c : {Rgb{0, 0, 0}, Rgb{1, 1, 1}, Rgb{0.002f, 0.001f, 0.003f}, Rgb{0.7f, 0.05f, 0.02f},
                             Rgb{0.1f, 0.3f, 0.6f}}) {
            const Rgb expected = stored_by_the_library(space, c), own = transform(from_linear_srgb(space), c);
            // Its line near black has the slope that is tangent to the power, 12.9232; IEC 61966-2-1 has 12.92.
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(encode(space, own[k]), expected[k], 1e-5) << data_of(space).name << ' ' << c[0];
        }
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
