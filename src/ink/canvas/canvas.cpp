#include "ink/canvas/canvas.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <span>

#include "core/error.h"
#include "core/hash.h"

namespace tuft::ink {
namespace {

constexpr std::size_t kTexels = atlas::kTileTexels;

bool all_zero(const Plane& plane) {
    return std::all_of(plane.begin(), plane.end(), [](float v) { return v == 0.0f; });
}

double integral(const Plane& plane, const atlas::TexelTile& tile) {
    double sum = 0;
    for (std::size_t t = 0; t < kTexels; ++t) sum += static_cast<double>(plane[t]) * static_cast<double>(tile.area[t]);
    return sum;
}

}  // namespace

Canvas::Canvas(std::size_t n_slots) : slots_(n_slots), dirty_(n_slots, 0) {}
Canvas::~Canvas() = default;

Canvas::Canvas(const Canvas& other)
    : pigments_(other.pigments_), slots_(other.slots_.size()), dirty_(other.slots_.size()) {
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
        other.each_plane(slot, [&](int film, int index, const Plane& plane) {
            (film == kFilms ? touch_liquid(slot, static_cast<Liquid>(index)) : touch_film(slot, film, index)) = plane;
        });
    }
    dirty_ = other.dirty_;  // copying is no writing
}

Canvas& Canvas::operator=(const Canvas& other) {
    if (this != &other) *this = Canvas(other);
    return *this;
}

Canvas::Canvas(Canvas&& other) noexcept {
    *this = std::move(other);
}

Canvas& Canvas::operator=(Canvas&& other) noexcept {
    pigments_ = std::move(other.pigments_);
    slots_ = std::move(other.slots_);
    dirty_ = std::move(other.dirty_);
    n_planes_ = other.n_planes_.exchange(0);
    n_films_ = other.n_films_.exchange(0);
    n_tiles_ = other.n_tiles_.exchange(0);
    n_liquid_ = other.n_liquid_.exchange(0);
    return *this;
}

template <class Fn>
void Canvas::each_plane(std::uint32_t slot, Fn&& fn) const {
    const Tile* tile = slots_[slot].get();
    if (!tile) return;
    const auto planes_of = [&](int film, const auto& planes) {
        for (std::size_t i = 0; i < planes.size(); ++i)
            if (planes[i]) fn(film, static_cast<int>(i), *planes[i]);
    };
    // The open film first: that is how files of old have it.
    planes_of(kOpenFilm, tile->open);
    for (std::size_t film = 0; film < tile->under.size(); ++film)
        if (tile->under[film]) planes_of(static_cast<int>(film), *tile->under[film]);
    planes_of(kFilms, tile->liquid);
}

int Canvas::add_pigment(const Pigment& pigment) {
    for (std::size_t i = 0; i < pigments_.size(); ++i)
        if (pigments_[i].name == pigment.name) return static_cast<int>(i);
    if (pigments_.size() == kMaxPigments)
        throw Error(Message("pigment '{}' is one too many: a decoration holds at most {} pigments", pigment.name,
                            kMaxPigments));
    pigments_.push_back(pigment);
    return static_cast<int>(pigments_.size()) - 1;
}

std::size_t Canvas::used_pigments() const {
    int used = 0;
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot)
        each_plane(slot, [&](int film, int index, const Plane& plane) {
            if (film != kFilms && index >= used && !all_zero(plane)) used = index + 1;
        });
    return static_cast<std::size_t>(used);
}

