#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/system/parallel.h"
#include "wet_stage.h"

// Laws of thin films that are known in closed form.
namespace tuft::ink {
namespace {

/// Rate at which a ripple of wavelength `lambda` decays on a film of `h` film units; in one chart or over a seam.
double ripple_rate(double h, double lambda, double seconds, const FilmParams& p, int charts = 1, double part = 0.05, double call = 0) {
    const double side = 2 * lambda;
    Wet s(testing::sheet(side, charts, std::round(side / 0.1e-3 / charts)));
    const double k = 2 * std::numbers::pi / lambda;
    const auto wave = [&](const Vec3& at) { return std::cos(k * (at.x + 0.5 * side)); };
    s.wet([&](const Vec3& at) { return h * (1 + part * wave(at)); });
    const auto amplitude = [&] {
        double sum = 0, square = 0;
        s.each([&](std::uint32_t slot, int t, const Vec3& at) {
            sum += (s.water(slot, t) - h) * wave(at);
            square += wave(at) * wave(at);
        });
        return sum / square;
    };
    const double from = amplitude();
    if (call > 0)
        for (double t = 0; t < seconds - 1e-9; t += call) s.film.advance(s.canvas, call, p);
    else
        s.film.advance(s.canvas, seconds, p);
    return std::log(from / amplitude()) / seconds;
}

TEST(FilmLaws, Study) {
    FilmParams p = film_params(load_substrate("porcelain"));
    p.evaporation = p.rim_evaporation = 0;
    const auto theory = [&](double h, double lambda) {
        const double k = 2 * std::numbers::pi / lambda;
        return p.tension * std::pow(h * kFilmUnit, 3) * std::pow(k, 4) / (3 * p.viscosity);
    };
    for (const auto& [h, l] : {std::pair{1.0, 2e-3}, {1.0, 4e-3}, {1.0, 8e-3}, {0.5, 2e-3}, {0.5, 1e-3}, {2.0, 4e-3}, {2.0, 8e-3}, {4.0, 8e-3}, {4.0, 16e-3}, {8.0, 16e-3}}) {
        const double t = 1 / theory(h, l);
        for (const int charts : {1, 2})
            std::printf("h %g l %g mm tau %g s: rate over theory %.4f\n", h, l * 1e3, t, ripple_rate(h, l, std::min(t, 60.0), p, charts) * t);
    }
}

TEST(FilmLaws, Cost) {
    set_thread_count(1);
    for (const int kind : {0, 1, 2, 3, 4, 5}) {
        Wet s(testing::sheet(0.04, 1, 400));
        for (const char* name : {"indigo", "gamboge"}) s.canvas.add_pigment(load_ink(name).parts[0].pigment);
        FilmParams p = film_params(load_substrate("porcelain"));
        if (kind == 0 || kind == 4) p.tension = 0;
        const double a = kind == 1 ? 0 : 0.2, h = kind == 3 ? 5 : 1.5;
        s.wet([&](const Vec3& at) { return kind > 3 ? h * disc(at, 15e-3) : h * (1 + a * std::sin(4000 * at.x) * std::cos(1500 * at.y)); });
        for (int k = 0; k < 4; ++k) s.ink(k, [&](const Vec3& at) { return 0.5 + 0.2 * std::sin(4000 * at.x + k); });
        timespec t0{}, t1{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t0);
        const FilmReport r = s.film.advance(s.canvas, 5, p);
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t1);
        const double ns = 1e9 * double(t1.tv_sec - t0.tv_sec) + double(t1.tv_nsec - t0.tv_nsec);
        std::printf("kind %d: %zu steps %zu tile steps %.1f ns per texel and step\n", kind, r.steps, r.tile_steps, ns / (160000.0 * (kind > 3 ? 0.4418 : 1) * double(r.steps)));
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace tuft::ink
