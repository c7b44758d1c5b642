#include "ink/exchange/film_tone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/random.h"
#include "ink/exchange/deposit.h"
#include "ink/texels/relief.h"
#include "texels.h"

/// Film that varies within a stamp.
namespace tuft::ink {
namespace {

/// Texels 0.05 mm apart in a turned plane.
std::unique_ptr<atlas::TexelShape> tile_at(const Vec3& origin) {
    auto shape = std::make_unique<atlas::TexelShape>();
    const Vec3 u = 0.05e-3 * glm::normalize(Vec3{1, 0.2, 0.3}), v = 0.05e-3 * glm::normalize(Vec3{-0.2, 1, 0.1});
    for (int t = 0; t < kN; ++t) {
        const Vec3 p = origin + double(t % atlas::kTile) * u + double(t / atlas::kTile) * v;
        shape->px[t] = static_cast<float>(p.x);
        shape->py[t] = static_cast<float>(p.y);
        shape->pz[t] = static_cast<float>(p.z);
    }
    return shape;
}

TEST(FilmTone, IsLinearBetweenSamplesAndEvenBeyond) {
    FilmTone tone{.even = false, .origin = {0.1, 0.2, -0.05}, .across = {2.5e5, 1e5, -5e4}, .film = {}};
    for (int i = 0; i < kToneSamples; ++i) tone.film[i] = static_cast<float>(0.5 + uniform(3, i));
    for (const Vec3& shift : {Vec3{0}, Vec3{0.3e-3, 0.1e-3, 0}, Vec3{-2e-3, 0, 0}, Vec3{3e-3, 0, 0}}) {
        const auto shape = tile_at(tone.origin + shift);
        std::array<float, kN> film;
        film.fill(2);
        apply_profile(film, tone, *shape);
        for (int t = 0; t < kN; ++t) {
            const Vec3 p{shape->px[t], shape->py[t], shape->pz[t]};
            const double at = std::clamp(glm::dot(tone.across, p - Vec3(Vec3f(tone.origin))), 0.0, kToneSamples - 1.0);
            const int i = std::min(static_cast<int>(at), kToneSamples - 2);
            // Positions are of single precision: 1.5e-8 of 0.2 m, 4e-3 of a sample.
            EXPECT_NEAR(film[t], 2 * std::lerp(tone.film[i], tone.film[i + 1], at - i), 0.02) << t;
        }
    }
}

TEST(FilmTone, OfGrainHasItsShareAndKeepsTheMean) {
    EXPECT_EQ(grain_share(1e-6, 1.8), 0) << "glaze";
    EXPECT_NEAR(grain_share(15e-6, 1.8), 0.35 * 15 / 33, 1e-6);
    double sum = 0, squares = 0;
    constexpr int kTiles = 100;
    for (int k = 0; k < kTiles; ++k) {
        std::array<float, kN> relief, film;
        relief_of_tile(*tile_at({0.01 * k, 0.003 * k, 0}), 120e-6, relief);
        film.fill(1);
        apply_grain(film, relief, 0.16f);
        for (const float f : film) sum += static_cast<double>(f) / kN / kTiles;
        for (const float f : film) squares += static_cast<double>(f) * f / kN / kTiles;
    }
    // A tile has some three by three independent heights, all of them 900: 0.16/30 = 0.005, three of them.
    EXPECT_NEAR(sum, 1, 0.016);
    EXPECT_NEAR(std::sqrt(squares - sum * sum), 0.16, 0.02);
}

// Texels of a tile share the corners of the noise; the heights are those of the points alone.
TEST(FilmTone, ReliefOfATileIsThatOfItsPoints) {
    for (const double length : {60e-6, 120e-6, 2e-6}) {
        const auto shape = tile_at({-0.0317, 0.0121, 0.0044});
        std::array<float, kN> relief;
        relief_of_tile(*shape, length, relief);
        for (int t = 0; t < kN; ++t)
            EXPECT_EQ(relief[t], static_cast<float>(relief_at({shape->px[t], shape->py[t], shape->pz[t]}, length)));
    }
}

// Any number of passes converges to the tone times g(f), and what is given is what lies there.
TEST(FilmTone, IsAFactorOnTheFilmOfADeposit) {
    const Texels area = random_texels(99, 0.5e-8, 1.5e-8), coverage = random_texels(3, 0, 1),
                 tone = random_texels(4, 0.8, 1.2);
    for (const bool mixed : {false, true}) {
        Canvas canvas(1);
        Ink ink;
        for (const char* name : {"black", "white"})
            if (mixed || ink.parts.empty()) {
                InkPart part;
                part.pigment.name = name;
                part.fraction = mixed ? 0.5 : 1;
                ink.parts.push_back(part);
            }
        const DepositParams params{.mix = mix_of(canvas, ink), .target = 1.8f, .extinction = 0.7f};
        const DepositLaw law = deposit_law(params, 1e-3);
        Texels goal;
        film_goals(goal, coverage, params);
        double given = 0;
        for (int i = 0; i < 60; ++i) given += deposit(canvas, {0, coverage, area}, params, law, tone);
        double there = 0;
        for (int t = 0; t < kN; ++t) {
            double film = 0;
            for (int p = 0; p < (mixed ? 2 : 1); ++p) film += static_cast<double>((*canvas.plane(0, p))[t]);
            EXPECT_NEAR(film, goal[t] * tone[t], 5e-6);
            there += film * static_cast<double>(area[t]);
        }
        EXPECT_NEAR(given / there, 1, 1e-6);
    }
}

}  // namespace
}  // namespace tuft::ink