void Canvas::forget_pigments(std::size_t n) {
    if (n >= pigments_.size()) return;
    n = std::max(n, used_pigments());
    if (n >= pigments_.size()) return;
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
        bool above = false;
        each_plane(slot, [&](int film, int index, const Plane&) {
            above |= film != kFilms && static_cast<std::size_t>(index) >= n;
        });
        if (!above) continue;
        // Planes of zeros, which have no place in a list that ends before them.
        const TileSnapshot tile = snapshot(slot);
        TileSnapshot kept{.slot = slot};
        const float* from = tile.amounts.data();
        const auto keep = [&](std::uint8_t planes, bool liquid) {
            std::uint8_t out = 0;
            for (int p = 0; p < kMaxPigments; ++p) {
                if (!(planes >> p & 1)) continue;
                if (liquid || static_cast<std::size_t>(p) < n) {
                    out = static_cast<std::uint8_t>(out | 1 << p);
                    kept.amounts.insert(kept.amounts.end(), from, from + kTexels);
                }
                from += kTexels;
            }
            return out;
        };
        kept.planes = keep(tile.planes, false);
        for (const FilmPlanes& f : tile.under)
            if (const std::uint8_t planes = keep(f.planes, f.film == kFilms)) kept.under.push_back({f.film, planes});
        restore(kept);
    }
    pigments_.resize(n);
}

void Canvas::set_pigment(int index, const Pigment& pigment) {
    assert(index >= 0 && index < static_cast<int>(pigments_.size()));
    pigments_[index] = pigment;
}

Canvas::Tile& Canvas::tile(std::uint32_t slot) {
    auto& tile = slots_[slot];
    if (!tile) {
        tile = std::make_unique<Tile>();
        n_tiles_.fetch_add(1, std::memory_order_relaxed);
    }
    dirty_[slot] = 1;
    return *tile;
}

Plane& Canvas::make(PlanePtr& plane) {
    if (!plane) {
        plane = std::make_unique<Plane>();
        plane->fill(0.0f);
        n_planes_.fetch_add(1, std::memory_order_relaxed);
    }
    return *plane;
}

std::array<Plane*, kMaxPigments> Canvas::open_planes(std::uint32_t slot) {
    std::array<Plane*, kMaxPigments> planes{};
    if (const Tile* tile = slots_[slot].get())
        std::transform(tile->open.begin(), tile->open.end(), planes.begin(), [](const PlanePtr& p) { return p.get(); });
    return planes;
}

const Plane* Canvas::film_plane(std::uint32_t slot, int film, int pigment) const {
    assert(film >= 0 && film < kFilms);
    const Tile* tile = slots_[slot].get();
    if (!tile) return nullptr;
    if (film == kOpenFilm) return tile->open[pigment].get();
    const auto place = static_cast<std::size_t>(film);
    return place < tile->under.size() && tile->under[place] ? (*tile->under[place])[pigment].get() : nullptr;
}

Plane& Canvas::touch_film(std::uint32_t slot, int film, int pigment) {
    assert(film >= 0 && film < kFilms && pigment >= 0 && pigment < kMaxPigments);
    Tile& here = tile(slot);
    if (film == kOpenFilm) return make(here.open[pigment]);
    const auto place = static_cast<std::size_t>(film);
    if (here.under.size() <= place) here.under.resize(place + 1);
    if (!here.under[place]) {
        here.under[place] = std::make_unique<Film>();
        n_films_.fetch_add(1, std::memory_order_relaxed);
    }
    return make((*here.under[place])[pigment]);
}

bool Canvas::has_film(std::uint32_t slot, int film) const {
    for (int p = 0; p < kMaxPigments; ++p)
        if (film_plane(slot, film, p)) return true;
    return false;
}

const Plane* Canvas::liquid(std::uint32_t slot, Liquid where) const {
    const Tile* tile = slots_[slot].get();
    return tile ? tile->liquid[static_cast<int>(where)].get() : nullptr;
}

Plane& Canvas::touch_liquid(std::uint32_t slot, Liquid where) {
    PlanePtr& plane = tile(slot).liquid[static_cast<int>(where)];
    if (!plane) n_liquid_.fetch_add(1, std::memory_order_relaxed);
    return make(plane);
}

