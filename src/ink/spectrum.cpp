#include "ink/spectrum.h"

#include <Eigen/LU>
#include <algorithm>

#include "ink/colorimetry.h"

namespace tuft::ink {
namespace {

constexpr Bands kNm{394, 428, 450, 472, 490, 510, 530, 552, 570, 590, 610, 628, 652, 684};

// Least squares in ΔE2000 over random mixes; made by tests/ink/fit_bands.cpp.
constexpr std::array<Bands, 3> kFitted{
    {{-0.00080991f, 0.03936632f, 0.03842149f, -0.04193560f, -0.08616304f, -0.17058125f, -0.15920643f,
      -0.02833641f, 0.18599834f, 0.37409075f, 0.39315814f, 0.28058303f, 0.14521209f, 0.03020248f},
     {-0.00468244f, -0.03497131f, -0.04134296f, 0.00824498f, 0.07952473f, 0.18848075f, 0.30870377f,
      0.28634093f, 0.17874385f, 0.07180598f, -0.00517306f, -0.01639602f, -0.01635851f, -0.00292068f},
     {0.00953205f, 0.26732382f, 0.46054362f, 0.27707670f, 0.08593384f, 0.01397534f, -0.02562305f,
      -0.03434756f, -0.02615122f, -0.01644718f, -0.00603534f, -0.00494556f, -0.00101837f, 0.00018291f}}};

using Basis = std::array<std::array<double, 3>, kBands>;

/// Bands of the three primaries: the smoothest spectra there, and the least change that gives
/// the bands' own sum the colour.
Basis make_basis() {
    Eigen::Matrix<double, 3, kBands> weights;
    Eigen::Matrix<double, kBands, 3> smooth;
    for (int c = 0; c < 3; ++c) {
        Rgb primary{};
        primary[c] = 1;
        const Spectrum spectrum = spectrum_of_rgb(primary);
        for (int b = 0; b < kBands; ++b) {
            weights(c, b) = static_cast<double>(band_weights()[c][b]);
            const double x = (static_cast<double>(kNm[b]) - wavelength_nm(0)) / 10;
            const int i = static_cast<int>(x);
            smooth(b, c) = spectrum[i] + (x - i) * (spectrum[i + 1] - spectrum[i]);
        }
    }
    const Eigen::Matrix3d lack = Eigen::Matrix3d::Identity() - weights * smooth;
    const Eigen::Matrix<double, kBands, 3> exact =
        smooth + weights.transpose() * (weights * weights.transpose()).inverse() * lack;
    Basis basis;
    for (int b = 0; b < kBands; ++b)
        for (int c = 0; c < 3; ++c) basis[b][c] = exact(b, c);
    return basis;
}

}  // namespace

const Bands& band_nm() {
    return kNm;
}

const std::array<Bands, 3>& band_weights() {
    return kFitted;
}

Rgb rgb_of_bands(const Bands& reflectance) {
    Rgb colour{};
    for (int c = 0; c < 3; ++c)
        for (int b = 0; b < kBands; ++b) colour[c] += band_weights()[c][b] * reflectance[b];
    return colour;
}

Rgb into_gamut(const Rgb& colour) {
    const auto [low, high] = std::minmax_element(colour.begin(), colour.end());
    const float y = 0.212639f * colour[0] + 0.715169f * colour[1] + 0.072192f * colour[2];
    const float grey = std::clamp(y, 0.0f, 1.0f);
    const float part = std::min(*low < 0 ? grey / (grey - *low) : 1.0f,
                                *high > 1 ? (1 - grey) / (*high - grey) : 1.0f);
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = grey + (colour[c] - grey) * part;
    return out;
}

Bands bands_of_rgb(const Rgb& colour) {
    static const Basis basis = make_basis();
    Bands out;
    for (int b = 0; b < kBands; ++b) {
        double sum = 0;
        for (int c = 0; c < 3; ++c) sum += basis[b][c] * static_cast<double>(colour[c]);
        out[b] = static_cast<float>(std::clamp(sum, 0.0, 1.0));
    }
    return out;
}

}  // namespace tuft::ink
