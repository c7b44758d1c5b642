#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "ink/composite/composite.h"
#include "mixtures.h"
#include "paths.h"

namespace tuft::ink {
namespace {

double delta_e(const Rgb& a, const Rgb& b) {
    return delta_e_2000(lab_of_rgb({a[0], a[1], a[2]}), lab_of_rgb({b[0], b[1], b[2]}));
}

TEST(Colorimetry, ColourDifferenceMatchesThePublishedPairs) {
    std::ifstream file(test_data() + "/optics/ciede2000.csv");
    int pairs = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::vector<double> v;
        std::stringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
        ASSERT_EQ(v.size(), 7u);
        const Lab a{v[0], v[1], v[2]}, b{v[3], v[4], v[5]};
        // The table has four decimals.
        EXPECT_NEAR(delta_e_2000(a, b), v[6], 5.1e-5) << line;
        EXPECT_NEAR(delta_e_2000(b, a), v[6], 5.1e-5) << line;
        ++pairs;
    }
    EXPECT_EQ(pairs, 34);
}

TEST(Colorimetry, TheTablesGiveTheWhiteOfD65) {
    Spectrum white;
    white.fill(1);
    const Xyz w = xyz_of_spectrum(white);
    // CIE 15: x = 0.31271, y = 0.32902 from steps of 1 nm; steps of 10 nm move them by 1e-4.
    EXPECT_NEAR(w[0] / (w[0] + w[1] + w[2]), 0.31271, 1.5e-4);
    EXPECT_NEAR(w[1] / (w[0] + w[1] + w[2]), 0.32902, 1.5e-4);
    for (const double v : rgb_of_spectrum(white)) EXPECT_NEAR(v, 1, 1e-12);
    // CIELAB of the sRGB primaries, as computed by many from IEC 61966-2-1: two decimals.
    const Lab red = lab_of_rgb({1, 0, 0}), blue = lab_of_rgb({0, 0, 1});
    EXPECT_NEAR(red[0], 53.24, 0.02);
    EXPECT_NEAR(red[1], 80.09, 0.03);
    EXPECT_NEAR(red[2], 67.20, 0.03);
    EXPECT_NEAR(blue[0], 32.30, 0.02);
    EXPECT_NEAR(blue[1], 79.19, 0.03);
    EXPECT_NEAR(blue[2], -107.86, 0.03);
}

TEST(Spectrum, ASmoothSpectrumHasTheColourItWasMadeFor) {
    for (const Rgb& colour : {Rgb{.84f, .83f, .79f}, Rgb{.3f, .23f, .17f}, Rgb{.5f, .5f, .5f}, Rgb{.7f, .45f, .3f},
                              Rgb{0, 0, 0}, Rgb{1, 1, 1}}) {
        const auto back = rgb_of_spectrum(spectrum_of_rgb(colour));
        const Rgb bands = rgb_of_bands(bands_of_rgb(colour));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(back[c], colour[c], 1e-12);
            EXPECT_NEAR(bands[c], colour[c], 1e-6);
        }
    }
    for (const double v : spectrum_of_rgb({.42f, .42f, .42f})) EXPECT_NEAR(v, .42, 1e-7);
    for (const float v : bands_of_rgb({1, 0, 0})) {
        EXPECT_GE(v, 0) << "the deepest red is cut to what a surface can reflect";
        EXPECT_LE(v, 1);
    }
}

TEST(Spectrum, WhiteIsWhiteAndLuminanceStaysInTheGamut) {
    Bands white;
    white.fill(1);
    for (const float v : rgb_of_bands(white)) EXPECT_NEAR(v, 1, 1e-6);
    for (int i = 0; i < 1000; ++i) {
        Rgb colour;
        for (int c = 0; c < 3; ++c) colour[c] = static_cast<float>(1.6 * uniform(c, i) - 0.3);
        const auto y = [](const Rgb& v) { return 0.212639 * v[0] + 0.715169 * v[1] + 0.072192 * v[2]; };
        const Rgb inside = into_gamut(colour);
        for (const float v : inside) {
            EXPECT_GE(v, -1e-6);
            EXPECT_LE(v, 1 + 1e-6);
        }
        EXPECT_NEAR(y(inside), std::clamp(y(colour), 0.0, 1.0), 2e-6);
    }
}