void Canvas::swap_liquid(std::uint32_t slot, Liquid where, PlanePtr& plane) {
    PlanePtr& here = tile(slot).liquid[static_cast<int>(where)];
    const std::size_t more = plane ? 1 : 0, less = here ? 1 : 0;  // unsigned: the sum is right
    if (more != less) {
        n_liquid_.fetch_add(more - less, std::memory_order_relaxed);
        n_planes_.fetch_add(more - less, std::memory_order_relaxed);
    }
    here.swap(plane);
}

void Canvas::swap_open(std::uint32_t slot, int pigment, PlanePtr& plane) {
    PlanePtr& here = tile(slot).open[pigment];
    const std::size_t more = plane ? 1 : 0, less = here ? 1 : 0;
    if (more != less) n_planes_.fetch_add(more - less, std::memory_order_relaxed);
    here.swap(plane);
}

std::vector<std::uint32_t> Canvas::wet_slots() const {
    std::vector<std::uint32_t> slots;
    if (!wet()) return slots;
    for (std::size_t slot = 0; slot < slots_.size(); ++slot)
        if (slots_[slot] && (slots_[slot]->liquid[0] || slots_[slot]->liquid[1]))
            slots.push_back(static_cast<std::uint32_t>(slot));
    return slots;
}

std::vector<std::uint32_t> Canvas::touched_slots() const {
    std::vector<std::uint32_t> slots;
    for (std::size_t slot = 0; slot < slots_.size(); ++slot)
        if (slots_[slot]) slots.push_back(static_cast<std::uint32_t>(slot));
    return slots;
}

std::vector<std::uint32_t> Canvas::take_dirty() {
    std::vector<std::uint32_t> slots;
    for (std::size_t slot = 0; slot < dirty_.size(); ++slot) {
        if (!dirty_[slot]) continue;
        slots.push_back(static_cast<std::uint32_t>(slot));
        dirty_[slot] = 0;
    }
    return slots;
}

TileSnapshot Canvas::snapshot(std::uint32_t slot) const {
    TileSnapshot out{.slot = slot, .planes = 0, .amounts = {}};
    each_plane(slot, [&](int film, int index, const Plane& plane) {
        std::uint8_t* planes = &out.planes;
        if (film != kOpenFilm) {
            if (out.under.empty() || out.under.back().film != film)
                out.under.push_back({static_cast<std::uint8_t>(film), 0});
            planes = &out.under.back().planes;
        }
        *planes = static_cast<std::uint8_t>(*planes | 1u << index);
        out.amounts.insert(out.amounts.end(), plane.begin(), plane.end());
    });
    return out;
}

void Canvas::restore(const TileSnapshot& snapshot) {
    bool good = snapshot.slot < slots_.size() && std::bit_width(snapshot.planes) <= pigments_.size();
    auto count = static_cast<std::size_t>(std::popcount(snapshot.planes));
    int below = -1;
    for (const FilmPlanes& f : snapshot.under) {
        const std::size_t limit = f.film == kFilms ? 2 : pigments_.size();
        good = good && f.film > below && f.film <= kFilms && f.film != kOpenFilm && f.planes != 0 &&
               std::bit_width(f.planes) <= limit;
        count += static_cast<std::size_t>(std::popcount(f.planes));
        below = f.film;
    }
    if (!good || snapshot.amounts.size() != kTexels * count) throw Error("a saved tile does not fit this canvas");
    if (slots_[snapshot.slot]) {
        std::size_t planes = 0, liquid = 0, films = 0;
        each_plane(snapshot.slot, [&](int film, int, const Plane&) {
            ++planes;
            liquid += film == kFilms;
        });
        for (const auto& film : slots_[snapshot.slot]->under) films += film != nullptr;
        n_planes_.fetch_sub(planes, std::memory_order_relaxed);
        n_liquid_.fetch_sub(liquid, std::memory_order_relaxed);
        n_films_.fetch_sub(films, std::memory_order_relaxed);
        n_tiles_.fetch_sub(1, std::memory_order_relaxed);
        slots_[snapshot.slot].reset();
    }
    const float* from = snapshot.amounts.data();
    const auto put = [&](int film, std::uint8_t planes) {
        for (int p = 0; p < kMaxPigments; ++p) {
            if (!(planes >> p & 1)) continue;
            Plane& to = film == kFilms ? touch_liquid(snapshot.slot, static_cast<Liquid>(p))
                                       : touch_film(snapshot.slot, film, p);
            std::copy(from, from + kTexels, to.begin());
            from += kTexels;
        }
    };
    put(kOpenFilm, snapshot.planes);
    for (const FilmPlanes& f : snapshot.under) put(f.film, f.planes);
    dirty_[snapshot.slot] = 1;
}

