// Chooses which wavelengths are the spectral bands and how much of red, green and blue each gives,
// and prints the colour error against the sum over all 41:
//
//     ink_fit_bands [N]      the table for 12 to 32 bands, or the numbers for src/ink/spectra/spectrum.cpp
//
// Beginning with all wavelengths, the one is left out whose loss costs least, then the next. Weights
// are least squares in about ΔE2000 with a ridge towards linear interpolation between the bands that
// are left, so that what the samples do not say is as for smooth spectra. Samples with large errors
// count more, round after round. Errors are printed of mixtures that had no part in this.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "mixtures.h"

namespace tuft::ink::test {
namespace {

constexpr int kW = kWavelengths;
constexpr int kRounds = 14;
constexpr double kRidge = 3e-6;  // of the mean square that a weight has in the samples

using Places = std::vector<int>;
using Gram = Eigen::Matrix<double, 3 * kW, 3 * kW>;

struct Samples {
    std::vector<Spectrum> r;
    std::vector<Lab> lab, shown;
    std::vector<Eigen::Matrix3d> slope;  ///< of Lab, scaled to about unit ΔE2000, by linear RGB
};

Lab lab_shown(const std::array<double, 3>& rgb) {
    const Rgb in = into_gamut({static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
    return lab_of_rgb({in[0], in[1], in[2]});
}

Samples make_samples(const std::vector<Curves>& pigments, int n, std::uint64_t seed) {
    Samples out;
    for (const Mixture& m : random_mixtures(n, static_cast<int>(pigments.size()), seed)) {
        const Spectrum backing = spectrum_of_rgb(m.backing);
        Spectrum r;
        for (int i = 0; i < kW; ++i)
            r[i] = reflectance(
                m, backing[i], [&](int p) { return pigments[p].k[i]; }, [&](int p) { return pigments[p].s[i]; });
        const auto rgb = rgb_of_spectrum(r);
        const Lab lab = lab_of_rgb(rgb);
        Eigen::Matrix3d slope;
        for (int c = 0; c < 3; ++c) {
            auto moved = rgb;
            moved[c] += 1e-5;
            const Lab l = lab_of_rgb(moved);
            const double chroma = std::hypot(lab[1], lab[2]);
            for (int k = 0; k < 3; ++k) slope(k, c) = (l[k] - lab[k]) / 1e-5 / (k == 0 ? 1.2 : 1 + 0.035 * chroma);
        }
        out.r.push_back(r);
        out.lab.push_back(lab);
        out.shown.push_back(lab_shown(rgb));
        out.slope.push_back(slope);
    }
    return out;
}

struct Fit {
    Places place;
    Eigen::MatrixXd weights;  ///< [3, n]
};

struct Errors {
    std::vector<double> all;  ///< of the colours as computed
    double mean = 0, p99 = 0, max = 0, shown = 0;
};

Errors measure(const Samples& s, const Fit& fit) {
    Errors out;
    for (std::size_t i = 0; i < s.r.size(); ++i) {
        std::array<double, 3> rgb{};
        for (int c = 0; c < 3; ++c)
            for (std::size_t b = 0; b < fit.place.size(); ++b)
                rgb[c] += fit.weights(c, static_cast<long>(b)) * s.r[i][fit.place[b]];
        out.all.push_back(delta_e_2000(s.lab[i], lab_of_rgb(rgb)));
        out.shown = std::max(out.shown, delta_e_2000(s.shown[i], lab_shown(rgb)));
        out.mean += out.all.back() / static_cast<double>(s.r.size());
    }
    std::vector<double> sorted = out.all;
    std::sort(sorted.begin(), sorted.end());
    out.p99 = sorted[sorted.size() * 99 / 100];
    out.max = sorted.back();
    return out;
}

/// Σ over the samples of (slopeᵀ slope) ⊗ (r rᵀ), each with its importance.
Gram gram_of(const Samples& s, const std::vector<double>& importance) {
    Gram g = Gram::Zero();
    for (std::size_t i = 0; i < s.r.size(); ++i) {
        const Eigen::Map<const Eigen::Matrix<double, kW, 1>> r(s.r[i].data());
        const Eigen::Matrix3d a = importance[i] * s.slope[i].transpose() * s.slope[i];
        const Eigen::Matrix<double, kW, kW> rr = r * r.transpose();
        for (int p = 0; p < 3; ++p)
            for (int q = 0; q <= p; ++q) g.block<kW, kW>(p * kW, q * kW) += a(p, q) * rr;
    }
    for (int p = 0; p < 3; ++p)
        for (int q = 0; q < p; ++q) g.block<kW, kW>(q * kW, p * kW) = g.block<kW, kW>(p * kW, q * kW).transpose();
    return g;
}

/// What each band gives where spectra are straight between the bands and level beyond them.
Eigen::MatrixXd natural(const Places& place) {
    const int n = static_cast<int>(place.size());
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero(3, n);
    for (int i = 0; i < kW; ++i) {
        const int next = static_cast<int>(std::lower_bound(place.begin(), place.end(), i) - place.begin());
        for (int c = 0; c < 3; ++c) {
            const double m = rgb_matching()[c][i];
            if (next == 0 || next == n) {
                w(c, next == 0 ? 0 : n - 1) += m;
                continue;
            }
            const double u = double(i - place[next - 1]) / (place[next] - place[next - 1]);
            w(c, next - 1) += (1 - u) * m;
            w(c, next) += u * m;
        }
    }
    return w;
}

/// Weights for these bands, rows summing to one; with `cost` what they leave in the Gram's measure.
Fit solve(const Gram& gram, const Places& place, double* cost = nullptr) {
    const int n = static_cast<int>(place.size()), m = 3 * n;
    // With w the weights over all wavelengths and m the matching functions, (w − m)ᵀ G (w − m) is least.
    Eigen::VectorXd matching(3 * kW), start(m);
    const Eigen::MatrixXd nat = natural(place);
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < kW; ++i) matching[c * kW + i] = rgb_matching()[c][i];
        for (int b = 0; b < n; ++b) start[c * n + b] = nat(c, b);
    }
    const Eigen::VectorXd gm = gram * matching;
    std::vector<int> rows;
    for (int c = 0; c < 3; ++c)
        for (const int i : place) rows.push_back(c * kW + i);
    Eigen::MatrixXd h(m, m);
    Eigen::VectorXd g(m);
    for (int a = 0; a < m; ++a) {
        g[a] = gm[rows[a]];
        for (int b = 0; b < m; ++b) h(a, b) = gram(rows[a], rows[b]);
    }
    const double ridge = kRidge * h.trace() / m;
    Eigen::MatrixXd damped = h;
    damped.diagonal().array() += ridge;
    // Rows sum to one, by Lagrange's multipliers.
    Eigen::MatrixXd rim = Eigen::MatrixXd::Zero(m, 4);
    for (int c = 0; c < 3; ++c) rim.block(c * n, c, n, 1).setOnes();
    rim.col(3) = g + ridge * start;
    const Eigen::MatrixXd x = damped.llt().solve(rim);
    Eigen::Matrix3d sums;
    Eigen::Vector3d lack;
    for (int c = 0; c < 3; ++c) {
        for (int d = 0; d < 3; ++d) sums(c, d) = x.block(c * n, d, n, 1).sum();
        lack[c] = 1 - x.block(c * n, 3, n, 1).sum();
    }
    const Eigen::VectorXd w = x.col(3) + x.leftCols(3) * sums.inverse() * lack;
    if (cost) *cost = w.dot(h * w) - 2 * w.dot(g) + ridge * (w - start).squaredNorm();
    Fit fit{place, Eigen::MatrixXd(3, n)};
    for (int c = 0; c < 3; ++c) fit.weights.row(c) = w.segment(c * n, n).transpose();
    return fit;
}

/// Leaves out one wavelength after the other, then tries whether any band is better elsewhere.
Places choose(const Gram& gram, int n) {
    Places place(kW);
    for (int i = 0; i < kW; ++i) place[i] = i;
    const auto cost_of = [&](const Places& p) {
        double cost = 0;
        solve(gram, p, &cost);
        return cost;
    };
    double best = 0;
    while (static_cast<int>(place.size()) > n) {
        best = 1e300;
        Places next;
        for (std::size_t k = 0; k < place.size(); ++k) {
            Places fewer = place;
            fewer.erase(fewer.begin() + static_cast<long>(k));
            if (const double cost = cost_of(fewer); cost < best) {
                best = cost;
                next = fewer;
            }
        }
        place = next;
    }
    for (bool moved = true; moved;) {
        moved = false;
        for (int k = 0; k < n; ++k)
            for (const int sign : {-1, 1}) {
                Places other = place;
                other[k] += sign;
                if (other[k] < 0 || other[k] >= kW || std::count(place.begin(), place.end(), other[k])) continue;
                if (const double cost = cost_of(other); cost < best - 1e-9 * std::abs(best)) {
                    best = cost;
                    place = other;
                    moved = true;
                }
            }
    }
    return place;
}

Fit search(const Samples& s, int n) {
    std::vector<double> importance(s.r.size(), 1);
    Fit best;
    double least = 1e300;
    Places place;
    for (int round = 0; round < kRounds; ++round) {
        const Gram gram = gram_of(s, importance);
        if (round < 3) place = choose(gram, n);
        const Fit fit = solve(gram, place);
        const Errors e = measure(s, fit);
        if (std::getenv("VERBOSE")) std::printf("  %d: %.3f %.3f %.3f\n", round, e.mean, e.p99, e.max);
        if (e.max < least) {
            least = e.max;
            best = fit;
        }
        // Lawson's weights, tempered.
        double mean = 0;
        for (std::size_t i = 0; i < s.r.size(); ++i) {
            importance[i] *= 0.2 + e.all[i] / e.p99;
            mean += importance[i] / static_cast<double>(s.r.size());
        }
        for (double& v : importance) v = std::max(v / mean, 0.02);
    }
    return best;
}

int run(int argc, char** argv) {
    std::vector<Curves> pigments = estimated_pigments();
    for (const auto& [name, curves] : measured_pigments(7)) pigments.push_back(curves);
    const int only = argc > 1 ? std::atoi(argv[1]) : 0;
    const Samples fitted = make_samples(pigments, 20000, 1), fresh = make_samples(pigments, 20000, 2);
    if (!only) std::printf("bands   mean   99 %%    max  shown  (ΔE2000 of 20000 mixes the fit has not seen)\n");
    for (int n = only ? only : 12; n <= (only ? only : 32); n += 2) {
        const Fit fit = search(fitted, n);
        const Errors e = measure(fresh, fit);
        std::printf("%5d  %.3f  %.3f  %.3f  %.3f\n", n, e.mean, e.p99, e.max, e.shown);
        std::fflush(stdout);
        if (!only) continue;
        for (const int p : fit.place) std::printf("%g, ", wavelength_nm(p));
        for (int c = 0; c < 3; ++c) {
            std::printf("\n");
            for (long b = 0; b < n; ++b) std::printf("%.8ff, ", fit.weights(c, b));
        }
        std::printf("\n");
    }
    return 0;
}

}  // namespace
}  // namespace tuft::ink::test

int main(int argc, char** argv) {
    return tuft::ink::test::run(argc, argv);
}
