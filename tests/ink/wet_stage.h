#pragma once

#include <algorithm>

#include "../atlas/analytic_surfaces.h"
#include "ink/film/film.h"
#include "texels.h"

/// What the tests of the wet film paint on.
namespace tuft::ink {

using atlas::TexelMap;

/// Keeps map and film together: the film looks at the map.
struct Wet {
    testing::Unwrapped u;
    TexelMap map;
    WetFilm film;
    Canvas canvas;

    explicit Wet(testing::Unwrapped unwrapped)
        : u(std::move(unwrapped)),
          map(atlas::build_texel_map(u.mesh, u.atlas)),
          film(map, atlas::build_seam_links(u.mesh, u.atlas, map)),
          canvas(map.n_slots()) {
        for (const char* name : {"carbon", "cinnabar"}) canvas.add_pigment(load_ink(name).parts[0].pigment);
    }
    /// Calls fn(slot, texel, position) for every texel of the charts.
    template <class Fn>
    void each(Fn&& fn) const {
        for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
            for (int t = 0; t < kN; ++t)
                if (map.tiles[slot].cluster[t] != atlas::kNoCluster) fn(slot, t, Vec3(map.position(slot, t)));
    }
    template <class Fn>
    void wet(Fn&& amount, Liquid where = Liquid::film) {
        each([&](std::uint32_t slot, int t, const Vec3& p) {
            if (const double a = amount(p); a > 0) canvas.touch_liquid(slot, where)[t] = static_cast<float>(a);
        });
    }
    template <class Fn>
    void ink(int pigment, Fn&& amount) {
        each([&](std::uint32_t slot, int t, const Vec3& p) {
            if (const double a = amount(p); a > 0) canvas.touch(slot, pigment)[t] = static_cast<float>(a);
        });
    }
    double water(std::uint32_t slot, int t, Liquid where = Liquid::film) const {
        const Plane* w = canvas.liquid(slot, where);
        return w ? static_cast<double>((*w)[t]) : 0;
    }
    double amount(std::uint32_t slot, int t, int pigment = 0) const {
        double sum = 0;
        for (int layer = 0; layer < kFilms; ++layer)
            if (const Plane* w = canvas.film_plane(slot, layer, pigment)) sum += static_cast<double>((*w)[t]);
        return sum;
    }
};

/// Nothing but what a test switches on.
inline FilmParams still() {
    FilmParams p;
    p.mobility = p.levelling = p.threshold = p.pin = p.mixing = p.grip = p.evaporation = p.tension = 0;
    p.shortest_step = 0;
    return p;
}

/// Dry rice paper with even fibres in air that is saturated; what is on the surface stays in its place.
inline FilmParams even_paper() {
    FilmParams p = film_params(load_substrate("rice-paper"), {0, 0, -1});
    p.unevenness = p.evaporation = p.rim_evaporation = p.mobility = p.levelling = 0;
    p.levels_ripples = false;
    return p;
}

inline double disc(const Vec3& p, double radius, double soft = 0.3e-3) {
    return std::clamp((radius - glm::length(p)) / soft + 0.5, 0.0, 1.0);
}

}  // namespace tuft::ink