void Canvas::clear() {
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        if (slots_[slot]) dirty_[slot] = 1;
        slots_[slot].reset();
    }
    n_planes_ = n_films_ = n_tiles_ = n_liquid_ = 0;
}

std::size_t Canvas::memory_bytes() const {
    // Sixteen bytes for a film's place in its tile and what the heap adds.
    return n_planes_ * sizeof(Plane) + n_films_ * (sizeof(Film) + 16) + n_tiles_ * sizeof(Tile) +
           slots_.capacity() * sizeof(slots_[0]) + dirty_.capacity();
}

std::uint64_t Canvas::hash() const {
    std::uint64_t h = 0;
    const std::span<const Pigment> used(pigments_.data(), used_pigments());
    for (const Pigment& p : used) h = hash_bytes(p.name.data(), p.name.size(), h + 1);
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
        each_plane(slot, [&](int film, int index, const Plane& plane) {
            if (all_zero(plane)) return;
            // The open film's places are those of files of old, which have no others.
            const std::uint64_t above = film == kOpenFilm ? 0 : static_cast<std::uint64_t>(film + 1);
            const std::uint64_t place = (above << 40 | slot) * kMaxPigments + static_cast<std::uint64_t>(index);
            h = hash_bytes(&place, sizeof place, h);
            h = hash_bytes(plane.data(), kTexels * sizeof(float), h);
        });
    }
    return h;
}

bool Canvas::same_contents(const Canvas& other) const {
    if (slots_.size() != other.slots_.size() || pigments_.size() != other.pigments_.size()) return false;
    for (std::size_t i = 0; i < pigments_.size(); ++i)
        if (pigments_[i].name != other.pigments_[i].name) return false;
    bool same = true;
    const auto compare = [&same](const Canvas& a, const Canvas& b, std::uint32_t slot) {
        a.each_plane(slot, [&](int film, int index, const Plane& plane) {
            const Plane* match =
                film == kFilms ? b.liquid(slot, static_cast<Liquid>(index)) : b.film_plane(slot, film, index);
            same = same &&
                   (match ? std::memcmp(plane.data(), match->data(), kTexels * sizeof(float)) == 0 : all_zero(plane));
        });
    };
    for (std::uint32_t slot = 0; same && slot < slots_.size(); ++slot) {
        compare(*this, other, slot);
        compare(other, *this, slot);
    }
    return same;
}

double Canvas::total(const atlas::TexelMap& map, int pigment) const {
    assert(map.n_slots() == slots_.size());
    double sum = 0;
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot)
        each_plane(slot, [&](int film, int index, const Plane& plane) {
            if (film != kFilms && index == pigment) sum += integral(plane, map.tiles[slot]);
        });
    return sum;
}

double Canvas::total_liquid(const atlas::TexelMap& map) const {
    assert(map.n_slots() == slots_.size());
    double sum = 0;
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot)
        each_plane(slot, [&](int film, int, const Plane& plane) {
            if (film == kFilms) sum += integral(plane, map.tiles[slot]);
        });
    return sum;
}

}  // namespace tuft::ink
