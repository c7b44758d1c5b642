#include "ink/texels/drying.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/system/parallel.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
// Films whose parts differ by less than this, of the whole, are of the same composition: their
// colours over anything differ by less than a tenth of a step of eight bits.
constexpr float kSame = 1e-4f;
// Film units that nobody can see: 1e-5 of carbon black changes a reflectance by 4e-5.
constexpr float kNothing = 1e-5f;

using Amounts = std::array<float, kMaxPigments>;

float sum_of(const Amounts& a) {
    float sum = 0;
    for (const float v : a) sum += v;
    return sum;
}

bool same_composition(const Amounts& a, const Amounts& b) {
    const float sa = sum_of(a), sb = sum_of(b);
    for (int p = 0; p < kMaxPigments; ++p)
        if (std::abs(a[p] * sb - b[p] * sa) > kSame * sa * sb) return false;
    return true;
}

/// The films of one tile, planes made when something is put into them.
struct Tile {
    Canvas& canvas;
    std::uint32_t slot;
    float stain;

    Amounts at(int film, int t) const {
        Amounts a{};
        for (int p = 0; p < kMaxPigments; ++p)
            if (const Plane* plane = canvas.film_plane(slot, film, p)) a[p] = (*plane)[t];
        return a;
    }
    void put(int film, int t, const Amounts& a) {
        for (int p = 0; p < kMaxPigments; ++p)
            if (a[p] != 0 || canvas.film_plane(slot, film, p)) canvas.touch_film(slot, film, p)[t] = a[p];
    }
    void add(int film, int t, const Amounts& a) {
        for (int p = 0; p < kMaxPigments; ++p)
            if (a[p] != 0) canvas.touch_film(slot, film, p)[t] += a[p];
    }
    /// The highest dry film with anything on the texel; the soaked one when there is none.
    int top(int t) const {
        for (int film = kOpenFilm - 1; film >= kFirstDryFilm; --film)
            if (canvas.has_film(slot, film) && sum_of(at(film, t)) > 0) return film;
        return kSoakedFilm;
    }
    void free_film(int t) {
        add(kFirstDryFilm, t, at(kFirstDryFilm + 1, t));
        for (int film = kFirstDryFilm + 1; film + 1 < kOpenFilm; ++film) put(film, t, at(film + 1, t));
        put(kOpenFilm - 1, t, {});
    }
    void close(int t, float part = 1) {
        Amounts amounts = at(kOpenFilm, t), rest{};
        for (int p = 0; p < kMaxPigments && part < 1; ++p) rest[p] = (1 - part) * amounts[p], amounts[p] -= rest[p];
        const float sum = sum_of(amounts);
        if (!(sum > 0)) return;
        put(kOpenFilm, t, rest);
        int film = top(t);
        if (film == kSoakedFilm && stain > 0) {
            Amounts in;
            for (int p = 0; p < kMaxPigments; ++p) in[p] = stain * amounts[p], amounts[p] -= in[p];
            add(kSoakedFilm, t, in);
        }
        if (film >= kFirstDryFilm) {
            const Amounts below = at(film, t);
            if (sum < kNothing || sum_of(below) < kNothing || same_composition(amounts, below)) {
                add(film, t, amounts);
                return;
            }
        }
        if (film == kOpenFilm - 1) {
            free_film(t);
            --film;
        }
        put(film + 1, t, amounts);
    }
    void drop_empty_planes() {
        for (int p = 0; p < kMaxPigments; ++p) {
            const Plane* plane = canvas.plane(slot, p);
            if (!plane || std::any_of(plane->begin(), plane->end(), [](float v) { return v != 0; })) continue;
            std::unique_ptr<Plane> none;
            canvas.swap_open(slot, p, none);
        }
    }
};

}  // namespace

void close_films(Canvas& canvas, std::uint32_t slot, std::span<const std::uint8_t, kN> closing, float stain) {
    if (!canvas.has_film(slot, kOpenFilm)) return;
    Tile tile{canvas, slot, stain};
    for (int t = 0; t < kN; ++t)
        if (closing[t]) tile.close(t);
    tile.drop_empty_planes();
}

void close_parts(Canvas& canvas, std::uint32_t slot, std::span<const float, kN> part) {
    if (!canvas.has_film(slot, kOpenFilm)) return;
    Tile tile{canvas, slot, 0};
    for (int t = 0; t < kN; ++t)
        if (part[t] > 0) tile.close(t, part[t]);
    tile.drop_empty_planes();
}

double dry_all(Canvas& canvas, const atlas::TexelMap& map) {
    const double liquid = canvas.total_liquid(map);
    const std::vector<std::uint32_t> slots = canvas.touched_slots();
    std::array<std::uint8_t, kN> all;
    all.fill(1);
    parallel_for(slots.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            close_films(canvas, slots[i], all);
            for (const Liquid where : {Liquid::film, Liquid::pores}) {
                std::unique_ptr<Plane> none;
                if (canvas.liquid(slots[i], where)) canvas.swap_liquid(slots[i], where, none);
            }
        }
    });
    return liquid;
}

}  // namespace tuft::ink