/// Colour errors of the bands against 41 wavelengths, sorted.
std::vector<double> band_errors(int n, std::uint64_t seed) {
    std::vector<Curves> full = test::estimated_pigments();
    for (const auto& [name, curves] : test::measured_pigments(7)) full.push_back(curves);
    std::vector<Pigment> banded;
    for (const Curves& c : full) {
        Pigment p;
        for (int i = 0; i < kWavelengths; ++i) p.curve.nm.push_back(static_cast<float>(wavelength_nm(i)));
        p.curve.k.assign(c.k.begin(), c.k.end());
        p.curve.s.assign(c.s.begin(), c.s.end());
        use_curve(p);
        banded.push_back(p);
    }
    std::vector<double> errors;
    for (const test::Mixture& m : test::random_mixtures(n, static_cast<int>(full.size()), seed)) {
        const Spectrum backing = spectrum_of_rgb(m.backing);
        const Bands under = bands_of_rgb(m.backing);
        Spectrum fine;
        Bands coarse;
        for (int i = 0; i < kWavelengths; ++i)
            fine[i] = test::reflectance(
                m, backing[i], [&](int p) { return full[p].k[i]; }, [&](int p) { return full[p].s[i]; });
        for (int b = 0; b < kBands; ++b)
            coarse[b] = static_cast<float>(test::reflectance(
                m, under[b], [&](int p) { return banded[p].k[b]; }, [&](int p) { return banded[p].s[b]; }));
        const Rgb got = rgb_of_bands(coarse);
        errors.push_back(delta_e_2000(lab_of_rgb({got[0], got[1], got[2]}), lab_of_rgb(rgb_of_spectrum(fine))));
    }
    std::sort(errors.begin(), errors.end());
    return errors;
}

TEST(Spectrum, FewBandsGiveTheColoursOfManyWavelengths) {
    // Mixes the bands were not fitted to. 0.5 is half of what an eye can tell apart.
    const std::vector<double> e = band_errors(8000, 77);
    double mean = 0;
    for (const double v : e) mean += v / static_cast<double>(e.size());
    EXPECT_LT(mean, 0.05);
    EXPECT_LT(e[e.size() * 99 / 100], 0.2);
    EXPECT_LT(e.back(), 0.5);
    RecordProperty("mean_milli", static_cast<int>(1000 * mean));
    RecordProperty("p99_milli", static_cast<int>(1000 * e[e.size() * 99 / 100]));
    RecordProperty("max_milli", static_cast<int>(1000 * e.back()));
}

/// Reflectance spectrum of a stack of films of these pigments, by their curves.
Spectrum stack_in_full(const std::vector<std::vector<std::pair<Pigment, double>>>& films, const Substrate& on) {
    std::vector<std::vector<std::pair<Curves, double>>> curves;
    for (const auto& film : films) {
        curves.emplace_back();
        for (const auto& [pigment, amount] : film) {
            const PigmentCurve& c = pigment.curve;
            Curves full;
            if (c.nm.empty()) full = upsample_pigment({c.k[0], c.k[1], c.k[2]}, {c.s[0], c.s[1], c.s[2]});
            for (int i = 0; i < kWavelengths; ++i) {
                const double scale = static_cast<double>(c.scale);
                const Coefficients at = c.nm.empty() ? Coefficients{scale * full.k[i], scale * full.s[i]}
                                                     : coefficients_at(c, static_cast<float>(wavelength_nm(i)));
                full.k[i] = at.k;
                full.s[i] = at.s;
            }
            curves.back().emplace_back(full, amount);
        }
    }
    const Interface glaze{.k1 = 0, .k2 = 0.6 * static_cast<double>(on.interface)};
    const Spectrum backing = spectrum_of_rgb(on.reflectance);
    Spectrum r;
    for (int i = 0; i < kWavelengths; ++i) {
        r[i] = saunderson_inverse(backing[i], glaze, false);
        for (const auto& film : curves) {
            double k = 0, s = 0;
            for (const auto& [c, amount] : film) {
                k += amount * c.k[i];
                s += amount * c.s[i];
            }
            r[i] = over(layer(k, s, 1), r[i]);
        }
        r[i] = saunderson(r[i], glaze, false);
    }
    return r;
}

