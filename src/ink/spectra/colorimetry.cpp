#include "ink/spectra/colorimetry.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::ink {
namespace {

using std::numbers::pi;

// CIE 1931 2° colour-matching functions and D65, 380–780 nm in steps of 10 (CIE 15:2004).
constexpr Spectrum kX{.001368, .004243, .01431, .04351, .13438,  .2839,   .34828,  .3362,  .2908,  .19536, .09564,
                      .03201,  .0049,   .0093,  .06327, .1655,   .2904,   .43345,  .5945,  .7621,  .9163,  1.0263,
                      1.0622,  1.0026,  .85445, .6424,  .4479,   .2835,   .1649,   .0874,  .04677, .0227,  .011359,
                      .00579,  .002899, .00144, .00069, .000332, .000166, .000083, .000042};
constexpr Spectrum kY{.000039, .00012,  .000396, .00121,  .004,   .0116,  .023,   .038,   .06,  .09098, .13902,
                      .20802,  .323,    .503,    .71,     .862,   .954,   .99495, .995,   .952, .87,    .757,
                      .631,    .503,    .381,    .265,    .175,   .107,   .061,   .032,   .017, .00821, .004102,
                      .002091, .001047, .00052,  .000249, .00012, .00006, .00003, .000015};
constexpr Spectrum kZ{.00645,  .02005, .06785, .2074, .6456, 1.3856, 1.74706, 1.77211, 1.6692,
                      1.28764, .81295, .46518, .272,  .1582, .07825, .04216,  .0203,   .00875,
                      .0039,   .0021,  .00165, .0011, .0008, .00034, .00019,  .00005,  .00002};
constexpr Spectrum kD65{49.9755, 54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812,
                        114.861, 115.923, 108.811, 109.354, 107.802, 104.79,  107.689, 104.405, 104.046,
                        100,     96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
                        80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856,
                        75.087,  63.5927, 46.4182, 66.8054, 63.3828};

// IEC 61966-2-1.
constexpr double kToRgb[3][3] = {
    {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};
constexpr double kToXyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};

double degrees(double radians) {
    return radians * 180 / pi;
}
double radians(double degrees) {
    return degrees * pi / 180;
}

/// Hue angle in [0, 360).
double hue(double b, double a) {
    if (a == 0 && b == 0) return 0;
    const double h = degrees(std::atan2(b, a));
    return h < 0 ? h + 360 : h;
}

}  // namespace

Xyz xyz_of_spectrum(const Spectrum& reflectance) {
    Xyz sum{};
    double white = 0;
    for (int i = 0; i < kWavelengths; ++i) {
        sum[0] += kD65[i] * kX[i] * reflectance[i];
        sum[1] += kD65[i] * kY[i] * reflectance[i];
        sum[2] += kD65[i] * kZ[i] * reflectance[i];
        white += kD65[i] * kY[i];
    }
    for (double& v : sum) v /= white;
    return sum;
}

const std::array<Spectrum, 3>& rgb_matching() {
    static const auto table = [] {
        std::array<Spectrum, 3> m{};
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (int i = 0; i < kWavelengths; ++i) {
                m[c][i] = kD65[i] * (kToRgb[c][0] * kX[i] + kToRgb[c][1] * kY[i] + kToRgb[c][2] * kZ[i]);
                sum += m[c][i];
            }
            for (double& v : m[c]) v /= sum;
        }
        return m;
    }();
    return table;
}

std::array<double, 3> rgb_of_spectrum(const Spectrum& reflectance) {
    std::array<double, 3> rgb{};
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kWavelengths; ++i) rgb[c] += rgb_matching()[c][i] * reflectance[i];
    return rgb;
}

Spectrum spectrum_of_rgb(const Rgb& colour) {
    // Minimum of ½ |D² r|² with M r = colour: [DᵀD Mᵀ; M 0] [r; λ] = [0; colour].
    static const auto basis = [] {
        constexpr int kAll = kWavelengths + 3;
        Eigen::Matrix<double, kAll, kAll> a = Eigen::Matrix<double, kAll, kAll>::Zero();
        const double d[3] = {1, -2, 1};
        for (int i = 0; i + 2 < kWavelengths; ++i)
            for (int p = 0; p < 3; ++p)
                for (int q = 0; q < 3; ++q) a(i + p, i + q) += d[p] * d[q];
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < kWavelengths; ++i)
                a(kWavelengths + c, i) = a(i, kWavelengths + c) = rgb_matching()[c][i];
        Eigen::Matrix<double, kAll, 3> goal = Eigen::Matrix<double, kAll, 3>::Zero();
        for (int c = 0; c < 3; ++c) goal(kWavelengths + c, c) = 1;
        const Eigen::Matrix<double, kAll, 3> r = a.fullPivLu().solve(goal);
        std::array<Spectrum, 3> b;
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < kWavelengths; ++i) b[c][i] = r(i, c);
        return b;
    }();
    Spectrum out{};
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kWavelengths; ++i) out[i] += static_cast<double>(colour[c]) * basis[c][i];
    return out;
}

