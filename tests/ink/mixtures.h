#pragma once

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/random.h"
#include "ink/spectra/colorimetry.h"
#include "ink/spectra/kubelka_munk.h"
#include "ink/spectra/upsample.h"
#include "paths.h"

/// Random mixes, thicknesses and stacks of pigments, with their colours computed in full.
namespace tuft::ink::test {

/// The measured acrylics of tests/data/optics/golden_ks.csv, 380–750 nm, per film unit of
/// `strength` of theirs; the last value is kept to 780 nm.
inline std::map<std::string, Curves> measured_pigments(double strength) {
    std::ifstream file(test_data() + "/optics/golden_ks.csv");
    std::map<std::string, Curves> pigments;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#' || line.starts_with("paint")) continue;
        std::stringstream cells(line);
        std::string name, index, nm, k, s;
        std::getline(cells, name, ',');
        std::getline(cells, index, ',');
        std::getline(cells, nm, ',');
        std::getline(cells, k, ',');
        std::getline(cells, s, ',');
        const int i = static_cast<int>((std::stod(nm) - 380) / 10 + 0.5);
        for (int j = i; j < kWavelengths; ++j) {
            pigments[name].k[j] = strength * std::stod(k);
            pigments[name].s[j] = strength * std::stod(s);
        }
    }
    return pigments;
}

/// Pigments of which only red, green and blue are known: the shipped estimates.
inline std::vector<Curves> estimated_pigments() {
    std::vector<Curves> out;
    const std::pair<Rgb, Rgb> rgb[] = {
        {{2.03f, 2.05f, 2.09f}, {.0616f, .0609f, .0624f}}, {{.288f, 2.24f, 2.57f}, {2.16f, .278f, .212f}},
        {{1.60f, 1.27f, .861f}, {.0203f, .0281f, .0568f}}, {{1.91f, 1.41f, .522f}, {.0137f, .0212f, .0591f}},
        {{.0379f, .0437f, .0553f}, {1.77f, 1.64f, 1.35f}}, {{.010f, .20f, 2.6f}, {.30f, .20f, .02f}},
        {{.45f, 1.9f, 2.4f}, {1.0f, .25f, .16f}}};
    for (const auto& [k, s] : rgb) out.push_back(upsample_pigment(k, s));
    return out;
}

/// One or two films of one to four pigments each over a grey or coloured backing.
struct Mixture {
    struct Film {
        std::vector<int> pigment;
        std::vector<double> amount;  ///< film units
    };
    std::vector<Film> films;
    Rgb backing{};
    double interface = 0;
};

inline std::vector<Mixture> random_mixtures(int n, int n_pigments, std::uint64_t seed) {
    std::vector<Mixture> all;
    std::uint64_t draw = 0;
    const auto u = [&] { return uniform(seed, draw++); };
    for (int i = 0; i < n; ++i) {
        Mixture m;
        const int films = u() < 0.3 ? 2 : 1;
        for (int f = 0; f < films; ++f) {
            Mixture::Film film;
            const int parts = 1 + static_cast<int>(3.999 * u() * u());
            const double x = 0.05 * std::pow(1000.0, u());  // 0.05 to 50 film units
            double sum = 0;
            for (int p = 0; p < parts; ++p) {
                film.pigment.push_back(static_cast<int>(u() * 0.9999 * n_pigments));
                film.amount.push_back(-std::log(1 - 0.999 * u()));
                sum += film.amount.back();
            }
            for (double& a : film.amount) a *= x / sum;
            m.films.push_back(std::move(film));
        }
        const double choice = u();
        if (choice < 0.5)
            m.backing = {.84f, .83f, .79f};
        else if (choice < 0.65)
            m.backing = {.88f, .86f, .80f};
        else if (choice < 0.8)
            m.backing = {.30f, .23f, .17f};
        else if (choice < 0.9)
            m.backing = {.42f, .43f, .44f};
        else
            m.backing = {.03f, .03f, .03f};
        m.interface = u() < 0.5 ? 1 : 0;
        all.push_back(std::move(m));
    }
    return all;
}

/// Reflectance of a mixture at one wavelength; `k(p)`, `s(p)` of the pigments there.
template <class K, class S>
double reflectance(const Mixture& m, double backing, K&& k, S&& s) {
    const Interface glaze{.k1 = 0, .k2 = 0.6 * m.interface};
    double r = saunderson_inverse(backing, glaze, false);
    for (const Mixture::Film& film : m.films) {
        double sum_k = 0, sum_s = 0;
        for (std::size_t p = 0; p < film.pigment.size(); ++p) {
            sum_k += film.amount[p] * k(film.pigment[p]);
            sum_s += film.amount[p] * s(film.pigment[p]);
        }
        r = over(layer(sum_k, sum_s, 1), r);
    }
    return saunderson(r, glaze, false);
}

}  // namespace tuft::ink::test