TEST(Spectrum, TheCompositeShowsShippedPigmentsAsTheFullSpectraDo) {
    std::vector<Pigment> pigments;
    for (const std::string& name : list_pigments()) pigments.push_back(load_pigment(name));
    std::uint64_t draw = 0;
    const auto u = [&] { return uniform(4711, draw++); };
    double worst = 0;
    for (const std::string& under : list_substrates()) {
        const Substrate on = load_substrate(under);
        for (int i = 0; i < 300; ++i) {
            // One to three films of one to four of eight pigments each, 0.1 to 50 film units.
            std::vector<Pigment> eight = pigments;
            while (eight.size() > static_cast<std::size_t>(kMaxPigments))
                eight.erase(eight.begin() + static_cast<long>(u() * 0.999 * static_cast<double>(eight.size())));
            std::vector<std::vector<std::pair<Pigment, double>>> films(1 + static_cast<int>(2.999 * u() * u()));
            std::vector<std::array<Plane, kMaxPigments>> planes(films.size());
            std::vector<TileFilm> tiles(films.size());
            for (std::size_t f = 0; f < films.size(); ++f) {
                const int parts = 1 + static_cast<int>(3.999 * u());
                const double thick = 0.1 * std::pow(500.0, u());
                std::array<double, kMaxPigments> amounts{};
                double sum = 0;
                for (int p = 0; p < parts; ++p) {
                    const double a = -std::log(1 - 0.999 * u());
                    amounts[static_cast<std::size_t>(u() * 7.999)] += a;
                    sum += a;
                }
                for (int p = 0; p < kMaxPigments; ++p) {
                    if (!(amounts[p] > 0)) continue;
                    planes[f][p].fill(static_cast<float>(amounts[p] * thick / sum));
                    tiles[f].pigments[p] = &planes[f][p];
                    films[f].emplace_back(eight[p], amounts[p] * thick / sum);
                }
            }
            const auto full = rgb_of_spectrum(stack_in_full(films, on));
            const Rgb want =
                into_gamut({static_cast<float>(full[0]), static_cast<float>(full[1]), static_cast<float>(full[2])});
            const TileAppearance look = shade_films(tiles, nullptr, eight, on);
            worst = std::max(worst, delta_e({look.colour[0][0], look.colour[1][0], look.colour[2][0]}, want));
        }
    }
    EXPECT_LT(worst, 0.5) << "half of what an eye can tell apart";
    RecordProperty("max_milli", static_cast<int>(1000 * worst));
}

TEST(Upsampling, FilmsKeepTheColoursTheyHaveInThreeBands) {
    for (const char* name : {"carbon", "cinnabar", "indigo", "cobalt", "shell-white", "gamboge", "iron-red"}) {
        const Pigment p = load_ink(name).parts[0].pigment;
        ASSERT_EQ(p.curve.k.size(), 3u);
        double worst = 0, sum = 0;
        int n = 0;
        for (const float x : {0.1f, 0.25f, 0.5f, 1.0f, 1.6f, 2.5f, 5.0f})
            for (const float backing : {0.03f, 0.3f, 0.84f, 0.95f}) {
                Rgb three;
                for (int c = 0; c < 3; ++c)
                    three[c] = static_cast<float>(over(layer(p.curve.k[c], p.curve.s[c], p.curve.scale * x), backing));
                Ink ink;
                ink.parts = {{p, 1.0}};
                const double e = delta_e(colour_of_film(ink, {backing, backing, backing}, x), three);
                worst = std::max(worst, e);
                sum += e;
                ++n;
            }
        // Gamboge is the hardest: its blue absorbs 13 times its green, at the rim of the gamut.
        EXPECT_LT(sum / n, 1.3) << name;
        EXPECT_LT(worst, 2.6) << name;
    }
}

