#include "ink/texels/merge.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/system/parallel.h"
#include "ink/texels/drying.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
using Texels = std::array<std::uint8_t, kN>;

/// Texels on which a film has ink.
Texels inked(const Canvas& canvas, std::uint32_t slot, int film) {
    Texels texels{};
    for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
        if (const Plane* plane = canvas.film_plane(slot, film, p))
            for (int t = 0; t < kN; ++t) texels[t] |= (*plane)[t] > 0;
    return texels;
}

bool any(const Texels& texels) {
    return std::any_of(texels.begin(), texels.end(), [](std::uint8_t t) { return t != 0; });
}

void add_film(Canvas& to, int to_film, const Canvas& from, std::uint32_t slot, int film) {
    for (int p = 0; p < static_cast<int>(from.pigments().size()); ++p)
        if (const Plane* plane = from.film_plane(slot, film, p)) {
            Plane& sum = to.touch_film(slot, to_film, p);
            for (int t = 0; t < kN; ++t) sum[t] += (*plane)[t];
        }
}

void merge_tile(Canvas& lower, const Canvas& upper, std::uint32_t slot) {
    add_film(lower, kSoakedFilm, upper, slot, kSoakedFilm);
    for (int film = kFirstDryFilm; film <= kOpenFilm; ++film) {
        const Texels texels = inked(upper, slot, film);
        if (!any(texels)) continue;
        close_films(lower, slot, texels);
        add_film(lower, kOpenFilm, upper, slot, film);
    }
    for (const Liquid where : {Liquid::film, Liquid::pores})
        if (const Plane* liquid = upper.liquid(slot, where)) {
            Plane& sum = lower.touch_liquid(slot, where);
            for (int t = 0; t < kN; ++t) sum[t] += (*liquid)[t];
        }
    lower.mark_dirty(slot);
}

}  // namespace

void merge_films(Canvas& lower, const Canvas& upper) {
    const auto same = [](const Pigment& a, const Pigment& b) { return a.name == b.name; };
    if (lower.n_slots() != upper.n_slots() || !std::equal(lower.pigments().begin(), lower.pigments().end(),
                                                          upper.pigments().begin(), upper.pigments().end(), same))
        throw Error("layers of different atlases or pigments cannot be merged");
    const std::vector<std::uint32_t> slots = upper.touched_slots();
    parallel_for(slots.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) merge_tile(lower, upper, slots[i]);
    });
}

}  // namespace tuft::ink
