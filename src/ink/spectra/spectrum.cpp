#include "ink/spectra/spectrum.h"

#include <Eigen/LU>
#include <algorithm>

#include "ink/spectra/colorimetry.h"

namespace tuft::ink {
namespace {

constexpr Bands kNm{410, 430, 450, 460, 470, 480, 490, 500, 510, 520, 530, 540,
                    550, 560, 570, 580, 590, 600, 610, 620, 640, 660, 670, 700};

// Least squares in ΔE2000 over random mixes; made by tests/ink/fit_bands.cpp.
constexpr std::array<Bands, 3> kFitted{
    {{0.00830976f,  0.03323250f,  0.03968624f,  -0.01558963f, -0.00776731f, -0.03843747f, -0.04249319f, -0.06741359f,
      -0.07969031f, -0.09606347f, -0.07983351f, -0.05308493f, -0.01324085f, 0.03650932f,  0.09348579f,  0.14551270f,
      0.18550726f,  0.20993085f,  0.18448765f,  0.26409544f,  0.21317870f,  0.03719219f,  0.03323959f,  0.00924627f},
     {-0.00611114f, -0.03215971f, -0.04667661f, 0.01403070f,  -0.01199490f, 0.03136373f,  0.03221932f,  0.06867785f,
      0.09077974f,  0.13087640f,  0.14560891f,  0.15037954f,  0.14235000f,  0.12208574f,  0.09477069f,  0.06815491f,
      0.03487878f,  0.01389652f,  -0.00122014f, -0.01505582f, -0.01818337f, -0.00450155f, -0.00319878f, -0.00097082f},
     {0.04658209f,  0.24754455f,  0.37762157f,  0.10347260f,  0.17505749f,  0.08838836f,  0.04600167f,  0.02371040f,
      0.00606077f,  -0.00487571f, -0.01334092f, -0.01525012f, -0.01608858f, -0.01664962f, -0.01418580f, -0.00942771f,
      -0.00981020f, -0.00404479f, -0.00524544f, -0.00294000f, -0.00183250f, -0.00128881f, 0.00077167f,  -0.00023096f}}};

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
    const float part = std::min(*low < 0 ? grey / (grey - *low) : 1.0f, *high > 1 ? (1 - grey) / (*high - grey) : 1.0f);
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = grey + (colour[c] - grey) * part;
    return out;
}

namespace {

const Basis& basis_of_primaries() {
    static const Basis basis = make_basis();
    return basis;
}

}  // namespace

const std::array<Bands, 3>& primary_bands() {
    static const auto bands = [] {
        std::array<Bands, 3> all;
        for (int c = 0; c < 3; ++c)
            for (int b = 0; b < kBands; ++b) all[c][b] = static_cast<float>(basis_of_primaries()[b][c]);
        return all;
    }();
    return bands;
}

Bands bands_of_rgb(const Rgb& colour) {
    const Basis& basis = basis_of_primaries();
    Bands out;
    for (int b = 0; b < kBands; ++b) {
        double sum = 0;
        for (int c = 0; c < 3; ++c) sum += basis[b][c] * static_cast<double>(colour[c]);
        out[b] = static_cast<float>(std::clamp(sum, 0.0, 1.0));
    }
    return out;
}

}  // namespace tuft::ink