TEST(Upsampling, NothingStaysNothingAndExtremesStayFinite) {
    const Curves none = upsample_pigment({0, 0, 0}, {0, 0, 0});
    for (int i = 0; i < kWavelengths; ++i) EXPECT_EQ(none.k[i] + none.s[i], 0);
    for (const auto& [k, s] :
         {std::pair<Rgb, Rgb>{{1e3f, 0, 1e-6f}, {0, 1e3f, 0}}, std::pair<Rgb, Rgb>{{1e-9f, 1e-9f, 1e-9f}, {0, 0, 1e3f}},
          std::pair<Rgb, Rgb>{{1e3f, 1e3f, 1e3f}, {1e3f, 1e3f, 1e3f}}}) {
        const Curves c = upsample_pigment(k, s);
        for (int i = 0; i < kWavelengths; ++i) {
            EXPECT_TRUE(std::isfinite(c.k[i]) && std::isfinite(c.s[i]));
            EXPECT_GE(c.k[i], 0);
            EXPECT_GE(c.s[i], 0);
        }
    }
}

/// Hue angle in CIELAB, degrees.
double hue_of(const Rgb& colour) {
    const Lab lab = lab_of_rgb({colour[0], colour[1], colour[2]});
    const double h = std::atan2(lab[2], lab[1]) * 180 / 3.14159265358979;
    return h < 0 ? h + 360 : h;
}

Ink mixed(const char* a, double part_a, const char* b, double part_b) {
    Ink ink;
    ink.parts = {{load_pigment(a), part_a}, {load_pigment(b), part_b}};
    return ink;
}

TEST(Mixing, YellowAndBlueMakeGreenAndWhiteMakesTints) {
    const Rgb paper{.9f, .9f, .9f};
    const double yellow = hue_of(colour_of_film(load_ink("gamboge"), paper, 1.5));
    const double blue = hue_of(colour_of_film(load_ink("indigo"), paper, 1));
    EXPECT_NEAR(yellow, 90, 20);
    EXPECT_NEAR(blue, 255, 35);
    // Colour names of CIELAB hues: green lies about 104–195 degrees.
    // Little indigo in gamboge gives the olive of painters' leaf green, hence from 0.4 on.
    for (const double part : {0.4, 0.6}) {
        const double green = hue_of(colour_of_film(mixed("gamboge", 1 - part, "indigo", part), paper, 1.5));
        EXPECT_GT(green, 104) << part;
        EXPECT_LT(green, 195) << part;
    }
    const Rgb red = colour_of_film(load_ink("cinnabar"), paper, 3);
    const Rgb pink = colour_of_film(mixed("cinnabar", 0.3, "titanium-white", 0.7), paper, 3);
    for (int c = 0; c < 3; ++c) EXPECT_GT(pink[c], red[c]) << "white and red make a lighter tint";
    EXPECT_LT(std::abs(hue_of(pink) - hue_of(red)), 40);
}

TEST(Mixing, ColoursAndEnergyStayInBounds) {
    std::vector<Pigment> pigments;
    for (const std::string& name : list_pigments()) pigments.push_back(load_pigment(name));
    pigments.resize(std::min<std::size_t>(pigments.size(), kMaxPigments));
    for (const std::string& under : list_substrates()) {
        std::vector<Plane> planes(pigments.size());
        TileFilm film;
        for (std::size_t p = 0; p < pigments.size(); ++p) {
            for (int t = 0; t < atlas::kTileTexels; ++t)
                planes[p][t] = static_cast<float>(std::pow(10.0, 9 * uniform(p, t) - 7));
            film.pigments[p] = &planes[p];
        }
        const TileFilm films[] = {film, film};
        const TileAppearance look = shade_films(films, nullptr, pigments, load_substrate(under));
        for (const auto& channel : look.colour)
            for (const float v : channel) {
                EXPECT_GE(v, -1e-6);
                EXPECT_LE(v, 1 + 1e-6);
            }
    }
    for (const Pigment& p : pigments)
        for (int b = 0; b < kBands; ++b)
            for (const double x : {0.01, 1.0, 100.0}) {
                const Layer l = layer(p.k[b], p.s[b], x);
                EXPECT_GE(l.r, 0);
                EXPECT_LE(l.r + l.t, 1 + 1e-12) << p.name;
            }
}

}  // namespace
}  // namespace tuft::ink
