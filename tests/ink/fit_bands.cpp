// Chooses where the spectral bands lie and how much of red, green and blue each gives, for 4 to
// 20 bands, and prints the colour error against the sum over 41 wavelengths:
//
//     fit_bands [N]      the table, or the numbers for src/ink/spectrum.cpp
#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "mixtures.h"

namespace tuft::ink::test {
namespace {

constexpr double kFirst = 384, kStep = 2;
constexpr int kPlaces = 180;  // 384 … 742 nm

double at(const Spectrum& v, double nm) {
    const double x = std::clamp((nm - 380) / 10, 0.0, kWavelengths - 1.0);
    const int i = std::min(static_cast<int>(x), kWavelengths - 2);
    return v[i] + (x - i) * (v[i + 1] - v[i]);
}

struct Samples {
    std::vector<std::array<double, kPlaces>> places;
    std::vector<std::array<double, 3>> rgb;
    std::vector<Lab> lab;
    std::vector<Eigen::Matrix3d> slope;  ///< of Lab, scaled to about unit ΔE2000, by linear RGB
};

Samples make_samples(const std::vector<Curves>& pigments, int n, std::uint64_t seed) {
    Samples out;
    for (const Mixture& m : random_mixtures(n, static_cast<int>(pigments.size()), seed)) {
        Spectrum ground = spectrum_of_rgb(m.ground), r;
        for (int i = 0; i < kWavelengths; ++i)
            r[i] = reflectance(m, ground[i], [&](int p) { return pigments[p].k[i]; },
                               [&](int p) { return pigments[p].s[i]; });
        std::array<double, kPlaces> v;
        for (int i = 0; i < kPlaces; ++i) {
            const double nm = kFirst + kStep * i;
            v[i] = reflectance(m, at(ground, nm), [&](int p) { return at(pigments[p].k, nm); },
                               [&](int p) { return at(pigments[p].s, nm); });
        }
        const auto rgb = rgb_of_spectrum(r);
        const Lab lab = lab_of_rgb(rgb);
        Eigen::Matrix3d slope;
        for (int c = 0; c < 3; ++c) {
            auto moved = rgb;
            moved[c] += 1e-5;
            const Lab l = lab_of_rgb(moved);
            const double chroma = std::hypot(lab[1], lab[2]);
            for (int k = 0; k < 3; ++k)
                slope(k, c) = (l[k] - lab[k]) / 1e-5 / (k == 0 ? 1.2 : 1 + 0.035 * chroma);
        }
        out.places.push_back(v);
        out.rgb.push_back(rgb);
        out.lab.push_back(lab);
        out.slope.push_back(slope);
    }
    return out;
}

struct Fit {
    std::vector<int> place;
    Eigen::MatrixXd weights;  ///< [3, n]
    double mean = 0, p99 = 0, max = 0, in_gamut = 0, score = 1e30;
};

void measure(const Samples& s, Fit& fit) {
    std::vector<double> e(s.rgb.size());
    double sum = 0, high = 0;
    for (std::size_t i = 0; i < s.rgb.size(); ++i) {
        std::array<double, 3> rgb{};
        for (int c = 0; c < 3; ++c)
            for (std::size_t b = 0; b < fit.place.size(); ++b)
                rgb[c] += fit.weights(c, static_cast<long>(b)) * s.places[i][fit.place[b]];
        e[i] = delta_e_2000(s.lab[i], lab_of_rgb(rgb));
        sum += e[i];
        high += std::pow(e[i], 6);
    }
    std::sort(e.begin(), e.end());
    fit.mean = sum / static_cast<double>(e.size());
    fit.p99 = e[e.size() * 99 / 100];
    fit.max = e.back();
    fit.in_gamut = 0;
    for (std::size_t i = 0; i < s.rgb.size(); ++i) {
        Rgb got{}, want{};
        for (int c = 0; c < 3; ++c) {
            double v = 0;
            for (std::size_t b = 0; b < fit.place.size(); ++b)
                v += fit.weights(c, static_cast<long>(b)) * s.places[i][fit.place[b]];
            got[c] = static_cast<float>(v);
            want[c] = static_cast<float>(s.rgb[i][c]);
        }
        got = into_gamut(got);
        want = into_gamut(want);
        fit.in_gamut = std::max(fit.in_gamut, delta_e_2000(lab_of_rgb({got[0], got[1], got[2]}), lab_of_rgb({want[0], want[1], want[2]})));
    }
    fit.score = std::pow(high / static_cast<double>(e.size()), 1.0 / 6);
}

/// Weights for bands at these places: least squares in about ΔE2000, rows summing to 1,
/// samples weighted again by their error so that the worst count most.
Fit solve(const Samples& s, const std::vector<int>& place, int rounds) {
    const long n = static_cast<long>(place.size()), m = 3 * (n - 1);
    Fit best;
    std::vector<double> importance(s.rgb.size(), 1);
    for (int round = 0; round < rounds; ++round) {
        Eigen::MatrixXd h = Eigen::MatrixXd::Zero(m, m);
        Eigen::VectorXd g = Eigen::VectorXd::Zero(m);
        for (std::size_t i = 0; i < s.rgb.size(); ++i) {
            // R_last is taken out by the sum: w · r = r_last + Σ w_b (r_b − r_last).
            Eigen::VectorXd d(n - 1);
            const double last = s.places[i][place[n - 1]];
            for (long b = 0; b < n - 1; ++b) d[b] = s.places[i][place[b]] - last;
            const Eigen::Matrix3d a = importance[i] * s.slope[i].transpose() * s.slope[i];
            const Eigen::Vector3d goal = a * Eigen::Vector3d(s.rgb[i][0] - last, s.rgb[i][1] - last, s.rgb[i][2] - last);
            const Eigen::MatrixXd dd = d * d.transpose();
            for (int p = 0; p < 3; ++p) {
                g.segment(p * (n - 1), n - 1) += goal[p] * d;
                for (int q = 0; q <= p; ++q) h.block(p * (n - 1), q * (n - 1), n - 1, n - 1) += a(p, q) * dd;
            }
        }
        h.diagonal().array() += 1e-9 * h.trace();
        const Eigen::VectorXd w = h.selfadjointView<Eigen::Lower>().ldlt().solve(g);
        Fit fit{.place = place, .weights = Eigen::MatrixXd(3, n)};
        for (int c = 0; c < 3; ++c) {
            fit.weights.row(c).head(n - 1) = w.segment(c * (n - 1), n - 1);
            fit.weights(c, n - 1) = 1 - w.segment(c * (n - 1), n - 1).sum();
        }
        measure(s, fit);
        if (fit.score < best.score) best = fit;
        if (round + 1 == rounds) break;
        for (std::size_t i = 0; i < s.rgb.size(); ++i) {
            std::array<double, 3> rgb{};
            for (int c = 0; c < 3; ++c)
                for (long b = 0; b < n; ++b) rgb[c] += fit.weights(c, b) * s.places[i][place[b]];
            const double e = delta_e_2000(s.lab[i], lab_of_rgb(rgb));
            importance[i] = std::min(importance[i] * (0.3 + e / fit.score), 1e6);
        }
    }
    return best;
}

/// Moves one band after the other as long as that helps, by ever smaller steps.
Fit search(const Samples& s, int n) {
    std::vector<int> place;
    for (int b = 0; b < n; ++b)
        place.push_back(static_cast<int>((415 + 255.0 * b / (n - 1) - kFirst) / kStep + 0.5));
    Fit best = solve(s, place, 3);
    for (const int step : {8, 4, 2, 1}) {
        for (bool moved = true; moved;) {
            moved = false;
            for (int b = 0; b < n; ++b)
                for (const int way : {-step, step}) {
                    place = best.place;
                    place[b] += way;
                    if (place[b] < 0 || place[b] >= kPlaces || (b > 0 && place[b] <= place[b - 1]) ||
                        (b + 1 < n && place[b] >= place[b + 1]))
                        continue;
                    const Fit fit = solve(s, place, 3);
                    if (fit.score < best.score * (1 - 1e-3)) {
                        best = fit;
                        moved = true;
                    }
                }
        }
    }
    return solve(s, best.place, 12);
}

int run(int argc, char** argv) {
    std::vector<Curves> pigments = estimated_pigments();
    for (const auto& [name, curves] : measured_pigments(7)) pigments.push_back(curves);
    int first = 4;
    const int only = argc > 1 ? std::atoi(argv[1]) : 0;
    const Samples fitted = make_samples(pigments, 2500, 1), fresh = make_samples(pigments, 6000, 2);
    if (!only) std::printf("bands   mean    99 %%    max   (dE2000 of 6000 mixes the fit has not seen)\n");
    if (const char* from = std::getenv("FROM")) first = std::atoi(from);
    for (int n = only ? only : first; n <= (only ? only : 20); ++n) {
        Fit fit = search(fitted, n);
        measure(fresh, fit);
        std::printf("%5d  %.3f  %.3f  %.3f  %.3f\n", n, fit.mean, fit.p99, fit.max, fit.in_gamut);
        std::fflush(stdout);
        if (!only) continue;
        for (const int p : fit.place) std::printf("%g, ", kFirst + kStep * p);
        std::printf("\n");
        for (int c = 0; c < 3; ++c) {
            for (long b = 0; b < n; ++b) std::printf("%.8ff, ", fit.weights(c, b));
            std::printf("\n");
        }
    }
    return 0;
}

}  // namespace
}  // namespace tuft::ink::test

int main(int argc, char** argv) {
    return tuft::ink::test::run(argc, argv);
}