Lab lab_of_rgb(const std::array<double, 3>& rgb) {
    std::array<double, 3> f;
    for (int i = 0; i < 3; ++i) {
        double v = 0, white = 0;
        for (int c = 0; c < 3; ++c) {
            v += kToXyz[i][c] * rgb[c];
            white += kToXyz[i][c];
        }
        const double t = std::max(v, 0.0) / white;
        f[i] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

std::array<double, 3> rgb_of_lab(const Lab& lab) {
    const double y = (lab[0] + 16) / 116;
    const std::array<double, 3> f{y + lab[1] / 500, y, y - lab[2] / 200};
    Eigen::Matrix3d to_xyz;
    Eigen::Vector3d xyz;
    for (int i = 0; i < 3; ++i) {
        const double cube = f[i] * f[i] * f[i];
        double white = 0;
        for (int c = 0; c < 3; ++c) {
            to_xyz(i, c) = kToXyz[i][c];
            white += kToXyz[i][c];
        }
        xyz[i] = white * (cube > 216.0 / 24389 ? cube : (116 * f[i] - 16) * 27 / 24389);
    }
    const Eigen::Vector3d rgb = to_xyz.inverse() * xyz;
    return {rgb[0], rgb[1], rgb[2]};
}

ColourDifference colour_difference(const Lab& p, const Lab& q) {
    const double c_mean = 0.5 * (std::hypot(p[1], p[2]) + std::hypot(q[1], q[2]));
    const double c7 = std::pow(c_mean, 7), k25 = std::pow(25.0, 7);
    const double g = 0.5 * (1 - std::sqrt(c7 / (c7 + k25)));
    const double a1 = (1 + g) * p[1], a2 = (1 + g) * q[1];
    const double c1 = std::hypot(a1, p[2]), c2 = std::hypot(a2, q[2]);
    const double h1 = hue(p[2], a1), h2 = hue(q[2], a2);

    const bool grey = c1 * c2 == 0;
    double dh = grey ? 0 : h2 - h1;
    if (dh > 180) dh -= 360;
    if (dh < -180) dh += 360;
    const double dl = q[0] - p[0], dc = c2 - c1;
    const double dh_ = 2 * std::sqrt(c1 * c2) * std::sin(radians(dh) / 2);

    const double l_mean = 0.5 * (p[0] + q[0]), c_mean_ = 0.5 * (c1 + c2);
    double h_mean = h1 + h2;
    if (!grey) {
        if (std::abs(h1 - h2) > 180) h_mean += h1 + h2 < 360 ? 360 : -360;
        h_mean *= 0.5;
    }
    const double t = 1 - 0.17 * std::cos(radians(h_mean - 30)) + 0.24 * std::cos(radians(2 * h_mean)) +
                     0.32 * std::cos(radians(3 * h_mean + 6)) - 0.20 * std::cos(radians(4 * h_mean - 63));
    const double l50 = (l_mean - 50) * (l_mean - 50);
    const double sl = 1 + 0.015 * l50 / std::sqrt(20 + l50);
    const double sc = 1 + 0.045 * c_mean_, sh = 1 + 0.015 * c_mean_ * t;
    const double bend = (h_mean - 275) / 25, cm7 = std::pow(c_mean_, 7);
    const double rt = -std::sin(radians(60 * std::exp(-bend * bend))) * 2 * std::sqrt(cm7 / (cm7 + k25));
    return {.l = dl / sl, .c = dc / sc, .h = dh_ / sh, .r = rt};
}

double delta_e_2000(const Lab& p, const Lab& q) {
    const auto [x, y, z, rt] = colour_difference(p, q);
    return std::sqrt(std::max(0.0, x * x + y * y + z * z + rt * y * z));
}

}  // namespace tuft::ink
